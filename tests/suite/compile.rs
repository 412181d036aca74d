//! `cylwatch compile`: a controller with its bytes says what `cylwatch monitor` says.
use crate::support::{column, files, refused, rows as csv_rows, run};
use cylwatch::detector::compiled::CompiledCylinder;
use cylwatch::detector::evidence::Tails;
use cylwatch::log::{Cells, MemoryLog};
use cylwatch::report::Values;
use cylwatch::run::{self, Call};
use tempfile::tempdir;

const FILL: [&str; 4] = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"];

fn compile<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["compile", "nitrogen-20l"], &FILL[..], more].concat()
}

/// Columns of a log of six hours, a row a minute, SI.
fn rows() -> [Vec<f64>; 4] {
    let wave = |minute: usize, phase: f64| (minute as f64 / 50.0 - phase).sin();
    let of = |value: &dyn Fn(usize) -> f64| (0..360).map(value).collect();
    [
        of(&|minute| 60.0 * minute as f64),
        of(&|minute| 285.0 + 5.0 * wave(minute, 0.0)),
        of(&|minute| if minute == 77 { f64::NAN } else { 285.3 + 5.0 * wave(minute, 0.2) }),
        of(&|minute| 197e5 + 3e5 * wave(minute, 0.3)),
    ]
}

#[test]
fn a_controller_says_what_the_command_says_bit_for_bit() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &compile(&["-o", "cylinder.bin", "--limit-bar", "150"]));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("shoulder in K, valve in K, pressure in Pa"), "{}", outcome.stderr);
    let bytes = std::fs::read(folder.path().join("cylinder.bin")).unwrap();
    let cylinder = CompiledCylinder::from_bytes(&bytes).unwrap();
    // Without built-in vessels nothing else says that these thresholds are its own.
    assert_eq!(cylinder.settings.tails, Some(Tails::of(&cylinder.vessel, 200e5)));
    assert_ne!(cylinder.settings.tails, Some(Tails::usual(&cylinder.vessel, 200e5)));
    let mut monitor = cylinder.monitor().unwrap();
    let columns = rows();
    let mut outputs = Vec::new();
    for (row, &time_s) in columns[0].iter().enumerate() {
        outputs.extend(monitor.step(time_s, &[1, 2, 3].map(|at| columns[at][row])).unwrap());
    }
    outputs.extend(monitor.finish().unwrap());

    let names = ["time_s", "shoulder_k", "valve_k", "pressure_pa"].map(str::to_owned);
    let columns = names.into_iter().zip(rows().map(Cells::Numbers)).collect();
    let log = MemoryLog { name: "rows".to_owned(), columns };
    let options = [("fill-pressure-bar", "200"), ("fill-temperature-degc", "15"), ("limit-bar", "150")];
    let call = options
        .iter()
        .fold(Call::new("nitrogen-20l").log(log), |call, (name, value)| call.option(name, Some(value)));
    let of_command = run::monitor(call).unwrap().rows;
    let column =
        |name: &str| match &of_command.columns.iter().find(|column| column.name == name).unwrap().values {
            Values::Numbers(_, numbers) => numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>(),
            other => panic!("{name}: {other:?}"),
        };
    let ours = |of: &dyn Fn(&cylwatch::detector::monitor::Output) -> f64| {
        outputs.iter().map(|output| of(output).to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(outputs.len(), 360);
    assert_eq!(ours(&|output| output.estimate.mass_kg), column("mass_kg"));
    assert_eq!(
        ours(&|output| output.decision.leak_probability.unwrap_or(f64::NAN)),
        column("leak_probability")
    );
}

#[test]
fn an_array_in_c_has_the_same_bytes_and_says_where_they_come_from() {
    let folder = tempdir().unwrap();
    run(folder.path(), &compile(&["-o", "cylinder.bin", "--quiet"]));
    let outcome = run(folder.path(), &compile(&["-o", "cylinder.c", "--quiet"]));
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    let bytes = std::fs::read(folder.path().join("cylinder.bin")).unwrap();
    let text = std::fs::read_to_string(folder.path().join("cylinder.c")).unwrap();
    let (_, array) = text.split_once("cw_cylinder[] = {").unwrap();
    let (array, rest) = array.split_once("};").unwrap();
    let numbers: Vec<u8> = array.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    assert_eq!(numbers, bytes);
    assert!(rest.contains(&format!("cw_cylinder_size = {};", bytes.len())), "{rest}");
    assert!(text.contains("cylwatch compile nitrogen-20l") && text.contains("sha256"), "{text}");
}

#[test]
fn what_a_controller_could_not_begin_with_is_refused() {
    let folder = tempdir().unwrap();
    for (arguments, words) in [
        (
            vec!["compile", "nitrogen-20l", "-o", "x.bin"],
            "give --fill-pressure-bar and --fill-temperature-degc",
        ),
        (
            vec!["compile", "nitrogen-20l", "-o", "x.bin", "--fill-pressure-bar", "200"],
            "give --fill-pressure-bar and --fill-temperature-degc",
        ),
        (compile(&["-o", "x.bin", "--readings", "shoulder,nose"]), "the place of nose is unknown"),
        (compile(&["-o", "x.bin", "--announced", "0..60"]), "leave it out"),
        (compile(&["-o", "x.bin", "--sensors", "none.toml"]), "none.toml"),
        (compile(&["-o", "no/folder/x.bin"]), "there is no folder"),
        (compile(&["-o", "-", "--footprint"]), "--output and --footprint name the same place"),
        (compile(&["--footprint=xml"]), "possible values: csv, json"),
        (compile(&[]), "--output <FILE>"),
    ] {
        refused(folder.path(), &arguments, &[words]);
    }
}

#[test]
fn a_footprint_has_the_bytes_of_this_cylinder_and_what_the_targets_take() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &compile(&["--footprint=csv", "--quiet"]));
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    assert_eq!(files(folder.path()), Vec::<String>::new());
    let (header, lines) = csv_rows(&outcome.stdout);
    let value = |target: &str, quantity: &str| -> f64 {
        let line = lines.iter().find(|line| line[0] == target).unwrap_or_else(|| panic!("no {target}"));
        let place = header.iter().position(|name| *name == quantity);
        line[place.unwrap_or_else(|| panic!("no {quantity}"))].parse().unwrap_or(f64::NAN)
    };
    let here = |quantity: &str| value("this cylinder", quantity);
    run(folder.path(), &compile(&["-o", "cylinder.bin", "--quiet"]));
    let bytes = std::fs::read(folder.path().join("cylinder.bin")).unwrap();
    assert_eq!(here("cylinder_bytes"), bytes.len() as f64);
    let fresh = CompiledCylinder::from_bytes(&bytes).unwrap().monitor().unwrap().save().unwrap();
    assert!(here("state_bytes") >= fresh.len() as f64, "{} below {}", here("state_bytes"), fresh.len());
    assert!(here("arena_begin_bytes") > here("state_bytes"));
    assert!(here("arena_row_bytes") >= here("arena_begin_bytes"));
    // The state lies with the caller, what is read of it in the arena.
    assert!(here("arena_restore_bytes") > here("arena_row_bytes"));
    // This is the reference cylinder.
    for quantity in ["arena_begin_bytes", "arena_row_bytes", "arena_restore_bytes"] {
        let ratio = here(quantity) / value("64 bits", quantity);
        let old = "assets/footprint.csv is old, run bindings/controller/test";
        assert!((0.9..1.1).contains(&ratio), "{old}: {quantity} has changed to {ratio} of it");
    }
    assert!(here("code_bytes").is_nan(), "the code is that of a target");
    for target in ["Cortex-M7", "Cortex-M4F"] {
        for quantity in &header[3..] {
            assert!(value(target, quantity) > 0.0, "{target}: {quantity}");
        }
        // Pointers of half the length.
        assert!(value(target, "arena_begin_bytes") < value("64 bits", "arena_begin_bytes"));
    }
}

#[test]
fn a_footprint_is_the_same_in_every_run_and_more_with_more_sensors() {
    let folder = tempdir().unwrap();
    let footprint = |more: &[&str]| {
        let outcome = run(folder.path(), &compile(&[&["--footprint=csv", "--quiet"], more].concat()));
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stdout
    };
    let arena = |text: &str| column(text, "arena_begin_bytes")[0];
    let three = footprint(&[]);
    assert_eq!(footprint(&[]), three);
    let two = footprint(&["--readings", "shoulder,pressure"]);
    assert!(arena(&two) < arena(&three), "{} and {}", arena(&two), arena(&three));
}

#[test]
fn a_footprint_for_people_names_every_quantity_and_the_build_it_is_measured_with() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &compile(&["--footprint", "-o", "cylinder.bin"]));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(files(folder.path()), ["cylinder.bin"]);
    let words = "compiled cylinder, saved state, arena to begin, arena between rows, code, constants, stack of a row, row on average, \
        Cortex-M7, Cortex-M4F, bytes, instructions, `controller`, 64 bits";
    for word in words.split(", ") {
        assert!(outcome.stdout.contains(word), "`{word}` is missing in\n{}", outcome.stdout);
    }
    let document = run(folder.path(), &compile(&["--footprint=json"])).stdout;
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["columns"]["target"][0], "this cylinder");
    assert!(document["columns"]["state_bytes"][0].as_u64() > Some(0), "{document}");
}
