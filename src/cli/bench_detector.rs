//! `cylwatch bench-detector`: leak detectors side by side on simulated cylinders.
use super::arguments::Format;
use super::command_line;
use super::message::Messages;
use super::output::{Target, remarks};
use super::progress::Progress;
use super::unit_options::between_false_alarms_s;
use super::views::{Views, Wanted};
use anyhow::bail;
use clap::Args;
use cylwatch::evaluation::performance::bench::{Candidate, Outcome, Plan, baselines, bench, monitor};
use cylwatch::report::figure::Picture;
use cylwatch::report::{Provenance, bench_detector as report};
use std::path::PathBuf;
use std::sync::Mutex;

const DAY_S: f64 = 86_400.0;
const HOUR_S: f64 = 3600.0;

/// Arguments of `bench-detector`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct BenchDetectorArguments {
    /// Cylinders for training, as many for the test, and as many for each leak rate; at least 5.
    #[arg(long, value_name = "NUMBER", default_value_t = 24)]
    pub seeds: u64,
    /// How long each cylinder is watched, in d, after --learning-days; above 1.
    #[arg(long, value_name = "NUMBER", default_value_t = 8.0)]
    pub days: f64,
    /// Operation that detectors learn from before anything counts, in d.
    #[arg(long, value_name = "NUMBER", default_value_t = 10.0)]
    pub learning_days: f64,
    /// Leak rates in bar/h, loss of the pressure at 15 degC [default: 11 from 0.001 to 10].
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub rates: Option<Vec<f64>>,
    /// Mean time between false alarms that every threshold is set for, in years.
    #[arg(long, value_name = "NUMBER", default_value_t = 10.0)]
    pub false_alarm_years: f64,
    /// First seed of cylinders and weather, a whole number of at least 0.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Simulate stratified gas, a finer wall and weather: about thirty times the time.
    #[arg(long)]
    pub stratified: bool,
    /// File for a row of each detector and rate; - is stdout [default: tables for people on stdout].
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Format of the data [default: json for a file that ends in .json, else csv].
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// The same as --format json.
    #[arg(long, conflicts_with = "format")]
    pub json: bool,
    /// Figure of delay against leak rate; the ending .svg or .png decides the format.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Report with tables, figure and inputs: one HTML file that needs nothing else.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
}

const HELP: &str = "\
Every detector sees the same readings of the same cylinders, drawn with errors of wall, films and
sensors, in winter weeks under a train with tunnels. Thresholds are set on the training cylinders
for one rate of false alarms; the test cylinders have other seeds.

Detectors: cylwatch; the paper's as published and refitted (real gas, gain 1, zero learnt); a
textbook's cumulative sum; an ideal gas at the shoulder's temperature; a pressure switch.

Examples:
  cylwatch bench-detector
  cylwatch bench-detector --seeds 60 --days 31 -o bench.csv --plot delay.svg
  cylwatch bench-detector --rates 0.01,0.1,1 --json | jq '.detectors[].performance.smallest'";

/// Validated options.
struct Options {
    plan: Plan,
    data: Target,
    format: Option<Format>,
    views: Views,
}

/// Simulates, judges, writes.
pub fn run(arguments: BenchDetectorArguments, messages: &Messages) -> anyhow::Result<()> {
    let options = Options::checked(arguments)?;
    let outcome = options.bench(messages)?;
    options.write(&outcome, messages)
}

impl Options {
    fn checked(arguments: BenchDetectorArguments) -> anyhow::Result<Self> {
        let data = Target::checked(arguments.output.as_deref(), &[])?;
        let wanted = Wanted { plot: arguments.plot.as_deref(), report: arguments.report.as_deref() };
        let views = Views::checked(wanted, &[], &[&data])?;
        let format = Format::asked(arguments.format, arguments.json, arguments.output.as_deref());
        let plan = plan(&arguments)?;
        Ok(Self { plan, data, format, views })
    }

    fn bench(&self, messages: &Messages) -> anyhow::Result<Outcome> {
        let candidates = candidates(&self.plan)?;
        let progress = Mutex::new(Progress::new(messages));
        let outcome = bench(&self.plan, &candidates, &|so_far| {
            // Without the bar the bench goes on.
            if let Ok(bar) = progress.lock() {
                bar.show("simulating cylinders", so_far.done as f64 / so_far.all as f64);
            }
        });
        drop(progress);
        Ok(outcome?)
    }

    fn write(&self, outcome: &Outcome, messages: &Messages) -> anyhow::Result<()> {
        let provenance =
            Provenance { command: command_line(), inputs: Vec::new(), seed: Some(self.plan.seed) };
        let story = report::story(outcome);
        let words = story.to_text();
        let picture = || Picture::Figure(report::figure(outcome));
        let with = |picture| story.picture(picture, report::CAPTION);
        let views = self.views.make(picture, with, Vec::new(), &provenance)?;
        let text = match self.format {
            None => words.clone(),
            Some(Format::Csv) => report::table(outcome).to_csv(&provenance, &remarks(&words)),
            Some(Format::Json) => {
                serde_json::to_string_pretty(&report::document(outcome, &provenance))? + "\n"
            }
        };
        self.data.write(text.as_bytes())?;
        views.write()?;
        if self.format.is_some() {
            messages.say(&words);
        }
        Ok(())
    }
}

/// All detectors, ours first.
fn candidates(plan: &Plan) -> anyhow::Result<Vec<Candidate>> {
    let mut candidates = vec![monitor(plan)?];
    candidates.extend(baselines(plan)?);
    Ok(candidates)
}

/// The plan, each option named if it is out of its bounds.
fn plan(arguments: &BenchDetectorArguments) -> anyhow::Result<Plan> {
    let positive = |option: &str, value: f64, above: f64| {
        if !(value > above && value.is_finite()) {
            bail!("--{option} {value}: it must be above {above} and finite");
        }
        Ok(value)
    };
    if arguments.seeds < 5 {
        bail!("--seeds {}: at least 5 cylinders are needed to set a threshold", arguments.seeds);
    }
    let mut plan = Plan {
        training: arguments.seeds,
        tests: arguments.seeds,
        seed: arguments.seed,
        learning_s: DAY_S * positive("learning-days", arguments.learning_days, 0.0)?,
        watched_s: DAY_S * positive("days", arguments.days, 1.0)?,
        between_alarms_s: between_false_alarms_s(arguments.false_alarm_years)?,
        fast: !arguments.stratified,
        ..Plan::default()
    };
    if let Some(rates) = &arguments.rates {
        let of = |rate: &f64| Ok(positive("rates", *rate, 0.0)? * 1e5 / HOUR_S);
        plan.rates_pa_s = rates.iter().map(of).collect::<anyhow::Result<_>>()?;
        plan.rates_pa_s.sort_by(f64::total_cmp);
        plan.rates_pa_s.dedup();
    }
    Ok(plan)
}
