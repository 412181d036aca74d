//! The figure of an identification: data and model, errors, what is left in the errors.
use super::{Part, Study};
use crate::estimator::identify::Residuals;
use crate::report::figure::{Figure, Horizontal, Item, Panel, Picture, correlation, style};

/// Data, model and errors against time, also of the held-out data; below, the errors' correlations against the lag.
pub(crate) fn figure(study: &Study) -> Picture {
    let mut figures = vec![over_time(study, &study.fitted, &study.identified.residuals, study.title())];
    figures.extend(study.held_out.as_ref().and_then(|part| {
        let title = format!("held out: {}", part.name);
        Some(over_time(study, part, &part.identified()?.residuals, title))
    }));
    figures.push(correlations(&study.identified.residuals, &study.input.name));
    Picture::stacked(figures)
}

/// Data with the models, and their errors.
fn over_time(study: &Study, part: &Part, residuals: &Residuals, title: String) -> Figure {
    let origin_s = origin_s(&study.fitted, part);
    let shifted = |times: &[f64]| times.iter().map(|time_s| time_s - origin_s).collect::<Vec<_>>();
    let all = shifted(part.data.time_s());
    let at = shifted(&residuals.time_s);
    let mut values = vec![
        Item::line(&study.input.name, &all, part.data.input().iter().copied(), style::SHOULDER),
        Item::line(&study.output.name, &all, part.data.output().iter().copied(), style::GAS_MEAN),
    ];
    if study.input.unit != study.output.unit {
        values.remove(0);
    }
    let mut errors = Vec::new();
    if let Some(published) = part.published() {
        let simulated = part.simulated(&published.residuals);
        let x = shifted(&published.residuals.time_s);
        values.push(Item::line("published", &x, simulated, style::THIRD));
        let missed = published.residuals.values.iter().copied();
        errors.push(Item::line("published", &x, missed, style::noisy(style::THIRD)));
    }
    values.push(Item::line("identified", &at, part.simulated(residuals), style::FIRST));
    let missed = residuals.values.iter().copied();
    errors.push(Item::line("identified", &at, missed, style::noisy(style::FIRST)));
    let mut panels = Vec::new();
    if study.input.unit != study.output.unit {
        let input = Item::line(&study.input.name, &all, part.data.input().iter().copied(), style::SHOULDER);
        let quantity = format!("input in {}", study.input.unit);
        panels.push(Panel::new(quantity, 0.7, vec![input]));
    }
    panels.push(Panel::new(format!("data in {}", study.output.unit), 1.0, values));
    panels.push(Panel::new(format!("error in {}", study.output.difference), 0.7, errors));
    Figure::over_time(title, panels)
}

/// Where a part's time axis begins, s: at the clock's zero, or, if that was long ago, at the first row. What was held out of a
/// log goes on with its axis.
fn origin_s(fitted: &Part, part: &Part) -> f64 {
    let span = |part: &Part| {
        let times = part.data.time_s();
        let [from_s, to_s] = [times.first(), times.last()].map(|time_s| time_s.copied().unwrap_or(0.0));
        (from_s, to_s)
    };
    let own = |(from_s, to_s): (f64, f64)| if from_s < 0.0 || from_s > to_s - from_s { from_s } else { 0.0 };
    let ((first_s, end_s), (from_s, to_s)) = (span(fitted), span(part));
    let goes_on = from_s > end_s && from_s - end_s < end_s - first_s;
    if goes_on { own((first_s, end_s)) } else { own((from_s, to_s)) }
}

/// Correlation of the errors with themselves and with the input, with 99 % bands.
fn correlations(residuals: &Residuals, input: &str) -> Figure {
    let lags = residuals.autocorrelation.len() as i64 - 1;
    let both: Vec<f64> = (-lags..=lags).map(|lag| lag as f64).collect();
    let after: Vec<f64> = (0..=lags).map(|lag| lag as f64).collect();
    let bounds = [residuals.autocorrelation_bound, residuals.input_correlation_bound];
    let of_input = format!("errors with\n{input}, lag\nsamples before");
    let panels = vec![
        correlation("errors with\nthemselves", &after, &residuals.autocorrelation, bounds[0]),
        correlation(&of_input, &both, &residuals.input_correlation, bounds[1]),
    ];
    Figure::new("What is left in the errors", Horizontal::Quantity("lag in samples".into()), panels)
}
