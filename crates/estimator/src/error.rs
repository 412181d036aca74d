//! Everything that can go wrong in this crate.

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EstimatorError {
    /// The thermal model refused.
    #[error(transparent)]
    Thermal(#[from] cylwatch_thermal::ThermalError),
    /// A covariance holds NaN or an infinity.
    #[error("covariance element ({row}, {column}) is not a finite number")]
    CovarianceNotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
    },
    /// A covariance is not symmetric.
    #[error("covariance elements ({row}, {column}) = {upper} and ({column}, {row}) = {lower} must be equal")]
    CovarianceNotSymmetric {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// Element above the diagonal.
        upper: f64,
        /// Its mirror image.
        lower: f64,
    },
    /// A covariance is not positive semi-definite.
    #[error(
        "covariance is not positive semi-definite: of the variance {variance} of state {state} the later states \
         leave {left}; lower its covariances or raise its variance"
    )]
    CovarianceIndefinite {
        /// State, from 0.
        state: usize,
        /// Its variance.
        variance: f64,
        /// What is left of it when the later states are known.
        left: f64,
    },
    /// A setting of the observer is out of its bounds.
    #[error("observer setting `{setting}` = {value} must be {bound}")]
    ObserverSetting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// Two sensors have one name.
    #[error("sensor `{name}` is there twice; give each sensor a name of its own")]
    SensorTwice {
        /// The name.
        name: String,
    },
    /// A sensor sits where the vessel has nothing.
    #[error(
        "sensor `{name}` sits where `{vessel}` has no place: surface sensors sit at bottom, middle, shoulder, neck, a \
         height on the wall, or the valve if the vessel has one"
    )]
    SensorPlace {
        /// Name of the sensor.
        name: String,
        /// Name of the vessel.
        vessel: String,
    },
    /// An observer without sensors.
    #[error("an observer needs at least one sensor")]
    NoSensors,
    /// A row of readings of another length.
    #[error("the observer has {expected} sensors, but the row has {found} readings")]
    RowLength {
        /// Number of sensors.
        expected: usize,
        /// Number of readings.
        found: usize,
    },
    /// Time that runs backwards, or is no number.
    #[error("time {time_s} s must be a number not before the last sample at {last_s} s")]
    TimeBackwards {
        /// Time of the row, s.
        time_s: f64,
        /// Time of the last row, s; NaN: there was none.
        last_s: f64,
    },
    /// A setting of the generator of truths is out of range.
    #[error("truth setting {setting} = {value} must be between {low} and {high}")]
    TruthSetting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// Smallest allowed value.
        low: f64,
        /// Largest allowed value.
        high: f64,
    },
    /// The vessel has no such place for a sensor.
    #[error("the vessel has no {place} for a sensor: take one with shoulder and valve")]
    NoSuchPlace {
        /// Name of the place.
        place: &'static str,
    },
    /// A file of a truth cannot be read.
    #[error("line {line} of the truth file: {reason}: write the file anew")]
    TruthFile {
        /// Line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// Reading or writing failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}
