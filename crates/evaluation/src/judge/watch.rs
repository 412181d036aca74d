//! One candidate watches one world: rows in, statements to the scorer, the time of each apart.
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::JudgeError;
use super::candidate::{Candidate, CandidateRun, Row};
use super::clock::Clock;
use super::score::{Score, Scorer};
use super::statement::Statement;
use crate::world::{Snapshot, World};

/// Rows between two looks at the clock.
const ROWS_PER_CHUNK: usize = 256;
/// How far back the row of a statement is looked for: rows that a candidate may hold back.
const MAX_DELAYED_ROWS: usize = 20_000;
/// Interval at which a device stores its state, s.
const SNAPSHOT_INTERVAL_S: f64 = 3600.0;

/// What came of it.
#[derive(Debug)]
pub struct Watched {
    /// The score, or why there is none.
    pub score: Result<Score, String>,
    /// Time that the candidate took, s.
    pub(crate) candidate_s: f64,
    /// Time that scoring took, s.
    pub(crate) scoring_s: f64,
}

/// Let a candidate watch a world. A candidate that fails or panics has no score; the others go on.
pub fn watch(world: &World, candidate: &dyn Candidate) -> Watched {
    let mut watching = Watching {
        world,
        scorer: Scorer::new(world, candidate.decision_level()),
        statements: Vec::new(),
        now_s: f64::NEG_INFINITY,
        candidate_s: 0.0,
        scoring_s: 0.0,
    };
    let outcome = catch_unwind(AssertUnwindSafe(|| watching.run(candidate)));
    let Watching { scorer, candidate_s, mut scoring_s, .. } = watching;
    let score = match outcome {
        Ok(Ok(())) => {
            let clock = Clock::begin();
            let score = scorer.finish();
            scoring_s += clock.elapsed_s();
            Ok(score)
        }
        Ok(Err(error)) => Err(error.to_string()),
        Err(panic) => Err(format!("panicked: {}", words_of(panic.as_ref()))),
    };
    Watched { score, candidate_s, scoring_s }
}

/// Words of a panic.
pub(super) fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without words".to_owned())
}

struct Watching<'a> {
    world: &'a World,
    scorer: Scorer<'a>,
    /// Statements of a chunk, with the last row that had arrived and the time of its arrival, s.
    statements: Vec<(usize, f64, Statement)>,
    now_s: f64,
    candidate_s: f64,
    scoring_s: f64,
}

impl Watching<'_> {
    fn run(&mut self, candidate: &dyn Candidate) -> Result<(), JudgeError> {
        let mut clock = Clock::begin();
        let mut run = candidate.start(&self.world.operator_data)?;
        let rows = self.world.log.time_s.len();
        let historical: BTreeSet<usize> = self.world.historical.iter().copied().collect();
        let keeps = self.world.power_cycles.iter().any(|(_, snapshot)| *snapshot == Snapshot::Old);
        let mut kept_s = f64::NEG_INFINITY;
        let mut cycles = self.world.power_cycles.iter().peekable();
        for begin_row in (0..rows).step_by(ROWS_PER_CHUNK) {
            let end_row = rows.min(begin_row + ROWS_PER_CHUNK);
            for row in begin_row..end_row {
                if keeps && self.now_s >= kept_s + SNAPSHOT_INTERVAL_S {
                    run.keep()?;
                    kept_s = self.now_s;
                }
                self.step(&mut *run, row, historical.contains(&row))?;
                while let Some((_, snapshot)) = cycles.next_if(|(after, _)| *after <= row) {
                    run.power_cycle(*snapshot)?;
                }
            }
            if end_row == rows {
                let mut statements = Vec::new();
                run.finish(&mut statements)?;
                self.statements
                    .extend(statements.into_iter().map(|statement| (rows - 1, self.now_s, statement)));
            }
            self.candidate_s += clock.lap_s();
            self.score();
            self.scoring_s += clock.lap_s();
        }
        Ok(())
    }

    fn step(&mut self, run: &mut dyn CandidateRun, row: usize, historical: bool) -> Result<(), JudgeError> {
        let (log, truth) = (&self.world.log, &self.world.truth);
        self.now_s = self.now_s.max(truth.time_s[row]);
        let mut statements = Vec::new();
        let readings = log.row(row);
        run.step(&Row { stamp_s: log.time_s[row], readings, historical }, &mut statements)?;
        self.statements.extend(statements.into_iter().map(|statement| (row, self.now_s, statement)));
        Ok(())
    }

    /// Score the statements of a chunk.
    fn score(&mut self) {
        let stamps = &self.world.log.time_s;
        for (arrived, now_s, statement) in self.statements.drain(..) {
            let oldest = arrived.saturating_sub(MAX_DELAYED_ROWS);
            let row = (oldest..=arrived).rev().find(|row| stamps[*row] == statement.stamp_s);
            // A statement about no row of the log is about the last one.
            self.scorer.take(now_s, row.unwrap_or(arrived), &statement);
        }
    }
}
