//! Piecewise linear functions of time with exact jumps.
//!
//! Two knots at the same time are a jump: the first value holds up to it, the second from it on.
//! Before the first and after the last knot the value is constant. [`Series::segment`] gives the linear
//! piece that belongs to an interval between edges, so that an integrator that stops at every edge never
//! sees a mixture of the two sides.
use crate::ThermalError;

/// A piecewise linear function of time, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    time_s: Vec<f64>,
    value: Vec<f64>,
}

/// The linear piece `value + slope (t - start)` of a [`Series`] on one interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearPiece {
    /// Start of the interval, s.
    pub start_s: f64,
    /// Value at the start, approached from inside the interval.
    pub value: f64,
    /// Change per second.
    pub(crate) slope_per_s: f64,
}

impl LinearPiece {
    /// Value at time `t_s`, s.
    pub fn at(&self, t_s: f64) -> f64 {
        self.value + self.slope_per_s * (t_s - self.start_s)
    }
}

impl Series {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self { time_s: vec![0.0], value: vec![value] }
    }

    /// Knots with times that do not decrease, at most two at the same time.
    ///
    /// # Errors
    /// No knot, lengths that differ, a value that is not finite, a time that goes back, three knots at one time.
    pub fn try_new(time_s: Vec<f64>, value: Vec<f64>) -> Result<Self, ThermalError> {
        if time_s.is_empty() || time_s.len() != value.len() {
            return Err(ThermalError::SeriesLengths { times: time_s.len(), values: value.len() });
        }
        for (row, (&t, &v)) in time_s.iter().zip(&value).enumerate() {
            if !t.is_finite() || !v.is_finite() {
                return Err(ThermalError::SeriesNotFinite { row: row + 1 });
            }
            if row > 0 && t < time_s[row - 1] {
                return Err(ThermalError::SeriesGoesBack {
                    row: row + 1,
                    time_s: t,
                    previous_s: time_s[row - 1],
                });
            }
            if row > 1 && t == time_s[row - 2] {
                return Err(ThermalError::SeriesTripleTime { row: row + 1, time_s: t });
            }
        }
        Ok(Self { time_s, value })
    }

    /// Every value as `by` changes it.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn mapped(&self, by: impl Fn(f64) -> f64) -> Result<Self, ThermalError> {
        Self::try_new(self.time_s.clone(), self.value.iter().map(|value| by(*value)).collect())
    }

    /// The function times a factor.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn scaled(&self, factor: f64) -> Result<Self, ThermalError> {
        self.mapped(|value| value * factor)
    }

    /// The function plus a constant.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn shifted(&self, by: f64) -> Result<Self, ThermalError> {
        self.mapped(|value| value + by)
    }

    /// Times at which the function jumps or changes its slope, s, increasing.
    pub fn edges_s(&self) -> impl Iterator<Item = f64> + '_ {
        let mut last = f64::NEG_INFINITY;
        self.time_s.iter().copied().filter(move |&t| {
            let new = t > last;
            last = t;
            new
        })
    }

    /// The linear piece on an interval `[from_s, to_s]` that contains no edge in its inside.
    pub fn segment(&self, from_s: f64, to_s: f64) -> LinearPiece {
        // The knot that ends the piece is the first one after the interval's middle.
        let middle = 0.5 * (from_s + to_s);
        let next = self.time_s.partition_point(|&t| t <= middle);
        let (value, slope_per_s) = match next {
            0 => (self.value[0], 0.0),
            n if n == self.time_s.len() => (self.value[n - 1], 0.0),
            n => {
                let (t0, t1) = (self.time_s[n - 1], self.time_s[n]);
                let slope = (self.value[n] - self.value[n - 1]) / (t1 - t0);
                (self.value[n - 1] + slope * (from_s - t0), slope)
            }
        };
        LinearPiece { start_s: from_s, value, slope_per_s }
    }

    /// Value at `t_s`, continued from the right at a jump.
    pub fn at(&self, t_s: f64) -> f64 {
        let next = self.time_s.partition_point(|&t| t <= t_s);
        match next {
            0 => self.value[0],
            n if n == self.time_s.len() => self.value[n - 1],
            n => {
                let weight = (t_s - self.time_s[n - 1]) / (self.time_s[n] - self.time_s[n - 1]);
                self.value[n - 1] + weight * (self.value[n] - self.value[n - 1])
            }
        }
    }

    /// Smallest and largest value.
    pub fn range(&self) -> (f64, f64) {
        self.value.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &v| (lo.min(v), hi.max(v)))
    }
}
