//! What the commands can do with a log, and what it lacks for them.
use super::{ColumnReport, Jump, Refusal, Role, Times};
use crate::estimator::sensor::Sensor;
use crate::log::LogOptions;
use crate::thermal::units::{self, Dimension};

/// Longest interval at which a calibration is worth while, s.
const LONGEST_INTERVAL_S: f64 = 120.0;
/// Shortest log that is worth a calibration, s.
const SHORTEST_S: f64 = 2.0 * 3600.0;
/// Change of the air that a calibration needs, K.
const CHANGE_K: f64 = 10.0;

/// What speaks against a calibration where the air jumps, as in a tunnel.
fn jumps_of_air(column: &ColumnReport) -> Option<String> {
    let proposed = column.proposal.as_ref().map(|proposal| proposal.mapping.ours.as_str());
    let suffix = match (&column.role, proposed) {
        (Role::Reading(_, suffix), _) => suffix,
        (_, Some(ours)) => ours.strip_prefix("ambient_")?,
        _ => return None,
    };
    let unit = units::find(suffix, Dimension::Temperature)?;
    let size_k = |jump: &Jump| (unit.to_si(jump.to) - unit.to_si(jump.from)).abs();
    let largest_k = column.jumps.iter().map(size_k).fold(0.0, f64::max);
    (largest_k > CHANGE_K).then(|| {
        format!("the air jumps by {largest_k:.0} K between two rows, and when it did is not known: a log with slow air tells more")
    })
}

/// A command and the log.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// Name of the command.
    pub command: &'static str,
    /// What the log lacks: nothing, and the command can use it.
    pub lacks: Vec<String>,
    /// What makes its results worth less, or has to be looked at.
    pub but: Vec<String>,
    /// Words of the command line to run next, the program first.
    pub line: Vec<String>,
}

/// What decides.
struct Case<'a> {
    name: &'a str,
    options: &'a LogOptions,
    times: &'a Times,
    columns: &'a [ColumnReport],
    refusals: &'a [Refusal],
    /// Quantities that are read, or would be with the proposals.
    quantities: Vec<String>,
}

/// All commands that read logs.
pub(super) fn uses(
    name: &str,
    options: &LogOptions,
    times: &Times,
    columns: &[ColumnReport],
    refusals: &[Refusal],
) -> Vec<Use> {
    let proposed = |column: &ColumnReport| {
        let ours = &column.proposal.as_ref()?.mapping.ours;
        crate::thermal::units::split(ours).map(|(quantity, _)| quantity.to_owned())
    };
    let quantities = columns.iter().filter_map(|column| column.role.quantity().or_else(|| proposed(column)));
    let case = Case { name, options, times, columns, refusals, quantities: quantities.collect() };
    vec![case.observing("estimate"), case.observing("monitor"), case.identify(), case.calibrate()]
}

impl Case<'_> {
    fn has(&self, quantity: &str) -> bool {
        self.quantities.iter().any(|name| name == quantity)
    }

    /// Thermometers on the cylinder, in the order of the columns.
    fn thermometers(&self) -> impl Iterator<Item = &String> {
        let is_thermometer = |name: &&String| {
            let is_outside = !name.starts_with("gas_") && !matches!(name.as_str(), "ambient" | "pressure");
            is_outside && Sensor::typical(name).is_ok()
        };
        self.quantities.iter().filter(is_thermometer)
    }

    fn observing(&self, command: &'static str) -> Use {
        let mut lacks = self.lacking(command == "monitor");
        let mut but = self.open_questions();
        let mut line = vec!["cylwatch".to_owned(), command.to_owned(), "nitrogen-20l".to_owned()];
        line.extend(self.arguments());
        if self.thermometers().next().is_none() && !self.has("pressure") {
            lacks.push("a thermometer on the cylinder (shoulder is best), or its pressure".to_owned());
        } else if self.thermometers().next().is_none() {
            but.push("without a thermometer on the cylinder it cannot tell cold from leak".to_owned());
        }
        if !self.has("pressure") {
            but.push("without a pressure the fill has to be given".to_owned());
            line.extend(["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"].map(str::to_owned));
        }
        line.extend(["-o".to_owned(), format!("{command}.csv")]);
        Use { command, lacks, but, line }
    }

    fn identify(&self) -> Use {
        let mut lacks = self.lacking(false);
        let input = self.thermometers().next();
        let output = self.quantities.iter().find(|name| name.starts_with("gas_"));
        if input.is_none() || output.is_none() {
            lacks.push(
                "a thermometer on the cylinder and one in the gas, as shoulder and gas_mean".to_owned(),
            );
        }
        let word = |name: Option<&String>, otherwise: &str| name.map_or(otherwise.to_owned(), String::clone);
        let mut line = vec!["cylwatch".to_owned(), "identify".to_owned()];
        line.extend(self.arguments());
        line.extend([
            "--input".to_owned(),
            word(input, "shoulder"),
            "--output".to_owned(),
            word(output, "gas_mean"),
        ]);
        Use { command: "identify", lacks, but: self.open_questions(), line }
    }

    fn calibrate(&self) -> Use {
        let mut lacks = self.lacking(false);
        let mut but = self.open_questions();
        if self.thermometers().next().is_none() {
            lacks.push("a thermometer on the cylinder".to_owned());
        }
        let is_air = |column: &&ColumnReport| {
            let proposed = column.proposal.as_ref().map(|proposal| proposal.mapping.ours.as_str());
            column.role.quantity().as_deref() == Some("ambient")
                || proposed.is_some_and(|ours| ours.starts_with("ambient_"))
        };
        match self.columns.iter().find(is_air) {
            None if !self.has("ambient") => {
                lacks.push("a column ambient, or --scenario to say what the air did".to_owned())
            }
            Some(column) if column.range[2] - column.range[0] < CHANGE_K => {
                but.push(format!("the air changes by less than {CHANGE_K} K: little can be told apart"));
            }
            Some(column) => but.extend(jumps_of_air(column)),
            _ => {}
        }
        if self.times.interval_s > LONGEST_INTERVAL_S {
            but.push(format!("rows should be at most {} min apart", LONGEST_INTERVAL_S / 60.0));
        }
        if self.times.span_s.1 - self.times.span_s.0 < SHORTEST_S {
            but.push(format!("a log should last {} h or more", SHORTEST_S / 3600.0));
        }
        let mut line = ["cylwatch", "calibrate", "nitrogen-20l"].map(str::to_owned).to_vec();
        line.extend(self.arguments());
        line.extend(["-o", "calibrated.toml"].map(str::to_owned));
        Use { command: "calibrate", lacks, but, line }
    }

    /// What every command asks of a log.
    fn lacking(&self, is_monitor: bool) -> Vec<String> {
        let mut lacks = Vec::new();
        if self.times.column.is_none() {
            lacks.push("a column of time".to_owned());
        }
        let has_proposals =
            self.times.supposed.is_some() || self.columns.iter().any(|column| column.proposal.is_some());
        let of_rows = |refusal: &&Refusal| refusal.message.contains(" column ") && has_proposals;
        let refusals = self.refusals.iter().filter(|refusal| !(is_monitor && refusal.monitor_takes_it));
        lacks.extend(refusals.filter(|refusal| !of_rows(refusal)).map(|refusal| refusal.message.clone()));
        lacks
    }

    /// What was supposed and has to be looked at.
    fn open_questions(&self) -> Vec<String> {
        let guessed =
            self.columns.iter().filter_map(|column| column.proposal.as_ref()).filter(|one| !one.is_likely);
        let guessed: Vec<String> = guessed.map(|one| one.mapping.to_string()).collect();
        match guessed.is_empty() {
            true => Vec::new(),
            false => vec![format!("look whether these are so: {}", guessed.join(", "))],
        }
    }

    /// The log, the mappings that were given, and those that are proposed.
    fn arguments(&self) -> Vec<String> {
        let given = self.options.mappings.iter();
        let proposed =
            self.columns.iter().filter_map(|column| column.proposal.as_ref()).map(|one| &one.mapping);
        let mappings = given.chain(&self.times.supposed).chain(proposed);
        // What messages call stdin is `-` on the command line.
        let log = if self.name == "stdin" { "-" } else { self.name };
        let mut arguments = vec![log.to_owned()];
        arguments.extend(mappings.flat_map(|mapping| ["--map".to_owned(), mapping.to_string()]));
        if let Some(zone) = self.options.zone.as_ref().or(self.times.supposed_zone.as_ref()) {
            arguments.extend(["--zone".to_owned(), zone.to_string()]);
        }
        arguments
    }
}
