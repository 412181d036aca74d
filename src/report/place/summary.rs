//! A study as a report: its settings, then one table after the other.
use super::{BAR, GRAM_PER_HOUR, HOUR, PlacementReport};
use crate::report::{Report, number};
use crate::thermal::units::DAY_S;
use crate::thermal::units::ZERO_CELSIUS_K;

impl PlacementReport<'_> {
    /// The settings, then one table after the other.
    pub(crate) fn summary(&self) -> Report {
        let mut report = Report::new("").text(self.settings_text());
        if self.study.numbers.is_empty() {
            report = report.text("No layout was looked at before the end.");
        }
        let parts = [
            self.best_layouts(),
            self.refused(),
            self.judged_layouts(),
            self.differences(),
            self.along_scenarios(),
            self.fronts(),
            self.losses(),
            self.faults(),
            self.biases(),
            self.positions(),
            self.by_paper(),
            self.achieved(),
        ];
        parts.into_iter().fold(report, Report::then)
    }

    /// Tables for people, at most 110 characters wide.
    pub(crate) fn text(&self) -> String {
        self.summary().to_text()
    }

    /// Question and conditions of the study.
    fn settings_text(&self) -> String {
        let study = self.study;
        let settings = &study.settings;
        let (conditions, detection) = (&settings.steady.conditions, &settings.steady.detection);
        let degc = |kelvin: f64| format!("{} °C", number(kelvin - ZERO_CELSIUS_K, 3));
        let partial = if self.is_partial() {
            "PARTIAL: the search was ended early, what is here is not all\n"
        } else {
            ""
        };
        let budget = if settings.budget.is_finite() {
            format!(", at a cost of at most {}", number(settings.budget, 4))
        } else {
            String::new()
        };
        let required = self.required().map_or(String::new(), |names| format!("every layout has: {names}\n"));
        let (pressure_pa, filled_k) = conditions.filling;
        let air = if conditions.air_k == conditions.body_k {
            String::new()
        } else {
            format!(" in air of {}", degc(conditions.air_k))
        };
        let scenarios = match &*study.scenarios {
            [] => "at rest only".into(),
            names => format!("and along: {}", names.join("; ")),
        };
        let per = conditions.interval_s;
        let interval = if per < 60.0 { format!("{per} s") } else { format!("{} min", number(per / 60.0, 3)) };
        let within = if detection.within_s < DAY_S {
            HOUR.with_symbol(detection.within_s)
        } else {
            format!("{} d", number(detection.within_s / DAY_S, 3))
        };
        format!(
            "{partial}Where sensors should sit on: {}\n{} candidates, up to {} sensors, by the {}{budget}\n{required}\
             at rest at {}{air}, filled to {} at {}, read every {interval}; {scenarios}\n\
             found: within {within} with 95 %, at a threshold of {} sd; delay: of a leak of {}\n",
            study.vessel,
            study.candidates.len(),
            settings.sensors,
            settings.criterion.description(),
            degc(conditions.body_k),
            BAR.with_symbol(pressure_pa),
            degc(filled_k),
            number(detection.threshold_sd, 3),
            GRAM_PER_HOUR.with_symbol(settings.leak_kg_s),
        )
    }
}
