//! `cylwatch bench-detector`: leak detectors side by side on simulated cylinders.
use super::format::Format;
use super::input::Inputs;
use super::message::Messages;
use super::number::{above, at_least};
use super::options::{DataArguments, FalseAlarmArguments, OUTPUT, ViewArguments};
use super::output::{Target, remarks};
use super::progress::Progress;
use super::result::{Contents, Destination};
use super::views::Views;
use clap::Args;
use cylwatch::evaluation::performance::bench::{Candidate, Outcome, Plan, baselines, bench, monitor};
use cylwatch::report::{Provenance, bench_detector as report};
use cylwatch::thermal::units::BAR_PA;
use cylwatch::thermal::units::{DAY_S, HOUR_S};
use std::sync::Mutex;

/// Arguments of `bench-detector`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(super) struct BenchDetectorArguments {
    /// Cylinders for training, as many for the test, and as many for each leak rate; at least 5.
    #[arg(long, value_name = "NUMBER", default_value_t = 24, value_parser = at_least(5_u64))]
    pub seeds: u64,
    /// Time that each cylinder is watched after --learning-days, in d; above 1.
    #[arg(long, value_name = "NUMBER", default_value_t = 8.0, value_parser = above(1.0))]
    pub days: f64,
    /// Time that detectors learn before anything counts, in d.
    #[arg(long, value_name = "NUMBER", default_value_t = 10.0, value_parser = above(0.0))]
    pub learning_days: f64,
    /// Leak rates in bar/h, loss of the pressure at 15 degC [default: 11 from 0.001 to 10].
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = above(0.0))]
    pub rates: Option<Vec<f64>>,
    #[command(flatten)]
    pub false_alarms: FalseAlarmArguments,
    /// First seed of cylinders and weather, a whole number of at least 0.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = at_least(0_u64))]
    pub seed: u64,
    /// Simulate stratified gas, a finer wall and weather: about thirty times the time.
    #[arg(long)]
    pub stratified: bool,
    #[command(flatten)]
    pub data: DataArguments,
    /// The same as --format json.
    #[arg(long, conflicts_with = "format", help_heading = OUTPUT)]
    pub json: bool,
    #[command(flatten)]
    pub views: ViewArguments,
}

const HELP: &str = "\
Without --output, --format and --json stdout gets tables for people.

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
pub(super) fn run(arguments: BenchDetectorArguments, messages: &Messages) -> anyhow::Result<()> {
    let options = Options::checked(arguments)?;
    let outcome = options.bench(messages)?;
    options.write(&outcome, messages)
}

impl Options {
    fn checked(arguments: BenchDetectorArguments) -> anyhow::Result<Self> {
        let data = Target::checked(arguments.data.output.as_deref(), &[])?;
        let views = Views::checked(&arguments.views, &[], &[&data])?;
        let format = arguments.data.format_or_tables(arguments.json);
        Ok(Self { plan: plan(&arguments), data, format, views })
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
        let inputs = Inputs::default();
        let provenance = Provenance { seed: Some(self.plan.seed), ..inputs.provenance() };
        let summary = report::summary(outcome);
        let remarks = remarks(&summary.to_text());
        let contents = Contents {
            summary,
            csv: &|provenance| report::table(outcome).to_csv(provenance, &remarks),
            json: &|provenance| report::document(outcome, provenance),
            picture: &|| report::figure(outcome).into(),
            report: &|picture, summary| summary.picture(picture, report::CAPTION),
        };
        let destination = Destination { data: &self.data, format: self.format, views: &self.views };
        destination.write(contents, &inputs, &provenance, messages)
    }
}

/// All detectors, ours first.
fn candidates(plan: &Plan) -> anyhow::Result<Vec<Candidate>> {
    let mut candidates = vec![monitor(plan)?];
    candidates.extend(baselines(plan)?);
    Ok(candidates)
}

/// The plan of the bench.
fn plan(arguments: &BenchDetectorArguments) -> Plan {
    let mut plan = Plan {
        training: arguments.seeds,
        tests: arguments.seeds,
        seed: arguments.seed,
        learning_s: DAY_S * arguments.learning_days,
        watched_s: DAY_S * arguments.days,
        between_alarms_s: arguments.false_alarms.mean_time_s(),
        fast: !arguments.stratified,
        ..Plan::default()
    };
    if let Some(rates) = &arguments.rates {
        plan.rates_pa_s = rates.iter().map(|rate| rate * BAR_PA / HOUR_S).collect();
        plan.rates_pa_s.sort_by(f64::total_cmp);
        plan.rates_pa_s.dedup();
    }
    plan
}
