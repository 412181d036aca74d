//! Whether the channels are what they are said to be: none late, and the two thermometers not in each other's place.
//!
//! Beside the observer a twin of it (the first member alone) takes the same rows with the two thermometers exchanged. The one that has
//! them in the right places expects the readings better. What is compared is
//!
//! `g = sum_i mean [ln(nu_i^2 + sigma_i^2) of the twin - the same of the observer]`
//!
//! over the three sensors `i`, with innovations `nu` and the sensors' noise `sigma`. It weighs a spike no more than any other row, and does not
//! rest on the variances that the observer states: the likelihood does, and is wrong for one cylinder in fifty (a slow valve). Exchanged thermometers are its negative. Above
//! 0.2 they are believed to be in their places, below -0.2 to be exchanged, if the pressure's part of it is below -0.1 and the thermometers do not speak against it: a valve that
//! is not the model's speaks for an exchange, too, but only an exchange makes the gas another one.
//!
//! Of 36 cylinders of six kinds in six climates (2.5 days each) nobody was taken for exchanged, and of the same with exchanged thermometers 25 of the 30 were found that did not stand in a workshop, where nothing
//! moves. Of six thin tanks none was found either way: what the sun does to one end of them decides.
//!
//! Late channels would mislead it, so those are looked for first ([`super::lateness`]). Both are judged from a day on, as soon as
//! there is enough to tell, and left alone after a week. What is found is put right, and the observer begins again.
use serde::{Deserialize, Serialize};

use super::lateness::LagMeter;
use crate::DetectorError;
use crate::estimator::observer::Innovation;

/// Time from which it is judged, and after which it is left alone, s.
const JUDGED_S: f64 = 86_400.0;
const GIVEN_UP_S: f64 = 7.0 * 86_400.0;
/// Difference that is believed, and the fewest rows that it may rest on.
const BELIEVED: f64 = 0.2;
/// Part of it that the pressure must bear out.
const BY_PRESSURE: f64 = 0.1;
const FEWEST: f64 = 200.0;

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::monitor) enum Finding {
    /// Too early to say.
    Open,
    /// The two thermometers and the pressure are so late, s, against the earliest.
    Late([f64; 3]),
    /// The thermometers have each other's place.
    Swapped,
    /// Nothing is wrong, or nothing can be told.
    Sound,
}

/// Learns how the channels are wired.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct WiringCheck {
    begun_s: Option<f64>,
    lags: Option<LagMeter>,
    differences: [f64; 3],
    rows: [f64; 3],
}

impl WiringCheck {
    /// Checks one that was saved.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        self.lags.as_ref().map_or(Ok(()), LagMeter::validate)
    }

    /// A check of everything.
    pub(crate) fn of_all() -> Self {
        Self { lags: Some(LagMeter::default()), ..Self::default() }
    }

    /// Take in the readings of two thermometers, in errors of a surface temperature, and the pressure, Pa.
    pub(crate) fn read(&mut self, time_s: f64, readings: [f64; 3]) {
        self.begun_s.get_or_insert(time_s);
        if let Some(meter) = &mut self.lags {
            meter.push(time_s, readings);
        }
    }

    /// Take in what the observer and its twin made of the same row, of sensors with such a noise, variances in K² and Pa².
    pub(crate) fn compare(&mut self, observer: [Innovation; 3], twin: [Innovation; 3], noise: [f64; 3]) {
        for i in 0..3 {
            let [own, other] = [observer[i], twin[i]].map(|of| libm::log(of.nu * of.nu + noise[i]));
            if own.is_finite() && other.is_finite() {
                self.differences[i] += other - own;
                self.rows[i] += 1.0;
            }
        }
    }

    /// The twin has begun anew.
    pub(crate) fn forget_twin(&mut self) {
        (self.differences, self.rows) = ([0.0; 3], [0.0; 3]);
    }

    /// What is known at a time, s. What was found is not found again.
    pub(crate) fn judge(&mut self, time_s: f64) -> Finding {
        let Some(begun_s) = self.begun_s.filter(|begun_s| time_s - begun_s >= JUDGED_S) else {
            return Finding::Open;
        };
        let tired = time_s - begun_s > GIVEN_UP_S;
        if let Some(meter) = &self.lags {
            let Some(late_s) = meter.late_s() else {
                return if tired { Finding::Sound } else { Finding::Open };
            };
            self.lags = None;
            if late_s != [0.0; 3] {
                // The comparison begins anew.
                *self = Self::default();
                return Finding::Late(late_s);
            }
        }
        match self.difference() {
            Some((all, by_pressure))
                if all < -BELIEVED && by_pressure < -BY_PRESSURE && all < by_pressure =>
            {
                Finding::Swapped
            }
            Some((difference, _)) if difference > BELIEVED => Finding::Sound,
            _ if tired => Finding::Sound,
            _ => Finding::Open,
        }
    }

    /// The number that is compared, and the pressure's part of it.
    fn difference(&self) -> Option<(f64, f64)> {
        let enough = self.rows.iter().all(|rows| *rows >= FEWEST);
        let means = [0, 1, 2].map(|i| self.differences[i] / self.rows[i]);
        enough.then(|| (means.iter().sum(), means[2]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::observer::Outcome;

    const NOISE: [f64; 3] = [0.05 * 0.05, 0.05 * 0.05, 1e3 * 1e3];

    fn innovation(nu: f64) -> Innovation {
        Innovation { nu, s: 1.0, outcome: Outcome::Accepted }
    }

    fn compared(own: f64, other: f64, rows: usize) -> WiringCheck {
        let mut check = WiringCheck::default();
        check.read(0.0, [280.0, 280.0, 180e5]);
        for n in 0..rows {
            // A spike once in a while, in both.
            let spike = if n % 50 == 0 { 40.0 } else { 0.0 };
            let of = |nu: f64| [innovation(nu + spike), innovation(nu), innovation(1e4 * nu)];
            check.compare(of(own), of(other), NOISE);
        }
        check
    }

    #[test]
    fn the_better_of_the_two_is_believed_after_a_day() {
        assert_eq!(compared(0.2, 0.3, 1440).judge(JUDGED_S - 1.0), Finding::Open);
        assert_eq!(compared(0.2, 0.3, 1440).judge(JUDGED_S), Finding::Sound);
        assert_eq!(compared(0.3, 0.2, 1440).judge(JUDGED_S), Finding::Swapped);
        assert_eq!(compared(0.3, 0.2, 100).judge(JUDGED_S), Finding::Open, "too few rows");
        assert_eq!(compared(0.2, 0.2, 1440).judge(JUDGED_S), Finding::Open);
        assert_eq!(compared(0.2, 0.2, 1440).judge(GIVEN_UP_S + 1.0), Finding::Sound);
        let mut blind = compared(0.3, 0.2, 1440);
        blind.compare([innovation(f64::NAN); 3], [innovation(0.2); 3], NOISE);
        assert_eq!(blind.judge(JUDGED_S), Finding::Swapped, "a row without a reading counts for nothing");
        let mut by_thermometers = WiringCheck::default();
        by_thermometers.read(0.0, [280.0, 280.0, 180e5]);
        for _ in 0..1440 {
            let of = |nu: f64| [innovation(nu), innovation(nu), innovation(2e3)];
            by_thermometers.compare(of(0.3), of(0.2), NOISE);
        }
        assert_eq!(by_thermometers.judge(JUDGED_S), Finding::Open, "the pressure does not bear it out");
        let mut against = compared(0.2, 0.2, 1440);
        for _ in 0..1440 {
            against.compare([0.2, 0.2, 0.3e4].map(innovation), [0.21, 0.21, 0.2e4].map(innovation), NOISE);
        }
        assert_eq!(against.judge(JUDGED_S), Finding::Open, "the thermometers speak against it");
        blind.forget_twin();
        assert_eq!(blind.judge(JUDGED_S), Finding::Open);
    }

    #[test]
    fn nothing_is_compared_as_long_as_a_channel_may_be_late() {
        let mut check = WiringCheck { lags: Some(LagMeter::default()), ..compared(0.3, 0.2, 1440) };
        assert_eq!(check.judge(JUDGED_S), Finding::Open);
        assert_eq!(check.judge(GIVEN_UP_S + 1.0), Finding::Sound);
    }
}
