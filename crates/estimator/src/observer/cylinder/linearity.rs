//! How close two states must be for one linearisation to hold for both.
//!
//! A linearisation at `a` says of a state `b` that its rate is `f(a) + A (b - a)`. What that leaves out is of second order, bilinear
//! above all: film times the difference of air and wall. Up to a [distance](crate::filter::Plant::distance) of 1 the derivatives of the one serve
//! for the other, and the means move by their own rates.
use super::super::states::StateKind;
use super::Cylinder;
use crate::EstimatorError;
use crate::filter::StepTransition;
use crate::sensor::ParameterKind;

impl Cylinder {
    /// Largest difference of two states, in parts of what a linearisation bears; infinite where a number is none.
    pub(super) fn difference(&self, a: &[f64], b: &[f64]) -> f64 {
        let farther = |most: f64, &(state, limit): &(usize, f64)| {
            let part = (a[state] - b[state]).abs() * limit;
            if part <= most { most } else { part }
        };
        let most = self.nonlinear.iter().fold(0.0, farther);
        if most.is_nan() { f64::INFINITY } else { most }
    }

    /// What the curvature of the equations adds to a state `b` in a step of `h` seconds that a linearisation at `a` has just made:
    /// `h (1 + (Phi - 1) / 2) r` with `r = f(b) - f(a) - A (b - a)`. Temperatures alone; lags follow linearly.
    ///
    /// # Errors
    /// The state has no gas.
    pub(super) fn add_rate_difference(
        &mut self,
        a: &[f64],
        b: &[f64],
        h: f64,
        step: &StepTransition,
        by: &mut [f64],
    ) -> Result<(), EstimatorError> {
        let (physical, temperatures) = (self.model.states(), self.states.mass);
        let unknowns = self.unknowns(b);
        let rate = &mut self.work.rate;
        self.model.rates(&b[..physical], &unknowns, rate, None)?;
        self.work.transition.subtract_linear(a, b, &mut rate[..temperatures]);
        for (row, by) in by[..temperatures].iter_mut().enumerate() {
            let carried: f64 =
                rate[..temperatures].iter().enumerate().map(|(j, r)| step.phi[(row, j)] * r).sum();
            *by += 0.5 * h * (rate[row] + carried);
        }
        Ok(())
    }

    /// Inverse of the largest difference of a state for which a linearisation serves; `None` where the equations are linear.
    pub(super) fn linear_range(&self, kind: &StateKind) -> Option<f64> {
        let limit = match kind {
            StateKind::Wall(_) | StateKind::Valve | StateKind::Gas => 2.0,
            StateKind::Mass => 0.05,
            StateKind::Air => 10.0,
            StateKind::OutsideFilm => 0.5,
            StateKind::Sun => 40.0,
            StateKind::InsideFilm => 0.5,
            StateKind::Capacity => 0.3,
            StateKind::FilmSlope => 0.2,
            StateKind::ValveSun => 0.3,
            StateKind::Leak | StateKind::Lag { .. } => return None,
            StateKind::Parameter { sensor, parameter } => {
                match self.sensors[*sensor].parameters()[*parameter].kind {
                    ParameterKind::Coupling => 0.06,
                    _ => return None,
                }
            }
        };
        Some(1.0 / limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::{Plant, StateSpace};
    use crate::observer::ObserverSettings;
    use crate::sensor::Sensor;
    use crate::thermal::vessel::presets;

    #[test]
    fn curvature_takes_a_close_state_where_its_own_equations_do() {
        let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
        let settings = ObserverSettings::default();
        let vessel = presets::load("nitrogen-20l").unwrap();
        let mut cylinder = Cylinder::new(&vessel, &sensors, &settings).unwrap();
        let (n, states) = (cylinder.states(), cylinder.states.clone());
        let mut a = vec![0.0; n];
        a[..states.mass].copy_from_slice(&[270.0, 271.0, 273.0, 268.0]);
        (a[states.mass], a[states.air]) = (4.4, 305.0);
        let mut b = a.clone();
        b[states.air] += 4.0;
        b[states.gas] -= 0.5;
        b[states.outside.unwrap()] += 0.3;
        b[states.inside.unwrap()] -= 0.3;
        b[states.capacity.unwrap()] += 0.1;
        let leak = settings.bank[0];
        let distance = cylinder.distance((&leak, &a), (&leak, &b));
        assert!((0.5..1.0).contains(&distance), "{distance}");

        let mut own = b.clone();
        cylinder.propagate(&mut own, 10.0, None).unwrap();
        let (before, mut step) = (a.clone(), StepTransition::zeros(n, states.leading, Cylinder::SOURCES));
        cylinder.transition(&mut a, 10.0, &mut step).unwrap();
        let away = nalgebra::DVector::from_fn(n, |i, _| b[i] - before[i]);
        let mut by = (&step.phi * away).as_slice().to_vec();
        by.iter_mut().zip(&a).for_each(|(by, a)| *by += a);
        let error = |x: &[f64]| (0..states.mass).map(|i| (x[i] - own[i]).abs()).fold(0.0, f64::max);
        let linear_k = error(&by);
        cylinder.add_curvature(&before, &b, 10.0, &step, &mut by).unwrap();
        let bent_k = error(&by);
        assert!(linear_k > 0.01, "{linear_k}");
        assert!(bent_k < 0.15 * linear_k, "{bent_k} of {linear_k}");
    }
}
