//! Discharge coefficients that were found with an ideal gas.
//!
//! A coefficient is a measured flow over a computed one. Who computes with an ideal gas, whose throat passes less, finds a larger
//! coefficient: by 2 to 6 % for nitrogen at 65 to 150 bar. The same flow follows with `C_d = C_d,ideal G_ideal / G`, both fluxes choked and at
//! one pressure and temperature: those of the gas that flows, at time 0.
use super::Model;
use crate::ThermalError;
use crate::flow::{Flow, FlowKind, Opening, Source, orifice};
use crate::fluid::{Equation, Fluid};
use crate::scenario::Scenario;
use crate::vessel::Vessel;

/// A discharge coefficient that was converted.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvertedCoefficient {
    /// Name of the flow.
    pub flow: String,
    /// As stated, for an ideal gas.
    pub ideal_gas: f64,
    /// For the real gas.
    pub real_gas: f64,
    /// State of the conversion: pressure, Pa.
    pub pressure_pa: f64,
    /// And temperature, K.
    pub temperature_k: f64,
}

/// The scenario with every discharge coefficient as one of the real gas in this vessel, and what was converted.
///
/// # Errors
/// The state of the gas that flows is outside the fluid's domain.
pub fn with_real_gas_coefficients(
    vessel: &Vessel,
    scenario: &Scenario,
) -> Result<(Scenario, Vec<ConvertedCoefficient>), ThermalError> {
    let (flows, converted) = convert(vessel, scenario)?;
    Ok((Scenario { flows, ..scenario.clone() }, converted))
}

/// The flows alone.
pub(super) fn real_gas_flows(vessel: &Vessel, scenario: &Scenario) -> Result<Vec<Flow>, ThermalError> {
    Ok(convert(vessel, scenario)?.0)
}

fn convert(
    vessel: &Vessel,
    scenario: &Scenario,
) -> Result<(Vec<Flow>, Vec<ConvertedCoefficient>), ThermalError> {
    let mut flows = scenario.flows.clone();
    let mut converted = Vec::new();
    for flow in &mut flows {
        let (opening, (pressure_pa, temperature_k)) = match &flow.kind {
            FlowKind::Release { opening: opening @ Opening::IdealGasOrifice { .. }, .. } => {
                (*opening, gas_at_start(vessel, scenario)?)
            }
            FlowKind::Supply { opening: opening @ Opening::IdealGasOrifice { .. }, source, .. } => {
                (*opening, source_at_start(source))
            }
            _ => continue,
        };
        let Opening::IdealGasOrifice { diameter_m, discharge_coefficient: ideal_gas } = opening else {
            continue;
        };
        let ratio = flux_of_ideal_gas(&vessel.fluid, pressure_pa, temperature_k)?;
        let real_gas = ideal_gas * ratio;
        flow.kind = match flow.kind.clone() {
            FlowKind::Release { back_pressure_pa, .. } => {
                FlowKind::Orifice { diameter_m, discharge_coefficient: real_gas, back_pressure_pa }
            }
            FlowKind::Supply { source, inlet_diameter_m, .. } => {
                let opening = Opening::Orifice { diameter_m, discharge_coefficient: real_gas };
                FlowKind::Supply { opening, source, inlet_diameter_m }
            }
            other => other,
        };
        let flow = flow.name.clone();
        converted.push(ConvertedCoefficient { flow, ideal_gas, real_gas, pressure_pa, temperature_k });
    }
    Ok((flows, converted))
}

/// Critical flux of the ideal gas over that of the fluid as it is described.
fn flux_of_ideal_gas(fluid: &Fluid, pressure_pa: f64, temperature_k: f64) -> Result<f64, ThermalError> {
    let flux = |fluid: &Fluid| -> Result<f64, ThermalError> {
        let rho = fluid.density_from_pressure_temperature(pressure_pa, temperature_k)?;
        let state = fluid.checked_state(rho, temperature_k)?;
        Ok(orifice::mass_flux(fluid, &state, 0.0)?.mass_flux_kg_m2_s)
    };
    Ok(flux(&fluid.clone().with_equation(Equation::IdealGas))? / flux(fluid)?)
}

fn gas_at_start(vessel: &Vessel, scenario: &Scenario) -> Result<(f64, f64), ThermalError> {
    let model = Model::new(vessel, &Scenario { flows: Vec::new(), ..scenario.clone() })?;
    let (gas_k, pressure_pa) = model.gas_state(&model.initial_state(vessel, &scenario.initial)?)?;
    Ok((pressure_pa, gas_k))
}

fn source_at_start(source: &Source) -> (f64, f64) {
    match source {
        Source::Supply { temperature_k, pressure_pa } => (pressure_pa.at(0.0), temperature_k.at(0.0)),
        Source::Vessel { temperature_k, pressure_pa, .. } => (*pressure_pa, *temperature_k),
    }
}
