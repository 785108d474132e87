//! Whether work is worth sharing among threads. The outcome is the same either way.

use rayon::prelude::*;

use crate::matter::sort::FEWEST_GRAINS;

/// `work` done on every item, results in the order of the items; shared among threads when
/// there are enough `grains`.
pub(crate) fn map<T: Send, R: Send>(
    grains: usize,
    items: Vec<T>,
    work: impl Fn(T) -> R + Sync + Send,
) -> Vec<R> {
    if grains < FEWEST_GRAINS {
        items.into_iter().map(work).collect()
    } else {
        items.into_par_iter().map(work).collect()
    }
}

/// `work` done on every one of a few large items, by a thread each.
pub(crate) fn each<T: Send, R: Send>(
    items: impl ExactSizeIterator<Item = T>,
    work: impl Fn(T) -> R + Sync + Send,
) -> Vec<R> {
    if items.len() < 2 {
        items.map(work).collect()
    } else {
        let items: Vec<T> = items.collect();
        items.into_par_iter().with_max_len(1).map(work).collect()
    }
}

/// The same over the items of a slice.
pub(crate) fn map_slice<T: Sync, R: Send>(
    grains: usize,
    items: &[T],
    work: impl Fn(&T) -> R + Sync + Send,
) -> Vec<R> {
    if grains < FEWEST_GRAINS {
        items.iter().map(work).collect()
    } else {
        items.par_iter().with_min_len(64).map(work).collect()
    }
}

/// The same, with the place of each item.
pub(crate) fn map_numbered<T: Sync, R: Send>(
    grains: usize,
    items: &[T],
    work: impl Fn((usize, &T)) -> R + Sync + Send,
) -> Vec<R> {
    if grains < FEWEST_GRAINS {
        items.iter().enumerate().map(work).collect()
    } else {
        items.par_iter().enumerate().with_min_len(64).map(work).collect()
    }
}
