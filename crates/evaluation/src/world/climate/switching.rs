//! The kind of the built-in railway week: wind that switches at the mouths of tunnels, tunnels 42 to 48 K warmer, up to 55 °C.
//!
//! The film follows from a wind speed: 8 to 30 m/s on a trip, still air parked, and in a tunnel 3 to 30 m/s, reached within 1 to 60 s
//! (evenly by the logarithm) of its mouth. The air changes there within 14 to 16 s, by 3 K/s. Weather, trips' times and sun as in
//! [`super::railway`], but the sun lights the upper 70 %.
use super::Span;
use super::draw::{TripLaw, TunnelLaw};
use super::part::StayAir;
use super::railway::{DAYLIGHT_S, SERVICE_S, patchy_sun, winter};
use super::unrest::Unrest;
use super::weather::{Film, Weather};
use cylwatch_thermal::units::MINUTE_S;

const HIGHEST_DEGC: f64 = 55.0;

pub(super) fn draw(span: &Span) -> Weather {
    let tunnels = TunnelLaw {
        service_s: SERVICE_S,
        a_day: (3, 6),
        stay_s: (20.0 * MINUTE_S, 35.0 * MINUTE_S),
        air: |random| StayAir::Warmer(random.uniform((42.0, 48.0)), HIGHEST_DEGC),
        ramp_s: (14.0, 16.0),
        flow: Some(((3.0, 30.0), (1.0, 60.0))),
    };
    let trips = TripLaw {
        service_s: SERVICE_S,
        height: (8.0, 30.0),
        ramp_s: (60.0, 240.0),
        cruise_s: (20.0 * MINUTE_S, 75.0 * MINUTE_S),
        stop_s: (3.0 * MINUTE_S, 20.0 * MINUTE_S),
    };
    Weather {
        outside: winter().draw(span),
        inside: None,
        stays: tunnels.draw(span),
        film: Film::Wind,
        rest: 0.3,
        rest_variation: 0.5,
        trips: trips.draw(span),
        sun: patchy_sun().draw(span),
        daylight_s: DAYLIGHT_S,
        lit: (0.3, 1.0, true),
        radiation_lag_s: 30.0 * MINUTE_S,
        sky_k: 0.0,
        unrest: Unrest { turbulence_k: 0.4, gust: 0.1, difference_k: 0.5 },
        jumps_s: Vec::new(),
        heated_s: Vec::new(),
    }
}
