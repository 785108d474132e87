//! `[particles]`.

use crate::law::restitution::{Constant, RestitutionLaw, VelocityDependent};
use crate::law::roughness::Roughness;
use crate::matter::grain::Grain;
use crate::scenario::bound::{Bound, rounded};
use crate::scenario::reader::{Found, Section};
use crate::scenario::schema;
use crate::space::Vector;

/// The most grains, present and poured together, that identities can name.
pub(in crate::scenario) const MOST_GRAINS: u64 = 4_000_000_000;

/// The most species: each grain carries its own in a byte.
const MOST_SPECIES: usize = 255;

/// `[particles]` as read; `None` for what is wrong.
#[derive(Clone, Debug)]
pub(in crate::scenario) struct ParticlesTable {
    /// What grains are made of, with their shares: one kind, or the species.
    pub(in crate::scenario) matter: Option<Matter>,
    /// `Some(None)` for smooth grains.
    pub(in crate::scenario) roughness: Option<Option<Roughness>>,
    pub(in crate::scenario) restitution: Option<RestitutionLaw>,
    pub(in crate::scenario) amount: Option<Amount>,
}

/// The kinds of grains.
#[derive(Clone, Debug)]
pub(in crate::scenario) struct Matter {
    /// Diameter and mass of each kind `[kind]`, at least one.
    pub(in crate::scenario) kinds: Vec<Grain>,
    /// The fraction of the grains that each kind makes up `[kind]`; the sum is 1.
    pub(in crate::scenario) shares: Vec<f64>,
    /// Whether they were given as species.
    pub(in crate::scenario) are_species: bool,
}

impl Matter {
    /// Mean volume (2D: area) of a grain [lengthᴰ].
    pub(in crate::scenario) fn mean_volume<V: Vector>(&self) -> f64 {
        let one = |(grain, share): (&Grain, &f64)| grain.volume::<V>() * share;
        self.kinds.iter().zip(&self.shares).map(one).sum()
    }

    /// Diameter of the largest grain [length].
    pub(in crate::scenario) fn largest_diameter(&self) -> f64 {
        self.kinds.iter().map(|grain| grain.diameter).fold(0.0, f64::max)
    }

    /// Diameter and mass of each species `[species]`; empty where all grains are alike.
    pub(in crate::scenario) fn species(&self) -> Vec<Grain> {
        if self.are_species { self.kinds.clone() } else { Vec::new() }
    }

    /// How many of `count` grains are of each species `[species]`: exact shares rounded down, the remainder to
    /// the largest fractions; empty where all grains are alike.
    pub(in crate::scenario) fn species_counts(&self, count: u32) -> Vec<u32> {
        if !self.are_species {
            return Vec::new();
        }
        let exact: Vec<f64> = self.shares.iter().map(|share| share * f64::from(count)).collect();
        let mut counts: Vec<u32> = exact.iter().map(|number| *number as u32).collect();
        let mut ranking: Vec<usize> = (0..counts.len()).collect();
        ranking.sort_by(|&a, &b| exact[b].fract().total_cmp(&exact[a].fract()));
        // Rounding may have made one grain too many out of shares that fit exactly.
        let placed: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        let missing = u64::from(count).saturating_sub(placed) as usize;
        for &species in ranking.iter().cycle().take(missing) {
            counts[species] += 1;
        }
        counts
    }
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
        return ParticlesTable { matter: None, roughness: None, restitution: None, amount: None };
    }
    ParticlesTable {
        matter: matter(&particles),
        roughness: roughness::<V>(&particles),
        restitution: restitution(&particles),
        amount: amount::<V>(&particles),
    }
}

/// One kind of grains, or the species.
fn matter(particles: &Section<'_>) -> Option<Matter> {
    let diameter = particles.number("diameter", Bound::POSITIVE).or(1.0);
    let mass = particles.number("mass", Bound::POSITIVE).or(1.0);
    match particles.tables("species", schema::SPECIES) {
        Found::Missing => {
            let grain = Grain { diameter: diameter?, mass: mass? };
            Some(Matter { kinds: vec![grain], shares: vec![1.0], are_species: false })
        }
        Found::Wrong => None,
        Found::Value(tables) => species(particles, &tables),
    }
}

fn species(particles: &Section<'_>, tables: &[Section<'_>]) -> Option<Matter> {
    for key in ["diameter", "mass"] {
        if particles.has(key) {
            particles.mistake(key, "stands beside species, which have their own; leave it out");
            return None;
        }
    }
    if tables.len() > MOST_SPECIES {
        let message = format!("names {} species, more than {MOST_SPECIES}; merge some", tables.len());
        particles.mistake("species", message);
        return None;
    }
    let one = |table: &Section<'_>| {
        let number =
            |key: &str, remedy: &str| table.number(key, Bound::POSITIVE).required(table, key, remedy);
        let diameter = number("diameter", "give the diameter of these grains");
        let mass = number("mass", "give the mass of these grains");
        let share = number("share", "give their share of all grains, such as 0.5");
        Some((Grain { diameter: diameter?, mass: mass? }, share?))
    };
    // All are read before any is missed, so that every mistake is told.
    let read: Vec<Option<(Grain, f64)>> = tables.iter().map(one).collect();
    let (kinds, shares): (Vec<Grain>, Vec<f64>) =
        read.into_iter().collect::<Option<Vec<_>>>()?.into_iter().unzip();
    let sum: f64 = shares.iter().sum();
    Some(Matter { kinds, shares: shares.into_iter().map(|share| share / sum).collect(), are_species: true })
}

/// Tangential restitution and moment of inertia.
fn roughness<V: Vector>(particles: &Section<'_>) -> Option<Option<Roughness>> {
    const KEY: &str = "tangential_restitution";
    let tangential = Bound::within(-1.0, 1.0, "a number from -1 (smooth) to 1 (perfectly rough)");
    let inertia =
        Bound::up_to(1.0, "I/(m a²) above 0 and at most 1: 0.5 for a solid disk, 0.4 for a solid sphere");
    let tangential = particles.number(KEY, tangential).optional();
    // A solid disk or sphere: I = 2 m a²/(D + 2).
    let reduced_inertia =
        particles.number("moment_of_inertia", inertia).or(2.0 / (V::DIMENSION as f64 + 2.0));
    if particles.has("moment_of_inertia") && !particles.has(KEY) {
        particles.mistake(
            "moment_of_inertia",
            format!("is that of rough grains, and these are smooth; give {KEY} or leave it out"),
        );
        return None;
    }
    let reduced_inertia = reduced_inertia?;
    Some(tangential?.map(|tangential_restitution| Roughness { tangential_restitution, reduced_inertia }))
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
pub(in crate::scenario) fn count<V: Vector>(amount: Amount, matter: &Matter, size: V) -> Result<u32, String> {
    let places = size.product() / matter.mean_volume::<V>();
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
