//! What the pages at the root promise.
use cylwatch::thermal::units::UNITS;

#[test]
fn every_unit_of_the_files_stands_in_the_notation() {
    let page = include_str!("../../NOTATION.md");
    for unit in UNITS {
        assert!(page.contains(&format!("`_{}`", unit.suffix)), "_{} is missing in NOTATION.md", unit.suffix);
    }
}

#[test]
fn the_readme_names_the_two_commands_and_its_files_are_there() {
    let page = include_str!("../../README.md");
    for command in ["cargo run -- reproduce", "cargo test"] {
        assert!(page.contains(&format!("```sh\n{command}\n```")), "{command}");
    }
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for target in page.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target) {
        // Anchors are those of the test of the book.
        let file = target.split('#').next().unwrap_or(target);
        assert!(target.starts_with("http") || root.join(file).exists(), "{target} is not there");
    }
}
