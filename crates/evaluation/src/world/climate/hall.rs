//! A heated hall: 12 to 20 °C, a fan heater that switches at 0.5 to 1.5 K below and above that, and doors that open.
//!
//! The heater is on for 4 to 15 min, during which the air rises evenly through the band, and off for 10 to 45 min, during which it falls.
//! The set point sinks by 3 to 6 K from 22 to 5 h. Doors open 2 to 8 times from 6 to 20 h for 2 to 15 min and let in 30 to 70 % of outside
//! air within 20 to 90 s. Film 4 W/(m² K), while a door is open 6 to 12. The air is warmer at the top, by 1 K and more.
use super::Span;
use super::draw::TunnelLaw;
use super::part::{Polyline, StayAir};
use super::unrest::Unrest;
use super::weather::Weather;
use super::workshop::any_season;
use crate::random::{Purpose, Random};
use cylwatch_thermal::units::{DAY_S, HOUR_S, MINUTE_S};

const SET_DEGC: (f64, f64) = (12.0, 20.0);
const BAND_K: (f64, f64) = (0.5, 1.5);
const SETBACK_K: (f64, f64) = (3.0, 6.0);
/// Night, and the time in which the set point changes, s.
const NIGHT_S: (f64, f64) = (22.0 * HOUR_S, 5.0 * HOUR_S);
const CHANGE_S: f64 = 3.0 * HOUR_S;
const ON_S: (f64, f64) = (4.0 * MINUTE_S, 15.0 * MINUTE_S);
const OFF_S: (f64, f64) = (10.0 * MINUTE_S, 45.0 * MINUTE_S);

/// Air that a heater keeps, and the times in which it is on.
fn heated(span: &Span) -> (Polyline, Vec<(f64, f64)>) {
    let random = &mut Random::new(span.seed, Purpose::WorldHeater);
    let (set_degc, band_k) = (random.uniform(SET_DEGC), random.uniform(BAND_K));
    let setback_k = random.uniform(SETBACK_K);
    let (mut air, mut on_s) = (Polyline { time_s: Vec::new(), value: Vec::new() }, Vec::new());
    let mut t = 0.0;
    // One more than needed: the last fall ends where the next rise begins.
    while t <= span.clock_end_s() + OFF_S.1 + ON_S.1 {
        let (begin_s, end_s) = (t, t + random.uniform(ON_S));
        for (at_s, side) in [(begin_s, -1.0), (end_s, 1.0)] {
            air.time_s.push(at_s);
            air.value.push(set_degc - setback_k * night(at_s) + side * band_k);
        }
        on_s.push((begin_s, end_s));
        t = end_s + random.uniform(OFF_S);
    }
    (air, on_s)
}

/// Share of the night's set point.
fn night(t_s: f64) -> f64 {
    let of_day_s = t_s.rem_euclid(DAY_S);
    let (begin_s, end_s) = NIGHT_S;
    let since_s = (of_day_s - begin_s).rem_euclid(DAY_S);
    let after_s = (of_day_s - end_s).rem_euclid(DAY_S);
    let is_night = since_s < (end_s - begin_s).rem_euclid(DAY_S);
    if is_night { (since_s / CHANGE_S).min(1.0) } else { (1.0 - after_s / CHANGE_S).max(0.0) }
}

pub(super) fn draw(span: &Span) -> Weather {
    let doors = TunnelLaw {
        service_s: (6.0 * HOUR_S, 20.0 * HOUR_S),
        a_day: (2, 8),
        stay_s: (2.0 * MINUTE_S, 15.0 * MINUTE_S),
        air: |random| StayAir::Outside(random.uniform((0.3, 0.7))),
        ramp_s: (20.0, 90.0),
        flow: Some(((6.0, 12.0), (5.0, 60.0))),
    };
    let (air, heated_s) = heated(span);
    let unrest = Unrest { turbulence_k: 0.1, gust: 0.15, difference_k: 1.0 };
    Weather {
        inside: Some(air),
        stays: doors.draw(span),
        rest_variation: 0.1,
        radiation_lag_s: 2.0 * HOUR_S,
        heated_s,
        ..Weather::sheltered(any_season().draw(span), 4.0, unrest)
    }
}
