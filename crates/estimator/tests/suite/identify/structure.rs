//! Dead time, known gain, offset and every kind of initial state, against closed forms.
use approx::assert_relative_eq;
use cylwatch_estimator::identify::{
    Data, DeadTime, Gain, Hold, Identified, InitialState, Method, Parameter, Settings, Structure, identify,
};

use super::system::{System, error, irregular, levels, normal, random, regular};

fn found(data: &Data, structure: &Structure, method: &Method) -> Identified {
    identify(data, structure, method, &Settings::default())
        .unwrap_or_else(|error| panic!("{structure:?}, {method:?}: {error}"))
}

/// Methods that need no other data.
fn methods() -> [Method; 4] {
    [
        Method::OutputError,
        Method::RefinedInstruments,
        Method::BiasCompensated { input_variance: 0.0, output_variance: 0.0 },
        Method::CompensatedInstruments { input_variance: 0.0 },
    ]
}

#[test]
fn a_known_dead_time_between_the_samples_is_exact() {
    for hold in [Hold::First, Hold::Zero] {
        let system = System { dead_time_s: 137.3, ..System::real(&[-0.002, -0.012], &[0.0015, 0.004]) };
        let time_s = irregular(250, 60.0, 11);
        let data = system.data(time_s.clone(), levels(&time_s, 12), hold);
        let structure = Structure::new(2, 1).with_dead_time(DeadTime::Fixed(137.3));
        for method in methods() {
            assert!(error(&found(&data, &structure, &method), &system) < 1e-8, "{hold:?} {method:?}");
        }
        let variances = Method::MaximumLikelihood {
            input_variance: 1e-14,
            output_variance: 1e-14,
            input_model: Default::default(),
        };
        assert!(error(&found(&data, &structure, &variances), &system) < 1e-8);
    }
}

#[test]
fn an_unknown_dead_time_is_found_with_its_interval() {
    for hold in [Hold::First, Hold::Zero] {
        let system = System { dead_time_s: 137.3, ..System::published() };
        let time_s = regular(300, 60.0);
        let data = system.data(time_s.clone(), levels(&time_s, 13), hold);
        let structure = Structure::new(1, 0).with_dead_time(DeadTime::Free(600.0));
        for method in [Method::OutputError, Method::RefinedInstruments] {
            let exact = found(&data, &structure, &method);
            assert!(error(&exact, &system) < 1e-8, "{hold:?} {method:?}");
            assert_relative_eq!(exact.model.dead_time_s, 137.3, max_relative = 1e-8);
        }
        let mut random = random(14);
        let noisy = data.output().iter().map(|y| y + 0.3 * normal(&mut random)).collect();
        let noisy = Data::try_new(time_s.clone(), data.input().to_vec(), noisy, hold).unwrap();
        let interval = found(&noisy, &structure, &Method::OutputError).interval(Parameter::DeadTime).unwrap();
        assert!((137.3 - interval.value).abs() < 4.0 * interval.sd && interval.sd < 5.0, "{interval:?}");
    }
}

#[test]
fn a_known_gain_leaves_one_parameter() {
    let system = System::real(&[-0.003021], &[0.003021]);
    let time_s = regular(200, 60.0);
    let data = system.data(time_s.clone(), levels(&time_s, 15), Hold::First);
    let structure = Structure::new(1, 0).with_gain(Gain::Fixed(1.0)).with_initial(InitialState::Zero);
    for method in methods() {
        let found = found(&data, &structure, &method);
        assert!(error(&found, &system) < 1e-8, "{method:?}");
        assert_eq!(found.parameters.len(), 1);
        assert_relative_eq!(found.derived.gain.value, 1.0, max_relative = 1e-14);
        assert_eq!(found.derived.gain.sd, 0.0);
    }
    // Two poles and a zero with the gain -2.
    let system = System::real(&[-0.002, -0.01], &[0.004, -0.04]);
    let data = system.data(time_s.clone(), levels(&time_s, 16), Hold::First);
    let structure = Structure::new(2, 1).with_gain(Gain::Fixed(-2.0));
    for method in methods() {
        assert!(error(&found(&data, &structure, &method), &system) < 1e-8, "{method:?}");
    }
}

#[test]
fn an_offset_of_the_output_is_told_from_the_gain() {
    let system = System { offset: -7.5, ..System::published() }.free(&[20.0]);
    let time_s = irregular(300, 60.0, 17);
    let data = system.data(time_s.clone(), levels(&time_s, 18), Hold::First);
    for method in methods() {
        let found = found(&data, &Structure::new(1, 0).with_offset(), &method);
        assert!(error(&found, &system) < 1e-8, "{method:?}");
        assert_relative_eq!(found.model.offset, -7.5, max_relative = 1e-8);
        assert_relative_eq!(found.initial[0], 20.0, max_relative = 1e-8);
    }
}

#[test]
fn a_settled_start_is_found_without_parameters_of_its_own() {
    let system = System::real(&[-0.002, -0.012], &[0.0015, 0.004]);
    let time_s = regular(250, 60.0);
    let input = levels(&time_s, 19);
    // Settled at the first input: each pole's part of the steady state, seen as a free response.
    let settled: Vec<f64> =
        system.poles.iter().zip(&system.residues).map(|(p, r)| -(r / p).re * input[0]).collect();
    let system = system.free(&settled);
    let data = system.data(time_s, input, Hold::First);
    let structure = Structure::new(2, 1).with_initial(InitialState::Settled);
    for method in methods() {
        let found = found(&data, &structure, &method);
        assert!(error(&found, &system) < 1e-8, "{method:?}");
        assert_eq!(found.parameters.len(), 4);
    }
    let likely = Method::MaximumLikelihood {
        input_variance: 1e-14,
        output_variance: 1e-14,
        input_model: Default::default(),
    };
    assert!(error(&found(&data, &structure, &likely), &system) < 1e-8);
}

#[test]
fn a_given_start_is_used_and_a_wrong_one_shows() {
    // r = 20 e^(p t) + 3 e^(q t).
    let (p, q) = (-0.002, -0.012);
    let system = System::real(&[p, q], &[0.0015, 0.004]).free(&[20.0, 3.0]);
    let time_s = regular(250, 60.0);
    let data = system.data(time_s.clone(), levels(&time_s, 20), Hold::Zero);
    let given = InitialState::Given(vec![23.0, 20.0 * p + 3.0 * q]);
    let mut methods = methods().to_vec();
    methods.push(Method::MaximumLikelihood {
        input_variance: 1e-14,
        output_variance: 1e-14,
        input_model: Default::default(),
    });
    for method in methods {
        let found = found(&data, &Structure::new(2, 1).with_initial(given.clone()), &method);
        assert!(error(&found, &system) < 1e-8, "{method:?}");
    }
    let estimated = found(&data, &Structure::new(2, 1), &Method::OutputError);
    assert_relative_eq!(estimated.initial[0], 23.0, max_relative = 1e-8);
    assert_relative_eq!(estimated.initial[1], 20.0 * p + 3.0 * q, max_relative = 1e-7);
    let zero = Structure::new(2, 1).with_initial(InitialState::Zero);
    let wrong = identify(&data, &zero, &Method::OutputError, &Settings::default());
    assert!(wrong.is_err() || wrong.is_ok_and(|found| error(&found, &system) > 1e-3));
}

#[test]
fn missing_values_are_left_out_without_harm() {
    let system = System::published();
    let time_s = regular(300, 60.0);
    // The input is straight over every third row, so that nothing is lost with it.
    let mut input = levels(&time_s, 21);
    for k in (2..input.len() - 1).step_by(3) {
        input[k] = 0.5 * (input[k - 1] + input[k + 1]);
    }
    let mut output = system.respond(&time_s, &input, Hold::First);
    (2..299).step_by(3).for_each(|k| input[k] = f64::NAN);
    (5..300).step_by(7).for_each(|k| output[k] = f64::NAN);
    let data = Data::try_new(time_s, input, output, Hold::First).unwrap();
    for method in methods() {
        assert!(error(&found(&data, &Structure::new(1, 0), &method), &system) < 1e-8, "{method:?}");
    }
}
