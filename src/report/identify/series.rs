//! An identification as columns and as JSON.
use super::summary::{Coefficient, coefficients};
use super::{Part, Study};
use crate::estimator::identify::{Interval, Residuals, published};
use crate::report::{Digits, Provenance, Table};
use serde_json::{Value, json};

/// Significant digits of the columns.
const DIGITS: Digits = Digits::Significant(10);

/// Data, model and errors row by row, the held-out ones after the fitted ones.
pub(crate) fn table(study: &Study) -> Table {
    let parts = [
        Some((0.0, &study.fitted, &study.identified.residuals)),
        study.held_out.as_ref().and_then(|part| Some((1.0, part, &part.identified()?.residuals))),
    ];
    let mut columns: [Vec<f64>; 7] = Default::default();
    for (held_out, part, residuals) in parts.into_iter().flatten() {
        let of_published = part.published().map(|comparison| part.simulated(&comparison.residuals));
        let rows = part.rows(residuals);
        let model = part.simulated(residuals);
        for (k, &row) in rows.iter().enumerate() {
            let (u, y) = (part.data.input()[row], part.data.output()[row]);
            let published = of_published.as_ref().and_then(|values| values.get(k)).copied();
            let cells = [
                part.data.time_s()[row],
                u,
                y,
                model[k],
                residuals.values[k],
                published.unwrap_or(f64::NAN),
                held_out,
            ];
            columns.iter_mut().zip(cells).for_each(|(column, cell)| column.push(cell));
        }
    }
    let (input, output) = (&study.input, &study.output);
    let suffix = output.suffix;
    let error = output.difference.to_lowercase();
    let names = [
        "time_s".to_owned(),
        format!("{}_{}", input.name, input.suffix),
        format!("{}_{suffix}", output.name),
        format!("model_{suffix}"),
        format!("error_{error}"),
        format!("published_{suffix}"),
        "held_out".to_owned(),
    ];
    let mut table = Table::new();
    let without_published = study.fitted.published().is_none();
    for (name, column) in names.into_iter().zip(columns) {
        if !(without_published && name.starts_with("published_")) {
            table.push(name, DIGITS, column);
        }
    }
    table
}

/// Everything as JSON; `options` is the request.
pub(crate) fn document(study: &Study, options: &Value, provenance: &Provenance) -> Value {
    let signal = |signal: &super::Signal| json!({ "name": signal.name, "unit": signal.suffix });
    let comparable = study.fitted.published().is_some();
    json!({
        "provenance": provenance.to_json(),
        "input": signal(&study.input),
        "output": signal(&study.output),
        "options": options,
        "coefficients": coefficients(study).iter().map(coefficient).collect::<Vec<_>>(),
        "identified": study.identified,
        "published": comparable.then(published::model),
        "fitted": part(&study.fitted, &study.identified.residuals),
        "held_out": study.held_out.as_ref().and_then(|held| Some(part(held, &held.identified()?.residuals))),
    })
}

/// A number of the model; one that was not free has no interval.
fn coefficient(of: &Coefficient) -> Value {
    let Interval { value, sd, low, high } = of.interval;
    let free = |number: f64| Some(number).filter(|_| sd != 0.0);
    json!({ "name": of.name, "unit": of.unit, "value": value, "sd": free(sd), "low": free(low), "high": free(high) })
}

/// Data with the models that were judged on them; `residuals` are of the identified one.
fn part(part: &Part, residuals: &Residuals) -> Value {
    let rows = part.rows(residuals);
    let of = |column: &[f64]| rows.iter().map(|&row| column[row]).collect::<Vec<_>>();
    let judged: Vec<Value> = part
        .judged
        .iter()
        .map(|judged| {
            json!({ "model": judged.model, "start": judged.start.text(), "comparison": judged.comparison })
        })
        .collect();
    json!({
        "name": part.name,
        "time_s": of(part.data.time_s()),
        "input": of(part.data.input()),
        "output": of(part.data.output()),
        "model": part.simulated(residuals),
        "judged": judged,
    })
}
