//! Flows of gas into and out of the cylinder: leak, discharge, refill.
pub mod orifice;

/// A flow with the times and conditions at which it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// Name for people and events, e.g. `leak`.
    pub name: String,
    /// What drives it.
    pub kind: FlowKind,
    /// It can run from this time, s.
    pub start_s: f64,
    /// It cannot run from this time on, s; infinity: until the end.
    pub stop_s: f64,
    /// It opens when the cylinder's pressure rises to this value, Pa (a relief device); `None`: open from the start time.
    pub opens_above_pa: Option<f64>,
    /// It closes for good when the cylinder's pressure has fallen to this value, Pa.
    pub closes_below_pa: Option<f64>,
    /// It closes for good when the cylinder's pressure has risen to this value, Pa (end of a refill).
    pub closes_above_pa: Option<f64>,
}

/// What drives a flow.
#[derive(Clone, Debug, PartialEq)]
pub enum FlowKind {
    /// Constant mass flow out of the cylinder.
    Leak {
        /// Mass flow out, kg/s.
        mass_flow_kg_s: f64,
    },
    /// Flow out through an orifice, choked or not.
    Orifice {
        /// Bore, m.
        diameter_m: f64,
        /// Discharge coefficient.
        discharge_coefficient: f64,
        /// Pressure behind it, Pa.
        back_pressure_pa: f64,
    },
    /// Constant mass flow into the cylinder from a source.
    Refill {
        /// Mass flow in, kg/s.
        mass_flow_kg_s: f64,
        /// Temperature of the source, K.
        source_temperature_k: f64,
        /// Pressure of the source, Pa; with the temperature it fixes the enthalpy that flows in.
        source_pressure_pa: f64,
        /// Bore of the inlet, m: its jet adds forced convection inside (Woodfield); `None`: no jet.
        inlet_diameter_m: Option<f64>,
    },
}
