use super::*;
use crate::units::HOUR_S;

const G_H: f64 = 1e-3 / HOUR_S;

/// Onsets every hour with rates of so many standard deviations of 1 g/h.
fn onsets(z: impl Fn(usize) -> f64) -> Vec<(f64, f64, f64)> {
    (0..24).map(|hour| (HOUR_S * hour as f64, z(hour) * G_H, G_H)).collect()
}

#[test]
fn one_onset_that_stands_out_gives_onset_rate_and_loss() {
    let end_s = 24.0 * HOUR_S;
    let fitted = Posterior::of(&onsets(|hour| if hour == 10 { 12.0 } else { 2.0 }), end_s, 0.0).unwrap();
    assert!(fitted.speaks_for_a_loss && fitted.log_bayes_factor > 50.0);
    let close = |value: f64, expected: f64| (value / expected - 1.0).abs() < 0.01;
    let Interval { value, low, high } = fitted.rate_kg_s();
    assert!(close(value, 12.0 * G_H) && close(low, 10.04 * G_H) && close(high, 13.96 * G_H));
    // What a triangle of an hour either way holds 95 % of, and ten minutes.
    let half_s = (1.0 - 0.05_f64.sqrt()) * HOUR_S;
    assert!((fitted.onset_s().value - 10.0 * HOUR_S).abs() < 1.0);
    assert!((fitted.onset_s().low - 10.0 * HOUR_S + half_s + 600.0).abs() < 1.0);
    assert!((fitted.onset_s().high - 10.0 * HOUR_S - half_s - 600.0).abs() < 1.0);
    assert!(close(fitted.lost_kg().value, 12.0 * G_H * 14.0 * HOUR_S));
}

#[test]
fn errors_that_no_innovation_shows_widen_the_rate() {
    let rate = |drift: f64| Posterior::of(&onsets(|_| 12.0), 24.0 * HOUR_S, drift).unwrap().rate_kg_s();
    let [without, with] = [0.0, 2.0 * G_H].map(rate).map(|rate| rate.high - rate.low);
    // 1 g/h and 1 % of 12 g/h, and 2 g/h beside.
    assert!((with / without - 1.0_f64.hypot(0.12).hypot(2.0) / 1.0_f64.hypot(0.12)).abs() < 0.01);
}

#[test]
fn without_a_loss_there_is_a_rate_that_a_leak_is_below_and_a_factor_against_it() {
    let fitted = Posterior::of(&onsets(|_| -1.0), 24.0 * HOUR_S, 0.0).unwrap();
    assert!(!fitted.speaks_for_a_loss && fitted.log_bayes_factor < -1.0);
    assert!(fitted.rate_kg_s().high > 0.5 * G_H && fitted.rate_kg_s().high < 2.0 * G_H);
}

#[test]
fn without_onsets_nothing_is_said_and_one_has_its_own_rate() {
    assert_eq!(Posterior::of(&[], 3.0 * HOUR_S, 0.0), None);
    let fitted = Posterior::of(&[(0.0, 9.0 * G_H, G_H)], HOUR_S, 0.0).unwrap();
    assert!((fitted.rate_kg_s().value / (9.0 * G_H) - 1.0).abs() < 1e-3);
}
