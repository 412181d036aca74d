//! From a plan to its worlds, and to the simulations behind them.
use cylwatch_thermal::units::{DAY_S, HOUR_S, MINUTE_S};
use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Check, GroupDocument, OverlayDocument, Pattern, Plan, Role};
use crate::judge::JudgeError;
use crate::world::{FaultRow, Leak, Overlay, Request, SimulationKey};

/// Shortest and longest log, s.
const LENGTHS_S: std::ops::RangeInclusive<f64> = 900.0..=400.0 * DAY_S;
/// Turns between the beginnings of two groups: prime to the numbers of kinds of all axes.
const GROUP_STRIDE: usize = 13;
/// Most rows of one log: a year of 2 min is 0.26 million, and a row takes about 150 bytes.
const MOST_ROWS: f64 = 5e6;

/// A world of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// What is asked for.
    pub request: Request,
    /// What its family is for.
    pub role: Role,
    /// Candidates that watch, by their index.
    pub candidates: Vec<usize>,
}

/// Worlds that one simulation serves.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// What must be simulated: the longest log and the closest rows of all.
    pub simulated: Request,
    /// Its worlds by their index in the plan.
    pub tasks: Vec<usize>,
}

/// All worlds of a plan, in its order.
pub(super) fn tasks(plan: &Plan, check: &Check<'_>) -> Result<Vec<Task>, JudgeError> {
    let mut tasks = Vec::new();
    for (group_index, group) in plan.document.group.iter().enumerate() {
        let length_s = length_s(group, check)?;
        let candidates = watching(plan, group, check)?;
        let (first, last) = group.seeds;
        let key = |name: &str| format!("group.{}.{name}", group.name);
        check.that(first <= last, &key("seeds"), format!("{first}, {last}"), "first and last seed")?;
        check.that(group.sensor_sets > 0, &key("sensor_sets"), 0, "must be at least 1")?;
        let overlays = overlays(group, length_s, check)?;
        for text in &group.families {
            let pattern: Pattern = check.parsed(&key("families"), text)?;
            for seed in first..=last {
                let count = pattern.combinations();
                // Groups begin their turns apart, so that not all of them pair the same kinds.
                let turn =
                    |number: usize| (seed - first) as usize * count + number + GROUP_STRIDE * group_index;
                for family in pattern.families(turn) {
                    let remedy = "must match `tune` or `judge`, and not both";
                    let role =
                        plan.role(&family).ok_or_else(|| check.refuse(&key("families"), family, remedy))?;
                    let rows = length_s / family.rows.interval_s();
                    let remedy = "has more rows than 5 million: ask for a shorter log or rows farther apart";
                    check.that(rows <= MOST_ROWS, &key("families"), family, remedy)?;
                    for set in 0..group.sensor_sets {
                        for laid in &overlays {
                            let overlay = laid.drawn(seed);
                            let request = Request { family, seed, set, length_s, overlay };
                            tasks.push(Task { request, role, candidates: candidates.clone() });
                        }
                    }
                }
            }
        }
    }
    check.that(
        !tasks.is_empty(),
        "group",
        "none",
        "give at least one [[group]] with families and overlays",
    )?;
    Ok(tasks)
}

fn length_s(group: &GroupDocument, check: &Check<'_>) -> Result<f64, JudgeError> {
    let key = format!("group.{}.length_d", group.name);
    let given = [
        group.length_min.map(|length| length * MINUTE_S),
        group.length_h.map(|length| length * HOUR_S),
        group.length_d.map(|length| length * DAY_S),
    ];
    let lengths: Vec<f64> = given.into_iter().flatten().collect();
    let &[length_s] = &lengths[..] else {
        let remedy = "give one of length_min, length_h, length_d";
        return Err(check.refuse(&key, format!("{} lengths", lengths.len()), remedy));
    };
    let remedy = "must be between 15 min and 400 d";
    check.that(LENGTHS_S.contains(&length_s), &key, length_s / DAY_S, remedy)?;
    Ok(length_s)
}

fn watching(plan: &Plan, group: &GroupDocument, check: &Check<'_>) -> Result<Vec<usize>, JudgeError> {
    if group.candidates.is_empty() {
        return Ok((0..plan.candidates.len()).collect());
    }
    let names: Vec<&str> = plan.candidates.iter().map(|named| named.name.as_str()).collect();
    let index = |name: &String| {
        let remedy = format!("is no candidate of the plan; known are {}", names.join(", "));
        let key = format!("group.{}.candidates", group.name);
        names.iter().position(|known| known == name).ok_or_else(|| check.refuse(&key, name, &remedy))
    };
    group.candidates.iter().map(index).collect()
}

/// An overlay whose onset is still to be drawn.
struct Laid {
    overlay: Overlay,
    onset_s: (f64, f64),
}

impl Laid {
    /// The overlay of a seed: all overlays of a seed have the same share of their range of onsets.
    fn drawn(&self, seed: u64) -> Overlay {
        let share: f64 = ChaCha8Rng::seed_from_u64(seed).random();
        let at_s = self.onset_s.0 + share * (self.onset_s.1 - self.onset_s.0);
        let mut overlay = self.overlay;
        match &mut overlay {
            Overlay::Nothing => {}
            Overlay::Leak { onset_s, .. }
            | Overlay::FastLoss { onset_s, .. }
            | Overlay::Discharge { onset_s, .. }
            | Overlay::Refill { onset_s, .. } => *onset_s = at_s,
            Overlay::Fault { onset_s, leak, .. } => {
                *onset_s = at_s;
                if let Some(leak) = leak {
                    leak.onset_s += at_s;
                }
            }
        }
        overlay
    }
}

fn overlays(group: &GroupDocument, length_s: f64, check: &Check<'_>) -> Result<Vec<Laid>, JudgeError> {
    let key = |name: &str| format!("group.{}.overlays.{name}", group.name);
    check.that(!group.overlays.is_empty(), &key("kind"), "none", "give at least { kind = \"nothing\" }")?;
    let mut all = Vec::new();
    for document in &group.overlays {
        let (bare, onset_h) = bare(document, &key, check)?;
        let onset_s = (onset_h.0 * HOUR_S, onset_h.1 * HOUR_S);
        let within = 0.0 <= onset_s.0 && onset_s.0 <= onset_s.1 && onset_s.1 < length_s;
        let remedy = "must be earliest and latest, at least 0 and before the end of the log";
        check.that(within, &key("onset_h"), format!("{}, {}", onset_h.0, onset_h.1), remedy)?;
        all.extend(bare.into_iter().map(|overlay| Laid { overlay, onset_s }));
    }
    Ok(all)
}

type Bare = (Vec<Overlay>, (f64, f64));

/// The overlays of an entry without their onsets, h.
fn bare(
    document: &OverlayDocument,
    key: &dyn Fn(&str) -> String,
    check: &Check<'_>,
) -> Result<Bare, JudgeError> {
    let positive = |name: &str, values: &[f64], most: f64| {
        let remedy = format!("must be above 0 and at most {most}");
        values
            .iter()
            .try_for_each(|value| check.that(*value > 0.0 && *value <= most, &key(name), value, &remedy))
    };
    let at = 0.0;
    Ok(match document {
        OverlayDocument::Nothing => (vec![Overlay::Nothing], (0.0, 0.0)),
        OverlayDocument::Leak { part_per_h, onset_h } => {
            positive("part_per_h", part_per_h, 10.0)?;
            let leak = |part: &f64| Overlay::Leak { part_per_h: *part, onset_s: at };
            (part_per_h.iter().map(leak).collect(), *onset_h)
        }
        &OverlayDocument::FastLoss { ref part, within_min, onset_h, goes_on } => {
            positive("part", part, 0.95)?;
            positive("within_min", &[within_min], 1e4)?;
            let within_s = within_min * MINUTE_S;
            let loss = |part: &f64| Overlay::FastLoss { part: *part, within_s, onset_s: at, goes_on };
            (part.iter().map(loss).collect(), onset_h)
        }
        &OverlayDocument::Discharge { ref part, within_min, onset_h, announced } => {
            positive("part", part, 0.95)?;
            positive("within_min", &[within_min], 1e4)?;
            let within_s = within_min * MINUTE_S;
            let discharge = |part: &f64| Overlay::Discharge { part: *part, within_s, onset_s: at, announced };
            (part.iter().map(discharge).collect(), onset_h)
        }
        &OverlayDocument::Refill { ref part, within_min, onset_h } => {
            positive("part", part, 10.0)?;
            positive("within_min", &[within_min], 1e4)?;
            let within_s = within_min * MINUTE_S;
            let refill = |part: &f64| Overlay::Refill { part: *part, within_s, onset_s: at };
            (part.iter().map(refill).collect(), onset_h)
        }
        OverlayDocument::Fault { rows, onset_h, leak_part_per_h, leak_after_h } => {
            let remedy = "must be between 0 and 10, 0 for none";
            check.that(
                (0.0..=10.0).contains(leak_part_per_h),
                &key("leak_part_per_h"),
                leak_part_per_h,
                remedy,
            )?;
            let within = (0.0..=1e4).contains(leak_after_h);
            check.that(within, &key("leak_after_h"), leak_after_h, "must be between 0 and 10 000")?;
            let leak = Leak { part_per_h: *leak_part_per_h, onset_s: leak_after_h * HOUR_S };
            let leak = Some(leak).filter(|leak| leak.part_per_h > 0.0);
            let named = |name: &String| {
                let remedy = "is no row of the fault table: P1 to P7, T1 to T7, E1 to E7, G1 to G5, D1 to D5";
                let found = FaultRow::ALL.into_iter().find(|row| row.name() == *name);
                found.ok_or_else(|| check.refuse(&key("rows"), name, remedy))
            };
            let rows: Vec<FaultRow> = match &rows[..] {
                [] => FaultRow::ALL.to_vec(),
                rows => rows.iter().map(named).collect::<Result<_, _>>()?,
            };
            (rows.into_iter().map(|row| Overlay::Fault { row, onset_s: at, leak }).collect(), *onset_h)
        }
    })
}

/// Worlds by the simulation that they share, in the order of their first one.
pub(super) fn units(tasks: &[Task]) -> Vec<Unit> {
    let mut by_key: BTreeMap<(SimulationKey, u64, String), usize> = BTreeMap::new();
    let mut units: Vec<Unit> = Vec::new();
    for (index, task) in tasks.iter().enumerate() {
        let request = task.request;
        let simulated = request.overlay.is_simulated(request.length_s);
        let flow = if simulated { format!("{:?}", request.overlay) } else { String::new() };
        let key = (SimulationKey::of(&request), request.length_s.to_bits(), flow);
        let place = *by_key.entry(key).or_insert_with(|| {
            let overlay = if simulated { request.overlay } else { Overlay::Nothing };
            units.push(Unit { simulated: Request { overlay, ..request }, tasks: Vec::new() });
            units.len() - 1
        });
        let unit = &mut units[place];
        if request.family.rows.interval_s() < unit.simulated.family.rows.interval_s() {
            unit.simulated.family.rows = request.family.rows;
        }
        unit.tasks.push(index);
    }
    units
}
