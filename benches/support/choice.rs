//! What the words of the command line choose.

const ENGINES: [&str; 3] = ["dsmc", "cba", "hsmc"];
const STATES: [&str; 5] = ["dilute", "gas", "dense", "clustered", "heap"];
/// Numbers from here on are grains, those below are threads.
const FEWEST_GRAINS: usize = 1000;

/// The rows of the matrix, and how they are timed and written.
pub(crate) struct Choice {
    pub(crate) engines: Vec<&'static str>,
    pub(crate) dimensions: Vec<usize>,
    pub(crate) states: Vec<&'static str>,
    pub(crate) sizes: Vec<usize>,
    pub(crate) threads: Vec<usize>,
    pub(crate) rounds: usize,
    /// Collisions per particle and step.
    pub(crate) collisions: f64,
    pub(crate) csv: bool,
}

impl Choice {
    /// From the words of the command line; where none are of a kind, the usual ones of that kind.
    pub(crate) fn of(words: impl Iterator<Item = String>) -> Result<Self, String> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let mut choice = Choice {
            engines: Vec::new(),
            dimensions: Vec::new(),
            states: Vec::new(),
            sizes: Vec::new(),
            threads: Vec::new(),
            rounds: 5,
            collisions: 0.5,
            csv: false,
        };
        for word in words {
            choice.take(&word)?;
        }
        usual(&mut choice.engines, &ENGINES);
        usual(&mut choice.dimensions, &[2, 3]);
        usual(&mut choice.states, &["gas", "clustered", "heap"]);
        usual(&mut choice.sizes, &[100_000]);
        usual(&mut choice.threads, if cores > 1 { &[1, 2] } else { &[1] });
        Ok(choice)
    }

    fn take(&mut self, word: &str) -> Result<(), String> {
        if let Some(&engine) = ENGINES.iter().find(|&&engine| engine == word) {
            self.engines.push(engine);
        } else if let Some(&state) = STATES.iter().find(|&&state| state == word) {
            self.states.push(state);
        } else if let Ok(number) = word.parse::<usize>().map(|number| number.max(1)) {
            (if number < FEWEST_GRAINS { &mut self.threads } else { &mut self.sizes }).push(number);
        } else {
            match word.split_once('=').unwrap_or((word, "")) {
                ("2d", "") => self.dimensions.push(2),
                ("3d", "") => self.dimensions.push(3),
                ("--csv", "") => self.csv = true,
                // `cargo bench` says so to every bench.
                ("--bench", "") => {}
                ("--rounds", number) => self.rounds = read(word, number)?,
                ("--collisions", number) => self.collisions = read(word, number)?,
                _ => {
                    return Err(format!(
                        "`{word}` is no {ENGINES:?}, no {STATES:?}, no 2d or 3d, no number of grains (from \
                         {FEWEST_GRAINS} on) or threads, no --rounds=5, --collisions=0.5 or --csv"
                    ));
                }
            }
        }
        Ok(())
    }
}

fn usual<T: Copy>(chosen: &mut Vec<T>, values: &[T]) {
    if chosen.is_empty() {
        chosen.extend(values);
    }
}

fn read<T: std::str::FromStr + PartialOrd + Default>(word: &str, number: &str) -> Result<T, String> {
    let number = number.parse().ok().filter(|number| *number > T::default());
    number.ok_or_else(|| format!("`{word}` needs a number above 0"))
}
