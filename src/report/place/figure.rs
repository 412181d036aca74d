//! A study as a picture: one thermometer at each place beside the cylinder, what accuracy costs, what a failure costs.
use super::outline::Outline;
use super::{GRAM_PER_HOUR, HOUR, KELVIN, MILLIMETRES, PlacementReport, Unit};
use crate::estimator::placement::Status;
use crate::estimator::placement::study::{EvaluatedLayout, Failure, Front, Position};
use crate::estimator::sensor::Site;
use crate::report::figure::style::{self, Stroke};
use crate::report::figure::{
    Cell, Column, Elevation, Figure, Grid, Horizontal, Item, Mark, Panel, Part, Picture, Place, Profile,
};
use crate::thermal::units;
use crate::thermal::wall::geometry::Orientation;

impl PlacementReport<'_> {
    /// Places beside the cylinder, cost, failures; parts that a partial study lacks are left out.
    pub fn figure(&self) -> Picture {
        let mut parts = vec![Part::Elevation(self.map())];
        // Layouts of one cost say nothing of what accuracy costs.
        let costs = || self.study.judged.iter().map(|judged| judged.cost);
        if costs().any(|cost| Some(cost) != costs().next()) {
            parts.push(Part::Figure(self.costs()));
        }
        if !self.study.failures.is_empty() {
            parts.push(Part::Grid(self.failures()));
        }
        Picture { title: format!("Where sensors should sit: {}", self.study.vessel), parts }
    }

    /// The cylinder with the best layout on it, and numbers against the height.
    fn map(&self) -> Elevation {
        let outline = Outline::of(self.vessel);
        let lies = self.vessel.geometry.orientation == Orientation::Horizontal;
        let best = self.study.numbers.last().and_then(|number| number.layouts.first());
        let partial = if self.is_partial() { " (partial)" } else { "" };
        let title = match best {
            Some(best) => format!(
                "Best {} sensors by the {}, and one anywhere{partial}",
                best.sensors.len(),
                self.study.settings.criterion.description()
            ),
            None => format!("One sensor anywhere{partial}"),
        };
        let sensors = best.map_or(&[][..], |best| &best.sensors);
        Elevation {
            title,
            height: format!("height along the axis{} in mm", if lies { ", which lies," } else { "" }),
            shapes: outline.shapes(),
            places: sensors.iter().map(|&sensor| self.place(sensor, &outline)).collect(),
            levels: self.levels(&outline),
            columns: self.columns(&outline),
        }
    }

    /// Where a sensor is drawn.
    fn place(&self, sensor: usize, outline: &Outline) -> Place {
        let on_wall = |height_mm: f64| (outline.radius_mm(height_mm), height_mm);
        let half_mm = 0.5 * outline.top_mm();
        let site = self.candidates.list.get(sensor).map(|candidate| candidate.sensor.site());
        let at = match (self.study.heights_m.get(sensor).copied().flatten(), site) {
            (Some(height_m), _) => on_wall(MILLIMETRES * height_m),
            (None, Some(Site::Surface(_))) => (outline.valve_radius_mm(), outline.valve_mm()),
            (None, Some(Site::Port)) => (0.0, outline.top_mm()),
            (None, Some(Site::Air)) => (1.12 * outline.radius_mm(half_mm), 0.2 * half_mm),
            (None, Some(Site::Gas(_)) | None) => (0.0, half_mm),
        };
        Place { at, name: self.name(sensor).to_owned() }
    }

    /// Shoulder and valve, where the paper has its sensors.
    fn levels(&self, outline: &Outline) -> Vec<Mark> {
        let level = |sensor: usize| {
            let name = self.asked_about(sensor)?.to_owned();
            let height_m = self.study.heights_m.get(sensor).copied().flatten();
            Some(Mark { at: height_m.map_or(outline.valve_mm(), |height_m| MILLIMETRES * height_m), name })
        };
        (0..self.study.candidates.len()).filter_map(level).collect()
    }

    fn columns(&self, outline: &Outline) -> Vec<Column> {
        let gas = |position: &Position| Some(position.steady?.gas_sd_k);
        let robust = |position: &Position| position.robust_k.first().copied();
        let smallest = |position: &Position| Some(position.steady?.smallest_leak_kg_s);
        let profile = |name: &str, unit, of: &dyn Fn(&Position) -> Option<f64>, stroke| {
            self.profile(name, unit, of, stroke, outline)
        };
        let mut accuracy = vec![profile("at rest", KELVIN, &gas, style::AT_REST)];
        if !self.study.scenarios.is_empty() {
            accuracy.push(profile("with model error", KELVIN, &robust, style::ROBUST));
        }
        accuracy.push(self.reference(KELVIN, &gas));
        let mut leaks = vec![profile("found in time", GRAM_PER_HOUR, &smallest, style::AT_REST)];
        leaks.push(self.reference(GRAM_PER_HOUR, &smallest));
        let column = |quantity: &str, profiles: Vec<Option<Profile>>| Column {
            quantity: quantity.into(),
            profiles: profiles.into_iter().flatten().collect(),
        };
        let mut columns =
            vec![column("sd of the gas temperature in K", accuracy), column("smallest leak in g/h", leaks)];
        columns.retain(|column| !column.profiles.is_empty());
        columns
    }

    /// A number at each place on the wall, and at the valve, which no line joins to the wall.
    fn profile(
        &self,
        name: &str,
        unit: Unit,
        of: &dyn Fn(&Position) -> Option<f64>,
        stroke: Stroke,
        outline: &Outline,
    ) -> Option<Profile> {
        let mut on_wall: Vec<(f64, f64)> = Vec::new();
        let mut at_valve = Vec::new();
        for position in &self.study.positions {
            let Some(value) = of(position).map(|si| unit.per_si * si) else { continue };
            match (position.height_m, self.asked_about(position.sensor)) {
                (Some(height_m), _) => on_wall.push((MILLIMETRES * height_m, value)),
                (None, Some(_)) => at_valve.extend([(f64::NAN, f64::NAN), (outline.valve_mm(), value)]),
                (None, None) => {}
            }
        }
        on_wall.sort_by(|a, b| a.0.total_cmp(&b.0));
        on_wall.extend(at_valve);
        let (heights, values): (Vec<f64>, Vec<f64>) = on_wall.into_iter().unzip();
        (!values.is_empty()).then(|| Profile { name: name.into(), values, heights, stroke })
    }

    /// What may not be chosen, as a line for all heights.
    fn reference(&self, unit: Unit, of: &dyn Fn(&Position) -> Option<f64>) -> Option<Profile> {
        let is_reference =
            |position: &&Position| position.height_m.is_none() && self.is(position.sensor, Status::Forbidden);
        let position = self.study.positions.iter().find(is_reference)?;
        let name = format!("{} (reference)", self.name(position.sensor));
        let values = vec![unit.per_si * of(position)?];
        Some(Profile { name, values, heights: Vec::new(), stroke: style::REFERENCE })
    }

    /// Fronts of cost against certainty and against the delay, with the judged layouts behind them.
    fn costs(&self) -> Figure {
        let study = self.study;
        let gas = |judged: &EvaluatedLayout| Some(judged.steady.gas_sd_k);
        let leak = GRAM_PER_HOUR.with_symbol(study.settings.leak_kg_s);
        let panels = vec![
            self.cost_panel("sd of the gas in K", KELVIN, &study.accuracy_front, &gas),
            self.cost_panel(&format!("delay of {leak} in h"), HOUR, &study.delay_front, &|judged| {
                judged.delay_s
            }),
        ];
        let horizontal = Horizontal::Quantity("cost of a layout".into());
        Figure::new("What accuracy costs", horizontal, panels)
    }

    fn cost_panel(
        &self,
        quantity: &str,
        unit: Unit,
        front: &Front,
        of: &dyn Fn(&EvaluatedLayout) -> Option<f64>,
    ) -> Panel {
        let judged: Vec<(f64, f64)> = self
            .study
            .judged
            .iter()
            .filter_map(|judged| Some((judged.cost, unit.per_si * of(judged)?)))
            .collect();
        let points: Vec<(f64, f64)> =
            front.points.iter().map(|point| (point.cost, unit.per_si * point.value)).collect();
        let stairs = stairs(&points, &judged);
        let of_points = |name: &str, points: Vec<(f64, f64)>, stroke| {
            let (x, y) = points.into_iter().unzip();
            Item::Points { name: name.into(), x, y, stroke }
        };
        let (x, y): (Vec<f64>, Vec<f64>) = stairs.into_iter().unzip();
        let name = if front.complete { "none is better" } else { "none judged is better" };
        let items = vec![
            of_points("judged layouts", judged, style::BEATEN),
            Item::Line { name: String::new(), x, y, stroke: style::FRONT },
            of_points(name, points, style::FRONT),
        ];
        Panel::new(quantity, 0.72, items)
    }

    /// What is left without each sensor, and whether its fault is told.
    fn failures(&self) -> Grid {
        let header = [
            "sensor",
            "lost: gas sd",
            "smallest leak",
            "fault found from",
            "told apart from",
            "else taken for",
            "gas off in a day",
        ];
        let layout: Vec<usize> = self.study.failures.iter().map(|failure| failure.sensor).collect();
        Grid {
            title: format!("A sensor of {} lost, or at fault", self.names(&layout)),
            header: header.map(str::to_owned).to_vec(),
            rows: self.study.failures.iter().map(|failure| self.failure(failure)).collect(),
        }
    }

    fn failure(&self, failure: &Failure) -> Vec<Cell> {
        let unit = self.unit_of(failure.sensor);
        let plain = |words: String| Cell::from(words);
        let warning = |words: String| Cell { words, stands_out: true };
        let mut cells = vec![plain(self.name(failure.sensor).to_owned())];
        match &failure.without {
            Some(left) => cells.extend([
                plain(KELVIN.with_symbol(left.gas_sd_k)),
                plain(GRAM_PER_HOUR.with_symbol(left.smallest_leak_kg_s)),
            ]),
            None => {
                let unseen = failure.unseen.as_deref().unwrap_or("a state");
                let unseen = units::split(unseen).map_or(unseen, |(quantity, _)| quantity);
                cells.extend([warning(format!("no {}", unseen.replace('_', " "))), warning("none".into())]);
            }
        }
        cells.push(plain(unit.with_symbol(failure.found)));
        let isolated =
            if failure.isolated.is_finite() { unit.with_symbol(failure.isolated) } else { "never".into() };
        cells.push(if failure.is_isolable { plain(isolated) } else { warning(isolated) });
        cells.push(plain(failure.confused_with.map_or("a leak", |sensor| self.name(sensor)).to_owned()));
        cells.push(plain(format!("{} per {}", KELVIN.with_symbol(failure.gas_k), unit.symbol)));
        cells
    }
}

/// The front as a staircase, since more money never buys less: on to the dearest layout, with room beside both ends.
fn stairs(points: &[(f64, f64)], judged: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let costs = || points.iter().chain(judged).map(|at| at.0);
    let (low, high) = (costs().fold(f64::INFINITY, f64::min), costs().fold(f64::NEG_INFINITY, f64::max));
    let room = 0.04 * (high - low).max(1.0);
    let ends = points.iter().skip(1).map(|next| next.0).chain([high + room]);
    let steps = points.iter().zip(ends).flat_map(|(&(cost, value), end)| [(cost, value), (end, value)]);
    // The axis begins where the curve does, here with a gap.
    [(low - room, f64::NAN)].into_iter().chain(steps).collect()
}
