//! The figure of a monitored log: pressures, mass, leak rate, verdict.
use super::VerdictStrip;
use super::marks::Marks;
use crate::detector::monitor::Output;
use crate::log::Truth;
use crate::report::estimate::DecimatedCurves;
use crate::report::figure::{Figure, Item, Panel, style};
use crate::report::{Clock, GRAM_PER_HOUR};
use crate::thermal::units::BAR_PA;

/// Curves: places in the course.
const RAW: usize = 0;
const EXPECTED: usize = 1;
const P15: usize = 2;
/// Value, edges of its band, truth.
const MASS: [usize; 4] = [3, 4, 5, 6];
/// The leak that is found with its bounds, the truth, and what the observer says.
const LEAK: [usize; 4] = [7, 8, 9, 10];
const OBSERVED: usize = 11;
const CURVES: usize = 12;

/// What a figure needs, collected output by output.
#[derive(Clone, Debug)]
pub(crate) struct FigureData {
    curves: DecimatedCurves,
    strip: VerdictStrip,
    marks: Marks,
    limit_pa: f64,
    full_pa: f64,
    /// Whether gas was in truth lost.
    has_outflow: bool,
}

impl FigureData {
    /// With the operational limit and the pressure of the full cylinder at 15 °C, Pa.
    pub(crate) fn new(limit_pa: f64, full_pa: f64) -> Self {
        Self {
            curves: DecimatedCurves::new(CURVES),
            strip: VerdictStrip::default(),
            marks: Marks::default(),
            limit_pa,
            full_pa,
            has_outflow: false,
        }
    }

    /// Adds an output with the truth of its row.
    pub(crate) fn push(&mut self, output: &Output, truth: &Truth) {
        let e = &output.estimate;
        let pressures = [e.pressure_pa, e.pressure_expected_pa, e.p15_pa].map(|p| p / BAR_PA);
        let mass = [e.mass_kg, e.mass_kg - 2.0 * e.mass_sd_kg, e.mass_kg + 2.0 * e.mass_sd_kg, truth.mass_kg];
        let found = output.leak.map_or([f64::NAN; 3], |leak| {
            let rate = leak.rate_kg_s.scaled(GRAM_PER_HOUR);
            [rate.value, rate.low, rate.high]
        });
        let others = [truth.outflow_kg_s, e.leak_kg_s].map(|rate| rate * GRAM_PER_HOUR);
        self.curves.push(e.time_s, pressures.into_iter().chain(mass).chain(found).chain(others));
        self.has_outflow |= truth.outflow_kg_s > 0.0;
        self.strip.push(e.time_s, output.decision.verdict);
        output.events.iter().for_each(|event| self.marks.event(event));
        output.alarms.iter().for_each(|alarm| self.marks.alarm(alarm));
    }

    fn pressures(&self) -> Panel {
        let limit = |name: String, pressure_pa: f64| {
            let value = pressure_pa / BAR_PA;
            pressure_pa.is_finite().then_some(Item::Limit { name, value })
        };
        let limit_bar = self.limit_pa / BAR_PA;
        let items = [
            self.curves.item("as read", RAW, style::noisy(style::PRESSURE)),
            self.curves.item("expected if tight", EXPECTED, style::MODEL),
            self.curves.item("at 15 °C", P15, style::GAS_MEAN),
            limit(format!("limit {} bar", super::short(limit_bar)), self.limit_pa),
            limit(
                "maintenance".to_owned(),
                (1.0 - crate::detector::prognosis::ISO_14520_LOSS) * self.full_pa,
            ),
        ];
        panel("pressure in bar", items, 1.0)
    }

    fn mass(&self) -> Panel {
        let items = [
            self.curves.band_item("± 2 sd", MASS),
            self.curves.item("estimate", MASS[0], style::GAS_MEAN),
            self.curves.item("truth", MASS[3], style::FIRST),
        ];
        panel("gas mass in kg", items, 0.8)
    }

    fn leak(&self) -> Option<Panel> {
        // Without a leak there is nothing but what the observer thinks of one.
        if !self.curves.has(LEAK[0]) && !self.has_outflow {
            return None;
        }
        let items = [
            self.curves.band_item("95 %", LEAK),
            self.curves.item("leak found", LEAK[0], style::GAS_MEAN),
            self.curves.item("observer", OBSERVED, style::MIDDLE),
            self.curves.item("truth", LEAK[3], style::FIRST),
        ];
        Some(panel("leak rate in g/h", items, 0.7))
    }

    fn verdict(&self) -> Panel {
        let stretches = self.strip.stretches(self.curves.origin_s());
        Panel::new("verdict", 0.16, vec![Item::Strip { stretches }])
    }
}

fn panel<const N: usize>(quantity: &str, items: [Option<Item>; N], height: f64) -> Panel {
    Panel::new(quantity, height, items.into_iter().flatten().collect())
}

/// The figure of a run, whose times a clock names.
pub(crate) fn figure(title: &str, data: &FigureData, clock: &Clock) -> Figure {
    let panels = [Some(data.pressures()), Some(data.mass()), data.leak(), Some(data.verdict())];
    Figure::over_time(title, panels.into_iter().flatten().collect())
        .with_marks(data.marks.shifted(data.curves.origin_s()))
        .since(clock.minute(data.curves.origin_s()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Provenance;
    use crate::report::figure::Picture;
    use crate::report::monitor::row::tests::{leaking, unknown};

    #[test]
    fn a_figure_has_limits_marks_and_a_strip_whose_colours_are_explained() {
        use crate::detector::monitor::{Event, EventKind};
        let mut data = FigureData::new(160e5, 200e5);
        for row in 0..50 {
            let mut output = if row < 20 { unknown() } else { leaking() };
            output.estimate.time_s = 1e9 + 60.0 * f64::from(row);
            if row == 20 {
                let kind = EventKind::LeakFound(output.leak.unwrap());
                output.events = vec![Event::new(output.estimate.time_s, 1e9, kind)];
            }
            data.push(&output, &Truth::UNKNOWN);
        }
        let figure = figure("a cylinder", &data, &Clock::default());
        assert_eq!(figure.marks[0].at, 1200.0);
        let provenance = Provenance { command: "cylwatch".into(), inputs: Vec::new(), seed: None };
        let picture = Picture::from(figure);
        let svg = picture.to_svg(&provenance).unwrap();
        for words in
            ["limit 160 bar", "maintenance", "leak found", "verdict", "unknown", "leak", "95 %", "at 15 °C"]
        {
            assert!(svg.contains(words), "`{words}` is missing");
        }
        assert!(picture.to_png(&provenance).is_ok());
    }
}
