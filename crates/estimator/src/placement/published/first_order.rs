//! First-order lag of a record by the least output error, for any time constant.
//!
//! `T' = (g u - T)/tau`, exact for readings that are straight in between, the state at the start fitted. Gain and start are linear, so that the
//! errors' squares depend on `tau` alone, which is scanned and then narrowed by golden section. It is the minimum that
//! [`crate::identify::identify`] finds by output error, but where the data do not determine a lag there is still one, and its limit
//! `tau = 0` is that of a reading that does not lead the gas.
use std::convert::Infallible;

use crate::identify::IdentifyError;
use crate::identify::published::TransferFunction;
use crate::minimum::golden_section;

/// Estimated: gain, time constant, start.
const PARAMETERS: usize = 3;
/// Shortest time constant above zero that is tried, sampling intervals.
const SHORTEST: f64 = 0.1;
/// Time constants that are tried first grow by this factor.
const STEP: f64 = 1.6;
/// Width of the logarithm of the time constant at which it ends.
const BRACKET_WIDTH: f64 = 1e-5;

/// Readings with the mean gas temperature, none missing.
#[derive(Clone, Debug, Default)]
pub(super) struct Record {
    time_s: Vec<f64>,
    reading_degc: Vec<f64>,
    gas_degc: Vec<f64>,
}

/// A lag of first order from a reading to the gas, in °C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FirstOrder {
    pub gain: f64,
    /// Zero: none.
    pub time_constant_s: f64,
}

/// Sums over a record of products of the gas, `y`, the answer to the reading with gain one from zero, `f`, and what is left of a
/// start at one, `d`.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    yy: f64,
    yf: f64,
    yd: f64,
    ff: f64,
    fd: f64,
    dd: f64,
}

impl Moments {
    /// Gain that leaves least, the start fitted.
    fn gain(&self) -> f64 {
        let moved = self.ff - self.fd * self.fd / self.dd;
        if moved > 0.0 { (self.yf - self.fd * self.yd / self.dd) / moved } else { 0.0 }
    }

    /// Start that leaves least with a gain.
    fn start(&self, gain: f64) -> f64 {
        (self.yd - gain * self.fd) / self.dd
    }

    /// Sum of the errors' squares with gain and start fitted.
    fn left(&self) -> f64 {
        let gain = self.gain();
        self.yy - gain * self.yf - self.start(gain) * self.yd
    }
}

impl Record {
    /// Of columns in K; lost readings are NaN and left out.
    pub(super) fn new(
        time_s: &[f64],
        reading_k: impl Iterator<Item = f64>,
        gas_k: &[f64],
        zero_k: f64,
    ) -> Self {
        let mut record = Self::default();
        for ((time_s, reading_k), gas_k) in time_s.iter().zip(reading_k).zip(gas_k) {
            if reading_k.is_finite() {
                record.time_s.push(*time_s);
                record.reading_degc.push(reading_k - zero_k);
                record.gas_degc.push(gas_k - zero_k);
            }
        }
        record
    }

    /// With another behind it, from a time after its last sample on.
    pub(super) fn then(&self, other: &Self, gap_s: f64) -> Self {
        let mut joined = self.clone();
        let shift_s = self.time_s.last().map_or(0.0, |end_s| end_s + gap_s);
        joined.time_s.extend(other.time_s.iter().map(|time_s| time_s + shift_s));
        joined.reading_degc.extend(&other.reading_degc);
        joined.gas_degc.extend(&other.gas_degc);
        joined
    }

    /// Mean gas temperature, °C.
    pub(super) fn gas_degc(&self) -> &[f64] {
        &self.gas_degc
    }

    /// The lag that leaves least.
    ///
    /// # Errors
    /// Too few readings.
    pub(super) fn first_order(&self) -> Result<FirstOrder, IdentifyError> {
        let samples = self.time_s.len();
        if samples <= PARAMETERS + 1 {
            return Err(IdentifyError::TooFewSamples { samples, parameters: PARAMETERS });
        }
        let duration_s = self.time_s[samples - 1] - self.time_s[0];
        let shortest = (SHORTEST * duration_s / (samples - 1) as f64).ln();
        let left = |logarithm: f64| self.moments(logarithm.exp()).left();
        let tried = ((duration_s.ln() - shortest) / STEP.ln()).ceil() as usize;
        let at = |number: usize| shortest + number as f64 * STEP.ln();
        let by_left = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
        let best = (0..=tried).map(|number| (number, left(at(number)))).min_by(by_left);
        let nearest = at(best.map_or(0, |(number, _)| number));
        let around = (nearest - STEP.ln(), nearest + STEP.ln());
        let Ok(narrowed) =
            golden_section(around, BRACKET_WIDTH, |logarithm| Ok::<_, Infallible>(left(logarithm)));
        let narrowed = narrowed.exp();
        let without = self.moments(0.0).left() <= self.moments(narrowed).left();
        let time_constant_s = if without { 0.0 } else { narrowed };
        Ok(FirstOrder { gain: self.moments(time_constant_s).gain(), time_constant_s })
    }

    /// Errors of a lag, gas less model, K, its start fitted.
    pub(super) fn errors_k(&self, lag: FirstOrder) -> Vec<f64> {
        let start = self.moments(lag.time_constant_s).start(lag.gain);
        self.answers(lag.time_constant_s)
            .map(|(gas_degc, answer, decay)| gas_degc - lag.gain * answer - start * decay)
            .collect()
    }

    fn moments(&self, time_constant_s: f64) -> Moments {
        self.answers(time_constant_s).fold(Moments::default(), |sum, (y, f, d)| Moments {
            yy: sum.yy + y * y,
            yf: sum.yf + y * f,
            yd: sum.yd + y * d,
            ff: sum.ff + f * f,
            fd: sum.fd + f * d,
            dd: sum.dd + d * d,
        })
    }

    /// Gas, answer from zero with gain one, and what is left of a start at one, sample by sample.
    fn answers(&self, time_constant_s: f64) -> impl Iterator<Item = (f64, f64, f64)> {
        // No lag is a pole at infinity, where the steps of the filter have their limits.
        let pole_per_s = 1.0 / time_constant_s;
        let mut driven = TransferFunction::new(1.0, pole_per_s).starting_at(0.0);
        let mut decaying = TransferFunction::new(0.0, pole_per_s).starting_at(1.0);
        self.time_s.iter().zip(&self.reading_degc).zip(&self.gas_degc).map(
            move |((time_s, reading_degc), gas_degc)| {
                (*gas_degc, driven.step(*time_s, *reading_degc), decaying.step(*time_s, 0.0))
            },
        )
    }
}
