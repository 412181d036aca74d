//! Scores of errors that are known in closed form, and the transfer function against its step response.
use approx::assert_relative_eq;

use super::super::{CylinderParameters, PressureSensor, SensorParameters, TemperatureSensor, TruthLeak};
use super::*;
use crate::estimator::log::{Channel, Log, Quantity};
use crate::estimator::observer::Quality;
use crate::thermal::vessel::presets;

const STEP_S: f64 = 10.0;
/// Gain and pole of the paper, the latter in 1/s.
const GAIN: f64 = 1.033;
const POLE_PER_S: f64 = 0.003021;

/// A truth with gas of 280 K, 4 kg and 190 bar for ever, and a shoulder that reads `shoulder_k`.
fn truth(course: Course, step_s: f64, shoulder_k: impl Fn(f64) -> f64) -> Truth {
    let samples = (course.duration_s() / step_s).round() as usize + 1;
    let time_s: Vec<f64> = (0..samples).map(|k| k as f64 * step_s).collect();
    let constant = |value: f64| vec![value; samples];
    let surface = TemperatureSensor { offset_k: 0.0, air_coupling: 0.1 };
    let channel = |name: &str, quantity| Channel { name: name.into(), quantity };
    Truth {
        course,
        seed: 0,
        parameters: CylinderParameters {
            outside_film: 1.0,
            inside_film: 1.0,
            wall_capacity: 1.0,
            valve_capacity: 1.0,
            valve_contact: 1.0,
            emissivity: 0.9,
            thermal_expansion: 1.0,
            pressure_expansion: 1.0,
            film_slope: 0.0,
            exchange_length_diameters: 1.0,
            core_mixing: 0.05,
        },
        sensors: SensorParameters {
            shoulder: surface,
            valve: surface,
            middle: surface,
            bottom: surface,
            pressure: PressureSensor { offset_pa: 0.0, coefficient_pa_k: 0.0 },
        },
        leak: None,
        gas_mean_k: constant(280.0),
        mass_kg: constant(4.0),
        pressure_pa: constant(190e5),
        ambient_k: constant(280.0),
        wall_mean_k: constant(280.0),
        shoulder_k: time_s.iter().map(|&t| shoulder_k(t)).collect(),
        valve_k: constant(280.0),
        middle_k: constant(280.0),
        bottom_k: constant(280.0),
        log: Log {
            channels: vec![
                channel("pressure", Quantity::Pressure),
                channel("shoulder", Quantity::Temperature),
            ],
            values: time_s.iter().flat_map(|&t| [190e5, shoulder_k(t)]).collect(),
            time_s: time_s.clone(),
        },
        time_s,
    }
}

/// Scores estimates that are wrong by `gas_k` and `mass_kg` of the time since the change of the air, with standard
/// deviations of 0.2 K and 2 g.
fn scored(truth: &Truth, gas_k: impl Fn(f64) -> f64, mass_kg: impl Fn(f64) -> f64) -> Score {
    let pairs: Vec<Pair> = (0..truth.time_s.len())
        .filter(|&index| truth.time_s[index] >= commissioning_s(truth))
        .map(|index| {
            let since_s = truth.time_s[index] - truth.course.change_s();
            let estimate = Estimate {
                time_s: truth.time_s[index],
                gas_mean_k: truth.gas_mean_k[index] + gas_k(since_s),
                gas_mean_sd_k: 0.2,
                mass_kg: truth.mass_kg[index] + mass_kg(since_s),
                mass_sd_kg: 0.002,
                leak_kg_s: 1e-6,
                leak_sd_kg_s: 1e-7,
                pressure_pa: truth.pressure_pa[index],
                pressure_expected_pa: f64::NAN,
                p15_pa: f64::NAN,
                quality: Quality::Good,
            };
            pair(truth, index, &estimate)
        })
        .collect();
    summarise(truth, &pairs)
}

fn still(course: Course) -> Truth {
    truth(course, STEP_S, |_| 280.0)
}

#[test]
fn a_constant_error_is_all_bias_and_no_deviation() {
    let truth = still(Course::Scenario1);
    let score = scored(&truth, |_| -0.3, |_| 0.007);
    // From the change on, both ends included: three hours.
    assert_eq!(score.samples, 1081);
    assert_relative_eq!(score.gas_rms_k, 0.3, max_relative = 1e-9);
    assert_relative_eq!(score.gas_bias_k, -0.3, max_relative = 1e-9);
    assert_relative_eq!(score.gas_max_k, 0.3, max_relative = 1e-9);
    assert_relative_eq!(score.mass_bias_kg, 0.007, max_relative = 1e-9);
    // Relative to the commissioning hour, a constant error of the mass is none.
    assert!(score.mass_sd_kg < 1e-12 && score.mass_rms_kg < 1e-12);
    assert_relative_eq!(score.gas_stated_k, 0.2, max_relative = 1e-9);
    assert_relative_eq!(score.mass_stated_kg, 0.002, max_relative = 1e-9);
    assert_eq!((score.gas_coverage, score.mass_coverage), (1.0, 0.0), "0.3 K of 0.39, 7 g of 3.9");
}

#[test]
fn a_ramp_scores_the_moments_of_its_samples() {
    let truth = still(Course::Scenario1);
    let (a, b, hours) = (1e-4, 1e-6, 3.0 * 3600.0);
    let score = scored(&truth, |t| a * t.max(0.0), |t| b * t.max(0.0));
    // n + 1 even samples of a ramp from 0 to A: mean A/2, mean square A² (2n + 1)/(6n), variance A² (n + 2)/(12 n).
    let n = hours / STEP_S;
    assert_relative_eq!(score.gas_bias_k, a * hours / 2.0, max_relative = 1e-9);
    assert_relative_eq!(score.gas_max_k, a * hours, max_relative = 1e-9);
    assert_relative_eq!(
        score.gas_rms_k,
        a * hours * ((2.0 * n + 1.0) / (6.0 * n)).sqrt(),
        max_relative = 1e-9
    );
    assert_relative_eq!(score.mass_sd_kg, b * hours * ((n + 2.0) / (12.0 * n)).sqrt(), max_relative = 1e-8);
    // The error of the commissioning hour is zero: relative is absolute.
    assert_relative_eq!(
        score.mass_rms_kg,
        b * hours * ((2.0 * n + 1.0) / (6.0 * n)).sqrt(),
        max_relative = 1e-8
    );
    // Inside the band until 1.96 times 0.2 K and 2 g, both after 3919.9 s: 392 samples of 1081.
    assert_relative_eq!(score.gas_coverage, 392.0 / 1081.0, max_relative = 1e-12);
    assert_relative_eq!(score.mass_coverage, 392.0 / 1081.0, max_relative = 1e-12);
}

#[test]
fn masses_are_compared_with_their_mean_error_in_the_commissioning_hour() {
    let truth = still(Course::Tunnel);
    // 3 g before the change, 5 g after it: 2 g relative, no deviation about the mean.
    let score = scored(&truth, |_| 0.0, |t| if t < 0.0 { 0.003 } else { 0.005 });
    assert_relative_eq!(score.mass_rms_kg, 0.002, max_relative = 1e-9);
    assert_relative_eq!(score.mass_bias_kg, 0.005, max_relative = 1e-9);
    assert!(score.mass_sd_kg < 1e-12);
}

#[test]
fn railway_weeks_are_judged_after_ten_days_and_masses_against_their_own_mean() {
    let week = |days| truth(Course::RailwayWeeks { days }, 600.0, |_| 280.0);
    let day = 86_400.0;
    let score = scored(&week(12.0), |t| if t < 10.0 * day { 9.0 } else { 0.1 }, |t| 1e-8 * t);
    assert_eq!(score.samples, 2 * 144 + 1);
    assert_relative_eq!(score.gas_rms_k, 0.1, max_relative = 1e-9);
    assert_relative_eq!(score.mass_bias_kg, 1e-8 * 11.0 * day, max_relative = 1e-9);
    assert_relative_eq!(score.mass_rms_kg, score.mass_sd_kg, max_relative = 1e-9);
    // Too short to learn in: judged from the beginning.
    assert_eq!(scored(&week(3.0), |_| 0.0, |_| 0.0).samples, 3 * 144 + 1);
}

#[test]
fn what_was_learnt_before_a_chamber_course_does_not_count() {
    let learnt = Course::Learnt { days: 0.5, then: Box::new(Course::Scenario1) };
    let truth = still(learnt);
    let score =
        scored(&truth, |t| if t < 0.0 { 9.0 } else { 0.1 }, |t| if t < -3601.0 { 1.0 } else { 0.001 });
    assert_eq!(score.samples, 1081);
    assert_relative_eq!(score.gas_rms_k, 0.1, max_relative = 1e-9);
    assert!(score.mass_rms_kg < 1e-12, "the hour before the change is the reference");
}

#[test]
fn a_leak_rate_is_compared_with_the_leak_while_it_lasts() {
    let mut truth = still(Course::Scenario1);
    // Estimated 1e-6 kg/s throughout; the true leak of 3e-6 opens after a quarter of the 10 800 s judged.
    truth.leak = Some(TruthLeak { rate_kg_s: 3e-6, start_s: 3600.0 + 2700.0 });
    let score = scored(&truth, |_| 0.0, |_| 0.0);
    let share: f64 = 270.0 / 1081.0;
    // Two values, 1e-6 and -2e-6: deviation 3e-6 sqrt(share (1 - share)).
    assert_relative_eq!(score.leak_sd_kg_s, 3e-6 * (share * (1.0 - share)).sqrt(), max_relative = 1e-9);
}

/// Response of `y' = p (g u - y)`, settled at `u(0) = 0`, to a ramp of `u` from 0 to one within `rise_s`.
fn step_response(t_s: f64, rise_s: f64) -> f64 {
    let ramp = |t_s: f64| {
        if t_s <= 0.0 { 0.0 } else { t_s - (1.0 - (-POLE_PER_S * t_s).exp()) / POLE_PER_S }
    };
    GAIN * (ramp(t_s) - ramp(t_s - rise_s)) / rise_s
}

#[test]
fn the_transfer_function_answers_a_step_as_its_closed_form() {
    let nominal = presets::load("nitrogen-20l").unwrap();
    let (from_degc, height_k, at_s) = (4.0, 30.0, 3600.0);
    for step_s in [10.0, 60.0, 300.0] {
        // The reading jumps between two samples.
        let shoulder = |t: f64| 273.15 + from_degc + height_k * ((t - at_s) / step_s).clamp(0.0, 1.0);
        let mut truth = truth(Course::Scenario1, step_s, shoulder);
        for (t_s, gas_k) in truth.time_s.iter().zip(&mut truth.gas_mean_k) {
            *gas_k = 273.15 + GAIN * from_degc + height_k * step_response(t_s - at_s, step_s);
        }
        let score =
            score_transfer_function(&truth, &nominal, TransferFunction::new(GAIN, POLE_PER_S)).unwrap();
        assert!(score.gas_max_k < 1e-9, "{} K at {step_s} s", score.gas_max_k);
        assert!(score.nis.is_nan() && score.gas_stated_k.is_nan());
    }
}

#[test]
fn the_transfer_function_reaches_63_percent_after_331_seconds() {
    let nominal = presets::load("nitrogen-20l").unwrap();
    let shoulder = |t: f64| 273.15 + 10.0 * f64::from(u8::from(t > 3600.0));
    // A sample each second, judged against the end of the step: the mean error over it is the response's area.
    let mut truth = truth(Course::Scenario1, 1.0, shoulder);
    truth.gas_mean_k.fill(273.15 + 10.0);
    let score = score_transfer_function(&truth, &nominal, TransferFunction::new(1.0, POLE_PER_S)).unwrap();
    // Of a first-order lag the area above the response is height times time constant, 331 s; the jump took a second.
    let area_k_s = -score.gas_bias_k * 10_801.0;
    assert_relative_eq!(area_k_s, 10.0 * (1.0 / POLE_PER_S + 0.5 + 0.5), max_relative = 2e-3);
    assert_relative_eq!(1.0 / POLE_PER_S, 331.0, max_relative = 1e-4);
}

#[test]
fn the_transfer_functions_mass_is_that_of_pressure_and_temperature() {
    let nominal = presets::load("nitrogen-20l").unwrap();
    let mut truth = truth(Course::Scenario1, 60.0, |_| 280.0);
    // Made from a density, so that pressure follows from the equation of state and not the other way round.
    let (rho, gas_k) = (220.0, 280.0);
    let pressure_pa = nominal.fluid.pressure_pa(rho, gas_k);
    truth.log.values.chunks_mut(2).for_each(|row| row[0] = pressure_pa);
    truth.mass_kg.fill(rho * nominal.volume.volume_m3(gas_k, pressure_pa) - 0.01);
    let score = score_transfer_function(&truth, &nominal, TransferFunction::new(1.0, POLE_PER_S)).unwrap();
    assert!(score.gas_max_k < 1e-9);
    assert_relative_eq!(score.mass_bias_kg, 0.01, max_relative = 1e-8);
}

#[test]
fn an_observer_that_is_told_all_is_scored_near_the_truth() {
    // A settled cylinder of the nominal mass at 280 K, sensors without error.
    let nominal = presets::load("nitrogen-20l").unwrap();
    let rho = nominal.fluid.density_from_pressure_temperature(200e5, 288.15).unwrap();
    let mass_kg = rho * nominal.volume.volume_m3(288.15, 200e5);
    let mut pressure_pa = 190e5;
    for _ in 0..50 {
        let rho = mass_kg / nominal.volume.volume_m3(280.0, pressure_pa);
        pressure_pa = nominal.fluid.pressure_pa(rho, 280.0);
    }
    let mut truth = truth(Course::Scenario1, 60.0, |_| 280.0);
    truth.mass_kg.fill(mass_kg);
    truth.log.values.chunks_mut(2).for_each(|row| row[0] = pressure_pa);
    let score = score(&truth, &nominal, &["shoulder", "pressure"], &ObserverSettings::default()).unwrap();
    assert!(score.gas_rms_k < 0.02 && score.mass_rms_kg < 1e-3, "{score:?}");
    assert_eq!((score.gas_coverage, score.mass_coverage), (1.0, 1.0));
    assert!(score.nis < 0.5, "readings without noise: {}", score.nis);
}

#[test]
fn an_unknown_sensor_is_refused() {
    let nominal = presets::load("nitrogen-20l").unwrap();
    let truth = still(Course::Scenario1);
    assert!(score(&truth, &nominal, &["sholder", "pressure"], &ObserverSettings::default()).is_err());
    // Known, but not among the truth's readings.
    assert!(score(&truth, &nominal, &["valve", "pressure"], &ObserverSettings::default()).is_err());
}
