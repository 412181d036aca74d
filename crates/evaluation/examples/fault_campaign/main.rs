//! The fault campaign: every row of the table of faults, with leaks of 0, 0.01, 0.1 and 1 bar/h, over many drawn cylinders.
//!
//! `cargo run --release -p cylwatch-evaluation --example fault_campaign -- [SEEDS [ROWS [CACHE]]]`
//!
//! `SEEDS`: a count, or `first..end` (default 50). `ROWS`: names or beginnings of names with commas, e.g. `P,T5,D`; `none` is the
//! record without a fault; default all. `CACHE`: folder in which simulated truths are kept from one run to the next. Each line of the
//! table is one row with one leak: how many of the cases are as required, with Wilson's 95 % interval; then what was missed how often,
//! and the first seeds. Rows of data share a truth for each cylinder and leak; the fault begins at a random time of the second
//! day after ten days of learning. Faults that last longer than the record do so to its end.
#![allow(clippy::print_stdout, clippy::print_stderr)]
mod base;
mod process;
#[path = "../shared/seeds.rs"]
mod seeds;

use std::collections::BTreeMap;
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use cylwatch_evaluation::fault::{Case, Missed, TableRow, judge};
use cylwatch_evaluation::performance::{CONFIDENCE, Proportion};
use rayon::prelude::*;

use base::{Base, Campaign, LEAKS_BAR_H};
use seeds::seeds;

type Failure = Box<dyn Error + Send + Sync>;

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Ending {
    Missed(Missed),
    Panic,
    Error,
}

/// One case of one cylinder.
struct Outcome {
    /// Row; `None`: no fault.
    row: Option<TableRow>,
    leak: usize,
    seed: u64,
    what: String,
    endings: Vec<Ending>,
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let seeds = seeds(arguments.first().map_or("50", String::as_str), 1)?;
    let rows = rows(arguments.get(1).map_or("", String::as_str))?;
    let cache = arguments.get(2).map(PathBuf::from);
    let campaign = Campaign::new(cache)?;
    // A panic is an outcome; its message would tear the table apart.
    std::panic::set_hook(Box::new(|_| {}));
    let jobs: Vec<(u64, usize)> =
        seeds.clone().flat_map(|seed| (0..LEAKS_BAR_H.len()).map(move |leak| (seed, leak))).collect();
    let outcomes: Vec<Outcome> =
        jobs.par_iter().flat_map_iter(|&(seed, leak)| outcomes(&campaign, &rows, seed, leak)).collect();
    print(&rows, &outcomes);
    Ok(())
}

/// The rows whose names begin as asked for, and the record without a fault.
fn rows(text: &str) -> Result<Vec<Option<TableRow>>, Failure> {
    let asked: Vec<&str> = text.split(',').filter(|part| !part.is_empty()).collect();
    let wanted = |name: &str| asked.is_empty() || asked.iter().any(|part| name.starts_with(part));
    let mut rows: Vec<Option<TableRow>> = if wanted("none") { vec![None] } else { Vec::new() };
    rows.extend(TableRow::ALL.into_iter().filter(|row| wanted(&row.name())).map(Some));
    if rows.is_empty() { Err(format!("no row of the table begins with {text}").into()) } else { Ok(rows) }
}

/// All cases of one cylinder with one leak.
fn outcomes(campaign: &Campaign, rows: &[Option<TableRow>], seed: u64, leak: usize) -> Vec<Outcome> {
    let of_data = |row: &Option<TableRow>| row.is_none_or(TableRow::is_of_data);
    let base = rows.iter().any(of_data).then(|| Base::generate(campaign, seed, leak));
    let mut outcomes = Vec::new();
    for row in rows {
        let mut what = String::new();
        let ended = catch_unwind(AssertUnwindSafe(|| match (row, &base) {
            (Some(row), _) if !row.is_of_data() => process::run(campaign, *row, seed, leak, &mut what),
            (_, Some(Ok(base))) => base.run(campaign, *row, &mut what).map(Some),
            (_, Some(Err(error))) => Err(error.to_string().into()),
            (_, None) => Ok(None),
        }));
        let endings = match ended {
            Ok(Ok(Some(missed))) => missed.into_iter().map(Ending::Missed).collect(),
            Ok(Ok(None)) => continue,
            Ok(Err(error)) => {
                what = format!("{what} {error}");
                vec![Ending::Error]
            }
            Err(_) => vec![Ending::Panic],
        };
        outcomes.push(Outcome { row: *row, leak, seed, what, endings });
    }
    let missed = outcomes.iter().filter(|outcome| !outcome.endings.is_empty()).count();
    eprintln!("seed {seed}, {} bar/h: {missed} of {} not as required", LEAKS_BAR_H[leak], outcomes.len());
    outcomes
}

/// What a run missed.
fn missed(case: &Case, history: &base::Histories) -> Vec<Missed> {
    judge(case, &history.history, history.unbroken)
}

fn print(rows: &[Option<TableRow>], outcomes: &[Outcome]) {
    println!("| row | leak, bar/h | as required | % (95 % interval) | missed |\n|---|---|---|---|---|");
    for row in rows {
        let of_row = |leak: Option<usize>| -> Vec<&Outcome> {
            outcomes.iter().filter(|o| o.row == *row && leak.is_none_or(|leak| o.leak == leak)).collect()
        };
        for (leak, bar_h) in LEAKS_BAR_H.iter().enumerate() {
            line(*row, &bar_h.to_string(), &of_row(Some(leak)));
        }
        line(*row, "all", &of_row(None));
    }
    let count = |ending: Ending| outcomes.iter().filter(|outcome| outcome.endings.contains(&ending)).count();
    println!(
        "\n{} runs: {} panics, {} with NaN, {} tight while blind, {} errors",
        outcomes.len(),
        count(Ending::Panic),
        count(Ending::Missed(Missed::NotANumber)),
        count(Ending::Missed(Missed::TightWhileBlind)),
        count(Ending::Error)
    );
}

fn line(row: Option<TableRow>, leak: &str, outcomes: &[&Outcome]) {
    if outcomes.is_empty() {
        return;
    }
    let good = outcomes.iter().filter(|outcome| outcome.endings.is_empty()).count();
    let share = Proportion { hits: good as u64, trials: outcomes.len() as u64 };
    let (low, high) = share.wilson(CONFIDENCE);
    let mut missed: BTreeMap<Ending, Vec<&Outcome>> = BTreeMap::new();
    for outcome in outcomes {
        for ending in &outcome.endings {
            missed.entry(*ending).or_default().push(outcome);
        }
    }
    let told = |(ending, of): (&Ending, &Vec<&Outcome>)| {
        let first: Vec<String> = of.iter().take(3).map(|o| format!("{}: {}", o.seed, o.what)).collect();
        let name = match ending {
            Ending::Missed(missed) => format!("{missed:?}"),
            other => format!("{other:?}"),
        };
        format!("{name} {} ({})", of.len(), first.join("; "))
    };
    let missed: Vec<String> = if leak == "all" { Vec::new() } else { missed.iter().map(told).collect() };
    println!(
        "| {} | {leak} | {good} of {} | {:.1} ({:.1} to {:.1}) | {} |",
        row.map_or("none".into(), TableRow::name),
        outcomes.len(),
        100.0 * share.value(),
        100.0 * low,
        100.0 * high,
        missed.join(", ")
    );
}
