//! A continuous-time transfer function.
use nalgebra::{Complex, DMatrix};
use serde::{Deserialize, Serialize};

use super::data::check_column;
use super::parametrisation::Parametrisation;
use super::problem::{Problem, Units};
use super::response::respond;
use super::schedule::Schedule;
use super::{Data, DeadTime, Gain, Hold, IdentifyError, InitialState, Parameter, Structure};

/// `y = e^(-s delta) num(s)/den(s) u + offset`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Coefficients of the numerator, highest power first; time in s.
    pub num: Vec<f64>,
    /// Coefficients of the denominator, highest power first; the first is one.
    pub den: Vec<f64>,
    /// Dead time `delta`, s.
    pub dead_time_s: f64,
    /// Constant added to the output.
    pub offset: f64,
}

impl Model {
    /// Order of the denominator.
    pub fn order(&self) -> usize {
        self.den.len().saturating_sub(1)
    }

    /// Steady-state gain.
    pub fn gain(&self) -> f64 {
        self.num.last().copied().unwrap_or(0.0) / self.den.last().copied().unwrap_or(f64::NAN)
    }

    /// Poles, 1/s, slowest first.
    pub(crate) fn poles_per_s(&self) -> Vec<Complex<f64>> {
        poles(&self.den[1..].iter().rev().copied().collect::<Vec<_>>())
    }

    /// Output at the times `time_s`, s, of the input samples, starting in the given state.
    ///
    /// # Errors
    /// The model is no stable one of order 1 to 3, columns are unusable, or the state is to be estimated.
    pub fn simulate(
        &self,
        time_s: &[f64],
        input: &[f64],
        hold: Hold,
        initial: &InitialState,
    ) -> Result<Vec<f64>, IdentifyError> {
        if *initial == InitialState::Estimated {
            return Err(IdentifyError::Unsupported {
                method: "a simulation",
                what: "an estimated initial state",
                remedy: "give it, or compare the model with data",
            });
        }
        let data = Data::try_new(time_s.to_vec(), input.to_vec(), vec![0.0; time_s.len()], hold)?;
        check_finite(data.input())?;
        let problem = problem(&data);
        let (parametrisation, theta) = self.parameters(initial.clone(), &problem.units)?;
        let schedule = Schedule::new(&problem, self.dead_time_s / problem.units.time_s);
        Ok(respond(&problem, &schedule, &problem.u, &parametrisation.expand(&theta)).y)
    }

    /// The model as parameters in the units of a record.
    pub(super) fn parameters(
        &self,
        initial: InitialState,
        units: &Units,
    ) -> Result<(Parametrisation, Vec<f64>), IdentifyError> {
        let structure = Structure {
            order: self.order(),
            zeros: self.num.len().saturating_sub(1),
            dead_time: DeadTime::Fixed(self.dead_time_s),
            gain: Gain::Free,
            offset: true,
            initial,
        };
        structure.validate()?;
        let parametrisation = Parametrisation::new(&structure, units);
        let value = |parameter: &Parameter| match *parameter {
            Parameter::Denominator(i) => self.den[self.order() - i],
            Parameter::Numerator(j) => self.num[self.num.len() - 1 - j],
            Parameter::Offset => self.offset,
            _ => 0.0,
        };
        let theta: Vec<f64> = parametrisation
            .parameters
            .iter()
            .map(|parameter| value(parameter) / parametrisation.unit(*parameter, units))
            .collect();
        let stable = parametrisation.expand(&theta).is_stable();
        let leading = self.den[0];
        if !stable || leading != 1.0 {
            let (name, value, bound) = if stable {
                ("den", leading, "1 in its first coefficient")
            } else {
                ("pole", self.poles_per_s()[0].re, "in the left half plane")
            };
            return Err(IdentifyError::Setting { name, value, bound });
        }
        Ok((parametrisation, theta))
    }
}

fn check_finite(input: &[f64]) -> Result<(), IdentifyError> {
    check_column("the input", input, input.len())?;
    match input.iter().position(|value| value.is_nan()) {
        Some(row) => Err(IdentifyError::Infinite { column: "the input", row }),
        None => Ok(()),
    }
}

/// A record whose output is not yet known, in SI units.
fn problem(data: &Data) -> Problem {
    let start_s = data.time_s().first().copied().unwrap_or(0.0);
    let time: Vec<f64> = data.time_s().iter().map(|time| time - start_s).collect();
    Problem {
        units: Units { start_s, time_s: 1.0, input: 1.0, output: 1.0 },
        hold: data.hold(),
        input_time: time.clone(),
        u: data.input().to_vec(),
        second: None,
        y: vec![0.0; time.len()],
        output_time: time,
    }
}

/// Roots of `s^n + a_(n-1) s^(n-1) + ... + a_0`, slowest first; `a` ascending.
pub(super) fn poles(a: &[f64]) -> Vec<Complex<f64>> {
    let n = a.len();
    // Coefficients far from one are scaled, s = scale z, so that the eigenvalues are near one.
    let scale = a[0].abs().powf(1.0 / n as f64).max(f64::MIN_POSITIVE);
    let companion = DMatrix::from_fn(n, n, |i, j| match (i + 1 == n, j == i + 1) {
        (true, _) => -a[j] / scale.powi((n - j) as i32),
        (false, true) => 1.0,
        (false, false) => 0.0,
    });
    let mut poles: Vec<Complex<f64>> =
        companion.complex_eigenvalues().iter().map(|z| polish(a, z * scale)).collect();
    poles.sort_by(|p, q| p.norm().total_cmp(&q.norm()).then(p.im.total_cmp(&q.im)));
    poles
}

/// Newton's method from a root that is nearly right.
fn polish(a: &[f64], mut root: Complex<f64>) -> Complex<f64> {
    for _ in 0..3 {
        let (value, slope) = evaluate(a, root);
        if slope.norm() > 0.0 && (value / slope).norm() < 1e-3 * root.norm() {
            root -= value / slope;
        }
    }
    root
}

/// The monic polynomial and its derivative; `a` ascending.
pub(super) fn evaluate(a: &[f64], s: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
    let (mut value, mut slope) = (Complex::new(1.0, 0.0), Complex::new(0.0, 0.0));
    for &coefficient in a.iter().rev() {
        slope = slope * s + value;
        value = value * s + coefficient;
    }
    (value, slope)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn poles_of_every_order_are_found_in_slow_units_too() {
        // (s + 1e-4)(s + 2e-3)(s + 3e-2), and a pair -1e-3 +- 2e-3 i.
        let (p, q, r) = (1e-4, 2e-3, 3e-2);
        let found = poles(&[p * q * r, p * q + p * r + q * r, p + q + r]);
        for (pole, expected) in found.iter().zip([p, q, r]) {
            assert_relative_eq!(pole.re, -expected, max_relative = 1e-12);
            assert_eq!(pole.im, 0.0);
        }
        let pair = poles(&[5e-6, 2e-3]);
        assert_relative_eq!(pair[1].re, -1e-3, max_relative = 1e-12);
        assert_relative_eq!(pair[1].im, 2e-3, max_relative = 1e-12);
        assert_relative_eq!(poles(&[0.003021])[0].re, -0.003021);
    }

    #[test]
    fn a_ramp_through_a_lag_with_dead_time_has_its_closed_form() {
        // u = t, y = t - delta - tau (1 - e^(-(t - delta)/tau)) from the dead time on, which ends between the samples.
        let (tau, delta) = (331.0, 47.3);
        let model =
            Model { num: vec![1.0 / tau], den: vec![1.0, 1.0 / tau], dead_time_s: delta, offset: 2.0 };
        let time_s = [0.0, 20.0, 60.0, 75.0, 300.0, 1000.0];
        let y = model.simulate(&time_s, &time_s, Hold::First, &InitialState::Zero).unwrap();
        for (t, y) in time_s.iter().zip(y) {
            let since = (t - delta).max(0.0);
            let expected = 2.0 + since - tau * (1.0 - (-since / tau).exp());
            assert_relative_eq!(y, expected, epsilon = 1e-10);
        }
    }

    #[test]
    fn a_given_free_response_decays_as_its_closed_form() {
        // Poles -1 and -2, r(0) = 3, r'(0) = -1: r = 5 e^-t - 2 e^-2t.
        let model = Model { num: vec![1.0], den: vec![1.0, 3.0, 2.0], dead_time_s: 0.0, offset: 0.0 };
        let time_s = [0.0, 0.5, 1.0, 4.0];
        let state = InitialState::Given(vec![3.0, -1.0]);
        let y = model.simulate(&time_s, &[0.0; 4], Hold::Zero, &state).unwrap();
        for (t, y) in time_s.iter().zip(y) {
            assert_relative_eq!(y, 5.0 * (-t).exp() - 2.0 * (-2.0 * t).exp(), max_relative = 1e-12);
        }
    }

    #[test]
    fn a_settled_model_stays_where_it_is() {
        let model = Model { num: vec![0.5, 4.0], den: vec![1.0, 3.0, 2.0], dead_time_s: 0.4, offset: 1.0 };
        let time_s: Vec<f64> = (0..20).map(f64::from).collect();
        let y = model.simulate(&time_s, &[7.0; 20], Hold::First, &InitialState::Settled).unwrap();
        y.iter().for_each(|y| assert_relative_eq!(*y, 15.0, max_relative = 1e-12));
    }

    #[test]
    fn an_unstable_model_is_refused() {
        let model = Model { num: vec![1.0], den: vec![1.0, -0.1], dead_time_s: 0.0, offset: 0.0 };
        let refused = model.simulate(&[0.0, 1.0], &[0.0, 1.0], Hold::Zero, &InitialState::Zero).unwrap_err();
        assert_eq!(refused.to_string(), "`pole` = 0.1 must be in the left half plane");
    }
}
