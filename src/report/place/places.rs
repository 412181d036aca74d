//! What accuracy costs, and one thermometer at each place.
use super::{GRAM, GRAM_PER_HOUR, HOUR, KELVIN, MILLIMETRES, PlacementReport, Unit};
use crate::estimator::placement::Status;
use crate::estimator::placement::study::{Front, Position};
use crate::report::{Report, number};

impl PlacementReport<'_> {
    /// Layouts that none is better than at their cost.
    pub(super) fn fronts(&self) -> Report {
        let study = self.study;
        let leak = GRAM_PER_HOUR.with_symbol(study.settings.leak_kg_s);
        let gas =
            self.front("Cost against the sd of the gas temperature", "sd / K", KELVIN, &study.accuracy_front);
        let delay = format!("Cost against the delay of a leak of {leak}");
        let delay = self.front(&delay, "delay / h", HOUR, &study.delay_front);
        gas.then(delay)
    }

    fn front(&self, title: &str, value: &str, unit: Unit, front: &Front) -> Report {
        let row = |point: &crate::estimator::placement::study::Point| {
            vec![number(point.cost, 4), unit.number(point.value), self.chosen(&point.sensors)]
        };
        let rows: Vec<Vec<String>> = front.points.iter().map(row).collect();
        let compared = if front.complete { "all layouts" } else { "not all layouts, only judged ones" };
        let title = format!("{title} ({compared}: {})", front.compared);
        Report::default().rows(title, &["cost", value, "layout"], rows)
    }

    /// One thermometer beside what is required, from the top down.
    pub(super) fn positions(&self) -> Report {
        let mut positions: Vec<&Position> = self.study.positions.iter().collect();
        positions.sort_by(|a, b| self.top_m(b).total_cmp(&self.top_m(a)));
        let mut header = vec![
            "",
            "place",
            "height / mm",
            "gas sd / K",
            "mass / g",
            "leak / g/h",
            "smallest leak",
            "delay / h",
        ];
        let robust: Vec<String> = match self.study.scenarios.len() {
            0 | 1 => vec!["robust / K".into()],
            scenarios => (1..=scenarios).map(|scenario| format!("robust {scenario} / K")).collect(),
        };
        header.extend(robust.iter().take(self.study.scenarios.len()).map(String::as_str));
        let rows: Vec<Vec<String>> = positions.into_iter().map(|position| self.position(position)).collect();
        let beside = self.required().map_or(String::new(), |names| format!(" beside {names}"));
        let title = format!("One sensor{beside}, anywhere");
        let explained = "< shoulder and valve; ref: may not be chosen, a reference; blind: sees not every state; smallest leak in g/h";
        Report::default().explained_rows(title, &header, rows, explained)
    }

    fn position(&self, position: &Position) -> Vec<String> {
        let mark = match self.asked_about(position.sensor) {
            Some(_) => "<",
            None if self.is(position.sensor, Status::Forbidden) => "ref",
            None => "",
        };
        let height = |height_m: f64| number((MILLIMETRES * height_m).round(), 6);
        let mut cells = vec![
            mark.to_owned(),
            self.name(position.sensor).to_owned(),
            position.height_m.map_or(String::new(), height),
        ];
        let Some(steady) = &position.steady else {
            cells.push("blind".into());
            return cells;
        };
        cells.extend([
            KELVIN.number(steady.gas_sd_k),
            GRAM.number(steady.mass_sd_kg),
            GRAM_PER_HOUR.number(steady.leak_sd_kg_s),
            GRAM_PER_HOUR.number(steady.smallest_leak_kg_s),
            position.delay_s.map_or("never".into(), |delay_s| HOUR.number(delay_s)),
        ]);
        cells.extend(position.robust_k.iter().map(|&of| KELVIN.number(of)));
        cells
    }

    /// Where it stands in the table: the valve is above the wall, and what is on neither comes last.
    fn top_m(&self, position: &Position) -> f64 {
        match (position.height_m, self.asked_about(position.sensor)) {
            (Some(height_m), _) => height_m,
            (None, Some(_)) => f64::MAX,
            (None, None) => f64::MIN,
        }
    }
}
