//! From free parameters to coefficients of the response, all in the record's units.
use nalgebra::DMatrix;

use super::problem::Units;
use super::{DeadTime, Gain, InitialState, Parameter, Structure};

/// Highest order.
pub(super) const HIGHEST: usize = 3;

/// Coefficients of `y = (b(s) U + c(s))/a(s) + offset`, ascending powers; `a` without its leading one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coefficients {
    pub order: usize,
    pub a: [f64; HIGHEST],
    pub b: [f64; HIGHEST],
    pub c: [f64; HIGHEST],
    pub offset: f64,
    pub dead_time: f64,
    /// Whether derivatives by the dead time are wanted.
    pub delay_free: bool,
    /// Whether the model is settled at the first input.
    pub settled: bool,
}

impl Coefficients {
    /// Positions in a row of derivatives by `a`, `b`, `c`, the offset and the dead time.
    pub(super) fn numerator_at(&self) -> usize {
        self.order
    }

    pub(super) fn initial_at(&self) -> usize {
        2 * self.order
    }

    pub(super) fn offset_at(&self) -> usize {
        3 * self.order
    }

    pub(super) fn dead_time_at(&self) -> usize {
        3 * self.order + 1
    }

    /// Length of a row of derivatives.
    pub(super) fn width(&self) -> usize {
        3 * self.order + 2
    }

    /// Whether all poles lie in the left half plane (Hurwitz).
    pub(super) fn is_stable(&self) -> bool {
        let a = &self.a[..self.order];
        a.iter().all(|a| *a > 0.0 && a.is_finite()) && (self.order < 3 || a[2] * a[1] > a[0])
    }
}

/// The structure in the record's units.
#[derive(Clone, Debug)]
pub(super) struct Parametrisation {
    pub structure: Structure,
    pub parameters: Vec<Parameter>,
}

impl Parametrisation {
    pub(super) fn new(structure: &Structure, units: &Units) -> Self {
        let mut scaled = structure.clone();
        if let Gain::Fixed(gain) = &mut scaled.gain {
            *gain *= units.input / units.output;
        }
        match &mut scaled.dead_time {
            DeadTime::None => {}
            DeadTime::Fixed(s) | DeadTime::Free(s) => *s /= units.time_s,
        }
        if let InitialState::Given(values) = &mut scaled.initial {
            let powers = (0..).map(|k| units.time_s.powi(k) / units.output);
            values.iter_mut().zip(powers).for_each(|(value, scale)| *value *= scale);
        }
        Self { parameters: scaled.parameters(), structure: scaled }
    }

    /// Unit of a parameter.
    pub(super) fn unit(&self, parameter: Parameter, units: &Units) -> f64 {
        let n = self.structure.order;
        let time = |power: usize| units.time_s.powi(-(power as i32));
        match parameter {
            Parameter::Denominator(i) => time(n - i),
            Parameter::Numerator(j) => units.output / units.input * time(n - j),
            Parameter::Initial(k) => units.output * time(k),
            Parameter::Offset => units.output,
            Parameter::DeadTime => units.time_s,
            Parameter::LogIntensity => 1.0,
        }
    }

    /// Coefficients of free parameters.
    pub(super) fn expand(&self, theta: &[f64]) -> Coefficients {
        let structure = &self.structure;
        let mut k = Coefficients {
            order: structure.order,
            a: [0.0; HIGHEST],
            b: [0.0; HIGHEST],
            c: [0.0; HIGHEST],
            offset: 0.0,
            dead_time: if let DeadTime::Fixed(time) = structure.dead_time { time } else { 0.0 },
            delay_free: matches!(structure.dead_time, DeadTime::Free(_)),
            settled: structure.initial == InitialState::Settled,
        };
        let mut initial = [0.0; HIGHEST];
        if let InitialState::Given(values) = &structure.initial {
            initial[..values.len()].copy_from_slice(values);
        }
        for (parameter, &value) in self.parameters.iter().zip(theta) {
            match *parameter {
                Parameter::Denominator(i) => k.a[i] = value,
                Parameter::Numerator(j) => k.b[j] = value,
                Parameter::Initial(i) => initial[i] = value,
                Parameter::Offset => k.offset = value,
                Parameter::DeadTime => k.dead_time = value,
                Parameter::LogIntensity => {}
            }
        }
        if let Gain::Fixed(gain) = structure.gain {
            k.b[0] = gain * k.a[0];
        }
        // c(s) = sum_k r^(k) (s^(n-1-k) + a_(n-1) s^(n-2-k) + ...): the Laplace transform of the free response r.
        for i in 0..k.order {
            k.c[i] = (0..k.order - i).map(|j| leading_one(&k, i + 1 + j) * initial[j]).sum();
        }
        k
    }

    /// Derivatives of the coefficients by the free parameters: (width, parameters).
    pub(super) fn jacobian(&self, theta: &[f64]) -> DMatrix<f64> {
        let k = self.expand(theta);
        let n = k.order;
        let mut jacobian = DMatrix::zeros(k.width(), self.parameters.len());
        let initial = self.initial(theta);
        for (column, parameter) in self.parameters.iter().enumerate() {
            let mut set = |row: usize, value: f64| jacobian[(row, column)] = value;
            match *parameter {
                Parameter::Denominator(i) => {
                    set(i, 1.0);
                    if let (0, Gain::Fixed(gain)) = (i, self.structure.gain) {
                        set(k.numerator_at(), gain);
                    }
                    for (j, value) in initial[..i].iter().enumerate() {
                        set(k.initial_at() + i - 1 - j, *value);
                    }
                }
                Parameter::Numerator(j) => set(k.numerator_at() + j, 1.0),
                Parameter::Initial(j) => {
                    for i in 0..n - j {
                        set(k.initial_at() + i, leading_one(&k, i + 1 + j));
                    }
                }
                Parameter::Offset => set(k.offset_at(), 1.0),
                Parameter::DeadTime => set(k.dead_time_at(), 1.0),
                Parameter::LogIntensity => {}
            }
        }
        jacobian
    }

    /// Free response and its derivatives at the start.
    fn initial(&self, theta: &[f64]) -> [f64; HIGHEST] {
        let mut initial = [0.0; HIGHEST];
        if let InitialState::Given(values) = &self.structure.initial {
            initial[..values.len()].copy_from_slice(values);
        }
        for (parameter, &value) in self.parameters.iter().zip(theta) {
            if let Parameter::Initial(i) = *parameter {
                initial[i] = value;
            }
        }
        initial
    }

    /// Position of a parameter.
    pub(super) fn position(&self, parameter: Parameter) -> Option<usize> {
        self.parameters.iter().position(|other| *other == parameter)
    }
}

/// Coefficient of `s^i` in the denominator, the leading one included.
fn leading_one(k: &Coefficients, i: usize) -> f64 {
    if i == k.order { 1.0 } else { k.a[i] }
}
