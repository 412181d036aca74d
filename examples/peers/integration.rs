//! One right-hand side for several integrators: the closed bottle, with one wall cell and with 48.
//!
//! The gas keeps its density, so its properties are functions of temperature alone; they are given at Chebyshev nodes,
//! from which the other side builds polynomials that are exact to rounding. States there: wall cells, then the energy of the gas. This project's
//! own run carries mass, mean wall and four integrals for its balances beside them, and evaluates the equation of state.
use super::stopwatch::{Stopwatch, Timing};
use anyhow::Context;
use cylwatch::thermal::fluid::Fluid;
use cylwatch::thermal::model::Model;
use cylwatch::thermal::model::inputs::InputPieces;
use cylwatch::thermal::scenario::{self, OutsideFilm, Scenario};
use cylwatch::thermal::simulate::{Method, SimulationSettings, simulate};
use cylwatch::thermal::transfer::inside::film_groups_exact;
use cylwatch::thermal::vessel::Fill;
use cylwatch::thermal::vessel::{self, InsideFilm, Vessel};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Samples that runs are compared at, s.
const SAMPLE_S: f64 = 360.0;
/// Tolerances; the absolute one of temperatures is 100 K times as much.
const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];
/// Tolerance of the run that counts as exact.
const REFERENCE: f64 = 1e-12;
/// Length of a run that shows what every run costs before it has begun, s.
const SHORT_S: f64 = 1.0;
/// Range of the polynomials, K, and their number of nodes.
const RANGE_K: (f64, f64) = (284.0, 312.0);
const NODES: usize = 16;
/// States at which derivatives are compared.
const SPECIMENS: usize = 5;
/// Cells of the resolved wall: cylinder, each end, and across the thickness.
const CELLS: (usize, usize, usize) = (10, 3, 3);

/// A conductance between two wall cells, W/K.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Link {
    a: usize,
    b: usize,
    conductance_w_k: f64,
}

/// A face of the wall: its cell, its area and the conductance of the half cell behind it.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Face {
    cell: usize,
    area_m2: f64,
    conductance_w_k: f64,
}

/// A state with its derivative.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Specimen {
    wall_k: Vec<f64>,
    energy_j: f64,
    gas_k: f64,
    pressure_pa: f64,
    wall_k_s: Vec<f64>,
    energy_w: f64,
}

/// The system of equations.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Inputs {
    name: String,
    capacity_j_k: Vec<f64>,
    links: Vec<Link>,
    inner: Vec<Face>,
    outer: Vec<Face>,
    outside_film_w_m2_k: f64,
    air_k: f64,
    start_k: f64,
    mass_kg: f64,
    energy_j: f64,
    /// `q = factor k R^(1/3) (theta^2 + flat^2)^(1/6) theta`.
    film_factor: f64,
    film_flat_k: f64,
    duration_s: f64,
    sample_s: f64,
    tolerances: Vec<f64>,
    /// Scale of an absolute tolerance of 1 K in the energy, J/K.
    energy_per_k: f64,
    density_kg_m3: f64,
    /// Chebyshev nodes, K; specific energy, pressure, and `ln k + ln R / 3` by film temperature (rows) and gas temperature.
    range_k: (f64, f64),
    node_k: Vec<f64>,
    node_energy_j_kg: Vec<f64>,
    node_pressure_pa: Vec<f64>,
    node_ln_film: Vec<Vec<f64>>,
    specimens: Vec<Specimen>,
}

/// The two systems.
pub(crate) fn inputs() -> anyhow::Result<Vec<Inputs>> {
    let (systems, scenario) = systems()?;
    systems.iter().map(|(name, vessel)| system(name, vessel, &scenario)).collect()
}

fn systems() -> anyhow::Result<([(&'static str, Vessel); 2], Scenario)> {
    let mut scenario = scenario::presets::load("bottle-step")?;
    scenario.sample_time_s = SAMPLE_S;
    let lumped = vessel::presets::load("closed-bottle")?;
    let mut resolved = lumped.clone();
    let geometry = &mut resolved.geometry;
    geometry.lumped = false;
    geometry.cylinder_cells = CELLS.0;
    (geometry.bottom.cells, geometry.shoulder.cells) = (CELLS.1, CELLS.1);
    geometry.layers[0].cells = CELLS.2;
    Ok(([("1 wall cell", lumped), ("48 wall cells", resolved)], scenario))
}

fn system(name: &str, vessel: &Vessel, scenario: &Scenario) -> anyhow::Result<Inputs> {
    let InsideFilm::Rayleigh { factor, exponent, multiplier: 1.0 } = vessel.inside_film else {
        anyhow::bail!("the film of the closed bottle is another one");
    };
    anyhow::ensure!((exponent - 1.0 / 3.0).abs() < 1e-15, "the film's exponent is another one");
    let OutsideFilm::Coefficient { film_w_m2_k } = &scenario.surroundings.film else {
        anyhow::bail!("the outside film of the closed bottle is another one");
    };
    let Fill::Settled { pressure_pa, temperature_k } = scenario.initial.fill else {
        anyhow::bail!("the fill of the closed bottle is another one");
    };
    let fluid = &vessel.fluid;
    let density = fluid.density_from_pressure_temperature(pressure_pa, temperature_k)?;
    let mass_kg = density * vessel.volume.volume_m3;
    let model = Model::new(vessel, scenario)?;
    let mesh = model.mesh();
    let conductivity = mesh.materials[0].conductivity_w_m_k;
    let heat = mesh.materials[0].density_kg_m3 * mesh.materials[0].heat_capacity_j_kg_k;
    let columns = || mesh.columns.iter().enumerate();
    let node_k: Vec<f64> = (0..NODES)
        .map(|k| {
            let (low, high) = RANGE_K;
            let unit = (PI * (k as f64 + 0.5) / NODES as f64).cos();
            0.5 * (low + high) + 0.5 * (high - low) * unit
        })
        .collect();
    let pressure: Vec<f64> = node_k.iter().map(|&t| fluid.pressure_pa(density, t)).collect();
    let row = |film_k: f64| pressure.iter().map(|&p| ln_film(fluid, film_k, p)).collect();
    let pieces = InputPieces::new(scenario, 0.0, scenario.duration_s);
    let air_k = pieces.at(0.0).air_k;
    let x0 = model.initial_state(vessel, &scenario.initial)?;
    Ok(Inputs {
        name: name.into(),
        capacity_j_k: mesh.volume_m3.iter().map(|volume| volume * heat).collect(),
        links: mesh
            .links
            .iter()
            .map(|link| {
                let (a, b) = (link.shape_a_m, link.shape_b_m);
                Link { a: link.a, b: link.b, conductance_w_k: conductivity * a * b / (a + b) }
            })
            .collect(),
        inner: columns()
            .map(|(j, column)| Face {
                cell: mesh.inner_cell(j),
                area_m2: column.inner_area_m2,
                conductance_w_k: conductivity * column.inner_shape_m,
            })
            .collect(),
        outer: columns()
            .map(|(j, column)| Face {
                cell: mesh.outer_cell(j),
                area_m2: column.outer_area_m2,
                conductance_w_k: conductivity * column.outer_shape_m,
            })
            .collect(),
        outside_film_w_m2_k: film_w_m2_k.segment(0.0, scenario.duration_s).at(0.0),
        air_k,
        start_k: scenario.initial.gas_temperature_k,
        mass_kg,
        energy_j: x0[model.layout().energy],
        film_factor: factor,
        film_flat_k: 0.01,
        duration_s: scenario.duration_s,
        sample_s: SAMPLE_S,
        tolerances: TOLERANCES.to_vec(),
        energy_per_k: 2.5 * fluid.specific_gas_constant_j_kg_k() * mass_kg,
        density_kg_m3: density,
        range_k: RANGE_K,
        node_energy_j_kg: node_k.iter().map(|&t| fluid.state(density, t).internal_energy_j_kg).collect(),
        node_ln_film: node_k.iter().map(|&t| row(t)).collect::<Vec<_>>(),
        node_pressure_pa: pressure,
        node_k,
        specimens: specimens(&model, &x0, &pieces, fluid, density, mass_kg)?,
    })
}

/// `ln k + ln R / 3` of the law for the film.
fn ln_film(fluid: &Fluid, film_k: f64, pressure_pa: f64) -> f64 {
    film_groups_exact(fluid, film_k, pressure_pa).map_or(f64::NAN, |(ln_k, ln_r)| ln_k + ln_r / 3.0)
}

/// States on the way from the start to the end, the wall unevenly warm, with the model's derivatives.
fn specimens(
    model: &Model,
    x0: &[f64],
    pieces: &InputPieces,
    fluid: &Fluid,
    density: f64,
    mass_kg: f64,
) -> anyhow::Result<Vec<Specimen>> {
    let layout = *model.layout();
    let one = |k: usize| {
        let gas_k = 288.0 + 4.0 * k as f64;
        let mut x = x0.to_vec();
        for (cell, x) in x[..layout.wall].iter_mut().enumerate() {
            *x = gas_k + 0.3 + 0.2 * (cell as f64 * 1.7 + k as f64).sin();
        }
        let state = fluid.state(density, gas_k);
        x[layout.energy] = mass_kg * state.internal_energy_j_kg;
        let mut rate = vec![0.0; layout.states];
        model.rate(&x, &pieces.at(0.0), &[], &mut rate)?;
        anyhow::Ok(Specimen {
            wall_k: x[..layout.wall].to_vec(),
            energy_j: x[layout.energy],
            gas_k,
            pressure_pa: state.pressure_pa,
            wall_k_s: rate[..layout.wall].to_vec(),
            energy_w: rate[layout.energy],
        })
    };
    (0..SPECIMENS).map(one).collect()
}

/// A run at one tolerance.
#[derive(Debug, Serialize)]
pub(crate) struct Run {
    tolerance: f64,
    time: Timing,
    steps: usize,
    newton_iterations: usize,
    jacobians: usize,
    gas_k: Vec<f64>,
    /// Largest difference from the reference run, K.
    error_k: f64,
}

/// One system.
#[derive(Debug, Serialize)]
pub(crate) struct Results {
    name: String,
    states: usize,
    /// Time of one right-hand side.
    rate_time: Timing,
    /// Time of a run that ends after a second: mesh, model, first entries of the film's table.
    short_time: Timing,
    reference_gas_k: Vec<f64>,
    runs: Vec<Run>,
    runs_one_step: Vec<Run>,
}

/// Both systems at every tolerance.
pub(crate) fn run(stopwatch: &Stopwatch) -> anyhow::Result<Vec<Results>> {
    let (systems, scenario) = systems()?;
    systems.iter().map(|(name, vessel)| results(name, vessel, &scenario, stopwatch)).collect()
}

fn results(
    name: &str,
    vessel: &Vessel,
    scenario: &Scenario,
    stopwatch: &Stopwatch,
) -> anyhow::Result<Results> {
    let at = |relative_tolerance: f64, method| {
        let settings = SimulationSettings { relative_tolerance, method, ..SimulationSettings::default() };
        simulate(vessel, scenario, &settings, &mut |_| ())
    };
    let reference = at(REFERENCE, Method::Bdf)?;
    let by = |method: Method| {
        let one = |tolerance: f64| {
            let run = at(tolerance, method)?;
            let pairs = run.gas_mean_k.iter().zip(&reference.gas_mean_k);
            anyhow::Ok(Run {
                tolerance,
                time: stopwatch.time(1, || at(tolerance, method)),
                steps: run.statistics.steps,
                newton_iterations: run.statistics.newton_iterations,
                jacobians: run.statistics.linear_solver_setups,
                error_k: pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
                gas_k: run.gas_mean_k,
            })
        };
        TOLERANCES.into_iter().map(one).collect::<anyhow::Result<Vec<_>>>()
    };
    let short = Scenario { duration_s: SHORT_S, sample_time_s: SHORT_S, ..scenario.clone() };
    let short_time =
        stopwatch.time(1, || simulate(vessel, &short, &SimulationSettings::default(), &mut |_| ()));
    let model = Model::new(vessel, scenario)?;
    let x0 = model.initial_state(vessel, &scenario.initial)?;
    let inputs = InputPieces::new(scenario, 0.0, scenario.duration_s).at(0.0);
    let mut rate = vec![0.0; x0.len()];
    model.rate(&x0, &inputs, &[], &mut rate).context("the start has no derivative")?;
    Ok(Results {
        name: name.into(),
        states: x0.len(),
        short_time,
        rate_time: stopwatch.time(1, || model.rate(&x0, &inputs, &[], &mut rate)),
        runs: by(Method::Bdf)?,
        runs_one_step: by(Method::Esdirk34)?,
        reference_gas_k: reference.gas_mean_k,
    })
}
