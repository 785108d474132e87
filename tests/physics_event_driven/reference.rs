//! A second event-driven simulator, as simple as it can be: after every event all grains are moved to its time
//! and all pairs, with all their images, are asked anew. It shares no code with the engine.

use std::f64::consts::TAU;

/// A collision of two grains, the lower number first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PairHit {
    pub(crate) time: f64,
    pub(crate) grains: [usize; 2],
}

/// A collision of a grain with a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallHit {
    pub(crate) time: f64,
    pub(crate) grain: usize,
    pub(crate) wall: usize,
}

/// A smooth wall across `axis` at 0 or, if `upper`, at the side of the box; it stands at its place + A sin(ωt).
#[derive(Clone, Copy, Debug)]
pub(crate) struct SmoothWall {
    pub(crate) axis: usize,
    pub(crate) upper: bool,
    pub(crate) restitution: f64,
    pub(crate) amplitude: f64,
    pub(crate) angular_frequency: f64,
    /// Whether the surface of a grain bounces off it; otherwise its centre does.
    pub(crate) holds_surfaces: bool,
}

/// Smooth hard spheres in a box with one corner at 0, periodic along every axis without walls.
#[derive(Clone, Debug)]
pub(crate) struct Reference<const D: usize> {
    pub(crate) sides: [f64; D],
    pub(crate) walls: Vec<SmoothWall>,
    pub(crate) gravity: [f64; D],
    pub(crate) restitution: f64,
    pub(crate) positions: Vec<[f64; D]>,
    pub(crate) velocities: Vec<[f64; D]>,
    pub(crate) diameters: Vec<f64>,
    pub(crate) masses: Vec<f64>,
    pub(crate) time: f64,
    pub(crate) pair_hits: Vec<PairHit>,
    pub(crate) wall_hits: Vec<WallHit>,
}

/// What happens next: two grains with the image of the second, or a grain and a wall.
#[derive(Clone, Copy, Debug)]
enum Event<const D: usize> {
    Nothing,
    Pair(usize, usize, [f64; D]),
    Wall(usize, usize),
}

fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}

fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// a + factor · b.
fn plus<const D: usize>(a: [f64; D], factor: f64, b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] + factor * b[axis])
}

/// Halves the interval until nothing is left to halve; `f` is positive at `low` and not at `high`.
pub(crate) fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return high;
        }
        if f(middle) > 0.0 { low = middle } else { high = middle }
    }
}

impl<const D: usize> Reference<D> {
    /// Equal grains in a periodic box without gravity.
    pub(crate) fn periodic(sides: [f64; D], diameter: f64, restitution: f64) -> Self {
        Reference {
            sides,
            walls: Vec::new(),
            gravity: [0.0; D],
            restitution,
            positions: Vec::new(),
            velocities: Vec::new(),
            diameters: vec![diameter],
            masses: vec![1.0],
            time: 0.0,
            pair_hits: Vec::new(),
            wall_hits: Vec::new(),
        }
    }

    fn diameter(&self, grain: usize) -> f64 {
        self.diameters[grain % self.diameters.len()]
    }

    fn mass(&self, grain: usize) -> f64 {
        self.masses[grain % self.masses.len()]
    }

    fn is_periodic(&self, axis: usize) -> bool {
        self.walls.iter().all(|wall| wall.axis != axis)
    }

    /// Kinetic energy and that of the field.
    pub(crate) fn energy(&self) -> f64 {
        let of_grain = |k: usize| {
            let (x, v) = (self.positions[k], self.velocities[k]);
            self.mass(k) * (0.5 * dot(v, v) - dot(self.gravity, x))
        };
        (0..self.positions.len()).map(of_grain).sum()
    }

    /// Momentum along `axis`.
    pub(crate) fn momentum(&self, axis: usize) -> f64 {
        (0..self.positions.len()).map(|k| self.mass(k) * self.velocities[k][axis]).sum()
    }

    /// The smallest gap between any two grains or their nearest images, negative if they overlap.
    pub(crate) fn smallest_gap(&self) -> f64 {
        let mut smallest = f64::INFINITY;
        for j in 0..self.positions.len() {
            for i in 0..j {
                for image in self.images() {
                    let apart = plus(minus(self.positions[j], self.positions[i]), 1.0, image);
                    let contact = 0.5 * (self.diameter(i) + self.diameter(j));
                    smallest = smallest.min(dot(apart, apart).sqrt() - contact);
                }
            }
        }
        smallest
    }

    /// Runs to `end`.
    pub(crate) fn run_to(&mut self, end: f64) {
        while self.time < end {
            self.advance(end);
        }
    }

    /// Runs until there have been `count` collisions of pairs.
    pub(crate) fn run_collisions(&mut self, count: usize) {
        while self.pair_hits.len() < count {
            self.advance(f64::INFINITY);
        }
    }

    /// Moves on to the next event, or to `end`, or as far as the neighbouring images stay the nearest.
    fn advance(&mut self, end: f64) {
        let (mut soonest, mut event) = (self.short_time().min(end - self.time), Event::Nothing);
        let images = self.images();
        for j in 0..self.positions.len() {
            for i in 0..j {
                for &image in &images {
                    if let Some(after) = self.pair_time(i, j, image).filter(|&after| after < soonest) {
                        (soonest, event) = (after, Event::Pair(i, j, image));
                    }
                }
            }
            for wall in 0..self.walls.len() {
                if let Some(after) = self.wall_time(j, wall, soonest).filter(|&after| after < soonest) {
                    (soonest, event) = (after, Event::Wall(j, wall));
                }
            }
        }
        self.fly(soonest);
        self.time = if matches!(event, Event::Nothing) && soonest == end - self.time {
            end
        } else {
            self.time + soonest
        };
        match event {
            Event::Nothing => {}
            Event::Pair(i, j, image) => self.collide(i, j, image),
            Event::Wall(grain, wall) => self.bounce(grain, wall),
        }
        self.wrap();
    }

    /// Time in which no grain crosses more than a fifth of the box, speeding up under gravity.
    fn short_time(&self) -> f64 {
        let least_side = self.sides.into_iter().fold(f64::INFINITY, f64::min);
        let fastest = self.velocities.iter().map(|&v| dot(v, v)).fold(0.0, f64::max).sqrt();
        let pull = dot(self.gravity, self.gravity).sqrt();
        // distance = fastest · t + pull · t²/2.
        let distance = 0.2 * least_side;
        2.0 * distance / (fastest + (fastest * fastest + 2.0 * pull * distance).sqrt())
    }

    /// Shifts to all neighbouring images, itself included.
    fn images(&self) -> Vec<[f64; D]> {
        let mut images = vec![[0.0; D]];
        for axis in (0..D).filter(|&axis| self.is_periodic(axis)) {
            for k in 0..images.len() {
                for shift in [-self.sides[axis], self.sides[axis]] {
                    let mut image = images[k];
                    image[axis] += shift;
                    images.push(image);
                }
            }
        }
        images
    }

    /// Time until grain `i` meets the image of grain `j`: the lower root of (dx + dv t)² = d². The field cancels.
    fn pair_time(&self, i: usize, j: usize, image: [f64; D]) -> Option<f64> {
        let dx = plus(minus(self.positions[j], self.positions[i]), 1.0, image);
        let dv = minus(self.velocities[j], self.velocities[i]);
        let contact = 0.5 * (self.diameter(i) + self.diameter(j));
        let (a, b, c) = (dot(dv, dv), dot(dx, dv), dot(dx, dx) - contact * contact);
        if b >= 0.0 || b * b < a * c {
            return None;
        }
        Some(((-b - (b * b - a * c).sqrt()) / a).max(0.0))
    }

    /// Gap between grain and wall after `after`, and its rate.
    fn wall_gap(&self, grain: usize, wall: usize, after: f64) -> (f64, f64) {
        let wall = &self.walls[wall];
        let (x, v, g) =
            (self.positions[grain][wall.axis], self.velocities[grain][wall.axis], self.gravity[wall.axis]);
        let reach = if wall.holds_surfaces { 0.5 * self.diameter(grain) } else { 0.0 };
        let (z, w) = wall.motion(self.time + after);
        let (there, speed) = (x + v * after + 0.5 * g * after * after, v + g * after);
        if wall.upper {
            (self.sides[wall.axis] + z - there - reach, w - speed)
        } else {
            (there - z - reach, speed - w)
        }
    }

    /// Time until a grain meets a wall within `horizon`: a scan in two thousand steps, at least so many per period,
    /// and bisection. Bounces that are shorter than a step are not resolved.
    fn wall_time(&self, grain: usize, wall: usize, horizon: f64) -> Option<f64> {
        let gap = |t: f64| self.wall_gap(grain, wall, t);
        let periods = self.walls[wall].angular_frequency * horizon / TAU;
        let steps = (2000.0 * (1.0 + periods)).ceil();
        if gap(0.0).0 <= 0.0 && gap(0.0).1 < 0.0 {
            return Some(0.0);
        }
        let mut before = 0.0;
        let mut k = 1.0;
        while k <= steps {
            let after = horizon * k / steps;
            if gap(after).0 <= 0.0 {
                return Some(bisect(|t| gap(t).0, before, after));
            }
            (before, k) = (after, k + 1.0);
        }
        None
    }

    fn fly(&mut self, duration: f64) {
        for (x, v) in self.positions.iter_mut().zip(&mut self.velocities) {
            *x = plus(plus(*x, duration, *v), 0.5 * duration * duration, self.gravity);
            *v = plus(*v, duration, self.gravity);
        }
    }

    /// v_n is reversed and loses 1 − r: v₁ − (1 + r) μ/m₁ (v₁₂·k) k, and v₂ accordingly.
    fn collide(&mut self, i: usize, j: usize, image: [f64; D]) {
        let apart = plus(minus(self.positions[j], self.positions[i]), 1.0, image);
        let length = dot(apart, apart).sqrt();
        let normal = apart.map(|component| component / length);
        let approach = dot(minus(self.velocities[i], self.velocities[j]), normal);
        let (m1, m2) = (self.mass(i), self.mass(j));
        let impulse = (1.0 + self.restitution) * approach * m1 * m2 / (m1 + m2);
        self.velocities[i] = plus(self.velocities[i], -impulse / m1, normal);
        self.velocities[j] = plus(self.velocities[j], impulse / m2, normal);
        self.pair_hits.push(PairHit { time: self.time, grains: [i, j] });
    }

    /// In the frame of the wall the normal velocity is reversed and loses 1 − r.
    fn bounce(&mut self, grain: usize, wall: usize) {
        let (axis, restitution) = (self.walls[wall].axis, self.walls[wall].restitution);
        let (_, wall_velocity) = self.walls[wall].motion(self.time);
        let v = &mut self.velocities[grain][axis];
        *v = wall_velocity - restitution * (*v - wall_velocity);
        self.wall_hits.push(WallHit { time: self.time, grain, wall });
    }

    fn wrap(&mut self) {
        let periodic: Vec<usize> = (0..D).filter(|&axis| self.is_periodic(axis)).collect();
        for axis in periodic {
            for x in &mut self.positions {
                x[axis] -= self.sides[axis] * (x[axis] / self.sides[axis]).floor();
            }
        }
    }
}

impl SmoothWall {
    /// Displacement A sin(ωt) and velocity at `time`.
    fn motion(&self, time: f64) -> (f64, f64) {
        let phase = self.angular_frequency * time;
        (self.amplitude * phase.sin(), self.amplitude * self.angular_frequency * phase.cos())
    }
}
