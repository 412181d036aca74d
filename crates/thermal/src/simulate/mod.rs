//! Adaptive implicit simulation of a vessel through a scenario.
//!
//! The run is cut at every edge of an input and at every event that opens or closes a flow; between two cuts all
//! inputs are linear in time and the solver (diffsol) runs free. Samples come from its dense output; a
//! sample on a cut belongs to the interval that begins there. Events are located on the dense output by bisection.
mod bordered;
mod events;
mod samples;
mod solver;
mod stepped;
mod tangent;

use std::cell::{Cell, RefCell};

use crate::ThermalError;
use crate::model::Model;
use crate::model::inputs::{InputPieces, edges_s};
use crate::scenario::Scenario;
use crate::trajectory::{Event, EventKind, Ledger, SolverStatistics, Trajectory};
use crate::vessel::{GasResolution, Vessel};
use events::{FlowStates, Monitors};
use samples::Samples;
use solver::{Drive, Step, Stepper, with_stepper};
pub use stepped::Stepped;
pub use tangent::Neighbours;
use tangent::Tangents;

/// Integration method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Backward differentiation, order 1 to 5: fastest in every course and tolerance tried, with an edge each minute too.
    #[default]
    Bdf,
    /// One-step, order 2.
    TrBdf2,
    /// One-step, order 3 to 4.
    Esdirk34,
}

/// Settings of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulationSettings {
    /// Relative tolerance of every state, 1e-13 to 1e-2; the error of temperatures is 20 to 100 times the absolute one.
    pub relative_tolerance: f64,
    /// Absolute tolerance of temperatures, K; by default 100 K times the relative tolerance.
    pub absolute_tolerance_k: Option<f64>,
    /// Integration method.
    pub method: Method,
    /// First step after a start or a jump, s.
    pub first_step_s: f64,
    /// Steps after which a run is given up.
    pub maximum_steps: usize,
    /// Fill gas in layers, though no model of it holds; false by default. For gas that only has to differ from that of an observer.
    pub fills_layers: bool,
}

impl Default for SimulationSettings {
    fn default() -> Self {
        Self {
            relative_tolerance: 1e-6,
            absolute_tolerance_k: None,
            method: Method::Bdf,
            first_step_s: 0.1,
            maximum_steps: 20_000_000,
            fills_layers: false,
        }
    }
}

/// Mean wall temperature that scales the ledger's tolerance, K.
const LEDGER_SCALE_K: f64 = 300.0;
/// Reynolds number that scales the tolerance of the gas's motion: jets of fills have 1e4 to 1e6.
const STIRRING_SCALE_RE: f64 = 1e4;
/// Edges so close to each other, relative to their time, are one: a rounding lies between them.
const SAME_EDGE: f64 = 1e3 * f64::EPSILON;

impl SimulationSettings {
    /// Check the settings.
    ///
    /// # Errors
    /// A value is outside its range.
    pub fn validate(&self) -> Result<(), ThermalError> {
        let check = |setting: &'static str, value: f64, low: f64, high: f64| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(ThermalError::Setting { setting, value, low, high })
            }
        };
        check("relative_tolerance", self.relative_tolerance, 1e-13, 1e-2)?;
        check("absolute_tolerance_k", self.absolute_tolerance_k.unwrap_or(1e-4), 1e-12, 1.0)?;
        check("first_step_s", self.first_step_s, 1e-9, 1e4)
    }

    fn admit(&self, vessel: &Vessel, scenario: &Scenario) -> Result<(), ThermalError> {
        let has_layers = matches!(vessel.gas, GasResolution::Stratified(gas) if gas.cells > 1);
        match scenario.flows.iter().find(|flow| flow.kind.is_refill()) {
            Some(refill) if has_layers && !self.fills_layers => {
                Err(ThermalError::FillOfLayers { flow: refill.name.clone() })
            }
            _ => Ok(()),
        }
    }
}

/// Run a scenario.
///
/// `progress` is called now and then with the fraction that is done, 0 to 1.
///
/// # Errors
/// Settings out of range; a refill of stratified gas; an initial or later gas state that is two-phase or outside the equation of
/// state, with the time and state at which it happened; a solver that cannot go on.
pub fn simulate(
    vessel: &Vessel,
    scenario: &Scenario,
    settings: &SimulationSettings,
    progress: &mut dyn FnMut(f64),
) -> Result<Trajectory, ThermalError> {
    simulate_while(vessel, scenario, settings, &mut |done| {
        progress(done);
        true
    })
}

/// [`simulate`] as long as it may go on: `going` is asked after each step of the solver, with the fraction that is done.
///
/// # Errors
/// As [`simulate`]; [`ThermalError::Stopped`].
pub fn simulate_while(
    vessel: &Vessel,
    scenario: &Scenario,
    settings: &SimulationSettings,
    going: &mut dyn FnMut(f64) -> bool,
) -> Result<Trajectory, ThermalError> {
    Ok(run(vessel, scenario, &[], settings, going)?.0)
}

/// A run with its neighbours to first order, below and above, for sensitivities: half of their difference is the
/// derivative times the half distance of the parameter. Their events, ledger and statistics are those of the run itself.
///
/// Derivatives are as precise as the run's tolerance times some hundred, and as the square of the distance. `going` is asked as by
/// [`simulate_while`].
///
/// # Errors
/// As [`simulate_while`]; a neighbour whose mesh or number of gas cells differs.
pub fn simulate_with_neighbours(
    vessel: &Vessel,
    scenario: &Scenario,
    neighbours: &[Neighbours],
    settings: &SimulationSettings,
    going: &mut dyn FnMut(f64) -> bool,
) -> Result<(Trajectory, Vec<[Trajectory; 2]>), ThermalError> {
    run(vessel, scenario, neighbours, settings, going)
}

fn run(
    vessel: &Vessel,
    scenario: &Scenario,
    neighbours: &[Neighbours],
    settings: &SimulationSettings,
    going: &mut dyn FnMut(f64) -> bool,
) -> Result<WithNeighbours, ThermalError> {
    settings.validate()?;
    settings.admit(vessel, scenario)?;
    let model = Model::new(vessel, scenario)?;
    let x = model.initial_state(vessel, &scenario.initial)?;
    let absolute = absolute_tolerances(&model, vessel, &x, settings);
    let course = Course { vessel, scenario, model: &model, settings };
    Ok(course.run(Start { x, absolute }, neighbours, going)?.0)
}

/// State that a run begins with, and the tolerances of its states.
struct Start {
    x: Vec<f64>,
    absolute: Vec<f64>,
}

/// What a run goes through.
struct Course<'a> {
    vessel: &'a Vessel,
    scenario: &'a Scenario,
    model: &'a Model,
    settings: &'a SimulationSettings,
}

/// A run with its neighbours.
type WithNeighbours = (Trajectory, Vec<[Trajectory; 2]>);

impl Course<'_> {
    /// The run, and the state at its end.
    fn run(
        &self,
        start: Start,
        neighbours: &[Neighbours],
        going: &mut dyn FnMut(f64) -> bool,
    ) -> Result<(WithNeighbours, Vec<f64>), ThermalError> {
        let Self { vessel, scenario, model, settings } = *self;
        let Start { x: x0, absolute } = start;
        let edges = edges_s(scenario);
        let tangents = match neighbours {
            [] => None,
            _ => Some(Tangents::new(neighbours, model, edges[0])?),
        };
        let drive = Drive {
            pieces: Cell::new(InputPieces::new(scenario, 0.0, edges[0])),
            open: RefCell::new(vec![false; scenario.flows.len()]),
            failure: RefCell::new(None),
        };
        let mut run = Run {
            model,
            scenario,
            drive: &drive,
            settings,
            flows: FlowStates::new(&scenario.flows),
            monitors: Monitors::new(scenario),
            samples: Samples::new(scenario),
            events: Vec::new(),
            segments: 0,
            x: x0.clone(),
            tangents,
            going,
        };
        let statistics = with_stepper(model, &drive, x0.clone(), absolute, settings, |stepper| {
            run.all_segments(stepper, &edges)?;
            Ok(SolverStatistics { segments: run.segments, ..stepper.statistics() })
        })?;
        let end = run.x.clone();
        let ledger = ledger(model, &x0, &end);
        Ok((run.into_trajectories(vessel, ledger, statistics), end))
    }
}

/// Tolerances in the states' own units: kelvin for the wall, the same error in kelvin for the gas energy.
fn absolute_tolerances(
    model: &Model,
    vessel: &Vessel,
    x0: &[f64],
    settings: &SimulationSettings,
) -> Vec<f64> {
    let layout = model.layout();
    let kelvin = settings.absolute_tolerance_k.unwrap_or(100.0 * settings.relative_tolerance);
    let heat = settings.relative_tolerance * model.wall_capacity_j_k() * LEDGER_SCALE_K;
    let mass: f64 = model.mass_kg(x0);
    let mut absolute = vec![kelvin; layout.states];
    let cv = 2.5 * vessel.fluid.specific_gas_constant_j_kg_k();
    for cell in 0..layout.gas {
        absolute[layout.mass + cell] = settings.relative_tolerance * x0[layout.mass + cell];
        absolute[layout.energy + cell] = kelvin * cv * x0[layout.mass + cell];
    }
    absolute[layout.heat_in] = heat;
    absolute[layout.enthalpy_in] = heat;
    absolute[layout.work_out] = heat;
    absolute[layout.mass_in] = settings.relative_tolerance * mass;
    for (tolerance, source_kg) in absolute[layout.drawn..].iter_mut().zip(model.source_masses_kg()) {
        *tolerance = settings.relative_tolerance * source_kg;
    }
    if let Some(stirring) = layout.stirring {
        absolute[stirring] = settings.relative_tolerance * STIRRING_SCALE_RE;
    }
    absolute
}

fn ledger(model: &Model, start: &[f64], end: &[f64]) -> Ledger {
    let layout = model.layout();
    let gained = |index: usize| end[index] - start[index];
    Ledger {
        mass_start_kg: model.mass_kg(start),
        mass_end_kg: model.mass_kg(end),
        mass_in_kg: gained(layout.mass_in),
        energy_start_j: model.energy_j(start),
        energy_end_j: model.energy_j(end),
        heat_in_j: gained(layout.heat_in),
        enthalpy_in_j: gained(layout.enthalpy_in),
        work_out_j: gained(layout.work_out),
        energy_scale_j: gained(layout.heat_in).abs()
            + gained(layout.enthalpy_in).abs()
            + gained(layout.work_out).abs()
            + (model.energy_j(end) - model.energy_j(start)).abs(),
    }
}

/// A run in progress.
struct Run<'a> {
    model: &'a Model,
    scenario: &'a Scenario,
    drive: &'a Drive,
    settings: &'a SimulationSettings,
    flows: FlowStates<'a>,
    monitors: Monitors,
    samples: Samples,
    events: Vec<Event>,
    segments: usize,
    /// Current state.
    x: Vec<f64>,
    /// Neighbours, if there are any.
    tangents: Option<Tangents>,
    /// Whether it may go on.
    going: &'a mut dyn FnMut(f64) -> bool,
}

impl Run<'_> {
    fn all_segments(&mut self, stepper: &mut dyn Stepper, edges: &[f64]) -> Result<(), ThermalError> {
        self.report_start()?;
        let mut from = 0.0;
        for &to in edges {
            // No solver steps over a rounding; what begins here begins with the next segment.
            if to - from <= SAME_EDGE * to {
                from = to;
                continue;
            }
            let jumped = self.begin_segment(from, to)?;
            if jumped || from == 0.0 {
                stepper.restart(from, self.settings.first_step_s.min(to - from));
            }
            self.segment(stepper, to)?;
            from = to;
        }
        self.sample_until(stepper, self.scenario.duration_s, true)
    }

    /// A run that begins below a limit says so.
    fn report_start(&mut self) -> Result<(), ThermalError> {
        let pressure_pa = self.pressure(0.0)?;
        for &limit_pa in self.scenario.pressure_limits_pa.iter().filter(|&&limit| pressure_pa <= limit) {
            let kind = EventKind::PressureLimit { limit_pa, falling: true };
            let event = self.event(0.0, kind, &self.x)?;
            self.events.push(event);
        }
        Ok(())
    }

    /// Set the inputs of `[from, to]`, open and close flows by the clock; true if anything jumped.
    fn begin_segment(&mut self, from: f64, to: f64) -> Result<bool, ThermalError> {
        self.segments += 1;
        let before = self.drive.pieces.get().at(from);
        self.drive.pieces.set(InputPieces::new(self.scenario, from, to));
        if let Some(tangents) = &mut self.tangents {
            tangents.begin_segment(from, to);
        }
        let jumped = self.drive.pieces.get().at(from).jumped_from(&before, &self.scenario.flows);
        let changed = self.flows.at_time(from, self.pressure(from)?);
        Ok(self.record_flows(from, changed)? || jumped)
    }

    /// Integrate to `to` with the inputs as they are; flow events restart the solver in between.
    fn segment(&mut self, stepper: &mut dyn Stepper, to: f64) -> Result<(), ThermalError> {
        self.arm(stepper.time_s(), stepper, to)?;
        loop {
            let before = stepper.time_s();
            let step = match stepper.step() {
                Ok(step) => step,
                Err(reason) => return Err(self.cannot_go_on(before, reason)),
            };
            stepper.state(&mut self.x);
            let now = if step == Step::Stop { to } else { stepper.time_s() };
            self.check(now, stepper.statistics().steps)?;
            if !(self.going)(now / self.scenario.duration_s) {
                return Err(ThermalError::Stopped { time_s: now });
            }
            if let Some(at) = self.locate_events(stepper, before, now)? {
                self.advance_tangents(stepper, before, at)?;
                self.sample_until(stepper, at, false)?;
                stepper.back_to(at).map_err(|reason| self.cannot_go_on(at, reason))?;
                stepper.state(&mut self.x);
                self.switch_flows(at)?;
                stepper.restart(at, self.settings.first_step_s.min(to - at).max(1e-9));
                if at >= to {
                    return Ok(());
                }
                self.arm(at, stepper, to)?;
                continue;
            }
            self.advance_tangents(stepper, before, now)?;
            self.sample_until(stepper, now, false)?;
            if step == Step::Stop {
                return Ok(());
            }
        }
    }

    fn advance_tangents(
        &mut self,
        stepper: &mut dyn Stepper,
        before: f64,
        now: f64,
    ) -> Result<(), ThermalError> {
        let Some(tangents) = &mut self.tangents else { return Ok(()) };
        tangents
            .advance(self.model, self.drive, (before, now), &mut |t, x| stepper.interpolate(t, x))
            .map_err(|error| error.at_time(now))
    }

    /// Open and close the flows whose pressure was reached; neighbours do so a little earlier or later.
    fn switch_flows(&mut self, at: f64) -> Result<(), ThermalError> {
        let fired = self.monitors.take_fired();
        // A flow that ends by itself changes no rate.
        if fired.is_empty() {
            return Ok(());
        }
        let inputs = self.drive.pieces.get().at(at);
        let delays = self
            .tangents
            .as_ref()
            .map(|tangents| tangents.delays(self.model, &inputs, &self.drive.open.borrow(), &self.x));
        let changed = self.flows.at_pressure(&fired);
        self.record_flows(at, changed)?;
        if let (Some(delays), Some(tangents)) = (delays.transpose()?, &mut self.tangents) {
            tangents.jump(&delays, self.model, &inputs, &self.drive.open.borrow(), &self.x)?;
        }
        Ok(())
    }

    fn arm(&mut self, now: f64, stepper: &mut dyn Stepper, to: f64) -> Result<(), ThermalError> {
        stepper.set_stop(to).map_err(|reason| self.cannot_go_on(now, reason))?;
        let inputs = self.drive.pieces.get().at(now);
        self.monitors.reset(self.model, &self.flows, &self.x, &inputs).map_err(|error| error.at_time(now))
    }

    /// Record what was crossed in the last step; returns the time of the first crossing that acts on a flow.
    fn locate_events(
        &mut self,
        stepper: &mut dyn Stepper,
        before: f64,
        now: f64,
    ) -> Result<Option<f64>, ThermalError> {
        let mut x = self.x.clone();
        let pieces = self.drive.pieces.get();
        let mut interpolate = |t: f64, x: &mut [f64]| stepper.interpolate(t, x);
        let located = self
            .monitors
            .crossed(
                self.model,
                &self.flows,
                &self.x,
                before,
                now,
                &|t| pieces.at(t),
                &mut x,
                &mut interpolate,
            )
            .map_err(|error| error.at_time(now))?;
        for (time_s, kind) in located.reports {
            interpolate(time_s, &mut x).map_err(|reason| self.cannot_go_on(time_s, reason))?;
            let event = self.event(time_s, kind, &x)?;
            self.events.push(event);
        }
        Ok(located.acts_at_s)
    }

    fn record_flows(&mut self, time_s: f64, changed: Vec<EventKind>) -> Result<bool, ThermalError> {
        let any = !changed.is_empty();
        for kind in changed {
            let event = self.event(time_s, kind, &self.x)?;
            self.events.push(event);
        }
        self.drive.open.borrow_mut().clone_from(&self.flows.open());
        Ok(any)
    }

    fn event(&self, time_s: f64, kind: EventKind, x: &[f64]) -> Result<Event, ThermalError> {
        let (gas_mean_k, pressure_pa) = self.model.gas_state(x).map_err(|error| error.at_time(time_s))?;
        Ok(Event { time_s, kind, pressure_pa, gas_mean_k })
    }

    fn pressure(&self, time_s: f64) -> Result<f64, ThermalError> {
        Ok(self.model.gas_state(&self.x).map_err(|error| error.at_time(time_s))?.1)
    }

    /// Emit the samples before `until` (the one at `until` too when `inclusive`).
    fn sample_until(
        &mut self,
        stepper: &mut dyn Stepper,
        until: f64,
        inclusive: bool,
    ) -> Result<(), ThermalError> {
        while let Some(t) = self.samples.next_time(until, inclusive) {
            let mut x = self.x.clone();
            if t < stepper.time_s() {
                stepper.interpolate(t, &mut x).map_err(|reason| self.cannot_go_on(t, reason))?;
            }
            let inputs = self.drive.pieces.get().at(t);
            let open = self.drive.open.borrow();
            let output = self.model.output(&x, &inputs, &open).map_err(|error| error.at_time(t))?;
            self.samples.push(t, inputs.air_k, output);
            if let Some(tangents) = &mut self.tangents {
                tangents.sample(t, &x, &open).map_err(|error| error.at_time(t))?;
            }
        }
        Ok(())
    }

    /// An accepted state must be finite and its gas inside the domain.
    fn check(&self, time_s: f64, steps: usize) -> Result<(), ThermalError> {
        if self.x.iter().any(|value| !value.is_finite()) {
            return Err(self.cannot_go_on(time_s, "the state is not finite".into()));
        }
        if steps > self.settings.maximum_steps {
            return Err(self.cannot_go_on(time_s, format!("more than {steps} steps")));
        }
        self.model.check_gas(&self.x).map_err(|error| error.at_time(time_s))
    }

    fn cannot_go_on(&self, time_s: f64, reason: String) -> ThermalError {
        if let Some(cause) = self.drive.failure.borrow_mut().take() {
            return cause.at_time(time_s);
        }
        let (gas_k, pressure_pa) = self.model.gas_state(&self.x).unwrap_or((f64::NAN, f64::NAN));
        ThermalError::Integration { time_s, gas_k, pressure_pa, reason }
    }

    /// The run and its neighbours.
    fn into_trajectories(
        self,
        vessel: &Vessel,
        ledger: Ledger,
        statistics: SolverStatistics,
    ) -> WithNeighbours {
        let run = Trajectory {
            ledger,
            statistics,
            ..self.samples.into_trajectory(vessel, self.scenario, self.model)
        };
        let neighbours = self.tangents.into_iter().flat_map(Tangents::into_trajectories);
        let neighbours = neighbours.map(|pair| {
            pair.map(|side| Trajectory { events: self.events.clone(), ledger, statistics, ..side })
        });
        let neighbours = neighbours.collect();
        (Trajectory { events: self.events, ..run }, neighbours)
    }
}
