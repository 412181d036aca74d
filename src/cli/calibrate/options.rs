//! Options that fit each other.
use super::*;
use crate::cli::output::check_distinct;

impl Options {
    /// Checks everything that can be checked before a file is read.
    pub(super) fn checked(arguments: CalibrateArguments) -> anyhow::Result<Self> {
        let mut logs = arguments.logs;
        let validation = validation(arguments.validate.as_deref(), &mut logs)?;
        check_logs(&arguments.vessel, &logs)?;
        let scenarios = of_logs("scenario", &arguments.scenarios, &logs)?;
        let vessels = of_logs("vessel-of", &arguments.vessels, &logs)?;
        let mut inputs: Vec<&Path> = vec![Path::new(&arguments.vessel)];
        inputs.extend(logs.iter().map(Path::new));
        inputs.extend(scenarios.values().chain(vessels.values()).map(Path::new));
        inputs.extend(arguments.sensors.sensors.as_deref());
        let vessel_file = document("-o", arguments.output.as_deref(), &inputs)?;
        let sensors_file = document("--sensors-out", arguments.sensors_out.as_deref(), &inputs)?;
        if matches!(vessel_file, Some(Target::Stdout)) && arguments.format != CalibrationFormat::Text {
            bail!("-o - and --format both want stdout: name a file for the vessel");
        }
        check_distinct(&[("-o", vessel_file.as_ref()), ("--sensors-out", sensors_file.as_ref())])?;
        let others: Vec<&Target> = vessel_file.iter().chain(&sensors_file).collect();
        let views = Views::checked(&arguments.views, &inputs, &others)?;
        let words = ParameterArguments {
            fit: &arguments.fit,
            hold: &arguments.hold,
            priors: &arguments.priors,
            bounds: &arguments.bounds,
            starts: &arguments.starts,
            profiles: &arguments.profiles,
        };
        let mut settings =
            CalibrationSettings { iterations: arguments.iterations, ..CalibrationSettings::default() };
        if let Some(tolerance) = arguments.solver.relative_tolerance {
            settings.simulation.relative_tolerance = tolerance;
        }
        settings.validate()?;
        Ok(Self {
            parameters: ParameterChoice::checked(&words)?,
            scenarios,
            vessels,
            vessel: arguments.vessel,
            logs,
            reading: arguments.reading,
            sensors: arguments.sensors.sensors,
            validation,
            settings,
            quantities: arguments.quantities,
            fill: arguments.fill,
            date: date::date(arguments.date.as_deref())?,
            vessel_file,
            sensors_file,
            format: arguments.format,
            views,
        })
    }
}

/// What is held out; a log becomes the last of the list.
fn validation(text: Option<&str>, logs: &mut Vec<String>) -> anyhow::Result<Option<Validation>> {
    Ok(match text.map(|text| (text, text.parse::<f64>())) {
        None => None,
        Some((_, Ok(fraction))) if fraction > 0.0 && fraction < 1.0 => {
            if logs.len() > 1 {
                bail!(
                    "--validate {fraction} holds out a part of one log, and there are {}: hold out a log",
                    logs.len()
                );
            }
            Some(Validation::Fraction(fraction))
        }
        Some((text, Ok(_))) => bail!("--validate {text} must lie between 0 and 1, or name a log"),
        Some((log, Err(_))) => {
            logs.push(log.to_owned());
            Some(Validation::LastLog)
        }
    })
}

/// Each log once, and stdin once.
fn check_logs(vessel: &str, logs: &[String]) -> anyhow::Result<()> {
    for (k, log) in logs.iter().enumerate() {
        if logs[..k].contains(log) {
            bail!("the log {log} is given twice: give each log once");
        }
    }
    if vessel == "-" && logs.iter().any(|log| log == "-") {
        bail!("stdin can be the vessel or a log, not both: give the other one as a file");
    }
    Ok(())
}

/// Place of a file that is calibrated.
fn document(option: &str, path: Option<&Path>, inputs: &[&Path]) -> anyhow::Result<Option<Target>> {
    let is_toml = |path: &Path| {
        path == Path::new("-") || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
    };
    if let Some(path) = path.filter(|path| !is_toml(path)) {
        bail!(
            "{option} {}: what is calibrated is a file that ends in .toml; --format json has all the rest",
            path.display()
        );
    }
    path.map(|path| Target::checked(Some(path), inputs)).transpose()
}

/// `LOG=THING` for each log, or one `THING` for all.
fn of_logs(option: &str, texts: &[String], logs: &[String]) -> anyhow::Result<BTreeMap<String, String>> {
    let mut found = BTreeMap::new();
    for text in texts {
        let these: Vec<&String> = match text.split_once('=') {
            Some((log, _)) => {
                let known = logs.iter().find(|known| *known == log);
                vec![known.with_context(|| {
                    format!("--{option} {text}: {log} is none of the logs, which are {}", logs.join(", "))
                })?]
            }
            None if option == "vessel-of" => bail!("--{option} {text}: write LOG=VESSEL"),
            None => logs.iter().collect(),
        };
        let thing = text.split_once('=').map_or(text.as_str(), |(_, thing)| thing);
        for log in these {
            if found.insert(log.clone(), thing.to_owned()).is_some() {
                bail!("--{option} {text}: {log} has one already: give one for each log");
            }
        }
    }
    Ok(found)
}
