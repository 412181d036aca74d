//! The figure of a calibration: for each log readings and model, residuals, and the residuals' autocorrelation.
use super::Study;
use super::summary::unit;
use crate::estimator::calibrate::ChannelResiduals;
use crate::report::figure::{Figure, Horizontal, Item, Panel, Picture, correlation, style};
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};

/// Two-sided normal quantile of 99 %.
const QUANTILE_99: f64 = 2.576;

/// All logs, one below the other.
pub(crate) fn figure(study: &Study) -> Picture {
    let figures = study.fitted_sources().into_iter().flat_map(|log| {
        let of_log = |one: &&ChannelResiduals| one.experiment == log;
        let channels: Vec<&ChannelResiduals> = study.calibrated.channels.iter().filter(of_log).collect();
        [over_time(study, log, &channels), correlations(log, &channels)]
    });
    Picture::stacked(figures.collect())
}

/// Readings with the model, and residuals; temperatures, then pressures.
fn over_time(study: &Study, log: &str, channels: &[&ChannelResiduals]) -> Figure {
    let mut panels = Vec::new();
    for pressure in [false, true] {
        let of_quantity = |one: &&&ChannelResiduals| study.is_pressure(log, &one.channel) == pressure;
        let these: Vec<&ChannelResiduals> = channels.iter().filter(of_quantity).copied().collect();
        if these.is_empty() {
            continue;
        }
        let (quantity, zero, scale) = if pressure {
            ("pressure in bar", 0.0, BAR_PA)
        } else {
            ("temperature in °C", ZERO_CELSIUS_K, 1.0)
        };
        let shown = |si: f64| (si - zero) / scale;
        let (mut data, mut models, mut residuals) = (Vec::new(), Vec::new(), Vec::new());
        for (number, one) in these.iter().enumerate() {
            let readings = study.readings(one);
            let stroke = style::innovation(&one.channel, number);
            let model = readings.iter().zip(&one.residuals).map(|(y, r)| shown(y - r));
            let name = if number == 0 { "model" } else { "" };
            models.push(Item::line(name, &one.time_s, model, style::MODEL));
            let readings = readings.iter().map(|y| shown(*y));
            data.push(Item::line(&one.channel, &one.time_s, readings, style::below_model(stroke)));
            let left = one.residuals.iter().map(|r| r / scale);
            residuals.push(Item::line(&one.channel, &one.time_s, left, stroke));
        }
        data.extend(models);
        let symbol = unit(study, log, &these[0].channel).0;
        panels.push(Panel::new(quantity, 1.0, data));
        panels.push(Panel::new(format!("residual in {symbol}"), 0.6, residuals));
    }
    Figure::over_time(format!("{log}: readings and calibrated model"), panels)
}

fn correlations(log: &str, channels: &[&ChannelResiduals]) -> Figure {
    let panel = |one: &&ChannelResiduals| {
        let lags: Vec<f64> = (1..=one.autocorrelation.len()).map(|lag| lag as f64).collect();
        let bound = QUANTILE_99 / (one.residuals.len() as f64).sqrt();
        correlation(&format!("residuals of\n{}", one.channel), &lags, &one.autocorrelation, bound)
    };
    let title = format!("{log}: what is left in the residuals");
    Figure::new(title, Horizontal::Quantity("lag in samples".into()), channels.iter().map(panel).collect())
}
