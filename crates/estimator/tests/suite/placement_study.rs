//! Candidates, scenarios and the study on the 20 L cylinder.
use approx::assert_relative_eq;
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::placement::search::{Method, SearchControl};
use cylwatch_estimator::placement::study::{BiasSource, Placement, Proof, Study, StudySettings};
use cylwatch_estimator::placement::{
    Candidates, Criterion, Objective, PublishedRecord, Quantity, ScenarioAnalysis, ScenarioMeasure, Status,
    SteadyAnalysis, SteadySettings, Variant, read_candidates,
};
use cylwatch_estimator::thermal::scenario;
use cylwatch_estimator::thermal::vessel::{Vessel, presets};

fn vessel() -> Vessel {
    presets::load("nitrogen-20l").unwrap()
}

fn all() -> Candidates {
    Candidates::of_vessel(&vessel()).unwrap()
}

/// A file of few candidates.
const FEW: &str = r#"
minimum_distance_mm = 100

[[sensor]]
name = "bottom"
[[sensor]]
name = "middle"
lag_s = 40
[[sensor]]
name = "shoulder"
[[sensor]]
name = "side"
height_mm = 500
[[sensor]]
name = "valve"
[[sensor]]
name = "ambient"
[[sensor]]
name = "pressure"

[[rule]]
sensor = "shoulder"
cost = 3
[[rule]]
sensor = "ambient"
status = "forbidden"
[[group]]
members = ["bottom", "valve"]
at_most = 1
"#;

fn few() -> Candidates {
    read_candidates(FEW, "few.toml", &vessel()).unwrap()
}

fn layout(candidates: &Candidates, names: &[&str]) -> Vec<usize> {
    let mut layout: Vec<usize> = names.iter().map(|name| candidates.index(name).unwrap()).collect();
    layout.sort_unstable();
    layout
}

#[test]
fn every_place_of_the_vessel_is_a_candidate() {
    let candidates = all();
    let on_wall: Vec<f64> = candidates.list.iter().filter_map(|of| of.height_m).collect();
    assert_eq!(on_wall.len(), 12, "one for each column of the wall");
    assert!(on_wall.is_sorted() && on_wall[0] > 0.0 && on_wall[11] < 0.8, "{on_wall:?}");
    for (name, status) in [
        ("bottom", Status::Allowed),
        ("middle", Status::Allowed),
        ("shoulder", Status::Allowed),
        ("neck", Status::Allowed),
        ("valve", Status::Allowed),
        ("ambient", Status::Allowed),
        ("gas_1", Status::Forbidden),
        ("pressure", Status::Required),
    ] {
        let index = candidates.index(name).unwrap_or_else(|| panic!("no {name}"));
        assert_eq!(candidates.list[index].status, status, "{name}");
    }
}

#[test]
fn rules_of_a_file_are_constraints() {
    let candidates = few();
    let constraints = candidates.constraints(3, 4.0);
    let allowed = |names: &[&str]| constraints.allow(&layout(&candidates, names));
    assert!(allowed(&["bottom", "middle", "pressure"]));
    assert!(!allowed(&["bottom", "valve", "pressure"]), "at most one of the group");
    assert!(!allowed(&["middle", "side", "pressure"]), "83 mm apart");
    assert!(!allowed(&["bottom", "shoulder", "pressure"]), "costs 5");
    assert!(!allowed(&["bottom", "ambient", "pressure"]), "forbidden");
    assert!(!allowed(&["bottom", "middle", "valve"]), "without pressure");
    assert_eq!(candidates.list[candidates.index("middle").unwrap()].sensor.lag_s, 40.0);
}

#[test]
fn what_is_wrong_in_a_file_is_told_with_line_and_remedy() {
    for (from, to, parts) in [
        ("cost = 3", "cost = -3", &["few.toml:23", "-3", "at least 0"][..]),
        ("sensor = \"ambient\"", "sensor = \"ambiance\"", &["ambiance", "a candidate", "ambient"]),
        ("at_most = 1", "at_least = 3", &["at_least", "at most 2"]),
        ("status = \"forbidden\"", "status = \"never\"", &["never", "forbidden"]),
        ("minimum_distance_mm = 100", "minimum_distance_mm = -1", &["minimum_distance_mm", "at least 0"]),
        ("height_mm = 500", "height_mm = 5000", &["few.toml:12", "side", "5 m"]),
        ("[[group]]", "[[grup]]", &["grup", "group"]),
    ] {
        let text = FEW.replace(from, to);
        let message = read_candidates(&text, "few.toml", &vessel()).unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}

fn analysis(candidates: &Candidates, name: &str) -> ScenarioAnalysis {
    let scenario = scenario::presets::load(name).unwrap();
    ScenarioAnalysis::new(&vessel(), &scenario, &candidates.sensors(), &SteadySettings::default().observer)
        .unwrap()
}

#[test]
fn model_error_adds_to_what_the_filter_states() {
    let candidates = few();
    let scenario = analysis(&candidates, "shock-cold");
    let accuracy = scenario.accuracy(&layout(&candidates, &["middle", "pressure"])).unwrap();
    assert!(
        accuracy.gas_schmidt_k.mean > accuracy.gas_sd_k.mean
            && accuracy.gas_schmidt_k.worst > accuracy.gas_sd_k.worst
    );
    assert!(accuracy.gas_worst_case_k.worst > accuracy.gas_sd_k.worst);
    assert_eq!(accuracy.variants.len(), Variant::ALL.len());
    let of = |wanted: Variant| accuracy.variants.iter().find(|of| of.variant == wanted).unwrap().gas_k.mean;
    // A coupling that is larger than supposed and one that is smaller are wrong in different directions.
    assert!(
        (of(Variant::Couplings(1.0)) - of(Variant::Couplings(-1.0))).abs() > 0.01,
        "{:?}",
        accuracy.variants
    );
    // In well-mixed gas the attitude is all one, in stratified gas it is not.
    assert!(
        (of(Variant::OtherAttitude) - of(Variant::StratifiedGas)).abs() > 1e-3,
        "{:?}",
        accuracy.variants
    );
    // A second thermometer leaves less of it.
    let more =
        scenario.accuracy(&layout(&candidates, &["bottom", "middle", "shoulder", "pressure"])).unwrap();
    assert!(more.gas_sd_k.mean < accuracy.gas_sd_k.mean);
}

fn study(
    settings: StudySettings,
    candidates: &Candidates,
    scenarios: &[&str],
) -> Result<Study, EstimatorError> {
    let scenarios: Vec<_> = scenarios.iter().map(|name| scenario::presets::load(name).unwrap()).collect();
    Placement::new(&vessel(), candidates, &scenarios, &settings)?.run(&SearchControl::default())
}

#[test]
fn a_study_holds_together() {
    let candidates = few();
    let settings = StudySettings { sensors: 4, ..StudySettings::default() };
    let study = study(settings, &candidates, &["shock-cold"]).unwrap();
    // A pressure alone tells nothing, so it begins at two.
    assert_eq!(study.numbers.iter().map(|number| number.sensors).collect::<Vec<_>>(), [2, 3, 4]);
    assert!(!study.partial);
    for number in &study.numbers {
        assert_eq!((number.method, number.proof), (Method::Exhaustive, Proof::Search));
        assert!(number.gap().unwrap() == 0.0 && number.relaxation.unwrap() <= number.layouts[0].value);
        assert!(number.layouts.iter().all(|of| of.value <= 1.02 * number.layouts[0].value + 1e-18));
        assert!(number.marginal.is_none_or(|by| (-1.0..=0.0).contains(&by)), "{:?}", number.marginal);
    }
    // No judged layout is better than the best by the criterion; their numbers are those of the search.
    for judged in &study.judged {
        let number = study.numbers.iter().find(|of| of.sensors == judged.sensors.len()).unwrap();
        let leak = judged.number(Criterion::LeakRate).unwrap();
        assert!(leak >= number.layouts[0].value * (1.0 - 1e-9));
        if judged.sensors == number.layouts[0].sensors {
            assert_relative_eq!(leak, number.layouts[0].value, max_relative = 1e-9);
        }
        let constraints = candidates.constraints(judged.sensors.len(), f64::INFINITY);
        assert!(constraints.allow(&judged.sensors));
    }
    for front in [&study.accuracy_front, &study.delay_front] {
        assert!(front.complete && front.points.len() >= 2);
        assert!(front.points.windows(2).all(|of| of[0].cost < of[1].cost && of[0].value > of[1].value));
    }
    let pressure = candidates.index("pressure").unwrap();
    for failure in &study.failures {
        assert!(failure.isolated >= failure.found * (1.0 - 1e-9) && failure.found > 0.0);
        assert_eq!(failure.without.is_none(), failure.sensor == pressure);
        assert_eq!(failure.unseen.as_deref() == Some("mass_kg"), failure.sensor == pressure);
        if let Some(without) = failure.without {
            let with = study.judged.iter().find(|of| of.sensors.len() == 4).unwrap().steady;
            assert!(without.leak_sd_kg_s >= with.leak_sd_kg_s);
        }
    }
    // The transmitter's offset moves the gas temperature at once, and the observer learns it away from there into the mass.
    let offset = |sensor| study.biases.iter().find(|of| of.source == BiasSource::Offset(sensor)).unwrap();
    let of_pressure = offset(pressure);
    assert!(
        of_pressure.gas_k[0] > 0.1 && of_pressure.gas_k[2].abs() < 0.2 * of_pressure.gas_k[0],
        "{of_pressure:?}"
    );
    assert_eq!(study.positions.len(), candidates.list.len() - 1);
    let by_paper = study.published.unwrap();
    assert_eq!(by_paper.scores.len(), 5, "neither the air nor the pressure");
    assert_eq!(by_paper.valve_against_shoulder.len(), PublishedRecord::ALL.len());
    let best = by_paper.best_of(&["valve", "shoulder"], PublishedRecord::Identification).unwrap();
    assert_eq!(best.name, "shoulder");
    assert!(by_paper.best_of(&["pressure"], PublishedRecord::Identification).is_none());
}

#[test]
fn posterior_and_leak_rank_middle_and_shoulder_apart_from_what_the_gas_says() {
    // Beside the valve the middle is a little better for the gas temperature and far better for a leak.
    let candidates = all();
    let placement = Placement::new(&vessel(), &candidates, &[], &StudySettings::default()).unwrap();
    let judge = |name| placement.evaluate(&layout(&candidates, &[name, "valve", "pressure"])).unwrap();
    let (middle, shoulder) = (judge("middle"), judge("shoulder"));
    let ratio = |criterion| middle.number(criterion).unwrap() / shoulder.number(criterion).unwrap();
    let (gas, leak) = (ratio(Criterion::GasTemperature), ratio(Criterion::SmallestLeak));
    println!("middle over shoulder: gas temperature {gas:.3}, smallest leak {leak:.3}");
    assert!(leak < gas && leak < 0.85);
    assert!(
        middle.delay_s < shoulder.delay_s
            && middle.number(Criterion::Scenario(ScenarioMeasure::Mean)).is_none()
    );
}

/// The bar: 25 % with one thermometer beside the pressure, 10 % with four.
#[test]
fn the_bound_is_near_the_best_layout_of_the_cylinder() {
    for (criterion, sensors) in [(Criterion::GasTemperature, 5), (Criterion::LeakRate, 3)] {
        let settings = StudySettings { sensors, criterion, ..StudySettings::default() };
        let candidates = all();
        let placement = Placement::new(&vessel(), &candidates, &[], &settings).unwrap();
        let numbers = placement.numbers(&SearchControl::default()).unwrap();
        assert_eq!(numbers.len(), sensors - 1);
        for (number, most) in numbers.iter().zip([0.25, 0.25, 0.25, 0.10]) {
            let gap = number.relaxation_gap().unwrap();
            println!(
                "{} beside the pressure by {}: {:?}, gap {:.2} %",
                number.sensors - 1,
                criterion.as_str(),
                candidates.names(&number.layouts[0].sensors),
                100.0 * gap
            );
            assert!(gap <= most && number.relaxation.unwrap() <= number.layouts[0].value * (1.0 + 1e-9));
            assert!(number.frank_wolfe.unwrap() <= number.relaxation.unwrap() * (1.0 + 1e-9));
        }
    }
}

/// Rounding ends the doubling of a covariance that grows for ever, and what it then says was once taken for a steady state.
#[test]
fn a_pressure_alone_has_no_steady_state_whatever_the_vessel() {
    for (name, nodes) in [("nitrogen-20l", 6), ("nitrogen-20l", 3), ("nitrogen-20l-paper", 6)] {
        let vessel = presets::load(name).unwrap();
        let candidates = Candidates::of_vessel(&vessel).unwrap();
        let mut settings = SteadySettings::default();
        settings.observer.wall_nodes = nodes;
        let steady = SteadyAnalysis::new(&vessel, &candidates.sensors(), &settings).unwrap();
        let alone = [candidates.index("pressure").unwrap()];
        for quantity in [Quantity::GasTemperature, Quantity::Mass, Quantity::LeakRate] {
            let value = steady.problem(quantity).value(&alone);
            assert_eq!(value, f64::INFINITY, "{name}, {nodes} nodes, {quantity:?}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let of = |change: &dyn Fn(&mut Candidates, &mut StudySettings)| {
        let (mut candidates, mut settings) = (few(), StudySettings::default());
        change(&mut candidates, &mut settings);
        study(settings, &candidates, &[]).unwrap_err()
    };
    let pressure = few().index("pressure").unwrap();
    let error = of(&|candidates, _| candidates.list[pressure].status = Status::Forbidden);
    assert!(matches!(&error, EstimatorError::Unseen { state } if state == "mass_kg"), "{error}");
    type Change = fn(&mut Candidates, &mut StudySettings);
    let changes: [(Change, &str); 5] = [
        (|_, settings| settings.budget = 0.5, "budget"),
        (|_, settings| settings.sensors = 20, "20 sensors"),
        (
            |candidates, _| {
                candidates.minimum_distance_m = 5.0;
                candidates.list.iter_mut().take(2).for_each(|of| of.status = Status::Required);
            },
            "too close",
        ),
        (|_, settings| settings.criterion = Criterion::Scenario(ScenarioMeasure::Mean), "scenario"),
        (|candidates, _| candidates.list.iter_mut().for_each(|of| of.status = Status::Required), "required"),
    ];
    for (change, part) in changes {
        let message = of(&change).to_string();
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn a_study_that_is_stopped_says_so() {
    let candidates = few();
    let placement = Placement::new(&vessel(), &candidates, &[], &StudySettings::default()).unwrap();
    let control = SearchControl::default();
    control.stop.store(true, std::sync::atomic::Ordering::Relaxed);
    let study = placement.run(&control).unwrap();
    assert!(study.partial && study.numbers.is_empty() && study.failures.is_empty());
}
