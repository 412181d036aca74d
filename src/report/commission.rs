//! The file of `cylwatch commission`: thresholds for one vessel, the worlds that they were found in, and how often they alarm without a leak.
use super::{Provenance, Report, digest, number};
use crate::evaluation::tails::{Campaign, Commissioned};
use crate::evaluation::world::{Climate, GasKind, NominalVessel, RowPattern, SensorClass};
use crate::thermal::units::BAR_PA;
use crate::thermal::units::{DAY_S, YEAR_S};
use crate::thermal::vessel::{Vessel, VesselSpec};
use cylwatch_detector::evidence::Tails;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// What the file says that it is.
const FORMAT: &str = "cylwatch-commissioned";
const VERSION: u64 = 1;
/// A fill is another one beyond this part of the one that was simulated: below the lowest that was drawn, above the highest.
const SAME_FILL: (f64, f64) = (0.85, 1.05);
const TOO_OFTEN: &str =
    "false alarms are more frequent than asked for: simulate more cylinders, or ask for fewer";

/// Thresholds for one vessel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct CommissionedVessel {
    /// The vessel that they are for.
    pub vessel: VesselMark,
    /// Highest pressure of the fills at 15 °C, bar absolute.
    pub fill_pressure_bar: f64,
    /// Upper end of the range of the transmitter, bar.
    pub full_scale_bar: f64,
    /// Mean time between false alarms that the thresholds are for, years.
    pub false_alarm_years: f64,
    /// Whether stretches were shortened to try the command out: the thresholds are of no use.
    pub rehearsal: bool,
    /// What was simulated.
    pub worlds: Worlds,
    /// What was found.
    #[serde(flatten)]
    pub found: Commissioned,
}

/// What tells one vessel from another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct VesselMark {
    /// Its name.
    pub name: String,
    /// Digest of its file's content.
    pub digest: String,
}

/// Worlds that thresholds were found in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Worlds {
    climates: Vec<Climate>,
    gases: Vec<GasKind>,
    sensors: Vec<SensorClass>,
    rows: Vec<RowPattern>,
    cylinders: usize,
    days: f64,
    cylinder_years: f64,
}

/// Why a file of thresholds cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum CommissionError {
    /// It is no JSON.
    #[error("it is no JSON: {0}")]
    NoJson(serde_json::Error),
    /// It is another file.
    #[error("it is no file of `cylwatch commission`")]
    Foreign,
    /// Another version.
    #[error("it has version {found}, this program reads {VERSION}: commission the vessel anew")]
    Version {
        /// Version of the file.
        found: Value,
    },
    /// A part of it is missing or wrong.
    #[error("{0}: commission the vessel anew")]
    Damaged(serde_json::Error),
    /// Its tails are none.
    #[error("{0}: commission the vessel anew")]
    Tails(crate::evaluation::EvaluationError),
    /// It is for another vessel.
    #[error(
        "its thresholds are for {} ({}), and this run has {} ({}): find those of this vessel with `cylwatch commission`",
        then.name, then.digest, now.name, now.digest
    )]
    OtherVessel {
        /// Vessel of the file.
        then: VesselMark,
        /// Vessel of the run.
        now: VesselMark,
    },
}

impl VesselMark {
    /// That of a vessel: comments in its file and the order of keys do not count.
    ///
    /// # Errors
    /// A number that JSON does not know.
    pub(crate) fn of(specification: &VesselSpec, vessel: &Vessel) -> serde_json::Result<Self> {
        Ok(Self { name: vessel.name.clone(), digest: digest(&serde_json::to_string(specification)?) })
    }
}

impl Worlds {
    /// Those of a campaign.
    pub(crate) fn of(campaign: &Campaign) -> Self {
        let Campaign { climates, gases, sensors, rows, cylinders, length_s, .. } = campaign.clone();
        let cylinder_years = cylinders as f64 * length_s / YEAR_S;
        Self { climates, gases, sensors, rows, cylinders, days: length_s / DAY_S, cylinder_years }
    }
}

/// What is going to be simulated, in words.
pub(crate) fn intention(nominal: &NominalVessel, campaign: &Campaign) -> String {
    let bar = |pressure_pa: f64| number(pressure_pa / BAR_PA, 4);
    let Worlds { climates, gases, sensors, rows, cylinders, days, cylinder_years } = Worlds::of(campaign);
    format!(
        "{}: simulating {cylinders} tight cylinders of {} d ({} years)\n  fill {} to {} bar at 15 °C, transmitter up to {} bar, \
         seed {}\n  climates {}; gas {}; sensors {} on each; rows {}",
        nominal.vessel.name,
        number(days, 4),
        number(cylinder_years, 3),
        bar(nominal.fill_pa.0),
        bar(nominal.fill_pa.1),
        bar(nominal.full_scale_pa),
        campaign.seed,
        listed(&climates),
        listed(&gases),
        listed(&sensors),
        listed(&rows),
    )
}

fn listed<T: ToString>(kinds: &[T]) -> String {
    kinds.iter().map(T::to_string).collect::<Vec<_>>().join(", ")
}

impl CommissionedVessel {
    /// As a JSON document.
    ///
    /// # Errors
    /// A number that JSON does not know.
    pub(crate) fn document(&self, provenance: &Provenance) -> serde_json::Result<Value> {
        let head = json!({ "provenance": provenance.to_json(), "format": FORMAT, "version": VERSION });
        let (Value::Object(mut document), Value::Object(content)) = (head, serde_json::to_value(self)?)
        else {
            return Ok(Value::Null);
        };
        document.extend(content);
        Ok(Value::Object(document))
    }

    /// Of the text of a file, for a vessel.
    ///
    /// # Errors
    /// It is another file, another version, damaged, or for another vessel.
    pub(crate) fn read(text: &str, vessel: &VesselMark) -> Result<Self, CommissionError> {
        let document: Value = serde_json::from_str(text).map_err(CommissionError::NoJson)?;
        if document["format"] != FORMAT {
            return Err(CommissionError::Foreign);
        }
        if document["version"] != VERSION {
            return Err(CommissionError::Version { found: document["version"].clone() });
        }
        let read: Self = serde_json::from_value(document).map_err(CommissionError::Damaged)?;
        read.found.tails().map_err(CommissionError::Tails)?;
        if read.vessel.digest != vessel.digest {
            return Err(CommissionError::OtherVessel { then: read.vessel, now: vessel.clone() });
        }
        Ok(read)
    }

    /// Where a cylinder of this fill at 15 °C, Pa, is not what the thresholds were found for, in words.
    pub(crate) fn cautions(&self, fill_pa: f64) -> Vec<String> {
        let (fill_bar, found_bar) = (fill_pa / BAR_PA, self.fill_pressure_bar);
        let (low, high) = SAME_FILL;
        let mut cautions = Vec::new();
        if !(low * found_bar..=high * found_bar).contains(&fill_bar) {
            cautions.push(format!(
                "the thresholds were found for a fill of {} bar at 15 °C, and this one makes {}: commission the vessel for it with \
                 --fill-pressure-bar",
                number(found_bar, 4),
                number(fill_bar, 4)
            ));
        }
        if self.rehearsal {
            cautions.push(
                "the thresholds are those of a rehearsal and of no use: commission the vessel in full"
                    .to_owned(),
            );
        }
        cautions
    }

    /// Thresholds beside the usual ones of such a vessel, and the rate of false alarms that was found.
    ///
    /// # Errors
    /// The mean time is not positive.
    pub(crate) fn summary(&self, usual: &Tails) -> Result<Report, cylwatch_detector::DetectorError> {
        let usual = usual.thresholds(self.false_alarm_years * YEAR_S)?;
        let rows = self.found.scales.iter().map(|of| {
            let (low, high) = of.threshold_interval;
            let [threshold, low, high, usual] =
                [of.threshold, low, high, usual.of(of.scale)].map(|level| number(level, 3));
            vec![of.scale.as_str().to_owned(), threshold, format!("{low} to {high}"), usual]
        });
        let rate = &self.found.false_alarms;
        let (low, high) = rate.by_simulation;
        let asked = 10.0 / self.false_alarm_years;
        let [per_ten, low_words, high_words, asked_words, years] =
            [rate.per_ten_years, low, high, asked, rate.cylinder_years].map(|value| number(value, 2));
        let report = Report::new(self.vessel.name.clone())
            .rows("", &["scale", "threshold", "95 %", "usual"], rows.collect())
            .text(format!(
                "False alarms in ten years, out of sample: {per_ten} (95 %: {low_words} to {high_words}); asked for: {asked_words}; \
                 {} in {} of {} cylinders and {years} years",
                rate.count, rate.simulations_with, rate.simulations
            ));
        let too_often = (low > asked).then(|| TOO_OFTEN.to_owned());
        Ok(report.cautions(too_often))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::judge::table::Rate;
    use crate::evaluation::tails::CommissionedScale;
    use cylwatch_detector::evidence::{Scale, Tail};

    fn mark(digest: &str) -> VesselMark {
        VesselMark { name: format!("cylinder {digest}"), digest: digest.to_owned() }
    }

    fn commissioned() -> CommissionedVessel {
        let tail = Tail { level: 1.5, interval_s: 1e6, scale: 0.5, shape: 0.125 };
        let of = |scale| CommissionedScale { scale, tail, threshold: 4.0, threshold_interval: (3.0, 6.0) };
        let rate = Rate {
            count: 2,
            cylinder_years: 40.0,
            per_ten_years: 0.5,
            poisson: (0.06, 1.81),
            simulations: 240,
            simulations_with: 2,
            by_simulation: (0.06, 1.81),
        };
        CommissionedVessel {
            vessel: mark("abc"),
            fill_pressure_bar: 200.0,
            full_scale_bar: 250.0,
            false_alarm_years: 10.0,
            rehearsal: false,
            worlds: Worlds::of(&Campaign::default()),
            found: Commissioned { scales: Scale::ALL.map(of), false_alarms: rate },
        }
    }

    fn document() -> Value {
        let provenance =
            Provenance { command: "cylwatch commission x".into(), inputs: Vec::new(), seed: Some(1) };
        commissioned().document(&provenance).unwrap()
    }

    fn refusal(document: &Value) -> String {
        CommissionedVessel::read(&document.to_string(), &mark("abc")).unwrap_err().to_string()
    }

    #[test]
    fn what_is_read_is_what_was_written() {
        let text = document().to_string();
        assert_eq!(CommissionedVessel::read(&text, &mark("abc")).unwrap(), commissioned());
        assert_eq!(document()["provenance"]["seed"], 1);
        assert_eq!(document()["scales"][4]["scale"], "month");
        assert_eq!(document()["false_alarms"]["count"], 2);
    }

    #[test]
    fn every_file_that_is_none_for_this_vessel_is_refused_with_the_reason() {
        let read = |text: &str| CommissionedVessel::read(text, &mark("abc")).unwrap_err().to_string();
        assert!(read("time_s,shoulder_degc").contains("no JSON"));
        assert!(read("{}").contains("no file of `cylwatch commission`"));
        let changed = |key: &str, value: Value| {
            let mut document = document();
            document[key] = value;
            refusal(&document)
        };
        assert!(changed("version", json!(2)).contains("version 2, this program reads 1"));
        assert!(changed("scales", json!([])).contains("commission the vessel anew"));
        assert!(changed("worlds", json!("?")).contains("commission the vessel anew"));
        let other = changed("vessel", json!({ "name": "another", "digest": "def" }));
        assert!(other.contains("another (def)") && other.contains("cylinder abc (abc)"), "{other}");
        let mut exchanged = document();
        exchanged["scales"][0]["scale"] = json!("day");
        assert!(refusal(&exchanged).contains("hour, half-day, day"), "{}", refusal(&exchanged));
        let mut negative = document();
        negative["scales"][1]["tail"]["scale"] = json!(-1.0);
        assert!(refusal(&negative).contains("tails.scale"));
    }

    #[test]
    fn another_fill_and_a_rehearsal_are_cautions() {
        assert!(commissioned().cautions(200e5).is_empty() && commissioned().cautions(180e5).is_empty());
        for fill_pa in [100e5, 300e5, f64::NAN] {
            assert_eq!(commissioned().cautions(fill_pa).len(), 1, "{fill_pa}");
        }
        let rehearsed = CommissionedVessel { rehearsal: true, ..commissioned() };
        assert!(rehearsed.cautions(190e5)[0].contains("rehearsal"));
    }

    #[test]
    fn thresholds_stand_beside_the_usual_ones_and_too_many_false_alarms_are_a_caution() {
        let text = commissioned().summary(&Tails::CYLINDER).unwrap().to_text();
        let usual = Tails::CYLINDER.thresholds(10.0 * 365.25 * 86_400.0).unwrap().of(Scale::Hour);
        assert!(text.contains("month") && text.contains("3 to 6"), "{text}");
        assert!(text.contains(&number(usual, 3)), "{text} without {usual}");
        assert!(
            text.contains("0.5 (95 %: 0.06 to 1.8); asked for: 1; 2 in 2 of 240")
                && !text.contains("caution"),
            "{text}"
        );
        let mut often = commissioned();
        often.found.false_alarms.by_simulation = (1.1, 4.0);
        assert!(often.summary(&Tails::CYLINDER).unwrap().to_text().contains("more frequent"));
    }
}
