//! The outcome of inspections: a table of cylinders, a page with what it rests on and what it is not.
use super::{Digits, GRAM_PER_HOUR, Provenance, Report, Table, number};
use crate::detector::inspection::{BOUND_SD, Criterion, Inspection, Judgement};
use crate::detector::monitor::{Interval, LeakFinding};
use crate::report::estimate::duration;
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};
use jiff::civil::Date;
use jiff::{Span, ToSpan};
use serde_json::{Value, json};

/// What the dates and the judgement follow from.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    /// Name of the vessel.
    pub vessel: String,
    /// When a loss is too large.
    pub criterion: Criterion,
    /// Months from one inspection to the next.
    pub inspection_months: i32,
    /// Months from one comparison of the gauge to the next.
    pub gauge_months: i32,
    /// Last comparison of the gauge.
    pub gauge_compared: Option<Date>,
}

/// What a judgement rests on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Basis {
    /// A log.
    Log {
        /// From its first row to its last, s.
        duration_s: f64,
        /// Rows.
        rows: u64,
    },
    /// A single reading.
    Reading {
        /// Pressure as read, Pa absolute.
        pressure_pa: f64,
        /// Temperature as read, K.
        temperature_k: f64,
        /// For how long it has rested, in words.
        rest: String,
    },
    /// Nothing could be read.
    Nothing,
}

/// A cylinder.
#[derive(Clone, Debug)]
pub(crate) struct Inspected {
    /// Its name.
    pub cylinder: String,
    /// Date of the inspection, if it is known.
    pub date: Option<Date>,
    /// What the judgement rests on.
    pub basis: Basis,
    /// What came out; `None`: nothing can be said, for the `reason`.
    pub outcome: Option<Inspection>,
    /// Standard deviation of what the gauge is off by all the time, Pa; NaN: not known.
    pub gauge_sd_pa: f64,
    /// Why it cannot be told; empty: it can.
    pub reason: String,
    /// What else was seen.
    pub remarks: Vec<String>,
}

impl Inspected {
    /// A cylinder of which nothing is said yet.
    pub(crate) fn blank(cylinder: String, date: Option<Date>, basis: Basis, remarks: Vec<String>) -> Self {
        Self { cylinder, date, basis, outcome: None, gauge_sd_pa: f64::NAN, reason: String::new(), remarks }
    }

    /// A cylinder whose log cannot be read.
    pub(crate) fn failed(cylinder: String, reason: String) -> Self {
        Self { reason, ..Self::blank(cylinder, None, Basis::Nothing, Vec::new()) }
    }

    /// What becomes of it.
    pub(crate) fn judgement(&self) -> Judgement {
        self.outcome.map_or(Judgement::CannotBeTold, |outcome| outcome.judgement)
    }

    fn next(&self, months: i32) -> Option<Date> {
        after(self.date?, months)
    }
}

/// What an adjusted pressure and a loss are uncertain by: half widths of 95 % intervals, Pa.
#[derive(Clone, Copy, Debug)]
struct Shares {
    gauge_pa: f64,
    /// Gas temperature, and all else about the cylinder.
    cylinder_pa: f64,
    fill_pa: f64,
}

impl Shares {
    fn of(found: &Inspection, gauge_sd_pa: f64) -> Self {
        let half = |interval: Interval| 0.5 * (interval.high - interval.low);
        let all_pa = half(found.adjusted_pa);
        let gauge_pa = (BOUND_SD * gauge_sd_pa).min(all_pa);
        let cylinder_pa = (all_pa * all_pa - gauge_pa * gauge_pa).sqrt();
        Self { gauge_pa, cylinder_pa, fill_pa: half(found.filled_pa) }
    }
}

/// What is most uncertain about a cylinder of which it cannot be told, and what would help.
pub(crate) fn remedy(found: &Inspection, gauge_sd_pa: f64) -> &'static str {
    let Shares { gauge_pa, cylinder_pa, fill_pa } = Shares::of(found, gauge_sd_pa);
    if fill_pa > gauge_pa.max(cylinder_pa) {
        "most uncertain is the fill: state how well it is known with --fill-sd-percent"
    } else if gauge_pa > cylinder_pa {
        "most uncertain is the gauge: one of a better class would tell more"
    } else {
        "most uncertain is the temperature of the gas: a thermometer on the wall, rest, or a longer log would tell more"
    }
}

fn after(date: Date, months: i32) -> Option<Date> {
    let span: Span = months.months();
    date.checked_add(span).ok()
}

/// A leak that a log shows.
pub(crate) fn leak_text(leak: &LeakFinding) -> String {
    let rate = leak.rate_kg_s.scaled(GRAM_PER_HOUR);
    let [value, low, high] = [rate.value, rate.low, rate.high].map(|rate| number(rate, 3));
    format!("it is losing gas: {value} ({low} to {high}) g/h")
}

/// A time of rest in words.
pub(crate) fn rest_text(rested_s: f64) -> String {
    if rested_s > 0.0 { format!("after {} of rest", duration(rested_s)) } else { "rest not known".to_owned() }
}

fn word(judgement: Judgement) -> &'static str {
    match judgement {
        Judgement::Pass => "pass",
        Judgement::Refill => "refill",
        Judgement::CannotBeTold => "cannot be told",
    }
}

fn basis(basis: &Basis) -> String {
    match basis {
        Basis::Log { duration_s, rows } => format!("log of {}, {rows} rows", duration(*duration_s)),
        Basis::Reading { pressure_pa, temperature_k, rest } => {
            let [bar, degc] =
                [pressure_pa / BAR_PA, temperature_k - ZERO_CELSIUS_K].map(|value| number(value, 4));
            format!("reading of {bar} bar at {degc} \u{b0}C, {rest}")
        }
        Basis::Nothing => String::new(),
    }
}

/// The table of all cylinders.
pub(crate) fn table(rules: &Rules, cylinders: &[Inspected]) -> Table {
    let date = |date: Option<Date>| date.map_or(String::new(), |date| date.to_string());
    let all = |of: &dyn Fn(&Inspection) -> f64| -> Vec<f64> {
        cylinders.iter().map(|one| one.outcome.as_ref().map_or(f64::NAN, of)).collect()
    };
    let texts = |of: &dyn Fn(&Inspected) -> String| -> Vec<String> { cylinders.iter().map(of).collect() };
    let mut table = Table::new();
    let (bar, percent, probability) = (Digits::Decimals(2), Digits::Decimals(2), Digits::Decimals(4));
    table.push_texts("cylinder", texts(&|one| one.cylinder.clone()));
    table.push_texts("date", texts(&|one| date(one.date)));
    table.push_texts("judgement", texts(&|one| word(one.judgement()).replace(' ', "-")));
    table.push("refill_probability", probability, all(&|found| found.refill_probability));
    table.push("adjusted_bar", bar, all(&|found| found.adjusted_pa.value / BAR_PA));
    table.push("adjusted_low_bar", bar, all(&|found| found.adjusted_pa.low / BAR_PA));
    table.push("adjusted_high_bar", bar, all(&|found| found.adjusted_pa.high / BAR_PA));
    table.push("filled_bar", bar, all(&|found| found.filled_pa.value / BAR_PA));
    table.push("loss_percent", percent, all(&|found| 100.0 * found.loss.value));
    table.push("loss_low_percent", percent, all(&|found| 100.0 * found.loss.low));
    table.push("loss_high_percent", percent, all(&|found| 100.0 * found.loss.high));
    table.push_texts("basis", texts(&|one| basis(&one.basis)));
    table.push_texts("reason", texts(&|one| one.reason.clone()));
    table.push_texts("remarks", texts(&|one| one.remarks.join("; ")));
    table.push_texts("next_inspection", texts(&|one| date(one.next(rules.inspection_months))));
    let gauge = date(rules.gauge_compared.and_then(|date| after(date, rules.gauge_months)));
    table.push_texts("next_gauge_comparison", texts(&|_| gauge.clone()));
    table
}

/// The same as JSON, with the criterion.
pub(crate) fn document(rules: &Rules, cylinders: &[Inspected], provenance: &Provenance) -> Value {
    let Criterion { loss_limit, certainty, reference_k } = rules.criterion;
    json!({
        "criterion": {
            "loss_limit_percent": 100.0 * loss_limit,
            "certainty_percent": 100.0 * certainty,
            "reference_degc": reference_k - ZERO_CELSIUS_K,
        },
        "columns": table(rules, cylinders).to_json(),
        "provenance": provenance.to_json(),
    })
}

/// One page: of one cylinder its facts, of many a table.
pub(crate) fn summary(rules: &Rules, cylinders: &[Inspected]) -> Report {
    let report = match cylinders {
        [one] => {
            let title = format!("Inspection of {}", rules.vessel);
            Report::new(title).facts(facts(rules, one)).heading("What it rests on")
        }
        many => {
            let rows: Vec<_> = many.iter().map(|one| row(rules, one)).collect();
            // Without dates nothing is due, without remarks nothing is seen.
            let is_used = |column: &usize| rows.iter().any(|row| !row[*column].is_empty());
            let used: Vec<usize> = (0..HEADER.len()).filter(is_used).collect();
            let header: Vec<&str> = used.iter().map(|column| HEADER[*column]).collect();
            let rows =
                rows.iter().map(|row| used.iter().map(|column| row[*column].clone()).collect()).collect();
            Report::new(format!("Inspection of {} cylinders: {}", many.len(), rules.vessel))
                .facts(counts(rules, many))
                .rows("", &header, rows)
                .heading("What it rests on")
        }
    };
    report.text(method(rules)).text(NO_CERTIFICATE)
}

const NO_CERTIFICATE: &str = "This is a measurement beside a criterion, and no certificate.";

fn method(rules: &Rules) -> String {
    let Criterion { loss_limit, certainty, reference_k } = rules.criterion;
    let [limit, sure, degc] =
        [100.0 * loss_limit, 100.0 * certainty, reference_k - ZERO_CELSIUS_K].map(|value| number(value, 4));
    format!(
        "The criterion is that of ISO 14520 as it is set here: refill where the pressure, adjusted for temperature to {degc} \u{b0}C, has fallen by more \
         than {limit} %; told with a probability of {sure} % or more, else it cannot be told. Intervals are of 95 %. Gauge, thermometer, gas temperature and fill are \
         counted with their uncertainties; of the loss nothing is supposed beforehand. Contents are inspected every {} months, gauges compared every {}.",
        rules.inspection_months, rules.gauge_months
    )
}

fn counts(rules: &Rules, cylinders: &[Inspected]) -> Vec<(&'static str, String)> {
    let count = |judgement| cylinders.iter().filter(|one| one.judgement() == judgement).count().to_string();
    let mut facts = vec![
        ("pass", count(Judgement::Pass)),
        ("refill", count(Judgement::Refill)),
        ("cannot be told", count(Judgement::CannotBeTold)),
    ];
    facts.extend(gauge_due(rules).map(|date| ("gauge due", date)));
    facts
}

fn gauge_due(rules: &Rules) -> Option<String> {
    Some(after(rules.gauge_compared?, rules.gauge_months)?.to_string())
}

fn facts(rules: &Rules, one: &Inspected) -> Vec<(&'static str, String)> {
    let named = Some(&one.cylinder).filter(|name| !name.is_empty());
    let mut facts: Vec<(&'static str, String)> =
        named.map(|name| ("cylinder", name.clone())).into_iter().collect();
    facts.extend(one.date.map(|date| ("date", date.to_string())));
    facts.push(("judgement", judgement(one)));
    if let Some(found) = &one.outcome {
        let degc = number(rules.criterion.reference_k - ZERO_CELSIUS_K, 4);
        facts.push(("pressure", format!("{} bar at {degc} \u{b0}C", range(found.adjusted_pa, 1.0 / BAR_PA))));
        facts.push(("filled", format!("{} bar at {degc} \u{b0}C", range(found.filled_pa, 1.0 / BAR_PA))));
        facts.push(("loss", format!("{} %", range(found.loss, 100.0))));
        let Shares { gauge_pa, cylinder_pa, fill_pa } = Shares::of(found, one.gauge_sd_pa);
        let [gauge, cylinder, fill] = [gauge_pa, cylinder_pa, fill_pa].map(|pa| pa / BAR_PA);
        if gauge.is_finite() {
            facts.push((
                "uncertain by",
                format!(
                    "gauge \u{b1}{gauge:.1}, gas temperature \u{b1}{cylinder:.1}, fill \u{b1}{fill:.1} bar"
                ),
            ));
        }
    }
    facts.push(("basis", basis(&one.basis)));
    let reason = if one.reason.is_empty() { None } else { Some(("reason", one.reason.clone())) };
    facts.extend(reason);
    facts.extend(one.remarks.iter().map(|remark| ("seen", remark.clone())));
    facts.extend(one.next(rules.inspection_months).map(|date| ("next inspection", date.to_string())));
    facts.extend(gauge_due(rules).map(|date| ("gauge due", date)));
    facts
}

const HEADER: [&str; 7] =
    ["cylinder", "judgement", "probability", "at reference, bar", "loss, %", "next", "remarks"];

fn row(rules: &Rules, one: &Inspected) -> [String; HEADER.len()] {
    let found = one.outcome.as_ref();
    let probability = found.map_or(String::new(), |found| percent(stated(found)));
    let adjusted = found.map_or(String::new(), |found| range(found.adjusted_pa, 1.0 / BAR_PA));
    let loss = found.map_or(String::new(), |found| range(found.loss, 100.0));
    let next = one.next(rules.inspection_months).map_or(String::new(), |date| date.to_string());
    let said: Vec<String> = std::iter::once(one.reason.clone())
        .chain(one.remarks.clone())
        .filter(|words| !words.is_empty())
        .collect();
    [
        one.cylinder.clone(),
        word(one.judgement()).to_owned(),
        probability,
        adjusted,
        loss,
        next,
        said.join("; "),
    ]
}

/// The judgement with the probability that it is right; where it cannot be told, of both.
fn judgement(one: &Inspected) -> String {
    let Some(found) = &one.outcome else { return word(Judgement::CannotBeTold).to_owned() };
    match found.judgement {
        Judgement::CannotBeTold => {
            let refill = found.refill_probability;
            format!("cannot be told: pass {}, refill {}", percent(1.0 - refill), percent(refill))
        }
        other => format!("{}, with a probability of {}", word(other), percent(stated(found))),
    }
}

/// Probability that a judgement is right; of a cylinder of which it cannot be told, that it is to be refilled.
fn stated(found: &Inspection) -> f64 {
    match found.judgement {
        Judgement::Pass => 1.0 - found.refill_probability,
        Judgement::Refill | Judgement::CannotBeTold => found.refill_probability,
    }
}

fn percent(probability: f64) -> String {
    match 100.0 * probability {
        percent if percent > 99.9 => "more than 99.9 %".to_owned(),
        percent if percent < 0.1 => "less than 0.1 %".to_owned(),
        percent => format!("{percent:.1} %"),
    }
}

/// A value with its interval, one decimal.
fn range(interval: Interval, factor: f64) -> String {
    let Interval { value, low, high } = interval.scaled(factor);
    format!("{value:.1} ({low:.1} to {high:.1})")
}
