//! What is left of a cylinder when its log has gone.
use crate::detector::monitor::{Health, Interval, Outcome, Verdict};
use crate::detector::prognosis::{Quantiles, Reaction};
use crate::report::monitor::{Summary, health_text, health_word, reaction_reason, summary};
use crate::report::{Block, Input};
use serde::{Deserialize, Serialize};

/// A file that was read, with the SHA-256 of its bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Source {
    /// Path.
    pub name: String,
    /// SHA-256 in hexadecimal.
    pub sha256: String,
}

impl From<Input> for Source {
    fn from(input: Input) -> Self {
        Self { name: input.name, sha256: input.sha256 }
    }
}

/// A cylinder of a fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Cylinder {
    /// Its name.
    pub name: String,
    /// Vessel as it was named; empty: none was.
    pub vessel: String,
    /// What was read.
    pub logs: Vec<Source>,
    /// What was found; `None`: nothing could be, and a [`Fault`] says why.
    pub found: Option<Finding>,
    /// Why nothing was found, and what to do; empty: something was.
    pub fault: String,
    /// What was cautioned about.
    pub cautions: Vec<String>,
    /// Events and changes of alarms.
    pub events: usize,
    /// The last of them in words.
    pub last_events: Vec<String>,
}

/// What the monitor found of a cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Finding {
    /// Whether gas was lost in any row, else what the last row says.
    pub outcome: Outcome,
    /// Verdict at the last row.
    pub verdict: Verdict,
    /// Probability of a leak.
    pub leak_probability: Option<f64>,
    /// Pressure at 15 °C, Pa.
    pub p15_pa: f64,
    /// Operational limit, Pa.
    pub limit_pa: f64,
    /// Pressure that will be read at the coldest temperature expected, Pa.
    pub cold_pa: f64,
    /// Mass lost since the leak began, kg; `None`: no leak is found.
    pub lost_kg: Option<Interval>,
    /// Leak rate, kg/s.
    pub leak_rate_kg_s: Interval,
    /// Time to the limit at 15 °C; `None`: not known yet.
    pub left: Option<Quantiles>,
    /// What is due; `None`: not known yet.
    pub reaction: Option<Reaction>,
    /// Why it is due.
    pub due_because: String,
    /// Severity of the worst alarm that stands; 0: none does.
    pub severity: u16,
    /// Names of the alarms that stand.
    pub alarms: Vec<String>,
    /// Sensors: name, health in a word, and in words what is wrong; no words: nothing is.
    pub sensors: Vec<(String, String, String)>,
    /// Rows.
    pub rows: u64,
    /// Times of the first and the last row, s.
    pub span_s: (f64, f64),
    /// The same as dates; empty: the log has none.
    pub span: (String, String),
    /// The run in words: names and values.
    pub facts: Vec<(String, String)>,
    /// Course of the pressure at 15 °C, Pa; NaN: not known.
    pub course_pa: Vec<f64>,
}

impl Finding {
    /// Of the summary of a run.
    pub(crate) fn of(run: &Summary, course_pa: Vec<f64>) -> Self {
        let last = &run.last;
        let alarms = run.alarms.retained();
        let clock = &run.naming.clock;
        let span_s = run.sampling.span_s();
        let date = |time_s: f64| clock.date_of_log(time_s).unwrap_or_default();
        let sensors = last.health.iter().zip(&run.naming.sensors).map(|(health, (name, quantity))| {
            let words = if *health == Health::Good { String::new() } else { health_text(*health, *quantity) };
            (name.clone(), health_word(*health).to_owned(), words)
        });
        let facts = summary(run).blocks.into_iter().find_map(|block| match block {
            Block::Facts(facts) => Some(facts),
            _ => None,
        });
        let due_because = match (&last.outlook, last.decision.reaction) {
            (Some(outlook), Some(reaction)) if reaction == outlook.advice.reaction => {
                reaction_reason(&outlook.advice, run.limits.next_service_s)
            }
            (_, Some(_)) => "gas is being lost".to_owned(),
            (_, None) => String::new(),
        };
        Self {
            outcome: run.outcome(),
            verdict: last.decision.verdict,
            leak_probability: last.decision.leak_probability,
            p15_pa: last.estimate.p15_pa,
            limit_pa: run.limits.limit_pa,
            cold_pa: last.cold_pressure_pa,
            lost_kg: last.leak.map(|leak| leak.lost_kg),
            leak_rate_kg_s: last.leak_rate_kg_s,
            left: last.outlook.map(|outlook| outlook.operational),
            reaction: last.decision.reaction,
            due_because,
            severity: alarms
                .iter()
                .filter(|(_, alarm)| alarm.active)
                .map(|(_, alarm)| alarm.severity)
                .max()
                .unwrap_or(0),
            alarms: alarms.iter().map(|(name, _)| name.as_str().to_owned()).collect(),
            sensors: sensors.collect(),
            rows: run.sampling.rows(),
            span_s,
            span: (date(span_s.0), date(span_s.1)),
            facts: facts.unwrap_or_default(),
            course_pa,
        }
    }

    /// The same after earlier rows of the cylinder: whether gas was lost in those counts, too.
    pub(crate) fn after(mut self, earlier: &Self) -> Self {
        if earlier.outcome == Outcome::Loss {
            self.outcome = Outcome::Loss;
        }
        self
    }

    /// Sensors that are not good.
    pub(super) fn at_fault(&self) -> impl Iterator<Item = &(String, String, String)> {
        self.sensors.iter().filter(|(_, _, words)| !words.is_empty())
    }
}

/// Something that could not be read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Fault {
    /// Cylinder; empty: of none in particular.
    pub cylinder: String,
    /// File.
    pub file: String,
    /// Line or row of it, from 1.
    pub line: Option<u64>,
    /// What is wrong.
    pub reason: String,
    /// What to do.
    pub remedy: String,
}

impl Fault {
    /// What to do where a message does not say it.
    const REMEDY: &str = "look at the file, or run `cylwatch inspect` on it";

    /// Of the message of an error, which names the place first and the remedy last.
    pub(crate) fn of(cylinder: &str, file: &str, message: &str) -> Self {
        let rest = message.strip_prefix(file).unwrap_or(message);
        let (line, rest) = match rest.strip_prefix(':').or_else(|| rest.strip_prefix(" row ")) {
            Some(numbered) => {
                let end = numbered.find(|c: char| !c.is_ascii_digit()).unwrap_or(numbered.len());
                match numbered[..end].parse() {
                    Ok(line) => (Some(line), &numbered[end..]),
                    Err(_) => (None, rest),
                }
            }
            None => (None, rest),
        };
        // A message may go on from the name: `log.csv has no header`.
        let it =
            if line.is_none() && rest.len() < message.len() && rest.starts_with(' ') { "it " } else { "" };
        let rest = format!("{it}{}", rest.trim_start_matches([':', ' ']));
        let (reason, remedy) = match rest.rsplit_once(": ") {
            Some((reason, remedy)) if !remedy.contains("os error") => (reason, remedy),
            _ => (rest.as_str(), Self::REMEDY),
        };
        let text = |words: &str| words.trim().to_owned();
        Self {
            cylinder: cylinder.to_owned(),
            file: file.to_owned(),
            line,
            reason: text(reason),
            remedy: text(remedy),
        }
    }

    /// In one line.
    pub(crate) fn words(&self) -> String {
        let line = self.line.map_or(String::new(), |line| format!(":{line}"));
        format!("{}{line}: {}: {}", self.file, self.reason, self.remedy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_taken_apart_into_line_reason_and_remedy() {
        for (message, line, reason, remedy) in [
            ("a.csv:3: the row is long: look for a mark", Some(3), "the row is long", "look for a mark"),
            ("a.csv row 12: time is off: sort", Some(12), "time is off", "sort"),
            (
                "a.csv has no header: the first line names the columns",
                None,
                "it has no header",
                "the first line names the columns",
            ),
            (
                "a.csv cannot be read: denied (os error 13)",
                None,
                "it cannot be read: denied (os error 13)",
                Fault::REMEDY,
            ),
        ] {
            let fault = Fault::of("A", "a.csv", message);
            assert_eq!((fault.line, fault.reason.as_str(), fault.remedy.as_str()), (line, reason, remedy));
        }
    }
}
