//! `[engine]`.

use super::calibrated;
use crate::law::impact::ImpactLaw;
use crate::law::piecewise::PiecewiseLinear;
use crate::scenario::bound::Bound;
use crate::scenario::model::{
    Admission, Cure, DisplacementRule, EngineKind, EnskogFactor, EventDrivenRules, Structure, TimeStep,
    Transfer,
};
use crate::scenario::reader::{Section, kind};
use crate::scenario::schema;
use crate::space::Vector;

/// `[engine]` as read; `None` for what is wrong.
#[derive(Clone, Debug)]
pub(in crate::scenario) struct EngineTable {
    pub(in crate::scenario) kind: Option<EngineKind>,
    /// The wish; `Some(None)` for the default.
    pub(in crate::scenario) cell_size: Option<Option<f64>>,
    pub(in crate::scenario) time_step: Option<TimeStep>,
    pub(in crate::scenario) enskog_factor: Option<EnskogFactor>,
    pub(in crate::scenario) transfer: Option<Transfer>,
    pub(in crate::scenario) impact_law: Option<ImpactLaw>,
    pub(in crate::scenario) hsmc: HsmcTable,
    pub(in crate::scenario) event_driven: Option<EventDrivenRules>,
}

/// `[engine.hsmc]` as read; `None` for what is wrong.
#[derive(Clone, Debug)]
pub(in crate::scenario) struct HsmcTable {
    pub(in crate::scenario) maximum_volume_fraction: Option<f64>,
    pub(in crate::scenario) cell_restitution: Option<CellRestitution>,
    pub(in crate::scenario) sweeps: Option<u32>,
    pub(in crate::scenario) admission: Option<Admission>,
    pub(in crate::scenario) displacement: Option<DisplacementRule>,
    /// `Some(None)` where only a lack of room keeps grains out.
    pub(in crate::scenario) entry_probability: Option<Option<PiecewiseLinear>>,
}

/// How the restitution of cell–cell collisions is given.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenario) enum CellRestitution {
    /// That of the grains.
    AsGrains,
    /// A number.
    Number(f64),
    /// That of the grains, but no less than this.
    AtLeast(f64),
}

/// Engines of the field that this version does not have: no slips of the pen.
const ELSEWHERE: &[&str] = &["cuba", "esmc", "md", "dem", "bd"];
/// Other names of the event-driven engine.
const EVENT_DRIVEN_NAMES: &[&str] = &["event_driven", "edmd", "ed"];

/// Reads `[engine]`.
pub(in crate::scenario) fn read<V: Vector>(root: &Section<'_>) -> EngineTable {
    let engine = root.section("engine", schema::ENGINE);
    let kinds = EngineKind::ALL.map(|kind| (kind.name(), kind));
    let names = kinds.map(|(name, _)| format!("\"{name}\"")).join(", ");
    let named = engine.item("kind").and_then(|item| item.as_str());
    let kind = if root.has("engine") && !engine.exists() {
        None
    } else if let Some(name) = named.filter(|name| ELSEWHERE.contains(name)) {
        engine.mistake("kind", format!("\"{name}\" is not available in this version; choose one of {names}"));
        None
    } else if let Some(name) = named.filter(|name| EVENT_DRIVEN_NAMES.contains(name)) {
        engine.mistake("kind", format!("\"{name}\" is not known; did you mean `event-driven`?"));
        None
    } else {
        engine.choice("kind", &kinds).required(&engine, "kind", &format!("choose one of {names}"))
    };
    EngineTable {
        kind,
        cell_size: engine.number("cell_size", Bound::POSITIVE).optional(),
        time_step: time_step(&engine),
        enskog_factor: engine
            .choice(
                "enskog_factor",
                &[
                    ("local", EnskogFactor::Local),
                    ("half-grain", EnskogFactor::HalfGrain),
                    ("smoothed", EnskogFactor::Smoothed),
                ],
            )
            .or(EnskogFactor::Local),
        transfer: engine
            .choice(
                "transfer",
                &[("momentum-change", Transfer::MomentumChange), ("corrected", Transfer::Corrected)],
            )
            .or(Transfer::MomentumChange),
        impact_law: calibrated::impact_law(&engine),
        hsmc: hsmc::<V>(&engine),
        event_driven: event_driven(&engine),
    }
}

fn time_step(engine: &Section<'_>) -> Option<TimeStep> {
    const KEY: &str = "time_step";
    const FORMS: &str = "{ collisions_per_particle = 0.1 }, { crossing = 0.2 } or { fixed = 1e-3 }";
    let Some(item) = engine.item(KEY) else {
        return Some(TimeStep::CollisionsPerParticle(0.1));
    };
    if !item.is_table_like() {
        engine.mistake(KEY, format!("must say how the step is chosen, not be {}; write {FORMS}", kind(item)));
        return None;
    }
    let form = engine.section(KEY, schema::TIME_STEP);
    let collisions = Bound::up_to(TimeStep::MOST_COLLISIONS, "a number above 0 and at most 2");
    let crossing = Bound::up_to(1.0, "a fraction of a cell above 0 and at most 1");
    let fixed = form.number("fixed", Bound::POSITIVE).map(TimeStep::Fixed);
    let collisions = form.number("collisions_per_particle", collisions).map(TimeStep::CollisionsPerParticle);
    let crossing = form.number("crossing", crossing).map(TimeStep::Crossing);
    let given = schema::TIME_STEP.iter().filter(|key| form.has(key)).count();
    if given != 1 {
        form.mistake_here(format!("takes exactly one form, not {given}; write {FORMS}"));
        return None;
    }
    fixed.optional()?.or(collisions.optional()?).or(crossing.optional()?)
}

fn hsmc<V: Vector>(engine: &Section<'_>) -> HsmcTable {
    let table = engine.section("hsmc", schema::HSMC);
    let densest = if V::DIMENSION == 2 {
        Bound::up_to(V::DENSEST_PACKING, "a number above 0 and at most 0.9069, the densest packing of disks")
    } else {
        Bound::up_to(
            V::DENSEST_PACKING,
            "a number above 0 and at most 0.7405, the densest packing of spheres",
        )
    };
    HsmcTable {
        maximum_volume_fraction: table.number("maximum_volume_fraction", densest).or(V::RANDOM_CLOSE_PACKING),
        cell_restitution: cell_restitution(&table),
        sweeps: table.whole("sweeps", 1, 1000).or(1).map(|sweeps| sweeps as u32),
        admission: table
            .choice("admission", &[("strict", Admission::Strict), ("thesis", Admission::Thesis)])
            .or(Admission::Strict),
        displacement: table
            .choice(
                "displacement",
                &[("paired", DisplacementRule::Paired), ("thesis", DisplacementRule::Thesis)],
            )
            .or(DisplacementRule::Paired),
        entry_probability: calibrated::entry_probability(&table),
    }
}

fn cell_restitution(hsmc: &Section<'_>) -> Option<CellRestitution> {
    const KEY: &str = "cell_restitution";
    if hsmc.item(KEY).is_some_and(|item| item.is_table_like()) {
        let form = hsmc.section(KEY, &["at_least"]);
        let least = form.number("at_least", Bound::SHARE);
        return least.required(&form, "at_least", "write { at_least = 0.9 }").map(CellRestitution::AtLeast);
    }
    hsmc.number(KEY, Bound::SHARE).map(CellRestitution::Number).or(CellRestitution::AsGrains)
}

fn event_driven(engine: &Section<'_>) -> Option<EventDrivenRules> {
    let table = engine.section("event_driven", schema::EVENT_DRIVEN);
    let structure = table
        .choice(
            "structure",
            &[
                ("automatic", Structure::Automatic),
                ("cells", Structure::Cells),
                ("neighbour-lists", Structure::NeighbourLists),
            ],
        )
        .or(Structure::Automatic);
    let cure = cure(&table);
    Some(EventDrivenRules { structure: structure?, cure: cure? })
}

/// Reads `engine.event_driven.collapse`.
fn cure(event_driven: &Section<'_>) -> Option<Cure> {
    const KEY: &str = "collapse";
    const FORMS: &str = "\"none\", or a table of contact_time, elastic_below, rotation or several of them, such as \
                         { contact_time = 1e-4 }";
    let Some(item) = event_driven.item(KEY) else { return Some(Cure::default()) };
    if !item.is_table_like() {
        if item.as_str() == Some("none") {
            return Some(Cure::default());
        }
        event_driven.mistake(KEY, format!("must be {FORMS}, not {}", kind(item)));
        return None;
    }
    let table = event_driven.section(KEY, schema::COLLAPSE);
    let rotation = Bound::up_to(90.0, "an angle in degrees, above 0 and at most 90");
    let elastic_below = table.number("elastic_below", Bound::POSITIVE).optional();
    let contact_time = table.number("contact_time", Bound::POSITIVE).optional();
    let rotation = table.number("rotation", rotation).map(f64::to_radians).optional();
    if item.as_table_like().is_some_and(|table| table.is_empty()) {
        event_driven.mistake(KEY, format!("names no cure; write {FORMS}"));
        return None;
    }
    Some(Cure { elastic_below: elastic_below?, contact_time: contact_time?, rotation: rotation? })
}
