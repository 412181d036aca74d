//! The worlds that a vessel is commissioned on, and the monitor in them.
use cylwatch_detector::evidence::Scale;
use cylwatch_detector::monitor::MonitorSettings;
use cylwatch_thermal::units::DAY_S;
use cylwatch_thermal::units::HOUR_S;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::cross_validation::FOLDS;
use super::fit::STRETCHES;
use super::monitored::{MonitoredCylinder, monitor};
use super::record::Record;
use crate::EvaluationError;
use crate::world::{
    Climate, Family, GasKind, NominalVessel, Request, RowPattern, SensorClass, Simulated, SimulationKey,
    VesselKind,
};

/// Tight cylinders around a vessel, each with another seed, and each read by all classes of sensors. The other kinds are gone through in turn; one that is named twice
/// has twice as many cylinders.
#[derive(Clone, Debug, PartialEq)]
pub struct Campaign {
    /// Climates.
    pub climates: Vec<Climate>,
    /// How the gas and the wall of the truth are resolved.
    pub gases: Vec<GasKind>,
    /// Sensors, a set of each class on every cylinder.
    pub sensors: Vec<SensorClass>,
    /// How often rows come.
    pub rows: Vec<RowPattern>,
    /// Number of cylinders.
    pub cylinders: usize,
    /// Length of each log, s.
    pub length_s: f64,
    /// Seed of all that is drawn.
    pub seed: u64,
}

impl Default for Campaign {
    /// Three of the climates that the usual tails were fitted to, sensors of class B and transmitters that are far off, two months each. Rows come every
    /// five minutes: every two they cost a third more, and the thresholds of the 20 L cylinder are the same within their intervals.
    fn default() -> Self {
        Self {
            climates: vec![Climate::Railway, Climate::Parked, Climate::Workshop],
            gases: vec![GasKind::Mixed, GasKind::Stratified, GasKind::FullMesh],
            sensors: vec![SensorClass::ClassB, SensorClass::Transmitter],
            rows: vec![RowPattern::FiveMinutes],
            cylinders: 117,
            length_s: 62.0 * DAY_S,
            seed: 1,
        }
    }
}

impl Campaign {
    /// Cylinders that a fit and its cross-validation need: as many stretches of the slowest scale in each half as a tail is fitted to; `None`:
    /// no number is enough, because a log has no whole stretch. `stretch` as in `Record::stretch_h`.
    pub fn needed(&self, stretch: f64) -> Option<usize> {
        // The last hour may have lost its rows.
        let each = self.sensors.len() * ((self.length_s - HOUR_S) / longest_s(stretch)) as usize;
        // One more in each half, for halves that are not quite alike.
        (each > 0).then(|| FOLDS * (STRETCHES.div_ceil(each) + 1))
    }

    /// Shortest log with a whole stretch of every scale, s.
    pub fn shortest_s(stretch: f64) -> f64 {
        HOUR_S + longest_s(stretch)
    }

    /// What is to be monitored, cylinder by cylinder. The kind of vessel is only a name. Seeds are far from those of plans that judge.
    pub fn requests(&self) -> Vec<Request> {
        let around: Vec<_> = self.around().collect();
        let of_cylinder = |cylinder: usize| {
            let (climate, gas, rows) = around[cylinder % around.len()];
            let seed = (self.seed.wrapping_add(1) << 32) + cylinder as u64;
            self.sensors.iter().zip(0..).map(move |(&sensors, set)| {
                let family = Family { vessel: VesselKind::Nitrogen20, climate, gas, sensors, rows };
                Request { set, ..Request::tight(family, seed, self.length_s) }
            })
        };
        if around.is_empty() { Vec::new() } else { (0..self.cylinders).flat_map(of_cylinder).collect() }
    }

    /// Every combination of the kinds but the sensors, the climates fastest.
    fn around(&self) -> impl Iterator<Item = (Climate, GasKind, RowPattern)> {
        self.rows.iter().flat_map(move |&rows| {
            self.gases
                .iter()
                .flat_map(move |&gas| self.climates.iter().map(move |&climate| (climate, gas, rows)))
        })
    }
}

/// Longest stretch of all scales, s.
fn longest_s(stretch: f64) -> f64 {
    let hours = Scale::ALL.map(|scale| Record::stretch_h(scale, stretch));
    hours.into_iter().fold(0.0, |longest, hours| longest.max(HOUR_S * hours as f64))
}

/// Simulate cylinders around a vessel and watch each, on all threads; the same on any number of them. Requests of one simulation that follow each other share it.
/// `progress` is told the part that is done.
///
/// # Errors
/// A simulation that fails, or as [`monitor`](super::monitor).
pub fn monitor_all(
    nominal: &NominalVessel,
    requests: &[Request],
    settings: &MonitorSettings,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Vec<MonitoredCylinder>, EvaluationError> {
    let done = AtomicUsize::new(0);
    let one = |requests_of_it: &[Request]| {
        let simulated = Simulated::around(nominal.clone(), &requests_of_it[0])?;
        let monitored = requests_of_it.iter().map(|request| monitor(&simulated.world(request)?, settings));
        let monitored = monitored.collect::<Result<Vec<_>, EvaluationError>>()?;
        let done = done.fetch_add(monitored.len(), Ordering::Relaxed) + monitored.len();
        progress(done as f64 / requests.len() as f64);
        Ok(monitored)
    };
    let shared = |a: &Request, b: &Request| SimulationKey::of(a) == SimulationKey::of(b);
    let simulations: Vec<&[Request]> = requests.chunk_by(shared).collect();
    let monitored = simulations.into_par_iter().with_max_len(1).map(one);
    Ok(monitored.collect::<Result<Vec<_>, EvaluationError>>()?.concat())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn each_cylinder_has_a_seed_of_its_own_and_all_sensors_and_the_other_kinds_come_in_turn() {
        let campaign = Campaign { cylinders: 18, ..Campaign::default() };
        let requests = campaign.requests();
        assert_eq!(requests.iter().map(|request| request.seed).collect::<BTreeSet<_>>().len(), 18);
        for pair in requests.chunks(2) {
            assert_eq!(SimulationKey::of(&pair[0]), SimulationKey::of(&pair[1]));
            assert!(pair[0].set != pair[1].set && pair[0].family.sensors != pair[1].family.sensors);
        }
        let next = Campaign { seed: 2, ..campaign }.requests();
        assert!(requests.iter().all(|request| next.iter().all(|other| other.seed != request.seed)));
        assert!(requests.iter().all(|request| request.seed > 1 << 32));
        let of = |kind: fn(&Family) -> bool| requests.iter().filter(|r| kind(&r.family)).count();
        assert_eq!(of(|family| family.gas == GasKind::FullMesh), 12);
        assert_eq!(of(|family| family.climate == Climate::Parked), 12);
        assert_eq!(of(|family| family.sensors == SensorClass::ClassB), 18);
    }

    #[test]
    fn two_hundred_stretches_of_the_slowest_scale_are_needed_in_each_half() {
        let of_days = |days: f64| Campaign { length_s: days * DAY_S, ..Campaign::default() }.needed(1.0);
        // A month each: 62 days have two stretches, 30 none that is over.
        assert_eq!((of_days(62.0), of_days(31.0), of_days(30.0)), (Some(102), Some(202), None));
        assert!(Campaign::shortest_s(1.0) > 30.0 * DAY_S && Campaign::shortest_s(1.0) <= 31.0 * DAY_S);
    }

    #[test]
    fn what_is_watched_does_not_depend_on_the_number_of_threads() {
        let campaign = Campaign {
            climates: vec![Climate::Workshop],
            gases: vec![GasKind::Mixed],
            cylinders: 3,
            length_s: 0.5 * DAY_S,
            ..Campaign::default()
        };
        let nominal = VesselKind::AirTank8.nominal().unwrap();
        let settings = MonitorSettings::default();
        let of = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| monitor_all(&nominal, &campaign.requests(), &settings, &|_| ())).unwrap()
        };
        assert_eq!(of(1), of(3));
    }
}
