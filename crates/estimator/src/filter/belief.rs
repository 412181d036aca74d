//! Whether a restricted member of a bank can still be believed, by what it and a free one say of the same quantity.
//!
//! A member that allows little is the better estimate as long as it is right. Where its hypothesis does not hold it is wrong, and explains
//! the readings by something else. The freest member tells them apart: it is right either way, only less precise. With the means and
//! variances of one quantity by both, the statistic of Hausman (1978),
//!
//! `d^2 = (m_free - m)^2 / (P_free - P)`,
//!
//! is that of a standard normal number while the restricted member is right. Its odds, with prior odds for how rare the alternative is,
//!
//! `w / (1 - w) = prior / (1 - prior) exp(-d^2 / 2)`,
//!
//! weigh what both say: `x = w x_member + (1 - w) x_free`, `P = w P_member + (1 - w) P_free + w (1 - w) (x_member - x_free)^2`.
//! A member that is excluded begins anew from the freest one ([`Bank::replace`](super::Bank::replace)).
use cylwatch_thermal::real::powi;

/// Prior probability that a member is right.
const PRIOR_PROBABILITY: f64 = 0.9999;
/// `d^2` beyond which a member is excluded: five and a half standard deviations.
const EXCLUSION_THRESHOLD: f64 = 30.0;
/// Least variance of the difference relative to that of the free member.
const MIN_VARIANCE_RATIO: f64 = 0.25;

/// Mean and variance.
pub(crate) type Moments = (f64, f64);

/// Mean and variance of a mixture, weight `w` of the first part.
pub(crate) fn mixture(w: f64, one: Moments, other: Moments) -> Moments {
    let apart = one.0 - other.0;
    (other.0 + w * apart, w * one.1 + (1.0 - w) * other.1 + w * (1.0 - w) * apart * apart)
}

/// What a member and the freest one, by one quantity, say about the member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belief {
    square: f64,
}

impl Belief {
    /// By the moments of one quantity of a member and of the freest one.
    pub fn of(member: Moments, free: Moments) -> Self {
        let variance = (free.1 - member.1).max(MIN_VARIANCE_RATIO * free.1);
        Self { square: powi(free.0 - member.0, 2) / variance }
    }

    /// Probability that the member is right.
    pub(crate) fn weight(self) -> f64 {
        let odds = PRIOR_PROBABILITY / (1.0 - PRIOR_PROBABILITY) * libm::exp(-0.5 * self.square);
        odds / (1.0 + odds)
    }

    /// Whether it is beyond five and a half standard deviations.
    pub fn is_excluded(self) -> bool {
        self.square > EXCLUSION_THRESHOLD
    }

    /// Mixture of what both say of one quantity.
    pub(crate) fn blend(self, member: Moments, free: Moments) -> Moments {
        mixture(self.weight(), member, free)
    }

    /// The quantity itself as far as each of them is believed.
    pub(crate) fn blended(member: Moments, free: Moments) -> Moments {
        Self::of(member, free).blend(member, free)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn members_that_agree_leave_the_prior() {
        let belief = Belief::of((4.4, 1e-6), (4.4, 1e-5));
        assert_relative_eq!(belief.weight(), PRIOR_PROBABILITY, max_relative = 1e-12);
    }

    #[test]
    fn a_difference_of_five_standard_deviations_turns_the_odds() {
        let (slow, free): (Moments, Moments) = ((4.4, 1.9e-5), (4.4 + 0.009, 2.8e-5));
        // d is 3: exp(-4.5) times 9999 is 111.1.
        assert_relative_eq!(Belief::of(slow, free).weight(), 111.1 / 112.1, max_relative = 1e-4);
        // d is 4.5: exp(-10.125) times 9999 is 0.4006.
        let doubted = Belief::of(slow, (4.4 + 0.0135, 2.8e-5));
        assert_relative_eq!(doubted.weight(), 0.4006 / 1.4006, max_relative = 1e-3);
        assert!(!doubted.is_excluded());
        assert!(Belief::of(slow, (4.4 + 0.018, 2.8e-5)).is_excluded());
    }

    #[test]
    fn a_blend_lies_between_and_tells_their_difference() {
        let belief = Belief::of((4.4, 1.9e-5), (4.408, 2.8e-5));
        let (mean, variance) = belief.blend((280.0, 0.01), (281.0, 0.04));
        let w = belief.weight();
        assert_relative_eq!(mean, 281.0 - w, max_relative = 1e-12);
        // Law of total variance.
        let within = w * 0.01 + (1.0 - w) * 0.04;
        let between = w * (280.0 - mean).powi(2) + (1.0 - w) * (281.0 - mean).powi(2);
        assert_relative_eq!(variance, within + between, max_relative = 1e-12);
    }
}
