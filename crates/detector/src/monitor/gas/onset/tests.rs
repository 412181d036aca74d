use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, Matrix2};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::*;

const HOUR_S: f64 = 3600.0;
const G_H: f64 = 1e-3 / HOUR_S;

/// Hourly bins without a sample missing.
fn hourly(mass_kg: impl Fn(f64) -> f64, hours: usize) -> Vec<Bin> {
    (0..hours)
        .map(|hour| {
            let time_s = HOUR_S * hour as f64;
            Bin { time_s, mass_kg: mass_kg(time_s), samples: 60 }
        })
        .collect()
}

/// A trace with Ornstein-Uhlenbeck errors of the default size and a leak.
fn drawn(rate_kg_s: f64, onset_s: f64, days: usize, random: &mut ChaCha8Rng) -> MassTrace {
    let error = MassError::default();
    let (mut trace, mut wander) = (MassTrace::default(), 0.0);
    let step_s = 600.0;
    let phi = (-step_s / error.time_s).exp();
    for step in 0..days * 144 {
        let time_s = step_s * step as f64;
        let normal: f64 = random.sample(StandardNormal);
        let fresh = if step == 0 { 1.0 } else { (1.0 - phi * phi).sqrt() };
        wander = if step == 0 { 0.0 } else { phi * wander } + fresh * error.sd_kg * normal;
        trace.push(time_s, 4.4 - rate_kg_s * (time_s - onset_s).max(0.0) + wander);
    }
    trace
}

#[test]
fn rate_and_deviation_of_an_onset_are_those_of_dense_generalised_least_squares() {
    let error = MassError::default();
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut bins = hourly(|_| 4.4, 40);
    for bin in &mut bins {
        bin.time_s += 900.0 * random.random::<f64>();
        bin.mass_kg += error.sd_kg * random.sample::<f64, _>(StandardNormal);
    }
    let n = bins.len();
    let covariance = DMatrix::from_fn(n, n, |i, j| {
        error.sd_kg.powi(2) * (-(bins[i].time_s - bins[j].time_s).abs() / error.time_s).exp()
    });
    let inverse = covariance.try_inverse().unwrap();
    for candidate in candidates(&bins, &error) {
        let ramp = |bin: &Bin| -(bin.time_s - candidate.onset_s).max(0.0);
        let design = DMatrix::from_fn(n, 2, |i, j| if j == 0 { 1.0 } else { ramp(&bins[i]) });
        let y = DVector::from_fn(n, |i, _| bins[i].mass_kg);
        let normal = design.transpose() * &inverse * &design;
        let spread = Matrix2::from_fn(|i, j| normal[(i, j)]).try_inverse().unwrap();
        let right = design.transpose() * &inverse * y;
        let rate = spread[(1, 0)] * right[0] + spread[(1, 1)] * right[1];
        assert_relative_eq!(candidate.rate, rate, max_relative = 1e-6, epsilon = 1e-14);
        assert_relative_eq!(candidate.sd, spread[(1, 1)].sqrt(), max_relative = 1e-8);
    }
}

#[test]
fn a_clean_kink_is_found_where_it_is() {
    let onset_s = 100.0 * HOUR_S;
    let bins = hourly(|t| 4.4 - 2.0 * G_H * (t - onset_s).max(0.0), 300);
    let best = candidates(&bins, &MassError::default())
        .into_iter()
        .max_by(|a, b| a.log_likelihood_ratio.total_cmp(&b.log_likelihood_ratio))
        .unwrap();
    assert_eq!(best.onset_s, onset_s);
    assert_relative_eq!(best.rate, 2.0 * G_H, max_relative = 1e-9);
}

#[test]
fn intervals_hold_rate_onset_and_loss_as_often_as_they_say() {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let runs = 300;
    for (rate_g_h, after_d) in [(0.5, 6), (2.0, 3), (20.0, 1)] {
        let mut inside = [0; 3];
        for _ in 0..runs {
            let onset_s = 10.0 * 86_400.0 + 86_400.0 * random.random::<f64>();
            let days = 11 + after_d;
            let fitted = fit(&drawn(rate_g_h * G_H, onset_s, days, &mut random), &MassError::default());
            let fitted = fitted.unwrap();
            let lost_kg = rate_g_h * G_H * (days as f64 * 86_400.0 - 600.0 - onset_s);
            let held = [
                fitted.rate_kg_s.holds(rate_g_h * G_H),
                fitted.onset_s.holds(onset_s),
                fitted.lost_kg.holds(lost_kg),
            ];
            inside.iter_mut().zip(held).for_each(|(count, held)| *count += u32::from(held));
        }
        let shares = inside.map(|count| f64::from(count) / f64::from(runs));
        println!("{rate_g_h} g/h: rate {} onset {} lost {}", shares[0], shares[1], shares[2]);
        assert!(shares[0] >= 0.92 && shares[1] >= 0.92 && shares[2] >= 0.92, "{shares:?}");
    }
}

#[test]
fn without_a_loss_there_is_no_leak_and_short_traces_say_nothing() {
    let mut trace = MassTrace::default();
    assert_eq!(fit(&trace, &MassError::default()), None);
    for step in 0..500 {
        // More and more gas: no onset of a loss explains it better.
        trace.push(600.0 * f64::from(step), 4.4 + 1e-4 * f64::from(step));
    }
    assert_eq!(fit(&trace, &MassError::default()), None);
}
