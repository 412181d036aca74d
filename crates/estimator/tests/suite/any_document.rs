//! No text makes the readers of sensors and of candidates panic: it is taken, or refused in one line that begins with the file.
use cylwatch_estimator::placement::read_candidates;
use cylwatch_estimator::sensor::read_sensors;
use cylwatch_thermal::vessel::{self, Vessel};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use std::sync::LazyLock;

const SENSORS: &str = r#"
[[sensor]]
name = "shoulder"
offset_sd_k = 0.1
air_coupling = 0.15
lag_s = 20
noise_k = 0.05
[[sensor]]
name = "tip"
kind = "immersion"
cell = 1
[[sensor]]
name = "pressure"
full_scale_bar = 400
gauge = true
noise_mbar = 10
temperature_coefficient_sd_mbar_k = 5
"#;

const CANDIDATES: &str = r#"
minimum_distance_mm = 100
[[sensor]]
name = "bottom"
[[sensor]]
name = "side"
height_mm = 500
lag_s = 40
[[sensor]]
name = "pressure"
[[rule]]
sensor = "side"
cost = 3
status = "required"
[[group]]
members = ["bottom", "side"]
at_most = 1
"#;

/// What replaces a value or a stretch of the text.
const PIECES: [&str; 26] = [
    "0",
    "-1",
    "1e-300",
    "1e300",
    "nan",
    "-inf",
    "99999999999999999999",
    "\"\"",
    "\"side\"",
    "true",
    "[",
    "]",
    "=",
    "\n",
    "\n[[sensor]]\n",
    "\n[[rule]]\n",
    "\n[[group]]\n",
    "# ",
    "\"",
    "'''",
    "_bar",
    "_mm",
    "[1, 2]",
    "1979-05-27",
    "\u{20ac}",
    "\u{0}",
];

static VESSEL: LazyLock<Vessel> = LazyLock::new(|| vessel::presets::load("nitrogen-20l").unwrap());

/// One of the two texts with some values and some stretches replaced, or bytes.
fn texts() -> impl Strategy<Value = String> {
    let edits =
        prop::collection::vec((any::<Index>(), prop::option::of(0_usize..12), select(&PIECES[..])), 1..4);
    let edited = (select(vec![SENSORS, CANDIDATES]), edits).prop_map(|(text, edits)| {
        edits.into_iter().fold(text.to_owned(), |text, (at, length, piece)| {
            let mut letters: Vec<char> = text.chars().collect();
            let start = at.index(letters.len() + 1);
            let rest = &letters[start..];
            let line = || rest.iter().position(|letter| *letter == '\n').unwrap_or(rest.len());
            let end = start + length.unwrap_or_else(line).min(rest.len());
            letters.splice(start..end, piece.chars());
            letters.into_iter().collect()
        })
    });
    let bytes = prop::collection::vec(any::<u8>(), 0..200);
    prop_oneof![9 => edited, 1 => bytes.prop_map(|bytes| String::from_utf8_lossy(&bytes).into_owned())]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_gives_sensors_and_candidates_or_a_message(text in texts()) {
        let refused = [
            read_sensors(&text, "x.toml").err().map(|error| error.to_string()),
            read_candidates(&text, "x.toml", &VESSEL).err().map(|error| error.to_string()),
        ];
        for message in refused.iter().flatten() {
            prop_assert!(message.starts_with("x.toml:") && !message.contains('\n'), "{message}\n{text}");
        }
    }
}
