//! A step of the cylinder with its noise in parts, for filters that suppose different things of mass and leak.
use nalgebra::DMatrix;

use super::Cylinder;
use crate::EstimatorError;
use crate::filter::bank::Pattern;

/// Transition of a step and the noise that it adds.
#[derive(Clone, Debug)]
pub(in crate::observer) struct Crossing {
    /// Leading rows of the transition: (leading, n).
    pub phi: DMatrix<f64>,
    /// Noise covariance but for mass and leak rate: (leading, leading), upper triangle.
    pub noise: DMatrix<f64>,
    /// Noise covariance by mass and by leak rate, per unit of their intensities.
    pub by_mass: DMatrix<f64>,
    pub by_leak: DMatrix<f64>,
}

impl Crossing {
    pub fn new(n: usize, leading: usize) -> Self {
        let square = DMatrix::zeros(leading, leading);
        Self {
            phi: DMatrix::zeros(leading, n),
            noise: square.clone(),
            by_mass: square.clone(),
            by_leak: square,
        }
    }
}

impl Cylinder {
    /// Move a state by one undivided step and write what the step is.
    ///
    /// # Errors
    /// The state has no gas.
    pub(in crate::observer) fn cross(
        &mut self,
        x: &mut [f64],
        h: f64,
        crossing: &mut Crossing,
    ) -> Result<(), EstimatorError> {
        self.step(x, h, false)?;
        let (mass, leak, walking) = (self.states.mass, self.states.leak, &self.walking);
        let transition = &mut self.work.transition;
        transition.write_phi(&mut crossing.phi);
        let common =
            |state: usize| if state == mass || state == leak { 0.0 } else { walking[state].intensity };
        transition.write_noise(common, h, &mut crossing.noise);
        let only = |of: usize| move |state: usize| f64::from(state == of);
        transition.write_noise(only(mass), h, &mut crossing.by_mass);
        transition.write_noise(only(leak), h, &mut crossing.by_leak);
        Ok(())
    }

    /// Where the leading rows of a transition may differ from zero.
    pub(in crate::observer) fn pattern(&self) -> Pattern {
        let states = &self.states;
        let lags: Vec<usize> = states.lag.iter().flatten().copied().collect();
        let temperatures = 0..states.mass;
        let others = (temperatures.end..states.leading).filter(|state| !lags.contains(state));
        let films = [states.inside, states.capacity, states.slope].into_iter().flatten();
        let physical: Vec<usize> = temperatures.clone().chain(others).chain(films).collect();
        let row = |state: usize| match state {
            _ if temperatures.contains(&state) => physical.clone(),
            _ if lags.contains(&state) => {
                let sensor = states.lag.iter().position(|lag| *lag == Some(state));
                let parameters = sensor.map_or(&[][..], |sensor| &states.parameters[sensor]);
                physical.iter().copied().chain([state]).chain(parameters.iter().copied().flatten()).collect()
            }
            _ if state == states.mass => vec![state, states.leak],
            _ => vec![state],
        };
        Pattern::new(&(0..states.leading).map(row).collect::<Vec<_>>())
    }
}
