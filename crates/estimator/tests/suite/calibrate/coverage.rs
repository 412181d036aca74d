//! Six properties 30 % off, found again from one log.
use super::study::{Case, kinds, preset};

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
