//! Toy worlds whose readings are the truth, and candidates that are right or wrong in known ways.
//!
//! The reading `shoulder` is the gas temperature, `valve` the mass flow out, `pressure` the mass: a candidate of a test can be perfect, or
//! wrong on purpose.
use std::sync::{Arc, OnceLock};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use serde_json::Value;

use super::JudgeError;
use super::candidate::{Candidate, CandidateRun, Kind, Registry, Row};
use super::measures::Class;
use super::plan::Plan;
use super::run::{RunSettings, Source, run};
use super::statement::{Decision, Estimated, Estimates, Innovation, Statement, normal};
use super::table::{GroupReport, Table};
use crate::detector::prognosis::Reaction;
use crate::world::{
    Family, OperatorData, Overlay, Regime, Request, SimulationKey, Truth, World, WorldError, WorldEvent,
    WorldEventKind, generate,
};

/// Gas of every toy world, kg.
pub(super) const WHOLE_KG: f64 = 4.0;
/// Pressure at 15 °C of all of it, Pa.
pub(super) const FULL_PA: f64 = 200e5;
const GAS_K: f64 = 288.15;

/// Makes toy worlds at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Toys;

impl Source for Toys {
    type Simulated = ();

    fn simulate(&self, _: &Request) -> Result<(), WorldError> {
        Ok(())
    }

    fn world(&self, (): &(), request: &Request) -> Result<World, WorldError> {
        Ok(world(request))
    }
}

/// The toy world of a request.
pub(super) fn world(request: &Request) -> World {
    static REAL: OnceLock<World> = OnceLock::new();
    let mut world =
        REAL.get_or_init(|| generate(&Request::tight(Family::usual(), 1, 900.0)).unwrap()).clone();
    let interval_s = request.family.rows.interval_s();
    let rows = (request.length_s / interval_s) as usize + 1;
    let time_s: Vec<f64> = (0..rows).map(|row| interval_s * row as f64).collect();
    let lost = |t: f64| lost_part(&request.overlay, t);
    let all = |value: f64| vec![value; rows];
    let mass_kg: Vec<f64> = time_s.iter().map(|t| WHOLE_KG * (1.0 - lost(*t))).collect();
    // Every world has readings of its own.
    let phase: f64 =
        format!("{request:?}").bytes().enumerate().map(|(n, byte)| f64::from(byte) * (n as f64).sqrt()).sum();
    let flow = |t: &f64| WHOLE_KG * (lost(*t + 1e-3) - lost(*t)) / 1e-3;
    world.truth = Truth {
        gas_mean_k: time_s.iter().map(|t| GAS_K + 5.0 * (t / 7000.0 + phase).sin()).collect(),
        mass_absolute_kg: mass_kg.clone(),
        pressure_pa: all(FULL_PA),
        settled_pa: mass_kg.iter().map(|mass_kg| FULL_PA * mass_kg / WHOLE_KG).collect(),
        outflow_kg_s: time_s.iter().map(flow).collect(),
        air_k: all(GAS_K),
        wall_mean_k: all(GAS_K),
        shoulder_k: all(GAS_K),
        valve_k: all(GAS_K),
        regime: (0..rows).map(|row| Regime::ALL[row / 50 % 5]).collect(),
        mass_kg,
        time_s,
    };
    let truth = &world.truth;
    world.log.time_s.clone_from(&truth.time_s);
    world.log.values = (0..rows)
        .flat_map(|row| [truth.gas_mean_k[row], truth.outflow_kg_s[row], truth.mass_kg[row]])
        .collect();
    (world.historical, world.power_cycles, world.fault) = (Vec::new(), Vec::new(), None);
    world.operator_data.announced = match request.overlay {
        Overlay::Discharge { onset_s, within_s, announced: true, .. } => vec![(onset_s, onset_s + within_s)],
        _ => Vec::new(),
    };
    world.events = request.overlay.leak().map(|leak| event(leak.onset_s)).into_iter().collect();
    (world.request, world.simulation) = (*request, SimulationKey::of(request));
    world
}

fn event(start_s: f64) -> WorldEvent {
    let (kind, end_s) = (WorldEventKind::Leak, f64::MAX);
    WorldEvent { kind, start_s, end_s, lost_kg: 0.1, announced: false }
}

/// Part of the gas that is lost at a time.
fn lost_part(overlay: &Overlay, t: f64) -> f64 {
    let of_leak = overlay.leak().map_or(0.0, |leak| leak.part_per_h / 3600.0 * (t - leak.onset_s).max(0.0));
    match *overlay {
        Overlay::FastLoss { part, within_s, onset_s, .. }
        | Overlay::Discharge { part, within_s, onset_s, .. } => {
            part * ((t - onset_s) / within_s).clamp(0.0, 1.0)
        }
        _ => of_leak,
    }
}

/// What a candidate of the tests says, from the truth.
type Say = fn(&mut ChaCha8Rng, &Row<'_>) -> Statement;

/// A candidate of the tests.
pub(super) struct Toy {
    say: Say,
    threshold: bool,
}

struct Saying(Say, ChaCha8Rng, u64);

impl Candidate for Toy {
    fn start(&self, _: &OperatorData) -> Result<Box<dyn CandidateRun>, JudgeError> {
        Ok(Box::new(Saying(self.say, ChaCha8Rng::seed_from_u64(0), 0)))
    }

    fn needs_threshold(&self) -> bool {
        self.threshold
    }
}

impl CandidateRun for Saying {
    fn step(&mut self, row: &Row<'_>, statements: &mut Vec<Statement>) -> Result<(), JudgeError> {
        // Worlds of other readings have other errors.
        self.2 = self.2.wrapping_mul(31).wrapping_add(row.readings[0].to_bits() ^ row.readings[2].to_bits());
        if row.stamp_s == 0.0 {
            self.1 = ChaCha8Rng::seed_from_u64(self.2);
        }
        statements.push(Statement { stamp_s: row.stamp_s, ..(self.0)(&mut self.1, row) });
        Ok(())
    }
}

/// A candidate that says so.
pub(super) fn toy(say: Say) -> Arc<dyn Candidate> {
    Arc::new(Toy { say, threshold: false })
}

/// A decision in which everything agrees.
pub(super) fn decided(class: Class) -> Decision {
    let loss = matches!(class, Class::Leak | Class::Discharge);
    let reaction = if loss { Reaction::AsSoonAsPossible } else { Reaction::None };
    Decision {
        class,
        leak: class == Class::Leak,
        loss,
        leak_probability: if class == Class::Unknown { None } else { Some(f64::from(u8::from(loss))) },
        alarm: Some(loss),
        reaction: Some(reaction),
        exit_code: match class {
            Class::Unknown => 3,
            _ => u8::from(loss),
        },
        sensor_named: class == Class::SensorFault,
        exchange: matches!(class, Class::Discharge | Class::Refill),
    }
}

fn always(class: Class) -> Statement {
    Statement { decision: Some(decided(class)), ..Statement::default() }
}

/// States the truth, exactly.
fn perfect(_: &mut ChaCha8Rng, row: &Row<'_>) -> Statement {
    let exact = |value: f64| Some(Estimated { value, interval: Some((value - 1e-9, value + 1e-9)) });
    let lost = row.readings[2] < WHOLE_KG || row.readings[1] > 0.0;
    let estimates = Estimates {
        mass_kg: exact(row.readings[2]),
        gas_mean_k: exact(row.readings[0]),
        leak_kg_s: exact(row.readings[1]),
        onset_s: None,
    };
    Statement { estimates, ..always(if lost { Class::Leak } else { Class::Tight }) }
}

/// States the truth with normal errors that it knows, and innovations that are white and as large as stated.
fn honest(random: &mut ChaCha8Rng, row: &Row<'_>) -> Statement {
    let mut draw = |value: f64, sd: f64| {
        let error: f64 = random.sample(StandardNormal);
        Some(normal(value + sd * error, sd))
    };
    let estimates = Estimates {
        mass_kg: draw(row.readings[2], 0.01),
        gas_mean_k: draw(row.readings[0], 0.1),
        leak_kg_s: draw(row.readings[1], 1e-6),
        onset_s: None,
    };
    let free: f64 = random.sample(StandardNormal);
    let nu: f64 = random.sample(StandardNormal);
    Statement {
        estimates,
        innovation: Some(Innovation { nu: 3.0 * nu, s: 9.0 }),
        free_mass_kg: Some(row.readings[2] + 0.02 * free),
        ..Statement::default()
    }
}

/// Finds a leak when a thousandth of the gas is lost.
fn lawful(_: &mut ChaCha8Rng, row: &Row<'_>) -> Statement {
    always(if row.readings[2] < WHOLE_KG * (1.0 - 1e-3) { Class::Leak } else { Class::Tight })
}

/// Tight, and probably leaking, in every tenth row.
fn contradictory(_: &mut ChaCha8Rng, row: &Row<'_>) -> Statement {
    let mut statement = always(Class::Tight);
    if ((row.stamp_s / 120.0) as u64).is_multiple_of(10) {
        statement.decision = Some(Decision { leak_probability: Some(0.99), ..decided(Class::Tight) });
    }
    statement
}

/// Lost mass as a statistic.
fn lost_mass(random: &mut ChaCha8Rng, row: &Row<'_>) -> Statement {
    let error: f64 = random.sample(StandardNormal);
    let lost = 1.0 - row.readings[2] / WHOLE_KG;
    Statement { statistic: Some(lost + 1e-5 * error), ..Statement::default() }
}

/// Kinds of the tests.
pub(super) fn registry() -> Registry {
    let mut registry = Registry::default();
    let kinds: [(&str, Kind); 8] = [
        ("perfect", |_| Ok(toy(perfect))),
        ("leaks", |_| Ok(toy(|_, _| always(Class::Leak)))),
        ("unknowns", |_| Ok(toy(|_, _| always(Class::Unknown)))),
        ("tights", |_| Ok(toy(|_, _| always(Class::Tight)))),
        ("honest", |_| Ok(toy(honest))),
        ("lawful", |_| Ok(toy(lawful))),
        ("contradictory", |_| Ok(toy(contradictory))),
        ("lost-mass", |_: &Value| Ok(Arc::new(Toy { say: lost_mass, threshold: true }))),
    ];
    kinds.iter().for_each(|(name, kind)| registry.register(name, *kind));
    registry
}

/// A plan of some kinds over groups that are written out.
pub(super) fn plan(kinds: &[&str], groups: &str) -> Plan {
    let candidates: String =
        kinds.iter().map(|kind| format!("[[candidate]]\nname = \"{kind}\"\nkind = \"{kind}\"\n")).collect();
    let text = format!(
        "title = \"toys\"\nbetween_false_alarms_y = 10.0\ntune = [\"*/workshop/*/*/*\"]\n\
         judge = [\"*/railway|desert/*/*/*\"]\n{candidates}{groups}"
    );
    Plan::parse(&text, "toys.toml", &registry(), &[]).unwrap()
}

/// A group of toy worlds.
pub(super) fn group(families: &str, seeds: (u64, u64), length_d: f64, overlays: &str) -> String {
    format!(
        "[[group]]\nname = \"toys\"\nfamilies = [\"{families}\"]\nseeds = [{}, {}]\nlength_d = {length_d:.3}\n\
         sensor_sets = 1\noverlays = [{overlays}]\n",
        seeds.0, seeds.1
    )
}

/// Settings of a run in a folder.
pub(super) fn settings(folder: &std::path::Path, threads: usize) -> RunSettings {
    RunSettings { folder: folder.to_owned(), threads, program: "test".to_owned(), most_worlds: None }
}

/// Run a plan of toys; its table.
pub(super) fn judged(plan: &Plan) -> Table {
    let folder = tempfile::tempdir().unwrap();
    let table = run(plan, &Toys, &settings(folder.path(), 2), &|_| ()).unwrap();
    assert!(table.is_whole());
    table
}

/// The row of a table for all worlds that judge.
pub(super) fn all(table: &Table, candidate: usize) -> &GroupReport {
    table.candidates[candidate].judged().unwrap()
}

/// A row of a table.
pub(super) fn group_of<'a>(table: &'a Table, candidate: usize, group: &str) -> &'a GroupReport {
    use super::plan::Role;
    let of = table.candidates[candidate].groups.iter();
    of.clone().find(|of| of.role == Role::Judge && of.group == group).unwrap()
}
