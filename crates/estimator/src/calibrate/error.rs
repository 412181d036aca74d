//! Why nothing can be calibrated.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::units::HOUR_S;

use super::ApparentLeak;

/// What is wrong, with value, bound and remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrateError {
    /// A setting out of its range.
    #[error("calibration setting `{name}` = {value} must lie between {low} and {high}")]
    Setting {
        /// Name of the field.
        name: &'static str,
        /// Its value.
        value: f64,
        /// It must be above this.
        low: f64,
        /// It must be below this.
        high: f64,
    },
    /// Settings of the simulation out of range.
    #[error("calibration setting `simulation`: {source}")]
    Settings {
        /// What the simulation says.
        source: ThermalError,
    },
    /// Nothing to fit to, or nothing to fit.
    #[error("a calibration needs at least one {missing}: give one")]
    Empty {
        /// `experiment` or `parameter`.
        missing: &'static str,
    },
    /// A parameter that is there twice for one experiment.
    #[error("`{parameter}` is there twice for `{experiment}`: leave one of them out")]
    ParameterTwice {
        /// Its name.
        parameter: String,
        /// Source of the experiment.
        experiment: String,
    },
    /// A parameter that an experiment does not have.
    #[error("`{parameter}` needs {missing}, which `{experiment}` does not have: {remedy}")]
    ParameterMisfit {
        /// Its name.
        parameter: String,
        /// Source of the experiment.
        experiment: String,
        /// What is missing.
        missing: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A parameter for an experiment that is not there.
    #[error("`{parameter}` belongs to experiment {experiment}, but there are {experiments}, counted from 0")]
    ScopeUnknown {
        /// Its name.
        parameter: String,
        /// As stated.
        experiment: usize,
        /// Number of experiments.
        experiments: usize,
    },
    /// Start, prior or bounds that cannot be used.
    #[error("{field} of `{parameter}` is {value}: it must be {bound}")]
    ParameterValue {
        /// Its name.
        parameter: String,
        /// `start`, `prior` or `bounds`.
        field: &'static str,
        /// As given.
        value: f64,
        /// What it must be.
        bound: String,
    },
    /// A channel that the log does not have.
    #[error("the log `{experiment}` has no channel `{channel}`: name one of {known:?}")]
    ChannelUnknown {
        /// Source of the experiment.
        experiment: String,
        /// As stated.
        channel: String,
        /// Names of the log's channels.
        known: Vec<String>,
    },
    /// A sensor that reads another quantity than its channel holds.
    #[error(
        "channel `{channel}` of `{experiment}` holds another quantity than its sensor reads: map it to another one"
    )]
    ChannelQuantity {
        /// Source of the experiment.
        experiment: String,
        /// Name of the channel.
        channel: String,
    },
    /// A sensor without noise has infinite weight.
    #[error(
        "sensor `{channel}` of `{experiment}` has no noise: state its standard deviation, or its resolution"
    )]
    NoNoise {
        /// Source of the experiment.
        experiment: String,
        /// Name of the channel.
        channel: String,
    },
    /// Times that do not fit to the scenario.
    #[error(
        "time {time_s} s in row {row} of `{experiment}` must increase and lie between 0 and the scenario's end at \
         {duration_s} s: shift the log's clock or lengthen the scenario"
    )]
    Time {
        /// Source of the experiment.
        experiment: String,
        /// Row, from 0.
        row: usize,
        /// Its time, s.
        time_s: f64,
        /// End of the scenario, s.
        duration_s: f64,
    },
    /// Fewer samples than parameters.
    #[error(
        "{samples} usable readings cannot determine {parameters} parameters: record more, or fix some of them"
    )]
    TooFewSamples {
        /// Usable readings of all channels.
        samples: usize,
        /// Number of parameters.
        parameters: usize,
    },
    /// A channel without usable readings.
    #[error(
        "channel `{channel}` of `{experiment}` has no usable readings between {low} and {high} (K or Pa): leave it out"
    )]
    NoReadings {
        /// Source of the experiment.
        experiment: String,
        /// Name of the channel.
        channel: String,
        /// Lowest plausible reading.
        low: f64,
        /// Highest plausible reading.
        high: f64,
    },
    /// A channel that always reads the same.
    #[error(
        "channel `{channel}` of `{experiment}` reads {value} (K or Pa) throughout: the sensor is stuck, leave it out"
    )]
    ConstantChannel {
        /// Source of the experiment.
        experiment: String,
        /// Name of the channel.
        channel: String,
        /// The reading, K or Pa.
        value: f64,
    },
    /// Nothing moves in any log.
    #[error(
        "no channel moves by more than {ratio:.1} times its noise: record a change of the ambient by tens of kelvin, a \
         filling or a discharge"
    )]
    NoExcitation {
        /// Largest spread of a channel over the standard deviation of its noise.
        ratio: f64,
    },
    /// A parameter that changes no reading.
    #[error("`{parameter}` changes no reading: fix it, or add a sensor or an experiment that it acts on")]
    NoInfluence {
        /// Its name.
        parameter: String,
    },
    /// A combination that the logs do not determine.
    #[error(
        "the logs determine `{combination}` to ± {deviation:.3} only: give one of these parameters a prior, fix it, or \
         record an experiment that tells them apart"
    )]
    Undetermined {
        /// The combination.
        combination: String,
        /// Its standard deviation in the parameters' usual widths.
        deviation: f64,
    },
    /// A parameter that runs to a bound.
    #[error(
        "`{parameter}` runs to its bound {bound}: look for what else the log holds (a parameter that is fixed, a wrong \
         scenario), or move the bound"
    )]
    AtBound {
        /// Its name.
        parameter: String,
        /// The bound, in the parameter's unit.
        bound: f64,
    },
    /// A log that the vessel cannot have made.
    #[error(
        "channel `{channel}` of `{experiment}` deviates by {deviation:.4} (K or Pa) from the calibrated model, as much as it \
         moves ({spread:.4}): the log is not of this vessel and scenario, or a channel is mapped wrongly"
    )]
    Misfit {
        /// Source of the experiment.
        experiment: String,
        /// Name of the channel.
        channel: String,
        /// Root mean square of its residuals, K or Pa.
        deviation: f64,
        /// Standard deviation of its readings, K or Pa.
        spread: f64,
    },
    /// The search did not end.
    #[error(
        "no minimum after {iterations} steps, the last one of {step:.3} standard deviations: begin nearer to it, \
         add priors, or look whether the log is of this vessel and scenario"
    )]
    NotConverged {
        /// Steps.
        iterations: usize,
        /// Length of the last step in standard deviations of the estimate.
        step: f64,
    },
    /// The search did not end, and the solver is coarser than usual.
    #[error(
        "no minimum after {iterations} steps, the last one of {step:.3} standard deviations: with a relative tolerance of \
         {relative_tolerance:e} the solver's error hides it: take {usual:e}"
    )]
    SolverTooCoarse {
        /// Steps.
        iterations: usize,
        /// Length of the last step in standard deviations of the estimate.
        step: f64,
        /// Relative tolerance of the solver.
        relative_tolerance: f64,
        /// The usual one.
        usual: f64,
    },
    /// A fit that failed, and what a leak would explain of it.
    #[error(
        "{failed}; the readings of `{experiment}` look like a leak of about {rate_g_h:.2} g/h: does it leak?"
    )]
    Leaking {
        /// What failed.
        failed: Box<CalibrateError>,
        /// Source of the experiment.
        experiment: String,
        /// Mass flow out, g/h.
        rate_g_h: f64,
    },
    /// The start, or a difference beside it, cannot be simulated.
    #[error("`{experiment}` cannot be simulated with the parameters given: {source}")]
    Simulation {
        /// Source of the experiment.
        experiment: String,
        /// What the simulation says.
        source: Box<crate::EstimatorError>,
    },
    /// The caller wanted the calibration to end.
    #[error("the calibration was stopped")]
    Stopped,
    /// A part to hold out that leaves nothing to fit or to score.
    #[error("holding out {what} leaves nothing to {purpose}: hold out another part")]
    HoldOut {
        /// What is held out.
        what: String,
        /// `fit` or `score`.
        purpose: &'static str,
    },
    /// A parameter that is not there.
    #[error("there is no parameter {index}: there are {parameters}, counted from 0")]
    ParameterUnknown {
        /// As asked.
        index: usize,
        /// Number of parameters.
        parameters: usize,
    },
}

impl CalibrateError {
    /// The same, with the leak that would explain it, where there is one.
    pub(super) fn with_leak(self, leaks: impl FnOnce() -> Result<Vec<ApparentLeak>, Self>) -> Self {
        let largest =
            |leaks: Vec<ApparentLeak>| leaks.into_iter().max_by(|a, b| a.rate_kg_s.total_cmp(&b.rate_kg_s));
        match leaks().ok().and_then(largest) {
            Some(ApparentLeak { experiment, rate_kg_s, .. }) => {
                Self::Leaking { failed: Box::new(self), experiment, rate_g_h: 1e3 * HOUR_S * rate_kg_s }
            }
            None => self,
        }
    }
}
