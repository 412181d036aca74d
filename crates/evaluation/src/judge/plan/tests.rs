use super::*;
use crate::world::{Overlay, SimulationKey};

const PLAN: &str = r#"
title = "a first look"
between_false_alarms_y = 10.0
tune = ["*/hall/*/*/*"]
judge = ["*/railway/*/*/*"]

[[candidate]]
name = "ours"
kind = "monitor"

[[group]]
name = "weeks"
families = ["nitrogen-20l/railway|hall/mixed/class-a|class-b/120s"]
seeds = [1, 3]
sensor_sets = 2
length_d = 7.0
overlays = [{ kind = "nothing" }, { kind = "leak", part_per_h = [1e-6, 1e-5, 0.1], onset_h = [30.0, 54.0] }]
"#;

fn parse(text: &str, left_out: &[&str]) -> Result<Plan, JudgeError> {
    let left_out: Vec<String> = left_out.iter().map(|text| (*text).to_owned()).collect();
    Plan::parse(text, "plan.toml", &Registry::default(), &left_out)
}

#[test]
fn a_group_is_families_times_seeds_times_sets_times_overlays() {
    let plan = parse(PLAN, &[]).unwrap();
    assert_eq!(plan.tasks.len(), 4 * 3 * 2 * 4);
    assert_eq!(plan.tasks.iter().filter(|task| task.role == Role::Tune).count(), plan.tasks.len() / 2);
    // Of each climate and seed: one simulation for what is laid over it, and one for the leak of 10 % an hour.
    let units = plan.units();
    assert_eq!(units.len(), 2 * 3 * 2);
    let mut all: Vec<usize> = units.iter().flat_map(|unit| unit.tasks.clone()).collect();
    all.sort_unstable();
    assert_eq!(all, (0..plan.tasks.len()).collect::<Vec<_>>());
    for unit in &units {
        let key = SimulationKey::of(&unit.simulated);
        assert!(unit.tasks.iter().all(|task| SimulationKey::of(&plan.tasks[*task].request) == key));
    }
}

#[test]
fn every_file_of_plans_is_built_in_and_passes_its_checks() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/plans");
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), presets::FILES.names().count());
    for name in presets::FILES.names() {
        let text = presets::FILES.text(name).unwrap();
        let plan = parse(text, &[]).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(std::fs::read_to_string(format!("{folder}/{name}.toml")).unwrap(), text);
        let Extent { worlds, cylinder_years, simulations, simulated_years, core_s, .. } = plan.extent();
        assert!(worlds >= simulations && cylinder_years >= simulated_years && core_s > 0.0);
    }
}

#[test]
fn onsets_are_drawn_within_their_bounds_and_differ_by_seed() {
    let plan = parse(PLAN, &[]).unwrap();
    let onsets: std::collections::BTreeSet<u64> = plan
        .tasks
        .iter()
        .filter_map(|task| match task.request.overlay {
            Overlay::Leak { onset_s, .. } => Some(onset_s),
            _ => None,
        })
        .inspect(|onset_s| assert!((30.0 * 3600.0..=54.0 * 3600.0).contains(onset_s), "{onset_s}"))
        .map(f64::to_bits)
        .collect();
    assert_eq!(onsets.len(), 3);
}

#[test]
fn a_kind_that_is_left_out_judges_instead_of_tuning() {
    let plan = parse(PLAN, &["climate=hall"]).unwrap();
    assert!(plan.tasks.iter().all(|task| task.role == Role::Judge));
    assert_ne!(plan.hash().unwrap(), parse(PLAN, &[]).unwrap().hash().unwrap());
}

#[test]
fn the_hash_is_of_what_decides_the_results() {
    let hash = |text: &str| parse(text, &[]).unwrap().hash().unwrap();
    assert_eq!(hash(PLAN), hash(&format!("# a comment\n{PLAN}")));
    assert_ne!(hash(PLAN), hash(&PLAN.replace("seeds = [1, 3]", "seeds = [1, 2]")));
}

#[test]
fn every_mistake_is_refused_by_file_key_value_and_remedy() {
    let cases = [
        ("railway|hall", "winter", "families", "winter", "known are"),
        ("[1, 3]", "[3, 1]", "seeds", "3, 1", "first and last"),
        ("sensor_sets = 2", "sensor_sets = 0", "sensor_sets", "0", "at least 1"),
        ("length_d = 7.0", "length_d = -7.0", "length_d", "-7", "between"),
        ("length_d = 7.0", "length_d = 7.0\nlength_h = 1.0", "length_d", "2 lengths", "one of"),
        ("length_d = 7.0", "", "length_d", "0 lengths", "one of"),
        ("1e-6,", "-1e-6,", "part_per_h", "-0.000001", "above 0"),
        ("[30.0, 54.0]", "[30.0, 540.0]", "onset_h", "540", "before the end"),
        ("kind = \"monitor\"", "kind = \"oracle\"", "kind", "oracle", "known are"),
        ("= 10.0", "= -1.0", "between_false_alarms_y", "-1", "positive"),
        ("judge = [\"*/railway/*/*/*\"]", "judge = []", "families", "railway", "tune"),
        ("judge = [\"*/railway/*/*/*\"]", "judge = [\"*/*/*/*/*\"]", "families", "hall", "not both"),
        ("/120s", "/1s", "", "", ""),
    ];
    for (from, to, key, value, remedy) in cases {
        assert!(PLAN.contains(from), "{from}");
        let result = parse(&PLAN.replacen(from, to, 1), &[]);
        if key.is_empty() {
            assert!(result.is_ok());
            continue;
        }
        let message = result.err().map(|error| error.to_string()).unwrap_or_default();
        for part in ["plan.toml", key, value, remedy] {
            assert!(message.contains(part), "{to}: {message:?} lacks {part}");
        }
    }
    let year = PLAN.replace("/120s", "/1s").replace("length_d = 7.0", "length_d = 365.0");
    assert!(parse(&year, &[]).err().unwrap().to_string().contains("5 million"));
    let unknown = parse(&PLAN.replace("sensor_sets", "sensor_set"), &[]).err().unwrap().to_string();
    assert!(unknown.contains("plan.toml, line 1") && unknown.contains("sensor_set"), "{unknown}");
    assert!(parse(PLAN, &["climate=hot"]).err().unwrap().to_string().contains("--leave-out"));
    let setting = PLAN.replace("kind = \"monitor\"", "kind = \"monitor\"\nsettings = { learning_s = -1.0 }");
    assert!(parse(&setting, &[]).err().unwrap().to_string().contains("learning_s"));
}

#[test]
fn a_candidate_without_a_verdict_needs_families_to_tune_on() {
    let text = PLAN.replace("kind = \"monitor\"", "kind = \"paper\"");
    assert!(parse(&text, &[]).is_ok());
    let error = parse(&text, &["climate=hall"]).err().unwrap().to_string();
    assert!(error.contains("ours") && error.contains("tune"), "{error}");
}
