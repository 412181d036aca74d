//! A roof in summer: sun of up to 800 W/m² in patches, and up to four showers a day.
//!
//! Annual mean 8 to 12 °C, swing 8 to 11 K, the log begins within 60 d of the hottest day. A shower lasts 3 to 30 min: water 2 to 8 K
//! colder than the air runs over the cylinder with a film of 60 to 150 W/(m² K), reached within 20 to 90 s; no sun meanwhile. Film 4 to
//! 10 W/(m² K) in the open, varying by 30 % within an hour. The sky takes 2 to 8 K away.
use super::Span;
use super::draw::{OutsideLaw, SunLaw, TunnelLaw};
use super::part::StayAir;
use super::unrest::Unrest;
use super::weather::Weather;
use crate::random::{Purpose, Random};
use cylwatch_thermal::units::{DAY_S, HOUR_S, MINUTE_S};

const HALF_A_YEAR_D: f64 = 182.625;
const DAYLIGHT_S: (f64, f64) = (5.0 * HOUR_S, 21.0 * HOUR_S);

pub(super) fn draw(span: &Span) -> Weather {
    let outside = OutsideLaw {
        mean_degc: (8.0, 12.0),
        swing_k: (8.0, 11.0),
        begins_d: (HALF_A_YEAR_D - 60.0, HALF_A_YEAR_D + 60.0),
        diurnal_k: (4.0, 8.0),
        weather_sd_k: 3.0,
    };
    let showers = TunnelLaw {
        service_s: (0.0, DAY_S),
        a_day: (0, 4),
        stay_s: (3.0 * MINUTE_S, 30.0 * MINUTE_S),
        air: |random| StayAir::Colder(random.uniform((2.0, 8.0))),
        ramp_s: (20.0, 90.0),
        flow: Some(((60.0, 150.0), (20.0, 90.0))),
    };
    let sun = SunLaw {
        daylight_s: DAYLIGHT_S,
        peak_w_m2: (200.0, 800.0),
        lit_s: (10.0 * MINUTE_S, 120.0 * MINUTE_S),
        shade_s: (5.0 * MINUTE_S, 90.0 * MINUTE_S),
    };
    let random = &mut Random::new(span.seed, Purpose::WorldSite);
    let (rest, sky_k, lit_from) =
        (random.uniform((4.0, 10.0)), random.uniform((2.0, 8.0)), random.uniform((0.0, 0.7)));
    let unrest = Unrest { turbulence_k: 0.4, gust: 0.2, difference_k: 0.5 };
    Weather {
        stays: showers.draw(span),
        rest_variation: 0.3,
        sun: sun.draw(span),
        daylight_s: DAYLIGHT_S,
        lit: (lit_from, 1.0, true),
        radiation_lag_s: 45.0 * MINUTE_S,
        sky_k,
        ..Weather::sheltered(outside.draw(span), rest, unrest)
    }
}
