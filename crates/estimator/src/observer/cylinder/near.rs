//! How near two states must be for one linearisation to hold for both.
//!
//! A linearisation at `a` says of a state `b` that its rate is `f(a) + A (b - a)`. What that leaves out is of second order, bilinear
//! above all: film times the difference of air and wall. Up to a [distance](Cylinder::distance) of [`HARDLY`] it is left out: at the
//! very most `0.15 x 5 K` of what drives the wall, which follows with 20 minutes, 6 mK in 10 s; over railway weeks it moves no
//! estimate by more than 0.004 of its standard deviation. Up to 1 the derivatives of the one serve for the other, and the means
//! move by their own [rates](Cylinder::bend).
use super::super::settings::LeakHypothesis;
use super::super::states::StateKind;
use super::{Crossing, Cylinder};
use crate::EstimatorError;
use crate::sensor::ParameterKind;

/// Distance up to which two states are one but for a linear difference.
pub(in crate::observer) const HARDLY: f64 = 0.5;

impl Cylinder {
    /// Largest difference of two states under their hypotheses, in parts of what a linearisation bears; infinite where a number is none.
    pub(in crate::observer) fn distance(
        &self,
        (reference, a): (&LeakHypothesis, &[f64]),
        (other, b): (&LeakHypothesis, &[f64]),
    ) -> f64 {
        // Without a leak rate the estimate takes no notice of its decay, but the signature of a leak does.
        if other.rate.decay_per_s() != reference.rate.decay_per_s() {
            return f64::INFINITY;
        }
        let farther = |most: f64, &(state, limit): &(usize, f64)| {
            let part = (a[state] - b[state]).abs() * limit;
            if part <= most { most } else { part }
        };
        let most = self.near.iter().fold(0.0, farther);
        if most.is_nan() { f64::INFINITY } else { most }
    }

    /// What the curvature of the equations adds to a state `b` in a step of `h` seconds that a linearisation at `a` has just made, `before`
    /// being `a` at its start: `h (1 + (Phi - 1) / 2) r` with `r = f(b) - f(a) - A (b - a)`. Temperatures alone; lags follow linearly.
    ///
    /// # Errors
    /// The state has no gas.
    pub(in crate::observer) fn bend(
        &mut self,
        before: &[f64],
        b: &[f64],
        h: f64,
        crossing: &Crossing,
        by: &mut [f64],
    ) -> Result<(), EstimatorError> {
        let (physical, temperatures) = (self.model.states(), self.states.mass);
        let unknowns = self.unknowns(b);
        let rate = &mut self.work.rate;
        self.model.rates(&b[..physical], &unknowns, rate, None)?;
        self.work.transition.subtract_linear(before, b, &mut rate[..temperatures]);
        for (row, by) in by[..temperatures].iter_mut().enumerate() {
            let carried: f64 =
                rate[..temperatures].iter().enumerate().map(|(j, r)| crossing.phi[(row, j)] * r).sum();
            *by += 0.5 * h * (rate[row] + carried);
        }
        Ok(())
    }

    /// Inverse of the largest difference of a state for which a linearisation serves; `None` where the equations are linear.
    pub(super) fn nearness(&self, kind: &StateKind) -> Option<f64> {
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
    use crate::filter::StateSpace;
    use crate::observer::ObserverSettings;
    use crate::sensor::Sensor;
    use crate::thermal::vessel::presets;

    #[test]
    fn curvature_takes_a_near_state_where_its_own_equations_do() {
        let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
        let settings = ObserverSettings::default();
        let vessel = presets::load("nitrogen-20l").unwrap();
        let mut cylinder = Cylinder::new(&vessel, &sensors, &settings).unwrap();
        let (n, m, states) = (cylinder.states(), cylinder.leading(), cylinder.states.clone());
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
        assert!((HARDLY..1.0).contains(&distance), "{distance}");

        let mut own = b.clone();
        cylinder.propagate(&mut own, 10.0, None).unwrap();
        let (before, mut crossing) = (a.clone(), Crossing::new(n, m));
        cylinder.cross(&mut a, 10.0, &mut crossing).unwrap();
        let away = nalgebra::DVector::from_fn(n, |i, _| b[i] - before[i]);
        let mut by = (&crossing.phi * away).as_slice().to_vec();
        by.iter_mut().zip(&a).for_each(|(by, a)| *by += a);
        let error = |x: &[f64]| (0..states.mass).map(|i| (x[i] - own[i]).abs()).fold(0.0, f64::max);
        let linear_k = error(&by);
        cylinder.bend(&before, &b, 10.0, &crossing, &mut by).unwrap();
        let bent_k = error(&by);
        assert!(linear_k > 0.01, "{linear_k}");
        assert!(bent_k < 0.15 * linear_k, "{bent_k} of {linear_k}");
    }
}
