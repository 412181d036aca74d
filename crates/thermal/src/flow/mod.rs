//! Flows of gas into and out of the cylinder: leak, discharge, refill.
pub mod orifice;
#[cfg(feature = "simulate")]
pub(crate) mod valve;

#[cfg(feature = "simulate")]
use crate::ThermalError;
#[cfg(feature = "simulate")]
use crate::fluid::{Fluid, Real, State};
#[cfg(feature = "simulate")]
use crate::scenario::series::Series;
use alloc::string::String;

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

impl Flow {
    /// A flow that is open all the time, whatever the pressure.
    pub fn open(name: &str, kind: FlowKind) -> Self {
        Self {
            name: name.into(),
            kind,
            start_s: 0.0,
            stop_s: f64::INFINITY,
            opens_above_pa: None,
            closes_below_pa: None,
            closes_above_pa: None,
        }
    }
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
    /// Mass flow out of the cylinder that changes with time.
    #[cfg(feature = "simulate")]
    LeakSeries {
        /// Mass flow out, kg/s.
        mass_flow_kg_s: Series,
    },
    /// Flow out through an opening other than [`FlowKind::Orifice`], choked or not.
    #[cfg(feature = "simulate")]
    Release {
        /// What the gas passes.
        opening: Opening,
        /// Pressure behind it, Pa.
        back_pressure_pa: f64,
    },
    /// Mass flow into the cylinder that changes with time, or whose source does.
    #[cfg(feature = "simulate")]
    RefillSeries {
        /// Mass flow in, kg/s.
        mass_flow_kg_s: Series,
        /// Where the gas comes from; not a vessel, which such a flow might empty.
        source: Source,
        /// Bore of the inlet, m, as in [`FlowKind::Refill`].
        inlet_diameter_m: Option<f64>,
    },
    /// Flow in through an opening from a source of higher pressure, choked or not; nothing flows back.
    #[cfg(feature = "simulate")]
    Supply {
        /// What the gas passes.
        opening: Opening,
        /// Where the gas comes from.
        source: Source,
        /// Bore of the inlet, m, as in [`FlowKind::Refill`].
        inlet_diameter_m: Option<f64>,
    },
}

/// What gas passes from a higher to a lower pressure.
#[cfg(feature = "simulate")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opening {
    /// A hole with the throat of the real gas.
    Orifice {
        /// Bore, m.
        diameter_m: f64,
        /// Discharge coefficient.
        discharge_coefficient: f64,
    },
    /// A hole whose coefficient was found with the throat of an ideal gas. A run converts it at its first state.
    IdealGasOrifice {
        /// Bore, m.
        diameter_m: f64,
        /// Discharge coefficient that goes with an ideal gas.
        discharge_coefficient: f64,
    },
    /// A control valve after IEC 60534-2-1.
    Valve {
        /// Flow coefficient Kv, m³/h.
        kv_m3_h: f64,
        /// Pressure differential ratio factor `x_T`.
        x_t: f64,
    },
}

/// Where a refill comes from.
#[cfg(feature = "simulate")]
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Gas of a pressure and a temperature, whatever is taken.
    Supply {
        /// Temperature, K.
        temperature_k: Series,
        /// Pressure, Pa.
        pressure_pa: Series,
    },
    /// A rigid vessel that the gas is taken from.
    Vessel {
        /// Volume, m³.
        volume_m3: f64,
        /// Temperature at time 0, K.
        temperature_k: f64,
        /// Pressure at time 0, Pa.
        pressure_pa: f64,
        /// What its gas exchanges with its wall.
        process: SourceProcess,
    },
}

/// What the gas of a source vessel does while it expands.
#[cfg(feature = "simulate")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SourceProcess {
    /// No heat: what stays behind expands along its isentrope. Right for seconds.
    #[default]
    Adiabatic,
    /// The wall keeps its temperature. Right for hours.
    Isothermal,
}

/// Mass flow of an opening.
#[cfg(feature = "simulate")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OpeningFlow<D = f64> {
    /// Mass flow, kg/s.
    pub mass_flow_kg_s: D,
    /// Pressure behind the opening at and below which it chokes, Pa.
    pub choking_pressure_pa: f64,
}

#[cfg(feature = "simulate")]
impl Opening {
    /// Mass flow from a state at rest to a pressure; 0 against a higher one.
    ///
    /// # Errors
    /// An orifice without a throat state.
    pub(crate) fn flow<D: Real>(
        &self,
        fluid: &Fluid,
        upstream: &State<D>,
        downstream_pa: D,
    ) -> Result<OpeningFlow<D>, ThermalError> {
        match *self {
            Self::Orifice { diameter_m, discharge_coefficient } => {
                let flux = orifice::mass_flux_into(fluid, upstream, downstream_pa)?;
                let area_m2 = 0.25 * core::f64::consts::PI * diameter_m * diameter_m;
                Ok(OpeningFlow {
                    mass_flow_kg_s: flux.mass_flux_kg_m2_s * (discharge_coefficient * area_m2),
                    choking_pressure_pa: flux.critical_pressure_pa,
                })
            }
            Self::Valve { kv_m3_h, x_t } => Ok(valve::flow(fluid, upstream, downstream_pa, kv_m3_h, x_t)),
            Self::IdealGasOrifice { .. } => unreachable!("the model converts these coefficients"),
        }
    }
}

#[cfg(feature = "simulate")]
impl FlowKind {
    /// The discharge coefficient of an orifice with the throat of the real gas.
    pub fn discharge_coefficient_mut(&mut self) -> Option<&mut f64> {
        match self {
            Self::Orifice { discharge_coefficient, .. }
            | Self::Release { opening: Opening::Orifice { discharge_coefficient, .. }, .. }
            | Self::Supply { opening: Opening::Orifice { discharge_coefficient, .. }, .. } => {
                Some(discharge_coefficient)
            }
            _ => None,
        }
    }

    /// Whether gas enters by it.
    pub fn is_refill(&self) -> bool {
        matches!(self, Self::Refill { .. } | Self::RefillSeries { .. } | Self::Supply { .. })
    }

    /// Whether it is a refill whose jet stirs the gas.
    pub fn has_jet(&self) -> bool {
        self.inlet_diameter_m().is_some()
    }

    /// Bore of a refill's inlet, m, if it has a jet.
    pub(crate) fn inlet_diameter_m(&self) -> Option<f64> {
        match self {
            Self::Refill { inlet_diameter_m, .. }
            | Self::RefillSeries { inlet_diameter_m, .. }
            | Self::Supply { inlet_diameter_m, .. } => *inlet_diameter_m,
            _ => None,
        }
    }

    /// Everything of the flow that changes with time.
    pub(crate) fn series(&self) -> impl Iterator<Item = &Series> {
        let flow = match self {
            Self::LeakSeries { mass_flow_kg_s } | Self::RefillSeries { mass_flow_kg_s, .. } => {
                Some(mass_flow_kg_s)
            }
            _ => None,
        };
        let source = match self {
            Self::RefillSeries { source: Source::Supply { temperature_k, pressure_pa }, .. }
            | Self::Supply { source: Source::Supply { temperature_k, pressure_pa }, .. } => {
                [Some(temperature_k), Some(pressure_pa)]
            }
            _ => [None, None],
        };
        flow.into_iter().chain(source.into_iter().flatten())
    }
}
