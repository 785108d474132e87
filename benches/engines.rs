//! The sort alone, and the writing of a log. `cargo bench --bench engines`.
//!
//! Whole steps and their verbs: `cargo bench --bench steps`.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use grainflow::matter::columns::Columns;
use grainflow::matter::sort::CountingSort;
use grainflow::observe::measure::{Column, Dimension};
use grainflow::record::frame::frame;
use grainflow::record::writer::{LogHeader, LogWriter, Recording};

const SIZES: [usize; 2] = [10_000, 1_000_000];

/// The stable counting sort of grains that have moved a little, without the move of their columns.
fn sort(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sort");
    for grains in SIZES {
        // Ten grains per cell, an even number along each side.
        let per_axis = 2 * (0.5 * (0.1 * grains as f64).sqrt()).round() as usize;
        let number_of_cells = per_axis * per_axis;
        let home = |row: usize| row * number_of_cells / grains;
        let away = |row: usize| [0, 0, 0, 1, per_axis][row * 7 % 5];
        let cells: Vec<u32> =
            (0..grains).map(|row| ((home(row) + away(row)) % number_of_cells) as u32).collect();
        let mut offsets = vec![0; number_of_cells + 1];
        let mut sort = CountingSort::default();
        group.throughput(Throughput::Elements(grains as u64));
        group.bench_function(BenchmarkId::new("order", grains), |b| {
            b.iter(|| {
                sort.count(black_box(&cells), number_of_cells);
                black_box(sort.accumulate(&mut offsets))
            })
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
            let recording = Recording {
                values: &[time],
                state_hash: "00",
                grains: frame.grains,
                profiles: &[],
                frame: Some(&frame),
                fields: &[],
            };
            writer.recording(&recording).expect("the log can be written");
        })
    });
    group.finish();
}

criterion_group!(benches, sort, log);
criterion_main!(benches);
