//! Each engine, dimension and size, the yardstick, the sort alone, and the writing of a log.
//!
//! Throughput in elements is particle-steps. `cargo bench --bench engines`.

mod support;

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DVec2, DVec3};
use grainflow::matter::columns::Columns;
use grainflow::matter::sort::CountingSort;
use grainflow::observe::measure::{Column, Dimension};
use grainflow::record::frame::frame;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};
use grainflow::space::Vector;
use support::cases::{VOLUME_FRACTION, geometry, scenario, stepper, yardstick};

const SIZES: [usize; 2] = [10_000, 1_000_000];
const COLLISIONS: f64 = 0.5;

fn engines(criterion: &mut Criterion) {
    of_dimension::<DVec2, 2>(criterion);
    of_dimension::<DVec3, 3>(criterion);
}

fn of_dimension<V: Vector, const D: usize>(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group(format!("step-{D}d"));
    group.sample_size(10);
    for grains in SIZES {
        group.throughput(Throughput::Elements(grains as u64));
        let mut kernel = yardstick::<V, D>(grains, COLLISIONS);
        let (sigma, g) = (V::cross_section(1.0), V::contact_correlation(VOLUME_FRACTION));
        group.bench_function(BenchmarkId::new("yardstick", grains), |b| b.iter(|| kernel.step(sigma, g)));
        for engine in ["dsmc", "cba", "hsmc"] {
            let scenario = scenario::<V>(engine, grains, COLLISIONS);
            let mut step = stepper(&scenario);
            group.bench_function(BenchmarkId::new(engine, grains), |b| b.iter(&mut step));
        }
    }
    group.finish();
}

/// The stable counting sort of grains that have moved a little, without the move of their columns.
fn sort(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sort");
    for grains in SIZES {
        let (_, per_axis) = geometry::<DVec2>(grains);
        let number_of_cells = per_axis * per_axis;
        let home = |row: usize| row * number_of_cells / grains;
        let away = |row: usize| [0, 0, 0, 1, per_axis][row * 7 % 5];
        let cells: Vec<u32> =
            (0..grains).map(|row| ((home(row) + away(row)) % number_of_cells) as u32).collect();
        let mut offsets = vec![0; number_of_cells + 1];
        let mut sort = CountingSort::default();
        group.throughput(Throughput::Elements(grains as u64));
        group.bench_function(BenchmarkId::new("order", grains), |b| {
            b.iter(|| black_box(sort.order(black_box(&cells), &mut offsets).len()))
        });
    }
    group.finish();
}

/// One recording of a frame of all grains.
fn log(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("log");
    group.sample_size(10);
    let grains = 100_000;
    let row = |k: usize| DVec2::new((k as f64 * 0.618).fract(), (k as f64 * 0.414).fract());
    let columns = Columns {
        positions: (0..grains).map(row).collect(),
        velocities: (0..grains).map(row).collect(),
        ids: (0..grains as u32).collect(),
        spins: None,
        species: None,
    };
    let header = LogHeader {
        columns: vec![Column { name: "time".into(), unit: Dimension { time: 1, ..Dimension::default() } }],
        time_scale: 1_000_000_000,
        ..LogHeader::default()
    };
    let place = tempfile::tempdir().expect("a temporary folder can be made");
    let mut writer = LogWriter::create(&place.path().join("log.mcap"), &header).expect("the log can be made");
    let mut time = 0.0;
    group.throughput(Throughput::Elements(grains as u64));
    group.bench_function("recording", |b| {
        b.iter(|| {
            time += 1.0;
            let frame = frame(time, &columns, None);
            let recording = Recording { values: &[time], state_hash: "00", profiles: &[], frame: &frame };
            writer.recording(&recording).expect("the log can be written");
        })
    });
    group.finish();
}

criterion_group!(benches, engines, sort, log);
criterion_main!(benches);
