//! The bound from sample to sample.
use nalgebra::DMatrix;

use super::moments::{Moments, Transition};
use crate::EstimatorError;
use crate::filter::{Linearisation, StateSpace, StepError, UdFactors};

/// How the expectation over paths is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation {
    /// As published: the spread of the transitions counts. The noise must be regular where transitions spread.
    Full,
    /// With the mean transition: never below the bound as published. The noise may be singular.
    MeanTransition,
}

/// The bound at the present sample.
#[derive(Clone, Debug, PartialEq)]
pub struct PosteriorBound {
    expectation: Expectation,
    leading: usize,
    covariance: DMatrix<f64>,
}

impl PosteriorBound {
    /// The bound before the first sample: the prior covariance (n, n) of a process whose first `leading` states move.
    /// States may be known exactly.
    ///
    /// # Errors
    /// The prior is no covariance.
    pub fn try_new(
        prior: &DMatrix<f64>,
        leading: usize,
        expectation: Expectation,
    ) -> Result<Self, EstimatorError> {
        let n = prior.nrows();
        if !prior.is_square() || leading > n {
            return Err(EstimatorError::StateLength { length: prior.ncols(), states: n });
        }
        UdFactors::from_covariance(prior)?;
        Ok(Self { expectation, leading, covariance: prior.clone() })
    }

    /// Move to the next sample, by the sums over its paths.
    ///
    /// # Errors
    /// There are no paths, or of a process of another size; or the noise is singular and [`Expectation::Full`] cannot go on.
    pub fn step(&mut self, moments: &Moments) -> Result<(), EstimatorError> {
        moments.check_size(self.covariance.nrows(), self.leading)?;
        if moments.paths() == 0 {
            return Err(EstimatorError::NoPaths);
        }
        let transition = match self.expectation {
            Expectation::Full => moments.full_transition()?,
            Expectation::MeanTransition => moments.mean_transition(),
        };
        if let Some(transition) = transition {
            self.predict(&transition)?;
        }
        self.inform(&moments.information())
    }

    /// `P <- F P F^T + Q`, `F = [phi; 0 I]`, after the information that the spread of the transitions gives.
    fn predict(&mut self, transition: &Transition) -> Result<(), EstimatorError> {
        if let Some(spread) = &transition.spread {
            self.inform(spread)?;
        }
        let (n, m) = (self.covariance.nrows(), self.leading);
        let mut f = DMatrix::identity(n, n);
        f.rows_mut(0, m).copy_from(&transition.phi);
        self.covariance = &f * &self.covariance * f.transpose();
        let mut corner = self.covariance.view_mut((0, 0), (m, m));
        corner += &transition.noise;
        Ok(())
    }

    /// `(P^-1 + M)^-1` as `P - P L (I + L^T P L)^-1 L^T P` with `M = L L^T`, in units of standard deviations.
    fn inform(&mut self, information: &DMatrix<f64>) -> Result<(), EstimatorError> {
        let n = self.covariance.nrows();
        let sd = self.covariance.diagonal().map(|p| if p > 0.0 { p.sqrt() } else { 1.0 });
        let prior = self.covariance.map_with_location(|i, j, p| p / (sd[i] * sd[j]));
        let axes = information.map_with_location(|i, j, m| m * (sd[i] * sd[j])).symmetric_eigen();
        let root = &axes.eigenvectors * DMatrix::from_diagonal(&axes.eigenvalues.map(|v| v.max(0.0).sqrt()));
        let spread = &prior * &root;
        let inner = DMatrix::identity(n, n) + root.transpose() * &spread;
        let factor = inner.cholesky().ok_or(EstimatorError::CovarianceSingular { state: n - 1 })?;
        let p = prior - &spread * factor.solve(&spread.transpose());
        self.covariance = ((&p + p.transpose()) * 0.5).map_with_location(|i, j, p| p * (sd[i] * sd[j]));
        Ok(())
    }

    /// The bound on the covariance: (n, n).
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }
}

/// The bound at every sample, from true paths: `paths[i][k]` is the state (n) of path `i` at sample `k`.
///
/// `intervals_s[k]` is the time from sample `k - 1` to `k`, s (the first one: 0), `heard[k]` tells which outputs have a reading.
///
/// # Errors
/// As [`Moments::add_path`], [`PosteriorBound::try_new`] and [`PosteriorBound::step`].
pub fn posterior_bound<M: StateSpace>(
    model: &mut M,
    prior: &DMatrix<f64>,
    paths: &[Vec<Vec<f64>>],
    (intervals_s, heard): (&[f64], &[Vec<bool>]),
    expectation: Expectation,
) -> Result<Vec<DMatrix<f64>>, StepError<M::Error>> {
    let (n, leading) = (model.states(), model.leading());
    let mut linear = Linearisation::zeros(n, leading, model.noises());
    let mut bound = PosteriorBound::try_new(prior, leading, expectation)?;
    let mut bounds = Vec::with_capacity(intervals_s.len());
    for (k, (&dt_s, heard)) in intervals_s.iter().zip(heard).enumerate() {
        let mut moments = Moments::new(n, leading);
        for path in paths {
            let step = (path[k.saturating_sub(1)].as_slice(), dt_s, path[k].as_slice());
            moments.add_path(model, step, heard, &mut linear)?;
        }
        bound.step(&moments)?;
        bounds.push(bound.covariance().clone());
    }
    Ok(bounds)
}

/// The bound of one path by itself, one sample further: the covariance of a filter that linearises on the true path.
///
/// # Errors
/// As [`Moments::add_path`].
pub fn path_bound<M: StateSpace>(
    model: &mut M,
    p: &mut UdFactors,
    (before, dt_s, after): (&[f64], f64, &[f64]),
    heard: &[bool],
    linear: &mut Linearisation,
) -> Result<(), StepError<M::Error>> {
    if dt_s > 0.0 {
        let mut moved = before.to_vec();
        model.propagate(&mut moved, dt_s, Some(linear)).map_err(StepError::Model)?;
        p.predict(linear);
    }
    let (mut h, mut gain) = (vec![0.0; after.len()], vec![0.0; after.len()]);
    for output in (0..heard.len()).filter(|output| heard[*output]) {
        model.output(output, after, Some(&mut h)).map_err(StepError::Model)?;
        let variance = model.noise_variance(output, after);
        if !(variance > 0.0 && variance.is_finite()) {
            return Err(EstimatorError::NoiseNotPositive { variance }.into());
        }
        p.update(&h, variance, &mut gain);
    }
    Ok(())
}
