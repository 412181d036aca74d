//! What is assumed of the model before the data are seen.
use serde::{Deserialize, Serialize};

use super::IdentifyError;

/// Dead time between input and output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DeadTime {
    /// None.
    #[default]
    None,
    /// Known, s; it need not be a multiple of the sampling interval.
    Fixed(f64),
    /// To be estimated, between zero and this, s.
    Free(f64),
}

/// Steady-state gain `b_0/a_0`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Gain {
    /// To be estimated.
    #[default]
    Free,
    /// Known, e.g. one where both columns are equal at rest.
    Fixed(f64),
}

/// State of the model at the first input sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InitialState {
    /// To be estimated.
    #[default]
    Estimated,
    /// At rest at zero: the output begins at its offset.
    Zero,
    /// Settled at the first input sample.
    Settled,
    /// The free response (what the output, less its offset, would do if the input were zero) and its time derivatives at
    /// the start: one value per order. For a first-order model this is the output itself.
    Given(Vec<f64>),
}

/// Structure of a continuous-time model
/// `y = e^(-s delta) (b_m s^m + ... + b_0)/(s^n + a_(n-1) s^(n-1) + ... + a_0) u + free response + offset`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// Order `n` of the denominator, 1 to 3.
    pub order: usize,
    /// Number of zeros `m`, below `n`.
    pub zeros: usize,
    /// Dead time `delta`. Before the record, the input had its first value.
    pub dead_time: DeadTime,
    /// Steady-state gain.
    pub gain: Gain,
    /// Whether a constant is added to the output.
    pub offset: bool,
    /// State at the first input sample.
    pub initial: InitialState,
}

impl Structure {
    /// A model with as many poles and zeros, a free gain, an estimated initial state, and nothing else.
    pub fn new(order: usize, zeros: usize) -> Self {
        Self {
            order,
            zeros,
            dead_time: DeadTime::None,
            gain: Gain::Free,
            offset: false,
            initial: InitialState::Estimated,
        }
    }

    /// The same with another state at the start.
    pub fn with_initial(self, initial: InitialState) -> Self {
        Self { initial, ..self }
    }

    /// The same with another dead time.
    pub fn with_dead_time(self, dead_time: DeadTime) -> Self {
        Self { dead_time, ..self }
    }

    /// The same with another gain.
    pub fn with_gain(self, gain: Gain) -> Self {
        Self { gain, ..self }
    }

    /// The same with a constant added to the output.
    pub fn with_offset(self) -> Self {
        Self { offset: true, ..self }
    }

    pub(super) fn validate(&self) -> Result<(), IdentifyError> {
        let within = |name, value: f64, ok: bool, bound| {
            if ok { Ok(()) } else { Err(IdentifyError::Setting { name, value, bound }) }
        };
        let n = self.order;
        within("order", n as f64, (1..=3).contains(&n), "1, 2 or 3")?;
        within("zeros", self.zeros as f64, self.zeros < n, "below the order")?;
        if let Gain::Fixed(gain) = self.gain {
            within("gain", gain, gain.is_finite() && gain != 0.0, "a number other than zero")?;
        }
        match self.dead_time {
            DeadTime::None => {}
            DeadTime::Fixed(s) => within("dead_time", s, s.is_finite() && s >= 0.0, "at least 0 s")?,
            DeadTime::Free(s) => within("dead_time", s, s.is_finite() && s > 0.0, "above 0 s")?,
        }
        if let InitialState::Given(values) = &self.initial {
            within("initial", values.len() as f64, values.len() == n, "one value per order")?;
            let odd = values.iter().copied().find(|value| !value.is_finite());
            within("initial", odd.unwrap_or(0.0), odd.is_none(), "finite")?;
        }
        Ok(())
    }

    /// Free parameters in the order in which everything here lists them.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        let mut free: Vec<Parameter> = (0..self.order).rev().map(Parameter::Denominator).collect();
        let fixed = usize::from(matches!(self.gain, Gain::Fixed(_)));
        free.extend((fixed..=self.zeros).rev().map(Parameter::Numerator));
        if self.initial == InitialState::Estimated {
            free.extend((0..self.order).map(Parameter::Initial));
        }
        if self.offset {
            free.push(Parameter::Offset);
        }
        if let DeadTime::Free(_) = self.dead_time {
            free.push(Parameter::DeadTime);
        }
        free
    }
}

/// A free parameter of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Coefficient of `s^i` in the denominator, s^(i - n).
    Denominator(usize),
    /// Coefficient of `s^j` in the numerator.
    Numerator(usize),
    /// Derivative `k` of the free response at the start.
    Initial(usize),
    /// Constant added to the output.
    Offset,
    /// Dead time, s.
    DeadTime,
    /// Natural logarithm of the intensity of the noise that drives the input's course (maximum likelihood).
    LogIntensity,
}

impl std::fmt::Display for Parameter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Denominator(i) => write!(f, "denominator coefficient of s^{i}"),
            Self::Numerator(j) => write!(f, "numerator coefficient of s^{j}"),
            Self::Initial(k) => write!(f, "derivative {k} of the free response at the start"),
            Self::Offset => write!(f, "output offset"),
            Self::DeadTime => write!(f, "dead time"),
            Self::LogIntensity => write!(f, "logarithm of the input's intensity"),
        }
    }
}
