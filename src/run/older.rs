//! States of older logs, in which measures remember other things than they do now.

use super::OBSERVATION;
use crate::observe::measures;
use crate::record::state::SavedState;
use crate::scenario::model::Scenario;
use crate::space::Vector;

/// Whether a log that says `observation` of itself, or nothing, remembers what this program does.
pub(super) fn observes_alike(observation: &str) -> bool {
    observation == OBSERVATION.to_string()
}

/// Takes out of `state` what measures cannot take over, so that they begin anew; returns their names.
pub(super) fn forget<V: Vector>(
    scenario: &Scenario<V>,
    state: &mut SavedState<'_, V>,
) -> Vec<&'static str> {
    let mut anew = Vec::new();
    for mut measure in measures(&scenario.setting(), scenario.record.measures.as_deref()) {
        let place = state.memories.iter().position(|(name, _)| name == measure.name());
        let Some(place) = place.filter(|&place| !measure.recall(&state.memories[place].1)) else { continue };
        state.memories.remove(place);
        // Samples are counted in the order of the memories.
        if place < state.samples.len() {
            state.samples.remove(place);
        }
        anew.push(measure.name());
    }
    anew
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::NoLaps;
    use crate::scenario::initial;
    use crate::scenario::model::AnyScenario;
    use crate::simulation::Simulation;

    #[test]
    fn measures_that_remember_otherwise_begin_anew_and_the_others_go_on() {
        let text = "dimension = 2\n[engine]\nkind = \"cba\"\ncell_size = 2.0\n[domain]\nsize = [20.0, 20.0]\n\
                    [particles]\ncount = 90\nrestitution = 0.9\n[initial]\nvelocities = { maxwell = 1.0 }\n\
                    [run]\ntime = 9.0\n";
        let AnyScenario::Two(scenario) = crate::scenario::parse("old", text, &Default::default()).unwrap() else {
            panic!("the scenario is flat")
        };
        let gas = initial::build(&scenario, None).unwrap();
        let mut simulation = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
        for _ in 0..20 {
            simulation.advance(&mut NoLaps, crate::engine::Horizon::NONE).unwrap();
        }
        let mut state = simulation.saved_state(0, 0);
        assert_eq!(forget(&scenario, &mut state.clone()), Vec::<&str>::new());
        let place = state.memories.iter().position(|(name, _)| name == "pressure").unwrap();
        // As numerics 2 remembered it first: no previous row, then rows of time, temperature, Σ p·s and grains.
        state.memories[place].1 = vec![0.0, 0.0, 1.0, 0.0, 90.0];
        assert!(Simulation::resume(&scenario, state.clone()).is_err());
        let (memories, samples) = (state.memories.len(), state.samples.len());
        assert_eq!(forget(&scenario, &mut state), ["pressure"]);
        assert_eq!((state.memories.len(), state.samples.len()), (memories - 1, samples - 1));
        let resumed = Simulation::resume(&scenario, state).unwrap();
        assert_eq!(resumed.gas().time(), simulation.gas().time());
    }
}
