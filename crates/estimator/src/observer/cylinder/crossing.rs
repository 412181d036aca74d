//! A step of the cylinder with its noise in parts, for filters that suppose different things of mass and leak.
use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use super::Cylinder;
use super::structure::Structure;
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

/// What follows the linearisation, compiled for the vector registers of the machine.
struct Cross<'a> {
    cylinder: &'a mut Cylinder,
    x: &'a mut [f64],
    h: f64,
    crossing: &'a mut Crossing,
}

impl WithSimd for Cross<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { cylinder, x, h, crossing } = self;
        let (mass, leak, walking) = (cylinder.states.mass, cylinder.states.leak, &cylinder.walking);
        let transition = &mut cylinder.work.transition;
        transition.solve(x, walking, h);
        transition.advance(x);
        transition.write_phi(&mut crossing.phi);
        let common =
            |state: usize| if state == mass || state == leak { 0.0 } else { walking[state].intensity };
        transition.write_noise(common, h, &mut crossing.noise);
        transition.write_noise(|state| f64::from(state == mass), h, &mut crossing.by_mass);
        transition.write_noise(|state| f64::from(state == leak), h, &mut crossing.by_leak);
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
        self.linearise(x)?;
        Arch::new().dispatch(Cross { cylinder: self, x, h, crossing });
        Ok(())
    }

    /// Where the leading rows of a transition may differ from zero.
    pub(in crate::observer) fn pattern(&self) -> Pattern {
        let Structure { block, outer, constants, mass, leak, .. } = Structure::of(&self.states);
        let coupled = [block.as_slice(), &outer, &constants].concat();
        let row = |state: usize| match state {
            _ if block.contains(&state) => coupled.clone(),
            _ if state == mass => vec![mass, leak],
            _ => vec![state],
        };
        // Noise spreads within the block, from outside of it into the block, and from the leak rate to the mass.
        let correlated =
            |i: usize, j: usize| block.contains(&i) || block.contains(&j) || (i, j) == (mass, leak);
        Pattern::new(&(0..self.states.leading).map(row).collect::<Vec<_>>()).with_noise(correlated)
    }
}
