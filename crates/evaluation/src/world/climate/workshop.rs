//! A workshop: 18 to 24 °C, kept within half a kelvin, still air, no sun.
//!
//! The air is an Ornstein-Uhlenbeck process of 0.2 K with 2 h around its set point, held within 0.5 K of it.
use super::Span;
use super::draw::{OutsideLaw, Range};
use super::part::Polyline;
use super::unrest::Unrest;
use super::weather::Weather;
use crate::random::{OrnsteinUhlenbeck, Purpose, Random};
use cylwatch_thermal::units::{HOUR_S, MINUTE_S};

const SET_DEGC: Range = (18.0, 24.0);
const SD_K: f64 = 0.2;
const BAND_K: f64 = 0.45;
const TIME_S: f64 = 2.0 * HOUR_S;
const STEP_S: f64 = 30.0 * MINUTE_S;

/// Air outside that an indoor climate has behind its walls: all seasons, begun at any time of the year.
pub(super) fn any_season() -> OutsideLaw {
    OutsideLaw {
        mean_degc: (6.0, 12.0),
        swing_k: (7.0, 11.0),
        begins_d: (0.0, 365.25),
        diurnal_k: (2.0, 6.0),
        weather_sd_k: 3.5,
    }
}

pub(super) fn draw(span: &Span) -> Weather {
    let mut random = Random::new(span.seed, Purpose::WorldHeater);
    let set_degc = random.uniform(SET_DEGC);
    let end_s = span.clock_end_s();
    let process = OrnsteinUhlenbeck::draw(&mut random, TIME_S, STEP_S, end_s);
    let time_s: Vec<f64> = (0..=(end_s / STEP_S) as usize).map(|step| step as f64 * STEP_S).collect();
    let value = time_s.iter().map(|&t| set_degc + (SD_K * process.at(t)).clamp(-BAND_K, BAND_K)).collect();
    let unrest = Unrest { turbulence_k: 0.05, gust: 0.1, difference_k: 0.2 };
    Weather {
        inside: Some(Polyline { time_s, value }),
        rest_variation: 0.1,
        radiation_lag_s: 2.0 * HOUR_S,
        ..Weather::sheltered(any_season().draw(span), 3.5, unrest)
    }
}
