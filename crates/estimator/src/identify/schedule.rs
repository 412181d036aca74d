//! The record cut where the input bends or the output is sampled.
//!
//! A dead time shifts the bends against the samples by anything, so that an interval between output samples may hold
//! several bends. On each piece the input is straight, and the response exact.
use super::{Hold, problem::Problem};

/// Instants within this share of the median interval count as one.
const INTERVAL_TOLERANCE: f64 = 1e-10;

/// A part of the record with straight input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub duration: f64,
    /// Input sample before it; the input runs from `from` to `to` of the way to the next sample.
    pub left: usize,
    pub from: f64,
    pub to: f64,
    /// Whether it begins where that sample acts.
    pub fresh: bool,
    /// Output sample at its end.
    pub output: Option<usize>,
}

impl Piece {
    /// Input at its start and end.
    pub(super) fn input(&self, u: &[f64]) -> (f64, f64) {
        let at = |share: f64| {
            if share == 0.0 { u[self.left] } else { u[self.left] + share * (u[self.left + 1] - u[self.left]) }
        };
        (at(self.from), at(self.to))
    }
}

/// All pieces of a record.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Schedule {
    /// Output sample at the very start.
    pub initial: Option<usize>,
    pub pieces: Vec<Piece>,
}

/// Where the cutting stands.
struct Cursor<'a> {
    problem: &'a Problem,
    dead_time: f64,
    tolerance: f64,
    time: f64,
    left: usize,
    /// Next input sample to act.
    next: usize,
    fresh: bool,
    pieces: Vec<Piece>,
}

impl Schedule {
    /// Cut a record whose input acts after a dead time.
    pub(super) fn new(problem: &Problem, dead_time: f64) -> Self {
        let mut cursor = Cursor {
            problem,
            dead_time,
            tolerance: INTERVAL_TOLERANCE * problem.interval(),
            time: 0.0,
            left: 0,
            next: 0,
            fresh: false,
            pieces: Vec::with_capacity(problem.samples() + problem.u.len()),
        };
        let mut initial = None;
        for (output, &time) in problem.output_time.iter().enumerate() {
            cursor.advance(time);
            if time <= cursor.tolerance && cursor.pieces.is_empty() {
                initial = Some(output);
            } else {
                cursor.cut(time, Some(output));
            }
        }
        Self { initial, pieces: cursor.pieces }
    }

    /// Whether all pieces are alike: each an interval from input sample to input sample with an output at its end.
    pub(super) fn is_uniform(&self) -> bool {
        let Some(first) = self.pieces.first() else { return false };
        self.initial.is_some()
            && self.pieces.iter().all(|piece| {
                piece.fresh
                    && piece.output.is_some()
                    && piece.to == first.to
                    && (piece.duration - first.duration).abs() <= 1e-9 * first.duration
            })
    }
}

impl Cursor<'_> {
    fn acts(&self, sample: usize) -> Option<f64> {
        self.problem.input_time.get(sample).map(|time| time + self.dead_time)
    }

    /// Cut at every input sample before `time`.
    fn advance(&mut self, time: f64) {
        while let Some(acts) = self.acts(self.next).filter(|acts| *acts < time - self.tolerance) {
            if acts > self.time + self.tolerance {
                self.cut(acts, None);
            }
            self.left = self.next;
            self.next += 1;
            self.fresh = true;
        }
    }

    fn cut(&mut self, to: f64, output: Option<usize>) {
        let (from_share, to_share) = (self.share(self.time), self.share(to));
        self.pieces.push(Piece {
            duration: to - self.time,
            left: self.left,
            from: if self.fresh { 0.0 } else { from_share },
            to: to_share,
            fresh: self.fresh,
            output,
        });
        self.time = to;
        self.fresh = false;
    }

    /// How far the input is from the sample that acts to the next one.
    fn share(&self, time: f64) -> f64 {
        match (self.problem.hold, self.acts(self.left), self.acts(self.left + 1)) {
            (Hold::First, Some(from), Some(to)) if self.next > self.left => {
                let share = ((time - from) / (to - from)).clamp(0.0, 1.0);
                if to - time <= self.tolerance { 1.0 } else { share }
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::Data;

    fn problem(hold: Hold, output: Vec<f64>) -> Problem {
        let time_s: Vec<f64> = (0..output.len()).map(|k| k as f64).collect();
        let input = (0..output.len()).map(|k| (k * k) as f64).collect();
        Problem::new(&Data::try_new(time_s, input, output, hold).unwrap(), None, None, 0).unwrap()
    }

    #[test]
    fn without_dead_time_each_interval_is_a_piece() {
        let problem = problem(Hold::First, vec![1.0, 2.0, 4.0, 3.0]);
        let schedule = Schedule::new(&problem, 0.0);
        assert_eq!((schedule.initial, schedule.pieces.len()), (Some(0), 3));
        assert!(schedule.is_uniform());
        for (k, piece) in schedule.pieces.iter().enumerate() {
            assert_eq!((piece.left, piece.from, piece.to, piece.output), (k, 0.0, 1.0, Some(k + 1)));
            assert_eq!(piece.input(&problem.u), (problem.u[k], problem.u[k + 1]));
        }
    }

    #[test]
    fn a_dead_time_cuts_the_intervals_where_the_input_bends() {
        // A third of an interval beyond one whole: the input holds its first value, then bends within each interval.
        let problem = problem(Hold::First, vec![1.0, 2.0, 4.0, 3.0]);
        let interval = problem.interval();
        let schedule = Schedule::new(&problem, 4.0 / 3.0 * interval);
        let found: Vec<(usize, bool, Option<usize>)> =
            schedule.pieces.iter().map(|piece| (piece.left, piece.fresh, piece.output)).collect();
        assert_eq!(
            found,
            [(0, false, Some(1)), (0, false, None), (0, true, Some(2)), (0, false, None), (1, true, Some(3))]
        );
        let (from, to) = schedule.pieces[3].input(&problem.u);
        let step = problem.u[1] - problem.u[0];
        assert!((from - 2.0 / 3.0 * step).abs() < 1e-9 && (to - step).abs() < 1e-9);
        assert_eq!(schedule.pieces[1].input(&problem.u), (problem.u[0], problem.u[0]));
    }

    #[test]
    fn missing_outputs_leave_pieces_without_output() {
        let problem = problem(Hold::Zero, vec![1.0, f64::NAN, f64::NAN, 3.0]);
        let schedule = Schedule::new(&problem, 0.0);
        let outputs: Vec<Option<usize>> = schedule.pieces.iter().map(|piece| piece.output).collect();
        assert_eq!(outputs, [None, None, Some(1)]);
        assert!(schedule.pieces.iter().all(|piece| piece.fresh && piece.to == 0.0));
    }
}
