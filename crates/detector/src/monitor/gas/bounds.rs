//! Loss and gain of gas that no temperature explains, without an observer, and finer ones by the observer.
//!
//! Gas is no colder than the coldest wall that it has lately lain against, and no warmer than the warmest. So a pressure `p` at
//! thermometers that lately read from `T_low` to `T_high` bounds the mass,
//!
//! `m(p - e, (1 + d) T_high) <= m <= m(p + e, (1 - d) T_low)`, `m(p, T) = rho(p, T) V(T, p)`,
//!
//! `d` for what no thermometer sees: another part of the wall, in the sun or in the wind; `e` for what the transmitter does with
//! its own temperature and its noise. A tight cylinder has one mass that lies within all of these intervals. Where the highest of the lower bounds
//! is above the present upper one, gas has gone out; where the lowest upper bound is below the present lower one, it has come in.
//! That is certain in the sense of the bounds: nothing is tuned, and no model of wall or gas can mislead it. It is coarse: a tenth of the
//! gas after a tunnel, a twentieth at rest.
//!
//! What is smaller the observer's flowing member tells ([`Flow`]) in the same way, with the bounds `m -+ (2.2 sqrt(s^2 + w^2) + 0.003 m_full)` in place of those of the
//! walls; `s` is the part of its standard deviation that comes and goes, `w` how far its mass usually is from that of the day before ([`super::wander`]). What has been learnt since a bound was set moves the mass
//! as well: of two estimates of which the later one rests on all that the earlier one does, errors that stay differ by `P - P'` in their variance, and 2.2 standard deviations of that are added to the bound. A log that begins in
//! the middle of a tunnel shows no refill while the observer finds out how cold the gas was. These bounds fade within hours, since what the observer has
//! learnt of films and sensors changes from day to day.
//!
//! Readings far off must not count: bounds are believed that four rows in a row agree on, and more than twice as many as have lately been beyond the bounds and come back: two
//! spikes may meet. Those of the observer, which has judged the readings, count at once; where thermometers moved so far since the row before that a tunnel between the two rows may have done 0.003 of the mass, when two rows agree.
//! A gain is not urgent: the observer's bounds tell it when the surroundings can no more make as much as 0.003 of the mass.
//!
//! Extremes fade to the present readings with a time constant that is long against those of wall and gas. Constant errors of the transmitter are in
//! all pressures alike.
//!
//! Assumes that no part of the wall is farther than `d` of its temperature from all thermometers for longer than the gas takes to follow it.
use cylwatch_estimator::thermal::real::powi;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::wander::Wander;
use crate::DetectorError;
use crate::estimator::observer::Flow;
use crate::monitor::examination::FORGOTTEN_S;
use crate::monitor::extremes::Extremes;
use crate::monitor::restored;

/// Time constant with which extremes fade, s.
const FADING_S: f64 = 2700.0;
/// What the gas may be beyond thermometers on the wall, and beyond one in the gas, as a part of their temperature (12 and 5 K at 15 °C); those on the wall may have been so far from what they
/// first read before.
const UNSEEN_WALL: f64 = 0.042;
const UNSEEN_GAS: f64 = 0.017;
/// Standard deviations of the transmitter's coefficient and noise that count.
const DEVIATIONS: f64 = 3.0;
/// Fewest rows in a row that have to agree on a bound: one more than a spike is long.
pub(in crate::monitor) const ROWS: usize = 4;
/// The same for what the observer says: standard deviations, part of the fill beside them, and time constant with which its bounds
/// fade, s: what it has wrongly learnt changes from day to day.
pub(in crate::monitor) const FLOW_DEVIATIONS: f64 = 2.2;
const FLOW_PART: f64 = 0.003;
const FLOW_FADING_S: f64 = 6.0 * 3600.0;

/// What a thermometer tells of the gas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::monitor) enum Contact {
    /// It sits on the wall or the valve.
    Wall,
    /// It sits in the gas.
    Gas,
}

/// What a row says.
#[derive(Clone, Copy, Debug)]
pub(in crate::monitor) struct Seen {
    /// Time, s.
    pub time_s: f64,
    /// Coldest and warmest thermometer, K.
    pub extremes_k: (f64, f64),
    /// Where these thermometers sit.
    pub contact: Contact,
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// Standard deviations of the transmitter's temperature coefficient, Pa/K, and of its noise, Pa.
    pub coefficient_pa_k: f64,
    pub noise_pa: f64,
}

/// Which way gas has certainly gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::monitor) enum Certain {
    Out,
    In,
}

/// A bound of the mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Bound {
    kg: f64,
    /// What did not come and go of what was uncertain of the mass when it was set, standard deviation, kg.
    sd_kg: f64,
}

impl Bound {
    /// How far the mass may be beyond it by what has been learnt since, kg.
    fn learnt_kg(&self, now_sd_kg: f64) -> f64 {
        FLOW_DEVIATIONS * libm::sqrt((powi(self.sd_kg, 2) - powi(now_sd_kg, 2)).max(0.0))
    }

    /// Of which a part has been kept since, where it would be so much now.
    fn faded(self, kept: f64, now: Self) -> Self {
        let between = |bound: f64, now: f64| now + kept * (bound - now);
        Self { kg: between(self.kg, now.kg), sd_kg: between(self.sd_kg, now.sd_kg) }
    }
}

/// Bounds of the mass in the last rows, and the tightest ones so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Ratchet {
    /// Lower and upper bound, the latest ones first, kg.
    recent_kg: SmallVec<[(f64, f64); 2 * ROWS]>,
    /// What does not come and go of what is uncertain of the mass, standard deviation, kg.
    sd_kg: f64,
    /// Highest lower and lowest upper bound.
    floor: Option<Bound>,
    ceiling: Option<Bound>,
}

impl Ratchet {
    /// Take in the bounds of a row, of a mass with this standard deviation that stays, kg; those that so many rows in a row agree on may become the tightest ones, of which a part has been
    /// kept since the last row.
    fn push(&mut self, bounds_kg: (f64, f64), sd_kg: f64, agreeing: usize, kept: f64) -> Option<Certain> {
        self.recent_kg.truncate(agreeing - 1);
        self.recent_kg.insert(0, bounds_kg);
        self.sd_kg = sd_kg;
        let certain = self.certain(agreeing);
        if let (None, Some((least_kg, most_kg))) = (certain, self.agreed(agreeing)) {
            let [least, most] = [least_kg, most_kg].map(|kg| Bound { kg, sd_kg });
            let floor = self.floor.map(|floor| floor.faded(kept, least));
            self.floor = floor.filter(|floor| floor.kg > least_kg).or(Some(least));
            let ceiling = self.ceiling.map(|ceiling| ceiling.faded(kept, most));
            self.ceiling = ceiling.filter(|ceiling| ceiling.kg < most_kg).or(Some(most));
        }
        certain
    }

    /// What the last rows agree on.
    fn certain(&self, rows: usize) -> Option<Certain> {
        let (least_kg, most_kg) = self.agreed(rows)?;
        let (floor_kg, ceiling_kg) = self.tightest_kg()?;
        if most_kg < floor_kg {
            Some(Certain::Out)
        } else if least_kg > ceiling_kg {
            Some(Certain::In)
        } else {
            None
        }
    }

    /// The tightest bounds by what is known now, kg.
    fn tightest_kg(&self) -> Option<(f64, f64)> {
        let (floor, ceiling) = (self.floor?, self.ceiling?);
        Some((floor.kg - floor.learnt_kg(self.sd_kg), ceiling.kg + ceiling.learnt_kg(self.sd_kg)))
    }

    /// Bounds that so many last rows agree on, kg.
    fn agreed(&self, rows: usize) -> Option<(f64, f64)> {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let wider = |(least, most): (f64, f64), &(low, high): &(f64, f64)| (low.min(least), high.max(most));
        (self.recent_kg.len() == rows).then(|| self.recent_kg.iter().fold(none, wider))
    }

    /// Part of the gas that is certainly gone or has certainly come, against the bound that it is beyond; 0 if none.
    fn beyond(&self) -> f64 {
        let (Some(now), Some((floor_kg, ceiling_kg))) = (self.recent_kg.first(), self.tightest_kg()) else {
            return 0.0;
        };
        ((floor_kg - now.1) / floor_kg).max((now.0 - ceiling_kg) / ceiling_kg).max(0.0)
    }

    fn gone(&mut self, way: Certain) {
        match way {
            Certain::Out => self.floor = None,
            Certain::In => self.ceiling = None,
        }
    }
}

/// Rows in a row beyond the bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Excursions {
    /// Up to now.
    now: usize,
    /// The most that have come back, and when they did, s.
    most: usize,
    most_s: f64,
}

impl Excursions {
    /// Take in whether a row is beyond, and whether it is certain: then it is no spike.
    fn push(&mut self, time_s: f64, beyond: bool, certain: bool) {
        if beyond || certain {
            self.now = if certain { 0 } else { self.now + 1 };
            return;
        }
        let came_back = core::mem::take(&mut self.now);
        if came_back > 0 && came_back >= self.lately(time_s) {
            (self.most, self.most_s) = (came_back, time_s);
        }
    }

    /// The most that have lately come back.
    fn lately(&self, time_s: f64) -> usize {
        if time_s - self.most_s < FORGOTTEN_S { self.most } else { 0 }
    }
}

/// Bounds of the mass since gas was last exchanged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct GasBounds {
    last_s: Option<f64>,
    /// Of the thermometers lately, K.
    extremes_k: Extremes,
    walls: Ratchet,
    excursions: Excursions,
    /// The same by the observer's flowing member, and when it last said something, s.
    flow: Ratchet,
    flow_s: Option<f64>,
    wander: Wander,
}

impl GasBounds {
    /// Checks one that was saved.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        let Excursions { now, most, .. } = self.excursions;
        restored::count("bounds.excursions", now.max(most) as u64)
    }

    /// Take in a row, with the mass of a pressure, Pa, and a temperature, K, kg; not a number outside the gas's domain.
    pub(crate) fn push(&mut self, seen: &Seen, mass_kg: impl Fn(f64, f64) -> f64) -> Option<Certain> {
        self.follow(seen);
        let unseen = match seen.contact {
            Contact::Wall => UNSEEN_WALL,
            Contact::Gas => UNSEEN_GAS,
        };
        let drift_pa = seen.coefficient_pa_k * self.extremes_k.spread();
        let error_pa = DEVIATIONS * libm::hypot(drift_pa, seen.noise_pa);
        let least_kg = mass_kg(seen.pressure_pa - error_pa, (1.0 + unseen) * self.extremes_k.high);
        let most_kg = mass_kg(seen.pressure_pa + error_pa, (1.0 - unseen) * self.extremes_k.low);
        if !(least_kg.is_finite() && most_kg.is_finite()) {
            return None;
        }
        let rows = ROWS.max(2 * self.excursions.lately(seen.time_s) + 1);
        let certain = self.walls.push((least_kg, most_kg), 0.0, rows, 1.0);
        self.excursions.push(seen.time_s, self.walls.beyond() > 0.0, certain.is_some());
        certain
    }

    /// Take in what the observer says of gas that may flow, in a cylinder that is filled with so much, kg, and what the surroundings may have done to it since the row
    /// before, as a part of it.
    pub(crate) fn push_flow(
        &mut self,
        time_s: f64,
        flow: &Flow,
        full_kg: f64,
        shaken: f64,
    ) -> Option<Certain> {
        let since_s = self.flow_s.replace(time_s).map_or(0.0, |last_s| time_s - last_s);
        let kept = libm::exp(-since_s / FLOW_FADING_S);
        let by_kg = self.comes_and_goes_kg(flow, full_kg) + FLOW_PART * full_kg;
        let lasting_sd_kg = libm::sqrt((powi(flow.mass_sd_kg, 2) - powi(flow.passing_sd_kg, 2)).max(0.0));
        self.wander.push(since_s, flow.mass_kg / full_kg);
        // A tunnel of minutes between two rows shows in neither.
        let rows = if shaken > FLOW_PART { 2 } else { 1 };
        let certain = self.flow.push((flow.mass_kg - by_kg, flow.mass_kg + by_kg), lasting_sd_kg, rows, kept);
        let calm = flow.considered_sd_kg <= FLOW_PART * full_kg;
        certain.filter(|&way| way == Certain::Out || calm)
    }

    /// What of a mass that the observer says comes and goes without gas, kg.
    pub(crate) fn comes_and_goes_kg(&self, flow: &Flow, full_kg: f64) -> f64 {
        FLOW_DEVIATIONS * libm::hypot(flow.passing_sd_kg, self.wander.sd() * full_kg)
    }

    /// Part of the gas that is certainly gone or has certainly come by the thermometers, against the bound that it is beyond; 0 if none.
    pub(crate) fn beyond(&self) -> f64 {
        self.walls.beyond()
    }

    /// Whether a mass, kg, can be that of the present row.
    pub(crate) fn allow(&self, mass_kg: f64) -> bool {
        self.walls
            .recent_kg
            .first()
            .is_none_or(|&(least_kg, most_kg)| (least_kg..=most_kg).contains(&mass_kg))
    }

    /// Gas has gone that way: what bounded the mass from that side does so no more. After a refill it is still no less than before.
    pub(crate) fn gone(&mut self, way: Certain) {
        self.walls.gone(way);
        self.forget_flow();
    }

    /// The observer has begun anew: what it said before counts no more.
    pub(crate) fn forget_flow(&mut self) {
        self.flow = Ratchet::default();
        self.wander.begin_anew();
    }

    /// Extremes follow the thermometers at once outwards, and slowly inwards.
    fn follow(&mut self, seen: &Seen) {
        let (coldest_k, warmest_k) = seen.extremes_k;
        let Some(last_s) = self.last_s.replace(seen.time_s) else {
            let before = if seen.contact == Contact::Wall { UNSEEN_WALL } else { 0.0 };
            self.extremes_k = Extremes { low: (1.0 - before) * coldest_k, high: (1.0 + before) * warmest_k };
            return;
        };
        self.extremes_k.follow(seen.extremes_k, libm::exp(-(seen.time_s - last_s) / FADING_S));
    }
}

#[cfg(test)]
mod tests;
