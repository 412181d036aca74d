//! Checks of a scenario's flows: leaks, discharges, refills.
use super::Series;
use super::opening::{HowItFlows, PathOf, SignalReader, Stated, bore};
use super::signal::{Files, Signal};
use super::spec::{OutflowSpec, RefillSpec, ScenarioSpec};
use crate::ThermalError;
use crate::document::check;
use crate::flow::{Flow, FlowKind, Opening, Source};
use crate::units::{ATMOSPHERE_PA, Dimension};

/// Every flow of a scenario, in the order leaks, discharges, refills.
pub(super) fn build(
    spec: &ScenarioSpec,
    files: Files<'_>,
    duration_s: f64,
) -> Result<Vec<Flow>, ThermalError> {
    let reader = SignalReader { files, duration_s };
    let mut flows: Vec<Flow> = Vec::new();
    let outflows = [("leak", &spec.leak), ("discharge", &spec.discharge)];
    for (kind, specs) in outflows {
        for (i, one) in specs.iter().enumerate() {
            push(&mut flows, outflow(kind, i, one, &reader)?, &format!("{kind}[{i}]"))?;
        }
    }
    for (i, one) in spec.refill.iter().enumerate() {
        push(&mut flows, refill(i, one, &reader)?, &format!("refill[{i}]"))?;
    }
    Ok(flows)
}

fn outflow(
    kind: &str,
    i: usize,
    spec: &OutflowSpec,
    reader: &SignalReader<'_>,
) -> Result<Flow, ThermalError> {
    let table = format!("{kind}[{i}]");
    let path = |field: &str| format!("{table}.{field}");
    let name = flow_name(kind, i, spec.name.as_ref())?;
    let kind = outflow_kind(&table, spec, reader)?;
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

/// The keys that flows out and refills have alike.
macro_rules! how_it_flows {
    ($spec:expr) => {
        HowItFlows {
            flow_kg_s: $spec.flow_kg_s,
            flow_table: $spec.flow_table.as_ref(),
            flow_csv: $spec.flow_csv.as_ref(),
            diameter_m: $spec.diameter_m,
            discharge_coefficient: $spec.discharge_coefficient,
            discharge_coefficient_ideal_gas: $spec.discharge_coefficient_ideal_gas,
            kv_m3_h: $spec.kv_m3_h,
            x_t: $spec.x_t,
        }
    };
}

/// A mass flow, an orifice or a valve, whichever the file describes.
fn outflow_kind(
    table: &str,
    spec: &OutflowSpec,
    reader: &SignalReader<'_>,
) -> Result<FlowKind, ThermalError> {
    let how = how_it_flows!(spec);
    let stated = how.stated(table, reader)?;
    let back = format!("{table}.back_pressure_pa");
    if spec.back_pressure_pa.is_some() && !matches!(stated, Stated::Opening(_)) {
        return Err(check::conflict(
            &back,
            "flow",
            "it belongs to an orifice of some diameter or to a valve",
        ));
    }
    let back_pressure_pa = check::pressure_pa(&back, spec.back_pressure_pa.unwrap_or(ATMOSPHERE_PA))?;
    Ok(match stated {
        Stated::Constant(mass_flow_kg_s) => FlowKind::Leak { mass_flow_kg_s },
        Stated::Series(mass_flow_kg_s) => FlowKind::LeakSeries { mass_flow_kg_s },
        Stated::Opening(Opening::Orifice { diameter_m, discharge_coefficient }) => {
            FlowKind::Orifice { diameter_m, discharge_coefficient, back_pressure_pa }
        }
        Stated::Opening(opening) => FlowKind::Release { opening, back_pressure_pa },
    })
}

fn refill(i: usize, spec: &RefillSpec, reader: &SignalReader<'_>) -> Result<Flow, ThermalError> {
    let table = format!("refill[{i}]");
    let path = |field: &str| format!("{table}.{field}");
    let (start_s, stop_s) = window(&path, spec.start_s, spec.stop_s)?;
    let inlet_diameter_m =
        spec.inlet_diameter_m.map(|value| bore(&path("inlet_diameter_m"), value)).transpose()?;
    let closes =
        spec.closes_above_pa.map(|value| check::pressure_pa(&path("closes_above_pa"), value)).transpose()?;
    let how = how_it_flows!(spec);
    let stated = how.stated(&table, reader)?;
    let source = source(&table, spec, reader)?;
    let kind = match (stated, source) {
        (Stated::Opening(opening), source) => FlowKind::Supply { opening, source, inlet_diameter_m },
        (_, Source::Vessel { .. }) => {
            let remedy = "a vessel gives what passes an orifice (diameter) or a valve (kv)";
            return Err(check::conflict(&path("source_volume_m3"), "flow", remedy));
        }
        (Stated::Constant(mass_flow_kg_s), Source::Supply { temperature_k, pressure_pa })
            if temperature_k.edges_s().count() == 1 && pressure_pa.edges_s().count() == 1 =>
        {
            FlowKind::Refill {
                mass_flow_kg_s,
                source_temperature_k: temperature_k.at(0.0),
                source_pressure_pa: pressure_pa.at(0.0),
                inlet_diameter_m,
            }
        }
        (Stated::Constant(mass_flow), source) => {
            FlowKind::RefillSeries { mass_flow_kg_s: Series::constant(mass_flow), source, inlet_diameter_m }
        }
        (Stated::Series(mass_flow_kg_s), source) => {
            FlowKind::RefillSeries { mass_flow_kg_s, source, inlet_diameter_m }
        }
    };
    Ok(Flow {
        name: flow_name("refill", i, spec.name.as_ref())?,
        kind,
        start_s,
        stop_s,
        opens_above_pa: None,
        closes_below_pa: None,
        closes_above_pa: closes,
    })
}

fn source(table: &str, spec: &RefillSpec, reader: &SignalReader<'_>) -> Result<Source, ThermalError> {
    let path = |field: &str| format!("{table}.{field}");
    let temperature = Signal {
        of: table,
        name: "source_temperature",
        dimension: Dimension::Temperature,
        constant: spec.source_temperature_k,
        changes: Vec::new(),
        table: spec.source_temperature_table.as_ref().map(|table| table.columns()),
        csv: spec.source_temperature_csv.as_ref(),
    };
    let pressure = Signal {
        of: table,
        name: "source_pressure",
        dimension: Dimension::Pressure,
        constant: spec.source_pressure_pa,
        changes: Vec::new(),
        table: spec.source_pressure_table.as_ref().map(|table| table.columns()),
        csv: spec.source_pressure_csv.as_ref(),
    };
    let Some(volume_m3) = spec.source_volume_m3 else {
        if spec.source_process.is_some() {
            let remedy = "it belongs to a source vessel: give source_volume_l, or leave it out";
            return Err(check::conflict(&path("source_process"), "a source without volume", remedy));
        }
        let needed = |signal: &Signal<'_>, key: &str, remedy: &str| {
            reader.read(signal)?.ok_or_else(|| check::missing(&path(key), remedy))
        };
        let remedy = "say how warm the gas of the source is";
        let temperature_k = needed(&temperature, "source_temperature_k", remedy)?;
        let remedy = "say the pressure of the source";
        let pressure_pa = needed(&pressure, "source_pressure_pa", remedy)?;
        return Ok(Source::Supply { temperature_k, pressure_pa });
    };
    let tabled = [
        ("source_temperature_table", spec.source_temperature_table.is_some()),
        ("source_temperature_csv", spec.source_temperature_csv.is_some()),
        ("source_pressure_table", spec.source_pressure_table.is_some()),
        ("source_pressure_csv", spec.source_pressure_csv.is_some()),
    ];
    if let Some((key, _)) = tabled.into_iter().find(|(_, given)| *given) {
        let remedy = "a vessel has its state at time 0 alone";
        return Err(check::conflict(&path(key), "source_volume", remedy));
    }
    let remedy = "give the inner volume of the vessel that the gas is taken from";
    check::positive(&path("source_volume_m3"), volume_m3, remedy)?;
    check::within(&path("source_volume_m3"), volume_m3, (0.0, 1e4), "at most 10000 m3", remedy)?;
    let needed = |key: &str, value: Option<f64>| {
        value.ok_or_else(|| check::missing(&path(key), "say the state of the source vessel at time 0"))
    };
    let temperature_k = needed("source_temperature_k", spec.source_temperature_k)?;
    let pressure_pa = needed("source_pressure_pa", spec.source_pressure_pa)?;
    Ok(Source::Vessel {
        volume_m3,
        temperature_k: check::temperature_k(&path("source_temperature_k"), temperature_k)?,
        pressure_pa: check::pressure_pa(&path("source_pressure_pa"), pressure_pa)?,
        process: spec.source_process.unwrap_or_default(),
    })
}

fn window(path: PathOf<'_>, start_s: Option<f64>, stop_s: Option<f64>) -> Result<(f64, f64), ThermalError> {
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
