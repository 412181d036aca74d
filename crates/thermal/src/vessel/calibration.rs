//! The record of a calibration in a vessel file: which values were fitted, from what, when, and how well they are known.
//!
//! The record changes nothing: the values themselves stand in the fields that they belong to. It is checked all the same,
//! so that a file that was edited by hand does not claim what cannot be.
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ThermalError;
use crate::document::check;

/// Record of a calibration.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct CalibrationSpec {
    /// When, in the form of RFC 3339, e.g. `2026-03-01T12:00:00Z`.
    pub date: String,
    /// Program and version.
    pub program: String,
    /// How it was fitted.
    pub settings: String,
    /// Probability with which an interval holds the truth.
    pub confidence: f64,
    /// The vessel file that it began with.
    pub vessel: OriginSpec,
    /// The logs that it was fitted to.
    #[serde(default)]
    pub log: Vec<OriginSpec>,
    /// What was fitted: values of the vessel, and those of logs and sensors that were fitted beside them.
    #[serde(default)]
    pub fitted: Vec<FittedSpec>,
}

/// A file that something comes from.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct OriginSpec {
    /// Name as it was given.
    pub name: String,
    /// SHA-256 of its bytes, 64 hexadecimal digits.
    pub sha256: String,
}

/// A fitted parameter.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct FittedSpec {
    /// Name, e.g. `wall-capacity` or `offset:shoulder`.
    pub parameter: String,
    /// The log that has a value of its own; without it the value holds for all.
    pub of_log: Option<String>,
    /// Unit of the numbers; `1` for a factor on what the file said before.
    pub unit: String,
    /// Value.
    pub value: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// What was known beforehand; nothing by default.
    pub prior: Option<PriorSpec>,
}

/// What was known of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
pub struct PriorSpec {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

impl CalibrationSpec {
    /// Checks the record.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that cannot be.
    pub(crate) fn check(&self) -> Result<(), ThermalError> {
        if !is_date(&self.date) {
            let remedy = "write it as 2026-03-01T12:00:00Z";
            let bound = "a date with time and zone of RFC 3339";
            return Err(check::broken("calibration.date", format!("{:?}", self.date), bound, remedy));
        }
        let (confidence, remedy) = (self.confidence, "0.95 is usual");
        check::positive("calibration.confidence", confidence, remedy)?;
        check::within("calibration.confidence", confidence, (0.0, 1.0 - 1e-12), "below 1", remedy)?;
        self.vessel.check("calibration.vessel")?;
        for (i, log) in self.log.iter().enumerate() {
            log.check(&format!("calibration.log[{i}]"))?;
        }
        self.fitted
            .iter()
            .enumerate()
            .try_for_each(|(i, fitted)| fitted.check(&format!("calibration.fitted[{i}]")))
    }
}

impl OriginSpec {
    fn check(&self, path: &str) -> Result<(), ThermalError> {
        let digits = self.sha256.len() == 64 && self.sha256.bytes().all(|byte| byte.is_ascii_hexdigit());
        if digits {
            return Ok(());
        }
        let bound = "64 hexadecimal digits";
        let remedy = "sha256sum prints them";
        Err(check::broken(&format!("{path}.sha256"), format!("{:?}", self.sha256), bound, remedy))
    }
}

impl FittedSpec {
    fn check(&self, path: &str) -> Result<(), ThermalError> {
        let remedy = "calibrate anew rather than edit the record";
        check::not_negative(&format!("{path}.sd"), self.sd, remedy)?;
        let bound = format!("between low = {} and high = {}", self.low, self.high);
        check::within(&format!("{path}.value"), self.value, (self.low, self.high), &bound, remedy)?;
        if let Some(prior) = &self.prior {
            check::positive(&format!("{path}.prior.sd"), prior.sd, remedy)?;
        }
        Ok(())
    }
}

/// Whether a text is a date with time and zone.
fn is_date(text: &str) -> bool {
    let date = text.parse::<toml::value::Datetime>();
    date.is_ok_and(|date| date.date.is_some() && date.time.is_some() && date.offset.is_some())
}
