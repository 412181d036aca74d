//! What others build on: dependencies of the libraries, the packages' contents, how to cite.
use std::path::Path;
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The packages that a library is built from, itself among them.
fn tree(package: &str, edges: &str) -> Vec<String> {
    tree_with(package, edges, &[])
}

fn tree_with(package: &str, edges: &str, more: &[&str]) -> Vec<String> {
    let arguments = ["tree", "-p", package, "-e", edges, "--prefix", "none", "--offline", "--locked"];
    let command = &mut Command::new(env!("CARGO"));
    let output = command.args(arguments).args(more).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let tree = String::from_utf8(output.stdout).unwrap();
    assert!(tree.starts_with(package), "{tree}");
    tree.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

#[test]
fn the_libraries_depend_on_nothing_that_draws_reads_arguments_or_writes_files() {
    for package in ["cylwatch-thermal", "cylwatch-estimator", "cylwatch-detector", "cylwatch-evaluation"] {
        let tree = tree(package, "normal");
        for foreign in ["plotters", "clap", "parquet", "indicatif", "flate2", "anyhow"] {
            assert!(!tree.iter().any(|found| found == foreign), "{package} depends on {foreign}");
        }
    }
}

#[test]
fn what_runs_beside_a_sensor_does_without_what_judges_it_even_in_its_tests() {
    for package in ["cylwatch-thermal", "cylwatch-estimator", "cylwatch-detector"] {
        let tree = tree(package, "all");
        assert!(!tree.iter().any(|found| found == "cylwatch-evaluation"), "{package}");
    }
}

#[test]
fn what_runs_beside_a_sensor_needs_no_solver_no_parser_no_threads_and_thirty_crates_of_others() {
    let mut tree = tree_with("cylwatch-detector", "normal", &["--no-default-features"]);
    for foreign in ["diffsol", "clarabel", "rayon", "toml", "csv", "schemars", "serde_json", "rand", "pulp"] {
        assert!(!tree.iter().any(|found| found == foreign), "it depends on {foreign}");
    }
    tree.retain(|package| !package.starts_with("cylwatch-"));
    tree.sort_unstable();
    tree.dedup();
    assert!(tree.len() <= 30, "{} crates: {tree:?}", tree.len());
}

#[test]
fn every_package_has_a_readme_and_its_licences() {
    for package in ["thermal", "estimator", "detector", "evaluation", "cosimulation"] {
        let folder = root().join("crates").join(package);
        for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(folder.join(file).exists(), "{} has no {file}", folder.display());
        }
    }
}

#[test]
fn the_citation_has_what_its_format_asks_for_and_the_version_of_the_program() {
    let page = include_str!("../../CITATION.cff");
    let version = format!("version: {}", env!("CARGO_PKG_VERSION"));
    for line in [
        "cff-version: 1.2.0",
        "title: cylwatch",
        "type: software",
        &version,
        "  - name: The cylwatch developers",
    ] {
        assert!(page.lines().any(|found| found == line), "{line} is missing");
    }
    for key in ["message: ", "authors:", "references:"] {
        assert!(page.lines().any(|found| found.starts_with(key)), "{key} is missing");
    }
    let readme = include_str!("../../README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let title = page.lines().find_map(|line| line.strip_prefix("    title: ")).unwrap();
    assert!(readme.contains(title), "{title} is not the paper of the README");
    assert!(!page.contains('\t') && !page.contains("http"));
}
