//! The crate `dsmc` is the other Rust library with refined instruments: both find the same where both apply.
use cylwatch_estimator::identify::{
    Data, Hold, InitialState, Method, Parameter, Settings, Structure, identify,
};
use dsmc::system_identification::iv::srivc;

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

fn by_dsmc(data: &Data) -> Vec<f64> {
    let start = srivc::Initialization::StateVariableFilter(0.005);
    let found =
        srivc::identify(data.input(), data.output(), 10.0, 1, 0, &start, &Default::default()).unwrap();
    assert!(found.converged);
    found.parameter.as_slice().to_vec()
}

#[test]
fn from_rest_both_libraries_agree_within_a_tenth_of_a_standard_deviation() {
    let data = record(0.0);
    let structure = Structure::new(1, 0).with_initial(InitialState::Zero);
    let found = identify(&data, &structure, &Method::RefinedInstruments, &Settings::default()).unwrap();
    let parameters = [Parameter::Denominator(0), Parameter::Numerator(0)];
    for (parameter, theirs) in parameters.into_iter().zip(by_dsmc(&data)) {
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
    let theirs = by_dsmc(&data)[0];
    assert!((ours.value - 0.003021).abs() < 3.0 * ours.sd);
    assert!((theirs - 0.003021).abs() > 10.0 * (ours.value - 0.003021).abs(), "{theirs}");
}
