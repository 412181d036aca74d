//! Flows of gas that are simulated: fast losses, discharges, refills, leaks too large to be laid over.
//!
//! What is let out goes through an orifice or at a constant rate, either for half of the seeds. An orifice that loses the part `x` of
//! the gas within `t` while the flow stays choked has, for a flow proportional to the mass, `m' = -m ln(1/(1 - x))/t` at its opening;
//! the cooling of the gas makes it a little slower. A loss that goes on stops where a fifth of the pressure is left.
use cylwatch_thermal::flow::orifice::mass_flux;
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::fluid::State;
use cylwatch_thermal::units::{ATMOSPHERE_PA, HOUR_S};
use serde::{Deserialize, Serialize};

use super::{Leak, Overlay, WorldError};
use crate::random::{Purpose, Random};
use crate::thermal::vessel::Vessel;

const DISCHARGE_COEFFICIENT: f64 = 0.8;
/// Pressure at which a loss that goes on stops, of that of the fill.
const REMAINING_PRESSURE: f64 = 0.2;
/// Source of a refill: this much above the fill.
const SOURCE: f64 = 1.1;
const SOURCE_K: f64 = 288.15;
/// Temperature that an orifice is sized for, K.
const SIZING_TEMPERATURE_K: f64 = 288.15;

/// Names of the flows of overlays; processes of the fault table have others.
pub(super) const LEAK: &str = "steady leak";
pub(super) const FAST_LOSS: &str = "fast loss";
pub(super) const DISCHARGE: &str = "ordered discharge";
pub(super) const REFILL: &str = "ordered refill";

/// A leak of constant mass flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SteadyLeak {
    /// Mass flow out, kg/s.
    pub rate_kg_s: f64,
    /// When it begins, s.
    pub onset_s: f64,
}

impl SteadyLeak {
    /// Mass that has left until a time, kg.
    pub fn lost_kg(&self, t_s: f64) -> f64 {
        self.rate_kg_s * (t_s - self.onset_s).max(0.0)
    }

    /// Its flow by the clock of the simulation.
    pub(super) fn flow(&self) -> Flow {
        flow(LEAK, (self.onset_s, f64::INFINITY), FlowKind::Leak { mass_flow_kg_s: self.rate_kg_s })
    }
}

/// What flows are made for.
pub(super) struct Filled<'a> {
    /// Bore through which it is filled, m.
    pub inlet_m: f64,
    pub vessel: &'a Vessel,
    pub seed: u64,
    /// Pressure of the fill at 15 °C, Pa.
    pub pressure_pa: f64,
    /// Mass at the beginning, kg.
    pub mass_kg: f64,
    /// Beginning of the log by the clock of the simulation, s.
    pub lead_s: f64,
}

impl Filled<'_> {
    /// The simulated flows of an overlay.
    pub(super) fn flows(&self, overlay: &Overlay) -> Result<Vec<Flow>, WorldError> {
        Ok(match *overlay {
            Overlay::Leak { .. } | Overlay::Fault { .. } => {
                overlay.leak().map(|leak| self.leak(&leak)).into_iter().collect()
            }
            Overlay::FastLoss { part, within_s, onset_s, goes_on } => {
                vec![self.loss(FAST_LOSS, part, within_s, onset_s, goes_on)?]
            }
            Overlay::Discharge { part, within_s, onset_s, .. } => {
                vec![self.loss(DISCHARGE, part, within_s, onset_s, false)?]
            }
            Overlay::Refill { part, within_s, onset_s } => {
                let kind = FlowKind::Refill {
                    mass_flow_kg_s: part * self.mass_kg / within_s,
                    source_temperature_k: SOURCE_K,
                    source_pressure_pa: SOURCE * self.pressure_pa * (1.0 + part),
                    inlet_diameter_m: Some(self.inlet_m),
                };
                vec![self.flow(REFILL, (onset_s, onset_s + within_s), kind)]
            }
            Overlay::Nothing => Vec::new(),
        })
    }

    fn leak(&self, leak: &Leak) -> Flow {
        let rate_kg_s = leak.part_per_h * self.mass_kg / HOUR_S;
        let open = SteadyLeak { rate_kg_s, onset_s: leak.onset_s + self.lead_s }.flow();
        Flow { closes_below_pa: Some(self.least_pa()), ..open }
    }

    /// Pressure at which what goes on stops, Pa.
    fn least_pa(&self) -> f64 {
        (REMAINING_PRESSURE * self.pressure_pa).max(1.5 * ATMOSPHERE_PA)
    }

    fn loss(
        &self,
        name: &str,
        part: f64,
        within_s: f64,
        onset_s: f64,
        goes_on: bool,
    ) -> Result<Flow, WorldError> {
        let through_orifice = Random::new(self.seed, Purpose::WorldFlow).happens(0.5);
        let kind = if through_orifice {
            FlowKind::Orifice {
                diameter_m: self.bore_m(part, within_s)?,
                discharge_coefficient: DISCHARGE_COEFFICIENT,
                back_pressure_pa: ATMOSPHERE_PA,
            }
        } else {
            FlowKind::Leak { mass_flow_kg_s: part * self.mass_kg / within_s }
        };
        let stop_s = if goes_on { f64::INFINITY } else { onset_s + within_s };
        let open = self.flow(name, (onset_s, stop_s), kind);
        Ok(Flow { closes_below_pa: Some(self.least_pa()), ..open })
    }

    /// Bore that loses a part of the gas within a time, m.
    fn bore_m(&self, part: f64, within_s: f64) -> Result<f64, WorldError> {
        let density =
            self.vessel.fluid.density_from_pressure_temperature(self.pressure_pa, SIZING_TEMPERATURE_K)?;
        let stagnation: State<f64> = self.vessel.fluid.checked_state(density, SIZING_TEMPERATURE_K)?;
        let flux = mass_flux(&self.vessel.fluid, &stagnation, ATMOSPHERE_PA)?.mass_flux_kg_m2_s;
        let rate_kg_s = -self.mass_kg * (1.0 - part).ln() / within_s;
        let area_m2 = rate_kg_s / (DISCHARGE_COEFFICIENT * flux);
        Ok((4.0 * area_m2 / std::f64::consts::PI).sqrt())
    }

    fn flow(&self, name: &str, (start_s, stop_s): (f64, f64), kind: FlowKind) -> Flow {
        flow(name, (start_s + self.lead_s, stop_s + self.lead_s), kind)
    }
}

/// A flow between two times by the clock of the simulation, s.
pub(super) fn flow(name: &str, (start_s, stop_s): (f64, f64), kind: FlowKind) -> Flow {
    Flow {
        name: name.into(),
        kind,
        start_s,
        stop_s,
        opens_above_pa: None,
        closes_below_pa: None,
        closes_above_pa: None,
    }
}
