//! `cylwatch bench-detector`: leak detectors side by side on simulated cylinders, as a plan of the judge says.
use super::input::Inputs;
use super::interrupt;
use super::message::Messages;
use super::number::at_least;
use super::options::{OUTPUT, ViewArguments};
use super::output::{Target, make_folder};
use super::progress::Progress as Bar;
use super::views::Views;
use crate::evaluation::judge::candidate::Registry;
use crate::evaluation::judge::plan::{Extent, Plan, presets};
use crate::evaluation::judge::run::{Progress, RunSettings, Simulator, run as judge};
use crate::evaluation::judge::table::Table;
use crate::report::{Input, Report, aligned, bench_detector as report, number};
use crate::thermal::units::{HOUR_S, MINUTE_S};
use anyhow::{Context, bail};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use tempfile::TempDir;

/// Exit code if worlds failed or are missing.
const PARTIAL: u8 = 3;

/// Arguments of `bench-detector`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(super) struct BenchDetectorArguments {
    /// Plan: a TOML file, the name of a built-in one, or - for stdin.
    #[arg(default_value = "railway")]
    pub plan: String,
    /// Let the families of a kind judge instead of tuning, as climate=desert; may be given again.
    #[arg(long = "leave-out", value_name = "AXIS=KIND")]
    pub left_out: Vec<String>,
    /// Threads [default: all cores].
    #[arg(long, value_name = "NUMBER", value_parser = at_least(1_usize))]
    pub threads: Option<usize>,
    /// Stop after so many worlds; with --out the same command goes on.
    #[arg(long, value_name = "NUMBER", value_parser = at_least(1_usize))]
    pub most: Option<usize>,
    /// Check the plan, say what it would run, and stop.
    #[arg(long)]
    pub check: bool,
    /// List the built-in plans and stop.
    #[arg(long)]
    pub list: bool,
    /// Folder of the results, made if it is not there; a run that was ended goes on in it [default: nothing is kept].
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub out: Option<PathBuf>,
    /// Print the table as JSON instead of Markdown.
    #[arg(long, help_heading = OUTPUT)]
    pub json: bool,
    #[command(flatten)]
    pub views: ViewArguments,
}

const HELP: &str = "\
A plan says which detectors watch which cylinders. Thresholds are set on families of cylinders
that tune, for one rate of false alarms; other families judge. All detectors see the same readings.
Without a plan: the monitor, the paper's detector as published and refitted, a textbook's
cumulative sum, an ideal gas and a pressure switch on 20 L nitrogen in railway winters.

DIR gets table.md, table.json, cost.md, cost.json, journal.jsonl and times.jsonl. It belongs to one
plan and one build of the program. Exit code 3: worlds failed or are missing.

Examples:
  cylwatch bench-detector
  cylwatch bench-detector reference --out ref --plot delay.svg
  cylwatch bench-detector my-plan.toml --leave-out climate=desert --json | jq '.candidates[].threshold'";

/// Judges, writes; exit code 3 if worlds failed or are missing.
pub(super) fn run(arguments: BenchDetectorArguments, messages: &Messages) -> anyhow::Result<ExitCode> {
    if arguments.list {
        Target::Stdout.write(list()?.as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    let views = Views::checked(&arguments.views, &[Path::new(&arguments.plan)], &[])?;
    let inputs = Inputs::default();
    let plan = inputs.plan(&arguments.plan, &arguments.left_out)?;
    let has_leaks = plan.has_leaks();
    if arguments.views.plot.is_some() && !has_leaks {
        bail!("--plot: the plan {} has no leaks that judge, whose delays the figure shows", arguments.plan);
    }
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.unwrap_or_else(cores);
    let intention = intention(&plan, threads);
    if arguments.check {
        Target::Stdout.write(intention.as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    messages.say(&intention);
    let folder = Folder::new(arguments.out)?;
    let settings = RunSettings {
        folder: folder.path().into(),
        threads,
        program: program()?,
        most_worlds: arguments.most,
    };
    let table = judged(&plan, &settings, messages)?;
    let text = if arguments.json { table.to_json()? } else { table.to_markdown() };
    let (provenance, sources) = (inputs.provenance(), inputs.sources());
    let views = if has_leaks {
        let report = |picture| Report::picture(report::summary(&table), picture, report::CAPTION);
        views.make(|| report::figure(&table), report, sources, &provenance)?
    } else {
        views.make_report(|| report::summary(&table), sources, &provenance)?
    };
    Target::Stdout.write(text.as_bytes())?;
    views.write()?;
    if table.is_whole() {
        return Ok(ExitCode::SUCCESS);
    }
    let found = &table.provenance;
    messages.caution(&format!(
        "{} of {} worlds are finished, and what failed stands in the table",
        found.finished, found.worlds
    ));
    Ok(ExitCode::from(PARTIAL))
}

/// The built-in plans with their titles.
fn list() -> anyhow::Result<String> {
    let row = |(name, text): &(&str, &str)| {
        let plan = Plan::parse(text, name, &Registry::default(), &[])?;
        anyhow::Ok(vec![(*name).to_owned(), plan.document.title])
    };
    let rows: Vec<Vec<String>> = presets::FILES.files.iter().map(row).collect::<anyhow::Result<_>>()?;
    Ok(aligned(&["name", "what"], &rows))
}

/// What a plan asks for, and about how long it takes.
fn intention(plan: &Plan, threads: usize) -> String {
    let Extent { worlds, cylinder_years, rows, simulations, simulated_years, core_s } = plan.extent();
    let about = match core_s / threads as f64 {
        seconds if seconds < MINUTE_S => "less than a minute".to_owned(),
        seconds if seconds < 2.0 * HOUR_S => format!("about {} min", (seconds / MINUTE_S).round()),
        seconds => format!("about {} h", (seconds / HOUR_S).round()),
    };
    format!(
        "{}: {worlds} worlds, {} cylinder-years, {} million rows; {simulations} simulations of {} years\n\
         {about} from the start with {threads} threads, each on a core of its own\n",
        plan.document.title,
        number(cylinder_years, 3),
        number(1e-6 * rows, 2),
        number(simulated_years, 3),
    )
}

/// Where the results go.
enum Folder {
    Kept(PathBuf),
    Temporary(TempDir),
}

impl Folder {
    fn new(out: Option<PathBuf>) -> anyhow::Result<Self> {
        let Some(folder) = out else {
            let folder = tempfile::tempdir().context("no temporary folder can be made: give --out")?;
            let path = folder.path().to_owned();
            // Nobody asked for what is in it.
            interrupt::listen(move || {
                _ = std::fs::remove_dir_all(&path);
                std::process::exit(interrupt::CODE);
            })?;
            return Ok(Self::Temporary(folder));
        };
        make_folder(&folder)?;
        Ok(Self::Kept(folder))
    }

    fn path(&self) -> &Path {
        match self {
            Self::Kept(folder) => folder,
            Self::Temporary(folder) => folder.path(),
        }
    }
}

/// Version of the program with the beginning of its file's hash: results of another build are not mixed in.
fn program() -> anyhow::Result<String> {
    let path = std::env::current_exe().context("the program does not find itself")?;
    let bytes = std::fs::read(&path).with_context(|| format!("{} cannot be read", path.display()))?;
    Ok(format!("{} {}", env!("CARGO_PKG_VERSION"), &Input::of("", &bytes).sha256[..16]))
}

fn judged(plan: &Plan, settings: &RunSettings, messages: &Messages) -> anyhow::Result<Table> {
    let bar = Mutex::new((Bar::new(messages), true));
    let show = |Progress { done, all, .. }: Progress| {
        // Without the bar the judge goes on.
        let Ok(mut bar) = bar.lock() else { return };
        if std::mem::take(&mut bar.1) && done > 0 {
            bar.0.suspended(|| messages.say(&format!("goes on: {done} of {all} worlds are there")));
        }
        bar.0.show("judging", done as f64 / all as f64);
    };
    Ok(judge(plan, &Simulator, settings, &show)?)
}
