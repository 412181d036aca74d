//! Judges monitors and estimators on worlds that they do not know.
//!
//! `cargo run --release -p cylwatch-evaluation --example judge -- PLAN --out DIR [options]`
//!
//! ```text
//! PLAN                       plan: families that tune and judge, candidates, groups of runs (crates/evaluation/plans)
//! --out DIR                  results: table.md, table.json, cost.md, cost.json, journal.jsonl, times.jsonl
//! --threads N                threads; default: all cores
//! --leave-out AXIS=KIND      families of this kind judge instead of tuning, e.g. climate=desert; may be repeated
//! --check                    check the plan, say what it would run, and stop
//! --most N                   stop after N worlds; the same command goes on
//! ```
//!
//! A run that was killed goes on with the same command. While it runs, `table.md` is renewed with what is finished. Exit code: 0 done, 2 a
//! mistake in the plan or the command, 3 done or stopped with worlds that failed or are missing.
use std::fs::File;
use std::io::{Read, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Instant;

use cylwatch_evaluation::judge::candidate::Registry;
use cylwatch_evaluation::judge::plan::Plan;
use cylwatch_evaluation::judge::run::{Progress, RunSettings, Simulator, run};
use sha2::{Digest, Sha256};

const USAGE: &str =
    "usage: judge PLAN --out DIR [--threads N] [--leave-out AXIS=KIND]... [--check] [--most N]";
/// Time between two words about the progress, s.
const SAID_EVERY_S: f64 = 10.0;

struct Arguments {
    plan: PathBuf,
    out: Option<PathBuf>,
    threads: usize,
    left_out: Vec<String>,
    check: bool,
    most: Option<usize>,
}

impl Arguments {
    fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let mut found = Self {
            plan: PathBuf::new(),
            out: None,
            threads: cores,
            left_out: Vec::new(),
            check: false,
            most: None,
        };
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or_else(|| format!("{argument} needs a value; {USAGE}"));
            let number =
                |text: String| text.parse().map_err(|_| format!("{argument} {text}: must be a whole number"));
            match argument.as_str() {
                "--out" => found.out = Some(value()?.into()),
                "--threads" => found.threads = number(value()?)?,
                "--most" => found.most = Some(number(value()?)?),
                "--leave-out" => found.left_out.push(value()?),
                "--check" => found.check = true,
                other if other.starts_with('-') => return Err(format!("{other}: no option; {USAGE}")),
                plan if found.plan.as_os_str().is_empty() => found.plan = plan.into(),
                other => return Err(format!("{other}: one plan only; {USAGE}")),
            }
        }
        if found.plan.as_os_str().is_empty() || (found.out.is_none() && !found.check) {
            return Err(USAGE.to_owned());
        }
        Ok(found)
    }
}

/// Version of the program: results of another build are not mixed in.
fn program() -> std::io::Result<String> {
    let mut bytes = Vec::new();
    File::open(std::env::current_exe()?)?.read_to_end(&mut bytes)?;
    let digits: String = Sha256::digest(&bytes)[..8].iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(format!("{} {digits}", env!("CARGO_PKG_VERSION")))
}

fn say(words: &str) {
    let _ = writeln!(std::io::stderr(), "{words}");
}

fn describe(plan: &Plan) {
    let years: f64 = plan.tasks.iter().map(|task| task.request.length_s).sum::<f64>() / 31_557_600.0;
    let units = plan.units();
    let simulated: f64 = units.iter().map(|unit| unit.simulated.length_s).sum::<f64>() / 31_557_600.0;
    let rows: f64 =
        plan.tasks.iter().map(|task| task.request.length_s / task.request.family.rows.interval_s()).sum();
    say(&format!(
        "{}: {} worlds, {years:.1} cylinder-years, {:.1} million rows; {} simulations of {simulated:.1} years",
        plan.document.title,
        plan.tasks.len(),
        1e-6 * rows,
        units.len()
    ));
}

fn judge(arguments: &Arguments) -> Result<ExitCode, Box<dyn std::error::Error>> {
    let plan = Plan::read(&arguments.plan, &Registry::default(), &arguments.left_out)?;
    describe(&plan);
    let Some(folder) = arguments.out.clone().filter(|_| !arguments.check) else {
        return Ok(ExitCode::SUCCESS);
    };
    let settings = RunSettings {
        folder: folder.clone(),
        threads: arguments.threads,
        program: program()?,
        most_worlds: arguments.most,
    };
    let begin = Instant::now();
    let said = Mutex::new(begin);
    let progress = |Progress { done, all, failed }: Progress| {
        let Ok(mut last) = said.lock() else { return };
        if last.elapsed().as_secs_f64() > SAID_EVERY_S {
            *last = Instant::now();
            let minutes = begin.elapsed().as_secs_f64() / 60.0;
            say(&format!("{done} of {all} worlds after {minutes:.1} min, {failed} failed"));
        }
    };
    let end = run(&plan, &Simulator, &settings, &progress)?;
    say(&format!("{} of {} worlds; {}", end.done, end.all, folder.join("table.md").display()));
    Ok(if end.failed > 0 || end.done < end.all { ExitCode::from(3) } else { ExitCode::SUCCESS })
}

fn main() -> ExitCode {
    let outcome = Arguments::parse(std::env::args().skip(1))
        .map_err(Into::into)
        .and_then(|arguments| judge(&arguments));
    outcome.unwrap_or_else(|error| {
        say(&format!("error: {error}"));
        ExitCode::from(2)
    })
}
