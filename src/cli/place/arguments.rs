//! The raw arguments of `place`.
use super::quantities::Quantities;
use crate::cli::number::at_least;
use crate::cli::options::{DataArguments, EXPERT, FalseAlarmArguments, HELP_FOOTER, OUTPUT, ViewArguments};
use crate::estimator::placement::Criterion;
use crate::estimator::placement::search::Method;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `place`.
#[derive(Debug, Args)]
#[command(after_help = HELP_FOOTER, after_long_help = HELP)]
pub(crate) struct PlaceArguments {
    /// Vessel: a TOML file, the name of a built-in one, or - for stdin.
    pub vessel: String,
    /// Scenario to judge layouts along: a TOML file, a built-in one, or none; may be given again [default: tunnel-winter].
    #[arg(long = "scenario", value_name = "SCENARIO")]
    pub scenarios: Vec<String>,
    /// Most sensors of a layout, required ones included.
    #[arg(long, value_name = "NUMBER", default_value_t = 4, value_parser = at_least(1_usize))]
    pub sensors: usize,
    /// Number that layouts are searched by; each layout is judged by all others, too.
    #[arg(long, value_name = "NAME", default_value = "leak-rate", value_parser = criterion())]
    pub criterion: Criterion,
    /// TOML file of the candidates: places, costs, rules [default: every place of the vessel].
    #[arg(long, value_name = "FILE")]
    pub candidates: Option<PathBuf>,
    /// Largest cost of a layout; a sensor costs 1 unless --candidates says otherwise [default: any].
    #[arg(long, value_name = "NUMBER", value_parser = at_least(0.0))]
    pub budget: Option<f64>,
    #[command(flatten)]
    pub quantities: Quantities,
    #[command(flatten)]
    pub false_alarms: FalseAlarmArguments,
    #[command(flatten)]
    pub data: DataArguments,
    /// The same as --format json.
    #[arg(long, conflicts_with = "format", help_heading = OUTPUT)]
    pub json: bool,
    #[command(flatten)]
    pub views: ViewArguments,
    /// Write the matrices that layouts are judged by to FILE, as JSON: states, transition, process noise, readings.
    #[arg(long, value_name = "FILE", help_heading = OUTPUT, hide_short_help = true)]
    pub matrices: Option<PathBuf>,
    /// Search [default: every layout up to 20 000 of a number of sensors, along a scenario up to 400, else greedy with swaps].
    #[arg(long, value_enum, help_heading = EXPERT)]
    pub method: Option<SearchMethod>,
    /// List layouts that are worse than the best by at most this, in %.
    #[arg(long, value_name = "NUMBER", default_value_t = 2.0, value_parser = at_least(0.0), help_heading = EXPERT)]
    pub within_percent: f64,
    /// Nodes of the observer's wall along the axis: places between two of them count as one [default: 6].
    #[arg(long, value_name = "NUMBER", value_parser = at_least(1_usize), help_heading = EXPERT)]
    pub wall_nodes: Option<usize>,
    /// Monte Carlo runs of the best layouts in the observer's own world, and a fifth as many in drawn cylinders; 100 take some
    /// minutes [default: none].
    #[arg(long, value_name = "NUMBER", default_value_t = 0, hide_default_value = true, value_parser = at_least(0_u64),
        help_heading = EXPERT)]
    pub confirm: u64,
    /// First seed of drawn sensors and of Monte Carlo runs, a whole number of at least 0.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = at_least(0_u64), help_heading = EXPERT)]
    pub seed: u64,
}

/// Search of layouts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SearchMethod {
    /// Every layout that is allowed.
    Exhaustive,
    /// Branch and bound: as certain, with fewer layouts; criteria gas-temperature, mass and leak-rate only.
    BranchAndBound,
    /// Greedy, then swaps as long as one is better; proves nothing by itself.
    Greedy,
}

impl From<SearchMethod> for Method {
    fn from(method: SearchMethod) -> Self {
        match method {
            SearchMethod::Exhaustive => Self::Exhaustive,
            SearchMethod::BranchAndBound => Self::BranchAndBound,
            SearchMethod::Greedy => Self::Greedy,
        }
    }
}

/// A criterion by its word.
fn criterion() -> impl TypedValueParser<Value = Criterion> {
    let words = PossibleValuesParser::new(Criterion::ALL.map(Criterion::as_str));
    words.try_map(|word| {
        let found = Criterion::ALL.into_iter().find(|criterion| criterion.as_str() == word);
        found.ok_or("there is no such criterion")
    })
}

const HELP: &str = "\
Which sensors, and where: for each number of sensors the best layout by one criterion, what no
layout can fall below, all that are as good within 2 %, and the same layouts by every other
number: gas temperature, mass, leak rate, smallest leak found in time, delay of a leak, and the
error along a scenario when films, couplings and gas are not as supposed. Then cost against
accuracy and delay, every sensor lost and at fault, the effect of unknown errors,
one thermometer at each place, and the same by the measure of the paper that this starts from:
the fit of a first-order model.

Criteria: gas-temperature, mass, leak-rate (standard deviation at rest; a bound is proven),
smallest-leak, and along the first scenario course-mean, course-worst, robust-mean, robust-worst
(of the gas temperature; robust: with model error).

Candidates are every axial cell of the wall, valve, ambient, pressure (required) and gas_1 (a
thermocouple in the gas, forbidden: a reference). A file changes that; all of it may be left out:

  minimum_distance_mm = 100     # of thermometers on the wall, along the axis

  [[sensor]]                    # instead of all places: as in a file of --sensors
  name = \"wall_300mm\"
  height_mm = 300

  [[rule]]
  sensor = \"shoulder\"
  cost = 2.5                    # 1 by default
  status = \"required\"           # or allowed, forbidden

  [[group]]
  members = [\"valve\", \"neck\"]
  at_least = 0
  at_most = 1

Without --output, --format and --json stdout gets tables for people; CSV has a row for each judged
layout.

Ctrl-C or --time-limit-min end the search with what it has; exit code 3 then.

Examples:
  cylwatch place nitrogen-20l
  cylwatch place nitrogen-20l --sensors 3 --criterion smallest-leak --plot places.svg
  cylwatch place my-cylinder.toml --candidates places.toml --budget 6 --json -o study.json
  cylwatch place nitrogen-20l --confirm 100 --seed 7
  cylwatch place nitrogen-20l --scenario none --matrices matrices.json";
