//! What a leak, a fault or the sun leaves in the innovations of the steady filter, and in its estimates.
//!
//! A disturbance of constant size `u` drives the states by `B u` from one sample to the next and shifts the readings by `D u`. With the
//! error `e` before an update, and the steady gain `K`,
//!
//! `d = H e + D u`, `e <- F (I - K H) e + (B - F K D) u`.
//!
//! The innovations of a filter that supposes none stay white with their covariance `S`, about the mean `d`. All that `N` samples since its
//! onset tell of `u` is therefore
//!
//! `J(N) = sum_k d_k^T S^-1 d_k` for `u = 1`,
//!
//! and no test of one-sided false-alarm threshold `b`, in standard deviations of the best statistic, finds a `u` with a
//! probability whose quantile is `z` before `u sqrt(J) = b + z`. Of several disturbances `J` is a matrix; what can be told of one whatever
//! the other is, `J_ii - J_ij^2 / J_jj`, says whether the two can be told apart.
//!
//! Sums over `N = 2^m` samples come from those over half of them, for the state that has `u` beside `e`:
//! `J(a + b) = J(a) + (M^a)^T J(b) M^a`.
//!
//! Assumes a filter at its steady state at rest, and an onset at a sample. Source: Willsky and Jones 1976.
use nalgebra::{DMatrix, DVector};

use super::GroupedProblem;
use super::cylinder::{InstrumentedCylinder, Quantity};
use crate::EstimatorError;
use crate::filter::{SteadyState, steady_state};

/// Doublings: two years of minutes.
const DOUBLINGS: usize = 20;

/// What disturbs the cylinder or its sensors from a sample on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Disturbance {
    /// A leak of 1 kg/s.
    Leak,
    /// An error of a candidate's readings of 1 K or 1 Pa.
    Reading {
        /// Index of the candidate.
        candidate: usize,
    },
    /// Sun of 1 W on the upper quarter of the wall.
    Sun,
}

/// Response of the filter that reads a layout to disturbances.
#[derive(Clone, Debug)]
pub struct Response {
    steady: SteadyState,
    /// Of the states of the layout.
    left: DMatrix<f64>,
    by_reading: DMatrix<f64>,
    functionals: [Option<DVector<f64>>; 3],
    /// What the innovations see of errors and disturbances, divided by their covariance: (m, n + u).
    seen: DMatrix<f64>,
    /// Sums over `2^m` samples, and the states after them.
    doublings: Vec<SampleBlock>,
}

/// A block of samples: the sum of information and the transition, of errors and disturbances: (n + u, n + u).
#[derive(Clone, Debug)]
struct SampleBlock {
    information: DMatrix<f64>,
    transition: DMatrix<f64>,
}

impl SampleBlock {
    fn none(size: usize) -> Self {
        Self { information: DMatrix::zeros(size, size), transition: DMatrix::identity(size, size) }
    }

    /// This one, then another.
    fn then(&self, later: &Self) -> Self {
        let added = self.transition.transpose() * &later.information * &self.transition;
        Self { information: &self.information + added, transition: &later.transition * &self.transition }
    }
}

impl InstrumentedCylinder {
    /// Response of the filter that reads a layout.
    ///
    /// # Errors
    /// [`EstimatorError::Unseen`] where the layout has no steady state; a disturbance is no candidate of the layout.
    pub fn response(
        &self,
        problem: &GroupedProblem,
        layout: &[usize],
        disturbances: &[Disturbance],
    ) -> Result<Response, EstimatorError> {
        let states = problem.states_of(layout);
        let of_layout = problem.of_layout(layout);
        let (n, m, count) = (states.len(), layout.len(), disturbances.len());
        let f = of_layout.transition();
        let h = DMatrix::from_fn(m, n, |i, j| of_layout.outputs()[i].gradient[j]);
        let r = DVector::from_iterator(m, of_layout.outputs().iter().map(|output| output.variance));
        let unseen = |_| self.unseen_error(layout);
        let steady = steady_state(f, &h, of_layout.process_noise(), &r).map_err(unseen)?;
        let mut by_state = DMatrix::zeros(n, count);
        let mut by_reading = DMatrix::zeros(m, count);
        for (index, disturbance) in disturbances.iter().enumerate() {
            match disturbance {
                Disturbance::Leak => by_state.set_column(index, &self.leak_drive().select_rows(&states)),
                Disturbance::Sun => {
                    if let Some(drive) = self.sun_drive() {
                        by_state.set_column(index, &drive.select_rows(&states));
                    }
                }
                Disturbance::Reading { candidate } => {
                    let place = layout.iter().position(|of| of == candidate);
                    let (readings, outputs) = (*candidate, m);
                    let place = place.ok_or(EstimatorError::ReadingsLength { readings, outputs })?;
                    by_reading[(place, index)] = 1.0;
                }
            }
        }
        let left = DMatrix::identity(n, n) - &steady.gain * &h;
        let mut transition = DMatrix::identity(n + count, n + count);
        transition.view_mut((0, 0), (n, n)).copy_from(&(f * &left));
        transition.view_mut((0, n), (n, count)).copy_from(&(by_state - f * &steady.gain * &by_reading));
        let mut seen = DMatrix::zeros(m, n + count);
        seen.columns_mut(0, n).copy_from(&h);
        seen.columns_mut(n, count).copy_from(&by_reading);
        let whitened = steady.innovation.clone().cholesky().map(|root| root.solve(&seen));
        let whitened = whitened.ok_or_else(|| self.unseen_error(layout))?;
        let information = seen.transpose() * &whitened;
        let mut doublings = vec![SampleBlock { information, transition }];
        for _ in 0..DOUBLINGS {
            let last = &doublings[doublings.len() - 1];
            doublings.push(last.then(last));
        }
        let functional = |quantity| Some(self.functional(quantity).ok()?.select_rows(&states));
        let functionals = [Quantity::GasTemperature, Quantity::Mass, Quantity::LeakRate].map(functional);
        Ok(Response { steady, left, by_reading, functionals, seen: whitened, doublings })
    }

    /// The state that a layout does not see, as an error.
    pub(super) fn unseen_error(&self, layout: &[usize]) -> EstimatorError {
        match self.unseen(layout) {
            Some(state) => EstimatorError::Unseen { state: state.to_owned() },
            None => EstimatorError::NoSteadyState,
        }
    }
}

impl Response {
    fn passage(&self, samples: u64) -> SampleBlock {
        let size = self.doublings[0].transition.nrows();
        let taken = self.doublings.iter().enumerate().filter(|(power, _)| samples >> power & 1 == 1);
        taken.fold(SampleBlock::none(size), |so_far, (_, passage)| so_far.then(passage))
    }

    fn errors(&self) -> usize {
        self.left.nrows()
    }

    /// Information of so many samples on the sizes of all disturbances: (u, u).
    pub fn information(&self, samples: u64) -> DMatrix<f64> {
        let (n, count) = (self.errors(), self.by_reading.ncols());
        self.passage(samples).information.view((n, n), (count, count)).into_owned()
    }

    /// Fewest samples whose information on a disturbance reaches an amount; `None`: two years do not.
    pub fn samples_to(&self, disturbance: usize, needed: f64) -> Option<u64> {
        let at = self.errors() + disturbance;
        let mut so_far = SampleBlock::none(self.doublings[0].transition.nrows());
        let mut samples = 0;
        for (power, passage) in self.doublings.iter().enumerate().rev() {
            let further = so_far.then(passage);
            if further.information[(at, at)] < needed {
                (so_far, samples) = (further, samples + (1 << power));
            }
        }
        (samples + 1 < 2 << DOUBLINGS).then_some(samples + 1)
    }

    /// Weights of the innovations of so many samples since the onset, (samples)(m), whose sum is the best statistic of a disturbance: of variance one
    /// while there is none, and of mean `u sqrt(J)` where it has the size `u`.
    pub fn weights(&self, disturbance: usize, samples: u64) -> Vec<DVector<f64>> {
        let at = self.errors() + disturbance;
        let transition = &self.doublings[0].transition;
        let scale = self.passage(samples).information[(at, at)].sqrt().recip();
        let mut state = DVector::zeros(transition.nrows());
        state[at] = scale;
        let mut weight = |_| {
            let weight = &self.seen * &state;
            state = transition * &state;
            weight
        };
        (0..samples).map(&mut weight).collect()
    }

    /// Change of the estimate of a quantity, K, kg or kg/s, after so many samples, per unit of each disturbance: (u). Empty where the
    /// member does not estimate it.
    pub fn bias(&self, quantity: Quantity, samples: u64) -> Vec<f64> {
        let Some(functional) = &self.functionals[quantity as usize] else { return Vec::new() };
        let (n, count) = (self.errors(), self.by_reading.ncols());
        let before = self.passage(samples).transition.view((0, n), (n, count)).into_owned();
        // After the update with the last sample; the estimate is off by minus its error.
        let error = &self.left * before - &self.steady.gain * &self.by_reading;
        (functional.transpose() * -error).iter().copied().collect()
    }
}

/// What a detector of the innovations is to reach.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DetectionSettings {
    /// Time within which a leak is to be found, s.
    pub within_s: f64,
    /// Threshold of the best statistic, in its standard deviations: what the rate of false alarms asks for.
    pub threshold_sd: f64,
    /// Quantile of the probability that the leak is found: 1.645 for 95 %.
    pub power_sd: f64,
}

impl Default for DetectionSettings {
    /// Within a day with 95 %, at a threshold of 5.42 standard deviations: one false alarm in ten years of samples every minute, for a ramp in
    /// white noise.
    fn default() -> Self {
        Self { within_s: 86_400.0, threshold_sd: 5.42, power_sd: 1.645 }
    }
}

impl DetectionSettings {
    /// Size of a disturbance times the root of its information at which it is found.
    pub fn needed_sd(&self) -> f64 {
        self.threshold_sd + self.power_sd
    }

    /// Smallest size that is found with an information on its unit.
    pub fn smallest(&self, information: f64) -> f64 {
        self.needed_sd() / information.sqrt()
    }

    /// Samples at an interval, s, in the time.
    pub fn samples(&self, interval_s: f64) -> u64 {
        (self.within_s / interval_s).round().max(1.0) as u64
    }
}
