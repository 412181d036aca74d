//! The threshold of a change whose course in the residuals is known but not its onset.
//!
//! A leak drives the innovations of a filter like a ramp that levels off. Its test is a maximum over onsets within a window, and
//! what it needs of the signature's information follows from the rate of false alarms of that maximum ([`GlrChart`]).
use super::GlrChart;
use crate::DetectorError;
use crate::error::positive;
use crate::statistic::{Noise, Shape, Side};

/// Threshold of the best statistic for a one-sided ramp of unknown onset in white residuals, in its standard deviations.
///
/// `b = sqrt(2 l)` with the threshold `l` of the log-likelihood ratio over onsets within `within_s`, s, sampled every
/// `interval_s`, s, that gives one false alarm in `between_alarms_s`, s, on average.
///
/// # Errors
/// A time is not positive and finite, or no threshold gives so short or long a time between alarms.
///
/// # Validity
/// As [`GlrChart::arl`]; a signature that levels off has rather fewer independent onsets than a ramp.
pub fn signature_threshold_sd(
    within_s: f64,
    interval_s: f64,
    between_alarms_s: f64,
) -> Result<f64, DetectorError> {
    positive("within_s", within_s)?;
    positive("interval_s", interval_s)?;
    positive("between_alarms_s", between_alarms_s)?;
    let chart = GlrChart {
        shape: Shape::Ramp,
        side: Side::Above,
        noise: Noise::white(1.0),
        interval_s,
        window: (within_s / interval_s).round().max(1.0) as usize,
        threshold: 0.0,
    };
    let chart = chart.for_arl(between_alarms_s / interval_s)?;
    Ok((2.0 * chart.threshold).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAY_S: f64 = 86_400.0;
    const YEAR_S: f64 = 365.25 * DAY_S;

    #[test]
    fn a_day_of_minutes_at_one_alarm_in_ten_years_takes_between_five_and_six_deviations() {
        let threshold = signature_threshold_sd(DAY_S, 60.0, 10.0 * YEAR_S).unwrap();
        assert!((5.0..6.2).contains(&threshold), "{threshold}");
    }

    #[test]
    fn rarer_alarms_and_more_samples_take_a_higher_threshold() {
        let of = |interval_s, years: f64| signature_threshold_sd(DAY_S, interval_s, years * YEAR_S).unwrap();
        assert!(of(60.0, 1.0) < of(60.0, 10.0) && of(60.0, 10.0) < of(60.0, 100.0));
        assert!(of(600.0, 10.0) < of(60.0, 10.0));
    }

    #[test]
    fn times_that_are_none_are_refused_by_name() {
        for (times, name) in [
            ((0.0, 60.0, YEAR_S), "within_s"),
            ((DAY_S, f64::NAN, YEAR_S), "interval_s"),
            ((DAY_S, 60.0, -1.0), "between_alarms_s"),
        ] {
            let message = signature_threshold_sd(times.0, times.1, times.2).unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
    }
}
