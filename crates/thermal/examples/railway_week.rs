//! Writes the table of the scenario `railway-week`: a made-up winter week under a rail vehicle.
//!
//! `cargo run -p cylwatch-thermal --example railway_week > scenarios/railway-week.csv`
//!
//! The knots come from a seeded generator that uses arithmetic alone, so that every machine writes the same
//! file. Air: a mean near 0 degC that wanders from day to day, a day cycle of 5 K either way (coldest at 3 h,
//! warmest at 15 h), and 3 to 6 tunnels a day that are 42 to 48 K warmer, entered and left at 3 K/s. Wind: the
//! train's speed, in trips between stops from 5 h to 23 h. Sun: a parabola from 8 h to 16 h, dimmed by clouds,
//! none in tunnels.
use std::fmt::Write as _;
use std::io::Write as _;

const DAY_S: i64 = 86_400;
const HOUR_S: i64 = 3_600;
const DAYS: i64 = 7;
const SEED: u64 = 20_260_101;

/// Generator splitmix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A whole number from `low` to `high`, both included.
    fn whole(&mut self, low: i64, high: i64) -> i64 {
        low + (self.next() % (high - low + 1) as u64) as i64
    }
}

/// A rise from zero to a height and back: corners in s.
struct Trapezoid {
    corners_s: [i64; 4],
    height: f64,
}

impl Trapezoid {
    fn at(&self, t_s: i64) -> f64 {
        let [a, b, c, d] = self.corners_s;
        match t_s {
            t if t <= a || t >= d => 0.0,
            t if t < b => self.height * (t - a) as f64 / (b - a) as f64,
            t if t > c => self.height * (d - t) as f64 / (d - c) as f64,
            _ => self.height,
        }
    }
}

/// Linear interpolation of hourly values.
fn hourly(values: &[f64], t_s: i64) -> f64 {
    let hour = (t_s / HOUR_S) as usize;
    let weight = (t_s % HOUR_S) as f64 / HOUR_S as f64;
    let next = values.get(hour + 1).unwrap_or(&values[hour]);
    values[hour] + weight * (next - values[hour])
}

/// Half a wave from 0 over 1 back to 0 on 0 to 1.
fn arch(x: f64) -> f64 {
    4.0 * x * (1.0 - x)
}

fn trips(random: &mut Random) -> Vec<Trapezoid> {
    let mut trips = Vec::new();
    for day in 0..DAYS {
        let mut t = day * DAY_S + 5 * HOUR_S + random.whole(0, 30) * 60;
        while t < day * DAY_S + 22 * HOUR_S {
            let (ramp, cruise) = (random.whole(60, 240), random.whole(20, 75) * 60);
            let speed_m_s = random.whole(80, 300) as f64 / 10.0;
            let corners_s = [t, t + ramp, t + ramp + cruise, t + 2 * ramp + cruise];
            trips.push(Trapezoid { corners_s, height: speed_m_s });
            t = corners_s[3] + random.whole(3, 20) * 60;
        }
    }
    trips
}

fn tunnels(random: &mut Random) -> Vec<Trapezoid> {
    let mut tunnels = Vec::new();
    for day in 0..DAYS {
        let count = random.whole(3, 6);
        // One tunnel in each equal part of the service day, so that none overlap.
        let part_s = 17 * HOUR_S / count;
        for i in 0..count {
            let (ramp, stay) = (random.whole(14, 16), random.whole(20, 35) * 60);
            let start = day * DAY_S + 5 * HOUR_S + i * part_s + random.whole(0, part_s - stay - 60);
            let corners_s = [start, start + ramp, start + ramp + stay, start + 2 * ramp + stay];
            tunnels.push(Trapezoid { corners_s, height: 3.0 * ramp as f64 });
        }
    }
    tunnels
}

/// Hourly air temperature outside tunnels, degC, and irradiance, W/m².
fn weather(random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    let daily: Vec<f64> = (0..=DAYS).map(|_| random.whole(-25, 25) as f64 / 10.0).collect();
    let clouds: Vec<f64> = (0..=DAYS).map(|_| random.whole(20, 100) as f64 / 100.0).collect();
    (0..=DAYS * 24)
        .map(|hour| {
            let (day, of_day) = ((hour / 24) as usize, hour % 24);
            let weight = of_day as f64 / 24.0;
            let mean = daily[day] + weight * (daily.get(day + 1).unwrap_or(&daily[day]) - daily[day]);
            let since_9 = (of_day + 24 - 9) % 24;
            let cycle =
                if since_9 < 12 { arch(since_9 as f64 / 12.0) } else { -arch((since_9 - 12) as f64 / 12.0) };
            let sun = if (8..=16).contains(&of_day) { arch((of_day - 8) as f64 / 8.0) } else { 0.0 };
            (mean + 5.0 * cycle, 450.0 * clouds[day] * sun)
        })
        .unzip()
}

/// The whole table as CSV.
pub(crate) fn table() -> String {
    let mut random = Random(SEED);
    let (air_degc, irradiance_w_m2) = weather(&mut random);
    let (trips, tunnels) = (trips(&mut random), tunnels(&mut random));
    let corners = trips.iter().chain(&tunnels).flat_map(|trapezoid| trapezoid.corners_s);
    let mut knots_s: Vec<i64> = (0..=DAYS * 24).map(|hour| hour * HOUR_S).chain(corners).collect();
    knots_s.sort_unstable();
    knots_s.dedup();
    let mut text = String::from(
        "# Made-up week of a rail vehicle, written by `cargo run -p cylwatch-thermal --example railway_week`\n\
         time_s,ambient_degc,wind_m_s,irradiance_w_m2\n",
    );
    for t_s in knots_s {
        let tunnel: f64 = tunnels.iter().map(|tunnel| tunnel.at(t_s)).sum();
        let air = hourly(&air_degc, t_s) + tunnel;
        let wind: f64 = trips.iter().map(|trip| trip.at(t_s)).sum();
        let light = if tunnel > 0.0 { 0.0 } else { hourly(&irradiance_w_m2, t_s) };
        // Adding zero turns a rounded -0 into 0.
        let air = (air * 100.0).round() / 100.0 + 0.0;
        writeln!(text, "{t_s},{air:.2},{wind:.1},{light:.0}").expect("writing to a string cannot fail");
    }
    text
}

fn main() -> std::io::Result<()> {
    std::io::stdout().write_all(table().as_bytes())
}
