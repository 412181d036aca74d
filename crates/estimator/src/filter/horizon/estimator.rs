//! The estimator: slide the window, iterate, report.
use nalgebra::{DMatrix, DVector};

use super::arrival::Arrival;
use super::constraint::{Constraint, StageRow};
use super::gauss_newton::{GaussNewton, Iterated, weigh_readings};
use super::interval::Interval;
use super::outcome::{ActiveConstraint, HorizonError, HorizonEstimate, HorizonStatus, Outlier};
use super::settings::HorizonSettings;
use super::sweep::Sweep;
use super::window::Window;
use crate::EstimatorError;
use crate::filter::StateSpace;

/// Moving-horizon estimator of a process.
///
/// Every sample is one [`step`](Self::step). The estimate of the newest state is the end of the best trajectory
/// through the window; [`trajectory`](Self::trajectory) is the rest of it, smoothed by what came later.
#[derive(Clone, Debug)]
pub struct MovingHorizon<M> {
    model: M,
    constraints: Vec<Constraint>,
    settings: HorizonSettings,
    window: Window,
    sweep: Sweep,
    /// Rows active at the newest sample's optimum.
    active: Vec<StageRow>,
}

impl<M: StateSpace> MovingHorizon<M> {
    /// Estimator that starts from mean and covariance of the state at a time before the first sample, or at it.
    ///
    /// # Shapes
    /// `mean`: (n); `covariance`: (n, n), which may be singular.
    ///
    /// # Errors
    /// A setting or constraint is out of range, or mean and covariance are not of the process's size, not finite, or
    /// the covariance is not symmetric and positive semi-definite.
    pub fn try_new(
        model: M,
        mean: &DVector<f64>,
        covariance: &DMatrix<f64>,
        constraints: Vec<Constraint>,
        settings: HorizonSettings,
    ) -> Result<Self, EstimatorError> {
        settings.validate()?;
        let (n, leading) = (model.states(), model.leading());
        if mean.len() != n || covariance.shape() != (n, n) {
            let (rows, columns) = covariance.shape();
            return Err(EstimatorError::HorizonPrior { states: n, mean: mean.len(), rows, columns });
        }
        if let Some(state) = mean.iter().position(|x| !x.is_finite()) {
            return Err(EstimatorError::HorizonPriorNotFinite { state, value: mean[state] });
        }
        for (row, constraint) in constraints.iter().enumerate() {
            constraint.validate(row, n, leading)?;
        }
        let window = Window::new(Arrival::try_new(mean, covariance)?);
        let sweep = Sweep::new(n, leading, model.noises(), model.outputs());
        Ok(Self { model, constraints, settings, window, sweep, active: Vec::new() })
    }

    /// Take the sample `dt_s` after the previous one (or after the prior), s, and estimate the state there.
    ///
    /// # Shapes
    /// `z`: (outputs), NaN where there is no reading.
    ///
    /// # Errors
    /// The sample is not one, or the process cannot be evaluated; the window is then as before.
    pub fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<HorizonEstimate, HorizonError<M::Error>> {
        self.check(dt_s, z)?;
        if self.window.intervals.len() == self.settings.samples {
            self.window.slide(&mut self.model, self.settings.loss)?;
            self.slide_active();
        }
        let before = self.window.path.clone();
        let interval = Interval::new(&self.model, dt_s, z);
        let appended = self.window.append(&mut self.model, interval);
        let estimate = appended.and_then(|()| self.optimise());
        if estimate.is_err() {
            self.window.intervals.truncate(before.omega.len());
            self.window.path = before;
        }
        estimate
    }

    /// Add `variance` to state `i` at the window's start: a constant that walks so slowly that no interval has noise for it.
    pub(crate) fn inflate(&mut self, i: usize, variance: f64) {
        self.window.arrival.inflate(i, variance);
        self.window.path.xi = self.window.arrival.deviation(&self.window.path.x[0]);
    }

    /// Bring state `i`, a constant, nearer to `rest` by a factor all along the window.
    pub(crate) fn relax(&mut self, i: usize, factor: f64, rest: f64) {
        self.window.arrival.relax(i, factor, rest);
        self.window.path.x.iter_mut().for_each(|x| x[i] = rest + factor * (x[i] - rest));
        self.window.path.xi = self.window.arrival.deviation(&self.window.path.x[0]);
    }

    /// States along the window, from the sample before it to the newest one: each (n).
    pub fn trajectory(&self) -> &[DVector<f64>] {
        &self.window.path.x
    }

    fn check(&self, dt_s: f64, z: &[f64]) -> Result<(), HorizonError<M::Error>> {
        if !(dt_s >= 0.0 && dt_s.is_finite()) {
            return Err(HorizonError::Interval { dt_s });
        }
        let outputs = self.model.outputs();
        if z.len() != outputs {
            return Err(HorizonError::Readings { given: z.len(), outputs });
        }
        match z.iter().enumerate().find(|(_, z)| z.is_infinite()) {
            Some((output, &value)) => Err(HorizonError::ReadingNotFinite { output, value }),
            None => Ok(()),
        }
    }

    /// Active rows move with their samples; a row on constants has its only place at the start and stays.
    fn slide_active(&mut self) {
        let leading = self.model.leading();
        let constraints = &self.constraints;
        self.active.retain(|spot| spot.stage > 0 || constraints[spot.row].is_on_constants(leading));
        self.active.iter_mut().for_each(|spot| spot.stage = spot.stage.saturating_sub(1));
    }

    fn optimise(&mut self) -> Result<HorizonEstimate, HorizonError<M::Error>> {
        let Self { model, constraints, settings, window, sweep, active } = self;
        let iteration = GaussNewton { constraints, settings };
        let iterated = iteration.iterate(model, window, sweep, active)?;
        *active = iterated.resolution.active.iter().map(|a| a.spot).collect();
        if !matches!(iterated.resolution.status, HorizonStatus::Fallback(_)) {
            for x in &mut window.path.x {
                constraints.iter().for_each(|c| c.snap(x.as_mut_slice()));
            }
        }
        if weigh_readings(window, &iterated.resolution, settings.loss) {
            sweep.factorise(&window.intervals, &window.path, &window.arrival.mean, &window.arrival.root);
        }
        Ok(self.report(&iterated))
    }

    fn report(&self, iterated: &Iterated) -> HorizonEstimate {
        let rows = &iterated.resolution.active;
        let spots = || rows.iter().map(|a| (&self.constraints[a.spot.row], a.spot));
        let leading = self.model.leading();
        let last = self.window.intervals.len();
        let active = rows.iter().map(|a| {
            let constant = self.constraints[a.spot.row].is_on_constants(leading);
            let age = if constant { 0 } else { last - a.spot.stage };
            ActiveConstraint { row: a.spot.row, age, multiplier: a.multiplier }
        });
        HorizonEstimate {
            x: self.window.path.newest().clone(),
            covariance: self.sweep.newest_covariance(),
            projected: (!rows.is_empty()).then(|| self.sweep.projected_covariance(spots())),
            active: active.collect(),
            outliers: self.outliers(iterated),
            status: iterated.resolution.status,
            converged: iterated.converged,
            iterations: iterated.iterations,
            qp_solves: iterated.qp_solves,
            qp_iterations: iterated.qp_iterations,
            cost: iterated.cost,
        }
    }

    fn outliers(&self, iterated: &Iterated) -> Vec<Outlier> {
        let intervals = &self.window.intervals;
        let mut found = Vec::new();
        for (i, interval) in intervals.iter().enumerate() {
            for reading in interval.readings.iter().filter(|r| r.weight < 1.0) {
                let residual = interval.residual_after(reading, &iterated.resolution.step.x[i + 1]);
                found.push(Outlier { output: reading.output, age: intervals.len() - 1 - i, residual });
            }
        }
        found
    }
}
