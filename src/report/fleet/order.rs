//! Urgency: what is due first comes first.
//!
//! In this order: the reaction (shutdown, as soon as possible, next interval; then what is not known: not read, then without a verdict;
//! then none), the severity of the alarms, the time to the limit, the probability of a leak, the name.
use super::row::{Cylinder, Finding};
use crate::detector::monitor::{Outcome, Verdict};
use crate::detector::prognosis::{Passage, Reaction};
use std::cmp::Ordering;

/// What a row says at a glance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Light {
    /// Gas was lost, or something is due at once.
    Act,
    /// Something is due at the next service, or a sensor is at fault.
    Plan,
    /// It cannot be told.
    Unknown,
    /// Nothing is due.
    Fine,
}

impl Light {
    /// All, the most urgent first.
    pub(crate) const ALL: [Self; 4] = [Self::Act, Self::Plan, Self::Unknown, Self::Fine];

    /// Its word.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Act => "act",
            Self::Plan => "plan",
            Self::Unknown => "unknown",
            Self::Fine => "fine",
        }
    }
}

impl Cylinder {
    /// Its light.
    pub(crate) fn light(&self) -> Light {
        let Some(found) = &self.found else { return Light::Unknown };
        let is_at_fault = found.verdict == Verdict::SensorFault || found.at_fault().next().is_some();
        match (found.outcome, found.reaction) {
            (Outcome::Loss, _) | (_, Some(Reaction::Shutdown | Reaction::AsSoonAsPossible)) => Light::Act,
            (_, Some(Reaction::NextInterval)) => Light::Plan,
            (Outcome::Unknown, _) | (_, None) => Light::Unknown,
            (_, Some(Reaction::None)) if is_at_fault => Light::Plan,
            (_, Some(Reaction::None)) => Light::Fine,
        }
    }

    /// Rank of the reaction, the most urgent highest.
    fn rank(&self) -> u8 {
        match self.found.as_ref().map(|found| (found.reaction, found.outcome)) {
            Some((Some(Reaction::Shutdown), _)) => 5,
            Some((Some(Reaction::AsSoonAsPossible), _)) => 4,
            Some((Some(Reaction::NextInterval), _)) => 3,
            None => 2,
            Some((None, _) | (Some(Reaction::None), Outcome::Unknown)) => 1,
            Some((Some(Reaction::None), _)) => 0,
        }
    }

    fn severity(&self) -> u16 {
        self.found.as_ref().map_or(0, |found| found.severity)
    }
}

/// Median time to the limit, s; infinite beyond the horizon and where it is not known.
fn left_s(found: &Finding) -> f64 {
    match found.left.map(|left| left.p50) {
        Some(Passage::Reached) => 0.0,
        Some(Passage::In(time_s)) => time_s,
        Some(Passage::BeyondHorizon | Passage::Unknown) | None => f64::INFINITY,
    }
}

/// What urgency goes by before the name, the lowest first; infinite: beyond the horizon or not known.
pub(super) fn key(one: &Cylinder) -> [f64; 4] {
    let left_s = one.found.as_ref().map_or(f64::INFINITY, left_s);
    let probability = one.found.as_ref().and_then(|found| found.leak_probability).unwrap_or(0.0);
    [-f64::from(one.rank()), -f64::from(one.severity()), left_s, -probability]
}

fn compare(a: &Cylinder, b: &Cylinder) -> Ordering {
    let by_key = key(a).into_iter().zip(key(b)).map(|(a, b)| a.total_cmp(&b));
    by_key.fold(Ordering::Equal, Ordering::then).then_with(|| a.name.cmp(&b.name))
}

/// Puts the most urgent first.
pub(crate) fn sort_by_urgency(cylinders: &mut [Cylinder]) {
    cylinders.sort_by(compare);
}
