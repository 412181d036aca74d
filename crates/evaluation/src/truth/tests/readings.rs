//! What the sensors of a truth read, recovered by regression from truth and readings.
use super::super::{Course, Truth, TruthSettings, generate_with};
use super::{covariance, mean, sd};

fn truth(seed: u64) -> Truth {
    let settings = TruthSettings {
        cylinder_cells: 2,
        gas_cells: 1,
        relative_tolerance: 1e-5,
        ..TruthSettings::default()
    };
    generate_with(&Course::Scenario1, seed, 2.0, &settings).unwrap()
}

fn column(truth: &Truth, name: &str) -> Vec<f64> {
    let column = truth.log.channels.iter().position(|channel| channel.name == name).unwrap();
    truth.log.rows().map(|(_, row)| row[column]).collect()
}

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Slope, intercept and residual deviation of `y` over `x`, with the slope's standard deviation.
fn regress(x: &[f64], y: &[f64]) -> (f64, f64, f64, f64) {
    let slope = covariance(x, y) / covariance(x, x);
    let intercept = mean(y) - slope * mean(x);
    let residual: Vec<f64> = x.iter().zip(y).map(|(x, y)| y - slope * x - intercept).collect();
    (slope, intercept, sd(&residual), sd(&residual) / (sd(x) * (x.len() as f64).sqrt()))
}

#[test]
fn a_surface_sensor_reads_its_offset_its_coupling_and_white_noise() {
    let truth = truth(31);
    // The middle of the wall sees neither the slope of the film nor the difference of the air.
    let (air, surface) = (&truth.ambient_k, &truth.middle_k);
    let error = less(&column(&truth, "wall_middle"), surface);
    let from_air = less(air, surface);
    let (slope, offset, _, doubt) = regress(&from_air, &error);
    // The chamber's film of 16 W/(m² K), times this cylinder's factor, couples by (h / 10)^0.3; gusts of 10 % move it by 3 %
    // from sample to sample and, by the curvature of the power, by 0.3 * 0.7 / 2 * 1 % in the mean.
    let coupling = truth.sensors.middle.air_coupling * (1.6 * truth.parameters.outside_film).powf(0.3);
    assert!((slope / coupling - 1.0).abs() < 0.02 + 4.0 * doubt / coupling, "coupling {slope}, {coupling}");
    assert!((offset - truth.sensors.middle.offset_k).abs() < 0.02, "offset {offset}");
    // Near the air's temperature gusts have no effect: what is left is noise.
    let near: Vec<f64> = from_air
        .iter()
        .zip(&error)
        .filter(|(from_air, _)| from_air.abs() < 1.5)
        .map(|(from_air, error)| error - slope * from_air - offset)
        .collect();
    let doubt = 4.0 / (2.0 * near.len() as f64).sqrt();
    assert!(near.len() > 1000 && (sd(&near) / 0.05 - 1.0).abs() < 0.01 + doubt, "noise {} K", sd(&near));
}

#[test]
fn a_transmitter_reads_its_offset_its_coefficient_and_white_noise() {
    let truth = truth(32);
    let error = less(&column(&truth, "pressure"), &truth.pressure_pa);
    let from_quoted: Vec<f64> = truth.valve_k.iter().map(|valve_k| valve_k - 288.15).collect();
    let (slope, offset, noise, doubt) = regress(&from_quoted, &error);
    let pressure = truth.sensors.pressure;
    assert!((slope - pressure.coefficient_pa_k).abs() < 4.0 * doubt, "coefficient {slope} Pa/K");
    assert!((offset - pressure.offset_pa).abs() < 4.0 * doubt * 40.0, "offset {offset} Pa");
    assert!((noise / 1000.0 - 1.0).abs() < 4.0 / (2.0 * error.len() as f64).sqrt(), "noise {noise} Pa");
}

#[test]
fn noises_of_the_sensors_are_white_and_independent() {
    let truth = truth(33);
    let n = truth.time_s.len();
    // Differences of second order take away what is slow: with white noise their deviation is sqrt(6) of it, and
    // neighbours correlate by -4/6.
    let rough = |name: &str| -> Vec<f64> {
        let values = column(&truth, name);
        values.windows(3).map(|v| v[0] - 2.0 * v[1] + v[2]).collect()
    };
    // From the third hour on, when the surfaces hardly move.
    let late = n * 3 / 4;
    let columns = ["shoulder", "valve", "wall_middle", "wall_bottom", "pressure"]
        .map(|name| rough(name)[late..].to_vec());
    let bound = 4.0 * 2.0 / ((n - late) as f64).sqrt();
    for (i, a) in columns.iter().enumerate() {
        let next = covariance(&a[1..], &a[..a.len() - 1]) / covariance(a, a);
        assert!((next + 4.0 / 6.0).abs() < bound, "sensor {i}: neighbours {next}");
        for b in &columns[..i] {
            let correlation = covariance(a, b) / (sd(a) * sd(b));
            assert!(correlation.abs() < bound, "{correlation}");
        }
    }
}
