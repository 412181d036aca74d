//! A simulated run as columns, as JSON, as a figure, as a few lines for the terminal.
use super::figure::{Figure, Item, Mark, Panel, style};
use super::{Digits, GRAM_PER_HOUR, Provenance, Readings, Report, Table, number, readings};
use crate::estimator::log::Quantity;
use crate::estimator::sensor::{Sensor, Site};
use crate::thermal::model::ConvertedCoefficient;
use crate::thermal::trajectory::{Event, EventKind, Trajectory};
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};
use crate::thermal::vessel::{GasResolution, Vessel};
use crate::thermal::wall::geometry::Orientation;
use serde_json::{Value, json};

/// Significant digits of a simulated number: beyond what the solver's tolerance carries, short enough to read.
const DIGITS: Digits = Digits::Significant(10);

fn celsius(values_k: &[f64]) -> impl Iterator<Item = f64> + '_ {
    values_k.iter().map(|t| t - ZERO_CELSIUS_K)
}

fn bar(values_pa: &[f64]) -> impl Iterator<Item = f64> + '_ {
    values_pa.iter().map(|p| p / BAR_PA)
}

/// Columns of a simulation: time, temperatures, pressure, mass, flows, source vessels, and the readings of the scenario's sensors.
pub(crate) fn table(run: &Trajectory, readings: &Readings) -> Table {
    let mut table = Table::new();
    table.push("time_s", DIGITS, run.time_s.iter().copied());
    table.push("ambient_degc", DIGITS, celsius(&run.ambient_k));
    table.push("gas_mean_degc", DIGITS, celsius(&run.gas_mean_k));
    let cells = run.gas_cells_k.first().map_or(0, Vec::len);
    for cell in 0..cells {
        let values = run.gas_cells_k.iter().map(|sample| sample[cell] - ZERO_CELSIUS_K);
        table.push(format!("gas_{}_degc", cell + 1), DIGITS, values);
    }
    for place in run.places.iter().filter(|place| place.name != "shoulder") {
        if let Some(surface) = run.surface_k(place.name) {
            table.push(format!("wall_{}_degc", place.name), DIGITS, celsius(&surface));
        }
    }
    for name in ["shoulder", "valve"] {
        if let Some(surface) = run.surface_k(name) {
            table.push(format!("{name}_degc"), DIGITS, celsius(&surface));
        }
    }
    table.push("wall_inner_mean_degc", DIGITS, celsius(&run.wall_inner_mean_k));
    for place in &run.places {
        if let Some(surface) = run.inner_surface_k(place.name) {
            table.push(format!("wall_inner_{}_degc", place.name), DIGITS, celsius(&surface));
        }
    }
    if let Some(liner) = &run.liner_mean_k {
        table.push("liner_mean_degc", DIGITS, celsius(liner));
    }
    table.push("pressure_bar", DIGITS, bar(&run.pressure_pa));
    table.push("mass_kg", DIGITS, run.mass_kg.iter().copied());
    table.push("outflow_g_h", DIGITS, run.outflow_kg_s.iter().map(|flow| flow * GRAM_PER_HOUR));
    table.push("heat_to_gas_w", DIGITS, run.heat_to_gas_w.iter().copied());
    for source in &run.sources {
        let name = column_word(&source.flow);
        table.push(format!("{name}_source_degc"), DIGITS, celsius(&source.temperature_k));
        table.push(format!("{name}_source_bar"), DIGITS, bar(&source.pressure_pa));
    }
    for (sensor, values) in readings.columns() {
        let (name, values) = readings::column(sensor, &values);
        table.push(name, DIGITS, values);
    }
    table
}

/// A name as part of a column's name.
fn column_word(name: &str) -> String {
    let word = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    name.chars().map(word).collect()
}

/// A discharge coefficient that was converted, in words.
pub(crate) fn conversion(of: &ConvertedCoefficient) -> String {
    format!(
        "{}: discharge coefficient {} with an ideal gas is {} with the real one, at {} bar and {} °C",
        of.flow,
        number(of.ideal_gas, 4),
        number(of.real_gas, 4),
        number(of.pressure_pa / BAR_PA, 5),
        number(of.temperature_k - ZERO_CELSIUS_K, 4)
    )
}

/// What to think of layers in a lying vessel; `None` where there are none.
pub(crate) fn lying_layers(vessel: &Vessel) -> Option<&'static str> {
    let has_layers = matches!(vessel.gas, GasResolution::Stratified(gas) if gas.cells > 1);
    (has_layers && vessel.geometry.orientation == Orientation::Horizontal).then_some(
        "gas in layers in a lying vessel: the model loses them, 3 K where 24 K were measured, so use mean temperature and pressure only",
    )
}

/// An event in words.
pub(crate) fn event_name(event: &Event) -> String {
    match &event.kind {
        EventKind::PressureLimit { limit_pa, falling } => {
            let side = if *falling { "below" } else { "above" };
            format!("{side} {} bar", number(limit_pa / BAR_PA, 6))
        }
        EventKind::FlowOpened { flow } => format!("{flow} opens"),
        EventKind::FlowClosed { flow } => format!("{flow} closes"),
        EventKind::Unchoked { flow } => format!("{flow} unchoked"),
    }
}

/// Title of a run: what happened to what.
pub(crate) fn title(run: &Trajectory) -> String {
    let (scenario, vessel) = (&run.scenario.name, &run.vessel.name);
    let title = if scenario == vessel { scenario.clone() } else { format!("{scenario} \u{2013} {vessel}") };
    title.replace("degC", "°C").replace(" -", " \u{2212}")
}

/// Temperatures, how they differ from the gas, pressure, and the gas mass where it changes.
pub(crate) fn figure(run: &Trajectory, readings: &Readings) -> Figure {
    let time = &run.time_s;
    let limit = |&limit_pa: &f64| Item::Limit {
        name: format!("limit {} bar", number(limit_pa / BAR_PA, 6)),
        value: limit_pa / BAR_PA,
    };
    let mut pressure: Vec<Item> = run.scenario.pressure_limits_pa.iter().map(limit).collect();
    pressure.push(Item::line("pressure", time, bar(&run.pressure_pa), style::PRESSURE));
    for (number, (sensor, values)) in readings.columns().enumerate() {
        if sensor.quantity() == Quantity::Pressure {
            let name = format!("sensor {}", sensor.name);
            pressure.push(Item::line(name, time, bar(&values), style::sensor("pressure", number)));
        }
    }
    let air = air(run, readings);
    let bodies = bodies(run, readings);
    let differences = differences(&bodies);
    let temperatures = air.into_iter().chain(bodies).collect();
    let mut panels = vec![
        Panel::new("temperature in °C", 1.1, temperatures),
        Panel::new("above gas mean in K", 0.7, differences),
        Panel::new("pressure in bar", 0.8, pressure),
    ];
    let (least, most) = run.mass_kg.iter().fold((f64::INFINITY, 0.0), |r, &m| (m.min(r.0), m.max(r.1)));
    if most - least > 1e-6 * most {
        let mass = Item::line("gas mass", time, run.mass_kg.iter().copied(), style::PRESSURE);
        panels.push(Panel::new("gas mass in kg", 0.55, vec![mass]));
    }
    let marks = run.events.iter().map(|event| Mark { at: event.time_s, name: event_name(event) }).collect();
    Figure::over_time(title(run), panels).with_marks(marks)
}

/// The air, and what sensors read of it.
fn air(run: &Trajectory, readings: &Readings) -> Vec<Item> {
    let mut items = vec![Item::line("air", &run.time_s, celsius(&run.ambient_k), style::AIR)];
    for (number, (sensor, values_k)) in readings.columns().enumerate() {
        if sensor.site() == Site::Air {
            items.push(sensor_line(run, sensor, &values_k, style::sensor("ambient", number)));
        }
    }
    items
}

fn sensor_line(run: &Trajectory, sensor: &Sensor, values_k: &[f64], stroke: style::Stroke) -> Item {
    Item::line(format!("sensor {}", sensor.name), &run.time_s, celsius(values_k), stroke)
}

/// Walls, valve, gas, and what sensors read of them; the mean gas is the last.
fn bodies(run: &Trajectory, readings: &Readings) -> Vec<Item> {
    let time = &run.time_s;
    let mut items = Vec::new();
    let resolved: &[(&str, &str, style::Stroke)] = &[
        ("valve", "valve", style::VALVE),
        ("shoulder", "shoulder", style::SHOULDER),
        ("middle", "wall, middle", style::WALL_MIDDLE),
        ("bottom", "wall, bottom", style::WALL_BOTTOM),
    ];
    let lumped = &[("valve", "valve", style::VALVE), ("middle", "wall", style::WALL_MIDDLE)];
    let places = if run.vessel.geometry.lumped { lumped } else { resolved };
    for &(place, name, stroke) in places {
        if let Some(surface) = run.surface_k(place) {
            items.push(Item::line(name, time, celsius(&surface), stroke));
        }
    }
    for (number, (sensor, values_k)) in readings.columns().enumerate() {
        let place = match sensor.site() {
            Site::Surface(place) => place.as_str(),
            Site::Gas(_) => "gas",
            Site::Air | Site::Port => continue,
        };
        items.push(sensor_line(run, sensor, &values_k, style::sensor(place, number)));
    }
    let cells = run.gas_cells_k.first().map_or(0, Vec::len);
    if cells > 1 {
        let cell = |k: usize| run.gas_cells_k.iter().map(move |sample| sample[k] - ZERO_CELSIUS_K);
        items.push(Item::line("gas, top", time, cell(cells - 1), style::GAS_TOP));
        items.push(Item::line("gas, bottom", time, cell(0), style::GAS_BOTTOM));
    }
    items.push(Item::line("gas, mean", time, celsius(&run.gas_mean_k), style::GAS_MEAN));
    items
}

/// The curves of walls, valve, sensors and gas cells minus the last one, the mean gas: what a sensor on the wall
/// gets wrong about the gas. The air is not among them: it would set the scale alone.
fn differences(bodies: &[Item]) -> Vec<Item> {
    let Some((Item::Line { y: mean, .. }, others)) = bodies.split_last() else { return Vec::new() };
    let difference = |item: &Item| match item {
        Item::Line { x, y, stroke, .. } => {
            Some(Item::line("", x, y.iter().zip(mean).map(|(t, gas)| t - gas), *stroke))
        }
        _ => None,
    };
    others.iter().filter_map(difference).collect()
}

/// Events and balances as comment lines of a CSV file.
pub(crate) fn remarks(run: &Trajectory) -> Vec<String> {
    let event = |event: &Event| format!("event at {} s: {}", number(event.time_s, 7), event_name(event));
    let mut lines: Vec<String> = run.events.iter().map(event).collect();
    lines.push(format!(
        "balance: mass residual {:.1e} of the fill, energy residual {:.1e} of the turnover",
        run.ledger.mass_residual(),
        run.ledger.energy_residual()
    ));
    lines
}

/// Size of a residual: two digits, or 0.
pub(crate) fn residual(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{:.1e}", value.abs()) }
}

/// The run as a JSON document: provenance, columns, events, ledger, what the solver did.
pub(crate) fn document(run: &Trajectory, readings: &Readings, provenance: &Provenance) -> Value {
    let event = |event: &Event| {
        json!({
            "time_s": event.time_s,
            "event": event_name(event),
            "pressure_bar": event.pressure_pa / BAR_PA,
            "gas_mean_degc": event.gas_mean_k - ZERO_CELSIUS_K,
        })
    };
    json!({
        "provenance": provenance.to_json(),
        "vessel": run.vessel.name,
        "scenario": run.scenario.name,
        "events": run.events.iter().map(event).collect::<Vec<_>>(),
        "ledger": ledger(run),
        "solver": statistics(run),
        "columns": table(run, readings).to_json(),
    })
}

/// Mass and energy balance as JSON.
pub(crate) fn ledger(run: &Trajectory) -> Value {
    let ledger = &run.ledger;
    json!({
        "mass_start_kg": ledger.mass_start_kg,
        "mass_end_kg": ledger.mass_end_kg,
        "mass_in_kg": ledger.mass_in_kg,
        "mass_residual": ledger.mass_residual(),
        "energy_start_j": ledger.energy_start_j,
        "energy_end_j": ledger.energy_end_j,
        "heat_in_j": ledger.heat_in_j,
        "enthalpy_in_j": ledger.enthalpy_in_j,
        "work_out_j": ledger.work_out_j,
        "energy_residual": ledger.energy_residual(),
    })
}

/// Counters of the solver as JSON.
pub(crate) fn statistics(run: &Trajectory) -> Value {
    let s = &run.statistics;
    json!({
        "states": s.states,
        "segments": s.segments,
        "steps": s.steps,
        "error_test_failures": s.error_test_failures,
        "newton_iterations": s.newton_iterations,
        "newton_failures": s.newton_failures,
        "linear_solver_setups": s.linear_solver_setups,
    })
}

/// What the figure of a run shows.
pub(crate) const CAPTION: &str = "Temperatures; how wall, valve and sensors differ from the mean gas; pressure with the scenario's limits; \
                           the gas mass where it changes. Lines named sensor are readings.";

/// The run in a few lines for people.
pub fn summary(run: &Trajectory) -> Report {
    let report = Report::new(title(run));
    let (Some(&first), Some(&last)) = (run.pressure_pa.first(), run.pressure_pa.last()) else {
        return report;
    };
    let extremes =
        run.gas_mean_k.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |r, &t| (r.0.min(t), r.1.max(t)));
    let mut facts = vec![
        ("pressure, start and end".to_owned(), format!("{:.2} and {:.2} bar", first / BAR_PA, last / BAR_PA)),
        (
            "gas mean, lowest and highest".to_owned(),
            format!("{:.2} and {:.2} °C", extremes.0 - ZERO_CELSIUS_K, extremes.1 - ZERO_CELSIUS_K),
        ),
        (
            "gas mass, start and end".to_owned(),
            format!("{:.4} and {:.4} kg", run.ledger.mass_start_kg, run.ledger.mass_end_kg),
        ),
        (
            "balance".to_owned(),
            format!(
                "mass within {}, energy within {}",
                residual(run.ledger.mass_residual()),
                residual(run.ledger.energy_residual())
            ),
        ),
        (
            "solver".to_owned(),
            format!("{} steps with {} states", run.statistics.steps, run.statistics.states),
        ),
    ];
    let event = |event: &Event| (format!("event at {:.0} s", event.time_s), event_name(event));
    facts.extend(run.events.iter().map(event));
    report.facts(facts)
}
