//! What a comparison will run, checked as a whole before anything does.

use std::path::Path;

use crate::random::Streams;
use crate::scenario::error::{Mistake, Place};
use crate::scenario::model::{AnyScenario, EngineKind, InitialPositions, RunLimits};
use crate::scenario::{Overrides, ScenarioError, load, parse_in};

/// Replicas of a scenario that draws its own grains, unless somebody says otherwise.
pub const USUAL_REPLICAS: u32 = 4;

/// What somebody wants to compare.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wish {
    /// A scenario file, or the name of a built-in one.
    pub source: String,
    /// What to change in it; its engine stays out of this.
    pub overrides: Overrides,
    /// Names of the engines; `None` for the scenario's own beside event-driven dynamics.
    pub engines: Option<Vec<String>>,
    /// Measures in place of `record.measures`.
    pub measures: Option<Vec<String>>,
    /// Independent initial states; `None` for [`USUAL_REPLICAS`], or 1 where the scenario names a log.
    pub replicas: Option<u32>,
}

/// Why nothing is run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// The scenario is wrong, or wrong for an engine.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The scenario is wrong for the initial state.
    #[error("{0}\nevent-driven dynamics makes the initial states, which all engines share")]
    Beginning(ScenarioError),
    /// Nothing to compare with.
    #[error(
        "--engines: `{0}` alone has nothing to be compared with; name two or more, such as hsmc,event-driven"
    )]
    Alone(String),
    /// An engine stands there twice.
    #[error("--engines: names `{0}` twice; name each engine once")]
    Twice(String),
    /// Replicas that would all begin alike.
    #[error(
        "--replicas {0}: the scenario starts from a log, so that all replicas would begin with the same grains; leave \
         it out, and errors are taken from blocks of the one run"
    )]
    SameBeginning(u32),
}

/// A comparison of a scenario, ready to run: every engine is known to take it.
#[derive(Clone, Debug)]
pub struct Plan {
    source: String,
    overrides: Overrides,
    contestants: Vec<AnyScenario>,
    replicas: u32,
}

impl Plan {
    /// Checks everything that is wished for, all mistakes of all engines at once.
    pub fn new(wish: &Wish) -> Result<Self, PlanError> {
        let mut overrides = wish.overrides.clone();
        let measures = wish.measures.as_ref().map(|names| names.join(","));
        if let Some(names) = &wish.measures {
            let list: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
            overrides.sets.push(format!("record.measures=[{}]", list.join(", ")));
        }
        let names = Names { measures, sets: overrides.sets.len() };
        let told = |error| PlanError::Scenario(names.told(error));
        let engines = match &wish.engines {
            Some(engines) => checked_names(engines)?,
            None => usual_engines(&load(&wish.source, &overrides).map_err(told)?),
        };
        let contestants = contestants(&wish.source, &overrides, &engines).map_err(told)?;
        let from_log = contestants.iter().any(|one| matches!(one.positions(), InitialPositions::Log(_)));
        let replicas = match (wish.replicas, from_log) {
            (Some(number), true) if number > 1 => return Err(PlanError::SameBeginning(number)),
            (number, true) => number.unwrap_or(1),
            (number, false) => number.unwrap_or(USUAL_REPLICAS),
        };
        let plan = Plan { source: wish.source.clone(), overrides, contestants, replicas };
        plan.beginning(1).map_err(|error| PlanError::Beginning(names.told(error)))?;
        Ok(plan)
    }

    /// The engines, in the order asked for.
    pub fn engines(&self) -> impl ExactSizeIterator<Item = EngineKind> + '_ {
        self.contestants.iter().map(AnyScenario::engine)
    }

    /// Initial states, each of which goes through every engine.
    pub fn replicas(&self) -> u32 {
        self.replicas
    }

    /// The scenario's name.
    pub fn name(&self) -> &str {
        self.contestants[0].name()
    }

    /// The seed from which replicas draw theirs.
    pub fn seed(&self) -> u64 {
        self.contestants[0].seed()
    }

    /// The scenario as asked for, with the first engine.
    pub(super) fn source_text(&self) -> &str {
        self.contestants[0].source_text()
    }

    /// Diameter of a grain [length].
    pub(super) fn diameter(&self) -> f64 {
        self.contestants[0].diameter()
    }

    /// The scenario whose beginning is the initial state of `replica`: event-driven, so that no grains overlap.
    pub(super) fn beginning(&self, replica: u32) -> Result<AnyScenario, ScenarioError> {
        let mut overrides = self.overrides.clone();
        overrides.engine = Some(EngineKind::EventDriven.name().to_owned());
        overrides.seed = Some(self.replica_seed(replica));
        let steps_alone = RunLimits { steps: None, ..self.contestants[0].run() } == RunLimits::default();
        if steps_alone {
            // It has no steps to count, and none is made here: any other limit will do.
            overrides.sets.push("run.collisions_per_particle=1".to_owned());
        }
        load(&self.source, &overrides)
    }

    /// The scenario of `replica` in engine number `contestant` as it stands in a file of `folder`: one that starts from
    /// the log `beginning`, a path from there.
    pub(super) fn contestant(
        &self,
        contestant: usize,
        replica: u32,
        folder: &Path,
        beginning: &str,
    ) -> Result<AnyScenario, ScenarioError> {
        let scenario = &self.contestants[contestant];
        let overrides = Overrides {
            sets: vec![format!("initial.positions={{ log = {beginning:?} }}")],
            seed: Some(self.replica_seed(replica)),
            engine: None,
        };
        let changed = parse_in(folder, scenario.name(), scenario.source_text(), &overrides)?;
        // What runs is what stands in the text, read as anybody would read it from there.
        parse_in(folder, scenario.name(), changed.source_text(), &Overrides::default())
    }

    fn replica_seed(&self, replica: u32) -> u64 {
        Streams::new(self.seed()).replica_seed(replica)
    }
}

/// Two or more engines, each named once; whether they exist is the scenario's to say.
fn checked_names(engines: &[String]) -> Result<Vec<String>, PlanError> {
    for (k, engine) in engines.iter().enumerate() {
        if engines[..k].contains(engine) {
            return Err(PlanError::Twice(engine.clone()));
        }
    }
    match engines {
        [] => Err(PlanError::Alone(String::new())),
        [engine] => Err(PlanError::Alone(engine.clone())),
        _ => Ok(engines.to_vec()),
    }
}

/// The scenario's own engine and the exact reference; HSMC beside a scenario that is event-driven itself.
fn usual_engines(scenario: &AnyScenario) -> Vec<String> {
    let exact = EngineKind::EventDriven;
    let own = if scenario.engine() == exact { EngineKind::Hsmc } else { scenario.engine() };
    [own, exact].map(|kind| kind.name().to_owned()).to_vec()
}

/// The scenario with each of `engines`, or what is wrong with it for any of them.
fn contestants(
    source: &str,
    overrides: &Overrides,
    engines: &[String],
) -> Result<Vec<AnyScenario>, ScenarioError> {
    let mut scenarios = Vec::new();
    let mut errors: Option<ScenarioError> = None;
    for engine in engines {
        match load(source, &Overrides { engine: Some(engine.clone()), ..overrides.clone() }) {
            Ok(scenario) => scenarios.push(scenario),
            Err(error) => {
                let all =
                    errors.get_or_insert_with(|| ScenarioError { mistakes: Vec::new(), ..error.clone() });
                for mistake in error.mistakes {
                    if !all.mistakes.contains(&mistake) {
                        all.mistakes.push(mistake);
                    }
                }
            }
        }
    }
    errors.map_or(Ok(scenarios), Err)
}

/// How options are called that reach the scenario under other names.
struct Names {
    measures: Option<String>,
    /// How many `--set` there are, `--measures` as the last.
    sets: usize,
}

impl Names {
    /// `error` with options called as the user wrote them.
    fn told(&self, mut error: ScenarioError) -> ScenarioError {
        for Mistake { place, .. } in &mut error.mistakes {
            let Place::Option { order, name } = place else { continue };
            if let Some(measures) = self.measures.as_ref().filter(|_| *order + 1 == self.sets) {
                *name = format!("--measures {measures}");
            } else if let Some(rest) = name.strip_prefix("--engine ") {
                *name = format!("--engines {rest}");
            }
        }
        error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(source: &str, engines: &[&str]) -> Wish {
        let engines = engines.iter().map(ToString::to_string).collect();
        Wish { source: source.to_owned(), engines: Some(engines), ..Wish::default() }
    }

    #[test]
    fn every_run_begins_with_its_replicas_log_and_seed() {
        let plan = Plan::new(&wish("cooling", &["hsmc", "event-driven"])).unwrap();
        assert_eq!((plan.replicas(), plan.name(), plan.engines().len()), (4, "cooling", 2));
        let beginning = plan.beginning(2).unwrap();
        assert!(
            beginning.engine().is_event_driven()
                && !matches!(beginning.positions(), InitialPositions::Log(_))
        );
        for contestant in 0..2 {
            let scenario = plan.contestant(contestant, 2, Path::new("a"), "initial-2/log.mcap").unwrap();
            let log = Path::new("a/initial-2/log.mcap").to_owned();
            assert_eq!(scenario.positions(), &InitialPositions::Log(log));
            assert_eq!(scenario.seed(), beginning.seed());
            assert_eq!(scenario.engine(), plan.engines().nth(contestant).unwrap());
            assert!(!scenario.source_text().contains("equilibrate"), "{}", scenario.source_text());
        }
        assert_ne!(plan.beginning(1).unwrap().seed(), beginning.seed());
    }

    #[test]
    fn the_usual_engines_are_the_own_and_the_exact_one() {
        let engines = |source: &str| -> Vec<EngineKind> {
            Plan::new(&Wish { source: source.to_owned(), ..Wish::default() }).unwrap().engines().collect()
        };
        assert_eq!(engines("clustering"), [EngineKind::Cba, EngineKind::EventDriven]);
        assert_eq!(engines("simic-cooling"), [EngineKind::Hsmc, EngineKind::EventDriven]);
    }

    #[test]
    fn steps_alone_still_have_a_beginning() {
        let mut steps = wish("cooling", &["hsmc", "cba"]);
        steps.overrides.sets = vec!["run={steps=3}".to_owned()];
        assert!(Plan::new(&steps).is_ok());
        steps.engines.as_mut().unwrap().push("event-driven".to_owned());
        assert!(Plan::new(&steps).unwrap_err().to_string().contains("has no steps"));
    }

    #[test]
    fn what_cannot_be_compared_is_refused_by_its_option() {
        let message = |wish: &Wish| Plan::new(wish).unwrap_err().to_string();
        assert!(message(&wish("cooling", &["hsmc"])).contains("alone has nothing to be compared with"));
        assert!(message(&wish("cooling", &["hsmc", "hsmc"])).contains("names `hsmc` twice"));
        let said = message(&wish("cooling", &["hsmc", "dsmcc"]));
        assert!(said.contains("--engines 'dsmcc'") && said.contains("did you mean"), "{said}");
        let mut wrong = wish("cooling", &["hsmc", "cba"]);
        wrong.measures = Some(vec!["enrgy".to_owned()]);
        assert!(message(&wrong).starts_with("--measures enrgy: "), "{}", message(&wrong));
        let mut rough = wish("cooling", &["hsmc", "cba", "event-driven"]);
        rough.overrides.sets = vec!["particles.tangential_restitution=0.5".to_owned()];
        let said = message(&rough);
        assert!(
            said.contains("hsmc knows smooth grains") && said.contains("cba knows smooth grains"),
            "{said}"
        );
        let mut log = wish("cooling", &["hsmc", "cba"]);
        log.overrides.sets = vec!["initial.positions.log=a.mcap".to_owned()];
        assert_eq!(Plan::new(&log).unwrap().replicas(), 1);
        log.replicas = Some(3);
        assert!(message(&log).contains("--replicas 3"));
    }
}
