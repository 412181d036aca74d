//! Checks of a scenario's flows: leaks, discharges, refills.
use super::spec::{OutflowSpec, RefillSpec, ScenarioSpec};
use crate::ThermalError;
use crate::document::check;
use crate::flow::{Flow, FlowKind};
use crate::units::ATMOSPHERE_PA;

/// Largest mass flow, kg/s.
const MASS_FLOW_MAX_KG_S: f64 = 100.0;

/// Every flow of a scenario, in the order leaks, discharges, refills.
pub(super) fn build(spec: &ScenarioSpec) -> Result<Vec<Flow>, ThermalError> {
    let mut flows: Vec<Flow> = Vec::new();
    let outflows = [("leak", &spec.leak), ("discharge", &spec.discharge)];
    for (kind, specs) in outflows {
        for (i, one) in specs.iter().enumerate() {
            push(&mut flows, outflow(kind, i, one)?, &format!("{kind}[{i}]"))?;
        }
    }
    for (i, one) in spec.refill.iter().enumerate() {
        push(&mut flows, refill(i, one)?, &format!("refill[{i}]"))?;
    }
    Ok(flows)
}

fn outflow(kind: &str, i: usize, spec: &OutflowSpec) -> Result<Flow, ThermalError> {
    let path = |field: &str| format!("{kind}[{i}].{field}");
    let name = flow_name(kind, i, spec.name.as_ref())?;
    let kind = outflow_kind(&path, spec)?;
    let (start_s, stop_s) = window(&path, spec.start_s, spec.stop_s)?;
    let pressure = |field: &str, value: Option<f64>| {
        value.map(|value| check::pressure_pa(&path(field), value)).transpose()
    };
    let opens_above_pa = pressure("opens_above_pa", spec.opens_above_pa)?;
    let closes_below_pa = pressure("closes_below_pa", spec.closes_below_pa)?;
    if let (Some(opens), Some(closes)) = (opens_above_pa, closes_below_pa)
        && closes >= opens
    {
        let bound = format!("below opens_above = {} bar", opens / 1e5);
        return Err(check::broken(&path("closes_below_pa"), closes, &bound, "it would close as it opens"));
    }
    Ok(Flow { name, kind, start_s, stop_s, opens_above_pa, closes_below_pa, closes_above_pa: None })
}

/// A constant mass flow or an orifice, whichever the file describes.
fn outflow_kind(path: &dyn Fn(&str) -> String, spec: &OutflowSpec) -> Result<FlowKind, ThermalError> {
    match (spec.flow_kg_s, spec.diameter_m) {
        (Some(_), Some(_)) => {
            let remedy = "give the mass flow or the bore of a hole";
            Err(check::conflict(&path("diameter_m"), "flow", remedy))
        }
        (None, None) => {
            let remedy =
                "give a mass flow, e.g. flow_g_h = 20, or the bore of a hole, e.g. diameter_mm = 0.1";
            Err(check::missing(&path("flow_kg_s"), remedy))
        }
        (Some(flow_kg_s), None) => {
            let orifice_only = [
                ("discharge_coefficient", spec.discharge_coefficient),
                ("back_pressure_pa", spec.back_pressure_pa),
            ];
            if let Some((field, _)) = orifice_only.iter().find(|(_, value)| value.is_some()) {
                return Err(check::conflict(
                    &path(field),
                    "flow",
                    "it belongs to an orifice of some diameter",
                ));
            }
            Ok(FlowKind::Leak { mass_flow_kg_s: mass_flow(&path("flow_kg_s"), flow_kg_s)? })
        }
        (None, Some(diameter_m)) => {
            let (coefficient, back) = (path("discharge_coefficient"), path("back_pressure_pa"));
            let (value, remedy) = (spec.discharge_coefficient.unwrap_or(0.8), "0.6 to 0.9 are usual");
            check::positive(&coefficient, value, remedy)?;
            Ok(FlowKind::Orifice {
                diameter_m: bore(&path("diameter_m"), diameter_m)?,
                discharge_coefficient: check::fraction(&coefficient, value, remedy)?,
                back_pressure_pa: check::pressure_pa(&back, spec.back_pressure_pa.unwrap_or(ATMOSPHERE_PA))?,
            })
        }
    }
}

fn refill(i: usize, spec: &RefillSpec) -> Result<Flow, ThermalError> {
    let path = |field: &str| format!("refill[{i}].{field}");
    let (start_s, stop_s) = window(&path, spec.start_s, spec.stop_s)?;
    let inlet = spec.inlet_diameter_m.map(|value| bore(&path("inlet_diameter_m"), value)).transpose()?;
    let closes =
        spec.closes_above_pa.map(|value| check::pressure_pa(&path("closes_above_pa"), value)).transpose()?;
    Ok(Flow {
        name: flow_name("refill", i, spec.name.as_ref())?,
        kind: FlowKind::Refill {
            mass_flow_kg_s: mass_flow(&path("flow_kg_s"), spec.flow_kg_s)?,
            source_temperature_k: check::temperature_k(
                &path("source_temperature_k"),
                spec.source_temperature_k,
            )?,
            source_pressure_pa: check::pressure_pa(&path("source_pressure_pa"), spec.source_pressure_pa)?,
            inlet_diameter_m: inlet,
        },
        start_s,
        stop_s,
        opens_above_pa: None,
        closes_below_pa: None,
        closes_above_pa: closes,
    })
}

fn mass_flow(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "the direction is clear from [[leak]], [[discharge]] or [[refill]]";
    check::positive(path, value, remedy)?;
    check::within(path, value, (0.0, MASS_FLOW_MAX_KG_S), "at most 100 kg/s", "check the unit, _g_h or _kg_s")
}

fn bore(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "give the diameter of the hole, check the unit";
    check::within(path, check::positive(path, value, remedy)?, (0.0, 1.0), "at most 1 m", remedy)
}

fn window(
    path: &dyn Fn(&str) -> String,
    start_s: Option<f64>,
    stop_s: Option<f64>,
) -> Result<(f64, f64), ThermalError> {
    let start = start_s.unwrap_or(0.0);
    check::not_negative(&path("start_s"), start, "time counts from the start of the scenario")?;
    let Some(stop) = stop_s else { return Ok((start, f64::INFINITY)) };
    if stop.is_finite() && stop > start {
        return Ok((start, stop));
    }
    let bound = format!("later than the start at {}", check::time_text(start));
    Err(check::broken(&path("stop_s"), stop, &bound, "leave it out for a flow to the end"))
}

fn flow_name(kind: &str, i: usize, name: Option<&String>) -> Result<String, ThermalError> {
    match name {
        Some(name) if name.trim().is_empty() => {
            let remedy = "leave it out for the default name";
            Err(check::broken(&format!("{kind}[{i}].name"), "\"\"", "a name", remedy))
        }
        Some(name) => Ok(name.clone()),
        None if i == 0 => Ok(kind.to_owned()),
        None => Ok(format!("{kind}{}", i + 1)),
    }
}

fn push(flows: &mut Vec<Flow>, flow: Flow, path: &str) -> Result<(), ThermalError> {
    if flows.iter().any(|other| other.name == flow.name) {
        let text = format!("{:?}", flow.name);
        let remedy = "events tell flows apart by their names";
        return Err(check::broken(&format!("{path}.name"), text, "a name that no other flow has", remedy));
    }
    flows.push(flow);
    Ok(())
}
