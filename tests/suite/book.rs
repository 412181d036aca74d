//! What the book and the pages at the root promise: links, includes, pictures, commands, sources and tests that are there.
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use cylwatch::thermal::units::UNITS;

use crate::support::run;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Files of a folder with an ending, sorted.
fn files(folder: &Path, ending: &str) -> BTreeSet<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.extension().is_some_and(|found| found == ending)).collect()
}

/// Chapters, and the pages at the root.
fn pages() -> Vec<PathBuf> {
    let at_root =
        ["README.md", "CONTRIBUTING.md", "NOTATION.md", "CHANGELOG.md"].map(|name| root().join(name));
    files(&root().join("book/src"), "md").into_iter().chain(at_root).collect()
}

/// A page as mdBook includes it, fenced blocks taken out: what is prose.
fn prose(text: &str) -> String {
    let mut fenced = false;
    let kept = text.lines().filter(|line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        !fenced && !fence
    });
    kept.collect::<Vec<_>>().join("\n")
}

/// Prose without inline code, in which brackets mean nothing.
fn words(prose: &str) -> String {
    prose.split('`').step_by(2).collect::<Vec<_>>().join(" ")
}

/// Inline codes of prose.
fn codes(prose: &str) -> Vec<&str> {
    prose.split('`').skip(1).step_by(2).collect()
}

/// Fenced blocks of a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let opening = format!("```{language}\n");
    text.split(&opening)
        .skip(1)
        .map(|rest| rest.split_once("\n```").map_or(rest, |(block, _)| block))
        .collect()
}

/// `(text, target, whether it is an image)` of each link.
fn links(words: &str) -> Vec<(String, String, bool)> {
    let mut found = Vec::new();
    for (at, _) in words.match_indices("](") {
        let target = words[at + 2..].split(')').next().unwrap().to_owned();
        let mut depth = 0;
        let opening = words[..at].rfind(|c| {
            depth += i32::from(c == ']') - i32::from(c == '[');
            depth < 0
        });
        let opening = opening.unwrap_or_else(|| panic!("a link to {target} without an opening bracket"));
        found.push((words[opening + 1..at].to_owned(), target, words[..opening].ends_with('!')));
    }
    found
}

/// What mdBook and GitHub make of a heading.
fn slug(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

/// `(path, part)` of each include of a page.
fn includes(text: &str) -> Vec<(&str, Option<&str>)> {
    let inside = text.split("{{#include ").skip(1).map(|rest| rest.split_once("}}").unwrap().0.trim());
    inside
        .map(|include| include.split_once(':').map_or((include, None), |(path, part)| (path, Some(part))))
        .collect()
}

/// Anchors of a page with what it includes.
fn anchors(page: &Path) -> BTreeSet<String> {
    let mut text = read(page);
    for (path, _) in includes(&text.clone()) {
        if path.ends_with(".md") {
            text.push_str(&read(&page.parent().unwrap().join(path)));
        }
    }
    let prose = prose(&text);
    let headings = prose.lines().filter(|line| line.starts_with('#'));
    headings.map(|line| slug(&line.trim_start_matches('#').replace('`', ""))).collect()
}

#[test]
fn every_chapter_stands_in_the_summary_once() {
    let folder = root().join("book/src");
    let summary = folder.join("SUMMARY.md");
    let mut listed = BTreeSet::new();
    for (title, target, _) in links(&words(&prose(&read(&summary)))) {
        assert!(!title.is_empty(), "{target} has no title");
        assert!(listed.insert(folder.join(&target)), "{target} stands in the summary twice");
    }
    let mut there = files(&folder, "md");
    there.remove(&summary);
    assert_eq!(listed, there);
}

#[test]
fn every_link_and_its_anchor_resolves() {
    let folder = root().join("book/src");
    for page in pages() {
        for (_, target, image) in links(&words(&prose(&read(&page)))) {
            if target.starts_with("http") {
                continue;
            }
            let (path, anchor) =
                target.split_once('#').map_or((&target[..], None), |(path, anchor)| (path, Some(anchor)));
            let file = if path.is_empty() { page.clone() } else { page.parent().unwrap().join(path) };
            assert!(file.exists(), "{}: {target} is not there", page.display());
            let inside = !path.contains("..") && (path.ends_with(".md") || image || path.is_empty());
            assert!(
                !page.starts_with(&folder) || inside,
                "{}: {target} lies outside of the book",
                page.display()
            );
            if let Some(anchor) = anchor {
                assert!(anchors(&file).contains(anchor), "{}: {target} has no such heading", page.display());
            }
        }
    }
}

#[test]
fn every_image_says_what_it_shows_and_none_is_left_over() {
    let mut used = BTreeSet::new();
    for page in pages() {
        for (text, target, _) in
            links(&words(&prose(&read(&page)))).into_iter().filter(|(_, _, image)| *image)
        {
            assert!(text.len() > 30, "{}: {target} has no text that says what it shows", page.display());
            used.insert(page.parent().unwrap().join(target).canonicalize().unwrap());
        }
    }
    let folder = root().join("book/src/images").canonicalize().unwrap();
    let there: BTreeSet<_> = ["png", "svg"].iter().flat_map(|ending| files(&folder, ending)).collect();
    assert_eq!(used, there);
    let bytes: u64 = there.iter().map(|path| path.metadata().unwrap().len()).sum();
    assert!(bytes < 3_300_000, "{bytes} bytes of pictures");
}

/// The command that a picture says it is from: a line of the description of an SVG, of a text chunk of a PNG.
fn command_of(image: &Path) -> String {
    let bytes = std::fs::read(image).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let line = text.split("command: ").nth(1).and_then(|rest| rest.lines().next());
    line.unwrap_or_else(|| panic!("{} states no command", image.display())).to_owned()
}

#[test]
fn every_image_states_a_command_that_works_in_any_folder_and_stands_in_the_text() {
    let folder = root().join("book/src/images");
    let texts: String = pages().iter().map(|page| read(page)).collect();
    let texts = texts.replace("\\\n", " ").replace("cargo run -- ", "cylwatch ");
    let texts = texts.split_whitespace().collect::<Vec<_>>().join(" ");
    for image in ["png", "svg"].iter().flat_map(|ending| files(&folder, ending)) {
        let command = command_of(&image);
        let is_known =
            ["cylwatch ", "cargo run --release --example "].iter().any(|of| command.starts_with(of));
        assert!(is_known && texts.contains(&command), "{}: {command}", image.display());
        for word in command.split([' ', '=', '\'', '"']) {
            assert!(!Path::new(word).is_absolute(), "{}: {word} in: {command}", image.display());
        }
    }
}

#[test]
fn every_include_resolves_and_every_included_example_runs_in_the_tests() {
    let tests = read(&root().join("tests/suite/examples.rs"));
    for page in files(&root().join("book/src"), "md") {
        let text = read(&page);
        for (path, part) in includes(&text) {
            let file = page.parent().unwrap().join(path);
            let source = read(&file);
            if let Some(part) = part {
                for mark in ["ANCHOR", "ANCHOR_END"] {
                    let found = source.lines().any(|line| line.trim().ends_with(&format!("{mark}: {part}")));
                    assert!(found, "{}: {path} has no {mark}: {part}", page.display());
                }
            }
            if let Some(example) = path.strip_prefix("../../examples/") {
                assert!(tests.contains(&format!("../../examples/{example}\"")), "{example} runs in no test");
            }
        }
    }
}

/// Commands of a block: comments and continuations resolved, pipes and lists taken apart.
fn commands(block: &str) -> Vec<Vec<String>> {
    let joined = block.replace("\\\n", " ");
    let parts =
        joined.lines().map(|line| line.split(" #").next().unwrap()).filter(|line| !line.starts_with('#'));
    let parts = parts.flat_map(|line| line.split(['|', ';', '&']));
    parts.map(|part| part.split_whitespace().map(str::to_owned).collect()).collect()
}

/// Arguments of the program in a command, if it runs the program.
fn arguments(command: &[String]) -> Option<&[String]> {
    let at = command.iter().position(|word| !word.contains('='))?;
    let command = &command[at..];
    if command[0] == "cylwatch" {
        return Some(&command[1..]);
    }
    let of_cargo = command.len() > 4 && command[..4] == ["cargo", "run", "--release", "--"];
    of_cargo.then(|| &command[4..])
}

/// Whether an option stands in the help, or the same quantity in another unit: `--next-service-d` for `--next-service-min`.
fn knows(known: &BTreeSet<String>, option: &str) -> bool {
    let mut stems = UNITS.iter().map(|unit| unit.suffix.replace('_', "-"));
    known.contains(option)
        || stems.any(|unit| {
            let stem = option.strip_suffix(&unit).filter(|stem| stem.ends_with('-') && stem.len() > 3);
            stem.is_some_and(|stem| known.iter().any(|known| known.starts_with(stem)))
        })
}

#[test]
fn every_command_of_the_program_in_a_block_has_the_options_that_stand_there() {
    let folder = tempfile::tempdir().unwrap();
    let mut helps: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut seen = 0;
    for page in pages() {
        for command in blocks(&read(&page), "sh").into_iter().flat_map(commands) {
            let Some(arguments) = arguments(&command) else { continue };
            let Some(name) = arguments.first() else {
                panic!("{}: cylwatch without a command", page.display())
            };
            let known = helps.entry(name.clone()).or_insert_with(|| {
                let help = run(folder.path(), &[name, "--help"]);
                assert_eq!(help.code, Some(0), "{}: no command {name}", page.display());
                let words = help.stdout.split(|c: char| !(c.is_alphanumeric() || c == '-'));
                words.filter(|word| word.starts_with('-')).map(str::to_owned).collect()
            });
            let is_option =
                |word: &&String| word.starts_with('-') && word.len() > 1 && word.parse::<f64>().is_err();
            for option in arguments.iter().skip(1).filter(is_option) {
                let option = option.split('=').next().unwrap();
                assert!(knows(known, option), "{}: {name} has no {option}", page.display());
            }
            seen += 1;
        }
    }
    assert!(seen > 20, "{seen} commands");
}

#[test]
fn every_example_and_bench_that_is_named_is_there() {
    let folders = [".", "crates/thermal", "crates/estimator", "crates/detector", "crates/evaluation"]
        .map(|name| root().join(name));
    for page in pages() {
        let text = read(&page);
        for (flag, folder) in [("--example ", "examples"), ("--bench ", "benches")] {
            for rest in text.split(flag).skip(1) {
                let name = rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap();
                let there = folders.iter().any(|at| {
                    let at = at.join(folder);
                    at.join(format!("{name}.rs")).exists() || at.join(name).join("main.rs").exists()
                });
                assert!(there, "{}: {flag}{name} is not there", page.display());
            }
        }
    }
}

/// A path of the repository in inline code, with the function that it may name: `path.rs::function`.
fn source_path(code: &str) -> Option<(&str, Option<&str>)> {
    let folders = ["crates/", "src/", "tests/", "examples/", "book/", "data/", "benches/", ".ci/"];
    let plain = !code.contains(|c: char| c.is_whitespace() || "<>*{".contains(c));
    (plain && folders.iter().any(|folder| code.starts_with(folder)))
        .then(|| code.split_once("::").map_or((code, None), |(path, name)| (path, Some(name))))
}

#[test]
fn every_source_file_and_test_that_the_text_cites_is_there() {
    for page in pages() {
        for (path, name) in codes(&prose(&read(&page))).into_iter().filter_map(source_path) {
            let file = root().join(path);
            assert!(file.exists(), "{}: {path} is not there", page.display());
            if let Some(name) = name {
                let there = read(&file).contains(&format!("fn {name}"));
                assert!(there, "{}: {path} has no function {name}", page.display());
            }
        }
    }
}

#[test]
fn every_source_key_stands_in_the_references() {
    let references = read(&root().join("references.bib"));
    for page in files(&root().join("book/src"), "md") {
        let words = words(&prose(&read(&page)));
        for rest in words.split('[').skip(1) {
            let Some((key, after)) = rest.split_once(']') else { continue };
            let is_key =
                !after.starts_with('(') && key.contains(|c: char| c.is_ascii_digit() || key == "buecking");
            if is_key && key.starts_with(|c: char| c.is_ascii_lowercase()) && !key.contains(' ') {
                assert!(references.contains(&format!("{{{key},")), "{}: no source {key}", page.display());
            }
        }
    }
}
