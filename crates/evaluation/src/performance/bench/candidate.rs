//! Detectors as a bench runs them: rows in, one number out.
use crate::EvaluationError;
use crate::baseline::{ErrorCusum, Reading, Threshold};
use crate::performance::Found;

/// What the sensors of one cylinder read at one time; NaN: missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Readings {
    /// Time, s.
    pub time_s: f64,
    /// Shoulder, K.
    pub shoulder_k: f64,
    /// Valve, K.
    pub valve_k: f64,
    /// Pressure, Pa.
    pub pressure_pa: f64,
}

/// A detector at work on one cylinder.
pub trait Contender {
    /// Take a row; the statistic after it, which alarms from a threshold on. Minus infinity: it cannot tell yet.
    ///
    /// # Errors
    /// What the detector cannot go on with.
    fn step(&mut self, readings: &Readings) -> Result<f64, EvaluationError>;

    /// What it says about the leak now; `None`: nothing.
    fn found(&mut self) -> Option<Found> {
        None
    }

    /// Its estimate of the pressure at 15 °C, Pa, as free of a leak hypothesis as it has; `None`: it has none. What it does
    /// without a leak is the noise behind the shortest possible delay.
    fn settled_pa(&self) -> Option<f64> {
        None
    }
}

/// Starts a detector for one cylinder.
type Start = Box<dyn Fn() -> Result<Box<dyn Contender>, EvaluationError> + Send + Sync>;

/// A detector by its name.
pub struct Candidate {
    /// Name for tables.
    pub name: String,
    /// Unit of its statistic.
    pub unit: &'static str,
    start: Start,
}

impl Candidate {
    /// A detector that `start` makes anew for each cylinder.
    pub fn new<C: Contender + 'static>(
        name: &str,
        unit: &'static str,
        start: impl Fn() -> Result<C, EvaluationError> + Send + Sync + 'static,
    ) -> Self {
        let boxed = move || start().map(|contender| Box::new(contender) as Box<dyn Contender>);
        Self { name: name.to_owned(), unit, start: Box::new(boxed) }
    }

    /// At the beginning of a cylinder.
    ///
    /// # Errors
    /// What its settings are refused for.
    pub fn start(&self) -> Result<Box<dyn Contender>, EvaluationError> {
        (self.start)()
    }
}

impl std::fmt::Debug for Candidate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Candidate").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Contender for Threshold {
    fn step(&mut self, readings: &Readings) -> Result<f64, EvaluationError> {
        Ok(self.update(readings.seen()))
    }
}

impl Contender for ErrorCusum {
    fn step(&mut self, readings: &Readings) -> Result<f64, EvaluationError> {
        Ok(self.update(readings.seen()))
    }
}

impl Readings {
    /// What a detector without an observer looks at.
    pub(super) fn seen(&self) -> Reading {
        Reading { time_s: self.time_s, shoulder_k: self.shoulder_k, pressure_pa: self.pressure_pa }
    }
}
