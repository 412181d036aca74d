//! Where the gas of a refill comes from, as the model needs it.
//!
//! A source vessel is rigid and gives gas of its own state. What stays in it keeps its temperature or its entropy, so one state of the
//! model, the mass that was drawn, fixes it: `rho = (m_0 - drawn)/V` with `T` or with `s(rho, T) = s_0`. Its energy needs no balance of its own.
use crate::ThermalError;
use crate::flow::{Flow, FlowKind, Source, SourceProcess};
use crate::fluid::{Fluid, Real, State};
use crate::scenario::Series;

use super::inputs::Moment;

const MAX_ITERATIONS: usize = 60;

/// The source of one refill.
#[derive(Clone, Debug)]
pub(super) enum Supply {
    /// Gas of one state.
    Fixed { state: Box<State> },
    /// Gas of a temperature, K, and pressure, Pa, that change.
    Changing { temperature_k: Series, pressure_pa: Series },
    /// A vessel.
    Vessel(SourceVessel),
}

/// A vessel that gas is drawn from.
#[derive(Clone, Copy, Debug)]
pub(super) struct SourceVessel {
    /// Its place among the source vessels.
    pub place: usize,
    volume_m3: f64,
    /// Mass at time 0, kg.
    pub mass_kg: f64,
    temperature_k: f64,
    /// Kept where the gas takes no heat, J/(kg K); `None`: it keeps its temperature.
    entropy_j_kg_k: Option<f64>,
}

/// The sources of all flows; `None` for flows out. Also the number of source vessels.
///
/// # Errors
/// A source is outside the fluid's domain.
pub(super) fn supplies(fluid: &Fluid, flows: &[Flow]) -> Result<(Vec<Option<Supply>>, usize), ThermalError> {
    let mut vessels = 0;
    let mut supplies = Vec::with_capacity(flows.len());
    for flow in flows {
        let supply = supply(fluid, flow, &mut vessels)
            .map_err(|cause| ThermalError::Source { flow: flow.name.clone(), cause: Box::new(cause) })?;
        supplies.push(supply);
    }
    Ok((supplies, vessels))
}

fn supply(fluid: &Fluid, flow: &Flow, vessels: &mut usize) -> Result<Option<Supply>, ThermalError> {
    let checked = |p: f64, t: f64| fluid.checked_state(fluid.density_from_pressure_temperature(p, t)?, t);
    let source = match &flow.kind {
        FlowKind::Refill { source_temperature_k: t, source_pressure_pa: p, .. } => {
            return Ok(Some(Supply::Fixed { state: Box::new(checked(*p, *t)?) }));
        }
        FlowKind::RefillSeries { source, .. } | FlowKind::Supply { source, .. } => source,
        FlowKind::Leak { .. }
        | FlowKind::Orifice { .. }
        | FlowKind::LeakSeries { .. }
        | FlowKind::Release { .. } => return Ok(None),
    };
    Ok(Some(match source {
        Source::Supply { temperature_k, pressure_pa } => {
            let ((t, hottest), (p, highest)) = (temperature_k.range(), pressure_pa.range());
            if t == hottest && p == highest {
                return Ok(Some(Supply::Fixed { state: Box::new(checked(p, t)?) }));
            }
            for time_s in temperature_k.edges_s().chain(pressure_pa.edges_s()) {
                checked(pressure_pa.at(time_s), temperature_k.at(time_s))
                    .map_err(|error| error.at_time(time_s))?;
            }
            Supply::Changing { temperature_k: temperature_k.clone(), pressure_pa: pressure_pa.clone() }
        }
        &Source::Vessel { volume_m3, temperature_k, pressure_pa, process } => {
            let state = checked(pressure_pa, temperature_k)?;
            let place = *vessels;
            *vessels += 1;
            Supply::Vessel(SourceVessel {
                place,
                volume_m3,
                mass_kg: state.density_kg_m3 * volume_m3,
                temperature_k,
                entropy_j_kg_k: (process == SourceProcess::Adiabatic).then_some(state.entropy_j_kg_k),
            })
        }
    }))
}

impl Supply {
    /// State of the gas at the source; `drawn_kg` is what a vessel has given.
    ///
    /// # Errors
    /// A vessel has given more than it had, or changing gas leaves the fluid's domain.
    pub(super) fn state<D: Real>(
        &self,
        fluid: &Fluid,
        moment: &Moment,
        drawn_kg: D,
    ) -> Result<State<D>, ThermalError> {
        match self {
            Self::Fixed { state } => {
                Ok(fluid.state(D::from(state.density_kg_m3), D::from(state.temperature_k)))
            }
            Self::Changing { temperature_k, pressure_pa } => {
                let (t, p) = (moment.value(temperature_k), moment.value(pressure_pa));
                let rho = fluid.density_from_pressure_temperature(p, t)?;
                Ok(fluid.state(D::from(rho), D::from(t)))
            }
            Self::Vessel(vessel) => vessel.state(fluid, drawn_kg),
        }
    }

    /// Enthalpy of the gas at the source, J/kg.
    ///
    /// # Errors
    /// As [`Supply::state`].
    pub(super) fn enthalpy_j_kg<D: Real>(
        &self,
        fluid: &Fluid,
        moment: &Moment,
        drawn_kg: D,
    ) -> Result<D, ThermalError> {
        match self {
            Self::Fixed { state } => Ok(D::from(state.enthalpy_j_kg)),
            _ => Ok(self.state(fluid, moment, drawn_kg)?.enthalpy_j_kg),
        }
    }
}

impl SourceVessel {
    /// State of its gas after so much was drawn, kg.
    ///
    /// # Errors
    /// It had less.
    pub(super) fn state<D: Real>(&self, fluid: &Fluid, drawn_kg: D) -> Result<State<D>, ThermalError> {
        let rho = (-drawn_kg + self.mass_kg) / self.volume_m3;
        let none = || ThermalError::NoGasState { mass_kg: self.mass_kg - drawn_kg.re(), energy_j: f64::NAN };
        if rho.re() <= 0.0 || !rho.re().is_finite() {
            return Err(none());
        }
        let Some(entropy) = self.entropy_j_kg_k else {
            return Ok(fluid.state(rho, D::from(self.temperature_k)));
        };
        let mut t = self.temperature_k;
        for _ in 0..MAX_ITERATIONS {
            let at = fluid.state(rho.re(), t);
            // (ds/dT)_rho = cv/T
            let step = (at.entropy_j_kg_k - entropy) / at.cv_j_kg_k;
            t *= (-step).clamp(-0.3, 0.3).exp();
            if step.abs() < 1e-13 {
                break;
            }
        }
        if !t.is_finite() {
            return Err(none());
        }
        // One more step carries the derivatives.
        let at = fluid.state(rho, D::from(t));
        let t = (-((at.entropy_j_kg_k - entropy) / at.cv_j_kg_k)).exp() * t;
        Ok(fluid.state(rho, t))
    }
}
