//! Arctic winter: down to -45 °C, wind of 3 to 8 m/s, and up to one stay a day in a heated garage at 5 to 15 °C.
//!
//! Annual mean -12 to -6 °C, swing 14 to 18 K, the log begins within 45 d of the coldest day; weather of 5 K with 2 d, diurnal 0.5 to 2 K.
//! A garage is entered within 1 to 5 min and left after 1 to 6 h, still air inside. The sky takes 4 to 10 K away; sun of up to 100 W/m².
use super::Span;
use super::draw::{OutsideLaw, SunLaw, TunnelLaw};
use super::part::StayAir;
use super::unrest::Unrest;
use super::weather::{Film, Weather};
use crate::random::{Purpose, Random};
use cylwatch_thermal::units::{HOUR_S, MINUTE_S};

const DAYLIGHT_S: (f64, f64) = (10.0 * HOUR_S, 14.0 * HOUR_S);

pub(super) fn draw(span: &Span) -> Weather {
    let outside = OutsideLaw {
        mean_degc: (-12.0, -6.0),
        swing_k: (14.0, 18.0),
        begins_d: (-45.0, 45.0),
        diurnal_k: (0.5, 2.0),
        weather_sd_k: 5.0,
    };
    let garage = TunnelLaw {
        service_s: (6.0 * HOUR_S, 22.0 * HOUR_S),
        a_day: (0, 1),
        stay_s: (HOUR_S, 6.0 * HOUR_S),
        air: |random| StayAir::Degc(random.uniform((5.0, 15.0))),
        ramp_s: (60.0, 120.0),
        flow: Some(((0.1, 0.4), (60.0, 120.0))),
    };
    let sun = SunLaw {
        daylight_s: DAYLIGHT_S,
        peak_w_m2: (0.0, 100.0),
        lit_s: (10.0 * MINUTE_S, 60.0 * MINUTE_S),
        shade_s: (10.0 * MINUTE_S, 60.0 * MINUTE_S),
    };
    let random = &mut Random::new(span.seed, Purpose::WorldSite);
    let (rest, sky_k) = (random.uniform((3.0, 8.0)), random.uniform((4.0, 10.0)));
    let unrest = Unrest { turbulence_k: 0.3, gust: 0.2, difference_k: 0.5 };
    Weather {
        stays: garage.draw(span),
        film: Film::Wind,
        rest_variation: 0.6,
        sun: sun.draw(span),
        daylight_s: DAYLIGHT_S,
        lit: (0.3, 1.0, true),
        radiation_lag_s: 60.0 * MINUTE_S,
        sky_k,
        ..Weather::sheltered(outside.draw(span), rest, unrest)
    }
}
