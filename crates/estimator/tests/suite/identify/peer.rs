//! The crate `dsmc` is the other Rust library with refined instruments: both find the same where both apply.
//!
//! Its numbers are those of version 0.27.2, `srivc::identify(input, output, 10.0, 1, 0, StateVariableFilter(0.005), default)`, on the records below.
use cylwatch_estimator::identify::{
    Data, Hold, InitialState, Method, Parameter, Settings, Structure, identify,
};

use super::system::{System, levels, normal, random};

/// A record from rest, every 10 s, with white noise on the output.
fn record(start_k: f64) -> Data {
    let time_s: Vec<f64> = (0..600).map(|k| f64::from(k) * 10.0).collect();
    let input = levels(&time_s, 51);
    let mut random = random(52);
    let output = System::published().free(&[start_k]).respond(&time_s, &input, Hold::Zero);
    let output = output.iter().map(|y| y + 0.05 * normal(&mut random)).collect();
    Data::try_new(time_s, input, output, Hold::Zero).unwrap()
}

/// Denominator and numerator by `dsmc`, of the record from rest and of the one that begins 20 K off.
const FROM_REST: [f64; 2] = [0.003_021_066_622_676_52, 0.003_120_937_820_955_72];
const OFF_REST: [f64; 2] = [0.003_502_266_501_042_99, 0.003_686_623_113_163_24];

#[test]
fn from_rest_both_libraries_agree_within_a_tenth_of_a_standard_deviation() {
    let data = record(0.0);
    let structure = Structure::new(1, 0).with_initial(InitialState::Zero);
    let found = identify(&data, &structure, &Method::RefinedInstruments, &Settings::default()).unwrap();
    let parameters = [Parameter::Denominator(0), Parameter::Numerator(0)];
    for (parameter, theirs) in parameters.into_iter().zip(FROM_REST) {
        let ours = found.interval(parameter).unwrap();
        assert!((ours.value - theirs).abs() < 0.1 * ours.sd, "{parameter}: {ours:?}, {theirs}");
    }
}

#[test]
fn off_rest_the_start_is_a_parameter_here_and_an_error_there() {
    let data = record(20.0);
    let found =
        identify(&data, &Structure::new(1, 0), &Method::RefinedInstruments, &Settings::default()).unwrap();
    let ours = found.interval(Parameter::Denominator(0)).unwrap();
    let theirs = OFF_REST[0];
    assert!((ours.value - 0.003021).abs() < 3.0 * ours.sd);
    assert!((theirs - 0.003021).abs() > 10.0 * (ours.value - 0.003021).abs(), "{theirs}");
}
