//! Nitrogen's properties over a grid of states, to compare with CoolProp.
use super::stopwatch::{Stopwatch, Timing};
use cylwatch::thermal::fluid::Fluid;
use serde::{Deserialize, Serialize};

/// Temperatures of the grid, K.
const TEMPERATURES_K: std::ops::RangeInclusive<u32> = 220..=350;
const STEP_K: usize = 10;
/// Pressures of the grid, bar.
const PRESSURES_BAR: [f64; 15] =
    [1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0, 100.0, 125.0, 150.0, 175.0, 200.0, 250.0, 300.0];

/// States: temperature, K, pressure, Pa, and the density there, kg/m³.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Inputs {
    temperature_k: Vec<f64>,
    pressure_pa: Vec<f64>,
    density_kg_m3: Vec<f64>,
}

/// Properties at the states, and the time of one state.
#[derive(Debug, Serialize)]
pub(crate) struct Results {
    /// `p(T, rho)` at the densities of the inputs.
    pressure_pa: Vec<f64>,
    /// The others are at temperature and pressure.
    density_kg_m3: Vec<f64>,
    cp_j_kg_k: Vec<f64>,
    cv_j_kg_k: Vec<f64>,
    viscosity_pa_s: Vec<f64>,
    conductivity_w_m_k: Vec<f64>,
    pressure_time: Timing,
    density_time: Timing,
    all_time: Timing,
}

/// The grid.
pub(crate) fn inputs() -> anyhow::Result<Inputs> {
    let fluid = Fluid::named("nitrogen")?;
    let grid = TEMPERATURES_K.step_by(STEP_K).flat_map(|t| PRESSURES_BAR.map(|p| (f64::from(t), 1e5 * p)));
    let (temperature_k, pressure_pa): (Vec<f64>, Vec<f64>) = grid.unzip();
    let pairs = pressure_pa.iter().zip(&temperature_k);
    let density = pairs.map(|(&p, &t)| fluid.density_from_pressure_temperature(p, t));
    let density_kg_m3 = density.collect::<Result<_, _>>()?;
    Ok(Inputs { temperature_k, pressure_pa, density_kg_m3 })
}

/// Density, both heat capacities, viscosity and conductivity at a pressure and temperature.
fn all(fluid: &Fluid, p: f64, t: f64) -> [f64; 5] {
    let Ok(rho) = fluid.density_from_pressure_temperature(p, t) else { return [f64::NAN; 5] };
    let state = fluid.state(rho, t);
    [rho, state.cp_j_kg_k, state.cv_j_kg_k, fluid.viscosity_pa_s(rho, t), fluid.conductivity_w_m_k(rho, t)]
}

/// Evaluates the grid.
pub(crate) fn run(inputs: &Inputs, stopwatch: &Stopwatch) -> anyhow::Result<Results> {
    let fluid = Fluid::named("nitrogen")?;
    let states = || inputs.pressure_pa.iter().copied().zip(inputs.temperature_k.iter().copied());
    let dense = || inputs.density_kg_m3.iter().copied().zip(inputs.temperature_k.iter().copied());
    let values: Vec<[f64; 5]> = states().map(|(p, t)| all(&fluid, p, t)).collect();
    let column = |k: usize| values.iter().map(|row| row[k]).collect();
    let count = inputs.temperature_k.len();
    Ok(Results {
        pressure_pa: dense().map(|(rho, t)| fluid.pressure_pa(rho, t)).collect(),
        density_kg_m3: column(0),
        cp_j_kg_k: column(1),
        cv_j_kg_k: column(2),
        viscosity_pa_s: column(3),
        conductivity_w_m_k: column(4),
        pressure_time: stopwatch
            .time(count, || dense().map(|(rho, t)| fluid.pressure_pa(rho, t)).sum::<f64>()),
        density_time: stopwatch.time(count, || {
            let densities = states().filter_map(|(p, t)| fluid.density_from_pressure_temperature(p, t).ok());
            densities.sum::<f64>()
        }),
        all_time: stopwatch
            .time(count, || states().map(|(p, t)| all(&fluid, p, t).iter().sum::<f64>()).sum::<f64>()),
    })
}
