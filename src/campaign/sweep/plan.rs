//! What a sweep will run: every case, checked before the first begins.

use super::SweepError;
use super::figures;
use super::variation::Variation;
use crate::random::Streams;
use crate::scenario::error::{Mistake, Place, ScenarioError};
use crate::scenario::model::AnyScenario;
use crate::scenario::{Overrides, load};

/// Most runs of a sweep.
const MOST_CASES: usize = 10_000;

/// What somebody asks for.
#[derive(Clone, Debug, Default)]
pub struct Wish {
    /// A scenario file, or the name of a built-in one.
    pub source: String,
    /// `--set` options for every case.
    pub sets: Vec<String>,
    /// `--seed`.
    pub seed: Option<u64>,
    /// `--vary` options; several make a grid.
    pub varies: Vec<String>,
    /// Engines to sweep over; none for the scenario's own.
    pub engines: Vec<String>,
    /// Runs of every case with seeds of their own, at least 1.
    pub replicas: u32,
    /// Figures to plot; none for the scenario's own.
    pub figures: Vec<String>,
}

/// One run.
#[derive(Clone, Debug)]
pub(super) struct Case {
    /// The name of its folder.
    pub(super) name: String,
    /// Which point of the grid, engines included: replicas of the same number differ by their seeds alone.
    pub(super) point: usize,
    /// Which value of each variation `[variation]`.
    pub(super) places: Vec<usize>,
    /// Which replica, from 1.
    pub(super) replica: u32,
    /// What is run.
    pub(super) scenario: AnyScenario,
}

/// All runs of a sweep.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) variations: Vec<Variation>,
    /// Whether engines are part of the grid.
    pub(super) sweeps_engines: bool,
    pub(super) cases: Vec<Case>,
    pub(super) replicas: u32,
    /// Figures to plot.
    pub(super) figures: Vec<String>,
}

impl Plan {
    /// Reads the options and checks every case; says all that is wrong.
    pub fn new(wish: &Wish) -> Result<Self, SweepError> {
        let variations = variations(wish)?;
        refuse_conflicts(wish, &variations)?;
        let cases = cases(wish, &variations)?;
        let mut own: Vec<String> = Vec::new();
        for case in cases.iter().filter(|case| case.replica == 1) {
            let new: Vec<String> = figures::own_figures(&case.scenario);
            own.extend(new.into_iter().filter(|name| !own.contains(name)).collect::<Vec<_>>());
        }
        figures::check(&wish.figures, &own).map_err(SweepError::Wrong)?;
        let mut figures = if wish.figures.is_empty() { own } else { wish.figures.clone() };
        let mut seen = std::collections::BTreeSet::new();
        figures.retain(|name| seen.insert(name.clone()));
        let sweeps_engines = !wish.engines.is_empty();
        Ok(Plan { variations, sweeps_engines, cases, replicas: wish.replicas, figures })
    }

    /// The scenario's name.
    pub fn name(&self) -> &str {
        self.cases[0].scenario.name()
    }

    /// How many runs there are.
    pub fn runs(&self) -> usize {
        self.cases.len()
    }

    /// The folder name of a case.
    pub fn case(&self, case: usize) -> &str {
        &self.cases[case].name
    }

    /// Paths of all varied keys.
    pub(super) fn paths(&self) -> Vec<&str> {
        self.variations.iter().flat_map(|variation| &variation.keys).map(|key| key.path.as_str()).collect()
    }

    /// Paths and values of a case, in the order of [`Plan::paths`].
    pub(super) fn settings<'a>(&'a self, case: &'a Case) -> impl Iterator<Item = (&'a str, &'a str)> {
        let places = self.variations.iter().zip(&case.places);
        places.flat_map(|(variation, &place)| variation.settings(place))
    }
}

fn variations(wish: &Wish) -> Result<Vec<Variation>, SweepError> {
    let read = |(k, text): (usize, &String)| {
        Variation::parse(text).map_err(|message| format!("--vary #{} '{text}': {message}", k + 1))
    };
    let (read, wrong): (Vec<_>, Vec<_>) = wish.varies.iter().enumerate().map(read).partition(Result::is_ok);
    let wrong: Vec<String> = wrong.into_iter().filter_map(Result::err).collect();
    if wrong.is_empty() {
        Ok(read.into_iter().flatten().collect())
    } else {
        Err(SweepError::Wrong(wrong.join("\n")))
    }
}

fn refuse_conflicts(wish: &Wish, variations: &[Variation]) -> Result<(), SweepError> {
    let wrong = |message: String| Err(SweepError::Wrong(message));
    if variations.is_empty() && wish.engines.is_empty() && wish.replicas < 2 {
        return wrong(
            "nothing varies; give --vary key=[a, b, c], --engines a,b or --replicas K, or use `grainflow run`".to_owned(),
        );
    }
    let paths: Vec<&str> = variations.iter().flat_map(|v| &v.keys).map(|key| key.path.as_str()).collect();
    if let Some((_, twice)) = paths.iter().enumerate().find(|(k, path)| paths[..*k].contains(path)) {
        return wrong(format!("--vary: `{twice}` is varied twice; name each key once"));
    }
    for (key, option, is_given) in
        [("seed", "--seed", wish.seed.is_some()), ("engine.kind", "--engines", !wish.engines.is_empty())]
    {
        if is_given && paths.contains(&key) {
            return wrong(format!("--vary: `{key}` is also set by {option}; leave one of them out"));
        }
    }
    if let Some((k, engine)) = wish.engines.iter().enumerate().find(|(k, e)| wish.engines[..*k].contains(e)) {
        return wrong(format!("--engines: engine {} is `{engine}` again; name each once", k + 1));
    }
    let sizes =
        variations.iter().map(Variation::len).chain([wish.engines.len().max(1), wish.replicas as usize]);
    let runs = sizes.fold(1_usize, usize::saturating_mul);
    if runs > MOST_CASES {
        return wrong(format!(
            "{runs} runs are too many; a sweep has at most {MOST_CASES}, cut it in pieces"
        ));
    }
    Ok(())
}

/// Every run in the order of the grid: the first variation slowest, then engines, then replicas.
fn cases(wish: &Wish, variations: &[Variation]) -> Result<Vec<Case>, SweepError> {
    let names = short_names(variations);
    let points: usize = variations.iter().map(Variation::len).product();
    let engines: Vec<Option<&String>> =
        if wish.engines.is_empty() { vec![None] } else { wish.engines.iter().map(Some).collect() };
    let (mut cases, mut mistakes, mut file) = (Vec::new(), Vec::<Mistake>::new(), String::new());
    for (point, (place, engine)) in
        (0..points).flat_map(|place| engines.iter().map(move |engine| (place, *engine))).enumerate()
    {
        let places = places(place, variations);
        match replicas(wish, variations, &places, engine) {
            Ok(scenarios) => cases.extend(scenarios.into_iter().zip(1..).map(|(scenario, replica)| Case {
                name: folder_name(
                    variations,
                    &names,
                    &places,
                    engine,
                    (wish.replicas > 1).then_some(replica),
                ),
                point,
                places: places.clone(),
                replica,
                scenario,
            })),
            Err(error) => {
                file = error.file;
                for mistake in error.mistakes {
                    if !mistakes.contains(&mistake) {
                        mistakes.push(mistake);
                    }
                }
            }
        }
    }
    if !mistakes.is_empty() {
        return Err(SweepError::Scenario(ScenarioError { file, mistakes }));
    }
    tell_apart(&mut cases);
    Ok(cases)
}

/// The place in every variation of point number `place` of their grid, the last variation fastest.
fn places(mut place: usize, variations: &[Variation]) -> Vec<usize> {
    let mut places = vec![0; variations.len()];
    for (k, variation) in variations.iter().enumerate().rev() {
        places[k] = place % variation.len();
        place /= variation.len();
    }
    places
}

/// The scenario of one point of the grid, once for each replica: the first keeps the seed.
fn replicas(
    wish: &Wish,
    variations: &[Variation],
    places: &[usize],
    engine: Option<&String>,
) -> Result<Vec<AnyScenario>, ScenarioError> {
    let mut sets = wish.sets.clone();
    // How an option shall be named in place of `--set #n`.
    let mut options = Vec::new();
    for (k, (variation, &place)) in variations.iter().zip(places).enumerate() {
        for (path, value) in variation.settings(place) {
            let set = format!("{path}={value}");
            options.push(format!("--vary #{} '{set}'", k + 1));
            sets.push(set);
        }
    }
    let mut overrides = Overrides { sets, engine: engine.cloned(), seed: wish.seed };
    let read = |overrides: &Overrides| {
        load(&wish.source, overrides).map_err(|error| renamed(error, wish.sets.len(), &options))
    };
    let first = read(&overrides)?;
    let streams = Streams::new(first.seed());
    let mut scenarios = vec![first];
    for replica in 2..=wish.replicas {
        overrides.seed = Some(streams.replica_seed(replica));
        scenarios.push(read(&overrides)?);
    }
    Ok(scenarios)
}

/// The same error, with options named as the user wrote them.
fn renamed(mut error: ScenarioError, sets: usize, options: &[String]) -> ScenarioError {
    for mistake in &mut error.mistakes {
        if let Place::Option { order, name } = &mut mistake.place {
            if let Some(option) = order.checked_sub(sets).and_then(|k| options.get(k)) {
                name.clone_from(option);
            } else if let Some(engine) = name.strip_prefix("--engine ") {
                *name = format!("--engines {engine}");
            }
        }
    }
    error
}

/// The leading key of each variation by the end of its path that no other varied key has.
fn short_names(variations: &[Variation]) -> Vec<String> {
    let paths: Vec<&str> = variations.iter().flat_map(|v| &v.keys).map(|key| key.path.as_str()).collect();
    let name = |variation: &Variation| {
        let path = variation.leader().path.as_str();
        let starts = path.rmatch_indices('.').map(|(at, _)| &path[at + 1..]).chain([path]);
        let is_alone = |end: &str| {
            let has_end = |other: &&&str| **other == end || other.ends_with(&format!(".{end}"));
            paths.iter().filter(has_end).count() == 1
        };
        starts.into_iter().find(|end| is_alone(end)).unwrap_or(path).to_owned()
    };
    variations.iter().map(name).collect()
}

/// A readable name such as `restitution=0.9_hsmc_replica-2`, of characters that every file system takes.
fn folder_name(
    variations: &[Variation],
    names: &[String],
    places: &[usize],
    engine: Option<&String>,
    replica: Option<u32>,
) -> String {
    let value = |(variation, &place): (&Variation, &usize)| variation.leader().values[place].clone();
    let mut parts: Vec<String> = variations
        .iter()
        .zip(places)
        .map(value)
        .zip(names)
        .map(|(value, name)| format!("{}={}", plain(&name.replace('[', ".")), plain(&value)))
        .collect();
    parts.extend(engine.cloned());
    parts.extend(replica.map(|replica| format!("replica-{replica}")));
    parts.join("_")
}

/// `text` with its letters, digits, points and signs; anything else becomes a hyphen between them.
fn plain(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || ".+-".contains(c);
    let words: Vec<&str> = text.split(|c| !is_plain(c)).filter(|word| !word.is_empty()).collect();
    words.join("-").chars().take(48).collect()
}

/// Numbers the cases whose names came out alike.
fn tell_apart(cases: &mut [Case]) {
    let mut seen = std::collections::BTreeMap::<String, usize>::new();
    for case in cases {
        let count = seen.entry(case.name.clone()).or_default();
        *count += 1;
        if *count > 1 {
            case.name = format!("{}~{count}", case.name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish(varies: &[&str]) -> Wish {
        Wish {
            source: "shear".to_owned(),
            varies: varies.iter().map(ToString::to_string).collect(),
            replicas: 1,
            ..Wish::default()
        }
    }

    fn names(wish: &Wish) -> Vec<String> {
        Plan::new(wish).unwrap().cases.into_iter().map(|case| case.name).collect()
    }

    fn wrong(wish: &Wish) -> String {
        Plan::new(wish).unwrap_err().to_string()
    }

    #[test]
    fn cases_have_readable_names_in_the_order_of_the_grid() {
        let grid = wish(&["particles.restitution=[0.9,0.8]", "particles.count=[100,200]"]);
        assert_eq!(
            names(&Wish { engines: vec!["dsmc".into(), "hsmc".into()], ..grid })[..3],
            [
                "restitution=0.9_count=100_dsmc",
                "restitution=0.9_count=100_hsmc",
                "restitution=0.9_count=200_dsmc"
            ]
        );
        let walls = "boundary.y.lower.velocity[0]=[-1,-2] + boundary.y.upper.velocity[0]=[1,2]";
        assert_eq!(names(&wish(&[walls])), ["upper.velocity.0=1", "upper.velocity.0=2"]);
        let steps = wish(&["engine.time_step=[{ fixed = 0.1 }, { crossing = 0.2 }]"]);
        assert_eq!(names(&steps)[1], "time-step=crossing-0.2");
    }

    #[test]
    fn replicas_keep_the_seed_once_and_differ_after() {
        let plan =
            Plan::new(&Wish { replicas: 3, seed: Some(7), ..wish(&["particles.count=[100]"]) }).unwrap();
        let seeds: Vec<u64> = plan.cases.iter().map(|case| case.scenario.seed()).collect();
        assert_eq!(seeds, [7, Streams::new(7).replica_seed(2), Streams::new(7).replica_seed(3)]);
        assert!(plan.cases.iter().all(|case| case.point == 0));
    }

    #[test]
    fn mistakes_name_the_option() {
        let said = wrong(&wish(&["particles.count=[100]", "particles.restitution=[0.5, 1.5, 2]"]));
        assert!(said.contains("--vary #2 'particles.restitution=1.5': particles.restitution: "), "{said}");
        assert!(said.contains("--vary #2 'particles.restitution=2'"), "{said}");
        assert!(wrong(&wish(&["particles.restituton=[0.5]"])).contains("did you mean `restitution`?"));
        let said = wrong(&Wish { engines: vec!["dsmcc".into()], ..wish(&[]) });
        assert!(said.contains("--engines 'dsmcc'"), "{said}");
        assert!(wrong(&wish(&[])).contains("nothing varies"));
        assert!(wrong(&wish(&["seed=[1]", "seed=[2]"])).contains("varied twice"));
        assert!(wrong(&Wish { seed: Some(1), ..wish(&["seed=[1,2]"]) }).contains("also set by --seed"));
        let many = wish(&["seed=linear(1,1000,1000)", "particles.count=linear(1,1000,1000)"]);
        assert!(wrong(&many).contains("too many"));
    }
}
