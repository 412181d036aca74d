//! Results do not depend on units, and two methods that minimise the same thing agree.
use approx::assert_relative_eq;
use cylwatch_estimator::identify::{
    Data, Hold, Identified, InputModel, Method, Parameter, Settings, StartMethod, Structure, identify,
};

use super::system::{System, irregular, levels, normal, random, regular};

/// A noisy record of a second-order system.
fn record(input_sd: f64, output_sd: f64) -> (Data, Vec<f64>) {
    // Multiples of 1/64 s, so that a shift does not round them.
    let time_s: Vec<f64> = irregular(400, 60.0, 31).iter().map(|t| (t * 64.0).round() / 64.0).collect();
    let truth = levels(&time_s, 32);
    let output = System::real(&[-0.002, -0.012], &[0.0015, 0.004]).free(&[5.0, 1.0]).respond(
        &time_s,
        &truth,
        Hold::First,
    );
    let mut random = random(33);
    let mut noisy = |values: &[f64], sd: f64| -> Vec<f64> {
        values.iter().map(|value| value + sd * normal(&mut random)).collect()
    };
    let (input, second, output) = (noisy(&truth, input_sd), noisy(&truth, 1.0), noisy(&output, output_sd));
    (Data::try_new(time_s, input, output, Hold::First).unwrap(), second)
}

fn methods(second: &[f64], input_unit: f64, output_unit: f64) -> Vec<Method> {
    let (input_variance, output_variance) = (0.04 * input_unit.powi(2), 0.01 * output_unit.powi(2));
    vec![
        Method::OutputError,
        Method::RefinedInstruments,
        Method::SecondSensor { input: second.iter().map(|u| u * input_unit).collect() },
        Method::BiasCompensated { input_variance, output_variance },
        Method::CompensatedInstruments { input_variance },
        Method::MaximumLikelihood { input_variance, output_variance, input_model: InputModel::RandomWalk },
    ]
}

fn found(data: &Data, method: &Method) -> Identified {
    identify(data, &Structure::new(2, 1), method, &Settings::default())
        .unwrap_or_else(|error| panic!("{method:?}: {error}"))
}

#[test]
fn units_of_time_input_and_output_change_nothing_but_the_units() {
    let (data, second) = record(0.2, 0.1);
    for (time, input, output) in [(60.0, 1.0, 1.0), (1.0, 1.8, 1e5), (1.0 / 3600.0, 1e-3, 0.37)] {
        let scaled = |values: &[f64], unit: f64| values.iter().map(|v| v * unit).collect::<Vec<_>>();
        let other = Data::try_new(
            scaled(data.time_s(), time),
            scaled(data.input(), input),
            scaled(data.output(), output),
            data.hold(),
        )
        .unwrap();
        for (method, in_other) in methods(&second, 1.0, 1.0).iter().zip(methods(&second, input, output)) {
            let (here, there) = (found(&data, method), found(&other, &in_other));
            for (i, power) in [(1, 1), (0, 2)] {
                let (a, b) = (Parameter::Denominator(i), Parameter::Numerator(i));
                let (here_a, there_a) = (here.interval(a).unwrap(), there.interval(a).unwrap());
                let (here_b, there_b) = (here.interval(b).unwrap(), there.interval(b).unwrap());
                let rate = f64::powi(time, -power);
                assert_relative_eq!(there_a.value, here_a.value * rate, max_relative = 1e-9);
                assert_relative_eq!(there_b.value, here_b.value * rate * output / input, max_relative = 1e-9);
                assert_relative_eq!(there_a.sd, here_a.sd * rate, max_relative = 1e-7);
            }
            assert_relative_eq!(
                there.statistics.fit_percent,
                here.statistics.fit_percent,
                max_relative = 1e-9
            );
        }
    }
}

#[test]
fn a_shift_of_time_changes_nothing() {
    let (data, second) = record(0.2, 0.1);
    let later = data.time_s().iter().map(|t| t + 1048576.0).collect();
    let later = Data::try_new(later, data.input().to_vec(), data.output().to_vec(), data.hold()).unwrap();
    for method in methods(&second, 1.0, 1.0) {
        let (here, there) = (found(&data, &method), found(&later, &method));
        for (here, there) in here.parameters.iter().zip(&there.parameters) {
            assert_relative_eq!(here.interval.value, there.interval.value, max_relative = 1e-9);
        }
    }
}

#[test]
fn refined_instruments_settle_at_the_least_output_error() {
    let time_s = regular(10_000, 10.0);
    let data = System::published().data(time_s.clone(), levels(&time_s, 34), Hold::First);
    let mut random = random(35);
    let output = data.output().iter().map(|y| y + 0.5 * normal(&mut random)).collect();
    let data = Data::try_new(time_s, data.input().to_vec(), output, Hold::First).unwrap();
    // Each from the plain filter's estimate: neither is started with the other.
    let settings = Settings { start: StartMethod::StateVariableFilter, ..Settings::default() };
    let by = |method| identify(&data, &Structure::new(1, 0), &method, &settings).unwrap();
    let (least, instruments) = (by(Method::OutputError), by(Method::RefinedInstruments));
    for (least, instruments) in least.parameters.iter().zip(&instruments.parameters) {
        let apart = (least.interval.value - instruments.interval.value).abs() / least.interval.sd;
        assert!(apart < 1e-6, "{}: {apart} standard deviations", least.parameter);
        assert_relative_eq!(least.interval.sd, instruments.interval.sd, max_relative = 1e-6);
    }
}

#[test]
fn without_noise_to_compensate_the_moments_are_those_of_plain_least_squares() {
    let (data, _) = record(0.0, 0.0);
    let none = Method::BiasCompensated { input_variance: 0.0, output_variance: 0.0 };
    let tiny = Method::BiasCompensated { input_variance: 1e-20, output_variance: 1e-20 };
    let (none, tiny) = (found(&data, &none), found(&data, &tiny));
    for (none, tiny) in none.parameters.iter().zip(&tiny.parameters) {
        assert_relative_eq!(none.interval.value, tiny.interval.value, max_relative = 1e-10);
    }
}

#[test]
fn the_delta_method_agrees_with_the_spread_of_gain_and_poles() {
    // Draws from the parameters' distribution, pole by pole.
    let (data, _) = record(0.0, 0.1);
    let found = found(&data, &Method::OutputError);
    let covariance = nalgebra::DMatrix::from_fn(4, 4, |i, j| found.covariance[i][j]);
    let factor = covariance.cholesky().unwrap().l();
    let mut random = random(36);
    let (mut gains, mut slow) = (Vec::new(), Vec::new());
    for _ in 0..20_000 {
        let draw = &factor * nalgebra::DVector::from_fn(4, |_, _| normal(&mut random));
        let value = |i: usize| found.parameters[i].interval.value + draw[i];
        let (a1, a0, b0) = (value(0), value(1), value(3));
        gains.push(b0 / a0);
        slow.push(0.5 * (-a1 + (a1 * a1 - 4.0 * a0).sqrt()));
    }
    let sd = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
    };
    assert_relative_eq!(found.derived.gain.sd, sd(&gains), max_relative = 0.03);
    assert_relative_eq!(found.derived.poles[0].real_per_s.sd, sd(&slow), max_relative = 0.03);
    let constants: Vec<f64> = slow.iter().map(|p| -1.0 / p).collect();
    assert_relative_eq!(found.derived.poles[0].time_constant_s.sd, sd(&constants), max_relative = 0.03);
}
