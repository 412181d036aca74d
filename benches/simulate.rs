//! Cost of a simulation: the paper's scenario 4 on the default mesh, and how it grows with the number of wall cells.
//!
//! `cargo bench -p cylwatch-benches --bench simulate`
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use cylwatch_thermal::scenario::{self, Scenario};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::vessel::{self, Vessel};

fn preset() -> (Vessel, Scenario) {
    let vessel = vessel::presets::load("nitrogen-20l").expect("built-in vessel");
    let scenario = scenario::presets::load("cool-down").expect("built-in scenario");
    (vessel, scenario)
}

/// The same vessel with so many axial cells on its cylinder and four radial ones: `4 (cylinder + 6)` wall cells.
fn refined(cylinder_cells: usize) -> Vessel {
    let (mut vessel, _) = preset();
    vessel.geometry.cylinder_cells = cylinder_cells;
    vessel.geometry.layers[0].cells = 4;
    vessel
}

fn scenario_4(c: &mut Criterion) {
    let (vessel, scenario) = preset();
    let settings = SimulationSettings::default();
    c.bench_function("scenario 4, 14 h, default mesh, 1e-6", |b| {
        b.iter(|| simulate(&vessel, &scenario, &settings, &mut |_| {}).expect("runs"));
    });
}

fn scaling(c: &mut Criterion) {
    let (_, mut scenario) = preset();
    scenario.sample_time_s = 3600.0;
    let settings = SimulationSettings::default();
    let mut group = c.benchmark_group("scenario 4, wall cells");
    group.sample_size(10);
    for cells in [100, 1000, 10_000] {
        let vessel = refined(cells / 4 - 6);
        group.bench_function(BenchmarkId::from_parameter(cells), |b| {
            b.iter(|| simulate(&vessel, &scenario, &settings, &mut |_| {}).expect("runs"));
        });
    }
    group.finish();
}

criterion_group!(benches, scenario_4, scaling);
criterion_main!(benches);
