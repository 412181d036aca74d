//! Which rows and readings the small program holds, and how they join it.
//!
//! Of a run of violated samples only the worst joins at a time, since its neighbours mostly follow.
use nalgebra::DVector;

use super::constraint::{Constraint, Span, StageRow};
use super::interior_point;
use super::outcome::{FallbackReason, HorizonStatus};
use super::polish::polish;
use super::problem::{Active, Resolution, WindowProblem};
use super::program::{Basis, Optimum, Program, Row, Suspect};
use super::settings::Loss;
use super::window::WindowTrajectory;

/// Violation of a row, in its posterior standard deviations, that is left alone.
const VIOLATION_TOLERANCE: f64 = 1e-8;
/// Violation relative to the magnitudes in a row that may be rounding.
const ROUNDING: f64 = 1e-12;
/// Violation relative to the magnitudes in a row that nothing can move which makes the problem infeasible.
const INFEASIBLE: f64 = 1e-9;
/// Posterior standard deviation of a row, relative to those of its states, up to which nothing can move it.
const FIXED: f64 = 1e-12;
/// Overshoot of the loss's bend, relative, that is left alone.
const BEND_TOLERANCE: f64 = 1e-9;

/// The program and where its rows and suspects come from.
pub(super) struct ActiveSet<'a> {
    problem: &'a WindowProblem<'a>,
    /// The optimum without constraints.
    base: &'a WindowTrajectory,
    basis: Basis,
    program: Program,
    rows: Vec<Joined>,
    /// Interval and output of each suspect.
    suspects: Vec<(usize, usize)>,
}

struct Joined {
    spot: StageRow,
    /// Posterior standard deviation of the row.
    sd: f64,
}

/// A row at one place, and how far it is outside.
struct Violation {
    spot: StageRow,
    excess: f64,
    /// Sum of the magnitudes whose difference the excess is.
    magnitude: f64,
}

impl<'a> ActiveSet<'a> {
    pub(super) fn new(problem: &'a WindowProblem<'a>, base: &'a WindowTrajectory) -> Self {
        let delta = match problem.loss {
            Loss::Huber { delta } => delta,
            Loss::Quadratic => f64::INFINITY,
        };
        let program = Program { rank: 0, rows: Vec::new(), suspects: Vec::new(), delta };
        Self { problem, base, basis: Basis::default(), program, rows: Vec::new(), suspects: Vec::new() }
    }

    /// Let what `step` violates join; whether anything did. With the first violation come the `likely` rows.
    ///
    /// # Errors
    /// A violated row cannot be moved.
    pub(super) fn extend(
        &mut self,
        step: &WindowTrajectory,
        likely: &[StageRow],
    ) -> Result<bool, FallbackReason> {
        let before = (self.rows.len(), self.suspects.len());
        self.extend_suspects(step);
        let violations = self.violations(step);
        if self.rows.is_empty() && !violations.is_empty() {
            for &spot in likely.iter().filter(|spot| self.problem.holds(spot)) {
                self.join(&Violation { spot, excess: f64::INFINITY, magnitude: f64::INFINITY })?;
            }
        }
        for violation in violations {
            self.join(&violation)?;
        }
        Ok(before != (self.rows.len(), self.suspects.len()))
    }

    /// Readings beyond the loss's bend, and those weighted down: their weight is only a stand-in for the loss.
    fn extend_suspects(&mut self, step: &WindowTrajectory) {
        for (i, interval) in self.problem.intervals.iter().enumerate() {
            for reading in &interval.readings {
                let residual = interval.residual_after(reading, &step.x[i + 1]);
                let suspect =
                    reading.weight < 1.0 || residual.abs() > self.program.delta * (1.0 + BEND_TOLERANCE);
                if suspect && !self.suspects.contains(&(i, reading.output)) {
                    let a = interval.gradient.column(reading.output);
                    let derivative = self.problem.sweep.derivative_at(a.as_slice(), i + 1);
                    self.program.suspects.push(Suspect {
                        coordinates: self.basis.coordinates(&derivative),
                        residual: interval.residual_after(reading, &self.base.x[i + 1]),
                        weight: reading.weight,
                    });
                    self.suspects.push((i, reading.output));
                }
            }
        }
    }

    /// The worst places of every run of violated samples.
    fn violations(&self, step: &WindowTrajectory) -> Vec<Violation> {
        let states: Vec<_> = (0..step.x.len()).map(|i| self.problem.state(step, i)).collect();
        let mut found = Vec::new();
        for (row, constraint) in self.problem.constraints.iter().enumerate() {
            let spots = self.problem.spots(row);
            let excess: Vec<f64> = spots.iter().map(|s| excess_at(constraint, s.stage, &states)).collect();
            for (i, &spot) in spots.iter().enumerate() {
                let magnitude = constraint.magnitude(states[spot.stage].as_slice());
                let neighbours = [i.checked_sub(1).map(|j| excess[j]), excess.get(i + 1).copied()];
                let peak = neighbours.iter().flatten().all(|other| excess[i] >= *other);
                if peak && excess[i] > ROUNDING * magnitude && self.rows.iter().all(|j| j.spot != spot) {
                    found.push(Violation { spot, excess: excess[i], magnitude });
                }
            }
        }
        found
    }

    /// Let one row join, unless it has or is violated by next to nothing.
    fn join(&mut self, violation: &Violation) -> Result<(), FallbackReason> {
        let &Violation { spot, excess, magnitude } = violation;
        if self.rows.iter().any(|joined| joined.spot == spot) {
            return Ok(());
        }
        let constraint = &self.problem.constraints[spot.row];
        let derivative = self.problem.sweep.derivative(constraint, spot);
        let sd = derivative.iter().map(|d| d * d).sum::<f64>().sqrt();
        let reference: f64 = constraint.terms().iter().map(|&(k, a)| a.abs() * self.problem.spread[k]).sum();
        if sd <= FIXED * reference {
            let infeasible = excess > INFEASIBLE * magnitude;
            return if infeasible { Err(FallbackReason::Infeasible) } else { Ok(()) };
        }
        if excess <= VIOLATION_TOLERANCE * sd {
            return Ok(());
        }
        let scaled: Vec<f64> = derivative.iter().map(|d| d / sd).collect();
        let inside = -self.problem.excess(self.base, spot);
        self.program.rows.push(Row { coordinates: self.basis.coordinates(&scaled), gap: inside / sd });
        self.rows.push(Joined { spot, sd });
        Ok(())
    }

    /// Solve the program as it is.
    ///
    /// # Errors
    /// Why there is no solution.
    pub(super) fn solve(&mut self, resolution: &mut Resolution) -> Result<(), FallbackReason> {
        self.program.rank = self.basis.rank();
        let solved = interior_point::solve(&self.program)?;
        let polished = polish(&self.program, &solved.optimum);
        resolution.qp_solves += 1;
        resolution.qp_iterations += solved.iterations;
        // A polished optimum has met the optimality conditions, however the solver ended.
        resolution.status = if solved.almost && polished.is_none() {
            HorizonStatus::AlmostSolved
        } else {
            HorizonStatus::Solved
        };
        let optimum = polished.unwrap_or(solved.optimum);
        let sweep = self.problem.sweep;
        let eta = self.basis.combine(optimum.v.as_slice(), sweep.drives());
        resolution.step = sweep.run(Some(&eta));
        resolution.active = self.active(&optimum);
        Ok(())
    }

    /// Of a row's distance and its multiplier, one is zero; rounding leaves the larger in doubt about neither.
    fn active(&self, optimum: &Optimum) -> Vec<Active> {
        let distance = self.program.gaps() - self.program.row_matrix() * &optimum.v;
        let pushing = |&(i, _): &(usize, &Joined)| optimum.multipliers[i] > distance[i].max(0.0);
        let rows = self.rows.iter().enumerate().filter(pushing);
        rows.map(|(i, row)| Active { spot: row.spot, multiplier: optimum.multipliers[i] / row.sd }).collect()
    }
}

fn excess_at(constraint: &Constraint, stage: usize, states: &[DVector<f64>]) -> f64 {
    constraint.excess(states[stage.saturating_sub(1)].as_slice(), states[stage].as_slice())
}

impl WindowProblem<'_> {
    /// Places in the window where a row holds.
    fn spots(&self, row: usize) -> Vec<StageRow> {
        (0..=self.intervals.len())
            .map(|stage| StageRow { row, stage })
            .filter(|spot| self.holds(spot))
            .collect()
    }

    /// Whether a row holds there. One on constants alone has a single place, at the start.
    fn holds(&self, spot: &StageRow) -> bool {
        let constraint = &self.constraints[spot.row];
        match constraint.span() {
            Span::State => spot.stage == 0 || !constraint.is_on_constants(self.sweep.leading()),
            Span::Step => spot.stage > 0,
        }
    }

    fn excess(&self, step: &WindowTrajectory, spot: StageRow) -> f64 {
        let before = self.state(step, spot.stage.saturating_sub(1));
        let constraint = &self.constraints[spot.row];
        constraint.excess(before.as_slice(), self.state(step, spot.stage).as_slice())
    }
}
