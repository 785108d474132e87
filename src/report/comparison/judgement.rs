//! What came out, quantity by quantity: of a profile that was taken at several times, the time that speaks loudest.

use crate::comparison::model::{Compared, Comparison, Difference, Verdict};

/// One engine in one quantity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finding<'a> {
    /// Name of the measure, column or figure.
    pub quantity: &'a str,
    /// Name of the column, where the measure has several.
    pub column: &'a str,
    /// Place of the engine.
    pub contestant: usize,
    /// When, for a profile [time].
    pub time: Option<f64>,
    /// How it stands to the reference.
    pub difference: &'a Difference,
}

/// How one engine stands to the reference, in all quantities.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Judgement {
    /// What the engine is called.
    pub engine: String,
    /// Quantities in which it agrees.
    pub agreeing: usize,
    /// A sentence for each quantity in which it differs, the farthest apart first.
    pub differing: Vec<String>,
    /// Quantities without errors to judge by.
    pub unknown: usize,
    /// A sentence for each figure that is not steady, in the engine or in the reference.
    pub not_steady: Vec<String>,
}

impl Judgement {
    /// Quantities that were compared.
    pub fn quantities(&self) -> usize {
        self.agreeing + self.differing.len() + self.unknown + self.not_steady.len()
    }
}

/// Every engine but the reference.
pub fn judgements(comparison: &Comparison) -> Vec<Judgement> {
    let findings = findings(comparison);
    let others = (0..comparison.contestants.len()).filter(|place| *place != comparison.reference);
    others
        .map(|place| {
            let of = |verdict: Verdict| {
                let own = findings.iter().filter(move |finding| finding.contestant == place);
                own.filter(move |finding| finding.difference.verdict == verdict)
            };
            let mut differing: Vec<&Finding<'_>> = of(Verdict::Differs).collect();
            differing.sort_by(|a, b| loudness(b.difference).total_cmp(&loudness(a.difference)));
            Judgement {
                engine: comparison.contestants[place].label.clone(),
                agreeing: of(Verdict::Agrees).count(),
                differing: differing.iter().map(|finding| finding.difference.sentence.clone()).collect(),
                unknown: of(Verdict::Unknown).count(),
                not_steady: of(Verdict::NotSteady)
                    .map(|finding| finding.difference.sentence.clone())
                    .collect(),
            }
        })
        .collect()
}

/// One finding for every quantity and engine that were compared, quantity by quantity.
pub(super) fn findings(comparison: &Comparison) -> Vec<Finding<'_>> {
    let mut findings: Vec<Finding<'_>> = Vec::new();
    for compared in &comparison.series {
        findings.extend(of_curve(compared));
    }
    for stages in stages(comparison) {
        for place in 0..comparison.contestants.len() {
            let all = stages.iter().flat_map(|compared| of_curve(compared));
            let own = all.filter(|finding| finding.contestant == place);
            findings.extend(own.max_by(|a, b| loudness(a.difference).total_cmp(&loudness(b.difference))));
        }
    }
    for figure in &comparison.figures {
        let own = figure.differences.iter().enumerate();
        findings.extend(own.filter_map(|(contestant, difference)| {
            let difference = difference.as_ref()?;
            Some(Finding { quantity: &figure.name, column: "", contestant, time: None, difference })
        }));
    }
    findings
}

fn of_curve(compared: &Compared) -> impl Iterator<Item = Finding<'_>> {
    let column = if compared.ordinate.name == compared.name { "" } else { &compared.ordinate.name };
    compared.differences.iter().enumerate().filter_map(move |(contestant, difference)| {
        let (difference, time) = (difference.as_ref()?, compared.time);
        Some(Finding { quantity: &compared.name, column, contestant, time, difference })
    })
}

/// Profiles of the same column, all its times together, in the order of the comparison.
pub(super) fn stages(comparison: &Comparison) -> Vec<Vec<&Compared>> {
    let mut groups: Vec<Vec<&Compared>> = Vec::new();
    for compared in &comparison.profiles {
        let is_same = |group: &&mut Vec<&Compared>| {
            group[0].name == compared.name && group[0].ordinate.name == compared.ordinate.name
        };
        match groups.iter_mut().find(is_same) {
            Some(group) => group.push(compared),
            None => groups.push(vec![compared]),
        }
    }
    groups
}

/// How far apart two are beside the threshold: above 1 where they differ, below 0 where nobody knows.
fn loudness(difference: &Difference) -> f64 {
    let share = difference.most.map_or(0.0, |peak| peak.standard_errors / difference.threshold);
    let share = if share.is_finite() { share } else { f64::MAX };
    match difference.verdict {
        Verdict::Differs => share.max(1.0),
        Verdict::Agrees => share.min(1.0),
        Verdict::Unknown | Verdict::NotSteady => -1.0,
    }
}
