//! Checks of a scenario's flows: leaks, discharges, refills.
use super::Series;
use super::signal::{CsvSpec, Files, FlowTable, Signal};
use super::spec::{OutflowSpec, RefillSpec, ScenarioSpec};
use crate::ThermalError;
use crate::document::check;
use crate::flow::{Flow, FlowKind, Opening, Source};
use crate::units::{ATMOSPHERE_PA, Dimension};

/// Largest mass flow, kg/s.
pub(super) const MASS_FLOW_MAX_KG_S: f64 = 100.0;
/// Pressure differential ratio factor of a globe valve whose flow opens it (IEC 60534-2-1, table of typical values).
const X_T_GLOBE: f64 = 0.72;
/// Discharge coefficient of an orifice of which nothing is known.
const DISCHARGE_COEFFICIENT: f64 = 0.8;

type PathOf<'a> = &'a dyn Fn(&str) -> String;

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

/// What tables of a flow are read with.
struct SignalReader<'a> {
    files: Files<'a>,
    duration_s: f64,
}

impl SignalReader<'_> {
    fn read(&self, signal: &Signal<'_>) -> Result<Option<Series>, ThermalError> {
        signal.series(self.files, self.duration_s)
    }
}

/// How gas is said to flow: by a mass flow, or through what.
enum Stated {
    Constant(f64),
    Series(Series),
    Opening(Opening),
}

/// The keys that say how gas flows, of any flow.
struct HowItFlows<'a> {
    flow_kg_s: Option<f64>,
    flow_table: Option<&'a FlowTable>,
    flow_csv: Option<&'a CsvSpec>,
    diameter_m: Option<f64>,
    discharge_coefficient: Option<f64>,
    discharge_coefficient_ideal_gas: Option<f64>,
    kv_m3_h: Option<f64>,
    x_t: Option<f64>,
}

impl HowItFlows<'_> {
    /// The one way that the table says.
    fn stated(&self, table: &str, reader: &SignalReader<'_>) -> Result<Stated, ThermalError> {
        let path = |field: &str| format!("{table}.{field}");
        let ways = [
            ("flow_kg_s", "flow", self.flow_kg_s.is_some()),
            ("flow_table", "flow_table", self.flow_table.is_some()),
            ("flow_csv", "flow_csv", self.flow_csv.is_some()),
            ("diameter_m", "diameter", self.diameter_m.is_some()),
            ("kv_m3_h", "kv", self.kv_m3_h.is_some()),
        ];
        let given: Vec<_> = ways.into_iter().filter(|way| way.2).collect();
        if let [first, second, ..] = given[..] {
            let remedy = "give the mass flow, the bore of a hole, or the Kv of a valve";
            return Err(check::conflict(&path(second.0), first.1, remedy));
        }
        let remedy = "give a mass flow, e.g. flow_g_h = 20, the bore of a hole, e.g. diameter_mm = 0.1, or the Kv of a valve, e.g. kv_m3_h = 0.4";
        let &[(key, name, _)] = &given[..] else { return Err(check::missing(&path("flow_kg_s"), remedy)) };
        let of_orifice = [
            ("discharge_coefficient", self.discharge_coefficient),
            ("discharge_coefficient_ideal_gas", self.discharge_coefficient_ideal_gas),
        ];
        let of_valve = [("x_t", self.x_t)];
        let foreign = |fields: &[(&str, Option<f64>)], owner: &str| {
            let found = fields.iter().find(|(_, value)| value.is_some());
            found.map_or(Ok(()), |(field, _)| Err(check::conflict(&path(field), name, owner)))
        };
        if key != "diameter_m" {
            foreign(&of_orifice, "it belongs to an orifice of some diameter")?;
        }
        if key != "kv_m3_h" {
            foreign(&of_valve, "it belongs to a valve of some kv_m3_h")?;
        }
        match (self.flow_kg_s, self.diameter_m, self.kv_m3_h) {
            (Some(flow_kg_s), ..) => Ok(Stated::Constant(mass_flow(&path("flow_kg_s"), flow_kg_s)?)),
            (_, Some(diameter_m), _) => Ok(Stated::Opening(self.orifice(&path, diameter_m)?)),
            (_, _, Some(kv_m3_h)) => Ok(Stated::Opening(self.valve(&path, kv_m3_h)?)),
            _ => {
                let signal = Signal {
                    of: table,
                    name: "flow",
                    dimension: Dimension::MassFlow,
                    constant: None,
                    changes: Vec::new(),
                    table: self.flow_table.map(FlowTable::columns),
                    csv: self.flow_csv,
                };
                let series = reader.read(&signal)?;
                series.map(Stated::Series).ok_or_else(|| check::missing(&path("flow_kg_s"), remedy))
            }
        }
    }

    fn orifice(&self, path: PathOf<'_>, diameter_m: f64) -> Result<Opening, ThermalError> {
        let diameter_m = bore(&path("diameter_m"), diameter_m)?;
        let coefficient = |field: &str, value: f64| {
            let remedy = "0.6 to 0.9 are usual";
            check::positive(&path(field), value, remedy)?;
            check::fraction(&path(field), value, remedy)
        };
        match (self.discharge_coefficient, self.discharge_coefficient_ideal_gas) {
            (Some(_), Some(_)) => {
                let remedy = "keep the one that was measured";
                Err(check::conflict(
                    &path("discharge_coefficient_ideal_gas"),
                    "discharge_coefficient",
                    remedy,
                ))
            }
            (None, Some(value)) => Ok(Opening::IdealGasOrifice {
                diameter_m,
                discharge_coefficient: coefficient("discharge_coefficient_ideal_gas", value)?,
            }),
            (value, None) => Ok(Opening::Orifice {
                diameter_m,
                discharge_coefficient: coefficient(
                    "discharge_coefficient",
                    value.unwrap_or(DISCHARGE_COEFFICIENT),
                )?,
            }),
        }
    }

    fn valve(&self, path: PathOf<'_>, kv_m3_h: f64) -> Result<Opening, ThermalError> {
        let remedy = "give the flow coefficient of the data sheet, 0.01 to 100 are usual; Cv is 1.156 Kv";
        check::positive(&path("kv_m3_h"), kv_m3_h, remedy)?;
        let kv_m3_h = check::within(&path("kv_m3_h"), kv_m3_h, (0.0, 1e5), "at most 100000 m3/h", remedy)?;
        let x_t = self.x_t.unwrap_or(X_T_GLOBE);
        let bound = "between 0.1 and 0.8";
        let remedy = "0.72 is a globe valve, 0.25 to 0.4 a ball or butterfly valve";
        Ok(Opening::Valve { kv_m3_h, x_t: check::within(&path("x_t"), x_t, (0.1, 0.8), bound, remedy)? })
    }
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

/// A mass flow, an orifice or a valve, whichever the file describes.
fn outflow_kind(
    table: &str,
    spec: &OutflowSpec,
    reader: &SignalReader<'_>,
) -> Result<FlowKind, ThermalError> {
    let how = HowItFlows {
        flow_kg_s: spec.flow_kg_s,
        flow_table: spec.flow_table.as_ref(),
        flow_csv: spec.flow_csv.as_ref(),
        diameter_m: spec.diameter_m,
        discharge_coefficient: spec.discharge_coefficient,
        discharge_coefficient_ideal_gas: spec.discharge_coefficient_ideal_gas,
        kv_m3_h: spec.kv_m3_h,
        x_t: spec.x_t,
    };
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
    let how = HowItFlows {
        flow_kg_s: spec.flow_kg_s,
        flow_table: spec.flow_table.as_ref(),
        flow_csv: spec.flow_csv.as_ref(),
        diameter_m: spec.diameter_m,
        discharge_coefficient: spec.discharge_coefficient,
        discharge_coefficient_ideal_gas: spec.discharge_coefficient_ideal_gas,
        kv_m3_h: spec.kv_m3_h,
        x_t: spec.x_t,
    };
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

fn mass_flow(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "the direction is clear from [[leak]], [[discharge]] or [[refill]]";
    check::positive(path, value, remedy)?;
    check::within(path, value, (0.0, MASS_FLOW_MAX_KG_S), "at most 100 kg/s", "check the unit, _g_h or _kg_s")
}

fn bore(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "give the diameter of the hole, check the unit";
    check::within(path, check::positive(path, value, remedy)?, (0.0, 1.0), "at most 1 m", remedy)
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
