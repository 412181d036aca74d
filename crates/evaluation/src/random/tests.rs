//! Streams of random numbers and the Ornstein-Uhlenbeck process.
use super::{OrnsteinUhlenbeck, Purpose, Random};
use crate::world::statistics::{Law, assert_equal_counts, assert_law, assert_share, mean, sd};

fn draws(seed: u64, purpose: Purpose) -> Vec<f64> {
    let mut random = Random::new(seed, purpose);
    (0..20).map(|_| random.normal()).collect()
}

#[test]
fn a_stream_is_repeated_by_its_seed_and_shared_with_no_other() {
    let of = || draws(7, Purpose::WorldWeather);
    assert_eq!(of(), of());
    for (seed, purpose) in
        [(8, Purpose::WorldWeather), (7, Purpose::WorldSun), (7, Purpose::ChamberPressureNoise)]
    {
        let other = draws(seed, purpose);
        assert!(of().iter().all(|value| !other.contains(value)));
    }
}

#[test]
fn uniform_whole_and_signed_numbers_keep_to_their_laws() {
    let mut random = Random::new(1, Purpose::WorldVessel);
    let values: Vec<f64> = (0..4000).map(|_| random.uniform((-3.0, 5.0))).collect();
    assert_law("uniform", &values, Law::Uniform(-3.0, 5.0));
    let mut counts = [0; 4];
    (0..4000).for_each(|_| counts[random.whole((3, 6)) - 3] += 1);
    assert_equal_counts("whole", &counts);
    let signed: Vec<f64> = (0..4000).map(|_| random.either_sign((2.0, 3.0))).collect();
    let magnitudes: Vec<f64> = signed.iter().map(|value| value.abs()).collect();
    assert_law("magnitude", &magnitudes, Law::Uniform(2.0, 3.0));
    assert_share("positive", signed.iter().filter(|&&value| value > 0.0).count(), 4000, 0.5);
}

/// Mean of `x(t) x(t + lag)` over a process, its error's standard deviation being about `sqrt(2 tau / T)`.
fn autocovariance(process: &OrnsteinUhlenbeck, duration_s: f64, step_s: f64, lag_s: f64) -> f64 {
    let samples = ((duration_s - lag_s) / step_s) as usize;
    let product = |k: usize| {
        let t_s = k as f64 * step_s;
        process.at(t_s) * process.at(t_s + lag_s)
    };
    (0..samples).map(product).sum::<f64>() / samples as f64
}

#[test]
fn ornstein_uhlenbeck_has_unit_variance_in_the_mean_over_time_and_its_correlation_time() {
    // Steps that see every part of the lines between the knots alike.
    let (time_s, spacing_s, duration_s) = (120.0, 120.0, 1.2e7);
    let process =
        OrnsteinUhlenbeck::draw(&mut Random::new(3, Purpose::WorldTurbulence), time_s, spacing_s, duration_s);
    let variance = autocovariance(&process, duration_s, spacing_s / 10.0, 0.0);
    let doubt = (2.0 * time_s / duration_s).sqrt();
    assert!((variance - 1.0).abs() < 4.0 * doubt, "variance {variance} ± {doubt}");
    // At the knots, k spacings apart, the correlation is that of the process itself.
    let at_knots = |k: f64| autocovariance(&process, duration_s, spacing_s, k * spacing_s);
    for k in 1..=3 {
        let correlation = at_knots(f64::from(k)) / at_knots(0.0);
        let expected = (-f64::from(k) * spacing_s / time_s).exp();
        assert!((correlation - expected).abs() < 4.0 * doubt, "lag {k}: {correlation}, {expected}");
    }
}

#[test]
fn ornstein_uhlenbeck_starts_stationary() {
    let first: Vec<f64> = (0..4000)
        .map(|seed| {
            let random = &mut Random::new(seed, Purpose::WorldWeather);
            OrnsteinUhlenbeck::draw(random, 172_800.0, 3600.0, 7200.0).at(0.0)
        })
        .collect();
    // Knots an hour apart lie close to the process itself; the stretch for the lines adds a third of 2 %.
    let r = (-3600_f64 / 172_800.0).exp();
    let expected = (3.0 / (2.0 + r)).sqrt();
    let deviation = sd(&first) / expected;
    assert!((deviation - 1.0).abs() < 4.0 / (2.0_f64 * 4000.0).sqrt(), "sd over expected {deviation}");
    assert!(mean(&first).abs() < 4.0 / 4000_f64.sqrt(), "mean {}", mean(&first));
}
