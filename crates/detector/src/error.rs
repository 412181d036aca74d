//! Everything that can go wrong in this crate.

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DetectorError {
    /// A setting is out of its bounds.
    #[error("setting `{setting}` = {value} must be {bound}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// The matrices of a filter step do not fit each other or the failure.
    #[error("`{matrix}` is {rows} x {columns} but must be {expected_rows} x {expected_columns}")]
    Shape {
        /// Name of the matrix.
        matrix: &'static str,
        /// Rows as given.
        rows: usize,
        /// Columns as given.
        columns: usize,
        /// Rows that fit.
        expected_rows: usize,
        /// Columns that fit.
        expected_columns: usize,
    },
    /// The covariance of an innovation is not positive definite.
    #[error("the covariance of the innovation must be positive definite")]
    InnovationCovariance,
    /// An innovation is NaN or infinite.
    #[error("innovation {output} is not a finite number: leave outputs without a reading out of the step")]
    InnovationNotFinite {
        /// Which one, from 0.
        output: usize,
    },
    /// No threshold gives the wished mean time between false alarms.
    #[error(
        "a mean time of {wished} samples is out of reach: between thresholds {low} and {high} it can be {shortest} to {longest}"
    )]
    OutOfReach {
        /// Wished mean number of samples between false alarms.
        wished: f64,
        /// Smallest threshold that was tried.
        low: f64,
        /// Largest threshold that was tried.
        high: f64,
        /// Mean number of samples at the smallest.
        shortest: f64,
        /// Mean number of samples at the largest.
        longest: f64,
    },
    /// Too few residuals to learn from.
    #[error("{found} residuals are too few: give at least {needed}")]
    TooFewResiduals {
        /// Number as given, NaN left out.
        found: usize,
        /// Number needed.
        needed: usize,
    },
    /// Residuals that do not vary.
    #[error("the residuals do not vary: a threshold needs their noise")]
    ResidualsConstant,
    /// Times and residuals differ in number, or times do not increase.
    #[error("time {time_s} s of residual {index} must be a number above that of the one before")]
    TimeBackwards {
        /// Index of the residual, from 0.
        index: usize,
        /// Its time, s.
        time_s: f64,
    },
    /// The gas has no such state.
    #[error(transparent)]
    Gas(#[from] cylwatch_estimator::thermal::ThermalError),
    /// A mass has no pressure in the vessel at a temperature.
    #[error(
        "{mass_kg} kg have no pressure at {temperature_k} K in {volume_m3} m3: give a mass that fits the vessel"
    )]
    NoPressure {
        /// Mass, kg.
        mass_kg: f64,
        /// Temperature, K.
        temperature_k: f64,
        /// Volume, m³.
        volume_m3: f64,
    },
    /// A row has another number of readings than there are sensors.
    #[error(
        "a row of {found} readings does not fit {expected} sensors: give one each, NaN where it is missing"
    )]
    RowLength {
        /// Number of sensors.
        expected: usize,
        /// Number of readings.
        found: usize,
    },
    /// An alarm is in a state in which something cannot be done to it.
    #[error("the alarm cannot be {act}: {reason}")]
    AlarmState {
        /// What was to be done.
        act: &'static str,
        /// What stands against it.
        reason: &'static str,
    },
    /// A state that cannot be continued from.
    #[error(transparent)]
    State(#[from] crate::monitor::state::StateError),
    /// The observer could not go on.
    #[error(transparent)]
    Observer(#[from] cylwatch_estimator::EstimatorError),
    /// The observer's bank lacks a member that the evidence needs.
    #[error("the observer's bank must have a member whose mass walks and another one whose leak rate walks")]
    Bank,
}

/// `value` if it is positive and finite.
pub(crate) fn positive(setting: &'static str, value: f64) -> Result<f64, DetectorError> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(DetectorError::Setting { setting, value, bound: "positive and finite" })
}
