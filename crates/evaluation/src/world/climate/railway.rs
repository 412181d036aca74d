//! Winter under a rail vehicle: 3 to 6 tunnels of 32 to 40 °C a day, trips, sun in patches; all seasons in long logs.
//!
//! Annual mean 1 to 6 °C, swing 8 to 14 K, the log begins within 45 d of the coldest day; weather of 4 K with 2 d, diurnal 3 to 7 K.
//! Film by convection 4 W/(m² K) parked, 10 to 30 on a trip. Sun up to 500 W/m² on the shoulder and the valve.
use super::Span;
use super::draw::{OutsideLaw, SunLaw, TripLaw, TunnelLaw};
use super::part::StayAir;
use super::unrest::Unrest;
use super::weather::Weather;
use cylwatch_thermal::units::{HOUR_S, MINUTE_S};

const SERVICE_S: (f64, f64) = (5.0 * HOUR_S, 22.0 * HOUR_S);
pub(super) const DAYLIGHT_S: (f64, f64) = (8.0 * HOUR_S, 16.0 * HOUR_S);
/// Of air beside trains.
pub(super) const UNREST: Unrest = Unrest { turbulence_k: 0.4, gust: 0.1, difference_k: 0.5 };

fn winter() -> OutsideLaw {
    OutsideLaw {
        mean_degc: (1.0, 6.0),
        swing_k: (8.0, 14.0),
        begins_d: (-45.0, 45.0),
        diurnal_k: (3.0, 7.0),
        weather_sd_k: 4.0,
    }
}

fn patchy_sun() -> SunLaw {
    let patch_s = (10.0 * MINUTE_S, 60.0 * MINUTE_S);
    SunLaw { daylight_s: DAYLIGHT_S, peak_w_m2: (0.0, 500.0), lit_s: patch_s, shade_s: patch_s }
}

pub(super) fn tunnels() -> TunnelLaw {
    TunnelLaw {
        service_s: SERVICE_S,
        a_day: (3, 6),
        stay_s: (20.0 * MINUTE_S, 35.0 * MINUTE_S),
        air: |random| StayAir::Degc(random.uniform((32.0, 40.0))),
        ramp_s: (15.0, 60.0),
        flow: None,
    }
}

pub(super) fn trips() -> TripLaw {
    TripLaw {
        service_s: SERVICE_S,
        height: (6.0, 26.0),
        ramp_s: (60.0, 240.0),
        cruise_s: (20.0 * MINUTE_S, 75.0 * MINUTE_S),
        stop_s: (3.0 * MINUTE_S, 20.0 * MINUTE_S),
    }
}

/// A winter under a vehicle with these tunnels and trips, and its film or wind at rest.
pub(super) fn under(span: &Span, rest: f64, tunnels: &TunnelLaw, trips: &TripLaw) -> Weather {
    Weather {
        stays: tunnels.draw(span),
        trips: trips.draw(span),
        sun: patchy_sun().draw(span),
        daylight_s: DAYLIGHT_S,
        lit: (0.8, 1.0, true),
        radiation_lag_s: 30.0 * MINUTE_S,
        ..Weather::sheltered(winter().draw(span), rest, UNREST)
    }
}

pub(super) fn draw(span: &Span) -> Weather {
    under(span, 4.0, &tunnels(), &trips())
}
