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

/// The closed bottle of the comparison with other integrators: 6 h, 61 samples, one wall cell and 48.
fn closed_bottle(c: &mut Criterion) {
    let mut scenario = scenario::presets::load("bottle-step").expect("built-in scenario");
    scenario.sample_time_s = 360.0;
    let lumped = vessel::presets::load("closed-bottle").expect("built-in vessel");
    let mut resolved = lumped.clone();
    let geometry = &mut resolved.geometry;
    (geometry.lumped, geometry.cylinder_cells, geometry.layers[0].cells) = (false, 10, 3);
    (geometry.bottom.cells, geometry.shoulder.cells) = (3, 3);
    let mut group = c.benchmark_group("closed bottle, 6 h");
    for (cells, vessel) in [(1, &lumped), (48, &resolved)] {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let settings =
                SimulationSettings { relative_tolerance: tolerance, ..SimulationSettings::default() };
            group.bench_function(format!("{cells} wall cells, {tolerance:e}"), |b| {
                b.iter(|| simulate(vessel, &scenario, &settings, &mut |_| {}).expect("runs"));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, scenario_4, closed_bottle, scaling);
criterion_main!(benches);
