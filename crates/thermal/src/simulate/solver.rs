//! The bridge to diffsol, and the only file that names it.
//!
//! [`with_stepper`] builds the solver for a [`Model`] and hands out a [`Stepper`], which hides its types. What the bridge takes care of:
//! * The Jacobian's pattern is given explicitly, from the model's fixed sequence of entries; nothing is probed.
//! * After a jump of an input the derivative is refreshed, the step reset and the order lowered: dense
//!   output over a jump with the old step can be wrong by tens of kelvin without any error.
//! * The stop time is snapped, since one-step methods may end one rounding beside it.
//! * A failing right-hand side yields NaN, so that the step is rejected; a NaN that slips into an accepted
//!   state is caught by the driver.
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use diffsol::matrix::sparsity::MatrixSparsity;
use diffsol::{
    Bdf, ConstantOp, FaerContext, FaerSparseMat, FaerVec, Matrix, NonLinearOp, NonLinearOpJacobian,
    OdeBuilder, OdeEquations, OdeEquationsRef, OdeSolverMethod, OdeSolverStopReason, Op, ParameterisedOp,
    Sdirk, Tableau, UnitCallable, Vector,
};

use super::bordered::BorderedLu;
use super::{Method, SimulationSettings};
use crate::ThermalError;
use crate::model::Model;
use crate::model::inputs::InputPieces;
use crate::trajectory::SolverStatistics;

type M = FaerSparseMat<f64>;
type V = FaerVec<f64>;
type LS = BorderedLu;

/// What drives the model now; changed between segments while the solver holds the equations.
pub(super) struct Drive {
    /// Surroundings of the segment.
    pub pieces: Cell<InputPieces>,
    /// Which flows are open.
    pub open: RefCell<Vec<bool>>,
    /// Why the last evaluation failed, if it did.
    pub failure: RefCell<Option<ThermalError>>,
}

/// Why a step ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// The solver chose its end.
    Internal,
    /// The stop time is reached.
    Stop,
}

/// A solver in the middle of a run.
pub(super) trait Stepper {
    /// Current time, s.
    fn time_s(&self) -> f64;
    /// Copy the current state.
    fn state(&self, out: &mut [f64]);
    /// One step, not past the stop time.
    fn step(&mut self) -> Result<Step, String>;
    /// Set the time that must not be passed, s.
    fn set_stop(&mut self, t_s: f64) -> Result<(), String>;
    /// State at a time within the last step.
    fn interpolate(&mut self, t_s: f64, out: &mut [f64]) -> Result<(), String>;
    /// Move the state back to a time within the last step.
    fn back_to(&mut self, t_s: f64) -> Result<(), String>;
    /// Begin anew from the current state at exactly `t_s` after a jump of the inputs, with a first step, s.
    fn restart(&mut self, t_s: f64, first_step_s: f64);
    /// What the solver did so far.
    fn statistics(&self) -> SolverStatistics;
}

struct Rhs<'m> {
    model: &'m Model,
    drive: &'m Drive,
    context: FaerContext,
    /// Pattern in column-major order.
    pattern: Vec<(usize, usize)>,
    /// Position in the value array of each emitted entry.
    slots: Vec<usize>,
    values: RefCell<Vec<f64>>,
}

impl<'m> Rhs<'m> {
    fn new(model: &'m Model, drive: &'m Drive, x0: &[f64]) -> Result<Self, ThermalError> {
        let mut sequence = Vec::new();
        model.jacobian(x0, &drive.pieces.get().at(0.0), &drive.open.borrow(), &mut |row, column, _| {
            sequence.push((column, row));
        })?;
        // The diagonal belongs to the pattern of `M - c J` in any case.
        let mut index: BTreeMap<(usize, usize), usize> = (0..x0.len()).map(|i| ((i, i), 0)).collect();
        index.extend(sequence.iter().map(|&entry| (entry, 0)));
        for (position, value) in index.values_mut().enumerate() {
            *value = position;
        }
        let slots = sequence.iter().map(|entry| index[entry]).collect();
        let pattern: Vec<_> = index.keys().map(|&(column, row)| (row, column)).collect();
        Ok(Self {
            model,
            drive,
            context: FaerContext::default(),
            values: RefCell::new(vec![0.0; pattern.len()]),
            pattern,
            slots,
        })
    }

    fn evaluate(&self, x: &[f64], t: f64, rate: &mut [f64]) {
        // A state that is no number follows from an earlier failure, which is the cause.
        if x.iter().any(|value| value.is_nan()) {
            rate.fill(f64::NAN);
            return;
        }
        let inputs = self.drive.pieces.get().at(t);
        if let Err(error) = self.model.rate(x, &inputs, &self.drive.open.borrow(), rate) {
            *self.drive.failure.borrow_mut() = Some(error);
            rate.fill(f64::NAN);
        }
    }
}

impl Op for &Rhs<'_> {
    type T = f64;
    type V = V;
    type M = M;
    type C = FaerContext;
    fn context(&self) -> &FaerContext {
        &self.context
    }
    fn nstates(&self) -> usize {
        self.model.layout().states
    }
    fn nout(&self) -> usize {
        self.model.layout().states
    }
    fn nparams(&self) -> usize {
        0
    }
}

impl NonLinearOp for &Rhs<'_> {
    fn call_inplace(&self, x: &V, t: f64, y: &mut V) {
        y.for_each_batch_host([x], |y, [x], _| self.evaluate(x, t, y));
    }
}

impl NonLinearOpJacobian for &Rhs<'_> {
    fn jac_mul_inplace(&self, x: &V, t: f64, v: &V, y: &mut V) {
        let inputs = self.drive.pieces.get().at(t);
        y.for_each_batch_host([x, v], |y, [x, v], _| {
            y.fill(0.0);
            let product = self.model.jacobian(x, &inputs, &self.drive.open.borrow(), &mut |i, j, value| {
                y[i] += value * v[j];
            });
            if let Err(error) = product {
                *self.drive.failure.borrow_mut() = Some(error);
            }
        });
    }

    fn jacobian_sparsity(&self) -> Option<<M as Matrix>::Sparsity> {
        let n = self.model.layout().states;
        <<M as Matrix>::Sparsity as MatrixSparsity<M>>::try_from_indices(n, n, self.pattern.clone()).ok()
    }

    fn jacobian_inplace(&self, x: &V, t: f64, y: &mut M) {
        let inputs = self.drive.pieces.get().at(t);
        let mut values = self.values.borrow_mut();
        values.fill(0.0);
        let mut slots = self.slots.iter();
        let x: Vec<f64> = (0..x.len()).map(|i| x.get_index(i)).collect();
        let emitted = self.model.jacobian(&x, &inputs, &self.drive.open.borrow(), &mut |_, _, value| {
            if let Some(&slot) = slots.next() {
                values[slot] += value;
            }
        });
        if let Err(error) = emitted {
            *self.drive.failure.borrow_mut() = Some(error);
            values.fill(0.0);
        }
        // A NaN would stop the factorisation with a panic; without coupling Newton merely fails.
        if values.iter().any(|value| !value.is_finite()) {
            values.fill(0.0);
        }
        y.inner_mut()[0].val_mut().copy_from_slice(&values);
    }
}

struct Init {
    x0: Vec<f64>,
    context: FaerContext,
}

impl Op for &Init {
    type T = f64;
    type V = V;
    type M = M;
    type C = FaerContext;
    fn context(&self) -> &FaerContext {
        &self.context
    }
    fn nstates(&self) -> usize {
        self.x0.len()
    }
    fn nout(&self) -> usize {
        self.x0.len()
    }
    fn nparams(&self) -> usize {
        0
    }
}

impl ConstantOp for &Init {
    fn call_inplace(&self, _t: f64, y: &mut V) {
        y.for_each_batch_host([], |y, [], _| y.copy_from_slice(&self.x0));
    }
}

struct Equations<'m> {
    rhs: Rhs<'m>,
    init: Init,
}

impl Op for Equations<'_> {
    type T = f64;
    type V = V;
    type M = M;
    type C = FaerContext;
    fn context(&self) -> &FaerContext {
        &self.rhs.context
    }
    fn nstates(&self) -> usize {
        self.init.x0.len()
    }
    fn nout(&self) -> usize {
        self.init.x0.len()
    }
    fn nparams(&self) -> usize {
        0
    }
}

impl<'a, 'm> OdeEquationsRef<'a> for Equations<'m> {
    type Mass = ParameterisedOp<'a, UnitCallable<M>>;
    type Rhs = &'a Rhs<'m>;
    type Root = ParameterisedOp<'a, UnitCallable<M>>;
    type Init = &'a Init;
    type Out = ParameterisedOp<'a, UnitCallable<M>>;
    type Reset = ParameterisedOp<'a, UnitCallable<M>>;
}

impl OdeEquations for Equations<'_> {
    fn rhs(&self) -> <Self as OdeEquationsRef<'_>>::Rhs {
        &self.rhs
    }
    fn mass(&self) -> Option<<Self as OdeEquationsRef<'_>>::Mass> {
        None
    }
    fn init(&self) -> <Self as OdeEquationsRef<'_>>::Init {
        &self.init
    }
    fn set_params(&mut self, _p: &V) {}
    fn get_params(&self, _p: &mut V) {}
}

struct Wrapper<'a, 'm, S> {
    solver: S,
    equations: &'a Equations<'m>,
    buffer: V,
    rate: V,
    /// Start of the last step, s.
    begin_s: f64,
    /// Stop time, s.
    stop_s: f64,
    /// The last step ended at the stop time, give or take a rounding.
    at_stop: bool,
    /// Whether the method keeps no history, so that its time may be set.
    one_step: bool,
}

impl<'a, 'm, S> Wrapper<'a, 'm, S> {
    fn new(solver: S, equations: &'a Equations<'m>, buffer: V, rate: V, one_step: bool) -> Self {
        Self { solver, equations, buffer, rate, begin_s: 0.0, stop_s: 0.0, at_stop: false, one_step }
    }
}

impl<'a, 'm: 'a, S: OdeSolverMethod<'a, Equations<'m>>> Wrapper<'a, 'm, S> {
    /// Tell a method with a history of the stop time only when its next step would pass it.
    ///
    /// A solver that knows it rescales its history at the end of a step to what is left before the stop. The polynomial is the same,
    /// but where little is left a rounding in its difference of order `k` grows by `(step/left)^(k-1)` over the step that has been made,
    /// which samples have yet to be taken of.
    fn tell_stop(&mut self) -> Result<(), String> {
        if self.one_step {
            return Ok(());
        }
        let state = self.solver.state();
        let stop_s = if state.t + state.h > self.stop_s - self.rounding_s() { self.stop_s } else { f64::MAX };
        self.solver.set_stop_time(stop_s).map_err(|error| error.to_string())
    }

    /// Distance of two times that are one for the solver, s: its own measure.
    fn rounding_s(&self) -> f64 {
        let state = self.solver.state();
        100.0 * f64::EPSILON * (state.t.abs() + state.h.abs())
    }
}

impl<'a, 'm: 'a, S: OdeSolverMethod<'a, Equations<'m>>> Stepper for Wrapper<'a, 'm, S> {
    fn time_s(&self) -> f64 {
        self.solver.state().t
    }

    fn state(&self, out: &mut [f64]) {
        let state = self.solver.state();
        for (i, value) in out.iter_mut().enumerate() {
            *value = state.y.get_index(i);
        }
    }

    fn step(&mut self) -> Result<Step, String> {
        self.tell_stop()?;
        self.begin_s = self.solver.state().t;
        let reason = self.solver.step().map_err(|error| error.to_string())?;
        let is_reached = matches!(reason, OdeSolverStopReason::TstopReached);
        self.at_stop = is_reached || (self.solver.state().t - self.stop_s).abs() <= self.rounding_s();
        Ok(if self.at_stop { Step::Stop } else { Step::Internal })
    }

    fn set_stop(&mut self, t_s: f64) -> Result<(), String> {
        // One rounding beside each edge would add up until a step ends beyond the solver's own tolerance.
        if self.one_step && self.at_stop {
            *self.solver.state_mut().t = self.stop_s;
        }
        (self.stop_s, self.at_stop) = (t_s, false);
        if self.one_step {
            return self.solver.set_stop_time(t_s).map_err(|error| error.to_string());
        }
        Ok(())
    }

    fn interpolate(&mut self, t_s: f64, out: &mut [f64]) -> Result<(), String> {
        // A step that stopped at an edge may end one rounding beside it, and the next one begin there.
        let t = t_s.max(self.begin_s).min(self.solver.state().t);
        self.solver.interpolate_inplace(t, &mut self.buffer).map_err(|error| error.to_string())?;
        for (i, value) in out.iter_mut().enumerate() {
            *value = self.buffer.get_index(i);
        }
        Ok(())
    }

    fn back_to(&mut self, t_s: f64) -> Result<(), String> {
        self.solver.state_mut_back(t_s).map_err(|error| error.to_string())
    }

    fn restart(&mut self, t_s: f64, first_step_s: f64) {
        (&self.equations.rhs).call_inplace(self.solver.state().y, t_s, &mut self.rate);
        let state = self.solver.state_mut();
        state.dy.copy_from(&self.rate);
        *state.t = t_s;
        *state.h = first_step_s;
        self.at_stop = false;
    }

    fn statistics(&self) -> SolverStatistics {
        let s = self.solver.get_statistics();
        SolverStatistics {
            steps: s.number_of_steps,
            error_test_failures: s.number_of_error_test_failures,
            newton_iterations: s.number_of_nonlinear_solver_iterations,
            newton_failures: s.number_of_nonlinear_solver_fails,
            linear_solver_setups: s.number_of_linear_solver_setups,
            segments: 0,
            states: self.equations.init.x0.len(),
        }
    }
}

/// Build the solver and run `work` with it.
///
/// # Errors
/// The first evaluation fails, or `work` does.
pub(super) fn with_stepper<R>(
    model: &Model,
    drive: &Drive,
    x0: Vec<f64>,
    absolute_tolerance: Vec<f64>,
    settings: &SimulationSettings,
    work: impl FnOnce(&mut dyn Stepper) -> Result<R, ThermalError>,
) -> Result<R, ThermalError> {
    let n = x0.len();
    let rhs = Rhs::new(model, drive, &x0)?;
    let init = Init { x0, context: rhs.context };
    let context = rhs.context;
    let failed =
        |error: diffsol::error::DiffsolError| ThermalError::SolverSetup { reason: error.to_string() };
    let mut problem = OdeBuilder::<M>::new()
        .rtol(settings.relative_tolerance)
        .atol(absolute_tolerance)
        .h0(settings.first_step_s)
        .build_from_eqn(Equations { rhs, init })
        .map_err(failed)?;
    // Counted over the whole run by diffsol: a long run may have many, a stuck one ends at the smallest step.
    problem.ode_options.max_nonlinear_solver_failures = settings.maximum_steps;
    let (buffer, rate) = (V::zeros(n, context), V::zeros(n, context));
    let equations = &problem.eqn;
    let border = n - model.layout().mean_wall;
    let one_step = |tableau: Tableau<f64>| -> Result<Sdirk<'_, _, LS>, diffsol::DiffsolError> {
        let state = problem.rk_state_and_consistent::<LS>(&tableau)?;
        Sdirk::new(&problem, state, tableau, BorderedLu::new(border))
    };
    match settings.method {
        Method::TrBdf2 => {
            let solver = one_step(Tableau::tr_bdf2()).map_err(failed)?;
            work(&mut Wrapper::new(solver, equations, buffer, rate, true))
        }
        Method::Esdirk34 => {
            let solver = one_step(Tableau::esdirk34()).map_err(failed)?;
            work(&mut Wrapper::new(solver, equations, buffer, rate, true))
        }
        Method::Bdf => {
            let state = problem.bdf_state::<LS>().map_err(failed)?;
            let solver: Bdf<'_, _, LS> =
                Bdf::new(&problem, state, BorderedLu::new(border)).map_err(failed)?;
            work(&mut Wrapper::new(solver, equations, buffer, rate, false))
        }
    }
}

#[cfg(test)]
mod tests;
