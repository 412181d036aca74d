//! A metro: twenty short tunnels a day of 16 to 30 °C, one to six minutes each, with trains that start and stop every few minutes.
//!
//! Air outside as in winter and the seasons of [`super::railway`], but milder (annual mean 8 to 12 °C). The film follows from the wind:
//! 5 to 20 m/s on a trip, reached within 15 to 40 s, and 2 to 15 m/s in a tunnel, reached within 1 to 20 s. No sun but at the terminus.
use super::Span;
use super::draw::{OutsideLaw, SunLaw, TripLaw, TunnelLaw};
use super::part::StayAir;
use super::railway::{DAYLIGHT_S, UNREST};
use super::weather::{Film, Weather};
use cylwatch_thermal::units::{HOUR_S, MINUTE_S};

const SERVICE_S: (f64, f64) = (5.0 * HOUR_S, 24.0 * HOUR_S);
const TUNNELS_A_DAY: usize = 20;

pub(super) fn draw(span: &Span) -> Weather {
    let outside = OutsideLaw {
        mean_degc: (8.0, 12.0),
        swing_k: (8.0, 11.0),
        begins_d: (-60.0, 60.0),
        diurnal_k: (2.0, 5.0),
        weather_sd_k: 3.0,
    };
    let tunnels = TunnelLaw {
        service_s: SERVICE_S,
        a_day: (TUNNELS_A_DAY, TUNNELS_A_DAY),
        stay_s: (1.0 * MINUTE_S, 6.0 * MINUTE_S),
        air: |random| StayAir::Degc(random.uniform((16.0, 30.0))),
        ramp_s: (5.0, 30.0),
        flow: Some(((2.0, 15.0), (1.0, 20.0))),
    };
    let trips = TripLaw {
        service_s: SERVICE_S,
        height: (5.0, 20.0),
        ramp_s: (15.0, 40.0),
        cruise_s: (4.0 * MINUTE_S, 15.0 * MINUTE_S),
        stop_s: (2.0 * MINUTE_S, 8.0 * MINUTE_S),
    };
    let sun = SunLaw {
        daylight_s: DAYLIGHT_S,
        peak_w_m2: (0.0, 300.0),
        lit_s: (5.0 * MINUTE_S, 20.0 * MINUTE_S),
        shade_s: (60.0 * MINUTE_S, 240.0 * MINUTE_S),
    };
    Weather {
        stays: tunnels.draw(span),
        film: Film::Wind,
        rest_variation: 0.5,
        trips: trips.draw(span),
        sun: sun.draw(span),
        daylight_s: DAYLIGHT_S,
        lit: (0.8, 1.0, true),
        radiation_lag_s: 30.0 * MINUTE_S,
        ..Weather::sheltered(outside.draw(span), 0.3, UNREST)
    }
}
