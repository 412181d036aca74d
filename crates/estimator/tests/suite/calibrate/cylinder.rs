//! What the example claims.
#[allow(dead_code)]
#[path = "../../../examples/calibrate_cylinder.rs"]
mod example;

use cylwatch_estimator::calibrate::ParameterKind;

#[test]
fn one_log_finds_six_numbers_that_are_30_percent_off_and_predicts_the_next_scenario() {
    let calibrated = example::calibrated().unwrap();
    for one in example::wrong() {
        let found = calibrated.estimate(&one.kind).unwrap();
        assert!((found.value - one.truth).abs() < 4.0 * found.sd, "{found:?}, true {}", one.truth);
        // No sensor sees the contact well.
        let widest = if one.kind == ParameterKind::ValveContact { 0.6 } else { 0.05 };
        assert!(found.sd < widest * found.value, "{found:?}");
    }
    let [before, after] = example::prediction(&calibrated).unwrap();
    assert!(before > 1.0 && after < before / 10.0, "{before} K before, {after} K after");
}
