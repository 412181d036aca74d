//! Sums over true paths that the bound needs of one sample.
use nalgebra::{Cholesky, DMatrix};

use crate::EstimatorError;
use crate::filter::{Linearisation, StateSpace, StepError};

/// Sums over paths, of one sample: the transition that leads to it and the information of its readings.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    n: usize,
    leading: usize,
    paths: u64,
    transitions: Option<Transitions>,
    /// Sum of `H^T R^-1 H`: (n, n).
    information: DMatrix<f64>,
}

/// Sums over transitions, as deviations from the first one: what has no spread then has none exactly.
#[derive(Clone, Debug, PartialEq)]
struct Transitions {
    count: u64,
    /// The first `phi`, `Q` and `Q^-1`; the inverse is zero for states without noise.
    phi: DMatrix<f64>,
    noise: DMatrix<f64>,
    inverse: DMatrix<f64>,
    /// Sums of `d phi`, `d Q`, `d (Q^-1)`.
    phi_beyond: DMatrix<f64>,
    noise_beyond: DMatrix<f64>,
    inverse_beyond: DMatrix<f64>,
    /// Sums of `d phi^T Q^-1 d phi`: (n, n), and `d phi^T Q^-1`: (n, leading).
    square: DMatrix<f64>,
    weighted: DMatrix<f64>,
    /// Whether a `Q` was singular where transitions spread.
    singular: bool,
}

/// One transition for the bound: `x+ = phi x + w`, after information about `x` that the spread of `phi` gives.
pub(super) struct Transition {
    pub phi: DMatrix<f64>,
    pub noise: DMatrix<f64>,
    pub spread: Option<DMatrix<f64>>,
}

impl Moments {
    /// No paths yet, of `n` states of which `leading` move.
    pub fn new(n: usize, leading: usize) -> Self {
        Self { n, leading, paths: 0, transitions: None, information: DMatrix::zeros(n, n) }
    }

    /// Add a path: from the state `before` over `dt_s`, s, to the state `after` with its readings. The first sample
    /// has no interval (0). `heard` tells which outputs have a reading; `linear` is scratch.
    ///
    /// # Errors
    /// The process refuses a state of the path, or gives a variance that is not positive.
    pub fn add_path<M: StateSpace>(
        &mut self,
        model: &mut M,
        (before, dt_s, after): (&[f64], f64, &[f64]),
        heard: &[bool],
        linear: &mut Linearisation,
    ) -> Result<(), StepError<M::Error>> {
        if dt_s > 0.0 {
            let mut moved = before.to_vec();
            model.propagate(&mut moved, dt_s, Some(linear)).map_err(StepError::Model)?;
            let one = Transitions::of(linear);
            match &mut self.transitions {
                Some(transitions) => transitions.merge(&one),
                none => *none = Some(one),
            }
        }
        let mut h = vec![0.0; self.n];
        for output in (0..heard.len()).filter(|output| heard[*output]) {
            model.output(output, after, Some(&mut h)).map_err(StepError::Model)?;
            self.add_output(&h, model.noise_variance(output, after))?;
        }
        self.paths += 1;
        Ok(())
    }

    fn add_output(&mut self, h: &[f64], variance: f64) -> Result<(), EstimatorError> {
        if !(variance > 0.0 && variance.is_finite()) {
            return Err(EstimatorError::NoiseNotPositive { variance });
        }
        let h = nalgebra::DVectorView::from_slice(h, h.len());
        self.information.ger(variance.recip(), &h, &h, 1.0);
        Ok(())
    }

    /// Add other paths of the same sample.
    ///
    /// # Errors
    /// They are of a process of another size.
    pub fn merge(&mut self, other: &Self) -> Result<(), EstimatorError> {
        self.check_size(other.n, other.leading)?;
        self.paths += other.paths;
        match (&mut self.transitions, &other.transitions) {
            (Some(own), Some(other)) => own.merge(other),
            (none @ None, Some(other)) => *none = Some(other.clone()),
            (_, None) => {}
        }
        self.information += &other.information;
        Ok(())
    }

    pub(super) fn check_size(&self, n: usize, leading: usize) -> Result<(), EstimatorError> {
        if (n, leading) == (self.n, self.leading) {
            Ok(())
        } else {
            Err(EstimatorError::StateLength { length: n, states: self.n })
        }
    }

    /// Number of paths.
    pub(crate) fn paths(&self) -> u64 {
        self.paths
    }

    /// `E[H^T R^-1 H]`.
    pub(super) fn information(&self) -> DMatrix<f64> {
        &self.information / self.paths.max(1) as f64
    }

    /// `E[phi]` and `E[Q]`; `None` at a sample without a transition before it.
    pub(super) fn mean_transition(&self) -> Option<Transition> {
        let t = self.transitions.as_ref()?;
        let count = t.count as f64;
        Some(Transition {
            phi: &t.phi + &t.phi_beyond / count,
            noise: &t.noise + &t.noise_beyond / count,
            spread: None,
        })
    }

    /// The transition that stands for all of them: `Q = E[Q^-1]^-1`, `phi = Q E[Q^-1 phi]`, and the information
    /// `E[phi^T Q^-1 phi] - phi^T Q^-1 phi` about the state before it.
    ///
    /// # Errors
    /// A `Q` was singular where transitions spread.
    pub(super) fn full_transition(&self) -> Result<Option<Transition>, EstimatorError> {
        let Some(t) = &self.transitions else { return Ok(None) };
        if t.singular {
            return Err(EstimatorError::BoundNoiseSingular);
        }
        let (count, m) = (t.count as f64, self.leading);
        // (Q_1^-1 + d)^-1 = (I + Q_1 d)^-1 Q_1: exact without spread, and for states without noise.
        let beyond = DMatrix::identity(m, m) + &t.noise * &t.inverse_beyond / count;
        let noise = beyond.lu().solve(&t.noise).ok_or(EstimatorError::BoundNoiseSingular)?;
        let noise = (&noise + noise.transpose()) * 0.5;
        let weighted = &t.weighted / count;
        let shift = &noise * weighted.transpose();
        let spread = &t.square / count - &weighted * &shift;
        Ok(Some(Transition {
            phi: &t.phi + shift,
            noise,
            spread: Some((&spread + spread.transpose()) * 0.5),
        }))
    }
}

impl Transitions {
    fn of(linear: &Linearisation) -> Self {
        let (m, n) = linear.phi.shape();
        let noise = &linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose();
        let inverse = inverse_of_driven(&noise);
        Self {
            count: 1,
            phi: linear.phi.clone(),
            singular: inverse.is_none(),
            inverse: inverse.unwrap_or_else(|| DMatrix::zeros(m, m)),
            noise,
            phi_beyond: DMatrix::zeros(m, n),
            noise_beyond: DMatrix::zeros(m, m),
            inverse_beyond: DMatrix::zeros(m, m),
            square: DMatrix::zeros(n, n),
            weighted: DMatrix::zeros(n, m),
        }
    }

    fn merge(&mut self, other: &Self) {
        let count = other.count as f64;
        let shift = &other.phi - &self.phi;
        // Where nothing drives a state, its transitions may not spread.
        let undriven =
            (0..shift.nrows()).filter(|&i| self.noise[(i, i)] == 0.0 || other.noise[(i, i)] == 0.0);
        self.singular |= other.singular;
        self.singular |= undriven.into_iter().any(|i| shift.row(i).iter().any(|by| *by != 0.0));
        let weight = &other.inverse * count + &other.inverse_beyond;
        let crossed = &other.weighted * &shift;
        self.square += &other.square + &crossed + crossed.transpose() + shift.transpose() * &weight * &shift;
        self.weighted += &other.weighted + shift.transpose() * weight;
        self.inverse_beyond += &other.inverse_beyond + (&other.inverse - &self.inverse) * count;
        self.noise_beyond += &other.noise_beyond + (&other.noise - &self.noise) * count;
        self.phi_beyond += &other.phi_beyond + shift * count;
        self.count += other.count;
    }
}

/// Inverse of a noise covariance over the states that have noise, zero elsewhere; `None` if it is singular.
fn inverse_of_driven(noise: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let driven: Vec<usize> = (0..noise.nrows()).filter(|&i| noise[(i, i)] > 0.0).collect();
    let inverse = regular_inverse(&noise.select_rows(&driven).select_columns(&driven))?;
    let mut all = DMatrix::zeros(noise.nrows(), noise.nrows());
    for (i, &row) in driven.iter().enumerate() {
        for (j, &column) in driven.iter().enumerate() {
            all[(row, column)] = inverse[(i, j)];
        }
    }
    Some(all)
}

/// Inverse of a covariance by its correlations, so that units do not matter; `None` if it is singular up to rounding.
fn regular_inverse(covariance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = covariance.nrows();
    let sd = covariance.diagonal().map(f64::sqrt);
    let factor = Cholesky::new(covariance.map_with_location(|i, j, p| p / (sd[i] * sd[j])))?;
    // The square of a pivot is what the others leave of a variance.
    let smallest = factor.l_dirty().diagonal().iter().fold(1.0_f64, |least, pivot| least.min(pivot * pivot));
    (smallest > 10.0 * n as f64 * f64::EPSILON)
        .then(|| factor.inverse().map_with_location(|i, j, p| p / (sd[i] * sd[j])))
}
