//! What sensors read of a simulated cylinder.
use approx::{assert_abs_diff_eq, assert_relative_eq};
use cylwatch_thermal::scenario::{AxialVariation, OutsideFilm, Series, Surroundings};
use cylwatch_thermal::transfer::outside::Body;
use cylwatch_thermal::wall::geometry::Orientation;

use super::request;
use crate::random::{Purpose, Random};
use crate::world::generate;
use crate::world::reading::{Place, read_pressure};
use crate::world::samples::Samples;
use crate::world::sensors::{Thermometer, Transmitter};
use crate::world::statistics::{Law, assert_law, mean, sd};

const BODY: Body = Body { orientation: Orientation::Vertical, diameter_m: 0.2, height_m: 0.8 };

fn thermometer() -> Thermometer {
    Thermometer {
        offset_k: 0.0,
        air_coupling: 0.0,
        lag_s: 0.0,
        stated_lag_s: 0.0,
        noise_k: 0.0,
        resolution_k: 0.0,
    }
}

fn transmitter() -> Transmitter {
    Transmitter {
        offset_pa: 0.0,
        coefficient_pa_k: 0.0,
        noise_pa: 0.0,
        resolution_pa: 0.0,
        full_scale_pa: 250e5,
        is_gauge: false,
    }
}

/// Air as stated and a film of 40 W/(m² K).
fn surroundings(air_k: Series) -> Surroundings {
    Surroundings {
        air_k,
        film: OutsideFilm::Coefficient { film_w_m2_k: Series::constant(40.0) },
        radiation_k: None,
        sun: None,
        axial: AxialVariation::default(),
    }
}

/// Readings of a surface, K, with samples a minute apart.
fn read(surface_k: &[f64], around: &Surroundings, sensor: &Thermometer, times_s: &[f64]) -> Vec<f64> {
    let samples = Samples { interval_s: 60.0, mass_kg: surface_k.to_vec(), ..Samples::default() };
    let place = Place {
        surroundings: around,
        body: BODY,
        samples: &samples,
        surface_k,
        above_middle: 0.4,
        noise: Purpose::WorldShoulderNoise,
    };
    place.read(sensor, times_s, 3)
}

#[test]
fn a_lag_follows_a_ramp_as_the_closed_form_does_wherever_rows_lie() {
    // 0.01 K/s from 600 s on, a time on a sample.
    let surface_k: Vec<f64> =
        (0..60).map(|k| 280.0 + 0.01 * (60.0 * f64::from(k) - 600.0).max(0.0)).collect();
    let around = surroundings(Series::constant(280.0));
    let lagging = Thermometer { lag_s: 45.0, ..thermometer() };
    let times_s = [0.0, 599.0, 617.3, 700.0, 701.0, 1800.0, 3000.5];
    for (t, reading) in times_s.iter().zip(read(&surface_k, &around, &lagging, &times_s)) {
        let since = (t - 600.0_f64).max(0.0);
        assert_abs_diff_eq!(
            reading,
            280.0 + 0.01 * (since - 45.0 * (1.0 - (-since / 45.0).exp())),
            epsilon = 1e-9
        );
    }
}

#[test]
fn coupling_grows_with_the_film_to_the_power_of_three_tenths() {
    let surface_k = [280.0; 60];
    let around = surroundings(Series::constant(300.0));
    let coupled = Thermometer { air_coupling: 0.1, offset_k: 0.25, ..thermometer() };
    let reading = read(&surface_k, &around, &coupled, &[1000.0])[0];
    assert_relative_eq!(reading, 280.25 + 20.0 * 0.1 * 4_f64.powf(0.3), max_relative = 1e-12);
}

#[test]
fn air_reaches_a_coupled_thermometer_through_its_lag_at_a_time_between_samples() {
    let surface_k = [280.0; 60];
    let air_k = Series::try_new(vec![0.0, 630.0, 630.0], vec![280.0, 280.0, 300.0]).unwrap();
    let around = surroundings(air_k);
    let sensor = Thermometer { air_coupling: 0.1, lag_s: 30.0, ..thermometer() };
    let step_k = 20.0 * 0.1 * 4_f64.powf(0.3);
    for t in [700.0, 720.0, 900.0_f64] {
        let reading = read(&surface_k, &around, &sensor, &[629.0, t])[1];
        // The jump is a ramp over the second between two knots.
        assert_abs_diff_eq!(reading, 280.0 + step_k * (1.0 - (-(t - 630.0) / 30.0).exp()), epsilon = 0.05);
    }
}

#[test]
fn temperatures_come_in_steps_of_their_celsius_value_and_with_white_noise() {
    let surface_k = [294.35; 2000];
    let around = surroundings(Series::constant(294.35));
    let times_s: Vec<f64> = (0..20_000).map(|k| 5.0 * f64::from(k)).collect();
    let noisy = Thermometer { noise_k: 0.05, ..thermometer() };
    let errors: Vec<f64> = read(&surface_k, &around, &noisy, &times_s).iter().map(|t| t - 294.35).collect();
    assert_law("noise", &errors, Law::Normal(0.0, 0.05));
    let lagged = errors.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / 20_000.0;
    assert!(lagged.abs() < 4.0 * 0.0025 / 20_000_f64.sqrt(), "neighbours {lagged}");
    let coarse = Thermometer { resolution_k: 0.5, ..noisy };
    for reading in read(&surface_k, &around, &coarse, &times_s) {
        let steps = (reading - 273.15) / 0.5;
        assert_abs_diff_eq!(steps, steps.round(), epsilon = 1e-6);
    }
}

#[test]
fn a_transmitter_adds_its_errors_counts_from_the_air_and_ends_with_its_loop() {
    let off = Transmitter { offset_pa: 2e4, coefficient_pa_k: 1500.0, ..transmitter() };
    let at = |sensor: &Transmitter, pressure_pa: f64| {
        read_pressure(sensor, &[pressure_pa], &[298.15], Random::new(1, Purpose::WorldPressureNoise))[0]
    };
    assert_relative_eq!(at(&off, 180e5), 180e5 + 2e4 + 1.5e4, max_relative = 1e-12);
    let gauge = Transmitter { is_gauge: true, ..off };
    assert_relative_eq!(at(&off, 180e5) - at(&gauge, 180e5), 101_325.0, max_relative = 1e-9);
    assert_relative_eq!(at(&transmitter(), 300e5), 257.8125e5, max_relative = 1e-12);
    let coarse = Transmitter { resolution_pa: 5e4, ..transmitter() };
    assert_eq!(at(&coarse, 180.26e5), 180.5e5);
}

/// All together: what the log of a world says is what its truth says, less what its sensors add.
#[test]
fn the_log_of_a_world_reads_its_truth() {
    let world = generate(&request("nitrogen-20l/workshop/mixed/class-b/60s", 11, 7.0)).unwrap();
    let sensors = &world.drawn.sensors;
    let errors: Vec<f64> = world
        .log
        .rows()
        .enumerate()
        .map(|(row, (_, readings))| {
            let warmer_k = world.truth.valve_k[row] - 288.15;
            let expected = sensors.pressure.offset_pa + sensors.pressure.coefficient_pa_k * warmer_k;
            readings[2] - world.truth.pressure_pa[row] - expected
        })
        .collect();
    let expected_pa = (1000_f64.powi(2) + 1000_f64.powi(2) / 12.0).sqrt();
    let n = errors.len() as f64;
    assert!(mean(&errors).abs() < 4.0 * expected_pa / n.sqrt(), "mean {}", mean(&errors));
    assert!((sd(&errors) / expected_pa - 1.0).abs() < 4.0 / (2.0 * n).sqrt(), "sd {}", sd(&errors));
    let shoulder: Vec<f64> = world.log.rows().map(|(_, row)| row[0]).collect();
    let bias: Vec<f64> = shoulder.iter().zip(&world.truth.shoulder_k).map(|(a, b)| a - b).collect();
    // In a room without jumps the air is within a few tenths of the cylinder, of which the coupling shows a tenth.
    assert!((mean(&bias) - sensors.shoulder.offset_k).abs() < 0.03, "{}", mean(&bias));
}
