//! Parts that climates are made of: air outside, stays in other air, trips and sunshine, each a function of the clock.
//!
//! Times are counted by the local clock, s from the midnight before the log begins. Nothing jumps: what changes at once does so on a
//! ramp, so that a solver goes on without a restart.
use cylwatch_thermal::units::{DAY_S, YEAR_S};
use std::f64::consts::TAU;

use crate::random::OrnsteinUhlenbeck;

/// Air outside: `mean - swing cos(2 pi (t - coldest)/year) + diurnal cos(2 pi (t - warmest)/day) + sd weather(t)`.
pub(super) struct Outside {
    pub mean_degc: f64,
    /// Half the difference of summer and winter, K.
    pub swing_k: f64,
    /// The coldest time of the year by the clock of the log, s.
    pub coldest_s: f64,
    pub diurnal_k: f64,
    /// Warmest time of the day, s.
    pub warmest_s: f64,
    pub weather_sd_k: f64,
    /// Unit variance, correlation time of days.
    pub weather: OrnsteinUhlenbeck,
}

impl Outside {
    pub(super) fn degc(&self, t_s: f64) -> f64 {
        self.mean_degc - self.swing_k * (TAU * (t_s - self.coldest_s) / YEAR_S).cos()
            + self.diurnal_k * (TAU * (t_s - self.warmest_s) / DAY_S).cos()
            + self.weather_sd_k * self.weather.at(t_s)
    }
}

/// A rise from zero to a height, a stay and a fall: corners in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trapezoid {
    pub corners_s: [f64; 4],
    pub height: f64,
}

impl Trapezoid {
    pub(super) fn at(&self, t_s: f64) -> f64 {
        let [a, b, c, d] = self.corners_s;
        let rise = (t_s - a) / (b - a);
        let fall = (d - t_s) / (d - c);
        self.height * rise.min(fall).clamp(0.0, 1.0)
    }
}

/// Sum of stretches that are sorted by their beginning and do not overlap.
pub(super) fn sum_at(stretches: &[Trapezoid], t_s: f64) -> f64 {
    let next = stretches.partition_point(|stretch| stretch.corners_s[0] <= t_s);
    next.checked_sub(1).map_or(0.0, |last| stretches[last].at(t_s))
}

/// Air of a stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StayAir {
    /// Its own temperature, °C.
    Degc(f64),
    /// So much warmer than the air would be otherwise, up to a highest temperature, K and °C.
    Warmer(f64, f64),
    /// So much colder than the air would be otherwise, K: rain.
    Colder(f64),
    /// A mixture of inside and outside air, by the share of the latter: an open door.
    Outside(f64),
}

/// A stay in other air: a tunnel, a hall, an open door, a shower. Both ends are ramps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stay {
    pub enter_s: f64,
    pub leave_s: f64,
    pub air: StayAir,
    /// Duration of the change of the air at either end, s.
    pub ramp_s: f64,
    /// Wind or film of the stay and the duration of its change at either end, s; `None`: as it would be otherwise.
    pub flow: Option<(f64, f64)>,
    /// Whether there is no sun.
    pub is_dark: bool,
}

impl Stay {
    /// Share of a signal that changes within a time at either end.
    fn share(&self, t_s: f64, ramp_s: f64) -> f64 {
        let rise = (t_s - self.enter_s) / ramp_s;
        let fall = 1.0 - (t_s - self.leave_s) / ramp_s;
        rise.min(fall).clamp(0.0, 1.0)
    }

    pub(super) fn air_degc(&self, t_s: f64, inside_degc: f64, outside_degc: f64) -> f64 {
        let target = match self.air {
            StayAir::Degc(degc) => degc,
            StayAir::Warmer(by_k, highest_degc) => (inside_degc + by_k).min(highest_degc.max(inside_degc)),
            StayAir::Colder(by_k) => inside_degc - by_k,
            StayAir::Outside(share) => inside_degc + share * (outside_degc - inside_degc),
        };
        inside_degc + self.share(t_s, self.ramp_s) * (target - inside_degc)
    }

    pub(super) fn flow(&self, t_s: f64, otherwise: f64) -> f64 {
        self.flow.map_or(otherwise, |(flow, ramp_s)| otherwise + self.share(t_s, ramp_s) * (flow - otherwise))
    }

    pub(super) fn light(&self, t_s: f64) -> f64 {
        if self.is_dark { 1.0 - self.share(t_s, self.ramp_s) } else { 1.0 }
    }

    pub(super) fn knots_s(&self) -> impl Iterator<Item = f64> + '_ {
        let ramps = [Some(self.ramp_s), self.flow.map(|(_, ramp_s)| ramp_s)];
        let ends = [self.enter_s, self.leave_s];
        ends.into_iter().flat_map(move |end| {
            std::iter::once(end).chain(ramps.into_iter().flatten().map(move |ramp| end + ramp))
        })
    }
}

/// Straight lines between points in the order of time, constant beyond them.
pub(super) struct Polyline {
    pub time_s: Vec<f64>,
    pub value: Vec<f64>,
}

impl Polyline {
    pub(super) fn at(&self, t_s: f64) -> f64 {
        let next = self.time_s.partition_point(|&t| t <= t_s);
        match next {
            0 => self.value[0],
            n if n == self.time_s.len() => self.value[n - 1],
            n => {
                let weight = (t_s - self.time_s[n - 1]) / (self.time_s[n] - self.time_s[n - 1]);
                self.value[n - 1] + weight * (self.value[n] - self.value[n - 1])
            }
        }
    }
}
