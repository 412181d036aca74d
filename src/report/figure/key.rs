//! The legend of a picture apart from it: on a phone the one beside the panels lies outside the window.
use super::style::Rgb;
use super::{Item, Part, Picture};

/// The legend of a panel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    /// What the panel shows.
    pub quantity: String,
    /// Names with the style of a sample, in CSS.
    pub entries: Vec<(String, String)>,
}

impl Picture {
    /// Legends of all panels that have one of their own.
    pub(crate) fn keys(&self) -> Vec<Key> {
        let figures = self.parts.iter().filter_map(|part| match part {
            Part::Figure(figure) => Some(figure),
            _ => None,
        });
        let key = |panel: &super::Panel| Key {
            quantity: panel.quantity.clone(),
            entries: panel.items.iter().flat_map(entries).collect(),
        };
        figures.flat_map(|figure| &figure.panels).map(key).filter(|key| !key.entries.is_empty()).collect()
    }
}

/// Entries of an item; one without a name has none.
fn entries(item: &Item) -> Vec<(String, String)> {
    let one = |name: &str, style: String| match name {
        "" => Vec::new(),
        name => vec![(name.replace('\n', " "), style)],
    };
    match item {
        Item::Line { name, stroke, .. } => {
            let pattern = if stroke.dash.is_empty() { "solid" } else { "dashed" };
            one(name, format!("border-top:{}px {pattern} {}", stroke.width.max(2.0), color(stroke.color)))
        }
        Item::Points { name, stroke, .. } | Item::Intervals { name, stroke, .. } => {
            one(name, format!("border-top:2px dotted {}", color(stroke.color)))
        }
        Item::Band { name, .. } => one(name, filled(Rgb::BAND)),
        Item::Limit { .. } => Vec::new(),
        Item::Strip { stretches } => {
            let mut found: Vec<(String, String)> = Vec::new();
            for stretch in stretches {
                let entry = (stretch.name.clone(), filled(stretch.color));
                if !found.contains(&entry) {
                    found.push(entry);
                }
            }
            found
        }
    }
}

fn filled(of: Rgb) -> String {
    format!("height:.7em;background:{}", color(of))
}

fn color(Rgb(red, green, blue): Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Figure, Panel, Stretch, style};

    #[test]
    fn every_name_of_a_legend_has_a_sample_of_its_looks_once() {
        let stretch =
            |from: f64, name: &str, color| Stretch { from, to: from + 1.0, name: name.into(), color };
        let items = vec![
            Item::line("gas", &[0.0, 1.0], [1.0, 2.0], style::GAS_MEAN),
            Item::line("", &[0.0, 1.0], [1.0, 2.0], style::MODEL),
            Item::line("model", &[0.0, 1.0], [1.0, 2.0], style::MODEL),
            Item::Limit { name: "limit".into(), value: 1.0 },
        ];
        let stretches = vec![
            stretch(0.0, "tight", Rgb::GREEN),
            stretch(1.0, "leak", Rgb::BLACK),
            stretch(2.0, "tight", Rgb::GREEN),
        ];
        let unnamed = vec![Item::line("", &[0.0], [1.0], style::MODEL)];
        let panels = vec![
            Panel::new("temperature", 1.0, items),
            Panel::new("as above", 1.0, unnamed),
            Panel::new("verdict", 0.2, vec![Item::Strip { stretches }]),
        ];
        let keys = Picture::from(Figure::over_time("a run", panels)).keys();
        let names: Vec<(&str, Vec<&str>)> = keys
            .iter()
            .map(|key| (key.quantity.as_str(), key.entries.iter().map(|(name, _)| name.as_str()).collect()))
            .collect();
        assert_eq!(names, [("temperature", vec!["gas", "model"]), ("verdict", vec!["tight", "leak"])]);
        assert!(keys[0].entries[0].1.starts_with("border-top:2.4px solid #000000"), "{:?}", keys[0]);
        assert!(keys[0].entries[1].1.contains("dashed"), "{:?}", keys[0]);
        assert_eq!(keys[1].entries[0].1, "height:.7em;background:#009e73");
    }
}
