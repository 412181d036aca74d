//! How the gas of a flow is said to flow, with its checks: a mass flow, constant or as a table, or an orifice or valve that it passes.
use super::Series;
use super::signal::{CsvSpec, Files, FlowTable, MASS_FLOW_MAX_KG_S, Signal};
use crate::ThermalError;
use crate::document::check;
use crate::flow::Opening;
use crate::units::Dimension;

/// Pressure differential ratio factor of a globe valve whose flow opens it (IEC 60534-2-1, table of typical values).
const X_T_GLOBE: f64 = 0.72;
/// Discharge coefficient of an orifice of which nothing is known.
const DISCHARGE_COEFFICIENT: f64 = 0.8;

/// Path of a field of a table.
pub(super) type PathOf<'a> = &'a dyn Fn(&str) -> String;

/// What tables of a flow are read with.
pub(super) struct SignalReader<'a> {
    pub files: Files<'a>,
    pub duration_s: f64,
}

impl SignalReader<'_> {
    pub(super) fn read(&self, signal: &Signal<'_>) -> Result<Option<Series>, ThermalError> {
        signal.series(self.files, self.duration_s)
    }
}

/// How gas is said to flow: by a mass flow, or through what.
pub(super) enum Stated {
    Constant(f64),
    Series(Series),
    Opening(Opening),
}

/// The keys that say how gas flows, of any flow.
pub(super) struct HowItFlows<'a> {
    pub flow_kg_s: Option<f64>,
    pub flow_table: Option<&'a FlowTable>,
    pub flow_csv: Option<&'a CsvSpec>,
    pub diameter_m: Option<f64>,
    pub discharge_coefficient: Option<f64>,
    pub discharge_coefficient_ideal_gas: Option<f64>,
    pub kv_m3_h: Option<f64>,
    pub x_t: Option<f64>,
}

impl HowItFlows<'_> {
    /// The one way that the table says.
    pub(super) fn stated(&self, table: &str, reader: &SignalReader<'_>) -> Result<Stated, ThermalError> {
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
        let kv_m3_h = check::within(&path("kv_m3_h"), kv_m3_h, (0.0, 1e4), "at most 10000 m3/h", remedy)?;
        let x_t = self.x_t.unwrap_or(X_T_GLOBE);
        let bound = "between 0.1 and 0.8";
        let remedy = "0.72 is a globe valve, 0.25 to 0.4 a ball or butterfly valve";
        Ok(Opening::Valve { kv_m3_h, x_t: check::within(&path("x_t"), x_t, (0.1, 0.8), bound, remedy)? })
    }
}

fn mass_flow(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "the direction is clear from [[leak]], [[discharge]] or [[refill]]";
    check::positive(path, value, remedy)?;
    check::within(path, value, (0.0, MASS_FLOW_MAX_KG_S), "at most 100 kg/s", "check the unit, _g_h or _kg_s")
}

/// A bore, m.
pub(super) fn bore(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "give the diameter of the hole, check the unit";
    check::within(path, check::positive(path, value, remedy)?, (0.0, 1.0), "at most 1 m", remedy)
}
