//! Data without noise: every method finds the system, whatever the samples, hold, order and start.
use cylwatch_estimator::identify::{
    Data, Hold, InitialState, InputModel, Method, Settings, StartMethod, Structure, identify,
};
use nalgebra::Complex;

use super::system::{System, error, irregular, levels, regular};

const SAMPLES: usize = 300;
const BAR: f64 = 1e-8;

/// All methods, told that there is (nearly) no noise. The second sensor sees the input late and through other noise.
fn methods(data: &Data) -> Vec<(&'static str, Method)> {
    let second = data.input().iter().zip(levels(data.time_s(), 77)).map(|(u, other)| 0.8 * u + 0.05 * other);
    vec![
        ("output error", Method::OutputError),
        ("refined instruments", Method::RefinedInstruments),
        ("bias-compensated", Method::BiasCompensated { input_variance: 0.0, output_variance: 0.0 }),
        ("compensated instruments", Method::CompensatedInstruments { input_variance: 0.0 }),
        ("second sensor", Method::SecondSensor { input: second.collect() }),
        (
            "maximum likelihood",
            Method::MaximumLikelihood {
                input_variance: 1e-14,
                output_variance: 1e-14,
                input_model: InputModel::RandomWalk,
            },
        ),
    ]
}

/// Systems of order one to three with the number of their zeros.
fn systems() -> Vec<(System, usize)> {
    let pair = [Complex::new(-0.002, 0.003), Complex::new(-0.002, -0.003)];
    let mut resonant = System::real(&[0.0, 0.0], &[0.0, 0.0]);
    resonant.poles = pair.to_vec();
    resonant.residues = vec![Complex::new(0.001, -0.002), Complex::new(0.001, 0.002)];
    vec![
        (System::published(), 0),
        (System::real(&[-0.002, -0.012], &[0.0015, 0.004]), 1),
        (resonant, 1),
        (System::real(&[-0.001, -0.004, -0.015], &[0.0004, 0.002, 0.004]), 2),
    ]
}

fn check(data: &Data, system: &System, structure: &Structure, bar: f64) {
    for (name, method) in methods(data) {
        // From the first filter's estimate, so that each method has its own way to go.
        let settings = Settings { start: StartMethod::StateVariableFilter, ..Settings::default() };
        let found = identify(data, structure, &method, &settings);
        let found = found.unwrap_or_else(|error| panic!("{name}, {structure:?}: {error}"));
        let wrong = error(&found, system);
        println!("{name:20} {:?} {:8} {wrong:.1e} in {}", data.hold(), structure.order, found.iterations);
        assert!(wrong < bar, "{name}, {structure:?}: {wrong:e}");
    }
}

#[test]
fn regular_samples_without_noise_give_the_system_by_every_method() {
    for hold in [Hold::First, Hold::Zero] {
        for (system, zeros) in systems() {
            let time_s = regular(SAMPLES, 60.0);
            let data = system.data(time_s.clone(), levels(&time_s, 1), hold);
            let structure = Structure::new(system.poles.len(), zeros);
            check(&data, &system, &structure.with_initial(InitialState::Zero), BAR);
        }
    }
}

#[test]
fn irregular_samples_without_noise_give_the_system_by_every_method() {
    for hold in [Hold::First, Hold::Zero] {
        for (system, zeros) in systems() {
            let time_s = irregular(SAMPLES, 60.0, 2);
            let data = system.data(time_s.clone(), levels(&time_s, 3), hold);
            check(&data, &system, &Structure::new(system.poles.len(), zeros), BAR);
        }
    }
}

#[test]
fn coarse_samples_of_an_interval_near_the_time_constant_are_no_harder() {
    for hold in [Hold::First, Hold::Zero] {
        let time_s = regular(SAMPLES, 300.0);
        let data = System::published().data(time_s.clone(), levels(&time_s, 4), hold);
        check(&data, &System::published(), &Structure::new(1, 0), BAR);
    }
}

#[test]
fn a_start_20_k_off_rest_does_no_harm() {
    for (system, zeros) in systems() {
        let parts: Vec<f64> = (0..system.poles.len()).map(|i| if i == 0 { 20.0 } else { 3.0 }).collect();
        if system.poles[0].im != 0.0 {
            continue;
        }
        let system = system.free(&parts);
        let time_s = irregular(SAMPLES, 60.0, 5);
        let data = system.data(time_s.clone(), levels(&time_s, 6), Hold::First);
        check(&data, &system, &Structure::new(system.poles.len(), zeros), 1e-6);
    }
}
