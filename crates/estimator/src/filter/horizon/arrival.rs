//! The cost of arriving at the window's start: all that the samples before it say.
//!
//! It is the filtering update of Rao, Rawlings and Mayne 2003: mean and covariance of the Kalman filter at the sample
//! before the window, which no reading inside the window has entered, so nothing counts twice. The filter moves on
//! by one sample as that leaves the window, linearised along the window's own trajectory, which later samples have
//! improved; an outlier enters with the noise variance `R |r| / delta` that its pull on that trajectory has. On a
//! linear problem this is the Kalman filter. Constraints do not enter: their effect before the window is given up,
//! which loses information but adds no bias.
//!
//! The covariance may be singular, so the cost is `|xi|^2` with `x_0 = xbar + S xi`, `S = U sqrt(D)`.
use nalgebra::{DMatrix, DVector};

use super::interval::Interval;
use crate::EstimatorError;
use crate::filter::UdFactors;

/// Filter at the window's start.
#[derive(Clone, Debug)]
pub(super) struct Arrival {
    /// `xbar`: (n).
    pub mean: DVector<f64>,
    /// `S`: (n, n) upper triangular, with zero columns where nothing is in doubt.
    pub root: DMatrix<f64>,
    factors: UdFactors,
    gain: Vec<f64>,
}

impl Arrival {
    /// Start from a prior.
    ///
    /// # Errors
    /// The covariance is not one.
    pub(super) fn try_new(mean: &DVector<f64>, covariance: &DMatrix<f64>) -> Result<Self, EstimatorError> {
        let factors = UdFactors::from_covariance(covariance)?;
        let mut arrival = Self {
            mean: mean.clone(),
            root: DMatrix::zeros(mean.len(), mean.len()),
            factors,
            gain: vec![0.0; mean.len()],
        };
        arrival.refresh_root();
        Ok(arrival)
    }

    /// Move on over an interval linearised at `from` and, its readings, at `to`.
    pub(super) fn absorb(&mut self, interval: &Interval, from: &DVector<f64>, to: &DVector<f64>) {
        let leading = interval.linear.phi.nrows();
        let offset = &self.mean - from;
        let mut moved = self.mean.rows_mut(0, leading);
        moved.copy_from(&interval.advanced.rows(0, leading));
        moved.gemv(1.0, &interval.linear.phi, &offset, 1.0);
        self.factors.predict(&interval.linear);
        for reading in &interval.readings {
            let nu = interval.residual_after(reading, &(&self.mean - to));
            let column = interval.gradient.column(reading.output);
            self.factors.update(column.as_slice(), 1.0 / reading.weight, &mut self.gain);
            self.mean.iter_mut().zip(&self.gain).for_each(|(x, k)| *x += k * nu);
        }
        self.refresh_root();
    }

    /// Bring state `i` nearer to `rest` by a factor.
    pub(super) fn relax(&mut self, i: usize, factor: f64, rest: f64) {
        self.mean[i] = rest + factor * (self.mean[i] - rest);
        self.factors.scale(i, factor);
        self.refresh_root();
    }

    /// Add `variance` to state `i`.
    pub(super) fn inflate(&mut self, i: usize, variance: f64) {
        self.factors.inflate(i, variance);
        self.refresh_root();
    }

    fn refresh_root(&mut self) {
        self.root.copy_from(self.factors.unit_upper());
        for (mut column, d) in self.root.column_iter_mut().zip(self.factors.diagonal()) {
            column *= d.sqrt();
        }
    }

    /// The `xi` of a state, as far as the doubt about the state reaches: (n).
    pub(super) fn deviation(&self, x: &DVector<f64>) -> DVector<f64> {
        let mut xi = x - &self.mean;
        for j in (0..xi.len()).rev() {
            let pivot = self.root[(j, j)];
            xi[j] = if pivot > 0.0 { xi[j] / pivot } else { 0.0 };
            let (mut above, value) = (xi.rows(0, j).into_owned(), xi[j]);
            above.axpy(-value, &self.root.view((0, j), (j, 1)).column(0), 1.0);
            xi.rows_mut(0, j).copy_from(&above);
        }
        xi
    }
}
