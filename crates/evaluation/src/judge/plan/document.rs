//! The plan as it is written: a TOML file.
//!
//! ```toml
//! title = "a first look"
//! between_false_alarms_y = 10.0                  # wished mean time, for candidates that need a threshold
//! tune = ["*/hall/*/*/*"]                        # families that thresholds are set on
//! judge = ["*/railway/*/*/*"]                    # families that are reported
//!
//! [[candidate]]
//! name = "cylwatch"
//! kind = "monitor"
//!
//! [[group]]
//! name = "weeks"
//! families = ["nitrogen-20l/railway|hall/mixed/class-b/120s"]
//! seeds = [1, 4]                                 # first and last
//! sensor_sets = 2                                # sets of sensors over one simulation; not independent
//! length_d = 7.0                                 # or length_min, length_h
//! overlays = [{ kind = "nothing" }, { kind = "leak", part_per_h = [1e-4, 1e-3], onset_h = [30.0, 54.0] }]
//! ```
use serde::{Deserialize, Serialize};

/// A plan as written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanDocument {
    /// Title of the table.
    pub title: String,
    /// Wished mean time between false alarms of candidates that need a threshold, and of the shortest possible delay, years.
    pub between_false_alarms_y: f64,
    /// Patterns of families that thresholds are set on.
    #[serde(default)]
    pub tune: Vec<String>,
    /// Patterns of families that judge.
    pub judge: Vec<String>,
    /// Candidates.
    pub candidate: Vec<CandidateDocument>,
    /// Groups of runs.
    pub group: Vec<GroupDocument>,
}

/// A candidate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CandidateDocument {
    /// Name in the table.
    pub name: String,
    /// Kind in the registry.
    pub kind: String,
    /// Settings that are laid over its own.
    #[serde(default)]
    pub settings: Option<toml::Table>,
}

/// A group of runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroupDocument {
    /// Name, for messages.
    pub name: String,
    /// Patterns of families.
    pub families: Vec<String>,
    /// First and last seed.
    pub seeds: (u64, u64),
    /// Sets of sensors over each simulation.
    #[serde(default = "one")]
    pub sensor_sets: u64,
    /// Length of the logs, min; one of the three.
    #[serde(default)]
    pub length_min: Option<f64>,
    /// Length of the logs, h.
    #[serde(default)]
    pub length_h: Option<f64>,
    /// Length of the logs, d.
    #[serde(default)]
    pub length_d: Option<f64>,
    /// What is laid over the simulations; each over all of them.
    pub overlays: Vec<OverlayDocument>,
    /// Names of the candidates that watch; none: all.
    #[serde(default)]
    pub candidates: Vec<String>,
}

const fn one() -> u64 {
    1
}

/// Overlays. Lists are crossed; an onset is drawn evenly between its two bounds by the seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "kind", deny_unknown_fields)]
pub enum OverlayDocument {
    /// A tight cylinder.
    Nothing,
    /// Leaks.
    Leak {
        /// Parts of the fill per hour.
        part_per_h: Vec<f64>,
        /// Earliest and latest onset, h.
        onset_h: (f64, f64),
    },
    /// Fast losses that nobody ordered.
    FastLoss {
        /// Parts of the fill.
        part: Vec<f64>,
        /// Time within which they are lost, min.
        within_min: f64,
        /// Earliest and latest onset, h.
        onset_h: (f64, f64),
        /// Whether the loss goes on at its rate.
        goes_on: bool,
    },
    /// Discharges.
    Discharge {
        /// Parts of the fill.
        part: Vec<f64>,
        /// Time within which they are let out, min.
        within_min: f64,
        /// Earliest and latest onset, h.
        onset_h: (f64, f64),
        /// Whether they are announced.
        announced: bool,
    },
    /// Refills.
    Refill {
        /// Parts of the fill.
        part: Vec<f64>,
        /// Time within which they are put in, min.
        within_min: f64,
        /// Earliest and latest onset, h.
        onset_h: (f64, f64),
    },
    /// Rows of the fault table.
    Fault {
        /// Names, such as `P1`; none: all.
        #[serde(default)]
        rows: Vec<String>,
        /// Earliest and latest onset, h.
        onset_h: (f64, f64),
        /// Leak beside it, part of the fill per hour; 0: none.
        #[serde(default)]
        leak_part_per_h: f64,
        /// Onset of that leak after that of the fault, h.
        #[serde(default)]
        leak_after_h: f64,
    },
}
