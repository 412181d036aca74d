//! Flows that open and close, pressures that are crossed: the discrete part of a run.
use crate::ThermalError;
use crate::flow::{Flow, FlowKind};
use crate::model::inputs::Inputs;
use crate::model::{Margins, Model};
use crate::scenario::Scenario;
use crate::trajectory::EventKind;
use crate::units::ATMOSPHERE_PA;

/// Bisection steps: 2^-50 of a step.
const BISECTIONS: usize = 50;

/// What a flow is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Before its start time.
    Waiting,
    /// Started, waiting for its opening pressure.
    Armed,
    /// Gas flows.
    Open,
    /// Over for good.
    Closed,
}

/// Phases of all flows.
pub(super) struct FlowStates<'a> {
    flows: &'a [Flow],
    phases: Vec<Phase>,
}

/// Pressure at which a flow closes when it is reached from above, Pa.
fn closes_below_pa(flow: &Flow) -> Option<f64> {
    match flow.kind {
        FlowKind::Leak { .. } | FlowKind::LeakSeries { .. } => {
            Some(flow.closes_below_pa.unwrap_or(0.0).max(ATMOSPHERE_PA))
        }
        _ => flow.closes_below_pa,
    }
}

impl<'a> FlowStates<'a> {
    /// All waiting.
    pub(super) fn new(flows: &'a [Flow]) -> Self {
        Self { flows, phases: vec![Phase::Waiting; flows.len()] }
    }

    /// Which flows are open.
    pub(super) fn open(&self) -> Vec<bool> {
        self.phases.iter().map(|&phase| phase == Phase::Open).collect()
    }

    /// Open and close by the clock; returns what happened.
    pub(super) fn at_time(&mut self, time_s: f64, pressure_pa: f64) -> Vec<EventKind> {
        let mut happened = Vec::new();
        for (flow, phase) in self.flows.iter().zip(&mut self.phases) {
            if *phase == Phase::Waiting && time_s >= flow.start_s {
                *phase = Phase::Armed;
            }
            if *phase == Phase::Armed && flow.opens_above_pa.is_none_or(|limit| pressure_pa >= limit) {
                *phase = Phase::Open;
                happened.push(EventKind::FlowOpened { flow: flow.name.clone() });
            }
            let spent = closes_below_pa(flow).is_some_and(|limit| pressure_pa <= limit)
                || flow.closes_above_pa.is_some_and(|limit| pressure_pa >= limit);
            if *phase != Phase::Closed && (time_s >= flow.stop_s || (*phase == Phase::Open && spent)) {
                if *phase == Phase::Open {
                    happened.push(EventKind::FlowClosed { flow: flow.name.clone() });
                }
                *phase = Phase::Closed;
            }
        }
        happened
    }

    /// Open and close by the pressures that were crossed; returns what happened.
    pub(super) fn at_pressure(&mut self, fired: &[usize]) -> Vec<EventKind> {
        let mut happened = Vec::new();
        for &index in fired {
            let name = self.flows[index].name.clone();
            match self.phases[index] {
                Phase::Armed => {
                    self.phases[index] = Phase::Open;
                    happened.push(EventKind::FlowOpened { flow: name });
                }
                Phase::Open => {
                    self.phases[index] = Phase::Closed;
                    happened.push(EventKind::FlowClosed { flow: name });
                }
                Phase::Waiting | Phase::Closed => {}
            }
        }
        happened
    }
}

/// A quantity whose sign is watched.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Watch {
    /// Pressure minus a limit.
    Limit(f64),
    /// Pressure minus the opening pressure of an armed flow.
    Opens(usize, f64),
    /// Closing pressure, reached from above, of an open flow.
    ClosesBelow(usize, f64),
    /// Closing pressure, reached from below, of an open flow.
    ClosesAbove(usize, f64),
    /// Choking margin of an open orifice or valve.
    Choking(usize),
    /// What drives the gas through an open orifice or valve: where it changes its sign the flow begins or ends.
    ///
    /// A solver that steps over the end keeps the matrix of a stiff flow where nothing flows, takes its short corrections for
    /// convergence, and drifts. So it begins anew there.
    Driving(usize),
}

/// All watched quantities with their values at the start of the step.
pub(super) struct Monitors {
    watches: Vec<Watch>,
    names: Vec<String>,
    values: Vec<Option<f64>>,
    fired: Vec<usize>,
}

/// Dense output of the last step: state at a time, s.
pub(super) type Interpolation<'a> = dyn FnMut(f64, &mut [f64]) -> Result<(), String> + 'a;

/// What was found in a step.
pub(super) struct Located {
    /// Events to report, in order of time.
    pub reports: Vec<(f64, EventKind)>,
    /// Time of the first crossing that acts on a flow, or at which a flow begins or ends, s.
    pub acts_at_s: Option<f64>,
}

impl Monitors {
    /// Watches of a scenario.
    pub(super) fn new(scenario: &Scenario) -> Self {
        let mut watches: Vec<Watch> = scenario.pressure_limits_pa.iter().map(|&p| Watch::Limit(p)).collect();
        for (index, flow) in scenario.flows.iter().enumerate() {
            watches.extend(flow.opens_above_pa.map(|p| Watch::Opens(index, p)));
            watches.extend(closes_below_pa(flow).map(|p| Watch::ClosesBelow(index, p)));
            watches.extend(flow.closes_above_pa.map(|p| Watch::ClosesAbove(index, p)));
            if matches!(
                flow.kind,
                FlowKind::Orifice { .. } | FlowKind::Release { .. } | FlowKind::Supply { .. }
            ) {
                watches.extend([Watch::Choking(index), Watch::Driving(index)]);
            }
        }
        let names = scenario.flows.iter().map(|flow| flow.name.clone()).collect();
        Self { values: vec![None; watches.len()], watches, names, fired: Vec::new() }
    }

    /// Flows whose watch fired at the last crossing.
    pub(super) fn take_fired(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.fired)
    }

    /// Take the values at the start of a segment.
    pub(super) fn reset(
        &mut self,
        model: &Model,
        flows: &FlowStates<'_>,
        x: &[f64],
        inputs: &Inputs,
    ) -> Result<(), ThermalError> {
        self.values = self.evaluate(model, flows, x, inputs)?;
        Ok(())
    }

    /// Values of all watches; `None` where a watch does not apply now.
    fn evaluate(
        &self,
        model: &Model,
        flows: &FlowStates<'_>,
        x: &[f64],
        inputs: &Inputs,
    ) -> Result<Vec<Option<f64>>, ThermalError> {
        if self.watches.is_empty() {
            return Ok(Vec::new());
        }
        let pressure = model.gas_state(x)?.1;
        let open = flows.open();
        // Both watches of an opening stand side by side and need one throat.
        let mut known = None;
        let mut margins = |index: usize| -> Result<Option<Margins>, ThermalError> {
            if let Some((_, margins)) = known.filter(|&(of, _)| of == index) {
                return Ok(margins);
            }
            let margins = match flows.phases[index] {
                Phase::Open => model.margins(x, inputs, &open, index)?,
                _ => None,
            };
            known = Some((index, margins));
            Ok(margins)
        };
        self.watches
            .iter()
            .map(|watch| {
                let in_phase = |index: usize, phase: Phase| flows.phases[index] == phase;
                Ok(match *watch {
                    Watch::Limit(limit) => Some(pressure - limit),
                    Watch::Opens(i, limit) => in_phase(i, Phase::Armed).then_some(pressure - limit),
                    Watch::ClosesBelow(i, limit) | Watch::ClosesAbove(i, limit) => {
                        in_phase(i, Phase::Open).then_some(pressure - limit)
                    }
                    Watch::Choking(i) => margins(i)?.map(|margins| margins.choking_pa),
                    Watch::Driving(i) => margins(i)?.map(|margins| margins.driving_pa),
                })
            })
            .collect()
    }

    /// Compare with the values at the start of the step `[before, now]` and locate what changed its sign.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn crossed(
        &mut self,
        model: &Model,
        flows: &FlowStates<'_>,
        x_now: &[f64],
        before: f64,
        now: f64,
        inputs_at: &dyn Fn(f64) -> Inputs,
        scratch: &mut [f64],
        interpolate: &mut Interpolation<'_>,
    ) -> Result<Located, ThermalError> {
        let mut located = Located { reports: Vec::new(), acts_at_s: None };
        let values = self.evaluate(model, flows, x_now, &inputs_at(now))?;
        let mut acting: Vec<(f64, Option<usize>)> = Vec::new();
        for (index, (&old, &new)) in self.values.iter().zip(&values).enumerate() {
            let (Some(old), Some(new)) = (old, new) else { continue };
            let falling = old > 0.0 && new <= 0.0;
            let rising = old < 0.0 && new >= 0.0;
            let watch = self.watches[index];
            let applies = match watch {
                Watch::Limit(_) => falling || rising,
                Watch::Opens(..) | Watch::ClosesAbove(..) => rising,
                Watch::ClosesBelow(..) | Watch::Choking(_) => falling,
                Watch::Driving(_) => (old > 0.0) != (new > 0.0),
            };
            if !applies {
                continue;
            }
            let (mut low, mut high) = (before, now);
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (low + high);
                interpolate(middle, scratch).map_err(|reason| ThermalError::SolverSetup { reason })?;
                let value = self.evaluate(model, flows, scratch, &inputs_at(middle))?[index].unwrap_or(new);
                if (value > 0.0) == (old > 0.0) { low = middle } else { high = middle }
            }
            match watch {
                Watch::Limit(limit_pa) => {
                    located.reports.push((high, EventKind::PressureLimit { limit_pa, falling }));
                }
                Watch::Choking(flow) => {
                    located.reports.push((high, EventKind::Unchoked { flow: self.names[flow].clone() }));
                }
                Watch::Opens(flow, _) | Watch::ClosesBelow(flow, _) | Watch::ClosesAbove(flow, _) => {
                    acting.push((high, Some(flow)));
                }
                Watch::Driving(_) => acting.push((high, None)),
            }
        }
        self.values = values;
        located.acts_at_s = acting.iter().map(|&(t, _)| t).min_by(f64::total_cmp);
        if let Some(first) = located.acts_at_s {
            self.fired =
                acting.into_iter().filter(|&(t, _)| t <= first).filter_map(|(_, flow)| flow).collect();
            located.reports.retain(|&(t, _)| t <= first);
        }
        located.reports.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(located)
    }
}
