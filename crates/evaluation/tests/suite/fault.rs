//! What each fault does to the rows, and that the table's rows draw what the table says.
use cylwatch_thermal::units::{DAY_S, HOUR_S, MINUTE_S};
use std::collections::HashSet;

use cylwatch_evaluation::EvaluationError;
use cylwatch_evaluation::fault::{
    Arrival, DeadCode, Fault, Record, Requirement, Snapshot, Step, TableRow, UnitConfusion,
};

const ROWS: usize = 3000;
const ONSET_S: f64 = 1000.0 * MINUTE_S;

/// Rows of a minute that all differ.
fn record() -> Record {
    let row = |k: usize| {
        let t = k as f64;
        let air = 270.0 + (t / 50.0).sin();
        let readings = vec![280.0 + (t / 100.0).sin(), 279.0 + (t / 70.0).cos(), 190e5 + 1e3 * t, air];
        Step::Row(Arrival::live(t * MINUTE_S, readings))
    };
    let sensors = ["shoulder", "valve", "pressure", "ambient"].map(String::from).to_vec();
    Record { sensors, steps: (0..ROWS).map(row).collect() }
}

fn injected(fault: &Fault) -> Record {
    fault.inject(&record(), ONSET_S, 7).unwrap()
}

/// Change of a sensor's readings row by row, with the time of the row, s.
fn changes(fault: &Fault, sensor: usize) -> Vec<(f64, f64)> {
    let (before, after) = (record(), injected(fault));
    let change = |(a, b): (&Arrival, &Arrival)| (a.stamp_s, b.readings[sensor] - a.readings[sensor]);
    before.rows().zip(after.rows()).map(change).collect()
}

fn stamps(record: &Record) -> Vec<f64> {
    record.rows().map(|row| row.stamp_s).collect()
}

fn pressure() -> String {
    "pressure".into()
}

/// A sensor that is dead for an hour, a transmitter of 250 bar.
fn dead(sensor: &str, code: DeadCode) -> Fault {
    Fault::Dead { sensor: sensor.into(), code, full_scale_pa: 250e5, lasting_s: HOUR_S }
}

/// Every fault once.
fn all() -> Vec<Fault> {
    let sensor = pressure;
    vec![
        Fault::Stuck { sensor: sensor(), lasting_s: HOUR_S },
        Fault::Offset { sensor: sensor(), by: 1e5 },
        Fault::Drift { sensor: sensor(), per_s: 0.1 },
        Fault::Span { sensor: sensor(), share: 0.005, per_k: 3750.0 },
        Fault::Noise { sensor: sensor(), sd: 1e4 },
        Fault::Quantised { sensor: sensor(), step: 1e4 },
        Fault::Spikes { sensor: sensor(), height: 50e5, longest: 3, share: 0.05 },
        dead("pressure", DeadCode::Minus999),
        Fault::Lost { sensors: vec!["shoulder".into(), "valve".into()], lasting_s: HOUR_S },
        Fault::Swapped { first: "shoulder".into(), second: "valve".into() },
        Fault::Units { sensors: vec![sensor()], mix_up: UnitConfusion::GaugeAsAbsolute },
        Fault::Detached { sensor: "shoulder".into(), noise_k: 0.3 },
        Fault::Pulses { sensor: sensor(), height_pa: 1e4, mean_s: 300.0 },
        Fault::Gap { lasting_s: HOUR_S },
        Fault::Duplicates { share: 0.3 },
        Fault::OutOfOrder { by_s: 600.0, share: 0.5 },
        Fault::Replay { length_s: HOUR_S, again: true, historical: true },
        Fault::ClockJump { by_s: -HOUR_S, lasting_s: None },
        Fault::ClockDrift { rate: 1e-4 },
        Fault::Irregular { shortest_s: 1.0, longest_s: 600.0, noise_k: 0.05, noise_pa: 1e3 },
        Fault::Shifted { sensor: sensor(), by_s: 90.0 },
        Fault::PowerCycles { mean_s: HOUR_S, snapshot: Snapshot::Old },
    ]
}

/// Faults that a record has from its beginning, since they lie in how it was put up.
const OF_THE_INSTALLATION: [&str; 5] = ["span", "quantised", "swapped", "units", "shifted"];

#[test]
fn the_same_seed_puts_in_the_same_fault_and_nothing_before_its_onset() {
    let before = record();
    let mut names = HashSet::new();
    for fault in all() {
        assert!(names.insert(fault.name()));
        let (first, again) = (injected(&fault), injected(&fault));
        assert_eq!(format!("{first:?}"), format!("{again:?}"), "{}", fault.name());
        assert!(first != before, "{} changes nothing", fault.name());
        if !OF_THE_INSTALLATION.contains(&fault.name()) {
            let rows_before = (ONSET_S / MINUTE_S) as usize;
            assert_eq!(first.steps[..rows_before], before.steps[..rows_before], "{}", fault.name());
        }
        let text = serde_json::to_string(&fault).unwrap();
        assert_eq!(serde_json::from_str::<Fault>(&text).unwrap(), fault);
    }
}

#[test]
fn a_fault_that_ends_leaves_what_follows_as_it_was() {
    let untouched = |fault: Fault, sensor: usize| {
        let changes = changes(&fault, sensor);
        let until_s = ONSET_S + fault.lasting_s();
        let outside = |t: f64| t < ONSET_S || t >= until_s;
        assert!(changes.iter().all(|&(t, by)| !outside(t) || by == 0.0), "{}", fault.name());
        let within = changes.iter().filter(|(t, by)| !outside(*t) && *by != 0.0).count();
        assert!(within >= 59, "{}: {within}", fault.name());
    };
    untouched(Fault::Stuck { sensor: pressure(), lasting_s: HOUR_S }, 2);
    untouched(dead("pressure", DeadCode::NotANumber), 2);
    untouched(Fault::Lost { sensors: vec!["valve".into()], lasting_s: HOUR_S }, 1);
}

#[test]
fn a_stuck_sensor_repeats_the_first_reading_of_the_fault() {
    let after = injected(&Fault::Stuck { sensor: pressure(), lasting_s: DAY_S });
    let held: Vec<f64> = after.rows().filter(|row| row.stamp_s >= ONSET_S).map(|r| r.readings[2]).collect();
    assert!(held[..1440].iter().all(|&reading| reading == 190e5 + 1e3 * 1000.0));
    assert!(held[1440] != held[0]);
}

#[test]
fn offset_and_drift_are_what_they_say() {
    let offset = changes(&Fault::Offset { sensor: "valve".into(), by: -5.0 }, 1);
    let drift = changes(&Fault::Drift { sensor: pressure(), per_s: 0.5 }, 2);
    for (k, (&(t, offset), &(_, drift))) in offset.iter().zip(&drift).enumerate() {
        let since_s = (t - ONSET_S).max(0.0);
        let jumped = if k >= 1000 { -5.0 } else { 0.0 };
        assert!((offset - jumped).abs() < 1e-9 && (drift - 0.5 * since_s).abs() < 1e-6, "{t}");
    }
}

#[test]
fn a_span_error_grows_with_the_pressure_and_the_valves_temperature() {
    let (before, after) =
        (record(), injected(&Fault::Span { sensor: pressure(), share: 0.01, per_k: 100.0 }));
    for (a, b) in before.rows().zip(after.rows()) {
        let expected = 1.01 * a.readings[2] + 100.0 * (a.readings[1] - 288.15);
        assert!((b.readings[2] - expected).abs() < 1e-6);
    }
}

#[test]
fn noise_has_its_standard_deviation_and_no_mean() {
    let values: Vec<f64> =
        changes(&Fault::Noise { sensor: pressure(), sd: 1e4 }, 2)[1000..].iter().map(|c| c.1).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let sd = (values.iter().map(|v| v * v).sum::<f64>() / n).sqrt();
    // Four standard errors of 2000 values.
    assert!(
        mean.abs() < 4.0 * 1e4 / n.sqrt() && (sd / 1e4 - 1.0).abs() < 4.0 / (2.0 * n).sqrt(),
        "{mean} {sd}"
    );
}

#[test]
fn quantised_readings_are_multiples_no_further_than_half_a_step() {
    let after = injected(&Fault::Quantised { sensor: pressure(), step: 1e4 });
    assert!(after.rows().all(|row| row.readings[2] % 1e4 == 0.0));
    let changes = changes(&Fault::Quantised { sensor: pressure(), step: 1e4 }, 2);
    assert!(changes.iter().all(|(_, by)| by.abs() <= 5e3));
}

#[test]
fn spikes_have_their_share_their_height_and_their_length() {
    let fault = Fault::Spikes { sensor: pressure(), height: 50e5, longest: 3, share: 0.05 };
    let spikes: Vec<f64> = changes(&fault, 2)[1000..].iter().map(|c| c.1).collect();
    let share = spikes.iter().filter(|&&by| by != 0.0).count() as f64 / spikes.len() as f64;
    // 100 of 2000 readings in some 50 spikes: four standard deviations of their number.
    assert!((share - 0.05).abs() < 0.05 * 4.0 / 50_f64.sqrt(), "{share}");
    assert!(spikes.iter().all(|&by| by == 0.0 || (by.abs() - 50e5).abs() < 1e-3));
    assert!(spikes.iter().any(|&by| by > 0.0) && spikes.iter().any(|&by| by < 0.0));
    // Two spikes may touch: never more than twice the longest.
    let runs = spikes.split(|&by| by == 0.0).map(<[f64]>::len).max().unwrap();
    assert!((2..=6).contains(&runs), "{runs}");
}

#[test]
fn dead_sensors_give_what_no_sensor_measures() {
    for code in DeadCode::ALL {
        for (sensor, index, plausible) in [("pressure", 2, 0.1e5..249e5), ("shoulder", 0, 100.0..400.0)] {
            let after = injected(&dead(sensor, code));
            let reading = after.rows().nth(1010).unwrap().readings[index];
            assert!(!plausible.contains(&reading), "{code:?} {sensor}: {reading}");
        }
    }
}

#[test]
fn swapped_sensors_have_each_others_readings() {
    let after = injected(&Fault::Swapped { first: "shoulder".into(), second: "valve".into() });
    for (a, b) in record().rows().zip(after.rows()) {
        assert_eq!([a.readings[0], a.readings[1]], [b.readings[1], b.readings[0]]);
    }
}

#[test]
fn mixed_up_units_give_the_known_numbers() {
    let read = |mix_up, sensor: &str, index: usize| {
        let after = injected(&Fault::Units { sensors: vec![sensor.into()], mix_up });
        after.rows().next().unwrap().readings[index]
    };
    let close =
        |value: f64, expected: f64| assert!((value / expected - 1.0).abs() < 1e-6, "{value} {expected}");
    // 280 K are 6.85 degC, which are 44.33 degF; 190 bar are 19 000 kPa and 2755.72 psi.
    close(read(UnitConfusion::CelsiusAsKelvin, "shoulder", 0), 6.85);
    close(read(UnitConfusion::KelvinAsCelsius, "shoulder", 0), 553.15);
    close(read(UnitConfusion::FahrenheitAsCelsius, "shoulder", 0), 273.15 + 44.33);
    close(read(UnitConfusion::KilopascalAsBar, "pressure", 2), 19_000e5);
    close(read(UnitConfusion::BarAsKilopascal, "pressure", 2), 1.9e5);
    close(read(UnitConfusion::PsiAsBar, "pressure", 2), 2755.717_e5);
    close(read(UnitConfusion::BarAsPsi, "pressure", 2), 13.100_039e5);
    close(read(UnitConfusion::GaugeAsAbsolute, "pressure", 2), 188.986_75e5);
}

#[test]
fn a_detached_thermometer_reads_the_air() {
    let after = injected(&Fault::Detached { sensor: "shoulder".into(), noise_k: 0.3 });
    let off: Vec<f64> = after.rows().skip(1000).map(|row| row.readings[0] - row.readings[3]).collect();
    let sd = (off.iter().map(|v| v * v).sum::<f64>() / off.len() as f64).sqrt();
    assert!((sd / 0.3 - 1.0).abs() < 4.0 / (2.0 * off.len() as f64).sqrt(), "{sd}");
    // It needs to know the air.
    let without = record().without("ambient");
    let error =
        Fault::Detached { sensor: "shoulder".into(), noise_k: 0.3 }.inject(&without, 0.0, 1).unwrap_err();
    assert!(matches!(error, EvaluationError::NoSuchSensor { sensor, .. } if sensor == "ambient"));
}

#[test]
fn pulses_come_and_go_with_either_sign() {
    let values: Vec<f64> = changes(&Fault::Pulses { sensor: pressure(), height_pa: 1e4, mean_s: 600.0 }, 2)
        [1000..]
        .iter()
        .map(|c| c.1.round())
        .collect();
    for level in [-1e4, 0.0, 1e4] {
        let share = values.iter().filter(|&&v| v == level).count() as f64 / values.len() as f64;
        assert!(share > 0.1, "{level}: {share}");
    }
    assert!(values.iter().all(|v| [0.0, 1e4].contains(&v.abs())));
}

#[test]
fn a_gap_takes_the_rows_of_its_time_and_no_others() {
    let after = stamps(&injected(&Fault::Gap { lasting_s: HOUR_S }));
    let expected: Vec<f64> = stamps(&record())
        .into_iter()
        .filter(|stamp_s| !(ONSET_S..ONSET_S + HOUR_S).contains(stamp_s))
        .collect();
    assert!(after == expected && after.len() == ROWS - 60);
}

#[test]
fn disorder_keeps_every_row_and_delays_none_too_long() {
    let before = stamps(&record());
    for (fault, most_s, extra) in [
        (Fault::OutOfOrder { by_s: 600.0, share: 0.5 }, 600.0, 0.0),
        (Fault::Duplicates { share: 0.3 }, 600.0, 0.3),
    ] {
        let after = stamps(&injected(&fault));
        let mut sorted = after.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup();
        assert_eq!(sorted, before, "{}", fault.name());
        let many = (after.len() - ROWS) as f64 / 2000.0;
        assert!((many - extra).abs() < 4.0 * (0.25_f64 / 2000.0).sqrt(), "{}: {many}", fault.name());
        let mut latest_s = f64::NEG_INFINITY;
        let mut behind = 0;
        for stamp_s in after {
            assert!(latest_s - stamp_s <= most_s);
            behind += usize::from(stamp_s < latest_s);
            latest_s = latest_s.max(stamp_s);
        }
        assert!(behind > 100, "{}: {behind} behind", fault.name());
    }
}

#[test]
fn a_replay_comes_after_live_rows_and_may_say_what_it_is() {
    for (again, historical) in [(false, true), (true, false)] {
        let after = injected(&Fault::Replay { length_s: HOUR_S, again, historical });
        let during = |row: &&Arrival| (ONSET_S..ONSET_S + HOUR_S).contains(&row.stamp_s);
        assert_eq!(after.rows().filter(during).count(), if again { 120 } else { 60 });
        let first_live = after.rows().position(|row| row.stamp_s >= ONSET_S + HOUR_S).unwrap();
        let replayed: Vec<&Arrival> = after.rows().skip(first_live).filter(during).collect();
        assert!(replayed.len() == 60 && replayed.iter().all(|row| row.historical == historical));
        assert!(replayed.windows(2).all(|pair| pair[0].stamp_s < pair[1].stamp_s));
    }
}

#[test]
fn clocks_jump_come_back_and_drift() {
    let shift = |fault: &Fault| -> Vec<f64> {
        stamps(&injected(fault)).iter().zip(stamps(&record())).map(|(a, b)| a - b).collect()
    };
    let jump = shift(&Fault::ClockJump { by_s: -5000.0, lasting_s: Some(HOUR_S) });
    assert!(jump[..1000].iter().chain(&jump[1060..]).all(|&by| by == 0.0));
    assert!(jump[1000..1060].iter().all(|&by| by == -5000.0));
    let drift = shift(&Fault::ClockDrift { rate: 1e-4 });
    assert!((drift[2000] - 6.0).abs() < 1e-6 && drift[999] == 0.0);
}

#[test]
fn irregular_rows_lie_between_those_that_there_were() {
    let fault = Fault::Irregular { shortest_s: 1.0, longest_s: 600.0, noise_k: 0.0, noise_pa: 0.0 };
    let after = injected(&fault);
    let intervals: Vec<f64> = stamps(&after)[1001..].windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(intervals.iter().all(|&dt| (1.0 - 1e-9..=600.0 + 1e-9).contains(&dt)));
    let short = intervals.iter().filter(|&&dt| dt < 600_f64.sqrt()).count() as f64 / intervals.len() as f64;
    assert!((short - 0.5).abs() < 4.0 * 0.5 / (intervals.len() as f64).sqrt(), "{short}");
    // The pressure of the record is a straight line of time.
    assert!(after.rows().all(|row| (row.readings[2] - 190e5 - 1e3 * row.stamp_s / 60.0).abs() < 1e-3));
}

#[test]
fn a_shifted_channel_is_what_it_was_before() {
    let after = injected(&Fault::Shifted { sensor: pressure(), by_s: 90.0 });
    for (k, row) in after.rows().enumerate() {
        let expected = 190e5 + 1e3 * (k as f64 - 1.5);
        assert!(
            if k < 2 { row.readings[2].is_nan() } else { (row.readings[2] - expected).abs() < 1e-3 },
            "{k}"
        );
    }
}

#[test]
fn power_cycles_stand_between_rows_that_are_all_there() {
    let after = injected(&Fault::PowerCycles { mean_s: HOUR_S, snapshot: Snapshot::Truncated });
    assert_eq!(stamps(&after), stamps(&record()));
    let cycles = after.steps.iter().filter(|step| **step == Step::PowerCycle(Snapshot::Truncated)).count();
    // 33 hours: four standard deviations of their number.
    assert!((10..=57).contains(&cycles), "{cycles}");
}

#[test]
fn a_sensor_that_is_not_there_is_named() {
    let error = Fault::Offset { sensor: "gas_1".into(), by: 1.0 }.inject(&record(), 0.0, 1).unwrap_err();
    assert_eq!(error.to_string(), "there is no sensor `gas_1`: there are shoulder, valve, pressure, ambient");
}

#[test]
fn rows_of_the_table_draw_faults_of_their_kind_for_every_seed() {
    let kinds = |row: TableRow| -> HashSet<&'static str> {
        (0..300).filter_map(|seed| row.draw(seed)).map(|fault| fault.name()).collect()
    };
    let expected = [
        (TableRow::P1, vec!["stuck"]),
        (TableRow::P5, vec!["noise", "quantised"]),
        (TableRow::T6, vec!["swapped", "units"]),
        (TableRow::D2, vec!["duplicates", "out-of-order", "replay"]),
        (TableRow::D3, vec!["clock-drift", "clock-jump"]),
        (TableRow::D4, vec!["irregular", "shifted"]),
        (TableRow::D5, vec!["power-cycles"]),
    ];
    for (row, names) in expected {
        assert_eq!(kinds(row), names.into_iter().collect(), "{row:?}");
    }
    for row in TableRow::ALL {
        assert_eq!(row.draw(1).is_some(), row.is_of_data(), "{row:?}");
        assert_eq!(row.draw(1), row.draw(1));
    }
    assert_eq!(TableRow::P1.requirement(), Requirement::Flagged);
    assert_eq!(TableRow::ALL.map(TableRow::name).iter().collect::<HashSet<_>>().len(), 31);
}

#[test]
fn parameters_are_drawn_over_the_whole_range_of_the_table() {
    let lasting = |row: TableRow| -> (f64, f64) {
        let all = (0..500).filter_map(|seed| row.draw(seed)).map(|fault| fault.lasting_s());
        all.fold((f64::INFINITY, 0.0), |(low, high), s| (low.min(s), high.max(s)))
    };
    let within = |(low, high): (f64, f64), shortest_s: f64, longest_s: f64| {
        assert!(low >= shortest_s && low < 1.2 * shortest_s, "{low}");
        assert!(high <= longest_s && high > longest_s / 1.2, "{high}");
    };
    within(lasting(TableRow::P1), 6.0 * HOUR_S, 30.0 * DAY_S);
    within(lasting(TableRow::D1), MINUTE_S, 60.0 * DAY_S);
    let steps: HashSet<i64> = (0..200)
        .filter_map(|seed| TableRow::P2.draw(seed))
        .map(|fault| match fault {
            Fault::Offset { by, .. } => (by / 1e4).round() as i64,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(steps, HashSet::from([-50, -20, -5, 5, 20, 50]));
}
