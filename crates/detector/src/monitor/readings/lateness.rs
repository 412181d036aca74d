//! Channels that are late: by how much, and rows in which all readings are of one time.
//!
//! The air jumps at the mouth of a tunnel, and every thermometer on the surface reads a part of it at once; what comes after is slow.
//! Second differences `d` of readings on an even grid show little but these jumps, so the cross-correlation
//!
//! `c(l) = sum_n d_a(n) d_b(n - l)`
//!
//! of two thermometers has a narrow peak at the difference of their delays; a parabola through it gives that to a tenth of a step. The
//! gas follows a jump smoothly. Where a thermometer's second difference is a jump and its reverse, `c` with the pressure changes
//! its sign once, and at a grid of a minute it does so 0.34 +- 0.15 minutes before none is late. Both numbers do not rest on the
//! observer; they are those of 150 days of 30 cylinders with different films, capacities and couplings (`truth`), as is the share
//! of 0.6 to 0.97 that the peak has of the largest that there can be.
//!
//! A difference is believed from 0.4 steps between thermometers and from 0.75 steps between them and the pressure. The channels that are
//! early are then held back by whole rows ([`DelayLine`]): interpolation would smear spikes and unstick what is stuck.
//!
//! # What it assumes
//! Two thermometers on the surface without a lag of their own that is stated (the observer has those), delays that stay, below four steps. The
//! grid is that of the rows, but not below a minute.
use alloc::collections::VecDeque;
use alloc::vec::Vec;

use crate::DetectorError;
use crate::monitor::intake::Readings;
use crate::monitor::restored::{self, Restored};
use crate::units::MINUTE_S;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

/// Shortest step of the grid, s, and the longest.
const LONGEST_STEP_S: f64 = 300.0;
/// Time over which rows are counted for it, s.
const COUNTED_S: f64 = 3600.0;
/// Steps that two rows around a point of the grid may be apart.
const BRIDGED: f64 = 1.25;
/// Longest difference that is looked for, steps.
const LONGEST: usize = 4;
/// Points that a second difference needs.
const POINTS: usize = 3;
const LAGS: usize = 2 * LONGEST + 1;
/// Least sum of products at the peak, in squared errors of a surface temperature, and its least part of the largest that there can be; the same of the pressure.
const LEAST: f64 = 700.0;
const LEAST_PART: f64 = 0.5;
const LEAST_PART_PRESSURE: f64 = 0.12;
/// Where the correlation with the pressure changes its sign if none is late, steps of a minute.
const NONE_LATE: f64 = -0.34;
/// Differences that are believed, steps.
const APART: f64 = 0.4;
const APART_PRESSURE: f64 = 0.75;

/// Readings of two thermometers, in errors of a surface temperature, and of the pressure, Pa.
/// What no channel that was found late is late by, s: four steps of five minutes, and the pressure as much after the other one.
const LONGEST_DELAY_S: f64 = 3600.0;

type Three = [f64; 3];
const NONE: Three = [f64::NAN; 3];

/// Sums of products of two channels at every lag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Correlation {
    products: [f64; LAGS],
    squares: [f64; 2],
}

impl Correlation {
    /// The pairs that the newest of the differences, `recent[0]`, makes with itself and those before it.
    fn add(&mut self, recent: &[Three], (a, b): (usize, usize)) {
        let Some(newest) = recent.first() else { return };
        for (lag, older) in recent.iter().enumerate() {
            self.count(LONGEST + lag, newest[a] * older[b]);
            if lag > 0 {
                self.count(LONGEST - lag, older[a] * newest[b]);
            }
        }
        for (sum, of) in self.squares.iter_mut().zip([newest[a], newest[b]]) {
            *sum += if of.is_finite() { of * of } else { 0.0 };
        }
    }

    fn count(&mut self, at: usize, product: f64) {
        if product.is_finite() {
            self.products[at] += product;
        }
    }

    fn largest(&self) -> usize {
        let inner = 1..LAGS - 1;
        inner.max_by(|i, j| self.products[*i].total_cmp(&self.products[*j])).unwrap_or(LONGEST)
    }

    /// Part of the largest that there can be.
    fn part(&self, at: usize) -> f64 {
        self.products[at] / libm::sqrt(self.squares[0] * self.squares[1])
    }

    /// Steps by which the first channel is later, by the peak.
    fn peak(&self) -> Option<f64> {
        let at = self.largest();
        if !(self.products[at] > LEAST && self.part(at) > LEAST_PART) {
            return None;
        }
        let [before, peak, after] = [at - 1, at, at + 1].map(|i| self.products[i]);
        Some(at as f64 - LONGEST as f64 + 0.5 * (before - after) / (before - 2.0 * peak + after))
    }

    /// Steps at which the sign changes after the largest.
    fn change_of_sign(&self) -> Option<f64> {
        let at = self.largest();
        if self.part(at).is_nan() || self.part(at) < LEAST_PART_PRESSURE {
            return None;
        }
        let before = (at..LAGS - 1).find(|i| self.products[i + 1] <= 0.0)?;
        let (here, next) = (self.products[before], self.products[before + 1]);
        Some(before as f64 - LONGEST as f64 + here / (here - next))
    }
}

/// Points of an even grid, linear between rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Grid {
    begun_s: Option<f64>,
    rows: u32,
    step_s: f64,
    next_s: f64,
    last: Option<(f64, Three)>,
}

impl Grid {
    /// Checks one that was saved.
    fn validate(&self) -> Result<(), DetectorError> {
        restored::count("lags.rows", self.rows.into())?;
        if self.step_s == 0.0 {
            return Ok(());
        }
        let usual = (MINUTE_S..=LONGEST_STEP_S).contains(&self.step_s);
        restored::require(usual, "lags.step_s", self.step_s, "0, or between 60 and 300 s")?;
        let next = self.last.is_none_or(|(last_s, _)| (self.next_s - last_s).abs() <= 2.0 * self.step_s);
        restored::require(next, "lags.next_s", self.next_s, "at most two steps from the last row")
    }

    /// The points up to a row; `None` among them where no row is near.
    fn push(&mut self, time_s: f64, readings: Three, mut point: impl FnMut(Three)) {
        let begun_s = *self.begun_s.get_or_insert(time_s);
        if self.step_s == 0.0 {
            self.rows += 1;
            if time_s - begun_s < COUNTED_S {
                return;
            }
            let minutes = libm::ceil((time_s - begun_s) / f64::from(self.rows - 1) / MINUTE_S - 0.1);
            self.step_s = (MINUTE_S * minutes.max(1.0)).min(LONGEST_STEP_S);
            self.next_s = time_s + self.step_s;
        }
        let Some((last_s, last)) = self.last.replace((time_s, readings)) else { return };
        if time_s - last_s > BRIDGED * self.step_s {
            if time_s > self.next_s {
                self.next_s = time_s + self.step_s;
                point(NONE);
            }
            return;
        }
        while self.next_s <= time_s {
            let weight = (self.next_s - last_s) / (time_s - last_s);
            point(core::array::from_fn(|i| last[i] + weight * (readings[i] - last[i])));
            self.next_s += self.step_s;
        }
    }
}

/// Learns by how much which channel is late.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct LagMeter {
    grid: Grid,
    /// The last three points, newest first, and the last differences.
    points: SmallVec<[Three; POINTS]>,
    differences: SmallVec<[Three; LONGEST + 1]>,
    thermometers: Correlation,
    with_pressure: [Correlation; 2],
}

impl LagMeter {
    /// Checks one that was saved.
    pub(super) fn validate(&self) -> Result<(), DetectorError> {
        restored::at_most(POINTS, "lags.points", self.points.len())?;
        restored::at_most(LONGEST + 1, "lags.differences", self.differences.len())?;
        self.grid.validate()
    }

    /// Take in two thermometers, in errors of a surface temperature, and the pressure, Pa; NaN where there is none.
    pub(crate) fn push(&mut self, time_s: f64, readings: Three) {
        let Self { grid, points, differences, thermometers, with_pressure } = self;
        grid.push(time_s, readings, |point| {
            push_front(points, point, POINTS);
            let [newest, middle, oldest] = [0, 1, 2].map(|i| points.get(i).copied().unwrap_or(NONE));
            let second = core::array::from_fn(|i| newest[i] - 2.0 * middle[i] + oldest[i]);
            push_front(differences, second, LONGEST + 1);
            thermometers.add(differences, (0, 1));
            with_pressure[0].add(differences, (0, 2));
            with_pressure[1].add(differences, (1, 2));
        });
    }

    /// How late each of the three is, s, against the earliest; `None` before the air has jumped often enough.
    pub(crate) fn late_s(&self) -> Option<Three> {
        let apart = self.thermometers.peak()?;
        let apart = if apart.abs() < APART { 0.0 } else { apart };
        let late = [apart.max(0.0), (-apart).max(0.0)];
        let pressure = self.pressure_late(late).unwrap_or(late[0].min(late[1]));
        let earliest = pressure.min(0.0);
        Some([late[0], late[1], pressure].map(|steps| (steps - earliest) * self.grid.step_s))
    }

    /// Steps by which the pressure is late, on the scale of the thermometers; with the nearer one of them unless it is far from both.
    fn pressure_late(&self, late: [f64; 2]) -> Option<f64> {
        if self.grid.step_s > MINUTE_S {
            return None;
        }
        let by = |i: usize| Some(late[i] - (self.with_pressure[i].change_of_sign()? - NONE_LATE));
        let pressure = 0.5 * (by(0)? + by(1)?);
        let nearest = if (pressure - late[0]).abs() < (pressure - late[1]).abs() { late[0] } else { late[1] };
        Some(if (pressure - nearest).abs() < APART_PRESSURE { nearest } else { pressure })
    }
}

fn push_front<A: smallvec::Array<Item = Three>>(queue: &mut SmallVec<A>, newest: Three, longest: usize) {
    queue.truncate(longest - 1);
    queue.insert(0, newest);
}

/// Holds early channels back, by whole rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct DelayLine {
    /// By how much each sensor is held back, s; empty: none is.
    delays_s: Vec<f64>,
    rows: VecDeque<(f64, Readings)>,
}

impl DelayLine {
    /// Checks one that was saved.
    pub(crate) fn validate(&self, of: &Restored) -> Result<(), DetectorError> {
        if self.delays_s.is_empty() {
            return restored::require(
                self.rows.is_empty(),
                "delays.rows",
                self.rows.len() as f64,
                "0 without delays",
            );
        }
        of.each("delays.delays_s", self.delays_s.len())?;
        for &delay_s in &self.delays_s {
            let measured = (0.0..=LONGEST_DELAY_S).contains(&delay_s);
            restored::require(measured, "delays.delays_s", delay_s, "between 0 and 1 h")?;
        }
        self.rows.iter().try_for_each(|(time_s, readings)| {
            of.each("delays.rows", readings.len())?;
            of.time("delays.rows", *time_s)
        })
    }

    /// Hold each sensor back by so much, s.
    pub(crate) fn of(delays_s: Vec<f64>) -> Self {
        Self { delays_s, rows: VecDeque::new() }
    }

    /// The readings of a row at the time that all have.
    pub(crate) fn align(&mut self, time_s: f64, readings: &mut [f64]) {
        let longest_s = self.delays_s.iter().copied().fold(0.0, f64::max);
        if longest_s == 0.0 {
            return;
        }
        self.rows.push_back((time_s, Readings::from_slice(readings)));
        // One row before the longest delay, which may be nearer to it than that after it.
        while self.rows.get(1).is_some_and(|(second_s, _)| *second_s <= time_s - longest_s) {
            self.rows.pop_front();
        }
        for (sensor, delay_s) in self.delays_s.iter().enumerate().filter(|(_, delay_s)| **delay_s > 0.0) {
            let off_s = |row: &&(f64, Readings)| (row.0 - (time_s - delay_s)).abs();
            if let Some((_, row)) = self.rows.iter().min_by(|a, b| off_s(a).total_cmp(&off_s(b))) {
                readings[sensor] = row[sensor];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A day of tunnels: thermometers that read a part of the air at once and a wall after it, a gas after the wall; each by so
    /// many seconds late.
    fn measured(late_s: Three, row_s: f64, hours: f64) -> LagMeter {
        let mut meter = LagMeter::default();
        let rows = (hours * 3600.0 / row_s) as usize;
        let mut course = Vec::new();
        let (mut wall_k, mut gas_k) = (270.0, 270.0);
        for second in 0..(hours * 3600.0) as usize {
            let phase_s = (second + 1200) % 10_800;
            let air_k = if phase_s < 1733 { 310.0 } else { 270.0 };
            wall_k += (air_k - wall_k) / 900.0;
            gas_k += (wall_k - gas_k) / 330.0;
            course.push([wall_k + 0.12 * (air_k - wall_k), wall_k + 0.07 * (air_k - wall_k), 6.5e4 * gas_k]);
        }
        for row in 0..rows {
            let time_s = row as f64 * row_s;
            let noise = |i: usize| ((row * (7 + 4 * i)) % 13) as f64 - 6.0;
            let of = |i: usize| course[((time_s - late_s[i]).max(0.0)) as usize][i];
            let scale = [0.12, 0.12, 1.0];
            let readings = std::array::from_fn(|i| (of(i) + [0.01, 0.01, 150.0][i] * noise(i)) / scale[i]);
            meter.push(time_s, readings);
        }
        meter
    }

    #[test]
    fn what_is_late_is_found_to_half_a_step() {
        for late_s in [
            [0.0; 3],
            [60.0, 0.0, 0.0],
            [0.0, 60.0, 0.0],
            [100.0, 0.0, 0.0],
            [0.0, 0.0, 110.0],
            [0.0, 0.0, 75.0],
        ] {
            for row_s in [10.0, 60.0] {
                let found = measured(late_s, row_s, 24.0).late_s().expect("tunnels enough");
                for (found_s, late_s) in found.into_iter().zip(late_s) {
                    assert!((found_s - late_s).abs() < 30.0, "{found:?} for {late_s:?}, rows of {row_s} s");
                }
            }
        }
        let coarse = measured([240.0, 0.0, 0.0], 120.0, 24.0).late_s().expect("tunnels enough");
        assert!((coarse[0] - 240.0).abs() < 60.0 && coarse[1..] == [0.0; 2], "{coarse:?}");
    }

    #[test]
    fn without_a_tunnel_nothing_is_said() {
        assert_eq!(measured([60.0, 0.0, 0.0], 60.0, 0.3).late_s(), None);
        let mut meter = LagMeter::default();
        (0..2880).for_each(|n| {
            meter.push(60.0 * f64::from(n), [280.0, 280.0 + 0.01 * f64::from(n % 7), f64::NAN])
        });
        assert_eq!(meter.late_s(), None);
    }

    #[test]
    fn the_early_ones_are_held_back_by_whole_rows() {
        let mut line = DelayLine::of(vec![0.0, 100.0, 120.0]);
        let mut aligned = Vec::new();
        for n in 0..5 {
            let n = f64::from(n);
            let mut row = vec![n, 10.0 + n, 20.0 + n];
            line.align(60.0 * n, &mut row);
            aligned.push(row);
        }
        assert_eq!(aligned[4], [4.0, 12.0, 22.0]);
        assert_eq!(aligned[1], [1.0, 10.0, 20.0], "at first the oldest there is");
        let mut none = DelayLine::default();
        let mut row = vec![1.0, f64::NAN];
        none.align(0.0, &mut row);
        assert!(row[0] == 1.0 && row[1].is_nan());
    }
}
