use std::convert::Infallible;

use approx::assert_relative_eq;
use nalgebra::{DMatrix, dmatrix, dvector};

use super::*;
use crate::consistency::Significance;
use crate::filter::{Dimensions, Linearisation, StateSpace, UdFactors};

/// `x+ = f(x) + w`, `z = h(x) + v`, `x` scalar, perhaps with a constant behind it.
struct Scalar {
    f: fn(&[f64]) -> (f64, Vec<f64>),
    h: fn(&[f64]) -> (f64, Vec<f64>),
    states: usize,
    q: f64,
    r: f64,
}

impl StateSpace for Scalar {
    type Error = Infallible;

    fn dimensions(&self) -> Dimensions {
        Dimensions { states: self.states, leading: 1, noises: 1, outputs: 1 }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        _: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Infallible> {
        let (moved, slope) = (self.f)(x);
        x[0] = moved;
        if let Some(linear) = linear {
            linear.phi.row_mut(0).copy_from_slice(&slope);
            linear.g.fill(1.0);
            linear.q.fill(self.q);
        }
        Ok(())
    }

    fn output(&mut self, _: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        let (value, slope) = (self.h)(x);
        if let Some(h) = h {
            h.copy_from_slice(&slope);
        }
        Ok(value)
    }

    fn noise_variance(&self, _: usize, _: &[f64]) -> f64 {
        self.r
    }
}

/// Paths through two points that have mean `mu` and variance `p0` at the first sample, and move by `f` without noise.
fn two_points(model: &mut Scalar, mu: f64, p0: f64, samples: usize) -> Vec<Vec<Vec<f64>>> {
    [-1.0, 1.0]
        .map(|sign| {
            let mut x = vec![mu + sign * p0.sqrt()];
            let mut path = vec![x.clone()];
            for _ in 1..samples {
                model.propagate(&mut x, 1.0, None).unwrap();
                path.push(x.clone());
            }
            path
        })
        .to_vec()
}

fn last(bounds: &[DMatrix<f64>]) -> f64 {
    bounds[bounds.len() - 1][(0, 0)]
}

#[test]
fn the_bound_of_a_random_walk_settles_at_the_root_of_its_riccati_equation() {
    let mut model = Scalar { f: |x| (x[0], vec![1.0]), h: |x| (x[0], vec![1.0]), states: 1, q: 2.0, r: 3.0 };
    let paths = vec![vec![vec![0.0]; 60]];
    let mut intervals = vec![1.0; 60];
    intervals[0] = 0.0;
    let heard = vec![vec![true]; 60];
    // M = P + q, P = M r / (M + r): M = (q + sqrt(q^2 + 4 q r)) / 2 = (2 + sqrt 28) / 2.
    let predicted = 0.5 * (2.0 + 28.0_f64.sqrt());
    for expectation in [Expectation::Full, Expectation::MeanTransition] {
        let prior = dmatrix![10.0];
        let bounds = posterior_bound(&mut model, &prior, &paths, (&intervals, &heard), expectation).unwrap();
        assert_relative_eq!(last(&bounds), predicted * 3.0 / (predicted + 3.0), max_relative = 1e-13);
    }
}

#[test]
fn the_bound_of_a_squared_reading_has_its_closed_form() {
    // J = 1/P0 + E[(2x)^2]/r = 1/P0 + 4 (mu^2 + P0) / r.
    let (mu, p0, r) = (0.7, 0.3, 0.5);
    let mut model =
        Scalar { f: |x| (x[0], vec![1.0]), h: |x| (x[0] * x[0], vec![2.0 * x[0]]), states: 1, q: 1.0, r };
    let paths = two_points(&mut model, mu, p0, 1);
    let heard = [vec![true]];
    let bounds =
        posterior_bound(&mut model, &dmatrix![p0], &paths, (&[0.0], &heard), Expectation::Full).unwrap();
    assert_relative_eq!(last(&bounds), 1.0 / (1.0 / p0 + 4.0 * (mu * mu + p0) / r), max_relative = 1e-14);
}

#[test]
fn no_estimator_is_better_than_the_bound() {
    // Error of the posterior mean, the best estimator, by quadrature over x and z.
    let (mu, p0, r) = (0.7, 0.3, 0.5);
    let bound = 1.0 / (1.0 / p0 + 4.0 * (mu * mu + p0) / r);
    let density =
        |d: f64, variance: f64| (-0.5 * d * d / variance).exp() / (std::f64::consts::TAU * variance).sqrt();
    let grid = |low: f64, high: f64, count: usize| {
        let step = (high - low) / count as f64;
        (0..=count).map(move |i| (low + step * i as f64, step))
    };
    let mut mse = 0.0;
    for (z, dz) in grid(-4.0, 20.0, 1200) {
        let [mut mass, mut first, mut second] = [0.0; 3];
        for (x, dx) in grid(-3.0, 4.4, 800) {
            let joint = density(x - mu, p0) * density(z - x * x, r) * dx;
            (mass, first, second) = (mass + joint, first + x * joint, second + x * x * joint);
        }
        if mass > 0.0 {
            mse += (second - first * first / mass) * dz;
        }
    }
    assert!(bound < mse && mse < 2.0 * bound, "bound {bound}, best {mse}");
}

#[test]
fn the_spread_of_transitions_counts_as_published() {
    // f = a x + b x^2: D11 = E[f'^2]/q, D12 = -E[f']/q, D22 = 1/q, scalar by hand.
    const A: f64 = 0.9;
    const B: f64 = 0.4;
    let (mu, p0, q, r) = (0.5, 0.2, 0.1, 0.6);
    let mut model = Scalar {
        f: |x| (A * x[0] + B * x[0] * x[0], vec![A + 2.0 * B * x[0]]),
        h: |x| (x[0], vec![1.0]),
        states: 1,
        q,
        r,
    };
    let paths = two_points(&mut model, mu, p0, 2);
    let heard = [vec![true], vec![true]];
    let j0 = 1.0 / p0 + 1.0 / r;
    let (mean, square) = (A + 2.0 * B * mu, (A + 2.0 * B * mu).powi(2) + 4.0 * B * B * p0);
    let full = 1.0 / (1.0 / q - (mean / q).powi(2) / (j0 + square / q) + 1.0 / r);
    let of_mean = 1.0 / (1.0 / (q + mean * mean / j0) + 1.0 / r);
    let mut of = |expectation| {
        let times = (&[0.0, 1.0][..], &heard[..]);
        last(&posterior_bound(&mut model, &dmatrix![p0], &paths, times, expectation).unwrap())
    };
    assert_relative_eq!(of(Expectation::Full), full, max_relative = 1e-13);
    assert_relative_eq!(of(Expectation::MeanTransition), of_mean, max_relative = 1e-13);
    assert!(full < of_mean);
}

#[test]
fn a_constant_behind_the_state_is_learnt_from_its_motion() {
    // x+ = c x + w with c constant: information on (x, c, x+) by hand, the old state eliminated.
    let (q, r) = (0.2, 0.3);
    let mut model =
        Scalar { f: |x| (x[1] * x[0], vec![x[1], x[0]]), h: |x| (x[0], vec![1.0, 0.0]), states: 2, q, r };
    let points = [[1.0, 0.8], [-1.0, 0.8]];
    let paths: Vec<_> = points.iter().map(|x| vec![x.to_vec(), vec![x[0] * x[1], x[1]]]).collect();
    let prior = DMatrix::from_diagonal(&dvector![0.5, 0.04]);
    let heard = [vec![true], vec![true]];
    let times = (&[0.0, 1.0][..], &heard[..]);
    let full = posterior_bound(&mut model, &prior, &paths, times, Expectation::Full).unwrap();
    // E[phi] = (c, 0), E[phi^T phi] = diag(c^2, 1): the constant gains 1/q, apart from the state.
    assert_relative_eq!(full[1][(1, 1)], 1.0 / (25.0 + 1.0 / q), max_relative = 1e-13);
    assert_relative_eq!(full[1][(0, 1)], 0.0, epsilon = 1e-14);
    // The mean transition knows nothing of it.
    let of_mean = posterior_bound(&mut model, &prior, &paths, times, Expectation::MeanTransition).unwrap();
    assert_relative_eq!(of_mean[1][(1, 1)], 0.04, max_relative = 1e-13);
    // Each path by itself: the filter's covariance; its mean lies above the bound.
    let mut mean = DMatrix::zeros(2, 2);
    for path in &paths {
        let mut p = UdFactors::from_covariance(&prior).unwrap();
        let mut linear = Linearisation::zeros(2, 1, 1);
        path_bound(&mut model, &mut p, (&path[0], 0.0, &path[0]), &[true], &mut linear).unwrap();
        path_bound(&mut model, &mut p, (&path[0], 1.0, &path[1]), &[true], &mut linear).unwrap();
        mean += p.covariance() / 2.0;
    }
    assert!((mean - &full[1]).symmetric_eigenvalues().min() > 0.0);
}

#[test]
fn known_states_stay_known_and_missing_readings_tell_nothing() {
    let mut model =
        Scalar { f: |x| (x[0], vec![1.0, 1.0]), h: |x| (x[0], vec![1.0, 1.0]), states: 2, q: 1.0, r: 1.0 };
    let paths = [vec![vec![0.0, 0.0]; 2]];
    let prior = DMatrix::from_diagonal(&dvector![2.0, 0.0]);
    let heard = [vec![false], vec![true]];
    let bounds =
        posterior_bound(&mut model, &prior, &paths, (&[0.0, 1.0], &heard), Expectation::Full).unwrap();
    assert_relative_eq!(bounds[0], prior, max_relative = 1e-14);
    assert_relative_eq!(bounds[1], DMatrix::from_diagonal(&dvector![0.75, 0.0]), max_relative = 1e-13);
}

#[test]
fn a_state_without_noise_needs_the_mean_transition_where_transitions_spread() {
    let still = |x: &[f64]| (x[0], vec![1.0]);
    let mut model = Scalar { f: still, h: still, states: 1, q: 0.0, r: 1.0 };
    let paths = [vec![vec![0.5]; 2], vec![vec![1.5]; 2]];
    let heard = [vec![true], vec![true]];
    let times = (&[0.0, 1.0][..], &heard[..]);
    for expectation in [Expectation::Full, Expectation::MeanTransition] {
        let bounds = posterior_bound(&mut model, &dmatrix![1.0], &paths, times, expectation).unwrap();
        // Two readings of a constant with a prior: 1 + 1 + 1.
        assert_relative_eq!(last(&bounds), 1.0 / 3.0, max_relative = 1e-14);
    }
    model.f = |x| (x[0] * x[0], vec![2.0 * x[0]]);
    let refused = posterior_bound(&mut model, &dmatrix![1.0], &paths, times, Expectation::Full);
    assert!(refused.unwrap_err().to_string().contains("mean transition"));
    let bounds = posterior_bound(&mut model, &dmatrix![1.0], &paths, times, Expectation::MeanTransition);
    // phi = 2 on average: P = 1/2, 4 P = 2, 2 / (2 + 1).
    assert_relative_eq!(last(&bounds.unwrap()), 2.0 / 3.0, max_relative = 1e-14);
}

#[test]
fn paths_may_be_summed_in_parts_and_the_bound_is_as_published() {
    let mut model = Scalar {
        f: |x| (x[0] * x[0] * x[1], vec![2.0 * x[0] * x[1], x[0] * x[0]]),
        h: |x| (x[0] * x[1], vec![x[1], x[0]]),
        states: 2,
        q: 0.3,
        r: 0.7,
    };
    let points = [[0.3, 1.1], [-0.8, 0.4], [1.7, 0.9], [0.2, -0.6], [1.1, 1.3]];
    let mut linear = Linearisation::zeros(2, 1, 1);
    let mut sum = |points: &[[f64; 2]]| {
        let mut moments = Moments::new(2, 1);
        for point in points {
            moments.add_path(&mut model, (point, 1.0, point), &[true], &mut linear).unwrap();
        }
        moments
    };
    let prior = dmatrix![0.5, 0.1; 0.1, 0.2];
    let bound = |moments: &Moments, expectation| {
        let mut bound = PosteriorBound::try_new(&prior, 1, expectation).unwrap();
        bound.step(moments).unwrap();
        bound.covariance().clone()
    };
    let whole = sum(&points);
    let mut parts = sum(&points[3..]);
    parts.merge(&sum(&points[..3])).unwrap();
    for expectation in [Expectation::Full, Expectation::MeanTransition] {
        assert_relative_eq!(bound(&whole, expectation), bound(&parts, expectation), max_relative = 1e-12);
    }
    // As published, on state, constant and next state together; readings are at the same points.
    let (mut joint, mut outputs) = (DMatrix::zeros(3, 3), DMatrix::zeros(2, 2));
    for [x, c] in points {
        let row = dmatrix![2.0 * x * c, x * x, -1.0];
        let h = dmatrix![c, x];
        joint += row.transpose() * row / 0.3 / 5.0;
        outputs += h.transpose() * h / 0.7 / 5.0;
    }
    let corner = joint.view((0, 0), (2, 2)) + prior.clone().try_inverse().unwrap();
    joint.view_mut((0, 0), (2, 2)).copy_from(&corner);
    let all = joint.try_inverse().unwrap();
    // Rows and columns of the inverse that belong to next state (2) and constant (1): the old state is eliminated.
    let left = dmatrix![all[(2, 2)], all[(2, 1)]; all[(1, 2)], all[(1, 1)]];
    let expected = (left.try_inverse().unwrap() + outputs).try_inverse().unwrap();
    assert_relative_eq!(bound(&whole, Expectation::Full), expected, max_relative = 1e-12);
}

#[test]
fn a_bound_without_paths_or_of_another_size_is_refused() {
    let mut bound = PosteriorBound::try_new(&dmatrix![1.0], 1, Expectation::Full).unwrap();
    assert!(bound.step(&Moments::new(1, 1)).unwrap_err().to_string().contains("at least one"));
    assert!(bound.step(&Moments::new(2, 1)).is_err());
    assert!(PosteriorBound::try_new(&dmatrix![-1.0], 1, Expectation::Full).is_err());
    assert!(Moments::new(1, 1).merge(&Moments::new(2, 1)).is_err());
}

#[test]
fn efficiency_compares_standard_deviations() {
    let over = Efficiency::over_time(9.0, &[3.0, 5.0, 4.0, 4.0], Significance::FIVE_PERCENT).unwrap();
    assert_relative_eq!(over.ratio, 1.5, max_relative = 1e-14);
    let half = 1.959_964 * (2.0_f64 / 3.0 / 4.0).sqrt();
    assert_relative_eq!(over.interval.low, (9.0 / (4.0 + half)).sqrt(), max_relative = 1e-6);
    assert!(Efficiency::over_time(1.0, &[1.0], Significance::FIVE_PERCENT).is_err());
}
