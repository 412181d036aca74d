//! The command line: raw arguments ([`arguments`]), validated options (the start of every command), the run, the output.
//!
//! Data goes to stdout, words to stderr. Exit codes: 0 done (also when the reader of a pipe has gone), 2 error; of `monitor`
//! and `fleet` also 1 leak found, 3 inconclusive; of `place` 3 ended early; of `bench-detector` 3 worlds failed or are missing.
mod appended;
mod arguments;
mod bench_detector;
mod beside;
mod calibrate;
mod call;
mod commission;
mod compile;
mod completions;
mod estimate;
mod fill;
mod fleet;
mod fleet_progress;
mod fmu;
mod format;
mod host;
mod identify;
mod init;
mod input;
mod inspect;
mod inspection;
mod interrupt;
mod live;
mod man;
mod message;
mod monitor;
mod number;
mod options;
mod output;
mod place;
mod progress;
mod properties;
mod reproduce;
mod result;
mod row_stream;
mod schema;
mod selection;
#[cfg(feature = "serve")]
mod serve;
mod simulate;
mod start;
mod states;
mod steps;
mod unit_options;
mod views;

use arguments::{Arguments, Command};
pub(crate) use call::{called, estimate_steps, fleet_of, monitor_steps, properties_of};
use clap::FromArgMatches;
pub(crate) use estimate::Steps as EstimateSteps;
pub use fleet::FleetOutcome;
pub use fleet_progress::FleetProgress;
pub use host::Outcome;
pub(crate) use host::{Host, Stopped};
use message::Messages;
pub(crate) use monitor::Steps as MonitorStepper;
pub use monitor::{RowsWanted, Told};
use std::process::ExitCode;
pub use steps::StepTime;

/// Exit code of an error.
const ERROR: u8 = 2;

/// The program `cylwatch`: reads the arguments, runs the command, and turns its outcome into an exit code.
pub fn main() -> ExitCode {
    let mut matches = Arguments::prepared().get_matches();
    let arguments = Arguments::from_arg_matches_mut(&mut matches).unwrap_or_else(|error| error.exit());
    let messages = Messages::new(arguments.quiet);
    match run(arguments.command, &messages) {
        Ok(code) => code,
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            messages.error(&error);
            ExitCode::from(ERROR)
        }
    }
}

fn run(command: Command, messages: &Messages) -> anyhow::Result<ExitCode> {
    let done = match command {
        Command::Monitor(arguments) => return monitor::run(*arguments, messages),
        Command::Fleet(arguments) => return fleet::run(*arguments, messages),
        Command::Place(arguments) => return place::run(*arguments, messages),
        Command::Inspection(arguments) => return inspection::run(*arguments, messages),
        Command::BenchDetector(arguments) => return bench_detector::run(arguments, messages),
        Command::Reproduce(arguments) => reproduce::run(arguments, messages),
        Command::Simulate(arguments) => simulate::run(arguments, messages),
        Command::Estimate(arguments) => estimate::run(*arguments, messages),
        Command::Inspect(arguments) => inspect::run(arguments, messages),
        Command::Identify(arguments) => identify::run(*arguments, messages),
        Command::Compile(arguments) => compile::run(*arguments, messages),
        Command::Fmu(arguments) => fmu::run(*arguments, messages),
        Command::Commission(arguments) => commission::run(*arguments, messages),
        Command::Calibrate(arguments) => calibrate::run(*arguments, messages),
        #[cfg(feature = "serve")]
        Command::Serve(arguments) => serve::run(arguments, messages),
        #[cfg(not(feature = "serve"))]
        Command::Serve { .. } => Err(anyhow::anyhow!(
            "this program was built without the gateway: build it with `cargo build --release --features serve`"
        )),
        Command::Properties(arguments) => properties::run(arguments, messages),
        Command::Init(arguments) => init::run(arguments, messages),
        Command::Schema(arguments) => schema::run(arguments),
        Command::Man(arguments) => man::run(arguments, Arguments::prepared(), messages),
        Command::Completions(arguments) => completions::run(arguments, Arguments::prepared()),
    };
    done.map(|()| ExitCode::SUCCESS)
}

/// Whether the reader of our output has gone, as `head` does when it has seen enough: that is success.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<std::io::Error>())
        .any(|cause| cause.kind() == std::io::ErrorKind::BrokenPipe)
}
