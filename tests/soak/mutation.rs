//! Texts and bytes that are nearly right: one or a few wounds in something sound.

use super::draw::Dice;

/// Words that go where numbers were.
const NUMBERS: [&str; 22] = [
    "0",
    "-0.0",
    "-1",
    "1",
    "2",
    "3",
    "1e-40",
    "1e-41",
    "1e40",
    "1e41",
    "1e308",
    "1e-308",
    "5e-324",
    "nan",
    "-inf",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "0.9069",
    "1e9",
    "\"\"",
];
/// Words that go anywhere.
const WORDS: [&str; 24] = [
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    "\"",
    "'",
    "\n",
    "#",
    ".",
    "[[",
    "]]",
    "\u{feff}",
    "\u{0}",
    "é",
    "true",
    "[particles]\n",
    "[run]\n",
    "gravity = [0.0, -1.0]\n",
    "engine.kind = \"hsmc\"\n",
    "x.lower = \"open\"\n",
    "log(",
    "1979-05-27",
];
const BYTES: [u8; 8] = [0, 1, 0x7f, 0x80, 0xff, 0xfe, b'\n', b'"'];

/// `text` with one to four wounds; `others` give pieces.
pub(crate) fn text(dice: &mut Dice, text: &str, others: &[String]) -> String {
    let mut text = text.to_owned();
    for _ in 0..1 + dice.below(4) {
        text = match dice.below(8) {
            0..=2 => with_number(dice, &text),
            3 => without_line(dice, &text),
            4 => with_line_of_another(dice, &text, others),
            5 => with_word(dice, &text),
            6 => String::from_utf8_lossy(&bytes(dice, text.as_bytes())).into_owned(),
            _ => with_lines_swapped(dice, &text),
        };
    }
    text
}

/// `data` with one wound.
pub(crate) fn bytes(dice: &mut Dice, data: &[u8]) -> Vec<u8> {
    let mut data = data.to_vec();
    if data.is_empty() {
        return vec![dice.one_of(&BYTES)];
    }
    let at = dice.below(data.len());
    let end = (at + 1 + dice.below(32)).min(data.len());
    match dice.below(7) {
        0 => data[at] ^= 1 << dice.below(8),
        1 => data[at] = dice.one_of(&BYTES),
        2 => data.truncate(at),
        3 => drop(data.drain(at..end)),
        4 => {
            let piece = data[at..end].to_vec();
            let to = dice.below(data.len());
            drop(data.splice(to..to, piece));
        }
        5 => data.insert(at, dice.one_of(&BYTES)),
        _ => data[at..end].fill(dice.one_of(&BYTES)),
    }
    data
}

/// A number of the text, somewhere, becomes another one.
fn with_number(dice: &mut Dice, text: &str) -> String {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    let starts: Vec<usize> = text
        .char_indices()
        .filter(|&(at, c)| is_part(c) && !text[..at].chars().next_back().is_some_and(is_part))
        .map(|(at, _)| at)
        .collect();
    if starts.is_empty() {
        return text.to_owned();
    }
    let start = dice.one_of(&starts);
    let length = text[start..].find(|c: char| !is_part(c)).unwrap_or(text.len() - start);
    format!("{}{}{}", &text[..start], dice.one_of(&NUMBERS), &text[start + length..])
}

fn lines(text: &str) -> Vec<&str> {
    text.split_inclusive('\n').collect()
}

fn without_line(dice: &mut Dice, text: &str) -> String {
    let mut lines = lines(text);
    if !lines.is_empty() {
        lines.remove(dice.below(lines.len()));
    }
    lines.concat()
}

fn with_line_of_another(dice: &mut Dice, text: &str, others: &[String]) -> String {
    let mut mine = lines(text);
    let other = &others[dice.below(others.len())];
    let theirs = lines(other);
    if !theirs.is_empty() {
        mine.insert(dice.below(mine.len() + 1), theirs[dice.below(theirs.len())]);
    }
    mine.concat()
}

fn with_lines_swapped(dice: &mut Dice, text: &str) -> String {
    let mut lines = lines(text);
    if lines.len() > 1 {
        let (one, other) = (dice.below(lines.len()), dice.below(lines.len()));
        lines.swap(one, other);
    }
    lines.concat()
}

fn with_word(dice: &mut Dice, text: &str) -> String {
    let places: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
    let at = dice.one_of(&places);
    format!("{}{}{}", &text[..at], dice.one_of(&WORDS), &text[at..])
}
