//! The threshold at which a run length has a wished value.
use crate::{DetectorError, error::positive};

/// Relative error of the run length at the threshold found.
const TOLERANCE: f64 = 1e-9;

/// The threshold between `low` and `high` at which `arl`, which grows with it, is `wished`.
///
/// Regula falsi in the logarithm of the run length, nearly linear in the threshold, with the Illinois correction.
pub(super) fn threshold_for(
    wished: f64,
    low: f64,
    high: f64,
    arl: impl Fn(f64) -> f64,
) -> Result<f64, DetectorError> {
    let target = positive("arl", wished)?.ln();
    let (mut below, mut above) = (low, low);
    let mut excess_below = arl(low).ln() - target;
    let shortest = excess_below;
    let mut excess_above = excess_below;
    // Outwards in steps that grow: solving far beyond the target would be ill-conditioned.
    let mut step = 0.05 * (high - low);
    while excess_above < 0.0 && above < high {
        (below, excess_below) = (above, excess_above);
        above = (above + step).min(high);
        excess_above = arl(above).ln() - target;
        step *= 1.3;
    }
    if excess_above < 0.0 || shortest > TOLERANCE {
        let (shortest, longest) = ((shortest + target).exp(), (excess_above + target).exp());
        return Err(DetectorError::OutOfReach { wished, low, high: above, shortest, longest });
    }
    let mut middle = above;
    for _ in 0..200 {
        if (excess_above - excess_below).abs() < TOLERANCE || above - below < 1e-13 * above.abs() {
            break;
        }
        middle = (below * excess_above - above * excess_below) / (excess_above - excess_below);
        let excess = arl(middle).ln() - target;
        if excess.abs() < TOLERANCE {
            break;
        }
        if excess > 0.0 {
            (above, excess_above) = (middle, excess);
            excess_below *= 0.5;
        } else {
            (below, excess_below) = (middle, excess);
            excess_above *= 0.5;
        }
    }
    Ok(middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_threshold_of_an_exponential_run_length_is_its_logarithm() {
        let found = threshold_for(1e6, 0.0, 100.0, |h| h.exp() + h).unwrap();
        assert_relative_eq!(found.exp() + found, 1e6, max_relative = 1e-8);
    }

    #[test]
    fn a_run_length_out_of_reach_is_named() {
        assert!(matches!(
            threshold_for(1e6, 0.0, 2.0, f64::exp),
            Err(DetectorError::OutOfReach { wished: 1e6, .. })
        ));
        assert!(threshold_for(0.5, 0.0, 2.0, f64::exp).is_err());
        assert!(threshold_for(f64::NAN, 0.0, 2.0, f64::exp).is_err());
    }
}
