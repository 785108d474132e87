//! The calendar of events: a bounded queue with a page for each short span of time.
//!
//! Time is divided into pages of equal width; an event is written on the page of its time, unsorted
//! (Paul 2007). Only the page that is open is sorted. An entry whose grain has changed its plan since
//! is not searched for and erased: it is recognised and dropped when its page comes up. The pages of one
//! year exist at a time; what lies beyond is written down when the next year begins.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::body::Plan;

/// Events that a page should hold: enough to sort them together, few enough to stay in the cache.
const EVENTS_PER_PAGE: f64 = 128.0;
/// Fewest pages of a year.
const FEWEST_PAGES: usize = 16;
/// Events on a sheet of paper.
const EVENTS_PER_SHEET: usize = 32;
/// No sheet.
const NONE: u32 = u32::MAX;

/// An event of one grain on a page.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Entry {
    /// When, after the beginning of the year [time].
    pub(super) time: f64,
    /// Identity of the grain, which decides between events of the same time.
    pub(super) id: u32,
    /// Its row.
    pub(super) row: u32,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.time.total_cmp(&other.time).then(self.id.cmp(&other.id))
    }
}
impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Entry {}

/// A stack of sheets.
#[derive(Clone, Copy, Debug)]
struct Page {
    /// The last sheet, which is being filled.
    sheet: u32,
    /// Entries on it.
    filled: u32,
}

/// All sheets.
#[derive(Debug, Default)]
struct Paper {
    /// `[sheet]`.
    sheets: Vec<[Entry; EVENTS_PER_SHEET]>,
    /// `[sheet]`: the one below it, on its page or on the pile of blank ones.
    below: Vec<u32>,
    /// The first blank sheet.
    blank: u32,
}

/// The pages of one year.
#[derive(Debug, Default)]
pub(super) struct Calendar {
    /// Length of the year [time].
    year: f64,
    /// Pages per time [1/time].
    pages_per_time: f64,
    pages: Vec<Page>,
    paper: Paper,
    /// Number of the page that is open.
    open_page: usize,
    /// The open page, latest event first.
    open: Vec<Entry>,
    /// Events written on the open page after it was opened.
    late: BinaryHeap<Reverse<Entry>>,
    usage: Usage,
}

/// How the calendar was used since the year began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Pages opened.
    pub opened: u64,
    /// Entries on them.
    pub entries: u64,
    /// Entries that were written on the page that was open.
    pub late: u64,
}

impl Calendar {
    /// Begins a year of length `year` in which about `events` events will happen. All pages are empty.
    pub(super) fn begin(&mut self, year: f64, events: f64) {
        let pages = ((events / EVENTS_PER_PAGE) as usize).max(FEWEST_PAGES);
        self.pages.clear();
        self.pages.resize(pages, Page::EMPTY);
        self.paper.clear();
        self.year = year;
        self.pages_per_time = pages as f64 / year;
        self.open.clear();
        self.late.clear();
        self.open_page = 0;
        self.usage = Usage::default();
    }

    /// Length of the year [time].
    pub(super) fn year(&self) -> f64 {
        self.year
    }

    /// How it was used since the year began.
    pub(super) fn usage(&self) -> Usage {
        self.usage
    }

    /// Writes an event down, if it lies in this year.
    #[inline]
    pub(super) fn write(&mut self, entry: Entry) {
        if entry.time >= self.year {
            return;
        }
        // An event that is due at once may lie a rounding before the open page.
        let page = (entry.time * self.pages_per_time) as usize;
        if page > self.open_page {
            // The last page takes what rounding would put behind it.
            let last = self.pages.len() - 1;
            self.pages[page.min(last)].push(entry, &mut self.paper);
        } else {
            self.usage.late += 1;
            self.late.push(Reverse(entry));
        }
    }

    /// An event that lies `ahead` places behind the next one, as far as is known.
    #[inline(always)]
    pub(super) fn upcoming(&self, ahead: usize) -> Option<Entry> {
        self.open.len().checked_sub(ahead + 1).map(|place| self.open[place])
    }

    /// Takes the next event that is still planned; `None` when the year is over.
    #[inline]
    pub(super) fn next(&mut self, plans: &[Plan]) -> Option<Entry> {
        loop {
            let entry = match (self.open.last(), self.late.peek()) {
                (Some(open), Some(Reverse(late))) if late < open => self.late.pop().map(|Reverse(late)| late),
                (None, Some(_)) => self.late.pop().map(|Reverse(late)| late),
                (Some(_), _) => self.open.pop(),
                (None, None) => {
                    if self.turn_page(plans) {
                        continue;
                    }
                    return None;
                }
            };
            if let Some(entry) = entry.filter(|entry| is_planned(entry, plans)) {
                return Some(entry);
            }
        }
    }

    /// Opens the next page that holds anything; false at the end of the year.
    fn turn_page(&mut self, plans: &[Plan]) -> bool {
        while self.open_page + 1 < self.pages.len() {
            self.open_page += 1;
            let page = std::mem::replace(&mut self.pages[self.open_page], Page::EMPTY);
            if page.sheet == NONE {
                continue;
            }
            page.open(&mut self.paper, &mut self.open);
            self.usage.opened += 1;
            self.usage.entries += self.open.len() as u64;
            // All plans are looked at together, so that they travel from memory together.
            self.open.retain(|entry| is_planned(entry, plans));
            self.open.sort_unstable_by(|a, b| b.cmp(a));
            if !self.open.is_empty() {
                return true;
            }
        }
        false
    }
}

impl Page {
    const EMPTY: Page = Page { sheet: NONE, filled: EVENTS_PER_SHEET as u32 };

    #[inline(always)]
    fn push(&mut self, entry: Entry, paper: &mut Paper) {
        if self.filled == EVENTS_PER_SHEET as u32 {
            *self = Page { sheet: paper.take(self.sheet), filled: 0 };
        }
        paper.sheets[self.sheet as usize][self.filled as usize] = entry;
        self.filled += 1;
    }

    /// Moves all entries to `entries`, which is empty, and gives the sheets back.
    fn open(self, paper: &mut Paper, entries: &mut Vec<Entry>) {
        let Page { mut sheet, filled } = self;
        let mut written = &paper.sheets[sheet as usize][..filled as usize];
        loop {
            entries.extend_from_slice(written);
            let below = std::mem::replace(&mut paper.below[sheet as usize], paper.blank);
            paper.blank = sheet;
            if below == NONE {
                return;
            }
            sheet = below;
            written = &paper.sheets[sheet as usize];
        }
    }
}

impl Paper {
    /// All sheets are blank.
    fn clear(&mut self) {
        self.sheets.clear();
        self.below.clear();
        self.blank = NONE;
    }

    /// A blank sheet, put on top of `below`.
    fn take(&mut self, below: u32) -> u32 {
        let sheet = self.blank;
        if sheet == NONE {
            self.sheets.push([Entry::default(); EVENTS_PER_SHEET]);
            self.below.push(below);
            return (self.sheets.len() - 1) as u32;
        }
        self.blank = std::mem::replace(&mut self.below[sheet as usize], below);
        sheet
    }
}

/// Whether the grain of `entry` still plans this event.
#[inline(always)]
fn is_planned(entry: &Entry, plans: &[Plan]) -> bool {
    plans[entry.row as usize].time == entry.time
}
