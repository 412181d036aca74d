//! Desert summer: days of 38 to 50 °C, nights 18 to 26 K colder, 900 to 1000 W/m² on the upper 60 to 100 % of the cylinder.
//!
//! Annual mean 22 to 26 °C, swing 10 to 12 K, the log begins within 45 d of the hottest day. Wind of 1 to 3 m/s that varies by 50 % within
//! an hour. Hardly a cloud: sun from 6 to 19 h with single minutes of shade. The night sky takes 5 to 12 K away.
use super::Span;
use super::draw::{OutsideLaw, SunLaw};
use super::unrest::Unrest;
use super::weather::{Film, Weather};
use crate::random::{Purpose, Random};
use cylwatch_thermal::units::{HOUR_S, MINUTE_S};

const HALF_A_YEAR_D: f64 = 182.625;
const DAYLIGHT_S: (f64, f64) = (6.0 * HOUR_S, 19.0 * HOUR_S);

pub(super) fn draw(span: &Span) -> Weather {
    let outside = OutsideLaw {
        mean_degc: (22.0, 26.0),
        swing_k: (10.0, 12.0),
        begins_d: (HALF_A_YEAR_D - 45.0, HALF_A_YEAR_D + 45.0),
        diurnal_k: (9.0, 13.0),
        weather_sd_k: 2.0,
    };
    let sun = SunLaw {
        daylight_s: DAYLIGHT_S,
        peak_w_m2: (900.0, 1000.0),
        lit_s: (60.0 * MINUTE_S, 300.0 * MINUTE_S),
        shade_s: (3.0 * MINUTE_S, 10.0 * MINUTE_S),
    };
    let random = &mut Random::new(span.seed, Purpose::WorldSite);
    let (lit_from, rest, sky_k) =
        (random.uniform((0.0, 0.4)), random.uniform((1.0, 3.0)), random.uniform((5.0, 12.0)));
    let unrest = Unrest { turbulence_k: 0.6, gust: 0.2, difference_k: 1.0 };
    Weather {
        film: Film::Wind,
        rest_variation: 0.5,
        sun: sun.draw(span),
        daylight_s: DAYLIGHT_S,
        lit: (lit_from, 1.0, true),
        radiation_lag_s: 60.0 * MINUTE_S,
        sky_k,
        ..Weather::sheltered(outside.draw(span), rest, unrest)
    }
}
