//! Specimens: distributions, limits, streams.
use cylwatch_thermal::sensor::SensorSpec;
use cylwatch_thermal::vessel;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;

const N: usize = 20_000;

fn sensor(name: &str, change: impl FnOnce(&mut SensorSpec)) -> Sensor {
    let mut spec = SensorSpec { name: name.into(), ..SensorSpec::default() };
    change(&mut spec);
    Sensor::try_from(&spec).unwrap()
}

/// Values of one parameter in many specimens.
fn specimens(sensor: &Sensor, parameter: usize, seed: u64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..N).map(|_| sensor.draw(&mut rng).parameters[parameter]).collect()
}

/// Share of values below a bound.
fn share_below(values: &[f64], bound: f64) -> f64 {
    values.iter().filter(|&&value| value < bound).count() as f64 / values.len() as f64
}

/// The largest distance between an empirical and a true distribution stays below 1.95 / sqrt(n) in 999 of 1000
/// samples (Kolmogorov).
fn assert_distributed(mut values: Vec<f64>, distribution: impl Fn(f64) -> f64) {
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let distance = values
        .iter()
        .enumerate()
        .map(|(i, &value)| (distribution(value) - (i as f64 + 0.5) / n).abs())
        .fold(0.0, f64::max);
    assert!(distance < 1.95 / n.sqrt(), "{distance}");
}

#[test]
fn offsets_of_a_class_are_uniform_within_its_tolerance() {
    let class_a = sensor("valve", |spec| spec.class = Some(crate::sensor::Pt100Class::A));
    // 0.15 + 0.002 x 20 = 0.19 K.
    let offsets = specimens(&class_a, 0, 11);
    assert!(offsets.iter().all(|b| b.abs() <= 0.19 + 1e-12));
    assert_distributed(offsets, |b| 0.5 + 0.5 * b / 0.19);
}

#[test]
fn other_parameters_are_normal() {
    use statrs::distribution::{ContinuousCDF, Normal};
    let transmitter = sensor("pressure", |spec| {
        (spec.temperature_coefficient_pa_k, spec.temperature_coefficient_sd_pa_k) =
            (Some(500.0), Some(2500.0));
        spec.span_sd_ratio = Some(1e-3);
    });
    let normal = |mean, sd| Normal::new(mean, sd).unwrap();
    assert_distributed(specimens(&transmitter, 1, 12), |c| normal(500.0, 2500.0).cdf(c));
    assert_distributed(specimens(&transmitter, 2, 13), |s| normal(0.0, 1e-3).cdf(s));
    assert!(specimens(&transmitter, 0, 14).iter().all(|&b| b == 0.0));
}

#[test]
fn couplings_are_normal_and_cut_at_nothing_and_all() {
    use statrs::distribution::{ContinuousCDF, Normal};
    let strapped =
        sensor("shoulder", |spec| (spec.air_coupling, spec.air_coupling_sd) = (Some(0.1), Some(0.08)));
    let couplings = specimens(&strapped, 1, 15);
    assert_eq!(share_below(&couplings, 0.0), 0.0);
    let normal = Normal::new(0.1, 0.08).unwrap();
    let (none, all) = (normal.cdf(0.0), normal.cdf(1.0));
    assert_distributed(couplings, |kappa| (normal.cdf(kappa) - none) / (all - none));
}

#[test]
fn a_specimen_depends_on_the_seed_and_on_its_name_alone() {
    let uncertain = |name: &str| sensor(name, |spec| spec.offset_sd_k = Some(0.3));
    let offset = |suite: &SensorSuite, seed: u64, name: &str| {
        suite.draw(seed).find_mut(name).unwrap().truth.parameters[0]
    };
    let alone = SensorSuite::try_new(vec![uncertain("valve")]).unwrap();
    let more = ["bottom", "valve", "shoulder"].map(uncertain).to_vec();
    let more = SensorSuite::try_new(more).unwrap();
    assert_eq!(offset(&alone, 3, "valve"), offset(&more, 3, "valve"));
    assert_ne!(offset(&alone, 3, "valve"), offset(&alone, 4, "valve"));
    assert_ne!(offset(&more, 3, "valve"), offset(&more, 3, "shoulder"));
}

#[test]
fn an_ideal_sensor_has_its_means_and_its_lag_and_nothing_else() {
    let real = sensor("shoulder", |spec| {
        (spec.air_coupling, spec.air_coupling_sd) = (Some(0.1), Some(0.04));
        (spec.offset_k, spec.offset_sd_k) = (Some(0.2), Some(0.3));
        (spec.noise_k, spec.resolution_k, spec.lag_s) = (Some(0.05), Some(0.1), Some(20.0));
        (spec.drift_k_s, spec.dropout) = (Some(1e-6), Some(0.5));
        (spec.walk_sd_k, spec.walk_time_s) = (Some(0.1), Some(60.0));
        (spec.correlated_noise_k, spec.correlation_time_s) = (Some(0.1), Some(60.0));
    });
    let expected = sensor("shoulder", |spec| {
        (spec.air_coupling, spec.offset_k, spec.lag_s) = (Some(0.1), Some(0.2), Some(20.0));
    });
    assert_eq!(real.ideal(), expected);
}

#[test]
fn two_sensors_of_one_name_are_refused() {
    let twice = vec![sensor("valve", |_| ()), sensor("valve", |_| ())];
    let message = SensorSuite::try_new(twice).unwrap_err().to_string();
    assert_eq!(message, "sensor `valve` is there twice; give each sensor a name of its own");
}

#[test]
fn sensors_without_a_place_on_the_vessel_are_set_aside() {
    let bottle = vessel::presets::load("closed-bottle").unwrap();
    assert!(bottle.valve.is_none());
    let height = |name: &str, height_m| {
        sensor(name, |spec| {
            (spec.kind, spec.height_m) = (Some(crate::sensor::KindChoice::Surface), Some(height_m));
        })
    };
    let sensors = vec![
        sensor("shoulder", |_| ()),
        sensor("valve", |_| ()),
        sensor("gas_1", |_| ()),
        sensor("gas_99", |_| ()),
        height("low", 0.1),
        height("high", 40.0),
        sensor("pressure", |_| ()),
        sensor("ambient", |_| ()),
    ];
    let (fitting, others) = SensorSuite::try_new(sensors).unwrap().split_by_fit(&bottle);
    let names = |sensors: &[Sensor]| sensors.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(fitting.sensors()), ["shoulder", "gas_1", "low", "pressure", "ambient"]);
    assert_eq!(names(&others), ["valve", "gas_99", "high"]);
    let needs: Vec<String> = others.iter().filter_map(|sensor| sensor.misfit(&bottle)).collect();
    assert_eq!(needs, ["a valve", "99 gas cells", "a wall at 40 m"]);
}
