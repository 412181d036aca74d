//! The raw arguments of `monitor`.
use crate::cli::fill::GivenFill;
use crate::cli::options::{
    DataArguments, EXPERT, FalseAlarmArguments, HELP_FOOTER, LogArguments, OUTPUT, SensorArguments,
    VesselAndLog, ViewArguments,
};
use crate::cli::unit_options::{Choice, Choices, QuantityArguments};
use crate::report::monitor;
use crate::thermal::units::Dimension;
use clap::Args;
use std::path::PathBuf;

/// What the verdict is held against, and times.
#[derive(Clone, Debug)]
pub(crate) struct MonitorQuantities;

impl Choices for MonitorQuantities {
    const CHOICES: &'static [Choice] = &[
        ("limit", Dimension::Pressure, "Lowest operational pressure [default: 160 bar]"),
        ("coldest", Dimension::Temperature, "Coldest temperature expected [default: -25 degc]"),
        ("next-service", Dimension::Time, "Time until the next service [default: 30 d]"),
        ("lateness", Dimension::Time, "Hold rows back so long and sort them [default: 0]"),
        (
            "step",
            Dimension::Time,
            "Replace rows that are closer together by their median; 0: never [default: 1 min]",
        ),
        ("save-every", Dimension::Time, "Interval of saving the state during a run [default: 10 min]"),
    ];
    const EXPERT: &'static [&'static str] = &["lateness", "step", "save-every"];
}

/// What can differ from cylinder to cylinder: for a fleet the columns of its file of vessels, too.
#[derive(Clone, Debug, Args)]
pub(crate) struct CylinderArguments {
    #[command(flatten)]
    pub given: QuantityArguments<MonitorQuantities>,
    #[command(flatten)]
    pub sensors: SensorArguments,
    #[command(flatten)]
    pub fill: GivenFill,
    /// Time of an ordered exchange of gas, such as a test of the system, which is no loss: in seconds of the log or as dates; may be
    /// given again.
    #[arg(long, value_name = "FROM..UNTIL", help_heading = EXPERT)]
    pub announced: Vec<String>,
    /// JSON file of `commission`: thresholds for this vessel [default: those common to seven vessels].
    #[arg(long, value_name = "FILE", help_heading = EXPERT)]
    pub commissioned: Option<PathBuf>,
    /// JSON file of `estimate --learned-out`: what it has learnt of cylinder and sensors.
    #[arg(long, value_name = "FILE", help_heading = EXPERT)]
    pub learned_in: Option<PathBuf>,
}

impl CylinderArguments {
    /// What is given here, and what is not as in `defaults`.
    pub(in crate::cli) fn or(self, defaults: &Self) -> Self {
        let announced = if self.announced.is_empty() { defaults.announced.clone() } else { self.announced };
        Self {
            given: self.given.or(&defaults.given),
            sensors: SensorArguments {
                sensors: self.sensors.sensors.or_else(|| defaults.sensors.sensors.clone()),
            },
            fill: self.fill.or(&defaults.fill),
            announced,
            commissioned: self.commissioned.or_else(|| defaults.commissioned.clone()),
            learned_in: self.learned_in.or_else(|| defaults.learned_in.clone()),
        }
    }

    /// Files that are named.
    pub(in crate::cli) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.sensors.sensors, &self.commissioned, &self.learned_in].into_iter().flatten()
    }
}

/// Arguments of `monitor`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = help())]
pub(crate) struct MonitorArguments {
    #[command(flatten)]
    pub inputs: VesselAndLog,
    #[command(flatten)]
    pub cylinder: CylinderArguments,
    #[command(flatten)]
    pub false_alarms: FalseAlarmArguments,
    /// Continue from FILE if it exists, and save the state to it.
    ///
    /// A CSV file of -o then grows from run to run; Ctrl-C and SIGTERM end the run with the state saved.
    #[arg(long, value_name = "FILE")]
    pub state: Option<PathBuf>,
    #[command(flatten)]
    pub data: DataArguments,
    /// Write events and alarms to FILE as JSON lines [default: text on stderr].
    ///
    /// Lines are written as the events happen; a run that continues a state appends.
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub events: Option<PathBuf>,
    #[command(flatten)]
    pub views: ViewArguments,
    #[command(flatten)]
    pub reading: LogArguments,
    /// Ignore an existing state and start fresh; reported as an event.
    #[arg(long, requires = "state", help_heading = EXPERT)]
    pub cold_start: bool,
    /// Acknowledge and confirm all alarms of the state with a comment, and reset those that are back to normal.
    #[arg(long, value_name = "COMMENT", requires = "state", conflicts_with = "cold_start", help_heading = EXPERT)]
    pub acknowledge: Option<String>,
}

impl MonitorArguments {
    /// Those of a run of another command over a log: nothing of it is written but what that command writes.
    pub(in crate::cli) fn of_another(
        inputs: VesselAndLog,
        cylinder: CylinderArguments,
        false_alarms: FalseAlarmArguments,
        reading: LogArguments,
    ) -> Self {
        Self {
            inputs,
            cylinder,
            false_alarms,
            state: None,
            data: DataArguments { output: None, format: None },
            events: None,
            views: ViewArguments::default(),
            reading,
            cold_start: false,
            acknowledge: None,
        }
    }
}

fn help() -> String {
    format!(
        "\
Logs are read as by `estimate`, but rows may come late or twice, and the clock may jump: see
--lateness-s and book/src/monitor.md.

{}

Exit codes: 0 no loss, 1 gas was lost in these rows, by a leak or by a discharge that was not
announced, 2 error, 3 inconclusive: the verdict is unknown at the end.

Examples:
  cylwatch simulate nitrogen-20l tunnel-winter -o run.csv
  cylwatch monitor nitrogen-20l run.csv -o rows.csv --plot monitor.svg
  cylwatch monitor nitrogen-20l day.csv -o rows.csv --events events.jsonl --state cylinder.state
  cylwatch monitor nitrogen-20l run.csv --commissioned thresholds.json -o rows.csv
  tail -n +1 -f live.csv | cylwatch monitor nitrogen-20l - --state cylinder.state -o rows.csv",
        monitor::DOCUMENTATION
    )
}
