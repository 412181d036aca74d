//! Runs a plan: simulates its worlds on all threads, lets the candidates watch, writes journal and tables.
//!
//! Threads claim the simulations of a plan one after the other, in its order. What is finished is in the journal; a run
//! that was killed goes on with what is missing. The table is made from the journal alone, in an order of its own, and now and then while
//! the run goes on. Times of computing stand in a file of their own, so that the table is reproducible.
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use super::JudgeError;
use super::clock::Clock;
use super::cost::{Costs, Times};
use super::entry::{Entry, Facts};
use super::journal::{Binding, Journal};
use super::plan::{Plan, Unit};
use super::score::Score;
use super::score::detection::LeakWatch;
use super::table::{self, Table};
use super::watch::{watch, words_of};
use crate::world::{Request, Simulated, World, WorldError};

/// Shortest time between two partial tables, s.
const PARTIAL_S: f64 = 60.0;
/// A partial table is due when the run has gone on for so many times the time that the last one took.
const PARTIAL_COST: f64 = 50.0;

/// Where worlds come from.
pub trait Source: Sync {
    /// A simulation that several worlds are laid over.
    type Simulated;

    /// Simulate what a request needs.
    ///
    /// # Errors
    /// A request out of range, or a simulation that fails.
    fn simulate(&self, request: &Request) -> Result<Self::Simulated, WorldError>;

    /// The world of a request over a simulation.
    ///
    /// # Errors
    /// A request that needs another simulation.
    fn world(&self, simulated: &Self::Simulated, request: &Request) -> Result<World, WorldError>;
}

/// The worlds of [`crate::world`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Simulator;

impl Source for Simulator {
    type Simulated = Simulated;

    fn simulate(&self, request: &Request) -> Result<Simulated, WorldError> {
        Simulated::run(request)
    }

    fn world(&self, simulated: &Simulated, request: &Request) -> Result<World, WorldError> {
        simulated.world(request)
    }
}

/// How a plan is run.
#[derive(Clone, Debug)]
pub struct RunSettings {
    /// Folder of the results.
    pub folder: PathBuf,
    /// Threads.
    pub threads: usize,
    /// Version of the program, for the binding of the journal.
    pub program: String,
    /// Stop after so many worlds of this run; `None`: go on to the end.
    pub most_worlds: Option<usize>,
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Worlds finished, those of earlier runs included.
    pub done: usize,
    /// Worlds of the plan.
    pub all: usize,
    /// Worlds or scores of this run that failed.
    pub failed: usize,
}

/// Run a plan to its end, or go on with it, write its table and return it. `progress` is told first what earlier runs have done.
///
/// # Errors
/// The folder belongs to another plan, or cannot be written. A world that fails is an entry of the table, not an error.
pub fn run<S: Source>(
    plan: &Plan,
    source: &S,
    settings: &RunSettings,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Table, JudgeError> {
    let binding = Binding { plan: plan.hash()?, program: settings.program.clone() };
    let journal = Journal::open(&settings.folder, &binding)?;
    let costs = Costs::open(&settings.folder)?;
    progress(Progress { done: journal.len(), all: plan.tasks.len(), failed: 0 });
    let missing = |unit: &Unit| -> Vec<usize> {
        unit.tasks.iter().copied().filter(|task| !journal.holds(*task)).collect()
    };
    let pending: Vec<Unit> = plan
        .units()
        .into_iter()
        .map(|unit| Unit { tasks: missing(&unit), ..unit })
        .filter(|unit| !unit.tasks.is_empty())
        .collect();
    let running = Running {
        plan,
        source,
        settings,
        progress,
        pending,
        claimed: AtomicUsize::new(0),
        stop: AtomicBool::new(false),
        shared: Mutex::new(Shared { journal, costs, failed: 0, begun: 0, partial: None, error: None }),
    };
    std::thread::scope(|scope| {
        for _ in 0..settings.threads.max(1) {
            scope.spawn(|| running.work());
        }
    });
    let shared = running.shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(error) = shared.error {
        return Err(error);
    }
    let table = table::write(plan, &mut shared.journal.results()?, &settings.folder)?;
    shared.costs.write(&settings.folder)?;
    Ok(table)
}

struct Running<'a, S> {
    plan: &'a Plan,
    source: &'a S,
    settings: &'a RunSettings,
    progress: &'a (dyn Fn(Progress) + Sync),
    /// Simulations with worlds that are missing.
    pending: Vec<Unit>,
    claimed: AtomicUsize,
    stop: AtomicBool,
    shared: Mutex<Shared>,
}

/// What the threads share.
struct Shared {
    journal: Journal,
    costs: Costs,
    failed: usize,
    begun: usize,
    /// When the last partial table was made, and how long that took, s.
    partial: Option<(Instant, f64)>,
    error: Option<JudgeError>,
}

impl<S: Source> Running<'_, S> {
    fn work(&self) {
        while !self.stop.load(Ordering::Relaxed) {
            let Some(unit) = self.pending.get(self.claimed.fetch_add(1, Ordering::Relaxed)) else { return };
            if let Err(error) = self.judge_unit(unit) {
                self.stop.store(true, Ordering::Relaxed);
                let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
                shared.error.get_or_insert(error);
            }
        }
    }

    fn judge_unit(&self, unit: &Unit) -> Result<(), JudgeError> {
        let clock = Clock::begin();
        let simulated = self.simulate(&unit.simulated);
        // The time of the simulation stands with its first world.
        let mut simulate_s = clock.elapsed_s();
        for &task in &unit.tasks {
            if self.stop.load(Ordering::Relaxed) || !self.may_begin() {
                return Ok(());
            }
            let mut times =
                Times { world: task, simulate_s: std::mem::take(&mut simulate_s), ..Times::default() };
            let world = self.world(&simulated, &self.plan.tasks[task].request, &mut times);
            let entry = match world {
                Ok(world) => self.judge(&world, task, &mut times),
                Err(reason) => Entry { facts: Err(reason), scores: Vec::new() },
            };
            self.enter(task, &entry, times)?;
        }
        Ok(())
    }

    /// Whether this run may judge another world.
    fn may_begin(&self) -> bool {
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        shared.begun += 1;
        self.settings.most_worlds.is_none_or(|most| shared.begun <= most)
    }

    fn simulate(&self, request: &Request) -> Result<S::Simulated, String> {
        guarded(|| self.source.simulate(request))
    }

    /// The world of a request; one that needs a simulation of its own gets it.
    fn world(
        &self,
        simulated: &Result<S::Simulated, String>,
        request: &Request,
        times: &mut Times,
    ) -> Result<World, String> {
        let clock = Clock::begin();
        let simulated = simulated.as_ref().map_err(Clone::clone)?;
        let laid_over = catch_unwind(AssertUnwindSafe(|| self.source.world(simulated, request)));
        times.lay_over_s = clock.elapsed_s();
        match laid_over {
            Ok(Err(WorldError::OtherSimulation { .. })) => {
                let clock = Clock::begin();
                let own = self.simulate(request)?;
                times.simulate_s += clock.elapsed_s();
                guarded(|| self.source.world(&own, request))
            }
            Ok(world) => world.map_err(|error| error.to_string()),
            Err(panic) => Err(format!("panicked: {}", words_of(panic.as_ref()))),
        }
    }

    fn judge(&self, world: &World, task: usize, times: &mut Times) -> Entry {
        let (first, last) = (world.truth.time_s.first(), world.truth.time_s.last());
        let (Some(first_s), Some(last_s)) = (first, last) else {
            return Entry { facts: Err("the log has no rows".to_owned()), scores: Vec::new() };
        };
        let length_s = last_s - first_s;
        times.cylinder_s = length_s;
        times.rows = world.log.time_s.len() as u64;
        let facts = Facts { rows: times.rows, length_s, leak: LeakWatch::facts(world) };
        let mut scores = Vec::new();
        for &candidate in &self.plan.tasks[task].candidates {
            let named = &self.plan.candidates[candidate];
            let watched = watch(world, named.candidate.as_ref());
            times.candidates_s.push((named.name.clone(), watched.candidate_s));
            times.scoring_s += watched.scoring_s;
            scores.push(watched.score.and_then(readable));
        }
        Entry { facts: Ok(facts), scores }
    }

    /// Write a finished world down; a partial table if one is due.
    fn enter(&self, task: usize, entry: &Entry, mut times: Times) -> Result<(), JudgeError> {
        let clock = Clock::begin();
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        shared.journal.append(task, entry)?;
        shared.failed += usize::from(entry.facts.is_err());
        shared.failed += entry.scores.iter().filter(|score| score.is_err()).count();
        let (done, all, failed) = (shared.journal.len(), self.plan.tasks.len(), shared.failed);
        let (last, took_s) = *shared.partial.get_or_insert_with(|| (Instant::now(), 0.0));
        if done < all && last.elapsed().as_secs_f64() > PARTIAL_S.max(PARTIAL_COST * took_s) {
            let begin = Instant::now();
            table::write(self.plan, &mut shared.journal.results()?, &self.settings.folder)?;
            shared.partial = Some((Instant::now(), begin.elapsed().as_secs_f64()));
        }
        times.journal_s = clock.elapsed_s();
        shared.costs.enter(times)?;
        drop(shared);
        (self.progress)(Progress { done, all, failed });
        Ok(())
    }
}

/// A score that can be read back: JSON has no numbers that are not finite.
fn readable(score: Score) -> Result<Score, String> {
    let text = serde_json::to_string(&score).map_err(|error| error.to_string())?;
    serde_json::from_str::<Score>(&text).map_err(|error| format!("a sum is no number: {error}"))?;
    Ok(score)
}

/// A result whose error is words, of something that may panic.
fn guarded<T>(make: impl FnOnce() -> Result<T, WorldError>) -> Result<T, String> {
    match catch_unwind(AssertUnwindSafe(make)) {
        Ok(made) => made.map_err(|error| error.to_string()),
        Err(panic) => Err(format!("panicked: {}", words_of(panic.as_ref()))),
    }
}
