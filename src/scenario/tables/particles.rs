//! `[particles]`.

use crate::law::restitution::{Constant, RestitutionLaw, VelocityDependent};
use crate::matter::grain::Grain;
use crate::scenario::bound::{Bound, rounded};
use crate::scenario::reader::Section;
use crate::scenario::schema;
use crate::space::Vector;

/// The most grains, present and poured together, that identities can name.
pub(in crate::scenario) const MOST_GRAINS: u64 = 4_000_000_000;

/// `[particles]` as read; `None` for what is wrong.
#[derive(Clone, Debug)]
pub(in crate::scenario) struct ParticlesTable {
    pub(in crate::scenario) grain: Option<Grain>,
    pub(in crate::scenario) restitution: Option<RestitutionLaw>,
    pub(in crate::scenario) amount: Option<Amount>,
}

/// How many grains, and by which key.
#[derive(Clone, Copy, Debug)]
pub(in crate::scenario) enum Amount {
    Count(u64),
    VolumeFraction(f64),
}

impl Amount {
    /// The key that said so.
    pub(in crate::scenario) fn key(self) -> &'static str {
        match self {
            Amount::Count(_) => "count",
            Amount::VolumeFraction(_) => "volume_fraction",
        }
    }
}

/// Reads `[particles]`.
pub(in crate::scenario) fn read<V: Vector>(root: &Section<'_>) -> ParticlesTable {
    let particles = root.section("particles", schema::PARTICLES);
    if root.has("particles") && !particles.exists() {
        return ParticlesTable { grain: None, restitution: None, amount: None };
    }
    let diameter = particles.number("diameter", Bound::POSITIVE).or(1.0);
    let mass = particles.number("mass", Bound::POSITIVE).or(1.0);
    ParticlesTable {
        grain: diameter.zip(mass).map(|(diameter, mass)| Grain { diameter, mass }),
        restitution: restitution(&particles),
        amount: amount::<V>(&particles),
    }
}

fn amount<V: Vector>(particles: &Section<'_>) -> Option<Amount> {
    let densest = if V::DIMENSION == 2 {
        Bound::up_to(V::DENSEST_PACKING, "a number above 0 and at most 0.9069, the densest packing of disks")
    } else {
        Bound::up_to(
            V::DENSEST_PACKING,
            "a number above 0 and at most 0.7405, the densest packing of spheres",
        )
    };
    let count = particles.whole("count", 0, MOST_GRAINS).map(Amount::Count);
    let fraction = particles.number("volume_fraction", densest).map(Amount::VolumeFraction);
    match (particles.has("count"), particles.has("volume_fraction")) {
        (true, true) => {
            particles.mistake("volume_fraction", "stands beside count; keep one of the two");
            None
        }
        (false, false) => {
            particles.missing("count", "is missing, and so is volume_fraction; give one of the two");
            None
        }
        _ => count.optional()?.or(fraction.optional()?),
    }
}

fn restitution(particles: &Section<'_>) -> Option<RestitutionLaw> {
    const KEY: &str = "restitution";
    if !particles.item(KEY).is_some_and(|item| item.is_table_like()) {
        let constant = particles.number(KEY, Bound::SHARE);
        let constant = constant.required(particles, KEY, "give a number from 0 to 1, such as 0.9");
        return constant.map(|r| RestitutionLaw::Constant(Constant(r)));
    }
    let table = particles.section(KEY, schema::RESTITUTION);
    let law = table.choice("law", &[("velocity-dependent", ())]);
    let law = law.required(&table, "law", "write law = \"velocity-dependent\"");
    let r0 = table.number("r0", Bound::SHARE).required(&table, "r0", "give the restitution at the speed v0");
    let v0 = table.number("v0", Bound::POSITIVE).required(&table, "v0", "give the speed where the law bends");
    law.and(r0.zip(v0)).map(|(r0, v0)| RestitutionLaw::VelocityDependent(VelocityDependent { r0, v0 }))
}

/// The number of grains in the box of `size`, and what is wrong with it.
pub(in crate::scenario) fn count<V: Vector>(amount: Amount, grain: Grain, size: V) -> Result<u32, String> {
    let places = size.product() / grain.volume::<V>();
    let count = match amount {
        Amount::Count(count) => count as f64,
        Amount::VolumeFraction(fraction) => (fraction * places).round(),
    };
    if count > MOST_GRAINS as f64 {
        return Err(format!(
            "makes {} grains, more than {MOST_GRAINS}; shrink domain.size or ν",
            rounded(count)
        ));
    }
    if matches!(amount, Amount::VolumeFraction(_)) && count == 0.0 {
        return Err(
            "makes less than half a grain in this box; enlarge domain.size or give a count".to_owned()
        );
    }
    let fraction = count / places;
    if fraction > V::DENSEST_PACKING {
        let most = (V::DENSEST_PACKING * places).floor();
        return Err(format!(
            "{count} grains fill {} of the box, more than the densest packing {:.4}; at most {most} fit",
            rounded(fraction),
            V::DENSEST_PACKING
        ));
    }
    Ok(count as u32)
}
