//! What the observer says after a sample.
use cylwatch_thermal::real::powi;
use cylwatch_thermal::units::QUOTED_K;
use serde::{Deserialize, Serialize};

use super::clock::Exchange;
use super::{Observer, REFERENCE_AFTER_S};
use crate::EstimatorError;
use crate::filter::{Belief, Outcome, StateSpace, mixture};

/// What an estimate rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quality {
    /// Every sensor was heard.
    Good,
    /// A sensor had no reading, or its reading was rejected.
    Degraded,
    /// No reading at all: the model alone.
    Predicted,
    /// Gas is or was just exchanged, or a reading was taken after many rejections: mass and gas temperature are free.
    Open,
    /// The estimate could not go on and began again from its prior.
    Restarted,
}

impl Quality {
    /// One word for a table.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Degraded => "degraded",
            Self::Predicted => "predicted",
            Self::Open => "open",
            Self::Restarted => "restarted",
        }
    }
}

/// Estimate after a sample. SI; `sd` is a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Time, s.
    pub time_s: f64,
    /// Mean gas temperature, K.
    pub gas_mean_k: f64,
    /// Its sd, K.
    pub gas_mean_sd_k: f64,
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Its sd, kg.
    pub mass_sd_kg: f64,
    /// Leak rate, kg/s, by the middle one of the members that have one, else what the one that holds the mass is compensated for; NaN without such a member.
    pub leak_kg_s: f64,
    /// Its sd, kg/s.
    pub leak_sd_kg_s: f64,
    /// Pressure as read, Pa; NaN: missing.
    pub pressure_pa: f64,
    /// Pressure that the transmitter would show now with the reference mass, Pa: with the mass a day after commissioning or
    /// after the last exchange of gas, before that with the mass as estimated.
    pub pressure_expected_pa: f64,
    /// Pressure of the estimated mass settled at 15 °C, Pa.
    pub p15_pa: f64,
    /// How far to rely on it.
    pub quality: Quality,
}

impl Estimate {
    /// Mass and gas temperature where it may be this or the other: between the two, and no more certain than they are apart.
    pub fn or(self, other: Self) -> Self {
        let between = |one: (f64, f64), other: (f64, f64)| {
            let (mean, variance) = mixture(0.5, (one.0, one.1 * one.1), (other.0, other.1 * other.1));
            (mean, libm::sqrt(variance))
        };
        let (mass_kg, mass_sd_kg) =
            between((self.mass_kg, self.mass_sd_kg), (other.mass_kg, other.mass_sd_kg));
        let (gas_mean_k, gas_mean_sd_k) =
            between((self.gas_mean_k, self.gas_mean_sd_k), (other.gas_mean_k, other.gas_mean_sd_k));
        Self { mass_kg, mass_sd_kg, gas_mean_k, gas_mean_sd_k, ..self }
    }
}

/// Leak rate in the eyes of one member.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leak {
    /// Leak rate, kg/s.
    pub rate_kg_s: f64,
    /// Its standard deviation, kg/s.
    pub sd_kg_s: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Its standard deviation, kg.
    pub mass_sd_kg: f64,
    /// Covariance of mass and leak rate, kg²/s.
    pub covariance_kg2_s: f64,
    /// Whether it was out of the question at this sample and began anew from the freest member.
    pub begun_anew: bool,
}

impl Observer {
    /// What the bank says after a sample.
    pub(super) fn estimate(
        &mut self,
        time_s: f64,
        readings: &[f64],
        restarted: bool,
    ) -> Result<Estimate, EstimatorError> {
        let (bank, states) = (&self.bank, self.cylinder.state_map());
        let (thermometer, freest) = (self.roles.thermometer, self.roles.freest);
        let [first_mass, slow_mass, free_mass] = [0, thermometer, freest].map(|index| self.masses[index]);
        let mut mass = Belief::blended(first_mass, free_mass);
        let mut gas = Belief::of(slow_mass, free_mass)
            .blend(bank.moments(thermometer, states.gas), bank.moments(freest, states.gas));
        gas.1 = self.band.stated_k2(gas.1, |state| bank.moments(thermometer, state).1);
        let mut leak = self.roles.slow.map_or((f64::NAN, f64::NAN), |slow| bank.moments(slow, states.leak));
        leak.1 += self.unknown_leak_variance(time_s, free_mass.1);
        if let Some(flow) = self.flow() {
            let belief = Belief::of(slow_mass, flow.mass());
            gas = belief.blend(gas, flow.gas());
            mass = Belief::blended(mass, flow.mass());
            // Of a rate of days and one of minutes a mixture would tell neither.
            if belief.weight() < 0.5 {
                leak = flow.rate();
            }
        }
        let mut estimate = Estimate {
            time_s,
            gas_mean_k: gas.0,
            gas_mean_sd_k: libm::sqrt(gas.1),
            mass_kg: mass.0,
            mass_sd_kg: libm::sqrt(mass.1),
            leak_kg_s: leak.0,
            leak_sd_kg_s: libm::sqrt(leak.1),
            pressure_pa: self.pressure_sensor().map_or(f64::NAN, |sensor| readings[sensor]),
            pressure_expected_pa: f64::NAN,
            p15_pa: f64::NAN,
            quality: self.quality(restarted),
        };
        if self.clock.reference_mass_kg.is_none() && time_s >= self.clock.reference_due_s {
            self.clock.reference_mass_kg = Some(estimate.mass_kg);
        }
        self.reference_x.copy_from_slice(&self.bank.members[0].x);
        self.add_pressures(&mut estimate, self.clock.reference_mass_kg)?;
        Ok(estimate)
    }

    /// Variance of a leak rate that a slow member excludes and the readings do not, (kg/s)²: `min(r^2, 2 P_free/t^2)`, with what a leak
    /// can be, `r`, and the mass of the freest member, variance `P_free`, at both ends of the time `t` since the beginning or the last exchange of gas.
    fn unknown_leak_variance(&self, time_s: f64, free_variance_kg2: f64) -> f64 {
        let largest = powi(self.cylinder.settings().any_leak_sd_kg_s, 2);
        let elapsed_s = (time_s - self.clock.reference_due_s + REFERENCE_AFTER_S).max(0.0);
        // Not a number at the beginning without a mass, and infinite at once: then it is the largest.
        largest.min(2.0 * free_variance_kg2 / (elapsed_s * elapsed_s))
    }

    /// Pressures of an estimate whose state is `reference_x`, with a reference mass, kg, if there is one.
    pub(super) fn add_pressures(
        &mut self,
        estimate: &mut Estimate,
        reference_kg: Option<f64>,
    ) -> Result<(), EstimatorError> {
        let mass = self.cylinder.state_map().mass;
        self.reference_x[mass] = reference_kg.unwrap_or(estimate.mass_kg);
        estimate.pressure_expected_pa = match self.pressure_sensor() {
            Some(sensor) => self.cylinder.output(sensor, &self.reference_x, None)?,
            None => self.cylinder.pressure_pa(&self.reference_x)?,
        };
        estimate.p15_pa = self.cylinder.model().settled_pressure_pa(estimate.mass_kg, QUOTED_K)?;
        Ok(())
    }

    fn pressure_sensor(&self) -> Option<usize> {
        (0..self.cylinder.outputs()).find(|&sensor| self.cylinder.reads_pressure(sensor))
    }

    fn quality(&self, restarted: bool) -> Quality {
        let innovations = self.innovations();
        let any = |outcome: Outcome| innovations.iter().any(|i| i.outcome == outcome);
        match () {
            () if restarted => Quality::Restarted,
            () if self.clock.exchange != Exchange::None || any(Outcome::Reacquired) => Quality::Open,
            () if !any(Outcome::Accepted) => Quality::Predicted,
            () if any(Outcome::Missing) || any(Outcome::Rejected) => Quality::Degraded,
            () => Quality::Good,
        }
    }
}
