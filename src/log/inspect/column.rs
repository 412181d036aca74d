//! What one column of a log holds, counted while its cells pass.
use super::resolution::Resolution;
use super::sketch::Sketch;
use crate::log::cell::Cell;

/// Largest jumps that are kept.
const JUMPS: usize = 8;
/// A change between two rows is a jump from so many usual ones on: ten times what 95 of 100 changes stay below.
const JUMP_RATIO: f64 = 10.0;
/// ... and from so many steps of the resolution on.
const JUMP_STEPS: f64 = 10.0;
/// Values below which nothing is usual yet.
const MIN_VALUES: u64 = 50;
/// What is left of a change when the next value has undone it, for a spike.
const SPIKE_REMAINDER: f64 = 0.3;

/// A change between two neighbours that is much larger than usual.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Line of the second value.
    pub line: u64,
    /// Value before, in the unit of the file.
    pub from: f64,
    /// Value after.
    pub to: f64,
    /// Whether the next value undid it.
    pub is_spike: bool,
}

/// Equal values in a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Run {
    /// The value, in the unit of the file.
    pub value: f64,
    /// How often.
    pub count: u64,
    /// Line of the first.
    pub line: u64,
    /// From its first to its last row, s.
    pub duration_s: f64,
}

/// Counts of a column, in the unit of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct Column {
    pub rows: u64,
    pub numbers: u64,
    pub missing: u64,
    pub others: u64,
    /// First cell that is no number and not missing.
    pub text: Option<String>,
    pub with_comma: u64,
    pub low: f64,
    pub high: f64,
    /// Smallest change that is none of rounding.
    smallest: f64,
    resolution: Resolution,
    pub longest: Run,
    run: Run,
    run_since_s: f64,
    values: Sketch,
    changes: Sketch,
    jumps: Vec<Jump>,
    last: Option<f64>,
    /// Change that the next value may undo, and its line.
    pending: Option<(Jump, f64)>,
}

impl Column {
    /// Takes in a cell.
    pub(super) fn push(&mut self, bytes: &[u8], decimal_comma: bool, line: u64, time_s: f64) {
        self.rows += 1;
        let cell = Cell::read(bytes, decimal_comma);
        match cell {
            Cell::Number(value) | Cell::WithComma(value) => {
                self.with_comma += u64::from(matches!(cell, Cell::WithComma(_)));
                self.resolution.push(bytes);
                self.number(value, line, time_s);
            }
            Cell::Missing => self.missing += 1,
            Cell::Infinite | Cell::Unreadable => {
                self.others += 1;
                self.text.get_or_insert_with(|| crate::log::cell::shown(bytes));
            }
        }
    }

    /// Median of the values.
    pub(super) fn median(&self) -> f64 {
        self.values.quantile(0.5)
    }

    /// Step of the digits, or else the smallest change; infinite where nothing changes.
    pub(super) fn step(&self) -> f64 {
        self.resolution.step().unwrap_or(self.smallest)
    }

    /// Jumps in the order of their lines.
    pub(super) fn jumps(&self) -> Vec<Jump> {
        if self.numbers < MIN_VALUES {
            return Vec::new();
        }
        let usual = self.changes.quantile(0.95).max(self.step() * JUMP_STEPS / JUMP_RATIO);
        let all = self.jumps.iter().chain(self.pending.as_ref().map(|(jump, _)| jump));
        let mut jumps: Vec<Jump> =
            all.filter(|jump| (jump.to - jump.from).abs() > JUMP_RATIO * usual).cloned().collect();
        jumps.sort_by_key(|jump| jump.line);
        jumps
    }

    fn number(&mut self, value: f64, line: u64, time_s: f64) {
        if self.numbers == 0 {
            (self.low, self.high, self.smallest) = (value, value, f64::INFINITY);
        }
        self.numbers += 1;
        (self.low, self.high) = (self.low.min(value), self.high.max(value));
        self.values.push(value);
        if let Some(last) = self.last {
            self.change(last, value, line);
        }
        // An exact comparison on purpose: the last digit counts.
        if self.last == Some(value) {
            self.run.count += 1;
        } else {
            (self.run, self.run_since_s) = (Run { value, count: 1, line, duration_s: 0.0 }, time_s);
        }
        self.run.duration_s = time_s - self.run_since_s;
        if self.run.count > self.longest.count {
            self.longest = self.run;
        }
        self.last = Some(value);
    }

    fn change(&mut self, from: f64, to: f64, line: u64) {
        let size = (to - from).abs();
        self.changes.push(size);
        if size > 1e-9 * (from.abs() + to.abs()) {
            self.smallest = self.smallest.min(size);
        }
        if let Some((mut jump, back)) = self.pending.take() {
            jump.is_spike = (to - back).abs() < SPIKE_REMAINDER * (jump.to - jump.from).abs();
            let is_return = jump.is_spike;
            self.keep(jump);
            if is_return {
                return;
            }
        }
        let smallest =
            self.jumps.iter().map(|jump| (jump.to - jump.from).abs()).fold(f64::INFINITY, f64::min);
        if size > 0.0 && (self.jumps.len() < JUMPS || size > smallest) {
            self.pending = Some((Jump { line, from, to, is_spike: false }, from));
        }
    }

    /// Keeps a change if it is one of the largest.
    fn keep(&mut self, jump: Jump) {
        self.jumps.push(jump);
        if self.jumps.len() > JUMPS {
            let size = |jump: &Jump| (jump.to - jump.from).abs();
            let smallest =
                (0..self.jumps.len()).min_by(|&a, &b| size(&self.jumps[a]).total_cmp(&size(&self.jumps[b])));
            smallest.map(|at| self.jumps.swap_remove(at));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(values: impl Iterator<Item = f64>) -> Column {
        let mut column = Column::default();
        for (k, value) in values.enumerate() {
            column.push(format!("{value:.2}").as_bytes(), false, k as u64 + 2, 60.0 * k as f64);
        }
        column
    }

    #[test]
    fn range_step_and_longest_run_are_those_of_the_cells() {
        let column = column((0..100).map(|k| if k < 40 { 5.0 } else { 5.0 + 0.25 * f64::from(k) }));
        assert_eq!((column.low, column.high, column.step()), (5.0, 29.75, 0.25));
        assert_eq!(column.longest, Run { value: 5.0, count: 40, line: 2, duration_s: 2340.0 });
    }

    #[test]
    fn a_spike_comes_back_and_a_jump_stays() {
        let noise = |k: i32| 20.0 + 0.1 * f64::from(k % 3);
        let column = column((0..200).map(|k| match k {
            60 => 85.0,
            120.. => noise(k) + 30.0,
            _ => noise(k),
        }));
        let found: Vec<(u64, bool)> = column.jumps().iter().map(|jump| (jump.line, jump.is_spike)).collect();
        assert_eq!(found, [(62, true), (122, false)]);
    }

    #[test]
    fn a_column_that_only_wanders_has_no_jump() {
        let column = column((0..500).map(|k| 15.0 + 10.0 * (f64::from(k) / 40.0).sin()));
        assert!(column.jumps().is_empty(), "{:?}", column.jumps());
    }
}
