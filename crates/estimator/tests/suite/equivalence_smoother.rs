//! Smoothers against the dense solution for all states at once.
use cylwatch_estimator::filter::{Bank, BankEngine, StepRecord, Workspace, smooth};
use nalgebra::{DMatrix, DVector};

use crate::linear_model::{Case, covariance_difference, rng, state_difference, uniform};

impl Case {
    /// The start and all steps of an extended filter, recorded; with `split`, each interval is a step of its own.
    fn pass(&self, split: bool) -> Vec<StepRecord> {
        let mut model = self.model.clone();
        let mut work = Workspace::new(&model);
        let members = vec![((), self.p0.clone())];
        let mut bank = Bank::new(&mut model, &BankEngine::Extended, self.x0.as_slice(), &members).unwrap();
        let mut records = vec![bank.record(0, &model)];
        for (dt_s, z) in self.dt_s.iter().zip(&self.z) {
            bank.predict(&mut model, &mut work, *dt_s).unwrap();
            if split {
                records.push(bank.record(0, &model));
            }
            bank.update(&mut model, &mut work, z).unwrap();
            records.push(bank.record(0, &model));
        }
        records
    }

    /// Mean and covariance of all states given all readings.
    ///
    /// All states are linear in the start and the noises: their joint prior covariance is dense and exact even where
    /// a state has no noise. One conditioning on all readings at once gives the answer.
    fn joint(&self) -> (DVector<f64>, DMatrix<f64>) {
        let (n, steps) = (self.x0.len(), self.dt_s.len());
        let size = n * (steps + 1);
        let (mut mean, mut prior) = (DVector::zeros(size), DMatrix::zeros(size, size));
        mean.rows_mut(0, n).copy_from(&self.x0);
        prior.view_mut((0, 0), (n, n)).copy_from(&self.p0);
        for (k, dt_s) in self.dt_s.iter().enumerate() {
            let (f, q) = self.model.discrete(*dt_s);
            let moved = &f * mean.rows(k * n, n);
            mean.rows_mut((k + 1) * n, n).copy_from(&moved);
            // Covariance of the new state with all before it, then with itself.
            let known = (k + 1) * n;
            let cross = &f * prior.view((k * n, 0), (n, known));
            let own = &f * prior.view((k * n, k * n), (n, n)) * f.transpose() + q;
            prior.view_mut((known, 0), (n, known)).copy_from(&cross);
            prior.view_mut((0, known), (known, n)).copy_from(&cross.transpose());
            prior.view_mut((known, known), (n, n)).copy_from(&own);
        }
        let readings: Vec<(usize, usize)> = (0..steps)
            .flat_map(|k| (0..self.model.r.len()).map(move |j| (k, j)))
            .filter(|(k, j)| self.z[*k][*j].is_finite())
            .collect();
        let mut h = DMatrix::zeros(readings.len(), size);
        for (row, (k, j)) in readings.iter().enumerate() {
            h.view_mut((row, (k + 1) * n), (1, n)).copy_from(&self.model.h.row(*j));
        }
        let z = DVector::from_iterator(readings.len(), readings.iter().map(|(k, j)| self.z[*k][*j]));
        let r = DVector::from_iterator(readings.len(), readings.iter().map(|(_, j)| self.model.r[*j]));
        let cross = &prior * h.transpose();
        let s = (&h * &cross + DMatrix::from_diagonal(&r)).cholesky().unwrap();
        let innovation = z - &h * &mean;
        let posterior = &prior - &cross * s.solve(&cross.transpose());
        (mean + &cross * s.solve(&innovation), posterior)
    }
}

fn assert_is_the_dense_solution(case: &Case) {
    let n = case.x0.len();
    let (x, p) = case.joint();
    for (k, smoothed) in smooth(&case.pass(false)).iter().enumerate() {
        let expected = p.view((k * n, k * n), (n, n)).into_owned();
        assert!(state_difference(smoothed.x.as_slice(), &x.rows(k * n, n).into_owned(), &expected) < 1e-10);
        assert!(covariance_difference(&smoothed.p, &expected) < 1e-10);
    }
}

#[test]
fn smoother_is_the_dense_solution_for_all_states() {
    for (seed, sizes) in [(41, (1, 1, 1)), (42, (3, 3, 2)), (43, (6, 4, 2)), (44, (9, 6, 3))] {
        assert_is_the_dense_solution(&Case::random(&mut rng(seed), sizes, 15));
    }
}

#[test]
fn smoother_needs_no_process_noise_and_no_inverse() {
    let mut silent = Case::random(&mut rng(45), (5, 4, 2), 12);
    silent.model.q_c.fill(0.0);
    assert_is_the_dense_solution(&silent);
    let mut known = Case::random(&mut rng(46), (5, 3, 2), 12);
    // The start has rank 2, one state is known, and one noise source drives all: every covariance is singular.
    let root = uniform(&mut rng(47), 5, 2);
    known.p0 = &root * root.transpose();
    known.p0.row_mut(4).fill(0.0);
    known.p0.column_mut(4).fill(0.0);
    known.model.q_c.fill(0.0);
    known.model.q_c[(0, 0)] = 0.5;
    assert_is_the_dense_solution(&known);
}

#[test]
fn a_step_taken_in_two_calls_is_smoothed_as_one() {
    let case = Case::random(&mut rng(49), (4, 3, 2), 10);
    let apart = smooth(&case.pass(true));
    for (k, expected) in smooth(&case.pass(false)).iter().enumerate() {
        assert!(state_difference(apart[2 * k].x.as_slice(), &expected.x, &expected.p) < 1e-12);
        assert!(covariance_difference(&apart[2 * k].p, &expected.p) < 1e-12);
    }
}
