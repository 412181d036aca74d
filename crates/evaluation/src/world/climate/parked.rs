//! A vehicle parked in the open, for a month and longer, at any time of the year.
//!
//! Annual mean 6 to 12 °C, swing 7 to 11 K, diurnal 2 to 6 K, weather of 3.5 K with 2 d. Wind of 1 to 3 m/s that varies by 70 % within an
//! hour; sun in patches of up to 700 W/m² on the upper part; the sky takes 2 to 8 K away.
use super::Span;
use super::draw::SunLaw;
use super::unrest::Unrest;
use super::weather::{Film, Weather};
use super::workshop::any_season;
use crate::random::{Purpose, Random};
use cylwatch_thermal::units::{HOUR_S, MINUTE_S};

const DAYLIGHT_S: (f64, f64) = (7.0 * HOUR_S, 18.0 * HOUR_S);

pub(super) fn draw(span: &Span) -> Weather {
    let sun = SunLaw {
        daylight_s: DAYLIGHT_S,
        peak_w_m2: (0.0, 700.0),
        lit_s: (10.0 * MINUTE_S, 120.0 * MINUTE_S),
        shade_s: (5.0 * MINUTE_S, 120.0 * MINUTE_S),
    };
    let random = &mut Random::new(span.seed, Purpose::WorldSite);
    let (lit_from, rest, sky_k) =
        (random.uniform((0.2, 0.8)), random.uniform((1.0, 3.0)), random.uniform((2.0, 8.0)));
    let unrest = Unrest { turbulence_k: 0.4, gust: 0.2, difference_k: 0.5 };
    Weather {
        film: Film::Wind,
        rest_variation: 0.7,
        sun: sun.draw(span),
        daylight_s: DAYLIGHT_S,
        lit: (lit_from, 1.0, true),
        radiation_lag_s: 45.0 * MINUTE_S,
        sky_k,
        ..Weather::sheltered(any_season().draw(span), rest, unrest)
    }
}
