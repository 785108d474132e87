//! States that are nearly right: one number of a saved state becomes another one, where it stands, so that the message
//! remains one.

use std::ops::Range;

use super::draw::Dice;

const NUMBERS: [f64; 12] =
    [0.0, -0.0, -1.0, 1.0, 0.5, 1e-300, 5e-324, 1e300, -1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const WORDS: [u32; 12] = [0, 1, 2, 3, 7, 8, 20, 255, 65_536, 0x7fff_ffff, u32::MAX - 1, u32::MAX];

/// A field of a message, as it stands in its bytes.
enum Field {
    /// An integer, in as many bytes as it needs.
    Integer(Range<usize>),
    /// A floating-point number.
    Number(Range<usize>),
    /// Bytes, text, or a message within.
    Bytes(Range<usize>),
}

/// The saved state `data` with one to three numbers changed.
pub(crate) fn wounded(dice: &mut Dice, data: &[u8]) -> Vec<u8> {
    let mut data = data.to_vec();
    for _ in 0..1 + dice.below(3) {
        let whole = 0..data.len();
        wound(dice, &mut data, whole);
    }
    data
}

fn wound(dice: &mut Dice, data: &mut [u8], place: Range<usize>) {
    let Some(fields) = fields(data, place).filter(|fields| !fields.is_empty()) else { return };
    match &fields[dice.below(fields.len())] {
        Field::Integer(place) => {
            // What says that more bytes follow stays.
            let value = dice.one_of(&[0, 1, 2, 0x7f, 0x7e]);
            data[place.clone()].iter_mut().for_each(|byte| *byte = *byte & 0x80 | value);
        }
        Field::Number(place) => number(dice, &mut data[place.clone()]),
        Field::Bytes(place) if place.len() < 4 => {}
        Field::Bytes(place) => match dice.below(5) {
            0 | 1 => wound(dice, data, place.clone()),
            2 | 3 if place.len() >= 8 => {
                let place = within::<8>(dice, place);
                number(dice, &mut data[place]);
            }
            _ => {
                let place = within::<4>(dice, place);
                word(dice, &mut data[place]);
            }
        },
    }
}

/// One of the words of N bytes in `place`.
fn within<const N: usize>(dice: &mut Dice, place: &Range<usize>) -> Range<usize> {
    let at = place.start + dice.below(place.len() / N) * N;
    at..at + N
}

fn number(dice: &mut Dice, bytes: &mut [u8]) {
    let Ok(old) = bytes.try_into().map(f64::from_le_bytes) else { return };
    let new = match dice.below(3) {
        0 => old * dice.one_of(&[-1.0, 2.0, 1.0 + 1e-12, 1.001]),
        1 => old + dice.one_of(&[-1.0, 1.0, 1e-9, 8.0]),
        _ => dice.one_of(&NUMBERS),
    };
    bytes.copy_from_slice(&new.to_le_bytes());
}

fn word(dice: &mut Dice, bytes: &mut [u8]) {
    let Ok(old) = bytes.try_into().map(u32::from_le_bytes) else { return };
    let new = match dice.below(3) {
        0 => old.wrapping_add(dice.one_of(&[1, 2, 8, u32::MAX])),
        _ => dice.one_of(&WORDS),
    };
    bytes.copy_from_slice(&new.to_le_bytes());
}

/// The fields of the message at `place` in `data`; `None` where there is none.
fn fields(data: &[u8], place: Range<usize>) -> Option<Vec<Field>> {
    let (mut at, mut fields) = (place.start, Vec::new());
    while at < place.end {
        let (key, after) = integer(data, at, place.end)?;
        let end;
        match key & 7 {
            0 => {
                end = integer(data, after, place.end)?.1;
                fields.push(Field::Integer(after..end));
            }
            1 => {
                end = after + 8;
                fields.push(Field::Number(after..end));
            }
            2 => {
                let (length, begin) = integer(data, after, place.end)?;
                end = begin.checked_add(usize::try_from(length).ok()?)?;
                fields.push(Field::Bytes(begin..end));
            }
            _ => return None,
        }
        at = end;
        if at > place.end {
            return None;
        }
    }
    Some(fields)
}

/// The integer that begins at `at`, and where it ends.
fn integer(data: &[u8], at: usize, end: usize) -> Option<(u64, usize)> {
    let mut value = 0;
    for (k, &byte) in data.get(at..end)?.iter().take(10).enumerate() {
        value |= u64::from(byte & 0x7f).checked_shl(7 * k as u32)?;
        if byte & 0x80 == 0 {
            return Some((value, at + k + 1));
        }
    }
    None
}
