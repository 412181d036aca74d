//! The stratified gas in discharges of two vessels that it was not fitted to.
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{GasResolution, Stratification};

use super::{Curve, at, case, curve, extreme, rms, run};

/// Forty cells: below that an edge moves with their number.
fn in_layers(name: &str) -> Trajectory {
    let (mut vessel, scenario) = case(name, "discharge");
    vessel.gas = GasResolution::Stratified(Stratification { cells: 40, ..Default::default() });
    run(&vessel, &scenario)
}

/// Mean difference of the warmest and the coldest, K: of the model, and measured, at the times of the second curve.
fn spread(run: &Trajectory, high: &Curve, low: &Curve) -> (f64, f64) {
    let (warm, cold) = (extreme(&run.gas_cells_k, f64::max), extreme(&run.gas_cells_k, f64::min));
    println!("  {} gas cells", run.gas_cells_k[0].len());
    rms("warmest", &run.time_s, &warm, high);
    rms("coldest", &run.time_s, &cold, low);
    let (times, values): (Vec<f64>, Vec<f64>) = high.iter().copied().unzip();
    let mean =
        |of: &dyn Fn(f64, f64) -> f64| low.iter().map(|&(t, v)| of(t, v)).sum::<f64>() / low.len() as f64;
    let model = mean(&|t, _| at(&run.time_s, &warm, t) - at(&run.time_s, &cold, t));
    let measured = mean(&|t, v| at(&times, &values, t) - v);
    println!("  spread {model:.1} K, measured {measured:.1} K");
    (model, measured)
}

/// Woodfield et al. 2007: 0.94 L of hydrogen, standing. Two thermometers span less than the extremes do; warmest and coldest are met to 11 and 7 K.
#[test]
fn layers_of_a_standing_vessel_spread_by_half_more_than_two_thermometers_say() {
    let run = in_layers("woodfield_2007");
    let (high, low) =
        (curve("woodfield_2007", "discharge_gas_high"), curve("woodfield_2007", "discharge_gas_low"));
    let (model, measured) = spread(&run, &high, &low);
    assert!((0.5..2.5).contains(&(model / measured)));
}

/// de Miguel et al. 2015: 29 L of hydrogen, lying. The model's wall has one temperature around the circumference, which takes the layers away.
#[test]
fn layers_of_a_lying_tank_are_lost_by_the_model() {
    let run = in_layers("demiguel_2015");
    let (model, measured) =
        spread(&run, &curve("demiguel_2015", "gas_high"), &curve("demiguel_2015", "gas_low"));
    assert!(measured > 20.0 && model < 0.2 * measured);
}
