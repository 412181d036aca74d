//! The samples of a window, the trajectory through them, and the cost of arriving there.
use nalgebra::DVector;

use super::arrival::Arrival;
use super::constraint::Constraint;
use super::interval::Interval;
use super::outcome::HorizonError;
use super::settings::Loss;
use crate::filter::StateSpace;

/// States and noises over a window of `N` intervals.
#[derive(Clone, Debug)]
pub(super) struct WindowTrajectory {
    /// States at the window's start and at each sample (or their changes `delta`): N + 1 of (n).
    pub x: Vec<DVector<f64>>,
    /// Noises in standard deviations: N of (k).
    pub omega: Vec<DVector<f64>>,
    /// Initial state in standard deviations: (n).
    pub xi: DVector<f64>,
}

impl WindowTrajectory {
    pub(super) fn newest(&self) -> &DVector<f64> {
        self.x.last().expect("a path holds the state at the window's start")
    }

    /// The path a fraction `alpha` of the way along `step`, whose states are changes and whose noises are absolute.
    pub(super) fn towards(&self, step: &WindowTrajectory, alpha: f64) -> Self {
        let blend = |a: &DVector<f64>, b: &DVector<f64>| a * (1.0 - alpha) + b * alpha;
        Self {
            x: self.x.iter().zip(&step.x).map(|(x, delta)| x + delta * alpha).collect(),
            omega: self.omega.iter().zip(&step.omega).map(|(a, b)| blend(a, b)).collect(),
            xi: blend(&self.xi, &step.xi),
        }
    }
}

/// A window, and the best trajectory through it that is known.
#[derive(Clone, Debug)]
pub(super) struct Window {
    pub arrival: Arrival,
    pub intervals: Vec<Interval>,
    pub path: WindowTrajectory,
}

impl Window {
    /// A window without samples.
    pub(super) fn new(arrival: Arrival) -> Self {
        let path = WindowTrajectory {
            x: vec![arrival.mean.clone()],
            omega: Vec::new(),
            xi: arrival.mean.map(|_| 0.0),
        };
        Self { arrival, intervals: Vec::new(), path }
    }

    /// Let the oldest sample go into the arrival cost.
    pub(super) fn slide<M: StateSpace>(
        &mut self,
        model: &mut M,
        loss: Loss,
    ) -> Result<(), HorizonError<M::Error>> {
        let (from, to) = (&self.path.x[0], &self.path.x[1]);
        self.intervals[0].linearise(model, from, to, loss)?;
        self.arrival.absorb(&self.intervals[0], from, to);
        self.intervals.remove(0);
        self.path.x.remove(0);
        self.path.omega.remove(0);
        self.path.xi = self.arrival.deviation(&self.path.x[0]);
        Ok(())
    }

    /// Put a sample at the end, its state predicted.
    pub(super) fn append<M: StateSpace>(
        &mut self,
        model: &mut M,
        interval: Interval,
    ) -> Result<(), HorizonError<M::Error>> {
        let mut x = self.path.newest().clone();
        interval.advance(model, x.as_mut_slice())?;
        self.path.x.push(x);
        self.path.omega.push(DVector::zeros(model.noises()));
        self.intervals.push(interval);
        Ok(())
    }

    /// Linearise every interval along the trajectory.
    pub(super) fn linearise<M: StateSpace>(
        &mut self,
        model: &mut M,
        loss: Loss,
    ) -> Result<(), HorizonError<M::Error>> {
        let ends = self.path.x.windows(2);
        self.intervals.iter_mut().zip(ends).try_for_each(|(i, x)| i.linearise(model, &x[0], &x[1], loss))
    }

    /// Whether the newest state of `path` is outside a constraint.
    pub(super) fn ends_outside(&self, constraints: &[Constraint], path: &WindowTrajectory) -> bool {
        let last = self.intervals.len();
        let (x, previous) = (path.x[last].as_slice(), path.x[last.saturating_sub(1)].as_slice());
        constraints.iter().any(|c| c.excess(previous, x) > 0.0)
    }
}
