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

/// Names of the measures that cannot take over what an older log remembers in `state`, and so begin anew.
pub(super) fn begun_anew<V: Vector>(scenario: &Scenario<V>, state: &SavedState<'_, V>) -> Vec<&'static str> {
    let all = measures(&scenario.setting(), scenario.record.measures.as_deref()).into_iter();
    let anew = all.filter_map(|mut measure| {
        let (_, memory) = state.memories.iter().find(|(name, _)| name == measure.name())?;
        (!measure.recall(memory)).then(|| measure.name())
    });
    anew.collect()
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
        let AnyScenario::Two(scenario) = crate::scenario::parse("old", text, &Default::default()).unwrap()
        else {
            panic!("the scenario is flat")
        };
        let gas = initial::build(&scenario, None).unwrap();
        let mut simulation = Simulation::start(&scenario, gas, &mut NoLaps).unwrap();
        for _ in 0..20 {
            simulation.advance(&mut NoLaps, crate::engine::Horizon::NONE).unwrap();
        }
        let mut state = simulation.saved_state(0, 0);
        assert_eq!(begun_anew(&scenario, &state), Vec::<&str>::new());
        // As earlier versions remembered it: no previous row, then rows of time, temperature, Σ p·s and grains.
        let place = state.memories.iter().position(|(name, _)| name == "pressure").unwrap();
        state.memories[place].1 = vec![0.0, 0.0, 1.0, 0.0, 90.0];
        assert_eq!(begun_anew(&scenario, &state), ["pressure"]);
        // Of this version it would be no memory of a run.
        assert!(Simulation::resume(&scenario, state.clone()).is_err());
        // Earlier versions counted the samples of every run from 1 on.
        state.samples.fill(3);
        let resumed = Simulation::resume(&scenario, state).unwrap();
        assert_eq!(resumed.gas().time(), simulation.gas().time());
        assert_eq!(resumed.begun_anew(), ["pressure"]);
    }
}
