//! Sampled readings against closed forms.
use approx::{assert_abs_diff_eq, assert_relative_eq};
use cylwatch_thermal::scenario::{Series, presets, read_scenario};
use cylwatch_thermal::sensor::SensorSpec;
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::vessel;

use super::*;
use crate::sensor::SensorSuite;

/// A cylinder at 20 °C for an hour, a sample a minute; air as stated.
fn trajectory(air: &str) -> Trajectory {
    let text = format!(
        "name = \"x\"\nduration_h = 1\nsample_time_min = 1\n[initial]\npressure_bar = 100\ntemperature_degc = 20\n\
         [ambient]\nair_degc = 20\nfilm_w_m2_k = 8\n{air}"
    );
    let scenario = read_scenario(&text, "x.toml", &presets::table).unwrap();
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ()).unwrap()
}

/// The air jumps by 30 K at 90 s, between two samples.
const STEP: &str = "[[ambient.air_change]]\nat_s = 90\nto_degc = 50\n";

/// The air jumps by 30 K at the start.
const STEP_AT_START: &str = "[[ambient.air_change]]\nat_s = 0\nto_degc = 50\n";

/// The air warms by 0.01 K/s from 0 to 3000 s.
const RAMP: &str = "[[ambient.air_change]]\nat_s = 0\nover_s = 3000\nto_degc = 50\n";

fn sensor(name: &str, change: impl FnOnce(&mut SensorSpec)) -> Sensor {
    let mut spec = SensorSpec { name: name.into(), ..SensorSpec::default() };
    change(&mut spec);
    Sensor::try_from(&spec).unwrap()
}

fn suite(sensors: impl IntoIterator<Item = Sensor>) -> SensorSuite {
    SensorSuite::try_new(sensors.into_iter().collect()).unwrap()
}

fn column(log: &Log, name: &str) -> Vec<f64> {
    let index = log.channels.iter().position(|channel| channel.name == name).unwrap();
    log.rows().map(|(_, row)| row[index]).collect()
}

fn nominal(run: &Trajectory, sensor: Sensor, seed: u64) -> Vec<f64> {
    let name = sensor.name.clone();
    column(&sample(run, &suite([sensor]).nominal(), seed).unwrap(), &name)
}

fn variance(values: impl IntoIterator<Item = f64>) -> (f64, usize) {
    let values: Vec<f64> = values.into_iter().collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (values.len() - 1) as f64, values.len())
}

/// A sample variance of `n` Gaussian numbers has the relative standard error `sqrt(2 / (n - 1))`; five of them.
fn assert_variance(values: impl IntoIterator<Item = f64>, expected: f64) {
    let (found, n) = variance(values);
    let error = 5.0 * (2.0 / (n - 1) as f64).sqrt();
    assert!((found / expected - 1.0).abs() < error, "{found} is not {expected} within {error}");
}

#[test]
fn ideal_sensors_read_the_columns_of_the_trajectory() {
    let run = trajectory(STEP_AT_START);
    let names = ["bottom", "valve", "wall_middle", "gas_1", "ambient", "pressure"];
    let log = sample(&run, &suite(names.map(|name| sensor(name, |_| ()))).nominal(), 0).unwrap();
    assert_eq!(log.time_s, run.time_s);
    assert_eq!(column(&log, "bottom"), run.surface_k("bottom").unwrap());
    assert_eq!(column(&log, "valve"), run.valve_k.clone().unwrap());
    assert_eq!(column(&log, "wall_middle"), run.surface_k("middle").unwrap());
    assert_eq!(column(&log, "gas_1"), run.gas_mean_k);
    assert_eq!(column(&log, "ambient"), run.ambient_k);
    assert_eq!(column(&log, "pressure"), run.pressure_pa);
}

#[test]
fn an_uncoupled_surface_sensor_at_a_height_reads_the_cell_there() {
    let run = trajectory(STEP_AT_START);
    let at = |height_m: f64| {
        nominal(&run, sensor("lid", |spec| (spec.kind, spec.height_m) = (None, Some(height_m))), 0)
    };
    let geometry = &run.vessel.geometry;
    assert_eq!(at(0.0), run.surface_k("bottom").unwrap());
    assert_eq!(at(geometry.outer_height_m()), run.surface_k("neck").unwrap());
    assert_eq!(at(0.5 * geometry.outer_height_m()), run.surface_k("middle").unwrap());
}

#[test]
fn the_lag_answers_a_jump_between_two_samples_as_the_closed_form_does() {
    let run = trajectory(STEP);
    let readings = nominal(&run, sensor("ambient", |spec| spec.lag_s = Some(45.0)), 0);
    for (t, reading) in run.time_s.iter().zip(readings) {
        let since = (t - 90.0_f64).max(0.0);
        assert_relative_eq!(reading, 293.15 + 30.0 * (1.0 - (-since / 45.0).exp()), max_relative = 1e-12);
    }
}

#[test]
fn the_lag_is_at_rest_with_the_air_before_a_jump_at_the_start() {
    let run = trajectory(STEP_AT_START);
    let readings = nominal(&run, sensor("ambient", |spec| spec.lag_s = Some(45.0)), 0);
    for (t, reading) in run.time_s.iter().zip(readings) {
        assert_relative_eq!(reading, 293.15 + 30.0 * (1.0 - (-t / 45.0).exp()), max_relative = 1e-12);
    }
}

#[test]
fn the_lag_follows_a_ramp_and_its_end_as_the_closed_form_does() {
    let run = trajectory(RAMP);
    let readings = nominal(&run, sensor("ambient", |spec| spec.lag_s = Some(200.0)), 0);
    let behind = |t: f64| t - 200.0 * (1.0 - (-t / 200.0).exp());
    for (&t, reading) in run.time_s.iter().zip(readings) {
        let rise = 0.01 * (behind(t) - behind((t - 3000.0).max(0.0)));
        assert_relative_eq!(reading, 293.15 + rise, max_relative = 1e-12);
    }
}

#[test]
fn the_air_in_a_coupled_sensor_lags_like_the_air_and_its_surface_like_the_surface() {
    // By linearity: a coupled lagged reading is the weighted sum of the lagged parts.
    let run = trajectory(STEP);
    let lagged = |name: &str, kappa: f64| {
        let change = |spec: &mut SensorSpec| {
            spec.lag_s = Some(70.0);
            spec.air_coupling = (name == "shoulder").then_some(kappa);
        };
        nominal(&run, sensor(name, change), 0)
    };
    let (air, surface, coupled) = (lagged("ambient", 0.0), lagged("shoulder", 0.0), lagged("shoulder", 0.15));
    for ((coupled, air), surface) in coupled.iter().zip(&air).zip(&surface) {
        assert_relative_eq!(*coupled, 0.15 * air + 0.85 * surface, max_relative = 1e-12);
    }
}

#[test]
fn the_gas_and_the_valve_in_an_immersion_sensor_lag_each_like_itself() {
    // A valve that is 40 K colder than the gas, and warms; by linearity as above.
    let mut run = trajectory(STEP);
    let valve_k = run.time_s.iter().map(|t| 253.15 + 1e-3 * t).collect();
    run.valve_k = Some(valve_k);
    let lagged = |name: &str, change: &dyn Fn(&mut SensorSpec)| {
        let both = |spec: &mut SensorSpec| {
            spec.lag_s = Some(70.0);
            change(spec);
        };
        nominal(&run, sensor(name, both), 0)
    };
    let (gas, valve) = (lagged("gas_1", &|_| ()), lagged("valve", &|_| ()));
    let immersed = lagged("gas_1", &|spec| {
        (spec.kind, spec.stem_coupling) = (Some(crate::sensor::KindChoice::Immersion), Some(0.15));
    });
    for ((immersed, gas), valve) in immersed.iter().zip(&gas).zip(&valve) {
        assert!((gas - valve).abs() > 30.0);
        assert_relative_eq!(*immersed, 0.85 * gas + 0.15 * valve, max_relative = 1e-12);
    }
}

#[test]
fn a_surface_sensor_has_the_air_of_its_height_around_it() {
    let mut run = trajectory("");
    // 8 K more at the top than at the bottom from 1000 s on, nothing before.
    let difference_k = Series::try_new(vec![0.0, 1000.0, 1000.0], vec![0.0, 0.0, 8.0]).unwrap();
    run.scenario.surroundings.axial.air_difference_k = Some(difference_k);
    let read = |name: &str, lag_s| {
        let change = |spec: &mut SensorSpec| {
            (spec.air_coupling, spec.lag_s) = (Some(0.5), Some(lag_s));
        };
        nominal(&run, sensor(name, change), 0)
    };
    let [valve, bottom, lagged] = [read("valve", 0.0), read("bottom", 0.0), read("valve", 500.0)];
    let [valve_k, bottom_k] = ["valve", "bottom"].map(|name| run.surface_k(name).unwrap());
    // Valve: the top, 4 K above the middle. Bottom: within the lowest tenth of the height, 3.2 to 4 K below.
    for (k, &t) in run.time_s.iter().enumerate() {
        let above = if t >= 1000.0 { 4.0 } else { 0.0 };
        assert_abs_diff_eq!(valve[k], 0.5 * valve_k[k] + 0.5 * (293.15 + above), epsilon = 1e-10);
        let below = 293.15 - (2.0 * bottom[k] - bottom_k[k]);
        assert!((0.8 * above - 1e-9..=above + 1e-9).contains(&below), "{t}: {below}");
    }
    // Everything else rests at 20 degC: half of the 4 K is reached with the lag from 1000 s on, a time between samples.
    let rest = run.valve_k.clone().unwrap();
    assert!(rest.iter().all(|t| (t - 293.15).abs() < 0.05));
    let index = run.time_s.iter().position(|&t| t == 1500.0).unwrap();
    assert_abs_diff_eq!(lagged[index], 293.15 + 2.0 * (1.0 - (-1.0_f64).exp()), epsilon = 0.03);
}

#[test]
fn readings_between_samples_do_not_depend_on_which_times_are_asked_for() {
    let run = trajectory(STEP);
    let one = suite([sensor("shoulder", |spec| (spec.lag_s, spec.air_coupling) = (Some(33.0), Some(0.15)))])
        .nominal();
    let few = [0.0, 89.0, 95.5, 600.0, 3600.0];
    let many: Vec<f64> = (0..=7200).map(|k| 0.5 * f64::from(k)).collect();
    let (few_log, many_log) =
        (sample_at(&run, &one, &few, 0).unwrap(), sample_at(&run, &one, &many, 0).unwrap());
    for (k, t) in few.iter().enumerate() {
        let index = many.iter().position(|other| other == t).unwrap();
        assert_relative_eq!(few_log.values[k], many_log.values[index], max_relative = 1e-12);
    }
}

#[test]
fn a_specimen_reads_its_own_parameters() {
    let run = trajectory(STEP_AT_START);
    let uncertain = sensor("pressure", |spec| {
        (spec.offset_sd_pa, spec.temperature_coefficient_sd_pa_k) = (Some(5e4), Some(2.5e3));
        spec.span_sd_ratio = Some(1e-3);
    });
    let mut truth = suite([uncertain]).draw(5);
    truth.find_mut("pressure").unwrap().truth.parameters = [0.3e5, 0.02e5, -2e-3];
    let readings = column(&sample(&run, &truth, 5).unwrap(), "pressure");
    let valve_k = run.valve_k.clone().unwrap();
    assert!(valve_k.last().unwrap() - valve_k[0] > 5.0);
    for (k, reading) in readings.iter().enumerate() {
        let expected = 0.998 * run.pressure_pa[k] + 0.3e5 + 0.02e5 * (valve_k[k] - 288.15);
        assert_relative_eq!(*reading, expected, max_relative = 1e-12);
    }
}

#[test]
fn white_noise_has_its_size_in_every_kind_of_sensor() {
    let run = trajectory("");
    let times: Vec<f64> = (0..36_000).map(|k| 0.1 * f64::from(k)).collect();
    let sensors = [
        sensor("shoulder", |spec| spec.noise_k = Some(0.05)),
        sensor("ambient", |spec| spec.noise_k = Some(0.2)),
        sensor("gas_1", |spec| spec.noise_k = Some(0.1)),
        sensor("pressure", |spec| spec.noise_pa = Some(1e3)),
    ];
    let expected = [0.0025, 0.04, 0.01, 1e6];
    let noisy = sample_at(&run, &suite(sensors.clone()).nominal(), &times, 9).unwrap();
    let ideal = sample_at(&run, &suite(sensors).ideal().nominal(), &times, 9).unwrap();
    for (index, expected) in expected.into_iter().enumerate() {
        let name = &noisy.channels[index].name;
        let errors = column(&noisy, name).into_iter().zip(column(&ideal, name)).map(|(n, i)| n - i);
        assert_variance(errors, expected);
    }
}

#[test]
fn drift_is_steady_and_the_walk_spreads_with_the_root_of_time() {
    let run = trajectory("");
    let drifting = nominal(&run, sensor("ambient", |spec| spec.drift_k_s = Some(1e-3)), 1);
    for (t, reading) in run.time_s.iter().zip(drifting) {
        assert_abs_diff_eq!(reading, 293.15 + 1e-3 * t, epsilon = 1e-10);
    }
    // Four hundred sensors walk independently: 0.5 K after the hour, half the variance after half of it.
    let walking = (0..400).map(|k| {
        sensor(&format!("walker_{k}"), |spec| {
            spec.kind = Some(crate::sensor::KindChoice::Ambient);
            (spec.walk_sd_k, spec.walk_time_s) = (Some(0.5), Some(3600.0));
        })
    });
    let log = sample_at(&run, &suite(walking).nominal(), &[0.0, 1800.0, 3600.0], 2).unwrap();
    assert!(log.row(0).iter().all(|&reading| reading == 293.15));
    assert_variance(log.row(1).to_vec(), 0.125);
    assert_variance(log.row(2).to_vec(), 0.25);
}

#[test]
fn a_walking_coupling_shows_where_air_and_surface_differ() {
    let mut run = trajectory("");
    for sample in &mut run.wall_outer_k {
        sample.iter_mut().for_each(|t| *t = 283.15);
    }
    // 10 K to the air: a coupling that is 0.03 off after the hour makes 0.3 K.
    let sensors = (0..400).map(|k| {
        let mut strapped = sensor(&format!("strapped_{k}"), |spec| spec.place = Some("shoulder".into()));
        let coupling = strapped.parameter_mut(crate::sensor::ParameterKind::Coupling).unwrap();
        coupling.walk_per_sqrt_s = 0.03 / 60.0;
        strapped
    });
    let log = sample_at(&run, &suite(sensors).nominal(), &[3600.0], 3).unwrap();
    assert_variance(log.row(0).to_vec(), 0.09);
}

#[test]
fn correlated_noise_keeps_its_size_and_forgets_with_its_time() {
    let run = trajectory("");
    let sensors = (0..2000).map(|k| {
        sensor(&format!("noisy_{k}"), |spec| {
            spec.kind = Some(crate::sensor::KindChoice::Ambient);
            (spec.correlated_noise_k, spec.correlation_time_s) = (Some(0.4), Some(600.0));
        })
    });
    let log = sample_at(&run, &suite(sensors).nominal(), &[100.0, 400.0], 4).unwrap();
    let (early, late) = (log.row(0), log.row(1));
    assert_variance(early.to_vec(), 0.16);
    assert_variance(late.to_vec(), 0.16);
    let products = early.iter().zip(late).map(|(a, b)| (a - 293.15) * (b - 293.15));
    let covariance = products.sum::<f64>() / 2000.0;
    let expected = 0.16 * (-0.5_f64).exp();
    let error = ((0.16 * 0.16 + expected * expected) / 2000.0_f64).sqrt();
    assert!((covariance - expected).abs() < 5.0 * error, "{covariance} {expected}");
}

#[test]
fn readings_are_whole_steps_and_their_error_is_uniform() {
    let run = trajectory(RAMP);
    let times: Vec<f64> = (0..30_000).map(|k| 0.1 * f64::from(k)).collect();
    let stepped = suite([sensor("ambient", |spec| spec.resolution_k = Some(0.25))]).nominal();
    let log = sample_at(&run, &stepped, &times, 0).unwrap();
    let mut errors = Vec::new();
    for (t, row) in log.rows() {
        assert_eq!(row[0] % 0.25, 0.0);
        errors.push(row[0] - (293.15 + 0.01 * t));
    }
    // The ramp of 30 K passes 120 steps: the error takes every value within half a step equally often.
    assert!(errors.iter().all(|error| error.abs() <= 0.125 + 1e-9));
    let (found, _) = variance(errors);
    assert_relative_eq!(found, 0.25 * 0.25 / 12.0, max_relative = 1e-3);
}

#[test]
fn a_transmitter_saturates_at_the_end_of_its_range() {
    let run = trajectory("");
    let small = nominal(&run, sensor("pressure", |spec| spec.full_scale_pa = Some(80e5)), 0);
    // 100 bar on a scale of 80 bar: 103.125 % of the scale.
    assert!(small.iter().all(|&reading| reading == 82.5e5));
}

#[test]
fn readings_get_lost_with_their_probability_and_the_others_stay() {
    let run = trajectory("");
    let times: Vec<f64> = (0..20_000).map(|k| 0.1 * f64::from(k)).collect();
    let with =
        |dropout| suite([sensor("shoulder", |spec| (spec.noise_k, spec.dropout) = (Some(0.05), dropout))]);
    let read = |dropout| sample_at(&run, &with(dropout).nominal(), &times, 6).unwrap().values;
    let (all, some) = (read(None), read(Some(0.2)));
    let lost = some.iter().filter(|reading| reading.is_nan()).count() as f64;
    // Binomial: 4000 with a standard deviation of 56.6.
    assert!((lost - 4000.0).abs() < 5.0 * 56.6, "{lost}");
    assert!(all.iter().zip(&some).all(|(a, b)| b.is_nan() || a == b));
}

#[test]
fn a_seed_gives_the_same_log_again_and_another_seed_another_one() {
    let run = trajectory("");
    let noisy = suite([sensor("shoulder", |spec| spec.noise_k = Some(0.05))]).nominal();
    let read = |seed| sample(&run, &noisy, seed).unwrap().values;
    assert_eq!(read(7), read(7));
    let (one, other) = (read(7), read(8));
    assert!(one.iter().zip(&other).all(|(a, b)| a != b));
}

#[test]
fn another_sensor_changes_nothing_for_those_that_are_there() {
    let run = trajectory("");
    let noisy = |name: &str| sensor(name, |spec| (spec.noise_k, spec.offset_sd_k) = (Some(0.05), Some(0.2)));
    let read = |names: &[&str]| {
        let suite = suite(names.iter().map(|name| noisy(name)));
        sample(&run, &suite.draw(7), 7).unwrap()
    };
    let (before, after) = (read(&["shoulder", "valve"]), read(&["bottom", "valve", "shoulder"]));
    for name in ["shoulder", "valve"] {
        assert_eq!(column(&before, name), column(&after, name));
    }
    // Streams of different sensors are independent: no correlation beyond five standard errors.
    let noise = |name: &str| {
        let values = column(&after, name);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.into_iter().map(move |v| (v - mean) / 0.05).collect::<Vec<_>>()
    };
    let (a, b) = (noise("bottom"), noise("valve"));
    let n = a.len() as f64;
    let correlation = a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>() / n;
    assert!(correlation.abs() < 5.0 / n.sqrt(), "{correlation}");
}

#[test]
fn times_that_cannot_be_sampled_are_named() {
    let run = trajectory("");
    let one = suite([sensor("shoulder", |_| ())]).nominal();
    let message = |times: &[f64]| sample_at(&run, &one, times, 0).unwrap_err().to_string();
    let bound = "must be later than the one before and lie within the trajectory, 0 s to 3600 s";
    assert_eq!(message(&[-1.0]), format!("sampling time 1, -1 s, {bound}"));
    assert_eq!(message(&[5.0, 5.0]), format!("sampling time 2, 5 s, {bound}"));
    assert_eq!(message(&[5.0, 3600.5]), format!("sampling time 2, 3600.5 s, {bound}"));
    assert_eq!(message(&[f64::NAN]), format!("sampling time 1, NaN s, {bound}"));
}

#[test]
fn a_sensor_on_a_missing_place_is_named() {
    let run = trajectory("");
    let error = sample(&run, &suite([sensor("gas_3", |_| ())]).nominal(), 0).unwrap_err();
    let vessel = &run.vessel.name;
    assert_eq!(
        error.to_string(),
        format!(
            "sensor gas_3 needs 3 gas cells, which vessel {vessel} does not have: give it another place or leave it out"
        )
    );
}
