//! Data that cannot be identified from: an error that names what is wrong, never a number without an interval.
use cylwatch_estimator::identify::{
    Caution, Data, DeadTime, Hold, Identified, IdentifyError, Method, Parameter, Settings, Structure,
    identify,
};

use super::system::{System, levels, normal, random, regular};

fn by(data: &Data, structure: &Structure, method: &Method) -> Result<Identified, IdentifyError> {
    identify(data, structure, method, &Settings::default())
}

fn output_error(data: &Data, structure: &Structure) -> Result<Identified, IdentifyError> {
    by(data, structure, &Method::OutputError)
}

/// A record of the published system with noise on the output.
fn record(samples: usize, noise: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let time_s = regular(samples, 60.0);
    let input = levels(&time_s, 41);
    let mut random = random(42);
    let output = System::published().respond(&time_s, &input, Hold::First);
    let output = output.iter().map(|y| y + noise * normal(&mut random)).collect();
    (time_s, input, output)
}

fn data(columns: (Vec<f64>, Vec<f64>, Vec<f64>)) -> Data {
    Data::try_new(columns.0, columns.1, columns.2, Hold::First).unwrap()
}

#[test]
fn columns_must_fit_the_times_and_the_times_increase() {
    let columns = |time: &[f64], input: &[f64], output: &[f64]| {
        Data::try_new(time.to_vec(), input.to_vec(), output.to_vec(), Hold::First).unwrap_err()
    };
    let short = columns(&[0.0, 1.0], &[1.0], &[1.0, 2.0]);
    assert_eq!(short, IdentifyError::Length { column: "the input", length: 1, times: 2 });
    let back = columns(&[0.0, 2.0, 2.0], &[1.0; 3], &[1.0; 3]);
    assert_eq!(back, IdentifyError::TimeOrder { row: 2, time_s: 2.0, before_s: 2.0 });
    let infinite = columns(&[0.0, 1.0], &[1.0, 2.0], &[1.0, f64::INFINITY]);
    assert_eq!(infinite, IdentifyError::Infinite { column: "the output", row: 1 });
}

#[test]
fn a_constant_column_is_named() {
    let (time_s, input, output) = record(50, 0.1);
    let flat = data((time_s.clone(), vec![21.0; 50], output));
    let error = output_error(&flat, &Structure::new(1, 0)).unwrap_err();
    assert_eq!(error, IdentifyError::Constant { column: "the input", value: 21.0 });
    let flat = data((time_s, input, vec![21.0; 50]));
    let error = output_error(&flat, &Structure::new(1, 0)).unwrap_err();
    assert_eq!(error, IdentifyError::Constant { column: "the output", value: 21.0 });
}

#[test]
fn fewer_samples_than_parameters_are_refused() {
    let error = output_error(&data(record(6, 0.1)), &Structure::new(3, 2)).unwrap_err();
    assert_eq!(error, IdentifyError::TooFewSamples { samples: 6, parameters: 9 });
    let (time_s, input, _) = record(60, 0.1);
    let empty = data((time_s, input, vec![f64::NAN; 60]));
    let error = output_error(&empty, &Structure::new(1, 0)).unwrap_err();
    assert_eq!(error, IdentifyError::TooFewSamples { samples: 0, parameters: 3 });
}

#[test]
fn a_gap_of_the_input_is_refused_unless_allowed() {
    let (time_s, mut input, output) = record(200, 0.1);
    input[100..130].fill(f64::NAN);
    let gap = data((time_s.clone(), input, output));
    match output_error(&gap, &Structure::new(1, 0)).unwrap_err() {
        IdentifyError::Gap { from_s, to_s, limit_s } => {
            assert_eq!((from_s, to_s), (time_s[99], time_s[130]));
            assert!((limit_s - 1200.0).abs() < 1e-6);
        }
        other => panic!("{other}"),
    }
    let settings = Settings { longest_gap_s: Some(3600.0), ..Settings::default() };
    assert!(identify(&gap, &Structure::new(1, 0), &Method::OutputError, &settings).is_ok());
}

#[test]
fn a_gap_of_the_output_is_no_gap() {
    let (time_s, input, mut output) = record(200, 0.1);
    output[100..130].fill(f64::NAN);
    let found = output_error(&data((time_s, input, output)), &Structure::new(1, 0)).unwrap();
    assert!(found.interval(Parameter::Denominator(0)).unwrap().contains(0.003021));
    assert!(found.cautions.contains(&Caution::SamplesLeftOut { rows: 30 }));
}

#[test]
fn an_output_that_does_not_depend_on_the_input_determines_nothing() {
    let (time_s, input, _) = record(300, 0.1);
    let mut random = random(43);
    let noise: Vec<f64> = time_s.iter().map(|_| normal(&mut random)).collect();
    for method in [
        Method::OutputError,
        Method::RefinedInstruments,
        Method::BiasCompensated { input_variance: 0.01, output_variance: 0.01 },
    ] {
        let found = by(&data((time_s.clone(), input.clone(), noise.clone())), &Structure::new(1, 0), &method);
        assert!(
            matches!(
                found,
                Err(IdentifyError::NotDetermined { .. }
                    | IdentifyError::PoleTooFast { .. }
                    | IdentifyError::PoleTooSlow { .. })
            ),
            "{method:?}: {:?}",
            found.err()
        );
    }
}

#[test]
fn too_high_an_order_is_not_determined() {
    let found = output_error(&data(record(400, 0.3)), &Structure::new(3, 2));
    assert!(
        matches!(found, Err(IdentifyError::NotDetermined { .. } | IdentifyError::PoleNotDetermined { .. })),
        "{:?}",
        found.err()
    );
}

#[test]
fn swapped_columns_are_told() {
    for noise in [0.0, 0.1, 0.3] {
        let (time_s, input, output) = record(300, noise);
        let right = data((time_s.clone(), input.clone(), output.clone()));
        assert!(output_error(&right, &Structure::new(1, 0)).is_ok());
        let swapped = data((time_s, output, input));
        match output_error(&swapped, &Structure::new(1, 0)) {
            Err(IdentifyError::Acausal { forward_percent, backward_percent }) => {
                assert!(backward_percent > 95.0 && forward_percent < backward_percent, "noise {noise}");
            }
            other => panic!("noise {noise}: {:?}", other.err()),
        }
    }
}

#[test]
fn an_output_that_follows_at_once_has_a_pole_too_fast_for_the_samples() {
    let (time_s, input, _) = record(300, 0.0);
    let mut random = random(44);
    let at_once = input.iter().map(|u| 1.03 * u + 0.01 * normal(&mut random)).collect();
    let found = output_error(&data((time_s, input, at_once)), &Structure::new(1, 0));
    assert!(matches!(found, Err(IdentifyError::PoleTooFast { .. })), "{:?}", found.err());
}

#[test]
fn an_integrator_has_a_pole_too_slow_for_the_record() {
    let time_s = regular(300, 60.0);
    let input: Vec<f64> = levels(&time_s, 45).iter().map(|u| u - 20.0).collect();
    let mut output = vec![0.0];
    for k in 1..300 {
        output.push(output[k - 1] + 60.0 * 0.5 * (input[k] + input[k - 1]));
    }
    let found = output_error(&data((time_s, input, output)), &Structure::new(1, 0));
    assert!(matches!(found, Err(IdentifyError::PoleTooSlow { .. })), "{:?}", found.err());
}

#[test]
fn a_dead_time_beyond_its_range_is_told() {
    let system = System { dead_time_s: 900.0, ..System::published() };
    let time_s = regular(300, 60.0);
    let late = system.data(time_s.clone(), levels(&time_s, 46), Hold::First);
    let structure = Structure::new(1, 0).with_dead_time(DeadTime::Free(600.0));
    let found = output_error(&late, &structure);
    let Err(IdentifyError::DeadTimeAtBound { dead_time_s, longest_s }) = found else {
        panic!("{:?}", found.err())
    };
    assert!((dead_time_s - 600.0).abs() < 1e-6 && (longest_s - 600.0).abs() < 1e-6);
}

#[test]
fn what_a_method_does_not_know_is_said_before_it_starts() {
    let record = data(record(100, 0.1));
    let free = Structure::new(1, 0).with_dead_time(DeadTime::Free(600.0));
    let known = Method::BiasCompensated { input_variance: 0.1, output_variance: 0.1 };
    assert!(matches!(by(&record, &free, &known), Err(IdentifyError::Unsupported { .. })));
    let negative = Method::BiasCompensated { input_variance: -0.1, output_variance: 0.1 };
    assert!(matches!(by(&record, &Structure::new(1, 0), &negative), Err(IdentifyError::Setting { .. })));
    for (order, zeros) in [(0, 0), (4, 0), (2, 2)] {
        let structure = Structure::new(order, zeros);
        assert!(matches!(output_error(&record, &structure), Err(IdentifyError::Setting { .. })));
    }
}

#[test]
fn variances_larger_than_the_data_are_refused() {
    let record = data(record(300, 0.1));
    for absurd in [
        Method::BiasCompensated { input_variance: 1e4, output_variance: 1e4 },
        Method::CompensatedInstruments { input_variance: 1e4 },
    ] {
        let found = by(&record, &Structure::new(1, 0), &absurd);
        assert_eq!(found.err(), Some(IdentifyError::VarianceTooLarge), "{absurd:?}");
    }
}

#[test]
fn a_model_too_simple_leaves_cautions() {
    let system = System::real(&[-0.002, -0.012], &[0.0015, 0.004]);
    let time_s = regular(500, 60.0);
    let record = system.data(time_s.clone(), levels(&time_s, 47), Hold::First);
    let found = output_error(&record, &Structure::new(1, 0)).unwrap();
    assert!(
        found.cautions.iter().any(|c| matches!(c, Caution::ColouredErrors { .. })),
        "{:?}",
        found.cautions
    );
    assert!(found.cautions.iter().any(|c| matches!(c, Caution::DynamicsLeft { .. })), "{:?}", found.cautions);
}
