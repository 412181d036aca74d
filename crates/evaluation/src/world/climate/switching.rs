//! The kind of the built-in railway week: wind that switches at the mouths of tunnels, tunnels 42 to 48 K warmer, up to 55 °C.
//!
//! The film follows from a wind speed: 8 to 30 m/s on a trip, still air parked, and in a tunnel 3 to 30 m/s, reached within 1 to 60 s
//! (evenly by the logarithm) of its mouth. The air changes there within 14 to 16 s, by 3 K/s. Weather, trips' times and sun as in
//! [`super::railway`], but the sun lights the upper 70 %.
use super::Span;
use super::draw::{TripLaw, TunnelLaw};
use super::part::StayAir;
use super::railway;
use super::weather::{Film, Weather};

const HIGHEST_DEGC: f64 = 55.0;

pub(super) fn draw(span: &Span) -> Weather {
    let tunnels = TunnelLaw {
        air: |random| StayAir::Warmer(random.uniform((42.0, 48.0)), HIGHEST_DEGC),
        ramp_s: (14.0, 16.0),
        flow: Some(((3.0, 30.0), (1.0, 60.0))),
        ..railway::tunnels()
    };
    let trips = TripLaw { height: (8.0, 30.0), ..railway::trips() };
    Weather {
        film: Film::Wind,
        rest_variation: 0.5,
        lit: (0.3, 1.0, true),
        ..railway::under(span, 0.3, &tunnels, &trips)
    }
}
