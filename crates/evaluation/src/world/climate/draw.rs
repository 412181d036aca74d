//! Laws that several climates share, each drawn day by day, so that a longer log begins like a shorter one.
use super::Span;
use super::part::{Outside, Stay, StayAir, Trapezoid};
use crate::random::{OrnsteinUhlenbeck, Purpose, Random};
use cylwatch_thermal::units::{DAY_S, HOUR_S, MINUTE_S, YEAR_S};

/// A range to draw from evenly.
pub(super) type Range = (f64, f64);

/// Law of the air outside.
pub(super) struct OutsideLaw {
    pub mean_degc: Range,
    pub swing_k: Range,
    /// Days from the coldest day of the year to the beginning of the log.
    pub begins_d: Range,
    pub diurnal_k: Range,
    pub weather_sd_k: f64,
}

impl OutsideLaw {
    pub(super) fn draw(&self, span: &Span) -> Outside {
        let mut random = Random::new(span.seed, Purpose::WorldAir);
        let weather = &mut Random::new(span.seed, Purpose::WorldWeather);
        Outside {
            mean_degc: random.uniform(self.mean_degc),
            swing_k: random.uniform(self.swing_k),
            coldest_s: (-random.uniform(self.begins_d) * DAY_S).rem_euclid(YEAR_S),
            diurnal_k: random.uniform(self.diurnal_k),
            warmest_s: 15.0 * HOUR_S,
            weather_sd_k: self.weather_sd_k,
            weather: OrnsteinUhlenbeck::draw(weather, 2.0 * DAY_S, HOUR_S, span.clock_end_s()),
        }
    }
}

/// Law of passages through tunnels: one in each equal part of the service day, so that none overlap.
pub(super) struct TunnelLaw {
    pub service_s: Range,
    pub a_day: (usize, usize),
    pub stay_s: Range,
    pub air: fn(&mut Random) -> StayAir,
    pub ramp_s: Range,
    /// Wind or film inside and the time in which it switches at the mouth, s; `None`: as outside.
    pub flow: Option<(Range, Range)>,
}

/// Time between two tunnels at least, s: longer than any ramp.
const TUNNEL_GAP_S: f64 = 150.0;

impl TunnelLaw {
    pub(super) fn draw(&self, span: &Span) -> Vec<Stay> {
        let mut random = Random::new(span.seed, Purpose::WorldStays);
        let mut stays = Vec::new();
        for day in 0..span.days() {
            let count = random.whole(self.a_day);
            let part_s = (self.service_s.1 - self.service_s.0) / count as f64;
            for part in 0..count {
                let stay_s = random.uniform(self.stay_s).min(part_s - TUNNEL_GAP_S);
                let begin_s = day as f64 * DAY_S + self.service_s.0 + part as f64 * part_s;
                let enter_s = begin_s + random.uniform((0.0, part_s - stay_s - TUNNEL_GAP_S));
                let air = (self.air)(&mut random);
                let ramp_s = random.uniform(self.ramp_s);
                let flow =
                    self.flow.map(|(flow, switch_s)| (random.uniform(flow), random.by_logarithm(switch_s)));
                stays.push(Stay { enter_s, leave_s: enter_s + stay_s, air, ramp_s, flow, is_dark: true });
            }
        }
        stays
    }
}

/// Law of trips: film or wind on top of that at rest.
pub(super) struct TripLaw {
    pub service_s: Range,
    pub height: Range,
    pub ramp_s: Range,
    pub cruise_s: Range,
    pub stop_s: Range,
}

impl TripLaw {
    pub(super) fn draw(&self, span: &Span) -> Vec<Trapezoid> {
        let mut random = Random::new(span.seed, Purpose::WorldTrips);
        let mut trips = Vec::new();
        for day in 0..span.days() {
            let end_s = day as f64 * DAY_S + self.service_s.1;
            let mut t = day as f64 * DAY_S + self.service_s.0 + random.uniform((0.0, 30.0 * MINUTE_S));
            while t < end_s {
                let ramp_s = random.uniform(self.ramp_s);
                let cruise_s = random.uniform(self.cruise_s);
                let corners_s = [t, t + ramp_s, t + ramp_s + cruise_s, t + 2.0 * ramp_s + cruise_s];
                trips.push(Trapezoid { corners_s, height: random.uniform(self.height) });
                t = corners_s[3] + random.uniform(self.stop_s);
            }
        }
        trips
    }
}

/// Law of sunshine: patches between sunrise and sunset, up to a day's peak.
pub(super) struct SunLaw {
    pub daylight_s: Range,
    /// Peak irradiance of a day, W/m².
    pub peak_w_m2: Range,
    pub lit_s: Range,
    pub shade_s: Range,
}

/// Time in which sun becomes shade, s.
const SUN_EDGE_S: f64 = 60.0;

impl SunLaw {
    pub(super) fn draw(&self, span: &Span) -> Vec<Trapezoid> {
        let mut random = Random::new(span.seed, Purpose::WorldSun);
        let mut patches = Vec::new();
        for day in 0..span.days() {
            let height = random.uniform(self.peak_w_m2);
            let end_s = day as f64 * DAY_S + self.daylight_s.1;
            let mut t = day as f64 * DAY_S + self.daylight_s.0 + random.uniform(self.shade_s);
            while t < end_s {
                let lit_s = random.uniform(self.lit_s).max(3.0 * SUN_EDGE_S);
                patches.push(Trapezoid {
                    corners_s: [t, t + SUN_EDGE_S, t + lit_s - SUN_EDGE_S, t + lit_s],
                    height,
                });
                t += lit_s + random.uniform(self.shade_s);
            }
        }
        patches
    }
}
