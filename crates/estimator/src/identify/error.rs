//! Why nothing could be identified, and what data would be needed.
use super::Parameter;

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IdentifyError {
    /// A column is not as long as the times.
    #[error("{column} has {length} values for {times} times: give one value, or NaN, for each time")]
    Length {
        /// Name of the column.
        column: &'static str,
        /// Its length.
        length: usize,
        /// Number of times.
        times: usize,
    },
    /// Times that do not increase.
    #[error("time {time_s} s in row {row} must be finite and later than {before_s} s before it")]
    TimeOrder {
        /// Row, from 0.
        row: usize,
        /// Its time, s.
        time_s: f64,
        /// The time before it, s.
        before_s: f64,
    },
    /// A value is infinite.
    #[error("{column} is infinite in row {row}: give a number, or NaN for a missing value")]
    Infinite {
        /// Name of the column.
        column: &'static str,
        /// Row, from 0.
        row: usize,
    },
    /// A structure or setting out of its bounds.
    #[error("`{name}` = {value} must be {bound}")]
    Setting {
        /// Name of the field.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// A method that cannot treat a structure.
    #[error("{method} does not know {what}: {remedy}")]
    Unsupported {
        /// Name of the method.
        method: &'static str,
        /// Part of the structure.
        what: &'static str,
        /// What to do instead.
        remedy: &'static str,
    },
    /// Fewer samples than parameters.
    #[error("{samples} usable output samples cannot determine {parameters} parameters: give at least {}", .parameters + 2)]
    TooFewSamples {
        /// Output samples within the input's record.
        samples: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// A column that never changes.
    #[error(
        "{column} is constant at {value}: nothing can be learnt without a step, a ramp or another change of the input"
    )]
    Constant {
        /// Name of the column.
        column: &'static str,
        /// Its value.
        value: f64,
    },
    /// A hole in the input that cannot be bridged.
    #[error(
        "the input is missing from {from_s} s to {to_s} s, longer than {limit_s:.1} s: identify the parts before and after it \
         on their own, or allow a longer gap"
    )]
    Gap {
        /// Last sample before the gap, s.
        from_s: f64,
        /// First sample after it, s.
        to_s: f64,
        /// Longest gap allowed, s.
        limit_s: f64,
    },
    /// A parameter that the data do not determine.
    #[error(
        "{parameter} = {value:.4e} has a standard deviation of {sd:.1e}, so that its 95 % interval includes zero: \
         excite the input more, record longer, or lower the order"
    )]
    NotDetermined {
        /// Which one.
        parameter: Parameter,
        /// Its value.
        value: f64,
        /// Its standard deviation; infinite if nothing is known.
        sd: f64,
    },
    /// A pole that the data do not determine.
    #[error(
        "the real part {real_per_s:.4e} 1/s of a pole has a standard deviation of {sd_per_s:.1e} 1/s, so that its 95 % interval includes \
         zero: excite the input more, record longer, or lower the order"
    )]
    PoleNotDetermined {
        /// Real part, 1/s.
        real_per_s: f64,
        /// Its standard deviation, 1/s.
        sd_per_s: f64,
    },
    /// The output comes before the input.
    #[error(
        "the input follows from the output (fit {backward_percent:.1} %) rather than the output from the input \
         (fit {forward_percent:.1} %): swap the columns, or correct their times"
    )]
    Acausal {
        /// Fit of the model that was asked for, %.
        forward_percent: f64,
        /// Fit of the model from output to input, %.
        backward_percent: f64,
    },
    /// A pole too fast for the samples.
    #[error(
        "a pole of {pole_per_s:.3e} 1/s is beyond the {bound_per_s:.3e} 1/s that the samples can show: sample faster, or lower the order"
    )]
    PoleTooFast {
        /// Largest pole by size, 1/s.
        pole_per_s: f64,
        /// Bound, 1/s.
        bound_per_s: f64,
    },
    /// A pole too slow for the record.
    #[error(
        "a pole of {pole_per_s:.3e} 1/s is below the {bound_per_s:.3e} 1/s that the record can show: record longer, or lower the order"
    )]
    PoleTooSlow {
        /// Smallest pole by size, 1/s.
        pole_per_s: f64,
        /// Bound, 1/s.
        bound_per_s: f64,
    },
    /// A dead time that ran to an end of its range.
    #[error("the dead time ran to the end {dead_time_s} s of its range 0 to {longest_s} s: {}", dead_time_remedy(.dead_time_s))]
    DeadTimeAtBound {
        /// Dead time, s.
        dead_time_s: f64,
        /// Longest dead time asked for, s.
        longest_s: f64,
    },
    /// The iteration did not settle.
    #[error(
        "{method} did not settle in {iterations} iterations (last relative step {step:.1e}): start from output error, \
         lower the order, or give more excited data"
    )]
    NotConverged {
        /// Name of the method.
        method: &'static str,
        /// Iterations done.
        iterations: usize,
        /// Largest relative change of the last one.
        step: f64,
    },
    /// Known variances that are more than what the data hold.
    #[error(
        "the stated noise variances leave nothing of the data's own variation: state smaller ones, or excite the input more"
    )]
    VarianceTooLarge,
    /// The caller wanted the identification to end.
    #[error("the identification was stopped")]
    Stopped,
}

fn dead_time_remedy(dead_time_s: &f64) -> &'static str {
    if *dead_time_s > 0.0 { "allow a longer one" } else { "identify without dead time" }
}
