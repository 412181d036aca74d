//! A study that was never run.
use super::PlacementReport;
use crate::estimator::placement::scenario::{Summary, VariantError};
use crate::estimator::placement::search::{Layout, Method};
use crate::estimator::placement::study::{
    BestLayouts, Bias, BiasSource, EvaluatedLayout, Failure, Front, Point, Position, Proof, Study,
    StudySettings,
};
use crate::estimator::placement::{Candidates, ScenarioAccuracy, SteadyAccuracy, Variant};
use crate::evaluation::placement::ClosedLoopSettings;
use crate::report::Provenance;
use crate::thermal::vessel::{Vessel, presets};

/// 1 g/h.
const GRAM_PER_HOUR: f64 = 1e-3 / 3600.0;

struct Known {
    vessel: Vessel,
    candidates: Candidates,
    study: Study,
}

impl Known {
    fn report(&self) -> PlacementReport<'_> {
        PlacementReport {
            study: &self.study,
            candidates: &self.candidates,
            vessel: &self.vessel,
            runs: ClosedLoopSettings::default(),
            closed_loop: None,
        }
    }
}

fn accuracy(gas_sd_k: f64, leak: f64) -> SteadyAccuracy {
    SteadyAccuracy {
        gas_sd_k,
        mass_sd_kg: 0.01 * gas_sd_k,
        leak_sd_kg_s: 0.5 * leak * GRAM_PER_HOUR,
        smallest_leak_kg_s: leak * GRAM_PER_HOUR,
    }
}

fn scenario_accuracy() -> ScenarioAccuracy {
    let of = |mean: f64| Summary { mean, worst: 2.0 * mean };
    let variants = [Variant::Nominal, Variant::StratifiedGas].map(|variant| VariantError {
        variant,
        gas_k: of(1.0),
        mass_kg: of(0.01),
    });
    ScenarioAccuracy {
        scenario: "a tunnel".into(),
        gas_sd_k: of(0.4),
        mass_sd_kg: of(0.01),
        leak_sd_kg_s: of(GRAM_PER_HOUR),
        gas_schmidt_k: of(0.6),
        mass_schmidt_kg: of(0.02),
        gas_worst_case_k: of(0.9),
        variants: variants.to_vec(),
    }
}

fn judged(sensors: &[usize], steady: SteadyAccuracy, delay_h: Option<f64>) -> EvaluatedLayout {
    EvaluatedLayout {
        sensors: sensors.to_vec(),
        cost: sensors.len() as f64,
        steady,
        delay_s: delay_h.map(|hours| 3600.0 * hours),
        scenarios: vec![scenario_accuracy()],
    }
}

fn known() -> Known {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let candidates = Candidates::of_vessel(&vessel).unwrap();
    let of = |name| candidates.index(name).unwrap();
    let (middle, shoulder, valve, gas, pressure) =
        (of("middle"), of("shoulder"), of("valve"), of("gas_1"), of("pressure"));
    let layouts = [(vec![middle, pressure], 2.0), (vec![shoulder, pressure], 2.01)]
        .map(|(sensors, leak)| Layout { sensors, value: leak * GRAM_PER_HOUR });
    let number = BestLayouts {
        sensors: 2,
        bound: layouts[0].value,
        layouts: layouts.to_vec(),
        proof: Proof::Search,
        relaxation: Some(0.95 * layouts[0].value),
        frank_wolfe: None,
        method: Method::Exhaustive,
        evaluated: 16,
        marginal: Some(-0.25),
        partial: false,
    };
    let front = |value: f64| Front {
        points: vec![Point { sensors: vec![middle, pressure], cost: 2.0, value }],
        complete: true,
        compared: 16,
    };
    let failure = |sensor, without: Option<SteadyAccuracy>, unseen: Option<&str>, found| Failure {
        sensor,
        unseen: unseen.map(str::to_owned),
        without,
        found,
        isolated: f64::INFINITY,
        confused_with: None,
        is_isolable: false,
        gas_k: 0.5,
        mass_kg: 0.02,
    };
    let position = |sensor: usize, steady| Position {
        sensor,
        height_m: candidates.list[sensor].height_m,
        steady,
        delay_s: None,
        robust_k: vec![0.7],
    };
    let study = Study {
        vessel: vessel.name.clone(),
        candidates: candidates.list.iter().map(|of| of.sensor.name.clone()).collect(),
        heights_m: candidates.list.iter().map(|of| of.height_m).collect(),
        scenarios: vec!["a tunnel".into()],
        settings: StudySettings { sensors: 2, ..StudySettings::default() },
        numbers: vec![number],
        judged: vec![
            judged(&[middle, pressure], accuracy(0.31, 4.0), Some(12.0)),
            judged(&[shoulder, pressure], accuracy(0.35, 3.2), None),
        ],
        accuracy_front: front(0.31),
        delay_front: front(12.0 * 3600.0),
        failures: vec![
            failure(middle, None, Some("air_k"), 0.2),
            failure(pressure, Some(accuracy(1.5, 40.0)), None, 0.3e5),
        ],
        biases: vec![Bias {
            source: BiasSource::Offset(middle),
            size: 0.3,
            gas_k: [0.3, 0.2, 0.1],
            mass_kg: [1e-3, 2e-3, 3e-3],
            leak_kg_s: [0.0, GRAM_PER_HOUR, 0.0],
        }],
        positions: vec![
            position(middle, Some(accuracy(0.31, 4.0))),
            position(shoulder, Some(accuracy(0.35, 3.2))),
            position(valve, Some(accuracy(0.5, 9.0))),
            position(gas, None),
        ],
        refused: Vec::new(),
        published: None,
        partial: false,
    };
    Known { vessel, candidates, study }
}

fn provenance() -> Provenance {
    Provenance { command: "c".into(), inputs: vec![], seed: None }
}

#[test]
fn words_name_the_best_its_proof_and_where_the_rankings_differ_within_110_characters() {
    let known = known();
    let text = known.report().text();
    let plain = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for expected in [
        "best 2 sensors middle + pressure: sd of gas 0.31 K, of mass 3.1 g; finds 4 g/h in 1 d, 25 % better than 1",
        "one lost without middle: the others do not see air_k",
        "without pressure: sd of gas 1.5 K; finds 40 g/h",
        "pressure in every layout",
        "2 middle 2 2 0 % 5 % -25.0 % 2 all, 16",
        "2: shoulder (2.01)",
        "0.31* 3.1* 2 4 12* 0.6* 1.8* 2",
        "0.35 3.5 1.6* 3.2* never 0.6* 1.8* 2",
        "they DIFFER, shoulder finds 3.2 g/h; least sd of gas: middle, +25 %",
        "the others do not see air_k",
        "pressure 0.3 bar never a leak NOT told apart",
        "offset middle 0.3 K 0.3 0.2 0.1 1 2 3 0 1 0",
        "ref gas_1 blind",
    ] {
        assert!(plain.contains(expected), "`{expected}` is missing in:\n{text}");
    }
    assert!(!text.contains("PARTIAL"));
    for line in text.lines() {
        assert!(line.chars().count() <= 110, "{line}");
    }
}

#[test]
fn places_stand_from_the_top_down_with_shoulder_and_valve_marked() {
    let known = known();
    let text = known.report().text();
    let table = text.split("anywhere\n").nth(1).unwrap();
    let names: Vec<&str> = table
        .lines()
        .skip(2)
        .take(4)
        .map(|line| line.split_whitespace().find(|word| !["<", "ref"].contains(word)).unwrap())
        .collect();
    assert_eq!(names, ["valve", "shoulder", "middle", "gas_1"]);
    assert_eq!(table.lines().filter(|line| line.starts_with("<  ")).count(), 2);
}

#[test]
fn a_partial_study_says_so_first_and_an_empty_one_still_makes_text_and_picture() {
    let mut known = known();
    known.study.partial = true;
    assert!(known.report().text().lines().nth(1).unwrap().starts_with("PARTIAL"));
    let empty = Study {
        numbers: vec![],
        judged: vec![],
        accuracy_front: Front::default(),
        delay_front: Front::default(),
        failures: vec![],
        biases: vec![],
        positions: vec![],
        ..known.study.clone()
    };
    known.study = empty;
    assert!(known.report().text().contains("No layout was looked at"));
    assert!(known.report().figure().to_svg(&provenance()).unwrap().contains("height along the axis"));
    assert_eq!(known.report().document(&provenance())["partial"], true);
}

#[test]
fn columns_have_a_row_for_each_judged_layout_and_leave_what_never_happens_empty() {
    let known = known();
    let csv = known.report().csv(&provenance());
    let lines: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(lines.len(), 3);
    assert!(lines.iter().all(|line| line.split(',').count() == lines[0].split(',').count()), "{lines:?}");
    assert_eq!(lines[1], "2,middle + pressure,2,0.31,3.1,2,4,12,0.4,0.8,0.6,1.8");
    assert!(lines[2].starts_with("2,shoulder + pressure,2,0.35,3.5,1.6,3.2,,"));
}

#[test]
fn json_has_the_best_by_name_and_the_study_in_si() {
    let known = known();
    let document = known.report().document(&provenance());
    assert_eq!(document["best"][0]["names"][0], "middle");
    assert!((document["best"][0]["value"].as_f64().unwrap() - 2.0).abs() < 1e-9);
    assert_eq!(document["criterion"]["unit"], "g/h");
    let si = document["judged"][0]["certainty"]["smallest_leak_kg_s"].as_f64().unwrap();
    assert!((si - 4.0 * GRAM_PER_HOUR).abs() < 1e-12);
    assert!(document["failures"][0]["isolated"].is_null());
}

#[test]
fn the_picture_names_places_levels_and_what_is_unseen() {
    let mut known = known();
    let svg = |known: &Known| known.report().figure().to_svg(&provenance()).unwrap();
    // Layouts of one cost say nothing of what accuracy costs.
    assert!(!svg(&known).contains("cost of a layout"));
    let mut dearer = known.study.judged[0].clone();
    dearer.cost += 1.0;
    known.study.judged.push(dearer);
    let svg = svg(&known);
    for words in
        ["middle", "shoulder", "valve", "no air", "smallest leak in g/h", "cost of a layout", "never"]
    {
        assert!(svg.contains(words), "{words} is missing");
    }
}
