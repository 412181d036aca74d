//! Winter weeks, or whole years, under a rail vehicle, drawn from a seed.
//!
//! Air outside tunnels: `mean + weather + diurnal`, mean -8 to 8 °C, weather an Ornstein-Uhlenbeck process of 4 K and
//! 2 d, diurnal cosine of 3 to 7 K either way with its top at 15 h. Tunnels: 3 to 6 a day in service (5 to 22 h), 32 to 40 °C,
//! 20 to 35 min, entered and left with a lag of 6 or 20 s. Film by convection: 4 W/(m² K) parked, 10 to 30 on a trip.
//! In years the mean is `annual - swing cos(2 pi (day - coldest)/365.25)`, annual mean 1 to 6 °C, swing 14 to 18 K: with weather and
//! day about -30 to 35 °C, beyond class T1 of EN 50125-1 (-25 to 40 °C) on the cold side.
//! Sun from 8 to 16 h in patches, up to 500 W/m², which is about 10 W on the shoulder of the 20 L cylinder.
use super::course::Climate;
use crate::random::{OrnsteinUhlenbeck, Purpose, Random};
use cylwatch_thermal::units::{DAY_S, HOUR_S, MINUTE_S, YEAR_S};

const MEAN_DEGC: (f64, f64) = (-8.0, 8.0);
const ANNUAL_DEGC: (f64, f64) = (1.0, 6.0);
const SWING_K: (f64, f64) = (14.0, 18.0);
const DIURNAL_K: (f64, f64) = (3.0, 7.0);
const WARMEST_S: f64 = 15.0 * HOUR_S;
const WEATHER_K: f64 = 4.0;
const WEATHER_TIME_S: f64 = 2.0 * DAY_S;
const SERVICE_S: (f64, f64) = (5.0 * HOUR_S, 22.0 * HOUR_S);
const TUNNELS_A_DAY: (usize, usize) = (3, 6);
const TUNNEL_DEGC: (f64, f64) = (32.0, 40.0);
const TUNNEL_STAY_S: (f64, f64) = (20.0 * MINUTE_S, 35.0 * MINUTE_S);
const TUNNEL_LAGS_S: [f64; 2] = [6.0, 20.0];
/// Time between the end of a tunnel and the next one at least, s.
const TUNNEL_GAP_S: f64 = 5.0 * MINUTE_S;
/// Knots of an exponential approach in time constants; the chords stay within 2.5 % of the step.
pub(super) const APPROACH: [f64; 7] = [0.0, 0.5, 1.0, 1.75, 2.75, 4.0, 7.0];
const FILM_PARKED_W_M2_K: f64 = 4.0;
const FILM_TRIP_W_M2_K: (f64, f64) = (10.0, 30.0);
const TRIP_RAMP_S: (f64, f64) = (60.0, 240.0);
const TRIP_CRUISE_S: (f64, f64) = (20.0 * MINUTE_S, 75.0 * MINUTE_S);
const TRIP_STOP_S: (f64, f64) = (3.0 * MINUTE_S, 20.0 * MINUTE_S);
const SUN_S: (f64, f64) = (8.0 * HOUR_S, 16.0 * HOUR_S);
const IRRADIANCE_PEAK_W_M2: (f64, f64) = (0.0, 500.0);
const SUN_PATCH_S: (f64, f64) = (10.0 * MINUTE_S, 60.0 * MINUTE_S);
const SUN_EDGE_S: f64 = 60.0;

/// A passage through a tunnel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Time of entry, s.
    pub enter_s: f64,
    /// Time of exit, s.
    pub leave_s: f64,
    /// Air temperature in the tunnel, °C.
    pub air_degc: f64,
    /// Time constant with which the air around the cylinder follows, s.
    pub lag_s: f64,
}

impl Passage {
    /// Share of tunnel air around the cylinder.
    fn share(&self, t_s: f64) -> f64 {
        let approach = |since_s: f64| {
            let end = APPROACH[APPROACH.len() - 1] * self.lag_s;
            if since_s >= end { 1.0 } else { 1.0 - (-since_s.max(0.0) / self.lag_s).exp() }
        };
        approach(t_s - self.enter_s) - approach(t_s - self.leave_s)
    }

    fn knots_s(&self) -> impl Iterator<Item = f64> + '_ {
        [self.enter_s, self.leave_s].into_iter().flat_map(|at| APPROACH.map(|n| at + n * self.lag_s))
    }
}

/// A rise from zero to a height, a stay and a fall: corners in s.
#[derive(Clone, Copy, Debug)]
struct Trapezoid {
    corners_s: [f64; 4],
    height: f64,
}

impl Trapezoid {
    fn at(&self, t_s: f64) -> f64 {
        let [a, b, c, d] = self.corners_s;
        let rise = (t_s - a) / (b - a);
        let fall = (d - t_s) / (d - c);
        self.height * rise.min(fall).clamp(0.0, 1.0)
    }
}

/// Drawn weeks; every quantity as a function of time, s from the first midnight.
pub(super) struct Railway {
    mean_degc: f64,
    /// Amplitude of the year, K, and its coldest time, s.
    year: (f64, f64),
    diurnal_k: f64,
    weather: OrnsteinUhlenbeck,
    passages: Vec<Passage>,
    trips: Vec<Trapezoid>,
    sun: Vec<Trapezoid>,
}

impl Railway {
    pub(super) fn draw(seed: u64, duration_s: f64, kind: Climate) -> Self {
        let days = (duration_s / DAY_S).ceil() as usize;
        let mut climate = Random::new(seed, Purpose::Climate);
        let weather = &mut Random::new(seed, Purpose::Weather);
        let seasons = kind == Climate::Seasons;
        let mean_degc = climate.uniform(if seasons { ANNUAL_DEGC } else { MEAN_DEGC });
        let diurnal_k = climate.uniform(DIURNAL_K);
        let year =
            if seasons { (climate.uniform(SWING_K), climate.uniform((0.0, YEAR_S))) } else { (0.0, 0.0) };
        Self {
            mean_degc,
            year,
            diurnal_k,
            weather: OrnsteinUhlenbeck::draw(weather, WEATHER_TIME_S, HOUR_S, duration_s),
            passages: passages(seed, days),
            trips: trips(seed, days),
            sun: sun(seed, days),
        }
    }

    /// Air temperature around the cylinder without turbulence, °C.
    pub(super) fn air_degc(&self, t_s: f64) -> f64 {
        let outside = self.outside_degc(t_s);
        self.passages_at(t_s)
            .iter()
            .fold(outside, |air, passage| air + passage.share(t_s) * (passage.air_degc - outside))
    }

    fn outside_degc(&self, t_s: f64) -> f64 {
        let phase = std::f64::consts::TAU * (t_s - WARMEST_S) / DAY_S;
        let (swing_k, coldest_s) = self.year;
        let season = std::f64::consts::TAU * (t_s - coldest_s) / YEAR_S;
        self.mean_degc - swing_k * season.cos()
            + WEATHER_K * self.weather.at(t_s)
            + self.diurnal_k * phase.cos()
    }

    /// The passages that can be felt at a time: all others add nothing.
    fn passages_at(&self, t_s: f64) -> &[Passage] {
        let longest_s = TUNNEL_STAY_S.1 + APPROACH[APPROACH.len() - 1] * TUNNEL_LAGS_S[1] + 1.0;
        let from = self.passages.partition_point(|passage| passage.enter_s < t_s - longest_s);
        let to = self.passages.partition_point(|passage| passage.enter_s <= t_s);
        &self.passages[from..to.max(from)]
    }

    /// Film by convection without gusts, W/(m² K).
    pub(super) fn film_w_m2_k(&self, t_s: f64) -> f64 {
        FILM_PARKED_W_M2_K + at_work(&self.trips, t_s).map(|trip| trip.at(t_s)).sum::<f64>()
    }

    /// Irradiance, W/m²; none in tunnels.
    pub(super) fn irradiance_w_m2(&self, t_s: f64) -> f64 {
        let of_day = (t_s.rem_euclid(DAY_S) - SUN_S.0) / (SUN_S.1 - SUN_S.0);
        let arch = (4.0 * of_day * (1.0 - of_day)).max(0.0);
        let light: f64 = at_work(&self.sun, t_s).map(|patch| patch.at(t_s)).sum();
        let tunnel: f64 = self.passages_at(t_s).iter().map(|passage| passage.share(t_s)).sum();
        arch * light * (1.0 - tunnel).max(0.0)
    }

    /// Times at which a signal bends, s, in no order.
    pub(super) fn knots_s(&self) -> impl Iterator<Item = f64> + '_ {
        let corners = self.trips.iter().chain(&self.sun).flat_map(|trapezoid| trapezoid.corners_s);
        self.passages.iter().flat_map(Passage::knots_s).chain(corners)
    }
}

/// Those of stretches in the order of time that may not be zero at a time.
fn at_work(stretches: &[Trapezoid], t_s: f64) -> impl Iterator<Item = &Trapezoid> {
    let from = stretches.partition_point(|stretch| stretch.corners_s[3] < t_s);
    stretches[from..].iter().take_while(move |stretch| stretch.corners_s[0] <= t_s)
}

/// Passages through tunnels in the first days: one in each equal part of the service day, so that none overlap.
pub fn passages(seed: u64, days: usize) -> Vec<Passage> {
    let mut random = Random::new(seed, Purpose::Tunnels);
    let mut passages = Vec::new();
    for day in 0..days {
        let count = random.whole(TUNNELS_A_DAY);
        let part_s = (SERVICE_S.1 - SERVICE_S.0) / count as f64;
        for part in 0..count {
            let stay_s = random.uniform(TUNNEL_STAY_S);
            let begin_s = day as f64 * DAY_S + SERVICE_S.0 + part as f64 * part_s;
            let enter_s = (begin_s + random.uniform((0.0, part_s - stay_s - TUNNEL_GAP_S))).round();
            passages.push(Passage {
                enter_s,
                leave_s: (enter_s + stay_s).round(),
                air_degc: random.uniform(TUNNEL_DEGC),
                lag_s: TUNNEL_LAGS_S[random.whole((0, 1))],
            });
        }
    }
    passages
}

fn trips(seed: u64, days: usize) -> Vec<Trapezoid> {
    let mut random = Random::new(seed, Purpose::Trips);
    let mut trips = Vec::new();
    for day in 0..days {
        let mut t = day as f64 * DAY_S + SERVICE_S.0;
        while t < day as f64 * DAY_S + SERVICE_S.1 {
            let ramp_s = random.uniform(TRIP_RAMP_S).round();
            let cruise_s = random.uniform(TRIP_CRUISE_S).round();
            let corners_s = [t, t + ramp_s, t + ramp_s + cruise_s, t + 2.0 * ramp_s + cruise_s];
            let height = random.uniform(FILM_TRIP_W_M2_K) - FILM_PARKED_W_M2_K;
            trips.push(Trapezoid { corners_s, height });
            t = corners_s[3] + random.uniform(TRIP_STOP_S).round();
        }
    }
    trips
}

/// Stretches of sunshine; their height is the day's peak irradiance, W/m².
fn sun(seed: u64, days: usize) -> Vec<Trapezoid> {
    let mut random = Random::new(seed, Purpose::Sun);
    let mut patches = Vec::new();
    for day in 0..days {
        let height = random.uniform(IRRADIANCE_PEAK_W_M2);
        let mut t = day as f64 * DAY_S + SUN_S.0 + random.uniform(SUN_PATCH_S).round();
        while t < day as f64 * DAY_S + SUN_S.1 {
            let lit_s = random.uniform(SUN_PATCH_S).round();
            let corners_s = [t, t + SUN_EDGE_S, t + lit_s - SUN_EDGE_S, t + lit_s];
            patches.push(Trapezoid { corners_s, height });
            t += lit_s + random.uniform(SUN_PATCH_S).round();
        }
    }
    patches
}
