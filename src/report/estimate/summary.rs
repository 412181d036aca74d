//! A run of an observer in a few lines for people, and as JSON.
use super::innovation::{Counts, Innovations};
use super::row::EstimateRow;
use super::score::{Score, Spread};
use crate::estimator::consistency::{Finding, OutputReport};
use crate::log::{Caution, Sampling};
use crate::report::{GRAM_PER_HOUR, Report};
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};
use serde_json::{Value, json};

/// What is left of a run when its rows have gone.
#[derive(Clone, Debug)]
pub(crate) struct Summary {
    /// Title: vessel and sensors.
    pub title: String,
    /// How the log was sampled.
    pub sampling: Sampling,
    /// What was cautioned about.
    pub cautions: Vec<Caution>,
    /// Last estimate.
    pub last: EstimateRow,
    /// Standard deviation of the change of mass since the first row, kg; NaN: unknown.
    pub mass_change_sd_kg: f64,
    /// Innovations of the sensors.
    pub innovations: Innovations,
    /// How near to the truth.
    pub score: Score,
    /// How often the observer began again.
    pub restarts: u64,
}

/// The run in a few lines, and its sensors.
pub(crate) fn summary(summary: &Summary) -> Report {
    let mut facts = vec![("log", log(&summary.sampling))];
    facts.extend(end(summary));
    match summary.restarts {
        0 => {}
        1 => facts.push(("restarts", "once from the prior".to_owned())),
        many => facts.push(("restarts", format!("{many} times from the prior"))),
    }
    facts.extend(score(&summary.score));
    let (header, rows) = sensors(&summary.innovations);
    Report::new(&summary.title).facts(facts).rows("", &header, rows)
}

/// What speaks against the model: sensors whose readings it refused so often that it does not describe them.
pub(crate) fn doubts(summary: &Summary) -> Vec<String> {
    const FEWEST: u64 = 5;
    const SHARE: f64 = 0.05;
    let doubt = |(name, counts): (String, &Counts)| {
        let all = counts.used + counts.rejected;
        (counts.rejected >= FEWEST && counts.rejected as f64 > SHARE * all as f64).then(|| {
            let rejected = counts.rejected;
            format!(
                "{rejected} of {all} readings of {name} do not fit the vessel: look at the vessel, at the sensor's \
                 place and at its unit"
            )
        })
    };
    let names = summary.innovations.report().outputs.into_iter().map(|output| output.name);
    names.zip(summary.innovations.counts()).filter_map(doubt).collect()
}

/// Rows, usual interval and gaps of a log.
pub(in crate::report) fn log(sampling: &Sampling) -> String {
    let gaps = sampling.gaps();
    let mut text = match sampling.rows() {
        1 => "1 row".to_owned(),
        rows => {
            let (length, usual) = (duration(sampling.duration_s()), duration(sampling.usual_interval_s()));
            format!("{rows} rows in {length}, usually {usual} apart")
        }
    };
    if gaps.count > 0 {
        let (longest, all) = (duration(gaps.longest_s), duration(gaps.total_s));
        let gaps = gaps.count;
        text.push_str(&match gaps {
            1 => format!(", 1 gap of {longest}"),
            _ => format!(", {gaps} gaps of together {all}, the longest {longest}"),
        });
    }
    text
}

/// The last estimate.
fn end(summary: &Summary) -> Vec<(&'static str, String)> {
    let e = &summary.last.estimate;
    let gas_degc = e.gas_mean_k - ZERO_CELSIUS_K;
    let mut lines = vec![
        ("gas mean at the end", format!("{gas_degc:.2} ± {:.2} °C", e.gas_mean_sd_k)),
        (
            "gas mass at the end",
            format!(
                "{:.4} ± {:.4} kg, as a change since the start ± {:.4} kg",
                e.mass_kg, e.mass_sd_kg, summary.mass_change_sd_kg
            ),
        ),
    ];
    if e.leak_kg_s.is_finite() {
        let (leak, sd) = (e.leak_kg_s * GRAM_PER_HOUR, e.leak_sd_kg_s * GRAM_PER_HOUR);
        let bar_h = summary.last.leak_pa_s / BAR_PA * 3600.0;
        let [leak, sd, bar_h] =
            [(leak, 4), (sd, 4), (bar_h, 5)].map(|(value, decimals)| fixed(value, decimals));
        lines.push(("leak rate at the end", format!("{leak} ± {sd} g/h, {bar_h} bar/h")));
    }
    lines.push(("pressure at 15 °C", format!("{:.2} bar", e.p15_pa / BAR_PA)));
    lines
}

/// A number with so many decimals, never minus zero.
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|byte| matches!(byte, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}

/// How near to the truth, where the log knows it.
fn score(score: &Score) -> Vec<(&'static str, String)> {
    let line = |spread: &Spread, factor: f64, unit: &str| {
        let [rms, mean, largest] =
            [spread.rms(), spread.mean(), spread.largest()].map(|value| value * factor);
        format!(
            "rms {rms:.3}, mean {mean:+.3}, largest {largest:.3} {unit}; {:.0} % within 2 sd",
            100.0 * spread.covered()
        )
    };
    let known = [
        ("gas mean against truth", &score.gas_mean_k, 1.0, "K"),
        ("gas mass against truth", &score.mass_kg, 1e3, "g"),
        ("leak rate against truth", &score.leak_kg_s, GRAM_PER_HOUR, "g/h"),
    ];
    let known = known.into_iter().filter(|(_, spread, _, _)| spread.count() > 0);
    known.map(|(what, spread, factor, unit)| (what, line(spread, factor, unit))).collect()
}

/// Readings and innovations of every sensor as a table.
fn sensors(innovations: &Innovations) -> ([&'static str; 8], Vec<Vec<String>>) {
    let row = |(counts, output): (&Counts, &OutputReport)| {
        let mut row = vec![output.name.clone()];
        row.extend([counts.used, counts.rejected, counts.missing].map(|count| count.to_string()));
        row.push(if output.nis.readings > 0 { format!("{:.2}", output.nis.mean) } else { String::new() });
        row.push(short(output.nis.finding).to_owned());
        row.push(output.largest_autocorrelation.map_or(String::new(), |(_, largest)| fixed(largest, 2)));
        let white = output.whiteness.is_consistent();
        row.push(if white { "white".to_owned() } else { short(output.whiteness).to_owned() });
        row
    };
    let report = innovations.report();
    let rows: Vec<Vec<String>> = innovations.counts().iter().zip(&report.outputs).map(row).collect();
    let header =
        ["sensor", "used", "rejected", "missing", "NIS (1)", "innovations", "autocorrelation (0)", "in time"];
    (header, rows)
}

/// A finding in few words.
fn short(finding: Finding) -> &'static str {
    match finding {
        Finding::Consistent => "as stated",
        Finding::TooConfident => "larger than stated",
        Finding::TooCautious => "smaller than stated",
        Finding::Correlated => "correlated",
        Finding::NotNormal => "not normal",
        Finding::TooFew => "too few to tell",
    }
}

/// A duration in the unit that people would say.
pub(in crate::report) fn duration(duration_s: f64) -> String {
    let (value, unit) = match duration_s {
        d if d < 120.0 => (d, "s"),
        d if d < 2.0 * 3600.0 => (d / 60.0, "min"),
        d if d < 3.0 * 86_400.0 => (d / 3600.0, "h"),
        d => (d / 86_400.0, "d"),
    };
    format!("{} {unit}", crate::report::number(value, 4))
}

/// The run as JSON; null where nothing is known.
pub(crate) fn document(summary: &Summary) -> Value {
    let (sampling, gaps) = (&summary.sampling, summary.sampling.gaps());
    let spread = |spread: &Spread, factor: f64| match spread.count() {
        0 => Value::Null,
        count => json!({
            "rows": count,
            "rms": spread.rms() * factor,
            "mean": spread.mean() * factor,
            "largest": spread.largest() * factor,
            "within_2_sd": spread.covered(),
        }),
    };
    let report = summary.innovations.report();
    let sensor = |(counts, output): (&Counts, &OutputReport)| {
        json!({
            "name": output.name,
            "used": counts.used,
            "rejected": counts.rejected,
            "missing": counts.missing,
            "innovations": output,
        })
    };
    let sensors: Vec<Value> = summary.innovations.counts().iter().zip(&report.outputs).map(sensor).collect();
    json!({
        "rows": sampling.rows(),
        "duration_s": sampling.duration_s(),
        "usual_interval_s": sampling.usual_interval_s(),
        "gaps": { "count": gaps.count, "longest_s": gaps.longest_s, "total_s": gaps.total_s },
        "mass_change_sd_g": summary.mass_change_sd_kg * 1e3,
        "restarts": summary.restarts,
        "sensors": sensors,
        "against_truth": {
            "gas_mean_k": spread(&summary.score.gas_mean_k, 1.0),
            "mass_g": spread(&summary.score.mass_kg, 1e3),
            "leak_g_h": spread(&summary.score.leak_kg_s, GRAM_PER_HOUR),
        },
        "cautions": summary.cautions.iter().map(Caution::to_string).collect::<Vec<_>>(),
    })
}
