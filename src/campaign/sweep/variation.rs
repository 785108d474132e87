//! `--vary`: which keys of a scenario move, and through which values.

/// Most values of one `--vary`.
const MOST_VALUES: usize = 1000;
/// How to write one, for error texts.
const FORMS: &str = "write key=[a, b, c], key=linear(first, last, count) or key=log(first, last, count)";

/// Keys that move together, each with as many values as the others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Variation {
    /// At least one.
    pub(super) keys: Vec<VariedKey>,
}

/// A key and the values that it takes one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct VariedKey {
    /// The path as `--set` takes it, such as `gravity[1]`.
    pub(super) path: String,
    /// Texts of the values as `--set` takes them; at least one.
    pub(super) values: Vec<String>,
}

impl Variation {
    /// Reads `key=[…]`, or several joined by ` + `.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let keys = split(text, '+')?.into_iter().map(VariedKey::parse).collect::<Result<Vec<_>, _>>()?;
        let first = &keys[0];
        if let Some(other) = keys.iter().find(|key| key.values.len() != first.values.len()) {
            return Err(format!(
                "`{}` has {} and `{}` has {}; keys that move together need equally many",
                first.path,
                counted(first.values.len()),
                other.path,
                counted(other.values.len())
            ));
        }
        let variation = Variation { keys };
        for k in 1..variation.len() {
            if let Some(twin) = (0..k).find(|&j| variation.is_same(j, k)) {
                let value = &variation.leader().values[k];
                return Err(format!(
                    "value {} is value {} again ({value}); leave it out, or repeat with --replicas",
                    k + 1,
                    twin + 1
                ));
            }
        }
        Ok(variation)
    }

    /// How many values each key has.
    pub(super) fn len(&self) -> usize {
        self.keys[0].values.len()
    }

    /// Whether two places have the same values, however they are written.
    fn is_same(&self, one: usize, other: usize) -> bool {
        let same = |a: &str, b: &str| a == b || number(a).is_some_and(|a| Some(a) == number(b));
        self.settings(one).zip(self.settings(other)).all(|(one, other)| same(one.1, other.1))
    }

    /// Paths with their values at `place`.
    pub(super) fn settings(&self, place: usize) -> impl Iterator<Item = (&str, &str)> {
        self.keys.iter().map(move |key| (key.path.as_str(), key.values[place].as_str()))
    }

    /// The key that names the values and is plotted against: the first whose values are all positive numbers, else
    /// the first of numbers, else the first.
    pub(super) fn leader(&self) -> &VariedKey {
        let all = |key: &&VariedKey, test: fn(f64) -> bool| {
            key.numbers().is_some_and(|numbers| numbers.into_iter().all(test))
        };
        let positive = self.keys.iter().find(|key| all(key, |x| x > 0.0));
        positive.or_else(|| self.keys.iter().find(|key| all(key, |_| true))).unwrap_or(&self.keys[0])
    }
}

impl VariedKey {
    fn parse(text: &str) -> Result<Self, String> {
        let (path, values) =
            text.split_once('=').ok_or_else(|| format!("`{}` has no `=`; {FORMS}", text.trim()))?;
        let (path, values) = (path.trim().to_owned(), values.trim());
        let inside = |opening: &str, closing: char| values.strip_prefix(opening)?.strip_suffix(closing);
        let values = if let Some(list) = inside("[", ']') {
            listed(list)?
        } else if let Some(range) = inside("linear(", ')') {
            spread(range, |first, last, share| first + share * (last - first))?
        } else if let Some(range) = inside("log(", ')') {
            logarithmic(range)?
        } else {
            return Err(format!("`{values}` is no list of values; {FORMS}"));
        };
        match values.len() {
            0 => Err(format!("`{path}` has no values; {FORMS}")),
            1..=MOST_VALUES => Ok(VariedKey { path, values }),
            many => Err(format!("`{path}` has {many} values; give at most {MOST_VALUES}")),
        }
    }

    /// The values as numbers; `None` where one is none.
    pub(super) fn numbers(&self) -> Option<Vec<f64>> {
        self.values.iter().map(|value| number(value)).collect()
    }
}

/// The finite number that a TOML text is.
fn number(text: &str) -> Option<f64> {
    text.replace('_', "").parse().ok().filter(|number: &f64| number.is_finite())
}

fn counted(values: usize) -> String {
    if values == 1 { "1 value".to_owned() } else { format!("{values} values") }
}

/// The values of `a, b, c`, each as it is written: a list of TOML, or one whose texts may stand without quotation marks,
/// as those of `--set`. A comma may follow the last.
fn listed(list: &str) -> Result<Vec<String>, String> {
    if let Ok(toml_edit::Value::Array(array)) = format!("[{list}]").parse() {
        return Ok(array.iter().map(|value| value.clone().decorated("", "").to_string()).collect());
    }
    let mut values: Vec<String> =
        split(list, ',')?.into_iter().map(|value| value.trim().to_owned()).collect();
    if values.last().is_some_and(String::is_empty) {
        values.pop();
    }
    match values.iter().position(String::is_empty) {
        Some(k) => Err(format!("value {} of the list is missing between two commas", k + 1)),
        None => Ok(values),
    }
}

fn logarithmic(range: &str) -> Result<Vec<String>, String> {
    let ends: Vec<f64> =
        split(range, ',')?.into_iter().take(2).filter_map(|end| number(end.trim())).collect();
    if let [first, last] = ends[..]
        && first * last <= 0.0
    {
        return Err(format!("log({range}) needs ends of the same sign, not 0; use linear({range})"));
    }
    spread(range, |first, last, share| first * (last / first).powf(share))
}

/// `count` values from `first` to `last` of the text `first, last, count`; `place` says where a share of the way lies.
/// They are rounded to six digits, so that they can be read and written down.
fn spread(range: &str, place: impl Fn(f64, f64, f64) -> f64) -> Result<Vec<String>, String> {
    let parts = split(range, ',')?;
    let wrong = || format!("({range}) is no range; {FORMS}, with a count from 2 to {MOST_VALUES}");
    let [first, last, count] = parts[..] else { return Err(wrong()) };
    let count: usize = count.trim().parse().map_err(|_| wrong())?;
    let (Some(first), Some(last)) = (number(first.trim()), number(last.trim())) else { return Err(wrong()) };
    if !(2..=MOST_VALUES).contains(&count) {
        return Err(wrong());
    }
    let value = |k: usize| place(first, last, k as f64 / (count - 1) as f64);
    let rounded =
        |x: f64| format!("{x:.5e}").parse::<f64>().map_or_else(|_| x.to_string(), |x| x.to_string());
    Ok((0..count).map(|k| rounded(value(k))).collect())
}

/// `text` cut at every `mark` that stands outside of brackets and quotation marks; as in TOML, a backslash between double
/// quotation marks takes its meaning from the sign behind it.
fn split(text: &str, mark: char) -> Result<Vec<&str>, String> {
    let (mut parts, mut start, mut depth, mut quote) = (Vec::new(), 0, 0_i32, None);
    let mut is_escaped = false;
    for (at, c) in text.char_indices() {
        if std::mem::take(&mut is_escaped) {
            continue;
        }
        match (quote, c) {
            (Some('"'), '\\') => is_escaped = true,
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{' | '(') => depth += 1,
            (None, ']' | '}' | ')') => depth -= 1,
            (None, c) if c == mark && depth == 0 => {
                parts.push(&text[start..at]);
                start = at + c.len_utf8();
            }
            _ => {}
        }
    }
    if depth != 0 || quote.is_some() {
        return Err(format!(
            "a bracket or a quotation mark of `{}` has no partner; where the shell cuts a list at its blanks, quote the \
             whole: --vary 'key=[a, b]'",
            text.trim()
        ));
    }
    parts.push(&text[start..]);
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Variation::parse(text).unwrap().keys.remove(0).values
    }

    fn wrong(text: &str) -> String {
        Variation::parse(text).unwrap_err()
    }

    #[test]
    fn lists_keep_their_texts() {
        assert_eq!(values("a.b=[1, 2.50 ,3]"), ["1", "2.50", "3"]);
        assert_eq!(values("a = [[1, 2], { b = 'x,]' }, hsmc,]"), ["[1, 2]", "{ b = 'x,]' }", "hsmc"]);
        assert_eq!(values("a = [[1, 2], { b = 'x,]' },]"), ["[1, 2]", "{ b = 'x,]' }"]);
    }

    #[test]
    fn texts_of_toml_may_hold_any_sign() {
        assert_eq!(values(r#"title=["a\"b","c"]"#), [r#""a\"b""#, r#""c""#]);
        assert_eq!(values(r#"title=["a,]\\", 'b\', bare]"#), [r#""a,]\\""#, r#"'b\'"#, "bare"]);
        let both = Variation::parse(r#"title=["a\"] + b=[","x"] + c=[1, 2]"#).unwrap();
        assert_eq!(both.settings(1).collect::<Vec<_>>(), [("title", r#""x""#), ("c", "2")]);
    }

    #[test]
    fn ranges_have_round_ends() {
        assert_eq!(values("a=linear(0, 1, 5)"), ["0", "0.25", "0.5", "0.75", "1"]);
        assert_eq!(values("a=log(0.1, 100, 4)"), ["0.1", "1", "10", "100"]);
        assert_eq!(values("a=log(1, 2, 3)")[1], "1.41421");
        assert_eq!(values("a=log(-0.1, -10, 3)"), ["-0.1", "-1", "-10"]);
        assert!(wrong("a=log(0, 1, 3)").contains("same sign"));
        assert!(wrong("a=linear(0, 1, 1)").contains("no range"));
        assert!(wrong("a=linear(0, 1)").contains("no range"));
    }

    #[test]
    fn keys_move_together() {
        let both = Variation::parse("a[0]=[-1e+1,-2] + b[0]=[1,2]").unwrap();
        assert_eq!(both.settings(0).collect::<Vec<_>>(), [("a[0]", "-1e+1"), ("b[0]", "1")]);
        assert_eq!(both.leader().path, "b[0]");
        assert_eq!(Variation::parse("a=[x, y] + b=[-1, 2]").unwrap().leader().path, "b");
        assert!(wrong("a=[1, 2] + b=[1]").contains("`a` has 2 values and `b` has 1 value"));
    }

    #[test]
    fn mistakes_name_their_remedy() {
        assert!(wrong("a").contains("has no `=`"));
        assert!(wrong("a=3").contains("key=[a, b, c]"));
        assert!(wrong("a=[]").contains("no values"));
        assert!(wrong("a=[1,,2]").contains("value 2"));
        assert!(wrong("a=[1,2,1]").contains("value 3 is value 1 again"));
        assert!(wrong("a=[0.9,2,0.90]").contains("value 3 is value 1 again"));
        assert!(wrong("a=[1").contains("no partner"));
    }
}
