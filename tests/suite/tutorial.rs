//! The tutorial's commands, as they stand in the chapter.
use std::path::Path;
use std::process::Command;

/// Fenced blocks of the shell.
fn blocks(chapter: &str) -> Vec<&str> {
    chapter.split("```sh\n").skip(1).map(|rest| rest.split_once("\n```").unwrap().0).collect()
}

/// Copies the files of a folder.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
    }
}

/// What stands behind a word at the beginning of a line.
fn said<'a>(output: &'a str, word: &str) -> &'a str {
    let line = output.lines().find(|line| line.starts_with(word));
    line.unwrap_or_else(|| panic!("no line `{word}` in\n{output}")).split_at(word.len()).1.trim()
}

/// `(low, high)` of the first interval `(low to high)` of a line.
fn interval(line: &str) -> (f64, f64) {
    let inside = line.split(['(', ')']).nth(1).unwrap();
    let (low, high) = inside.split_once(" to ").unwrap();
    (low.parse().unwrap(), high.parse().unwrap())
}

#[test]
fn every_command_of_the_tutorial_runs_and_the_monitor_finds_the_leak_that_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().unwrap();
    copy(&root.join("book/tutorial"), &folder.path().join("book/tutorial"));
    let chapter = std::fs::read_to_string(root.join("book/src/tutorial.md")).unwrap();
    let script: String =
        blocks(&chapter).iter().enumerate().map(|(n, block)| format!("echo '== {n}'\n{block}\n")).collect();
    let program = Path::new(env!("CARGO_BIN_EXE_cylwatch")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let output = Command::new("bash")
        .args(["-c", &format!("exec 2>&1\n{script}")])
        .current_dir(folder.path())
        .env("PATH", path)
        .env_remove("NO_COLOR")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let step = |command: &str| {
        let n = blocks(&chapter).iter().position(|block| block.contains(command)).unwrap();
        let part = text
            .split(&format!("== {n}\n"))
            .nth(1)
            .unwrap_or_else(|| panic!("nothing of {command} in\n{text}"));
        part.split("\n== ").next().unwrap()
    };

    assert!(step("cylwatch inspect").contains("pressure_barg=Druck"), "{}", step("cylwatch inspect"));
    assert!(step("cylwatch init").contains("vessel.toml"));
    assert!(said(step("estimate vessel.toml"), "log").starts_with("576 rows"));
    // The true film is 1.35 times that of the file.
    let film: Vec<&str> = said(step("cylwatch calibrate"), "outside-film").split_whitespace().collect();
    let [low, high] = [2, 3].map(|n| film[n].parse::<f64>().unwrap());
    assert!(low < 1.35 && 1.35 < high, "{film:?}");

    let verdict = step("monitor calibrated.toml log.csv");
    assert_eq!(said(verdict, "verdict"), "leak");
    assert_eq!(said(verdict, "exit code"), "1");
    // 1.5 g/h from 391 h to 504 h.
    for (word, truth) in [("leak rate", 1.5), ("lost since", 169.5)] {
        let (low, high) = interval(said(verdict, word));
        assert!(low < truth && truth < high, "{word}: {low} to {high}");
    }
    assert!(said(verdict, "since").starts_with("2026-01-28"));
    let after = step("--acknowledge");
    assert!(after.contains("alarm leak acknowledged") && said(after, "exit code") == "1");
}
