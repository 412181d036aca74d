//! The parameters of a calibration as rows.
use super::{Line, Study};
use crate::report::{Digits, Table};
use crate::thermal::vessel::spec::FittedSpec;

/// Significant digits of the numbers.
const DIGITS: Digits = Digits::Significant(8);

/// A row for each parameter, in the SI unit of its row, as `parameters` of the JSON.
pub(crate) fn table(study: &Study) -> Table {
    type Number = fn(&FittedSpec) -> f64;
    let (fitted, lines) = (study.fitted_lines(), study.lines());
    let mut table = Table::new();
    table.push_texts("parameter", fitted.iter().map(|one| one.parameter.clone()));
    table.push_texts("of_log", fitted.iter().map(|one| one.of_log.clone().unwrap_or_default()));
    table.push_texts("unit", fitted.iter().map(|one| one.unit.clone()));
    let of_fitted: [(&str, Number); 6] = [
        ("value", |one| one.value),
        ("sd", |one| one.sd),
        ("low", |one| one.low),
        ("high", |one| one.high),
        ("prior_mean", |one| one.prior.map_or(f64::NAN, |prior| prior.mean)),
        ("prior_sd", |one| one.prior.map_or(f64::NAN, |prior| prior.sd)),
    ];
    for (name, value) in of_fitted {
        table.push(name, DIGITS, fitted.iter().map(value));
    }
    let mut push =
        |name: &str, value: &dyn Fn(&Line<'_>) -> f64| table.push(name, DIGITS, lines.iter().map(value));
    push("start", &|line| line.spec.start);
    push("prior_share", &|line| line.estimate.prior_share.unwrap_or(f64::NAN));
    push("mesh_shift_sd", &|line| study.mesh_shift_sd.get(line.place).copied().unwrap_or(f64::NAN));
    table
}
