//! What others build on: dependencies of the libraries, the packages' contents, how to cite.
use std::path::Path;
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_libraries_depend_on_nothing_that_draws_reads_arguments_or_writes_files() {
    for package in ["cylwatch-thermal", "cylwatch-estimator", "cylwatch-detector"] {
        let arguments = ["tree", "-p", package, "-e", "normal", "--prefix", "none", "--offline", "--locked"];
        let output = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().unwrap();
        let tree = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(tree.starts_with(package), "{tree}");
        for foreign in ["plotters", "clap", "parquet", "indicatif", "flate2", "anyhow"] {
            let found = tree.lines().any(|line| line.split(' ').next() == Some(foreign));
            assert!(!found, "{package} depends on {foreign}:\n{tree}");
        }
    }
}

#[test]
fn every_package_has_a_readme_and_its_licences() {
    for package in ["thermal", "estimator", "detector"] {
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
