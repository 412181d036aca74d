//! The filter's likelihood against the joint Gaussian density of all readings, written out densely.
use approx::assert_relative_eq;
use std::sync::atomic::AtomicBool;

use super::*;
use crate::identify::{Data, Settings, Structure};

/// `-ln L` from the joint covariance of all readings, up to the same constant. The nearly unknown first value and slope, of the
/// variances `first`, are kept apart from the rest (Woodbury), so that nothing is lost to rounding.
fn dense_cost(likelihood: &Likelihood<'_>, k: &Coefficients, intensity: f64, first: &[f64]) -> f64 {
    let problem = likelihood.search.problem;
    // Input samples that act after the last output are no part of the likelihood.
    let schedule = Schedule::new(problem, k.dead_time);
    let last = schedule.pieces.iter().filter(|piece| piece.fresh).map(|piece| piece.left).max().unwrap();
    let samples = if problem.hold == Hold::First { last + 2 } else { last + 1 };
    let t = &problem.input_time;
    // Covariance of the true input at two samples, given its first value and slope.
    let walk = |s: f64, t: f64| {
        let (early, late) = (s.min(t), s.max(t));
        match likelihood.input_model {
            InputModel::RandomWalk => intensity * early,
            InputModel::IntegratedRandomWalk => {
                intensity * (early * early * late / 2.0 - early.powi(3) / 6.0)
            }
        }
    };
    let input = DMatrix::from_fn(samples, samples, |i, j| walk(t[i], t[j]));
    let unknown = DMatrix::from_fn(samples, first.len(), |i, j| t[i].powi(j as i32));
    // Response to each input sample alone: the output is linear in them.
    let readings = samples + problem.samples();
    let mut map = DMatrix::zeros(readings, samples);
    for i in 0..samples {
        map[(i, i)] = 1.0;
        let unit: Vec<f64> = (0..problem.u.len()).map(|j| f64::from(u8::from(i == j))).collect();
        let y = respond(problem, &schedule, &unit, k).y;
        map.view_mut((samples, i), (y.len(), 1)).copy_from_slice(&y);
    }
    let mut covariance = &map * input * map.transpose();
    for i in 0..readings {
        covariance[(i, i)] +=
            if i < samples { likelihood.variances.input } else { likelihood.variances.output };
    }
    let z = DVector::from_iterator(readings, problem.u[..samples].iter().chain(&problem.y).copied());
    let h = map * unknown;
    let factor = covariance.cholesky().unwrap();
    let ln_determinant = |l: DMatrix<f64>| l.diagonal().iter().map(|d| 2.0 * d.ln()).sum::<f64>();
    let prior = DMatrix::from_diagonal(&DVector::from_column_slice(first).map(|variance| 1.0 / variance));
    let inner = (prior + h.tr_mul(&factor.solve(&h))).cholesky().unwrap();
    let known = h.tr_mul(&factor.solve(&z));
    let quadratic = z.dot(&factor.solve(&z)) - known.dot(&inner.solve(&known));
    let ln_first: f64 = first.iter().map(|variance| variance.ln()).sum();
    0.5 * (ln_determinant(factor.l()) + ln_determinant(inner.l()) + ln_first + quadratic)
}

#[test]
fn the_filters_likelihood_is_the_joint_gaussian_density() {
    let (settings, stop) = (Settings::default(), AtomicBool::new(false));
    for hold in [Hold::First, Hold::Zero] {
        for (input_model, dead_time_s) in [
            (InputModel::RandomWalk, 0.0),
            (InputModel::RandomWalk, 1.3),
            (InputModel::IntegratedRandomWalk, 0.0),
        ] {
            let time_s: Vec<f64> = (0..14).map(|k| f64::from(k) + 0.2 * (f64::from(k) * 1.7).sin()).collect();
            let input = (0..14).map(|k| (f64::from(k) * 0.7).sin()).collect();
            let output =
                (0..14).map(|k| if k == 5 { f64::NAN } else { (f64::from(k) * 0.4).cos() }).collect();
            let data = Data::try_new(time_s, input, output, hold).unwrap();
            let problem = Problem::new(&data, None, None, 0).unwrap();
            let structure = Structure::new(2, 1)
                .with_initial(InitialState::Zero)
                .with_dead_time(crate::identify::DeadTime::Fixed(dead_time_s));
            let parametrisation = Parametrisation::new(&structure, &problem.units);
            let search = Search {
                problem: &problem,
                parametrisation: &parametrisation,
                settings: &settings,
                stop: &stop,
            };
            let variances = Variances { input: 0.05, output: 0.02 };
            let likelihood = Likelihood { search, variances, input_model };
            let cost_at = |theta: &[f64]| {
                let k = parametrisation.expand(theta);
                let states = 4 + usize::from(input_model == InputModel::IntegratedRandomWalk);
                let start = likelihood.start_covariance(&k, states);
                let first: Vec<f64> = (2..states).filter(|i| *i != 3).map(|i| start[(i, i)]).collect();
                let dense = dense_cost(&likelihood, &k, theta[4].exp(), &first);
                (cost(&likelihood.innovations(theta).unwrap()), dense)
            };
            for theta in [[1.1, 0.6, 0.3, 0.5, -0.5], [0.8, 0.4, 0.1, 0.7, 0.4]] {
                let (filter, dense) = cost_at(&theta);
                assert_relative_eq!(filter, dense, epsilon = 1e-7);
            }
        }
    }
}
