//! An identification in a few lines for people.
use super::{Part, Study};
use crate::estimator::identify::{Interval, Parameter, Pole, Residuals, Statistics};
use crate::report::{Report, number};

/// Digits of values that people compare.
const DIGITS: usize = 5;

/// The study in words and tables.
pub(crate) fn summary(study: &Study) -> Report {
    let header = ["", "value", "95 % low", "95 % high", "unit"];
    let report = Report::new(study.title()).text(format!("{}\n{}", log(&study.fitted), study.method)).rows(
        "",
        &header,
        coefficients(study).iter().map(row).collect(),
    );
    merits(study, report).text(errors(&study.identified.residuals))
}

fn log(part: &Part) -> String {
    let times = part.data.time_s();
    let length_s = times.last().copied().unwrap_or(0.0) - times.first().copied().unwrap_or(0.0);
    format!("{}: {} rows in {} h", part.name, times.len(), number(length_s / 3600.0, 4))
}

/// A number of the model with its name and unit.
pub(super) struct Coefficient {
    pub name: String,
    pub interval: Interval,
    pub unit: String,
}

impl Coefficient {
    fn new(name: impl Into<String>, interval: Interval, unit: impl Into<String>) -> Self {
        Self { name: name.into(), interval, unit: unit.into() }
    }
}

/// Poles and gain, then the parameters themselves.
pub(super) fn coefficients(study: &Study) -> Vec<Coefficient> {
    let (u, y) = (study.input.difference, study.output.difference);
    let derived = &study.identified.derived;
    let mut found = Vec::new();
    for (index, pole) in derived.poles.iter().enumerate() {
        found.extend(of_pole(pole, index, derived.poles.len()));
    }
    let unit = if u == y { "1".to_owned() } else { format!("{y}/{u}") };
    found.push(Coefficient::new("steady-state gain", derived.gain, unit));
    found.extend(study.identified.parameters.iter().map(|estimate| {
        let (name, unit) = name_and_unit(study, estimate.parameter);
        Coefficient::new(name, estimate.interval, unit)
    }));
    found
}

fn of_pole(pole: &Pole, index: usize, count: usize) -> Vec<Coefficient> {
    let suffix = if count > 1 { format!(" {}", index + 1) } else { String::new() };
    let mut found = vec![Coefficient::new(format!("pole{suffix}"), pole.real_per_s, "1/s")];
    if pole.imaginary_per_s.value != 0.0 {
        found.push(Coefficient::new(format!("pole{suffix}, imaginary"), pole.imaginary_per_s, "1/s"));
    }
    found.push(Coefficient::new(format!("time constant{suffix}"), pole.time_constant_s, "s"));
    found
}

/// Name of a parameter in `(b1 s + b0)/(s^n + ... + a0)`, with its unit.
fn name_and_unit(study: &Study, parameter: Parameter) -> (String, String) {
    let order = study.identified.model.order();
    let (u, y) = (study.input.difference, study.output.difference);
    let per_time = |power: usize| match power {
        0 => "1".to_owned(),
        1 => "1/s".to_owned(),
        _ => format!("1/s^{power}"),
    };
    match parameter {
        Parameter::Denominator(i) => (format!("denominator a{i}"), per_time(order - i)),
        Parameter::Numerator(j) if u == y => (format!("numerator b{j}"), per_time(order - j)),
        Parameter::Numerator(j) => (format!("numerator b{j}"), format!("{y}/{u} {}", per_time(order - j))),
        Parameter::Initial(0) => ("free response at the start".to_owned(), study.output.unit.to_owned()),
        Parameter::Initial(1) => ("its slope at the start".to_owned(), format!("{y}/s")),
        Parameter::Initial(k) => (format!("its derivative {k} at the start"), format!("{y}/s^{k}")),
        Parameter::Offset => ("offset".to_owned(), study.output.unit.to_owned()),
        Parameter::DeadTime => ("dead time".to_owned(), "s".to_owned()),
        Parameter::LogIntensity => ("logarithm of the input's intensity".to_owned(), String::new()),
    }
}

fn row(coefficient: &Coefficient) -> Vec<String> {
    let Coefficient { name, interval, unit } = coefficient;
    let mut cells = vec![name.clone()];
    cells.push(number(interval.value, DIGITS));
    match interval.sd {
        0.0 => cells.extend(["".to_owned(), "".to_owned()]),
        _ => cells.extend([interval.low, interval.high].map(|edge| number(edge, DIGITS))),
    }
    cells.push(unit.clone());
    cells
}

/// Figures of merit of all models on all data.
fn merits(study: &Study, report: Report) -> Report {
    let squared = format!("MSE / {}^2", study.output.difference);
    let rms = format!("rms / {}", study.output.difference);
    let header =
        ["model", "data", "start", "samples", "fit / %", &rms, &squared, "FPE", "AIC", "AICc", "BIC"];
    let line = |model: &str, data: &str, start: &str, statistics: &Statistics| {
        let s = statistics;
        let mut cells = [model, data, start].map(str::to_owned).to_vec();
        cells.push(s.samples.to_string());
        cells.push(format!("{:.2}", s.fit_percent));
        cells.extend([s.mse.sqrt(), s.mse, s.fpe].map(|value| number(value, 4)));
        cells.extend([s.aic, s.aicc, s.bic].map(|value| format!("{value:.1}")));
        cells
    };
    let mut rows = vec![line("identified", "the log", "as above", &study.identified.statistics)];
    let parts = [("the log", Some(&study.fitted)), ("held out", study.held_out.as_ref())];
    for (data, part) in parts {
        for judged in part.iter().flat_map(|part| &part.judged) {
            rows.push(line(judged.model, data, judged.start.text(), &judged.comparison.statistics));
        }
    }
    let held_out =
        study.held_out.as_ref().map_or_else(String::new, |part| format!("held out: {}\n", log(part)));
    let published = match study.fitted.published() {
        Some(_) => "published: G(s) = 0.003121/(s + 0.003021), shoulder to gas in °C, gain 1.0331\n",
        None => "",
    };
    report.explained_rows("", &header, rows, held_out + published)
}

/// What is left in the errors.
fn errors(residuals: &Residuals) -> String {
    let lags = residuals.autocorrelation.len() - 1;
    let largest =
        |values: &[f64]| values.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let auto = largest(&residuals.autocorrelation[1..]);
    let with_input = largest(&residuals.input_correlation);
    let white = if residuals.is_white() { "may be white" } else { "are not white" };
    format!(
        "errors {white} (probability {}); over {lags} lags their largest autocorrelation is {auto:+.2} \
         (99 % bound {:.2}),\ntheir largest correlation with the input {with_input:+.2} (99 % bound {:.2})\n",
        probability(residuals.whiteness),
        residuals.autocorrelation_bound,
        residuals.input_correlation_bound
    )
}

/// A probability, as far as it matters.
pub(super) fn probability(value: f64) -> String {
    if value < 0.001 { "below 0.001".to_owned() } else { format!("{value:.3}") }
}
