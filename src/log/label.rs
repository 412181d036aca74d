//! Names of columns as loggers write them: a name, and a unit in brackets or behind it (`Druck [bar]`, `M01: °C`).

/// A header cut into name and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::log) struct Label<'a> {
    /// The name without unit.
    pub base: &'a str,
    /// The unit as it is written.
    pub unit: Option<&'a str>,
}

/// Whether a header is that of the column which names cylinders.
pub(in crate::log) fn is_cylinder(header: &str) -> bool {
    header.trim().eq_ignore_ascii_case("cylinder")
}

/// Words for units, in small letters, with the suffixes that agree with them, the likely one first. `bar` alone does not
/// say from which zero it counts. A unit without suffixes is none that is read.
const WORDS: [(&str, &[&str]); 71] = [
    ("°c", &["degc"]),
    ("ºc", &["degc"]),
    ("c", &["degc"]),
    ("degc", &["degc"]),
    ("deg c", &["degc"]),
    ("grad c", &["degc"]),
    ("celsius", &["degc"]),
    ("k", &["k"]),
    ("kelvin", &["k"]),
    ("bar", &["bar", "barg"]),
    ("bara", &["bar"]),
    ("bar a", &["bar"]),
    ("bar(a)", &["bar"]),
    ("bar abs", &["bar"]),
    ("bar(abs)", &["bar"]),
    ("bar absolut", &["bar"]),
    ("barg", &["barg"]),
    ("bar g", &["barg"]),
    ("bar(g)", &["barg"]),
    ("bar rel", &["barg"]),
    ("bar(rel)", &["barg"]),
    ("bar relativ", &["barg"]),
    ("barü", &["barg"]),
    ("bar ü", &["barg"]),
    ("mbar", &["mbar"]),
    ("hpa", &["mbar"]),
    ("pa", &["pa"]),
    ("kpa", &["kpa", "kpag"]),
    ("mpa", &["mpa", "mpag"]),
    ("psi", &["psi", "psig"]),
    ("psia", &["psi"]),
    ("psig", &["psig"]),
    ("s", &["s"]),
    ("sec", &["s"]),
    ("sek", &["s"]),
    ("min", &["min"]),
    ("h", &["h"]),
    ("d", &["d"]),
    ("kg", &["kg"]),
    ("g", &["g"]),
    ("g/h", &["g_h"]),
    ("kg/h", &["kg_h"]),
    ("kg/s", &["kg_s"]),
    ("g/s", &["g_s"]),
    ("°f", &["degf"]),
    ("f", &["degf"]),
    ("degf", &["degf"]),
    ("deg f", &["degf"]),
    ("fahrenheit", &["degf"]),
    ("mpa(a)", &["mpa"]),
    ("mpa(g)", &["mpag"]),
    ("mpag", &["mpag"]),
    ("kpa(a)", &["kpa"]),
    ("kpa(g)", &["kpag"]),
    ("kpag", &["kpag"]),
    ("psi(a)", &["psi"]),
    ("psi(g)", &["psig"]),
    ("mbarg", &["mbarg"]),
    ("inhg", &["inhg"]),
    ("in hg", &["inhg"]),
    ("ms", &[]),
    ("atm", &[]),
    ("torr", &[]),
    ("%", &[]),
    ("%rh", &[]),
    ("%rf", &[]),
    ("v", &[]),
    ("mv", &[]),
    ("ma", &[]),
    ("l/min", &[]),
    ("ohm", &[]),
];

/// Units that are long enough to be one behind a name without brackets.
const PLAIN: [&str; 14] =
    ["°c", "ºc", "°f", "bar", "bara", "barg", "mbar", "hpa", "kpa", "mpa", "mpag", "psi", "psig", "inhg"];

/// Suffixes of ours that agree with a unit as it is written; `None`: it is no word for a unit.
pub(in crate::log) fn suffixes(word: &str) -> Option<&'static [&'static str]> {
    let word = word.trim().to_lowercase().replace(" (", "(");
    WORDS.iter().find(|(known, _)| *known == word).map(|(_, suffixes)| *suffixes)
}

impl<'a> Label<'a> {
    /// Cuts a header.
    pub(super) fn of(header: &'a str) -> Self {
        let header = header.trim();
        if let Some((base, inside)) = bracketed(header) {
            return Self { base: tidy(base), unit: Some(inside.trim()) };
        }
        if let Some((base, word)) = header.rsplit_once(char::is_whitespace)
            && PLAIN.contains(&word.to_lowercase().as_str())
            && !base.trim().is_empty()
        {
            let base = base.trim_end();
            let base = base.strip_suffix('/').or_else(|| base.strip_suffix(" in")).unwrap_or(base);
            return Self { base: tidy(base), unit: Some(word) };
        }
        Self { base: tidy(header), unit: None }
    }

    /// Suffixes that agree with the unit; `None`: there is no unit, or a word that is none.
    pub(super) fn suffixes(&self) -> Option<&'static [&'static str]> {
        suffixes(self.unit?)
    }

    /// Name and unit as we write them, in small letters.
    pub(super) fn own(&self) -> String {
        let base = self.base.to_lowercase();
        match self.suffixes().and_then(|suffixes| suffixes.first()) {
            Some(suffix) => format!("{base}_{suffix}"),
            None => base,
        }
    }
}

/// What stands before and in the brackets at the end.
fn bracketed(header: &str) -> Option<(&str, &str)> {
    let (open, close) = match header.chars().last()? {
        ']' => ('[', ']'),
        ')' => ('(', ')'),
        _ => return None,
    };
    let mut depth = 0;
    for (at, letter) in header.char_indices().rev() {
        depth += i32::from(letter == close) - i32::from(letter == open);
        if depth == 0 {
            let (base, inside) = (&header[..at], &header[at + 1..header.len() - 1]);
            return (!base.trim().is_empty()).then_some((base, inside));
        }
    }
    None
}

/// A name without the colon that some loggers put behind it.
fn tidy(name: &str) -> &str {
    let name = name.trim();
    let short = name.strip_suffix(':').map_or(name, str::trim_end);
    if short.is_empty() { name } else { short }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_cut_into_name_and_unit() {
        for (header, base, unit, own) in [
            ("Druck [bar]", "Druck", Some("bar"), "druck_bar"),
            ("T1 [°C]", "T1", Some("°C"), "t1_degc"),
            ("Druck (bar(g))", "Druck", Some("bar(g)"), "druck_barg"),
            ("Druck [bar abs]", "Druck", Some("bar abs"), "druck_bar"),
            ("M01: °C", "M01", Some("°C"), "m01_degc"),
            ("Druck / bar", "Druck", Some("bar"), "druck_bar"),
            ("DATUM:", "DATUM", None, "datum"),
            ("Zeit [hh:mm:ss]", "Zeit", Some("hh:mm:ss"), "zeit"),
            ("shoulder_degC", "shoulder_degC", None, "shoulder_degc"),
            ("[bar]", "[bar]", None, "[bar]"),
            ("a)", "a)", None, "a)"),
            ("", "", None, ""),
        ] {
            let label = Label::of(header);
            assert_eq!((label.base, label.unit, label.own().as_str()), (base, unit, own), "{header}");
        }
    }

    #[test]
    fn every_suffix_is_a_unit_and_bar_alone_may_be_gauge() {
        for suffix in WORDS.iter().flat_map(|(_, suffixes)| *suffixes) {
            assert!(crate::thermal::units::UNITS.iter().any(|unit| unit.suffix == *suffix), "{suffix}");
        }
        assert_eq!(suffixes("Bar"), Some(&["bar", "barg"][..]));
        assert_eq!(suffixes("torr"), Some(&[][..]));
        assert_eq!(suffixes("Pt100"), None);
    }
}
