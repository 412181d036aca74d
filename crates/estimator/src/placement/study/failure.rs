//! What is lost with a sensor, whether its fault is found, and what unknown errors do to the estimates.
//!
//! A fault is a constant error of one sensor's readings from some sample on. It is found like a leak, by its signature in the
//! innovations ([`Disturbance`]), and it is told from a leak and from the fault of any other sensor by what its signature has that theirs has not.
use serde::{Deserialize, Serialize};

use super::Placement;
use crate::EstimatorError;
use crate::log::Quantity as Reading;
use crate::placement::cylinder::Quantity;
use crate::placement::response::{Disturbance, Response};
use crate::placement::steady::SteadyAccuracy;
use crate::sensor::ParameterKind;

/// A fault that a workshop should be able to find: 1 K, 1 bar.
const REQUIRED_FAULT: [f64; 2] = [1.0, 1e5];
/// Difference of air and wall that a coupling error is told at, K.
const COUPLED_K: f64 = 10.0;
/// Times after which a bias is told, s.
const TIMES_S: [f64; 3] = [3600.0, 86_400.0, 7.0 * 86_400.0];

/// Without a sensor, or with a fault of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// Index of the candidate.
    pub sensor: usize,
    /// What the other sensors know; `None`: they do not see every state.
    pub without: Option<SteadyAccuracy>,
    /// The state that they do not see.
    pub unseen: Option<String>,
    /// Smallest constant error that is found in time, K or Pa.
    pub found: f64,
    /// Smallest that is also told from a leak and from every other sensor's, K or Pa; infinite: none is.
    pub isolated: f64,
    /// What it is confused with longest: a candidate, or the leak.
    pub confused_with: Option<usize>,
    /// Whether 1 K or 1 bar is told from everything else in time.
    pub is_isolable: bool,
    /// Error of the gas temperature that a fault of 1 K or 1 bar makes after a day, K.
    pub gas_k: f64,
    /// Of the mass, kg.
    pub mass_kg: f64,
}

/// What disturbs the estimates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BiasSource {
    /// A sensor's offset.
    Offset(usize),
    /// A sensor's coupling to the air, with 10 K between air and wall.
    Coupling(usize),
    /// Sun on the upper quarter of the wall.
    Sun,
}

/// What one standard deviation of something unknown, from some time on, does to the estimates after an hour, a day and a week.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bias {
    /// What it is.
    pub source: BiasSource,
    /// The standard deviation: K or Pa of a reading, W of the sun.
    pub size: f64,
    /// Change of the gas temperature, K.
    pub gas_k: [f64; 3],
    /// Change of the mass, kg.
    pub mass_kg: [f64; 3],
    /// Change of the leak rate, kg/s.
    pub leak_kg_s: [f64; 3],
}

impl Placement {
    /// Each sensor of a layout lost, and at fault.
    pub(super) fn failures(&self, layout: &[usize]) -> Result<Vec<Failure>, EstimatorError> {
        let mut disturbances = vec![Disturbance::Leak];
        disturbances.extend(layout.iter().map(|&candidate| Disturbance::Reading { candidate }));
        let response = self.steady().response(layout, &disturbances)?;
        let information = response.information(self.steady().samples());
        let detection = self.steady().settings().detection;
        let failure = |(place, &sensor): (usize, &usize)| {
            let own = place + 1;
            let all = information[(own, own)];
            // What is left of its signature beside that of another.
            let beside = |other: usize| all - information[(own, other)].powi(2) / information[(other, other)];
            let others = (0..disturbances.len()).filter(|other| *other != own);
            let nearest = others.map(|other| (other, beside(other))).min_by(|a, b| a.1.total_cmp(&b.1));
            let (nearest, left) = nearest.unwrap_or((0, all));
            let isolated = if left > 0.0 { detection.smallest(left) } else { f64::INFINITY };
            let fault = REQUIRED_FAULT[usize::from(self.is_pressure(sensor))];
            let others: Vec<usize> = layout.iter().copied().filter(|other| *other != sensor).collect();
            let without = self.steady().accuracy(&others);
            let unseen = match &without {
                Err(EstimatorError::Unseen { state }) => Some(state.clone()),
                _ => None,
            };
            let after = |quantity| fault * response.bias(quantity, self.samples(TIMES_S[1]))[own];
            Failure {
                sensor,
                without: without.ok(),
                unseen,
                found: detection.smallest(all),
                isolated,
                confused_with: nearest.checked_sub(1).map(|place| layout[place]),
                is_isolable: isolated <= fault,
                gas_k: after(Quantity::GasTemperature),
                mass_kg: after(Quantity::Mass),
            }
        };
        Ok(layout.iter().enumerate().map(failure).collect())
    }

    /// What a standard deviation of each error of a layout does.
    pub(super) fn biases(&self, layout: &[usize]) -> Result<Vec<Bias>, EstimatorError> {
        let mut sources = Vec::new();
        for &sensor in layout {
            let parameters = self.candidates().list[sensor].sensor.parameters();
            let sd = |kind| parameters.iter().find(|of| of.kind == kind).map_or(0.0, |of| of.sd);
            let reading = Disturbance::Reading { candidate: sensor };
            sources.push((BiasSource::Offset(sensor), reading, sd(ParameterKind::Offset)));
            let coupled_k = COUPLED_K * sd(ParameterKind::Coupling);
            sources.push((BiasSource::Coupling(sensor), reading, coupled_k));
        }
        let sun_w = self.steady().settings().observer.sun.prior_sd;
        sources.push((BiasSource::Sun, Disturbance::Sun, sun_w));
        sources.retain(|(.., size)| *size > 0.0);
        let disturbances: Vec<Disturbance> = sources.iter().map(|(_, disturbance, _)| *disturbance).collect();
        let response: Response = self.steady().response(layout, &disturbances)?;
        let at = |quantity| TIMES_S.map(|time_s| response.bias(quantity, self.samples(time_s)));
        let [gas, mass, leak] = [Quantity::GasTemperature, Quantity::Mass, Quantity::LeakRate].map(at);
        let bias = |(index, &(source, _, size)): (usize, &(BiasSource, Disturbance, f64))| Bias {
            source,
            size,
            gas_k: [0, 1, 2].map(|time| size * gas[time][index]),
            mass_kg: [0, 1, 2].map(|time| size * mass[time][index]),
            leak_kg_s: [0, 1, 2].map(|time| size * leak[time][index]),
        };
        Ok(sources.iter().enumerate().map(bias).collect())
    }

    fn is_pressure(&self, candidate: usize) -> bool {
        self.candidates().list[candidate].sensor.quantity() == Reading::Pressure
    }

    fn samples(&self, time_s: f64) -> u64 {
        (time_s / self.steady().settings().conditions.interval_s).round().max(1.0) as u64
    }
}
