//! An inspection as JSON.
use crate::log::Packing;
use crate::log::inspect::{ColumnReport, Inspection, Interval, Jump, Role, Use};
use crate::report::{Provenance, quoted, rounded};
use serde_json::{Value, json};

/// Significant digits of values and times.
const DIGITS: usize = 10;

/// Everything; values in the units of the file, times in s, null where nothing is known.
pub(crate) fn document(inspection: &Inspection, provenance: &Provenance) -> Value {
    let (form, times) = (&inspection.form, &inspection.times);
    let (from, to) = times.span_s;
    let (steps_back, first_back) = times.steps_back;
    json!({
        "provenance": provenance.to_json(),
        "log": inspection.name,
        "form": {
            "parquet": form.is_parquet,
            "separator": form.separator.to_string(),
            "decimal_mark": if form.decimal_comma { "," } else { "." },
            "encoding": form.encoding,
            "compression": match form.packing { Packing::Gzip => Some("gzip"), Packing::Plain => None },
            "header_line": form.header_line,
            "lines_above": form.lines_above,
        },
        "time": {
            "column": times.column,
            "proposed_map": times.supposed.as_ref().map(ToString::to_string),
            "origin": times.origin.map(|origin| origin.to_string()),
            "zone": times.zone,
            "proposed_zone": times.supposed_zone.as_ref().map(ToString::to_string),
            "rows": times.rows,
            "first_s": value(from),
            "last_s": value(to),
            "interval_s": value(times.interval_s),
            "jitter_s": value(times.jitter_s),
            "gaps": times.gaps.iter().map(interval).collect::<Vec<_>>(),
            "steps_back": steps_back,
            "first_step_back": first_back.as_ref().map(interval),
        },
        "columns": inspection.columns.iter().map(column).collect::<Vec<_>>(),
        "refusals": inspection.refusals.iter().map(|refusal| json!({
            "message": refusal.message,
            "count": refusal.count,
            "monitor_takes_it": refusal.monitor_takes_it,
        })).collect::<Vec<_>>(),
        "cautions": inspection.cautions.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "oddities": inspection.oddities,
        "uses": inspection.uses.iter().map(usage).collect::<Vec<_>>(),
    })
}

fn column(column: &ColumnReport) -> Value {
    let (numbers, missing, others) = column.cells;
    let [low, median, high] = column.range.map(value);
    let (taken_for, unit) = match &column.role {
        Role::Time => (Some("time"), None),
        Role::Reading(name, unit) => (Some(name.as_str()), Some(*unit)),
        Role::Truth(name, unit) => (Some(*name), Some(*unit)),
        Role::Simulated | Role::Aside => (None, None),
    };
    json!({
        "name": column.header,
        "taken_for": taken_for,
        "is_truth": matches!(column.role, Role::Truth(..) | Role::Simulated),
        "unit": unit,
        "unit_in_header": column.unit,
        "numbers": numbers,
        "missing": missing,
        "others": others,
        "first_other": column.text,
        "min": low,
        "median": median,
        "max": high,
        "step": value(column.step),
        "longest_run": (column.longest.count > 0).then(|| json!({
            "value": column.longest.value,
            "count": column.longest.count,
            "line": column.longest.line,
            "duration_s": value(column.longest.duration_s),
        })),
        "jumps": column.jumps.iter().map(jump).collect::<Vec<_>>(),
        "proposal": column.proposal.as_ref().map(|proposal| json!({
            "map": proposal.mapping.to_string(),
            "is_likely": proposal.is_likely,
            "reason": proposal.reason,
        })),
    })
}

fn usage(usage: &Use) -> Value {
    let line: Vec<String> = usage.line.iter().map(|word| quoted(word)).collect();
    json!({
        "command": usage.command,
        "possible": usage.lacks.is_empty(),
        "lacks": usage.lacks,
        "but": usage.but,
        "line": line.join(" "),
    })
}

fn jump(jump: &Jump) -> Value {
    json!({ "line": jump.line, "from": jump.from, "to": jump.to, "is_spike": jump.is_spike })
}

fn interval(interval: &Interval) -> Value {
    json!({ "begin_s": value(interval.begin_s), "length_s": value(interval.length_s), "line": interval.line })
}

/// A number, or null for what is none.
fn value(value: f64) -> Option<f64> {
    value.is_finite().then(|| rounded(value, DIGITS))
}
