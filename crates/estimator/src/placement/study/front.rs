//! Pareto fronts: layouts that none is better than at their cost.
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{ALL_LAYOUTS, EvaluatedLayout, Placement};
use crate::EstimatorError;
use crate::placement::criterion::Criterion;
use crate::placement::search::{Method, SearchControl, search};

/// Layouts by cost and one number.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Front {
    /// Those that no other is better than, by rising cost.
    pub points: Vec<Point>,
    /// Every layout was looked at; else only those that are judged.
    pub complete: bool,
    /// Layouts that were compared.
    pub compared: usize,
}

/// A layout on a front.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Indices of its candidates.
    pub sensors: Vec<usize>,
    /// Cost.
    pub cost: f64,
    /// The number, SI.
    pub value: f64,
}

impl Front {
    /// Of points in any order.
    pub(crate) fn of(mut all: Vec<Point>, complete: bool) -> Self {
        let compared = all.len();
        let in_order = |a: &Point, b: &Point| {
            a.cost
                .total_cmp(&b.cost)
                .then(a.value.total_cmp(&b.value))
                .then_with(|| a.sensors.cmp(&b.sensors))
        };
        all.sort_by(in_order);
        let mut points: Vec<Point> = Vec::new();
        for point in all {
            if points.last().is_none_or(|last| point.value < last.value) {
                points.push(point);
            }
        }
        Self { points, complete, compared }
    }
}

impl Placement {
    /// Cost against gas temperature, and against the delay of the leak.
    pub(super) fn fronts(
        &self,
        judged: &[EvaluatedLayout],
        control: &SearchControl,
    ) -> Result<(Front, Front), EstimatorError> {
        let numbers = self.sensors();
        let complete = numbers.clone().map(|sensors| self.layouts(sensors)).sum::<f64>() <= ALL_LAYOUTS;
        let of_judged = |value: &dyn Fn(&EvaluatedLayout) -> Option<f64>| {
            let point = |of: &EvaluatedLayout| {
                Some(Point { sensors: of.sensors.clone(), cost: of.cost, value: value(of)? })
            };
            judged.iter().filter_map(point).collect::<Vec<_>>()
        };
        let mut by_gas = of_judged(&|of| Some(of.steady.gas_sd_k));
        let mut by_delay = of_judged(&|of| of.delay_s);
        if !complete || control.stop.load(std::sync::atomic::Ordering::Relaxed) {
            return Ok((Front::of(by_gas, false), Front::of(by_delay, false)));
        }
        let objective = Criterion::GasTemperature.objective(&self.steady, &self.scenarios)?;
        for sensors in numbers {
            let constraints = self.constraints(sensors);
            // A number that no layout can have adds nothing.
            let Ok(found) = search(&objective, &constraints, Method::Exhaustive, f64::INFINITY, control)
            else {
                continue;
            };
            let delays: Vec<Option<f64>> = found
                .layouts
                .par_iter()
                .map(|layout| self.steady.delay_s(&layout.sensors, self.settings.leak_kg_s))
                .collect::<Result<_, _>>()?;
            for (layout, delay_s) in found.layouts.into_iter().zip(delays) {
                let cost = constraints.cost(&layout.sensors);
                let point = |value| Point { sensors: layout.sensors.clone(), cost, value };
                by_delay.extend(delay_s.map(point));
                by_gas.push(point(layout.value.sqrt()));
            }
        }
        let complete = !control.stop.load(std::sync::atomic::Ordering::Relaxed);
        Ok((Front::of(by_gas, complete), Front::of(by_delay, complete)))
    }
}
