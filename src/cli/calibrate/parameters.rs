//! What is fitted: names, starts, priors and bounds of the command line as parameters.
use super::conditions::Conditions;
use super::recording::Recording;
use crate::estimator::calibrate::{ParameterKind, ParameterNameError, ParameterSpec, Prior};
use crate::estimator::log::Quantity;
use crate::estimator::sensor::{Parameter, Sensor, Site, SurfacePlace};
use crate::report::calibrate::shown_unit;
use crate::thermal::vessel::Vessel;
use anyhow::{Context, bail};

/// Prior of the valve's contact where --fit does not name it: 5 to 15 W/K, and no sensor sees it well.
const CONTACT_SD: f64 = 0.5;

/// Options that are not yet compared with logs.
#[derive(Debug)]
pub(super) struct ParameterChoice {
    fit: Vec<ParameterKind>,
    hold: Vec<ParameterKind>,
    priors: Vec<(ParameterKind, [f64; 2])>,
    bounds: Vec<(ParameterKind, [f64; 2])>,
    starts: Vec<(ParameterKind, [f64; 1])>,
    profiles: Vec<ParameterKind>,
}

/// An experiment that parameters are made for.
pub(super) struct Subject<'a> {
    pub vessel: &'a Vessel,
    pub recording: &'a Recording,
    pub conditions: &'a Conditions,
    /// Whether it is on the vessel that the calibration is about: its sensors are shared with all such logs.
    pub is_main: bool,
}

/// Words of the command line.
pub(super) struct ParameterArguments<'a> {
    pub fit: &'a [String],
    pub hold: &'a [String],
    pub priors: &'a [String],
    pub bounds: &'a [String],
    pub starts: &'a [String],
    pub profiles: &'a [String],
}

impl ParameterChoice {
    /// Reads the words.
    pub(super) fn checked(words: &ParameterArguments<'_>) -> anyhow::Result<Self> {
        let names = |option: &str, names: &[String]| -> anyhow::Result<Vec<ParameterKind>> {
            names.iter().map(|name| kind(option, name.trim())).collect()
        };
        Ok(Self {
            fit: names("fit", words.fit)?,
            hold: names("hold", words.hold)?,
            priors: assigned("prior", words.priors, "MEAN,SD")?,
            bounds: assigned("bounds", words.bounds, "LOW,HIGH")?,
            starts: assigned("start", words.starts, "VALUE")?,
            profiles: names("profile", words.profiles)?,
        })
    }

    /// Parameters for all subjects, those of the vessel first.
    pub(super) fn parameters(&self, subjects: &[Subject<'_>]) -> anyhow::Result<Vec<ParameterSpec>> {
        let wanted = if self.fit.is_empty() { usual(subjects) } else { self.fit.clone() };
        let mut specs: Vec<ParameterSpec> = Vec::new();
        for kind in wanted.iter().filter(|kind| !kind.is_of_experiment()) {
            let spec = free(kind, subjects)?;
            let is_usual = self.fit.is_empty() && *kind == ParameterKind::ValveContact;
            specs.push(if is_usual { spec.with_prior(1.0, CONTACT_SD) } else { spec });
        }
        for spec in nuisances(subjects) {
            let is_there = |other: &ParameterSpec| other.kind == spec.kind && other.scope == spec.scope;
            let free = wanted.contains(&spec.kind) && !spec.kind.is_of_experiment();
            if !free && !self.hold.contains(&spec.kind) && !specs.iter().any(is_there) {
                specs.push(spec);
            }
        }
        if let Some(both) = wanted.iter().find(|kind| self.hold.contains(kind)) {
            bail!("--fit and --hold both name {}: keep one", both.name());
        }
        self.refine(&mut specs, subjects)?;
        Ok(specs)
    }

    /// Places of the parameters whose profile is asked for.
    pub(super) fn profiles(&self, specs: &[ParameterSpec]) -> anyhow::Result<Vec<usize>> {
        let place = |kind: &ParameterKind| {
            specs
                .iter()
                .position(|spec| spec.kind == *kind)
                .with_context(|| not_fitted("profile", kind, specs))
        };
        self.profiles.iter().map(place).collect()
    }

    /// Priors, bounds and starts of the command line.
    fn refine(&self, specs: &mut [ParameterSpec], subjects: &[Subject<'_>]) -> anyhow::Result<()> {
        let unit = |kind: &ParameterKind| shown_unit(kind, is_pressure(kind, subjects)).1;
        let named = |option: &str, kind: &ParameterKind, specs: &[ParameterSpec]| {
            if specs.iter().any(|spec| spec.kind == *kind) {
                Ok(())
            } else {
                bail!(not_fitted(option, kind, specs))
            }
        };
        for (kind, [mean, sd]) in &self.priors {
            named("prior", kind, specs)?;
            let prior = Prior { mean: mean * unit(kind), sd: sd * unit(kind) };
            for spec in specs.iter_mut().filter(|spec| spec.kind == *kind) {
                spec.prior = Some(prior);
                // The search begins at what is known, unless it is told otherwise below.
                spec.start = prior.mean;
            }
        }
        for (kind, [low, high]) in &self.bounds {
            named("bounds", kind, specs)?;
            for spec in specs.iter_mut().filter(|spec| spec.kind == *kind) {
                let (low, high) = (low * unit(kind), high * unit(kind));
                spec.bounds = Some((low, high));
                if !(low..=high).contains(&spec.start) || spec.start == low || spec.start == high {
                    spec.start = 0.5 * (low + high);
                }
            }
        }
        for (kind, [start]) in &self.starts {
            named("start", kind, specs)?;
            for spec in specs.iter_mut().filter(|spec| spec.kind == *kind) {
                spec.start = start * unit(kind);
            }
        }
        Ok(())
    }
}

/// What a usual log determines.
fn usual(subjects: &[Subject<'_>]) -> Vec<ParameterKind> {
    let any = |has: &dyn Fn(&Subject<'_>) -> bool| subjects.iter().any(has);
    let has_pressure = any(&|subject| {
        subject.recording.sensors.iter().any(|sensor| sensor.quantity() == Quantity::Pressure)
    });
    let on_valve = |sensor: &Sensor| sensor.site() == Site::Surface(SurfacePlace::Valve);
    let has_valve =
        any(&|subject| subject.vessel.valve.is_some() && subject.recording.sensors.iter().any(on_valve));
    let mut kinds = vec![ParameterKind::OutsideFilm];
    kinds.extend(has_pressure.then_some(ParameterKind::InsideFilm));
    kinds.extend(has_valve.then_some(ParameterKind::ValveContact));
    kinds
}

/// A parameter without a prior, for all experiments that have what it acts on.
fn free(kind: &ParameterKind, subjects: &[Subject<'_>]) -> anyhow::Result<ParameterSpec> {
    let start = match kind {
        ParameterKind::DischargeCoefficient { .. } => 0.8,
        kind if kind.is_positive() => 1.0,
        _ => 0.0,
    };
    let Some(name) = kind.sensor() else {
        let spec = ParameterSpec::new(kind.clone(), start);
        let acts = |subject: &Subject<'_>| match kind {
            ParameterKind::ValveCapacity | ParameterKind::ValveContact => subject.vessel.valve.is_some(),
            ParameterKind::DischargeCoefficient { flow } => {
                subject.conditions.scenario.flows.iter().any(|known| known.name == *flow)
            }
            _ => true,
        };
        // Where it acts on nothing at all, the fit says so.
        return Ok(if subjects.iter().any(acts) { scoped(spec, subjects, acts) } else { spec });
    };
    let sensors = || subjects.iter().flat_map(|subject| &subject.recording.sensors);
    let Some(sensor) = sensors().find(|sensor| sensor.name == name) else {
        let mut known: Vec<&str> = sensors().map(|sensor| sensor.name.as_str()).collect();
        known.dedup();
        let nearest = nearest(name, known.iter().copied());
        bail!("{}: the log has no sensor {name}{nearest}; it has {}", kind.name(), known.join(", "));
    };
    let stated = ParameterSpec::of_sensor(sensor).into_iter().find(|spec| spec.kind == *kind);
    let start = match (kind, stated) {
        (_, Some(stated)) => stated.start,
        (ParameterKind::SensorLag { .. }, None) => sensor.lag_s.max(1.0),
        _ => 0.0,
    };
    Ok(scoped(ParameterSpec::new(kind.clone(), start), subjects, |subject| {
        subject.is_main && subject.recording.sensors.iter().any(|sensor| sensor.name == name)
    }))
}

/// The start of each log, and the numbers of each sensor within its data sheet.
fn nuisances(subjects: &[Subject<'_>]) -> Vec<ParameterSpec> {
    let mut specs = Vec::new();
    for (index, subject) in subjects.iter().enumerate() {
        let Conditions { temperature_sd_k, mass_sd, air_offset, .. } = subject.conditions;
        let own = |kind, start, sd| ParameterSpec::new(kind, start).with_prior(start, sd).only(vec![index]);
        specs.push(own(ParameterKind::InitialTemperature, 0.0, *temperature_sd_k));
        specs.push(own(ParameterKind::FillMass, 1.0, *mass_sd));
        if let Some(Parameter { mean, sd, .. }) = *air_offset {
            specs.push(own(ParameterKind::AirOffset, mean, sd));
        }
    }
    for (index, subject) in subjects.iter().enumerate() {
        for spec in subject.recording.sensors.iter().flat_map(ParameterSpec::of_sensor) {
            let name = spec.kind.sensor().unwrap_or_default().to_owned();
            let shares = |other: &Subject<'_>| {
                other.is_main && other.recording.sensors.iter().any(|sensor| sensor.name == name)
            };
            specs.push(if subject.is_main { scoped(spec, subjects, shares) } else { spec.only(vec![index]) });
        }
    }
    specs
}

/// A parameter for those subjects that it is for.
fn scoped(
    spec: ParameterSpec,
    subjects: &[Subject<'_>],
    is_for: impl Fn(&Subject<'_>) -> bool,
) -> ParameterSpec {
    let these: Vec<usize> = (0..subjects.len()).filter(|&index| is_for(&subjects[index])).collect();
    if these.len() == subjects.len() { spec } else { spec.only(these) }
}

fn is_pressure(kind: &ParameterKind, subjects: &[Subject<'_>]) -> bool {
    let mut sensors = subjects.iter().flat_map(|subject| &subject.recording.sensors);
    sensors
        .any(|sensor| kind.sensor() == Some(sensor.name.as_str()) && sensor.quantity() == Quantity::Pressure)
}

/// A parameter by its name.
fn kind(option: &str, name: &str) -> anyhow::Result<ParameterKind> {
    name.parse::<ParameterKind>().map_err(|error| match error {
        ParameterNameError::Unknown { name, known } => {
            let names: Vec<String> = ParameterKind::names().collect();
            let (word, object) = name.split_once(':').unwrap_or((&name, ""));
            let near = nearest(word, names.iter().map(|name| name.trim_end_matches(':')));
            let object = if object.is_empty() { String::new() } else { format!(" (of {object})") };
            anyhow::anyhow!("--{option} {word}{object}: there is no such parameter{near}; known are {known}")
        }
        other => anyhow::anyhow!("--{option}: {other}"),
    })
}

/// `NAME=A,B` with as many numbers as the option takes.
fn assigned<const N: usize>(
    option: &str,
    texts: &[String],
    form: &str,
) -> anyhow::Result<Vec<(ParameterKind, [f64; N])>> {
    let read = |text: &String| {
        let wrong = || format!("--{option} {text}: write NAME={form}, as outside-film={}", example(N));
        let (name, numbers) = text.split_once('=').with_context(wrong)?;
        let numbers: Result<Vec<f64>, _> = numbers.split(',').map(|number| number.trim().parse()).collect();
        let numbers = numbers.ok().filter(|numbers| numbers.iter().all(|number: &f64| number.is_finite()));
        let numbers = numbers.and_then(|numbers| numbers.try_into().ok()).with_context(wrong)?;
        Ok((kind(option, name.trim())?, numbers))
    };
    texts.iter().map(read).collect()
}

fn example(numbers: usize) -> &'static str {
    if numbers == 1 { "1.2" } else { "0.8,1.5" }
}

fn not_fitted(option: &str, kind: &ParameterKind, specs: &[ParameterSpec]) -> String {
    let fitted: Vec<String> = specs.iter().map(|spec| spec.kind.name()).collect();
    format!("--{option}: {} is not fitted; fitted are {}: add it to --fit", kind.name(), fitted.join(", "))
}

/// The nearest name, as a question.
fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> String {
    let likeness = |candidate: &str| strsim::jaro_winkler(word, candidate);
    let best = known.max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    best.filter(|best| likeness(best) > 0.7).map_or(String::new(), |best| format!(", did you mean {best}?"))
}
