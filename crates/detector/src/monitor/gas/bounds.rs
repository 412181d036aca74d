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
//! walls; `s` is the part of its standard deviation that comes and goes, `w` how far its mass usually is from that of the day before ([`super::wander`]). These bounds fade within hours, since what the observer has
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
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::jump::FORGOTTEN_S;
use super::wander::Wander;
use crate::estimator::observer::Flow;

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

/// Bounds of the mass in the last rows, and the tightest ones so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Ratchet {
    /// Lower and upper bound, the latest ones first, kg.
    recent_kg: VecDeque<(f64, f64)>,
    /// Highest lower and lowest upper bound, kg.
    floor_kg: Option<f64>,
    ceiling_kg: Option<f64>,
}

impl Ratchet {
    /// Take in the bounds of a row; those that so many rows in a row agree on may become the tightest ones, of which a part has been
    /// kept since the last row.
    fn push(&mut self, bounds_kg: (f64, f64), agreeing: usize, kept: f64) -> Option<Certain> {
        self.recent_kg.push_front(bounds_kg);
        self.recent_kg.truncate(agreeing);
        let certain = self.certain(agreeing);
        if let (None, Some((least_kg, most_kg))) = (certain, self.agreed(agreeing)) {
            let faded = |bound_kg: f64, now_kg: f64| now_kg + kept * (bound_kg - now_kg);
            self.floor_kg =
                Some(self.floor_kg.map_or(least_kg, |floor| least_kg.max(faded(floor, least_kg))));
            self.ceiling_kg = Some(self.ceiling_kg.map_or(most_kg, |top| most_kg.min(faded(top, most_kg))));
        }
        certain
    }

    /// What the last rows agree on.
    fn certain(&self, rows: usize) -> Option<Certain> {
        let (least_kg, most_kg) = self.agreed(rows)?;
        if most_kg < self.floor_kg? {
            Some(Certain::Out)
        } else if least_kg > self.ceiling_kg? {
            Some(Certain::In)
        } else {
            None
        }
    }

    /// Bounds that so many last rows agree on, kg.
    fn agreed(&self, rows: usize) -> Option<(f64, f64)> {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let wider = |(least, most): (f64, f64), &(low, high): &(f64, f64)| (low.min(least), high.max(most));
        (self.recent_kg.len() == rows).then(|| self.recent_kg.iter().fold(none, wider))
    }

    /// Part of the gas that is certainly gone or has certainly come, against the bound that it is beyond; 0 if none.
    fn beyond(&self) -> f64 {
        let (Some(now), Some(floor_kg), Some(ceiling_kg)) =
            (self.recent_kg.front(), self.floor_kg, self.ceiling_kg)
        else {
            return 0.0;
        };
        ((floor_kg - now.1) / floor_kg).max((now.0 - ceiling_kg) / ceiling_kg).max(0.0)
    }

    fn gone(&mut self, way: Certain) {
        match way {
            Certain::Out => self.floor_kg = None,
            Certain::In => self.ceiling_kg = None,
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
        let came_back = std::mem::take(&mut self.now);
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
    /// Extremes of the thermometers lately, K.
    low_k: f64,
    high_k: f64,
    walls: Ratchet,
    excursions: Excursions,
    /// The same by the observer's flowing member, and when it last said something, s.
    flow: Ratchet,
    flow_s: Option<f64>,
    wander: Wander,
}

impl GasBounds {
    /// Take in a row, with the mass of a pressure, Pa, and a temperature, K, kg; not a number outside the gas's domain.
    pub fn push(&mut self, seen: &Seen, mass_kg: impl Fn(f64, f64) -> f64) -> Option<Certain> {
        self.follow(seen);
        let unseen = match seen.contact {
            Contact::Wall => UNSEEN_WALL,
            Contact::Gas => UNSEEN_GAS,
        };
        let drift_pa = seen.coefficient_pa_k * (self.high_k - self.low_k);
        let error_pa = DEVIATIONS * drift_pa.hypot(seen.noise_pa);
        let least_kg = mass_kg(seen.pressure_pa - error_pa, (1.0 + unseen) * self.high_k);
        let most_kg = mass_kg(seen.pressure_pa + error_pa, (1.0 - unseen) * self.low_k);
        if !(least_kg.is_finite() && most_kg.is_finite()) {
            return None;
        }
        let rows = ROWS.max(2 * self.excursions.lately(seen.time_s) + 1);
        let certain = self.walls.push((least_kg, most_kg), rows, 1.0);
        self.excursions.push(seen.time_s, self.walls.beyond() > 0.0, certain.is_some());
        certain
    }

    /// Take in what the observer says of gas that may flow, in a cylinder that is filled with so much, kg, and what the surroundings may have done to it since the row
    /// before, as a part of it.
    pub fn push_flow(&mut self, time_s: f64, flow: &Flow, full_kg: f64, shaken: f64) -> Option<Certain> {
        let since_s = self.flow_s.replace(time_s).map_or(0.0, |last_s| time_s - last_s);
        let kept = (-since_s / FLOW_FADING_S).exp();
        let by_kg = self.comes_and_goes_kg(flow, full_kg) + FLOW_PART * full_kg;
        self.wander.push(since_s, flow.mass_kg / full_kg);
        // A tunnel of minutes between two rows shows in neither.
        let rows = if shaken > FLOW_PART { 2 } else { 1 };
        let certain = self.flow.push((flow.mass_kg - by_kg, flow.mass_kg + by_kg), rows, kept);
        let calm = flow.considered_sd_kg <= FLOW_PART * full_kg;
        certain.filter(|&way| way == Certain::Out || calm)
    }

    /// What of a mass that the observer says comes and goes without gas, kg.
    pub fn comes_and_goes_kg(&self, flow: &Flow, full_kg: f64) -> f64 {
        FLOW_DEVIATIONS * flow.passing_sd_kg.hypot(self.wander.sd() * full_kg)
    }

    /// Part of the gas that is certainly gone or has certainly come by the thermometers, against the bound that it is beyond; 0 if none.
    pub fn beyond(&self) -> f64 {
        self.walls.beyond()
    }

    /// Whether a mass, kg, can be that of the present row.
    pub fn allow(&self, mass_kg: f64) -> bool {
        self.walls
            .recent_kg
            .front()
            .is_none_or(|&(least_kg, most_kg)| (least_kg..=most_kg).contains(&mass_kg))
    }

    /// Gas has gone that way: what bounded the mass from that side does so no more. After a refill it is still no less than before.
    pub fn gone(&mut self, way: Certain) {
        self.walls.gone(way);
        self.forget_flow();
    }

    /// The observer has begun anew: what it said before counts no more.
    pub fn forget_flow(&mut self) {
        self.flow = Ratchet::default();
        self.wander.begin_anew();
    }

    /// Extremes follow the thermometers at once outwards, and slowly inwards.
    fn follow(&mut self, seen: &Seen) {
        let (coldest_k, warmest_k) = seen.extremes_k;
        let Some(last_s) = self.last_s.replace(seen.time_s) else {
            let before = if seen.contact == Contact::Wall { UNSEEN_WALL } else { 0.0 };
            (self.low_k, self.high_k) = ((1.0 - before) * coldest_k, (1.0 + before) * warmest_k);
            return;
        };
        let kept = (-(seen.time_s - last_s) / FADING_S).exp();
        self.low_k = coldest_k.min(coldest_k + kept * (self.low_k - coldest_k));
        self.high_k = warmest_k.max(warmest_k + kept * (self.high_k - warmest_k));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An ideal gas: 1 kg at 100 bar and 300 K.
    fn mass_kg(pressure_pa: f64, temperature_k: f64) -> f64 {
        pressure_pa / 100e5 * 300.0 / temperature_k
    }

    fn seen(minute: f64, pressure_pa: f64, extremes_k: (f64, f64)) -> Seen {
        let time_s = 60.0 * minute;
        let (contact, coefficient_pa_k, noise_pa) = (Contact::Wall, 0.0, 1e3);
        Seen { time_s, extremes_k, contact, pressure_pa, coefficient_pa_k, noise_pa }
    }

    /// The first certainty of pressures and extremes of every minute of two days.
    fn certain(course: impl Fn(f64) -> (f64, (f64, f64))) -> Option<(f64, Certain)> {
        let mut bounds = GasBounds::default();
        (0..2880).map(f64::from).find_map(|minute| {
            let (pressure_pa, extremes_k) = course(minute);
            Some((minute, bounds.push(&seen(minute, pressure_pa, extremes_k), mass_kg)?))
        })
    }

    #[test]
    fn a_tight_cylinder_whose_gas_is_between_its_walls_is_never_certain_to_have_lost_gas() {
        // Gas that lags by half an hour behind a wall that swings by 40 K within an hour, a part of it 10 K warmer by day.
        let wall_k = |minute: f64| 290.0 + 20.0 * (minute / 60.0).sin();
        let gas_k = |minute: f64| 290.0 + 20.0 * 0.9 * (minute / 60.0 - 0.46).sin();
        let sun_k = |minute: f64| (10.0 * (minute / 230.0).sin()).max(0.0);
        assert_eq!(
            certain(|minute| {
                let warmed_k = wall_k(minute) + sun_k(minute);
                (100e5 * gas_k(minute) / 300.0, (warmed_k, warmed_k))
            }),
            None
        );
    }

    #[test]
    fn a_fifth_of_the_gas_is_certainly_gone_or_come_within_minutes() {
        for (way, certainly) in [(-1.0, Certain::Out), (1.0, Certain::In)] {
            let pressure = |minute: f64| 100e5 * (1.0 + 0.02 * way * (minute - 600.0).clamp(0.0, 20.0));
            let (minute, which) = certain(|minute| (pressure(minute), (300.0, 300.0))).expect("40 %");
            assert_eq!(which, certainly);
            assert!((601.0..612.0).contains(&minute), "{minute} min");
        }
    }

    #[test]
    fn what_was_lost_is_lost_once() {
        let mut bounds = GasBounds::default();
        let pressure = |minute: f64| if minute < 600.0 { 100e5 } else { 70e5 };
        let minutes = (0..2880).map(f64::from);
        let lost = |bounds: &mut GasBounds, minute: f64| {
            let certain = bounds.push(&seen(minute, pressure(minute), (300.0, 300.0)), mass_kg);
            certain.into_iter().for_each(|way| bounds.gone(way));
            certain.is_some()
        };
        let times = minutes.filter(|&minute| lost(&mut bounds, minute)).count();
        assert_eq!(times, 1);
        assert!(bounds.allow(0.7) && !bounds.allow(1.0));
    }

    #[test]
    fn what_is_lost_again_after_a_refill_is_lost() {
        let mut bounds = GasBounds::default();
        let pressure = |minute: f64| match minute {
            m if m < 60.0 => 100e5,
            m if m < 120.0 => 300e5,
            _ => 200e5,
        };
        let mut ways = Vec::new();
        for minute in (0..240).map(f64::from) {
            let certain = bounds.push(&seen(minute, pressure(minute), (300.0, 300.0)), mass_kg);
            certain.into_iter().for_each(|way| bounds.gone(way));
            ways.extend(certain);
        }
        assert_eq!(ways, [Certain::In, Certain::Out]);
    }

    #[test]
    fn three_readings_far_off_are_no_gas_and_four_are() {
        let spikes =
            |rows: f64| move |minute: f64| if minute % 60.0 < rows && minute > 100.0 { 50e5 } else { 100e5 };
        assert_eq!(certain(|minute| (spikes(3.0)(minute), (300.0, 300.0))), None);
        let told = certain(|minute| (spikes(4.0)(minute), (300.0, 300.0)));
        assert!(matches!(told, Some((_, Certain::Out))), "{told:?}");
    }

    /// Spikes of three rows, of which one day two meet.
    #[test]
    fn spikes_that_meet_are_no_gas_and_what_stays_is() {
        let spikes = |minute: f64| minute % 60.0 < 3.0 || (900.0..906.0).contains(&minute);
        let pressure = |minute: f64| if spikes(minute) && minute > 100.0 { 50e5 } else { 100e5 };
        assert_eq!(certain(|minute| (pressure(minute), (300.0, 300.0))), None);
        let lost = |minute: f64| if minute < 1510.0 { pressure(minute) } else { 50e5 };
        let (minute, way) = certain(|minute| (lost(minute), (300.0, 300.0))).unwrap();
        assert_eq!((minute, way), (1510.0 + 12.0, Certain::Out), "thirteen rows");
        // What was long ago says nothing of today.
        let late = |minute: f64| if minute < 120.0 { pressure(minute) } else { 100e5 };
        let mut bounds = GasBounds::default();
        let days = 1440.0 * 6.0;
        let told = (0..10_000).map(f64::from).find(|&minute| {
            let pressure_pa = if minute < days { late(minute) } else { 50e5 };
            bounds.push(&seen(minute, pressure_pa, (300.0, 300.0)), mass_kg).is_some()
        });
        assert_eq!(told, Some(days + 3.0));
    }

    /// What was certain and not believed, since it was being examined, makes no later loss wait.
    #[test]
    fn a_certainty_that_came_back_is_no_spike() {
        let mut bounds = GasBounds::default();
        let pressure =
            |minute: f64| if (200.0..240.0).contains(&minute) || minute >= 300.0 { 50e5 } else { 100e5 };
        let mut told = (0..400).map(f64::from).filter(|&minute| {
            bounds.push(&seen(minute, pressure(minute), (300.0, 300.0)), mass_kg).is_some()
        });
        assert_eq!(told.find(|&minute| minute > 250.0), Some(303.0));
    }

    #[test]
    fn one_reading_far_off_is_no_gas() {
        let spikes = |minute: f64| 100e5 * if minute % 7.0 == 3.0 { 0.5 } else { 1.0 };
        assert_eq!(certain(|minute| (spikes(minute), (300.0, 300.0))), None);
        let upwards = |minute: f64| 100e5 * if minute % 7.0 == 3.0 { 1.5 } else { 1.0 };
        assert_eq!(certain(|minute| (upwards(minute), (300.0, 300.0))), None);
    }

    /// A mass of so many parts that the observer says, known to a part.
    fn flow(mass_kg: f64, sd_kg: f64) -> Flow {
        Flow {
            mass_kg,
            mass_sd_kg: 0.01,
            passing_sd_kg: sd_kg,
            considered_sd_kg: 0.0,
            gas_mean_k: 300.0,
            gas_mean_sd_k: 1.0,
            rate_kg_s: 0.0,
            rate_sd_kg_s: 1e-3,
        }
    }

    #[test]
    fn what_the_observer_says_counts_beyond_what_comes_and_goes() {
        let mut bounds = GasBounds::default();
        let minutes = |from: u32| (from..from + 60).map(|minute| 60.0 * f64::from(minute));
        // Errors of its size, and constant ones however large, are none.
        let errors = minutes(0)
            .find_map(|t| bounds.push_flow(t, &flow(1.0 + 2e-3 * (t / 500.0).sin(), 2e-3), 1.0, 0.0));
        assert_eq!(errors, None);
        // 2.2 sd, with the usual wander 0.23 %, and 0.3 % on either side are 1.6 %.
        assert_eq!(bounds.push_flow(3600.0, &flow(0.988, 2e-3), 1.0, 0.0), None);
        let lost = minutes(61).find_map(|t| bounds.push_flow(t, &flow(0.98, 2e-3), 1.0, 0.0));
        assert_eq!(lost, Some(Certain::Out));
        bounds.gone(Certain::Out);
        assert_eq!(minutes(121).find_map(|t| bounds.push_flow(t, &flow(0.98, 2e-3), 1.0, 0.0)), None, "once");
        let mut shaken = bounds.clone();
        let come = flow(1.0, 2e-3);
        assert_eq!(
            shaken.push_flow(181.0 * 60.0, &come, 1.0, 0.01),
            None,
            "a row in which all moves is none"
        );
        assert_eq!(shaken.push_flow(182.0 * 60.0, &come, 1.0, 0.01), Some(Certain::In));
        assert_eq!(
            minutes(181).find_map(|t| bounds.push_flow(t, &flow(1.0, 2e-3), 1.0, 0.0)),
            Some(Certain::In)
        );
    }

    #[test]
    fn a_gain_waits_until_the_surroundings_make_no_more_of_it_and_a_loss_does_not() {
        let told = |mass_kg: f64, considered_sd_kg: f64| {
            let mut bounds = GasBounds::default();
            let of = |mass_kg: f64, considered_sd_kg: f64| Flow { considered_sd_kg, ..flow(mass_kg, 2e-3) };
            (0..60).for_each(|minute| {
                bounds.push_flow(60.0 * f64::from(minute), &of(1.0, 0.0), 1.0, 0.0);
            });
            bounds.push_flow(3600.0, &of(mass_kg, considered_sd_kg), 1.0, 0.0)
        };
        assert_eq!(told(1.05, 0.004), None);
        assert_eq!(told(1.05, 0.002), Some(Certain::In));
        assert_eq!(told(0.95, 0.004), Some(Certain::Out));
    }

    #[test]
    fn what_a_transmitter_does_to_an_empty_cylinder_is_no_gas() {
        let mut bounds = GasBounds::default();
        let hours = (0..48).map(|hour| 3600.0 * f64::from(hour));
        // A fifth of what is left, by day and by night: 0.2 % of the fill.
        let empty = |t: f64| flow(0.01 + 1e-3 * (t / 13_751.0).sin(), 1e-5);
        assert_eq!(hours.into_iter().find_map(|t| bounds.push_flow(t, &empty(t), 1.0, 0.0)), None);
    }

    #[test]
    fn what_the_observer_learns_slowly_is_no_gas() {
        // 3 % within a week, as a bound that fades within hours allows and one that stays would not.
        let mut bounds = GasBounds::default();
        let hours = (0..168).map(|hour| 3600.0 * f64::from(hour));
        let wanders = |t: f64| flow(1.0 - 0.03 * t / 604_800.0, 1e-3);
        assert_eq!(hours.into_iter().find_map(|t| bounds.push_flow(t, &wanders(t), 1.0, 0.0)), None);
    }

    #[test]
    fn a_mass_that_swings_with_every_day_is_no_gas_once_that_is_known_and_a_loss_beside_it_is() {
        // 1 % by day and by night.
        let swings = |hour: f64| 1.0 + 0.01 * (std::f64::consts::TAU * hour / 24.0).sin();
        let ways_of = |mass: &dyn Fn(f64) -> f64| {
            let mut bounds = GasBounds::default();
            let hours = (0..30 * 24).map(f64::from);
            let certain = |hour: f64| {
                let certain = bounds.push_flow(3600.0 * hour, &flow(mass(hour), 1e-3), 1.0, 0.0);
                certain.into_iter().for_each(|way| bounds.gone(way));
                certain.map(|way| (hour, way))
            };
            hours.filter_map(certain).collect::<Vec<_>>()
        };
        let days = |ways: &[(f64, Certain)]| ways.iter().map(|(hour, _)| hour / 24.0).fold(0.0, f64::max);
        assert!(days(&ways_of(&swings)) < 8.0, "{:?}", ways_of(&swings));
        let lost = |hour: f64| swings(hour) - if hour > 700.0 { 0.08 } else { 0.0 };
        assert_eq!(ways_of(&lost).last(), Some(&(701.0, Certain::Out)));
    }

    #[test]
    fn a_row_outside_the_gas_says_nothing() {
        let mut bounds = GasBounds::default();
        bounds.push(&seen(0.0, 100e5, (300.0, 300.0)), mass_kg);
        let before = bounds.clone();
        assert_eq!(bounds.push(&seen(1.0, 10e5, (300.0, 300.0)), |_, _| f64::NAN), None);
        assert_eq!(before.walls, bounds.walls);
    }
}
