//! Everything that can go wrong in this crate.

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// The thermal model refused.
    #[error(transparent)]
    Thermal(#[from] cylwatch_thermal::ThermalError),
    /// The observer, or what its layouts are placed by, refused.
    #[error(transparent)]
    Estimator(#[from] cylwatch_estimator::EstimatorError),
    /// A detector refused.
    #[error(transparent)]
    Detector(#[from] cylwatch_detector::DetectorError),
    /// Too few largest values to tell their tail.
    #[error("{found} stretches of operation are too few: give at least {needed}")]
    TooFewStretches {
        /// Number as given, NaN left out.
        found: usize,
        /// Number needed.
        needed: usize,
    },
    /// Largest values without a tail.
    #[error("the largest values do not vary: a threshold needs their tail")]
    StatisticsConstant,
    /// Tails that are not those of all scales.
    #[error(
        "the scales must be hour, half-day, day, week and month, in this order: commission the vessel anew"
    )]
    Scales,
    /// A world that cannot be made.
    #[error(transparent)]
    World(Box<crate::world::WorldError>),
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
    /// A record has no sensor of that name.
    #[error("there is no sensor `{sensor}`: there are {known}")]
    NoSuchSensor {
        /// Name that was asked for.
        sensor: String,
        /// Names that there are.
        known: String,
    },
    /// Too few runs to set a threshold by.
    #[error("{found} runs with a statistic are too few for a threshold: give at least {needed}")]
    TooFewRuns {
        /// Runs with a statistic.
        found: usize,
        /// Runs needed.
        needed: usize,
    },
}

impl From<crate::world::WorldError> for EvaluationError {
    fn from(error: crate::world::WorldError) -> Self {
        Self::World(Box::new(error))
    }
}

/// `value` if it is positive and finite.
pub(crate) fn positive(setting: &'static str, value: f64) -> Result<f64, EvaluationError> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(EvaluationError::Setting { setting, value, bound: "positive and finite" })
}
