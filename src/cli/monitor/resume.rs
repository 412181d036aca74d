//! How a run begins: from a state, or cold.
use super::state::{Identity, Refusal, State};
use super::*;
use crate::estimator::sensor::Sensor;
use crate::report::commission::{CommissionedVessel, VesselMark};
use crate::report::{Input, digest};
use crate::thermal::vessel::Vessel;
use anyhow::anyhow;
use jiff::Timestamp;

/// A vessel and what is known of its past.
pub(super) struct RunStart {
    /// The vessel.
    pub vessel: Vessel,
    /// What tells this vessel from another.
    mark: VesselMark,
    /// Thresholds of its own, if there are some.
    pub commissioned: Option<CommissionedVessel>,
    /// The state that the run continues.
    pub state: Option<State>,
    /// Why there is none although there could be.
    pub cold_start: Option<String>,
}

impl RunStart {
    /// Reads the vessel and the state.
    pub(super) fn find(options: &Options, inputs: &Inputs, messages: &Messages) -> anyhow::Result<Self> {
        let (specification, vessel, _) = inputs.vessel_specification(&options.vessel, messages)?;
        let mark = VesselMark::of(&specification, &vessel)?;
        let commissioned = options.commissioned.as_deref();
        let commissioned = commissioned.map(|path| commissioned_for(inputs, path, &mark)).transpose()?;
        let mut start = Self { vessel, mark, commissioned, state: None, cold_start: None };
        let Some(path) = &options.state else { return Ok(start) };
        match (State::read(path), options.cold_start) {
            (Ok(None), _) => {
                if options.acknowledge.is_some() {
                    bail!("{} is not there: --acknowledge needs a state with alarms", path.display());
                }
            }
            (Ok(Some(state)), false) => {
                if options.learned_in.is_some() {
                    messages.caution("--learned-in is not used: the state contains what was learnt");
                }
                inputs.record(Input::of(path.display().to_string(), &std::fs::read(path)?));
                start.state = Some(state);
            }
            (Ok(Some(_)), true) => start.cold_start = Some("requested by --cold-start".to_owned()),
            (Err(reason), true) => start.cold_start = Some(reason.to_string()),
            (Err(reason), false) => return Err(refused(path, &reason)),
        }
        if let Some(reason) = &start.cold_start {
            messages.caution(&format!("cold start instead of continuing from {}: {reason}", path.display()));
        }
        Ok(start)
    }

    /// Date of second 0 of the state.
    pub(super) fn origin(&self) -> anyhow::Result<Option<Timestamp>> {
        let origin = self.state.as_ref().and_then(|state| state.origin.as_deref());
        origin.map(str::parse).transpose().context("the state has no date of RFC 3339")
    }

    /// What a state of this run belongs to. Limits, the coldest night, how rare a false alarm is to be and thresholds of its own are taken over as they are now.
    pub(super) fn identity(&self, options: &Options, sensors: &[Sensor]) -> Identity {
        let names: Vec<&str> = sensors.iter().map(|sensor| sensor.name.as_str()).collect();
        let value = |value: f64| crate::report::number(value, 9);
        let mut entries = vec![
            ("vessel", format!("{} ({})", self.mark.name, self.mark.digest)),
            ("sensors", format!("{} ({})", names.join(", "), digest(&format!("{sensors:?}")))),
            ("a lateness of", format!("{} s", value(options.lateness_s))),
            ("a step of", format!("{} s", value(options.step_s))),
        ];
        if let Some(words) = options.fill.text() {
            entries.push(("the fill", words));
        }
        Identity(entries.into_iter().map(|(what, value)| (what.to_owned(), value)).collect())
    }
}

/// The refusal of a state, with what to do.
pub(super) fn refused(path: &Path, reason: &Refusal) -> anyhow::Error {
    anyhow!("cannot continue from {}: {reason}; --cold-start starts fresh and replaces it", path.display())
}

/// The thresholds of a file, which must be for this vessel.
fn commissioned_for(inputs: &Inputs, path: &Path, mark: &VesselMark) -> anyhow::Result<CommissionedVessel> {
    let text = inputs.read(&path.to_string_lossy())?;
    CommissionedVessel::read(&text, mark).with_context(|| format!("--commissioned {}", path.display()))
}
