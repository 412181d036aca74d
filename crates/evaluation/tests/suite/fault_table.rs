//! Rows of the fault table through the monitor and the judge: `plans/fault.toml` in short.
use cylwatch_evaluation::judge::candidate::Registry;
use cylwatch_evaluation::judge::plan::Plan;
use cylwatch_evaluation::judge::watch::watch;
use cylwatch_evaluation::world::generate;

/// The monitor, and a group of worlds that is still to be filled in.
const PLAN: &str = r#"
title = "Faults"
between_false_alarms_y = 10.0
judge = ["*/*/*/*/*"]

[[candidate]]
name = "cylwatch"
kind = "monitor"

[[group]]
name = "faults"
"#;

/// Left to the long plan are offsets, and faults of the installation that a monitor has from its first row on: after a day of learning, half a bar or a kelvin while wall and
/// gas move is not told from a loss of 10 g.
const DATA: &str = r#"
families = ["nitrogen-20l/railway/mixed/class-b/120s", "argon-50l/workshop/mixed/class-a/120s"]
seeds = [21, 21]
length_d = 2.0
overlays = [{ kind = "fault", rows = ["P1", "P3", "P6", "P7", "T1", "T4", "T5", "E7", "D1", "D3", "D5"], onset_h = [30.0, 32.0] }]
"#;

/// A heater, a warm hall or a heater that cycles at one end, with the gas in layers: the gas is a kelvin from what the thermometers say.
const ONE_END: &str = r#"
families = ["hydrogen-50l/workshop/stratified/class-b/120s"]
seeds = [31, 32]
length_d = 5.0
overlays = [{ kind = "fault", rows = ["E5"], onset_h = [48.0, 96.0] }]
"#;

/// Every world of a group is recognised, and the decision never contradicts itself.
fn all_are_recognised(group: &str, worlds: usize) {
    let plan = Plan::parse(&format!("{PLAN}{group}"), "a plan", &Registry::default(), &[]).unwrap();
    assert_eq!(plan.tasks.len(), worlds);
    for task in &plan.tasks {
        let world = generate(&task.request).unwrap();
        let score = watch(&world, &*plan.candidates[0].candidate).score;
        let score = score.unwrap_or_else(|error| panic!("{:?}: {error}", task.request));
        let outcome = score.fault.unwrap();
        assert!(
            score.said > 0 && outcome.recognised && !outcome.false_loss,
            "{:?}: {outcome:?}",
            task.request
        );
        assert_eq!(score.disagreements.unwrap().disagreeing, 0, "{:?}", task.request);
    }
}

#[test]
fn faults_of_the_data_end_in_no_panic_no_nan_no_contradiction_and_no_leak() {
    all_are_recognised(DATA, 22);
}

#[test]
fn one_end_that_is_warmed_by_itself_is_no_leak() {
    all_are_recognised(ONE_END, 2);
}
