//! Six properties 30 % off, found again from one log.
use cylwatch_estimator::calibrate::{ParameterKind, ParameterSpec};
use cylwatch_thermal::model::Model;
use cylwatch_thermal::vessel;
use cylwatch_thermal::vessel::Fill;

use super::study::{Case, kinds, preset, run};

/// 50 seeds: `cargo run --release -p cylwatch-estimator --example calibrate_coverage`.
#[test]
fn six_parameters_that_are_30_percent_off_lie_in_their_intervals() {
    let mut scenario = preset("tunnel-step");
    scenario.sample_time_s = 30.0;
    let (mut inside, mut tried) = (0, 0);
    for seed in 1..=2 {
        let case = Case::new(seed);
        let calibrated = case.calibration(&scenario).run().unwrap();
        let covered = case.covered(&calibrated);
        for (i, kind) in kinds().iter().enumerate() {
            let found = &calibrated.estimates[i];
            println!(
                "{seed} {kind}: {:.4} ± {:.4}, true {:.4} {}",
                found.value, found.sd, case.truth[i], covered[i]
            );
        }
        inside += covered.iter().filter(|inside| **inside).count();
        tried += covered.len();
    }
    // Fewer than 10 of 12 intervals of 95 % have a chance of 2 %.
    assert!(inside >= 10, "{inside} of {tried}");
}

#[test]
fn prediction_of_the_next_scenario_improves_at_least_threefold() {
    let case = Case::new(11);
    let calibrated = case.calibration(&preset("shock-cold")).run().unwrap();
    let (before, after) = case.prediction(&calibrated, &preset("tunnel-winter"));
    println!("rms of the mean gas temperature: {before:.3} K before, {after:.4} K after");
    assert!(before > 3.0 * after, "{before} K before, {after} K after");
}

/// At 1.3 times the fill the warm gas is beyond the transmitter's range: it then reads the end of it, which is no pressure.
#[test]
fn fill_that_is_far_off_is_found_though_the_transmitter_ends_before_it() {
    let case = Case::new(3);
    let mut scenario = preset("tunnel-step");
    scenario.sample_time_s = 30.0;
    let nominal = vessel::presets::load("nitrogen-20l").unwrap();
    let model = Model::new(&nominal, &scenario).unwrap();
    let stated_kg = model.mass_kg(&model.initial_state(&nominal, &scenario.initial).unwrap());
    for factor in [0.6, 1.3] {
        let mut filled = case.exposed(&scenario);
        filled.initial.fill = Fill::Mass { mass_kg: factor * stated_kg };
        let mut calibration = case.calibration(&scenario);
        calibration.experiments[0].log = case.readings(&run(&case.vessel(), &filled));
        calibration.parameters.push(ParameterSpec::new(ParameterKind::FillMass, 1.0));
        let calibrated = calibration.run().unwrap();
        let found = calibrated.estimate(&ParameterKind::FillMass).unwrap();
        assert!((found.value - factor).abs() < 3.0 * found.sd, "{found:?} instead of {factor}");
        assert!(found.sd < 0.01, "{found:?}");
    }
}
