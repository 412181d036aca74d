//! Truths as text.
use super::super::{Course, Truth, TruthLeak, TruthSettings, generate_with};
use crate::EvaluationError;

fn truth() -> Truth {
    let settings = TruthSettings {
        cylinder_cells: 2,
        gas_cells: 3,
        relative_tolerance: 1e-4,
        leak: Some(TruthLeak { rate_kg_s: 1e-5, start_s: 600.0 }),
        ..TruthSettings::default()
    };
    generate_with(&Course::Scenario1, 17, 300.0, &settings).unwrap()
}

fn text(truth: &Truth) -> String {
    let mut out = Vec::new();
    truth.write_to(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn a_truth_is_read_as_it_was_written_to_the_stated_digits() {
    let truth = truth();
    let written = text(&truth);
    let read = Truth::read_from(&mut written.as_bytes()).unwrap();
    assert_eq!(
        (&read.course, read.seed, read.parameters, read.sensors, read.leak),
        (&truth.course, truth.seed, truth.parameters, truth.sensors, truth.leak)
    );
    assert_eq!(read.log.channels, truth.log.channels);
    let close = |what: &str, a: &[f64], b: &[f64], bound: f64| {
        assert_eq!(a.len(), b.len(), "{what}");
        let far = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far <= bound, "{what} off by {far}");
    };
    // Half of the last digit written, and rounding.
    close("time", &read.time_s, &truth.time_s, 0.51e-3);
    for (what, a, b) in [
        ("gas", &read.gas_mean_k, &truth.gas_mean_k),
        ("ambient", &read.ambient_k, &truth.ambient_k),
        ("wall", &read.wall_mean_k, &truth.wall_mean_k),
        ("shoulder", &read.shoulder_k, &truth.shoulder_k),
        ("valve", &read.valve_k, &truth.valve_k),
        ("middle", &read.middle_k, &truth.middle_k),
        ("bottom", &read.bottom_k, &truth.bottom_k),
    ] {
        close(what, a, b, 0.51e-4);
    }
    close("mass", &read.mass_kg, &truth.mass_kg, 0.51e-7);
    close("pressure", &read.pressure_pa, &truth.pressure_pa, 0.51);
    for row in 0..truth.time_s.len() {
        close("temperatures", &read.log.row(row)[..4], &truth.log.row(row)[..4], 0.51e-4);
        close("pressure", &read.log.row(row)[4..], &truth.log.row(row)[4..], 0.51);
    }
    assert_eq!(read.log.time_s, read.time_s);
    assert_eq!(text(&read), written, "what was read is written as the same text");
}

#[test]
fn a_faulty_line_is_named() {
    let written = text(&truth());
    let line_of = |text: &str| match Truth::read_from(&mut text.as_bytes()) {
        Err(EvaluationError::TruthFile { line, .. }) => line,
        other => panic!("{other:?}"),
    };
    let broken = |number: usize, change: fn(&str) -> String| {
        let lines: Vec<String> = written
            .lines()
            .enumerate()
            .map(|(index, line)| if index + 1 == number { change(line) } else { line.to_owned() })
            .collect();
        lines.join("\n")
    };
    assert_eq!(line_of(""), 1);
    assert_eq!(line_of(&broken(1, |line| line.replace("seed", "sead"))), 1);
    assert_eq!(line_of(&broken(5, |line| format!("{line},1"))), 5);
    assert_eq!(line_of(&broken(7, |line| line.replacen('.', ",", 1))), 7);
    assert_eq!(line_of(&broken(9, |line| line.replacen('.', "x", 1))), 9);
}
