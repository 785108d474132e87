//! Regular lattices without overlap, stretched to the box.

use super::super::model::{InitialPositions, Scenario};
use super::super::reader::Section;
use super::in_cells::evenness;
use crate::space::Vector;

/// Distances are compared with this much slack, so that grains may touch.
const SLACK: f64 = 1e-12;

/// Planes of sites along each axis, parallel to the faces and at equal distances.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Planes {
    /// Along each axis; 1 beyond D.
    number: [u32; 3],
    /// Whether every other site is left out, those with an odd sum of coordinates: the centred lattice,
    /// triangular in 2D and face-centred cubic in 3D.
    centred: bool,
}

/// What a lattice has to fit into.
#[derive(Clone, Copy, Debug)]
struct Room<V> {
    size: V,
    periodic: [bool; 3],
    /// Of the largest grain.
    diameter: f64,
    count: u64,
}

/// Notes that the grains of `scenario` fit onto no lattice.
pub(in crate::scenario) fn check<V: Vector>(root: &Section<'_>, scenario: &Scenario<V>) -> Option<()> {
    let wanted =
        scenario.engine.kind.is_event_driven() && scenario.initial.positions == InitialPositions::Lattice;
    if !wanted || planes(&Room::of(scenario)).is_some() {
        return Some(());
    }
    root.mistake(
        "initial.positions",
        format!(
            "no regular lattice of {} grains with the diameter {} fits into this box without overlap; write \
             \"compressed\", take fewer grains or enlarge domain.size",
            scenario.count,
            scenario.largest_diameter()
        ),
    );
    None
}

/// Sites of a lattice for the grains of `scenario` `[id]`, surplus ones left empty evenly; `None` where none fits.
pub(super) fn sites<V: Vector>(scenario: &Scenario<V>) -> Option<Vec<V>> {
    let room = Room::of(scenario);
    let planes = planes(&room)?;
    let mut sites: Vec<[u32; 3]> = planes.sites().collect();
    let surplus = sites.len().saturating_sub(scenario.count as usize);
    if surplus > 0 {
        let mut ranking: Vec<(f64, usize)> =
            sites.iter().enumerate().map(|(k, &site)| (evenness::<V>(site), k)).collect();
        ranking.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut empty = vec![false; sites.len()];
        ranking.into_iter().take(surplus).for_each(|(_, k)| empty[k] = true);
        let mut is_empty = empty.into_iter();
        sites.retain(|_| !is_empty.next().unwrap_or(false));
    }
    let place = |site: [u32; 3]| V::from_fn(|axis| room.place(axis, site[axis], planes.number[axis]));
    Some(sites.into_iter().map(place).collect())
}

/// The lattice to take: in 2D the square one where it fits, otherwise, and in 3D first, the centred one.
fn planes<V: Vector>(room: &Room<V>) -> Option<Planes> {
    if V::DIMENSION == 2 {
        simple(room).or_else(|| centred(room))
    } else {
        centred(room).or_else(|| simple(room))
    }
}

impl Planes {
    /// Coordinates of the sites, with the first axis fastest.
    fn sites(self) -> impl Iterator<Item = [u32; 3]> {
        let [a, b, c] = self.number;
        let all = (0..c).flat_map(move |z| (0..b).flat_map(move |y| (0..a).map(move |x| [x, y, z])));
        all.filter(move |[x, y, z]| !self.centred || (x + y + z) % 2 == 0)
    }
}

impl<V: Vector> Room<V> {
    fn of(scenario: &Scenario<V>) -> Self {
        Room {
            size: scenario.size,
            periodic: std::array::from_fn(|axis| scenario.boundary.is_periodic(axis)),
            diameter: scenario.largest_diameter(),
            count: scenario.count.into(),
        }
    }

    /// The distance between `number` planes along `axis` [length]; a single one has no neighbour.
    fn spacing(&self, axis: usize, number: u32) -> f64 {
        match (self.periodic[axis], number) {
            (true, number) => self.size[axis] / f64::from(number),
            (false, 1) => f64::INFINITY,
            (false, number) => (self.size[axis] - self.diameter) / f64::from(number - 1),
        }
    }

    /// The place along `axis` of plane `plane` of `number`: spread over the period, or from wall to wall.
    fn place(&self, axis: usize, plane: u32, number: u32) -> f64 {
        let spacing = self.spacing(axis, number);
        match (self.periodic[axis], number) {
            (true, _) => (f64::from(plane) + 0.5) * spacing,
            (false, 1) => 0.5 * self.size[axis],
            // The last one keeps its radius from the wall whatever rounding does.
            (false, number) if plane == number - 1 => self.size[axis] - 0.5 * self.diameter,
            (false, _) => 0.5 * self.diameter + f64::from(plane) * spacing,
        }
    }

    /// The most planes along `axis` that are `least` apart.
    fn most(&self, axis: usize, least: f64) -> u32 {
        let length = if self.periodic[axis] { self.size[axis] } else { self.size[axis] - self.diameter };
        let intervals = (length / least * (1.0 + SLACK)).floor().clamp(0.0, f64::from(u32::MAX - 1)) as u32;
        if self.periodic[axis] { intervals } else { intervals + 1 }
    }
}

/// The simple lattice (square, cubic) with sites as equally spaced along the axes as the box allows.
fn simple<V: Vector>(room: &Room<V>) -> Option<Planes> {
    let most: [u32; 3] =
        std::array::from_fn(|axis| if axis < V::DIMENSION { room.most(axis, room.diameter) } else { 1 });
    if most.contains(&0) {
        return None;
    }
    let spacing = (room.size.product() / room.count.max(1) as f64).powf(1.0 / V::DIMENSION as f64);
    let mut number = [1; 3];
    for axis in 0..V::DIMENSION {
        number[axis] = ((room.size[axis] / spacing * (1.0 + SLACK)) as u32).clamp(1, most[axis]);
    }
    let sites = |number: [u32; 3]| number.iter().map(|&planes| u64::from(planes)).product::<u64>();
    while sites(number) < room.count {
        let wider = |&axis: &usize| room.size[axis] / f64::from(number[axis]);
        let axis = (0..V::DIMENSION)
            .filter(|&axis| number[axis] < most[axis])
            .max_by(|a, b| wider(a).total_cmp(&wider(b)))?;
        number[axis] += 1;
    }
    Some(Planes { number, centred: false })
}

/// The centred lattice whose nearest sites are farthest apart, among those with room for the grains.
fn centred<V: Vector>(room: &Room<V>) -> Option<Planes> {
    // Planes of one axis hold every other site: half a diameter apart, sites of two planes on are a whole one.
    let most: [u32; 3] =
        std::array::from_fn(
            |axis| {
                if axis < V::DIMENSION { room.most(axis, 0.5 * room.diameter) } else { 1 }
            },
        );
    let last = V::DIMENSION - 1;
    let middle = if V::DIMENSION == 2 { 1 } else { most[1] };
    let mut best: Option<(f64, Planes)> = None;
    for a in 1..=most[0] {
        for b in 1..=middle {
            let mut number = [a, b, 1];
            let below: u64 = number[..last].iter().map(|&planes| u64::from(planes)).product();
            let needed = (2 * room.count).div_ceil(below).max(1);
            if needed > u64::from(most[last]) + 1 {
                continue;
            }
            // Half of an odd number of sites is rounded up: one plane less may do.
            number[last] = (needed as u32).saturating_sub(1).max(1);
            while number_of_centred_sites(number) < room.count || odd_period(room, number, last) {
                number[last] += 1;
            }
            let fits = number[last] <= most[last] && !(0..last).any(|axis| odd_period(room, number, axis));
            let apart = nearest::<V>(room, number);
            let is_better = best.is_none_or(|(farthest, _)| apart > farthest * (1.0 + SLACK));
            if fits && apart >= room.diameter * (1.0 - SLACK) && is_better {
                best = Some((apart, Planes { number, centred: true }));
            }
        }
    }
    best.map(|(_, planes)| planes)
}

/// Whether the pattern of every other site would break at a period.
fn odd_period<V: Vector>(room: &Room<V>, number: [u32; 3], axis: usize) -> bool {
    room.periodic[axis] && number[axis] % 2 == 1
}

fn number_of_centred_sites(number: [u32; 3]) -> u64 {
    number.iter().map(|&planes| u64::from(planes)).product::<u64>().div_ceil(2)
}

/// The least distance between two sites of the centred lattice [length].
fn nearest<V: Vector>(room: &Room<V>, number: [u32; 3]) -> f64 {
    let spacing = |axis: usize| room.spacing(axis, number[axis]);
    let mut least = f64::INFINITY;
    for a in 0..V::DIMENSION {
        if number[a] > 2 || room.periodic[a] {
            least = least.min(2.0 * spacing(a));
        }
        for b in 0..a {
            if number[a] > 1 && number[b] > 1 {
                least = least.min(spacing(a).hypot(spacing(b)));
            }
        }
    }
    least
}
