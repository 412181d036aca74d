//! Neighbours of a run to first order: the sensitivities of a trajectory.
//!
//! For a parameter `theta` the state `x(t; theta)` has the derivative `dx/dtheta`. Two neighbours at
//! `theta -+ h` are displaced from the run by `-+ d`, `d = h dx/dtheta`, with
//!
//! `dd/dt = F(d) = [f(x + d; theta + h) - f(x - d; theta - h)] / 2`, `d(0) = [x0(theta + h) - x0(theta - h)] / 2`
//!
//! No error of the solver enters these differences; of `h` there remains `O(h^2)`. Over each step that the solver accepts,
//! along its dense output, the equation is integrated by the L-stable SDIRK of five stages and order 4 of Hairer and Wanner
//! (1996, table IV.6.5). It is linear but for `O(h^3)`, so a stage is one solution of linear equations for all parameters with the
//! model's exact Jacobian `J`: `F(d) = F(d') + J (d - d')`, `d'` being the stage's explicit part. That is more than
//! `J d + df/dtheta`: where gas and wall are equally warm the film's heat bends as `|dT|^(4/3)`, and a difference at a fixed
//! state, at which the neighbours are not at rest, would see that bend. Within a step `d` is a cubic of Hermite.
//!
//! A flow that opens or closes where the pressure reaches a limit does so earlier or later in a neighbour: by
//! `dt = -dp / (dp/dt)`, and the displacement jumps by `(f_before - f_after) dt`. Times of a scenario are fixed and give no jump.
use nalgebra::{DMatrix, DVector};

use super::events::Interpolation;
use super::samples::Samples;
use super::solver::Drive;
use crate::ThermalError;
use crate::model::Model;
use crate::model::inputs::{InputPieces, Inputs};
use crate::scenario::Scenario;
use crate::trajectory::Trajectory;
use crate::vessel::Vessel;

/// Diagonal of the method.
const GAMMA: f64 = 0.25;
/// Nodes of the method.
const NODES: [f64; 5] = [0.25, 0.75, 11.0 / 20.0, 0.5, 1.0];
/// Coefficients below the diagonal; the last row with [`GAMMA`] is that of the weights.
const WEIGHTS: [[f64; 4]; 5] = [
    [0.0; 4],
    [0.5, 0.0, 0.0, 0.0],
    [17.0 / 50.0, -1.0 / 25.0, 0.0, 0.0],
    [371.0 / 1360.0, -137.0 / 2720.0, 15.0 / 544.0, 0.0],
    [25.0 / 24.0, -49.0 / 48.0, 125.0 / 16.0, -85.0 / 12.0],
];
/// Time over which the rate of the pressure is taken, s.
const PRESSURE_STEP_S: f64 = 2e-3;

/// A vessel and a scenario on either side of the run's own.
#[derive(Clone, Debug)]
pub struct Neighbours {
    /// The parameter a little smaller.
    pub below: (Vessel, Scenario),
    /// The parameter larger by as much.
    pub above: (Vessel, Scenario),
}

/// One neighbour.
struct Side {
    vessel: Vessel,
    scenario: Scenario,
    model: Model,
    pieces: InputPieces,
    samples: Samples,
    /// -1 below, 1 above.
    sign: f64,
}

/// Displacements of all neighbours in the middle of a run.
pub(super) struct Tangents {
    sides: Vec<[Side; 2]>,
    /// Start and end of the last step, s.
    span_s: (f64, f64),
    /// Displacements, (states, parameters), at its ends, and their rates.
    ends: [DMatrix<f64>; 2],
    rates: [DMatrix<f64>; 2],
    /// Whether the rate at the end still holds for the next step.
    continues: bool,
}

impl Side {
    fn new((vessel, scenario): &(Vessel, Scenario), until_s: f64, sign: f64) -> Result<Self, ThermalError> {
        Ok(Self {
            vessel: vessel.clone(),
            scenario: scenario.clone(),
            model: Model::new(vessel, scenario)?,
            pieces: InputPieces::new(scenario, 0.0, until_s),
            samples: Samples::new(scenario),
            sign,
        })
    }

    /// The state of this side.
    fn displaced(&self, x: &[f64], by: &[f64]) -> Vec<f64> {
        x.iter().zip(by).map(|(x, by)| x + self.sign * by).collect()
    }
}

impl Tangents {
    /// Displacements at time 0; `first_edge_s` ends the first piece of the inputs.
    pub(super) fn new(
        neighbours: &[Neighbours],
        model: &Model,
        first_edge_s: f64,
    ) -> Result<Self, ThermalError> {
        let n = model.layout().states;
        let mut displacement = DMatrix::zeros(n, neighbours.len());
        let mut sides = Vec::with_capacity(neighbours.len());
        for (column, Neighbours { below, above }) in neighbours.iter().enumerate() {
            let pair = [Side::new(below, first_edge_s, -1.0)?, Side::new(above, first_edge_s, 1.0)?];
            if pair.iter().any(|side| side.model.layout() != model.layout()) {
                return Err(ThermalError::NeighbourOfAnotherShape { index: column });
            }
            for side in &pair {
                let x0 = side.model.initial_state(&side.vessel, &side.scenario.initial)?;
                for (d, x) in displacement.column_mut(column).iter_mut().zip(x0) {
                    *d += 0.5 * side.sign * x;
                }
            }
            sides.push(pair);
        }
        let rates = DMatrix::zeros(n, neighbours.len());
        let ends = [displacement.clone(), displacement];
        Ok(Self { sides, span_s: (0.0, 0.0), ends, rates: [rates.clone(), rates], continues: false })
    }

    /// Inputs of `[from, to]`, s.
    pub(super) fn begin_segment(&mut self, from_s: f64, to_s: f64) {
        self.continues = false;
        for side in self.sides.iter_mut().flatten() {
            side.pieces = InputPieces::new(&side.scenario, from_s, to_s);
        }
    }

    /// Integrate over `[from, to]`, s, of the last step, with the state `along` it.
    pub(super) fn advance(
        &mut self,
        model: &Model,
        drive: &Drive,
        (from_s, to_s): (f64, f64),
        along: &mut Interpolation<'_>,
    ) -> Result<(), ThermalError> {
        let h = to_s - from_s;
        let mut x = vec![0.0; model.layout().states];
        let mut state_at = |time_s: f64, x: &mut [f64]| {
            along(time_s, x).map_err(|reason| ThermalError::SolverSetup { reason })
        };
        self.span_s = (from_s, to_s);
        self.ends.swap(0, 1);
        self.rates.swap(0, 1);
        if !self.continues {
            state_at(from_s, &mut x)?;
            self.rates[0] = self.difference(drive, from_s, &x, &self.ends[0])?;
        }
        let mut stages: Vec<DMatrix<f64>> = Vec::with_capacity(NODES.len());
        for (node, weights) in NODES.iter().zip(&WEIGHTS) {
            let time_s = from_s + node * h;
            state_at(time_s, &mut x)?;
            let mut explicit = self.ends[0].clone();
            for (weight, stage) in weights.iter().zip(&stages) {
                explicit.zip_apply(stage, |explicit, rate| *explicit += h * weight * rate);
            }
            let rate = self.difference(drive, time_s, &x, &explicit)?;
            let stage = implicit(model, drive, time_s, &x, GAMMA * h)?.lu().solve(&rate);
            stages.push(stage.ok_or_else(|| ThermalError::SolverSetup {
                reason: format!("the sensitivities have no solution at {time_s} s"),
            })?);
            self.ends[1] = explicit;
        }
        if let Some(last) = stages.pop() {
            self.ends[1].zip_apply(&last, |end, rate| *end += h * GAMMA * rate);
            self.rates[1] = last;
        }
        self.continues = true;
        Ok(())
    }

    /// `F(d)` at a state of the run.
    fn difference(
        &self,
        drive: &Drive,
        time_s: f64,
        x: &[f64],
        displacement: &DMatrix<f64>,
    ) -> Result<DMatrix<f64>, ThermalError> {
        let open = drive.open.borrow();
        let mut difference = DMatrix::zeros(x.len(), self.sides.len());
        let mut rate = vec![0.0; x.len()];
        for (column, pair) in self.sides.iter().enumerate() {
            for side in pair {
                let displaced = side.displaced(x, displacement.column(column).as_slice());
                side.model.rate(&displaced, &side.pieces.at(time_s), &open, &mut rate)?;
                for (d, rate) in difference.column_mut(column).iter_mut().zip(&rate) {
                    *d += 0.5 * side.sign * rate;
                }
            }
        }
        Ok(difference)
    }

    /// Displacements at a time of the last step.
    fn at(&self, time_s: f64) -> DMatrix<f64> {
        let (from_s, to_s) = self.span_s;
        let h = to_s - from_s;
        if h <= 0.0 {
            return self.ends[1].clone();
        }
        let s = ((time_s - from_s) / h).clamp(0.0, 1.0);
        let r = 1.0 - s;
        let (values, slopes) =
            ([r * r * (1.0 + 2.0 * s), s * s * (1.0 + 2.0 * r)], [h * s * r * r, -h * s * s * r]);
        &self.ends[0] * values[0]
            + &self.ends[1] * values[1]
            + &self.rates[0] * slopes[0]
            + &self.rates[1] * slopes[1]
    }

    /// Sample every neighbour at a time of the last step, at which the run's state is `x`.
    pub(super) fn sample(&mut self, time_s: f64, x: &[f64], open: &[bool]) -> Result<(), ThermalError> {
        let displacement = self.at(time_s);
        for (pair, column) in self.sides.iter_mut().zip(displacement.column_iter()) {
            for side in pair {
                let displaced = side.displaced(x, column.as_slice());
                let inputs = side.pieces.at(time_s);
                let output = side.model.output(&displaced, &inputs, open)?;
                side.samples.push(time_s, inputs.air_k, output);
            }
        }
        Ok(())
    }

    /// How much later, s, each neighbour above reaches the pressure that the run has reached in state `x`.
    pub(super) fn delays(
        &self,
        model: &Model,
        inputs: &Inputs,
        open: &[bool],
        x: &[f64],
    ) -> Result<Delays, ThermalError> {
        let mut rate = vec![0.0; x.len()];
        model.rate(x, inputs, open, &mut rate)?;
        let moved = |by_s: f64| -> Result<f64, ThermalError> {
            let x: Vec<f64> = x.iter().zip(&rate).map(|(x, rate)| x + by_s * rate).collect();
            Ok(model.gas_state(&x)?.1)
        };
        let slope_pa_s = (moved(PRESSURE_STEP_S)? - moved(-PRESSURE_STEP_S)?) / (2.0 * PRESSURE_STEP_S);
        let mut delay_s = Vec::with_capacity(self.sides.len());
        for (pair, column) in self.sides.iter().zip(self.ends[1].column_iter()) {
            let mut ahead_pa = 0.0;
            for side in pair {
                let pressure_pa = side.model.gas_state(&side.displaced(x, column.as_slice()))?.1;
                ahead_pa += 0.5 * side.sign * pressure_pa;
            }
            delay_s.push(-ahead_pa / slope_pa_s);
        }
        Ok(Delays { delay_s, rate })
    }

    /// The jump of the displacements after an event of the run, whose rates are those of `delays` before it.
    pub(super) fn jump(
        &mut self,
        delays: &Delays,
        model: &Model,
        inputs: &Inputs,
        open: &[bool],
        x: &[f64],
    ) -> Result<(), ThermalError> {
        let mut after = vec![0.0; x.len()];
        model.rate(x, inputs, open, &mut after)?;
        let change = DVector::from_fn(x.len(), |i, _| delays.rate[i] - after[i]);
        let delay = DVector::from_column_slice(&delays.delay_s);
        self.ends[1].ger(1.0, &change, &delay, 1.0);
        self.continues = false;
        Ok(())
    }

    /// Trajectories of each neighbour, below and above, so far without events and balance.
    pub(super) fn into_trajectories(self) -> impl Iterator<Item = [Trajectory; 2]> {
        self.sides.into_iter().map(|pair| {
            pair.map(|Side { vessel, scenario, model, samples, .. }| {
                samples.into_trajectory(&vessel, &scenario, &model)
            })
        })
    }
}

/// When neighbours reach the pressure of an event, and the run's rate before it.
pub(super) struct Delays {
    delay_s: Vec<f64>,
    rate: Vec<f64>,
}

/// `I - c J` at a state of the run.
fn implicit(
    model: &Model,
    drive: &Drive,
    time_s: f64,
    x: &[f64],
    c: f64,
) -> Result<DMatrix<f64>, ThermalError> {
    let mut matrix = DMatrix::identity(x.len(), x.len());
    let inputs = drive.pieces.get().at(time_s);
    model.jacobian(x, &inputs, &drive.open.borrow(), &mut |i, j, value| matrix[(i, j)] -= c * value)?;
    Ok(matrix)
}
