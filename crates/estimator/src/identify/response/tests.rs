//! Derivatives against differences of the response itself, which the simulation's tests hold against closed forms.
use approx::assert_relative_eq;

use super::*;
use crate::identify::parametrisation::Parametrisation;
use crate::identify::{Data, DeadTime, Hold, InitialState, Structure};

/// A record with intervals of 1 to 2, and a model of the order with everything free.
fn problem(hold: Hold) -> Problem {
    let time_s: Vec<f64> = (0..40).map(|k| f64::from(k) * 1.5 + 0.25 * (f64::from(k) * 1.3).sin()).collect();
    let input = (0..40).map(|k| (f64::from(k) * 0.7).sin() + f64::from(k / 9)).collect();
    let output = (0..40).map(|k| (f64::from(k) * 0.2).cos()).collect();
    let mut problem =
        Problem::new(&Data::try_new(time_s, input, output, hold).unwrap(), None, None, 0).unwrap();
    problem.rescale(1.0 / problem.units.time_s);
    problem
}

#[test]
fn derivatives_by_every_parameter_equal_central_differences() {
    let initials = [InitialState::Estimated, InitialState::Settled, InitialState::Zero];
    for hold in [Hold::First, Hold::Zero] {
        for (order, initial) in (1..=3).flat_map(|order| initials.clone().map(|initial| (order, initial))) {
            let problem = problem(hold);
            let structure = Structure::new(order, order - 1)
                .with_offset()
                .with_dead_time(DeadTime::Free(10.0 * problem.units.time_s))
                .with_initial(initial);
            let parametrisation = Parametrisation::new(&structure, &problem.units);
            let theta: Vec<f64> = (0..parametrisation.parameters.len())
                .map(|i| if i < order { [0.9, 0.7, 0.2][i] } else { 0.4 + 0.1 * i as f64 })
                .collect();
            let at = |theta: &[f64]| {
                let k = parametrisation.expand(theta);
                respond(&problem, &Schedule::new(&problem, k.dead_time), &problem.u, &k)
            };
            let exact = parametrisation.jacobian(&theta).tr_mul(&at(&theta).columns);
            for i in 0..theta.len() {
                let shifted = |by: f64| {
                    let mut shifted = theta.clone();
                    shifted[i] += by;
                    at(&shifted).y
                };
                let (above, below) = (shifted(1e-5), shifted(-1e-5));
                for (sample, (above, below)) in above.iter().zip(&below).enumerate() {
                    let difference = (above - below) / 2e-5;
                    assert_relative_eq!(exact[(i, sample)], difference, epsilon = 2e-8, max_relative = 5e-8);
                }
            }
        }
    }
}

#[test]
fn a_known_gain_ties_the_numerator_to_the_denominator() {
    let problem = problem(Hold::First);
    let structure = Structure::new(2, 1).with_gain(crate::identify::Gain::Fixed(0.7));
    let parametrisation = Parametrisation::new(&structure, &problem.units);
    let theta = [0.9, 0.7, 0.3, 0.2, -0.1];
    let k = parametrisation.expand(&theta);
    let gain = k.b[0] / k.a[0] * problem.units.output / problem.units.input;
    assert_relative_eq!(gain, 0.7, max_relative = 1e-14);
    let jacobian = parametrisation.jacobian(&theta);
    for i in 0..theta.len() {
        let shifted = |by: f64| {
            let mut shifted = theta;
            shifted[i] += by;
            parametrisation.expand(&shifted)
        };
        let (above, below) = (shifted(1e-4), shifted(-1e-4));
        for j in 0..2 {
            let slope = |of: fn(&Coefficients) -> [f64; 3]| (of(&above)[j] - of(&below)[j]) / 2e-4;
            assert_relative_eq!(jacobian[(j, i)], slope(|k| k.a), epsilon = 1e-10);
            assert_relative_eq!(jacobian[(2 + j, i)], slope(|k| k.b), epsilon = 1e-10);
            assert_relative_eq!(jacobian[(4 + j, i)], slope(|k| k.c), epsilon = 1e-10);
        }
    }
}

#[test]
fn a_filtered_signal_that_is_straight_between_its_samples_is_exact() {
    // Of the signal t itself through 1/(s + a): t/a - (1 - e^(-a t))/a^2.
    let problem = problem(Hold::Zero);
    let k = Coefficients {
        order: 1,
        a: [0.3, 0.0, 0.0],
        b: [0.0; 3],
        c: [0.0; 3],
        offset: 0.0,
        dead_time: 0.0,
        delay_free: false,
        settled: false,
    };
    let filtered = filter_output(&problem, &k, &problem.output_time);
    for (t, q) in problem.output_time.iter().zip(filtered.iter()) {
        assert_relative_eq!(*q, t / 0.3 - (1.0 - (-0.3 * t).exp()) / 0.09, epsilon = 1e-11);
    }
}
