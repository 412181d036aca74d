//! What a calibration found, with everything that it is reported with.
use crate::estimator::calibrate::{
    ApparentLeak, Calibrated, Calibration, ChannelResiduals, ChannelScore, Estimate, Experiment,
    ParameterKind, ParameterSpec, Profile, Scope,
};
use crate::estimator::log::Quantity;
use crate::thermal::units::BAR_PA;
use crate::thermal::vessel::spec::FittedSpec;

const PASCAL_PER_MILLIBAR: f64 = 1e2;

/// A finished calibration.
#[derive(Clone, Debug)]
pub(crate) struct Study {
    /// What was to be fitted, to what.
    pub calibration: Calibration,
    /// What was found.
    pub calibrated: Calibrated,
    /// What was taken from where, a line for each log.
    pub conditions: Vec<String>,
    /// Prediction scores of the held-out data.
    pub scores: Vec<ChannelScore>,
    /// What was held out.
    pub held_out: Option<String>,
    /// Profiles that were asked for.
    pub profiles: Vec<Profile>,
    /// What a finer wall would change ([`Calibrated::mesh_shift_sd`]), in the order of the parameters; empty: not known.
    pub mesh_shift_sd: Vec<f64>,
    /// Logs whose residuals look like a loss of gas ([`Calibrated::apparent_leaks`]).
    pub apparent_leaks: Vec<ApparentLeak>,
}

/// A fitted parameter for people.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<'a> {
    /// Place in the list of parameters.
    pub place: usize,
    /// What was found.
    pub estimate: &'a Estimate,
    /// What was known before.
    pub spec: &'a ParameterSpec,
    /// Unit that people read.
    pub unit: &'static str,
    /// That unit in SI.
    pub factor: f64,
}

/// Unit of a parameter for people, and what it is in SI.
pub(crate) fn shown_unit(kind: &ParameterKind, is_pressure: bool) -> (&'static str, f64) {
    match kind.si_unit(is_pressure) {
        "Pa" => ("bar", BAR_PA),
        "Pa/K" => ("mbar/K", PASCAL_PER_MILLIBAR),
        unit => (unit, 1.0),
    }
}

impl Line<'_> {
    /// Share of the prior's variance that the logs have taken away; 1 without a prior.
    pub(crate) fn learnt(&self) -> f64 {
        1.0 - self.estimate.prior_share.unwrap_or(0.0)
    }
}

impl Study {
    /// Parameters that took part, in their order.
    pub(crate) fn lines(&self) -> Vec<Line<'_>> {
        let specs = &self.calibration.parameters;
        let lines = self.calibrated.estimates.iter().zip(specs).enumerate();
        lines
            .filter(|(_, (_, spec))| self.took_part(&spec.scope))
            .map(|(place, (estimate, spec))| {
                let (unit, factor) = shown_unit(&spec.kind, self.calibrated.is_of_pressure(estimate));
                Line { place, estimate, spec, unit, factor }
            })
            .collect()
    }

    /// The same as lines of a vessel file, SI.
    pub(crate) fn fitted_lines(&self) -> Vec<FittedSpec> {
        let lines = self.calibrated.fitted_specification(&self.sources());
        let specs = &self.calibration.parameters;
        lines
            .into_iter()
            .zip(specs)
            .filter(|(_, spec)| self.took_part(&spec.scope))
            .map(|(line, _)| line)
            .collect()
    }

    /// Name of a parameter, with its log where there are several.
    pub(crate) fn name(&self, line: &Line<'_>) -> String {
        let name = line.spec.kind.name();
        match &line.spec.scope {
            Scope::Only(these) if self.fitted_sources().len() > 1 => {
                let logs: Vec<&str> = these.iter().map(|&log| self.source(log)).collect();
                format!("{name} ({})", logs.join(", "))
            }
            _ => name,
        }
    }

    /// Logs that were fitted.
    pub(crate) fn fitted_sources(&self) -> Vec<&str> {
        let mut sources: Vec<&str> = Vec::new();
        for channel in &self.calibrated.channels {
            if !sources.contains(&channel.experiment.as_str()) {
                sources.push(&channel.experiment);
            }
        }
        sources
    }

    /// Place of the log whose vessel is the main one.
    pub(crate) fn main_experiment(&self) -> usize {
        let fitted = self.fitted_sources();
        let is_main = |one: &Experiment| one.vessel.is_none() && fitted.contains(&one.source.as_str());
        self.calibration.experiments.iter().position(is_main).unwrap_or(0)
    }

    /// How it was fitted.
    pub(crate) fn settings_text(&self) -> String {
        let fitted = self.fitted_sources();
        let of_fitted = |words: &&String| fitted.iter().any(|name| words.starts_with(&format!("{name}:")));
        let mut words: Vec<String> = self.conditions.iter().filter(of_fitted).cloned().collect();
        let held: Vec<String> = self
            .calibration
            .parameters
            .iter()
            .filter_map(|spec| {
                spec.bounds.map(|(low, high)| format!("{} in {low} to {high}", spec.kind.name()))
            })
            .collect();
        if !held.is_empty() {
            words.push(format!("bounds: {}", held.join(", ")));
        }
        if let Some(held_out) = &self.held_out {
            words.push(format!("held out: {held_out}"));
        }
        words.join("; ")
    }

    /// Readings of a channel at the times of its residuals, K or Pa.
    pub(crate) fn readings(&self, channel: &ChannelResiduals) -> Vec<f64> {
        let experiment = self.calibration.experiments.iter().find(|one| one.source == channel.experiment);
        let Some(log) = experiment.map(|one| &one.log) else { return Vec::new() };
        let Some(at) = log.channels.iter().position(|one| one.name == channel.channel) else {
            return Vec::new();
        };
        let row = |time_s: &f64| log.time_s.partition_point(|other| other < time_s);
        channel.time_s.iter().map(|time_s| log.row(row(time_s))[at]).collect()
    }

    /// Whether a channel of a log is a pressure.
    pub(crate) fn is_pressure(&self, experiment: &str, channel: &str) -> bool {
        let experiment = self.calibration.experiments.iter().find(|one| one.source == experiment);
        experiment.is_some_and(|one| {
            let found = one.log.channels.iter().find(|known| known.name == channel);
            found.is_some_and(|found| found.quantity == Quantity::Pressure)
        })
    }

    fn took_part(&self, scope: &Scope) -> bool {
        let fitted = self.fitted_sources();
        let experiments = self.calibration.experiments.iter().enumerate();
        let mut fitted = experiments.filter(|(_, one)| fitted.contains(&one.source.as_str()));
        fitted.any(|(place, _)| scope.contains(place))
    }

    fn sources(&self) -> Vec<String> {
        self.calibration.experiments.iter().map(|one| one.source.clone()).collect()
    }

    fn source(&self, experiment: usize) -> &str {
        self.calibration.experiments.get(experiment).map_or("", |one| &one.source)
    }
}
