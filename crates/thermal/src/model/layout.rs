//! Where each quantity stands in the state vector.
//!
//! `[wall cells | valve | mean wall | gas masses | gas energies | heat in | enthalpy in | mass in | work out | drawn | stirring]`
//!
//! Wall and valve carry energy as the temperature `x = T_ref + e / c_20` (see [`crate::wall::material`]); `mean wall` is
//! their capacity-weighted mean without the valve, kept as a state so that the inner volume needs no dense coupling.
//! Heat, enthalpy, mass and work are the ledger: time integrals of what crosses the boundary. Then comes the mass that was drawn from each
//! vessel that is the source of a refill, and last the motion of the gas that jets stir, where a refill has an inlet.

/// Indices into the state vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Number of wall cells; they come first.
    pub wall: usize,
    /// The valve's state, if there is a valve.
    pub valve: Option<usize>,
    /// Number of gas cells.
    pub gas: usize,
    /// Mean wall state.
    pub mean_wall: usize,
    /// First gas mass, kg.
    pub mass: usize,
    /// First gas energy, J.
    pub energy: usize,
    /// Heat received from outside, J.
    pub heat_in: usize,
    /// Enthalpy received with gas, J.
    pub(crate) enthalpy_in: usize,
    /// Gas received, kg.
    pub(crate) mass_in: usize,
    /// Work done on the expanding vessel, J.
    pub(crate) work_out: usize,
    /// Mass drawn from the first source vessel, kg.
    pub(crate) drawn: usize,
    /// Reynolds number of the jet that keeps the gas in its motion, if a refill has an inlet.
    pub(crate) stirring: Option<usize>,
    /// Number of states.
    pub states: usize,
}

impl Layout {
    /// Layout for so many wall and gas cells and source vessels, with or without jets.
    pub(crate) fn new(wall: usize, valve: bool, gas: usize, sources: usize, jets: bool) -> Self {
        let mean_wall = wall + usize::from(valve);
        let mass = mean_wall + 1;
        let energy = mass + gas;
        let heat_in = energy + gas;
        let stirring = heat_in + 4 + sources;
        Self {
            wall,
            valve: valve.then_some(wall),
            gas,
            mean_wall,
            mass,
            energy,
            heat_in,
            enthalpy_in: heat_in + 1,
            mass_in: heat_in + 2,
            work_out: heat_in + 3,
            drawn: heat_in + 4,
            stirring: jets.then_some(stirring),
            states: stirring + usize::from(jets),
        }
    }

    /// Gas masses, kg, and energies, J, of a state vector.
    pub(crate) fn gas_of<'a>(&self, x: &'a [f64]) -> (&'a [f64], &'a [f64]) {
        x[self.mass..self.heat_in].split_at(self.gas)
    }
}
