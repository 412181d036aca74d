//! A report as a page for a browser: one file that refers to nothing outside, with its pictures inside.
//!
//! The page is legible without scripts, on a phone (pictures of panels are drawn a second time for it; wide tables and
//! other pictures scroll in their own frames), in grey (curves differ in dash and
//! width), and on paper. Every picture has its words for who cannot see it.
use super::content::{Block, Report};
use super::figure::Picture;
use super::figure::style::Sheet;
use super::{Provenance, ReportError};
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Looks of all pages.
pub(super) const STYLE: &str = include_str!("page.css");

/// A page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Page<'a> {
    /// What it says.
    pub report: &'a Report,
    /// Where it comes from.
    pub provenance: &'a Provenance,
}

impl Page<'_> {
    /// The text of the file.
    ///
    /// # Errors
    /// A picture cannot be drawn.
    pub(crate) fn to_html(self) -> Result<String, ReportError> {
        let blocks = self.report.blocks.iter().enumerate().map(|(k, block)| element(k, block));
        let blocks = blocks.collect::<Result<Vec<Markup>, ReportError>>()?;
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                (head(&self.report.title, &html! {}))
                body {
                    (banner(&self.report.title))
                    (contents(&self.report.blocks))
                    main { @for block in &blocks { (block) } }
                    (origin(self.provenance))
                }
            }
        };
        Ok(page.into_string())
    }
}

/// The head of a page, with what it has beside the others.
pub(super) fn head(title: &str, own: &Markup) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="generator" content={ "cylwatch " (Provenance::VERSION) };
            title { (title) }
            style { (PreEscaped(STYLE)) }
            (own)
        }
    }
}

/// Program and title.
pub(super) fn banner(title: &str) -> Markup {
    html! { header { p.program { "cylwatch " (Provenance::VERSION) } h1 { (title) } } }
}

/// Command, inputs and seed.
pub(super) fn origin(provenance: &Provenance) -> Markup {
    html! {
        footer {
            h2 #origin { "Where this comes from" }
            div.wide {
                table {
                    tbody {
                        tr { th scope="row" { "program" } td { "cylwatch " (Provenance::VERSION) } }
                        tr { th scope="row" { "command" } td { code { (provenance.command) } } }
                        @for input in &provenance.inputs {
                            tr {
                                th scope="row" { "input" }
                                td { (input.name) br; small { "SHA-256 " code { (input.sha256) } } }
                            }
                        }
                        tr {
                            th scope="row" { "seed" }
                            td {
                                @match provenance.seed {
                                    Some(seed) => (seed),
                                    None => "none, nothing is random",
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Anchor of a heading.
fn anchor(index: usize) -> String {
    format!("s{index}")
}

/// Links to the headings, where there are some.
fn contents(blocks: &[Block]) -> Markup {
    let headings: Vec<(usize, &str)> = blocks
        .iter()
        .enumerate()
        .filter_map(|(k, block)| match block {
            Block::Heading(words) => Some((k, words.as_str())),
            _ => None,
        })
        .collect();
    html! {
        @if headings.len() > 2 {
            nav aria-label="Contents" {
                ol { @for (k, words) in &headings { li { a href={ "#" (anchor(*k)) } { (words) } } } }
            }
        }
    }
}

fn element(index: usize, block: &Block) -> Result<Markup, ReportError> {
    Ok(match block {
        Block::Heading(words) => html! { h2 id=(anchor(index)) { (words) } },
        Block::Text(words) => {
            let words = joined(words);
            html! { p { @for (k, line) in words.lines().enumerate() { @if k > 0 { br; } (line) } } }
        }
        Block::Remark(words) => {
            let words = joined(words);
            html! { p.remark { @for (k, line) in words.lines().enumerate() { @if k > 0 { br; } (line) } } }
        }
        Block::Caution(words) => html! { p.caution { strong { "Caution: " } (joined(words)) } },
        Block::Facts(facts) => html! {
            div.wide { table.facts { tbody {
                @for (name, value) in facts {
                    tr { th scope="row" { (name) } td { (joined(value)) } }
                }
            } } }
        },
        Block::Table { caption, table } => table.to_html(caption),
        Block::Picture { picture, caption } => figure(picture, caption)?,
        Block::Source { name, text } => html! {
            details { summary { (name) } pre { (text) } }
        },
    })
}

/// No line ends between a number and its unit.
fn joined(words: &str) -> String {
    const UNITS: [&str; 11] = ["\u{b0}C", "%", "bar", "K", "kg", "g", "g/h", "h", "d", "s", "min"];
    let mut pieces = words.split(' ');
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let unit = piece.lines().next().unwrap_or_default().trim_end_matches([',', ';', '.', ':', ')']);
        let is_unit = out.ends_with(|letter: char| letter.is_ascii_digit()) && UNITS.contains(&unit);
        out.push(if is_unit { '\u{a0}' } else { ' ' });
        out.push_str(piece);
    }
    out
}

fn figure(picture: &Picture, caption: &str) -> Result<Markup, ReportError> {
    let desk = picture.to_element(Sheet::DESK)?;
    let phone = picture.is_narrowable().then(|| picture.to_element(Sheet::PHONE)).transpose()?;
    Ok(html! {
        figure {
            @match phone {
                Some(phone) => { div.desk { (PreEscaped(desk)) } div.phone { (PreEscaped(phone)) } },
                None => { div.wide { (PreEscaped(desk)) } },
            }
            @for key in picture.keys() {
                p.key {
                    (key.quantity) ": "
                    @for (name, style) in key.entries { span { i style=(style) {} " " (name) } " " }
                }
            }
            @if !caption.is_empty() { figcaption { (caption) } }
            details.words { summary { "The picture in words" } p { (picture.described()) } }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Input;
    use crate::report::figure::{Figure, Item, Panel, style};

    fn report() -> Report {
        let items = vec![Item::line("a < b & \"c\"", &[0.0, 60.0], [1.0, 2.0], style::GAS_MEAN)];
        let figure = Figure::over_time("<run>", vec![Panel::new("temperature in °C", 1.0, items)]);
        Report::new("A <b>run</b>")
            .heading("one")
            .text("5 < 6 & 7 > 3")
            .cautions(["<script>".to_owned()])
            .heading("two")
            .facts([("gas", "1 °C".to_owned())])
            .rows("c", &["what", "n"], vec![vec!["<i>".into(), "-10".into()], vec!["b".into()]])
            .heading("three")
            .picture(figure, "what it shows")
            .source("vessel.toml", "name = \"<x>\"")
    }

    fn page() -> String {
        let inputs = vec![Input::of("a<b.toml", b"abc")];
        let provenance = Provenance { command: "cylwatch x '<y>'".into(), inputs, seed: None };
        Page { report: &report(), provenance: &provenance }.to_html().unwrap()
    }

    #[test]
    fn nothing_that_is_said_becomes_markup() {
        let page = page();
        for raw in ["<b>run", "<script>:", "<i>", "name = \"<x>", "a<b.toml", "'<y>'", "a < b & \"c\""] {
            assert!(!page.contains(raw), "{raw}");
        }
        assert!(!page.contains("<script"));
        assert!(page.contains("A &lt;b&gt;run&lt;/b&gt;") && page.contains("5 &lt; 6 &amp; 7 &gt; 3"));
    }

    #[test]
    fn a_number_keeps_its_unit() {
        let kept = "at \u{2212}25\u{a0}\u{b0}C (160\u{a0}bar), 5\u{a0}%\n3 dogs";
        assert_eq!(joined("at \u{2212}25 \u{b0}C (160 bar), 5 %\n3 dogs"), kept);
    }

    #[test]
    fn a_page_refers_to_nothing_outside() {
        let page = page();
        for outside in ["src=", "@import", "url(", "<link", "<iframe", "fetch(", "href=\"http"] {
            assert!(!page.contains(outside), "{outside}");
        }
        let without_namespace = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!without_namespace.contains("http"));
    }

    #[test]
    fn a_picture_has_its_words_a_table_its_heads_and_numbers_stand_right() {
        let page = page();
        assert!(page.contains("role=\"img\" aria-label=\"&lt;run&gt;. Horizontal: time, 0 s to 60 s."));
        assert!(page.contains("<th scope=\"col\" class=\"number\">n</th>"));
        assert!(
            page.contains("<td class=\"number\">-10</td>") && page.contains("<td class=\"number\"></td>")
        );
        assert!(page.contains("<nav") && page.contains("href=\"#s0\""));
    }
}
