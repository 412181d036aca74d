//! A monitored log in a few lines that a person can act on, and as JSON.
use super::event::{finding, health_word, range, verdict};
use super::prognosis::percent;
use super::{Naming, health_text, passage_text, reaction_reason, reaction_text, reaction_word, short};
use crate::detector::monitor::alarm::AlarmPanel;
use crate::detector::monitor::{Decision, Health, LeakFinding, Outcome, Outlook, Output, Verdict};
use crate::detector::prognosis::Quantiles;
use crate::log::{Caution, Sampling};
use crate::report::Report;
use crate::report::estimate::sampling_text;
use crate::report::{BAR_PER_HOUR, GRAM, GRAM_PER_HOUR};
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// What the verdict is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OperatingLimits {
    /// Operational limit, Pa.
    pub limit_pa: f64,
    /// Coldest temperature expected, K.
    pub coldest_k: f64,
    /// Time until the next service, s.
    pub next_service_s: f64,
}

/// Rows that were not simply used, and jumps of the clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct RowCounts {
    /// With nothing new.
    pub duplicates: u64,
    /// With another value than a row of the same time.
    pub contradictions: u64,
    /// Too late.
    pub too_late: u64,
    /// With a time that cannot be.
    pub wild: u64,
    /// Jumps of the clock.
    pub jumps: u64,
}

impl RowCounts {
    /// Together with those of an earlier run.
    pub(crate) fn and(self, earlier: Self) -> Self {
        Self {
            duplicates: self.duplicates + earlier.duplicates,
            contradictions: self.contradictions + earlier.contradictions,
            too_late: self.too_late + earlier.too_late,
            wild: self.wild + earlier.wild,
            jumps: self.jumps + earlier.jumps,
        }
    }
}

/// What is left of a run when its rows have gone.
#[derive(Clone, Debug)]
pub(crate) struct Summary {
    /// Title: vessel and sensors.
    pub title: String,
    /// How the log was sampled.
    pub sampling: Sampling,
    /// What was cautioned about.
    pub cautions: Vec<Caution>,
    /// What times and sensors are called.
    pub naming: Naming,
    /// The last output.
    pub last: Output,
    /// Alarms as they are.
    pub alarms: AlarmPanel,
    /// What the verdict is held against.
    pub limits: OperatingLimits,
    /// Rows that an earlier run has seen already.
    pub known_rows: u64,
    /// Rows that wait for those that may come late.
    pub held_rows: u64,
    /// What became of rows that were not simply used.
    pub row_counts: RowCounts,
    /// Whether gas was lost in any of these rows.
    pub loss_found: bool,
    /// Whether the run continues an earlier one.
    pub continued: bool,
}

/// The run in a few lines.
pub(crate) fn summary(summary: &Summary) -> Report {
    let decision = &summary.last.decision;
    let mut facts = vec![("verdict", decision_text(decision))];
    facts.extend(summary.last.leak.iter().flat_map(|leak| leak_rows(leak, &summary.naming)));
    if summary.last.leak.is_none() {
        facts.push(("leak", no_leak_text(&summary.last)));
    }
    facts.extend(pressure_rows(summary));
    if let Some(outlook) = &summary.last.outlook {
        facts.extend(outlook_rows(outlook, decision, summary.limits.next_service_s));
    }
    facts.extend(alarm_rows(summary));
    facts.push(("sensors", sensors(&summary.last.health, &summary.naming)));
    facts.push(("log", log(summary)));
    Report::new(&summary.title).facts(facts)
}

/// The verdict, with what it means where the word alone does not say it.
fn decision_text(decision: &Decision) -> String {
    let announced = match (decision.verdict, decision.outcome) {
        (Verdict::Discharge, Outcome::Loss) => ", not announced: gas is lost",
        (Verdict::Discharge, _) => ", announced",
        _ => "",
    };
    format!("{}{announced}", decision.verdict)
}

/// What is known of a leak where none is found.
fn no_leak_text(last: &Output) -> String {
    let largest = format!("{} g/h", short(last.leak_rate_kg_s.high * GRAM_PER_HOUR));
    match (last.decision.outcome, last.decision.leak_probability) {
        (Outcome::Loss, _) => "gas went out fast: see the events".to_owned(),
        (_, None) => format!("not known yet; the readings allow up to {largest}"),
        (_, Some(probability)) => {
            format!("none found; probability of a leak: {}, at most {largest}", percent(probability))
        }
    }
}

fn leak_rows(leak: &LeakFinding, naming: &Naming) -> [(&'static str, String); 3] {
    let clock = &naming.clock;
    let [onset, from, to] =
        [leak.onset_s.value, leak.onset_s.low, leak.onset_s.high].map(|time_s| clock.text(time_s));
    [
        (
            "leak rate",
            format!(
                "{} g/h, {} bar/h at 15 °C",
                range(leak.rate_kg_s.scaled(GRAM_PER_HOUR)),
                range(leak.rate_pa_s.scaled(BAR_PER_HOUR))
            ),
        ),
        ("since", format!("{onset} ({from} to {to})")),
        ("lost since", format!("{} g", range(leak.lost_kg.scaled(GRAM)))),
    ]
}

fn pressure_rows(summary: &Summary) -> [(&'static str, String); 2] {
    let OperatingLimits { limit_pa, coldest_k, .. } = summary.limits;
    let held = |pressure_pa: f64| {
        let limit = short(limit_pa / BAR_PA);
        match pressure_pa {
            p if p.is_nan() => format!("limit {limit} bar"),
            p if p > limit_pa => format!("above the limit of {limit} bar"),
            _ => format!("at or below the limit of {limit} bar"),
        }
    };
    let [p15_pa, cold_pa] = [summary.last.estimate.p15_pa, summary.last.cold_pressure_pa];
    let degc = coldest_k - ZERO_CELSIUS_K;
    [
        ("pressure at 15 °C", format!("{:.2} bar, {}", p15_pa / BAR_PA, held(p15_pa))),
        (
            "coldest night",
            format!("{:.1} bar will be read at {degc:.0} °C, {}", cold_pa / BAR_PA, held(cold_pa)),
        ),
    ]
}

fn outlook_rows(outlook: &Outlook, decision: &Decision, next_service_s: f64) -> Vec<(&'static str, String)> {
    let left = |quantiles: &Quantiles| {
        let [p5, p50, p95] = [quantiles.p5, quantiles.p50, quantiles.p95]
            .map(|passage| passage_text(passage, quantiles.horizon_s));
        if p5 == p95 { p5 } else { format!("{p5} (5 %), {p50} (50 %), {p95} (95 %)") }
    };
    let advice = &outlook.advice;
    vec![
        ("time to the limit", format!("{} at 15 °C", left(&outlook.operational))),
        ("", format!("{} on the coldest night", left(&outlook.cold))),
        ("to maintenance", left(&outlook.maintenance)),
        (
            "reaction",
            match decision.reaction {
                None => "not known yet".to_owned(),
                Some(reaction) if reaction == advice.reaction => {
                    format!("{}: {}", reaction_text(reaction), reaction_reason(advice, next_service_s))
                }
                Some(reaction) => format!("{}: gas is being lost", reaction_text(reaction)),
            },
        ),
    ]
}

fn alarm_rows(summary: &Summary) -> Vec<(&'static str, String)> {
    let retained = summary.alarms.retained();
    let words = retained
        .iter()
        .map(|(name, condition)| super::alarm::standing(*name, condition, &summary.naming.clock));
    std::iter::once("alarms").chain(std::iter::repeat("")).zip(words).collect()
}

fn sensors(health: &[Health], naming: &Naming) -> String {
    let bad = |(health, (name, quantity)): (&Health, &(String, _))| {
        (*health != Health::Good).then(|| format!("{name} {}", health_text(*health, *quantity)))
    };
    let bad: Vec<String> = health.iter().zip(&naming.sensors).filter_map(bad).collect();
    if bad.is_empty() { "all good".to_owned() } else { bad.join(", ") }
}

fn log(summary: &Summary) -> String {
    let mut text = sampling_text(&summary.sampling);
    let row_counts = &summary.row_counts;
    for (count, one, many) in [
        (summary.known_rows, "known to the state", "known to the state"),
        (summary.held_rows, "waits for late ones", "wait for late ones"),
        (row_counts.duplicates, "came twice", "came twice"),
        (row_counts.contradictions, "contradicts another", "contradict others"),
        (row_counts.too_late, "came too late", "came too late"),
        (row_counts.wild, "has a time that cannot be", "have times that cannot be"),
    ] {
        match count {
            0 => {}
            1 => text.push_str(&format!("; 1 {one}")),
            count => text.push_str(&format!("; {count} {many}")),
        }
    }
    match row_counts.jumps {
        0 => {}
        1 => text.push_str("; the clock jumped once"),
        jumps => text.push_str(&format!("; the clock jumped {jumps} times")),
    }
    match summary.cautions.len() {
        0 => {}
        1 => text.push_str("; 1 caution"),
        many => text.push_str(&format!("; {many} cautions")),
    }
    text
}

/// The run as JSON; null where nothing is known.
pub(crate) fn document(summary: &Summary) -> Value {
    let clock = &summary.naming.clock;
    let sensors: Vec<Value> = summary
        .last
        .health
        .iter()
        .zip(&summary.naming.sensors)
        .map(|(health, (name, _))| json!({ "name": name, "health": health_word(*health) }))
        .collect();
    let alarms: Vec<Value> = summary
        .alarms
        .retained()
        .into_iter()
        .map(|(name, condition)| json!({ "name": name.as_str(), "condition": condition }))
        .collect();
    json!({
        "rows": summary.sampling.rows(),
        "known_rows": summary.known_rows,
        "held_rows": summary.held_rows,
        "duplicates": summary.row_counts.duplicates,
        "contradictions": summary.row_counts.contradictions,
        "too_late": summary.row_counts.too_late,
        "wild_times": summary.row_counts.wild,
        "clock_jumps": summary.row_counts.jumps,
        "duration_s": summary.sampling.duration_s(),
        "continued": summary.continued,
        "time_s": summary.last.stamp_s,
        "time": clock.date_of_log(summary.last.stamp_s),
        "verdict": verdict(summary.last.decision.verdict),
        "outcome": summary.last.decision.outcome,
        "leak": summary.last.leak.as_ref().map(|leak| finding(leak, clock)),
        "loss_found": summary.loss_found,
        "leak_probability": summary.last.decision.leak_probability,
        "leak_rate_high_g_h": summary.last.leak_rate_kg_s.high * GRAM_PER_HOUR,
        "reaction": summary.last.decision.reaction.map(reaction_word),
        "p15_bar": summary.last.estimate.p15_pa / BAR_PA,
        "cold_pressure_bar": summary.last.cold_pressure_pa / BAR_PA,
        "limit_bar": summary.limits.limit_pa / BAR_PA,
        "coldest_degc": summary.limits.coldest_k - ZERO_CELSIUS_K,
        "outlook": summary.last.outlook.as_ref().map(outlook),
        "alarms": alarms,
        "sensors": sensors,
        "cautions": summary.cautions.iter().map(Caution::to_string).collect::<Vec<_>>(),
    })
}

fn outlook(outlook: &Outlook) -> Value {
    use crate::detector::prognosis::Passage;
    // Null is beyond the horizon, 0 reached.
    let days = |passage: Passage| match passage {
        Passage::Reached => Some(0.0),
        Passage::In(time_s) => Some(time_s / 86_400.0),
        Passage::BeyondHorizon | Passage::Unknown => None,
    };
    let left = |q: &Quantiles| json!({ "p5_d": days(q.p5), "p50_d": days(q.p50), "p95_d": days(q.p95), "horizon_d": q.horizon_s / 86_400.0 });
    json!({
        "operational": left(&outlook.operational),
        "cold": left(&outlook.cold),
        "maintenance": left(&outlook.maintenance),
        "known": outlook.known,
        "before_safe_state": outlook.advice.before_safe_state,
        "before_next_service": outlook.advice.before_next_service,
        "before_following_service": outlook.advice.before_following_service,
    })
}

impl Summary {
    /// What the run comes to: a loss if gas was lost in any of its rows, else what its last row says.
    pub(crate) fn outcome(&self) -> Outcome {
        if self.loss_found { Outcome::Loss } else { self.last.decision.outcome }
    }
}
