//! What a result says, in order: paragraphs, facts, tables, pictures. A terminal shows it as aligned text, a browser as a page
//! ([`Page`](super::Page)): nothing is said twice.
use super::figure::Picture;
use super::table::{Table, wrapped};

/// A part of a report.
#[derive(Clone, Debug)]
pub enum Block {
    /// A heading; a terminal leaves it out.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// What explains the table above.
    Remark(String),
    /// Something to be careful about.
    Caution(String),
    /// Names with values; an empty name continues the one above.
    Facts(Vec<(String, String)>),
    /// A table.
    Table {
        /// What stands above it; empty: nothing.
        caption: String,
        /// The table.
        table: Table,
    },
    /// A picture with what it shows; a terminal leaves it out.
    Picture {
        /// The picture.
        picture: Picture,
        /// What it shows and how to read it.
        caption: String,
    },
    /// Text as it was read, such as a file; a terminal leaves it out.
    Source {
        /// Its name.
        name: String,
        /// Its text.
        text: String,
    },
}

/// What a result says.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Title.
    pub title: String,
    /// In order.
    pub blocks: Vec<Block>,
}

impl Report {
    /// Nothing but a title.
    pub(crate) fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), blocks: Vec::new() }
    }

    /// With a heading.
    pub(crate) fn heading(mut self, words: impl Into<String>) -> Self {
        self.blocks.push(Block::Heading(words.into()));
        self
    }

    /// With a paragraph; an empty one is left out.
    pub(crate) fn text(mut self, words: impl Into<String>) -> Self {
        let words = words.into();
        if !words.is_empty() {
            self.blocks.push(Block::Text(words));
        }
        self
    }

    /// With an explanation of the table above; an empty one is left out.
    pub(crate) fn remark(mut self, words: impl Into<String>) -> Self {
        let words = words.into();
        if !words.is_empty() {
            self.blocks.push(Block::Remark(words));
        }
        self
    }

    /// With cautions.
    pub(crate) fn cautions(mut self, words: impl IntoIterator<Item = String>) -> Self {
        self.blocks.extend(words.into_iter().map(Block::Caution));
        self
    }

    /// With facts.
    pub(crate) fn facts<N: Into<String>>(mut self, facts: impl IntoIterator<Item = (N, String)>) -> Self {
        self.blocks.push(Block::Facts(facts.into_iter().map(|(name, value)| (name.into(), value)).collect()));
        self
    }

    /// With a table; one without rows is left out.
    pub(crate) fn table(mut self, caption: impl Into<String>, table: Table) -> Self {
        if table.rows() > 0 {
            self.blocks.push(Block::Table { caption: caption.into(), table });
        }
        self
    }

    /// With a table of texts; one without rows is left out.
    pub(crate) fn rows<H: AsRef<str>>(
        self,
        caption: impl Into<String>,
        header: &[H],
        rows: Vec<Vec<String>>,
    ) -> Self {
        self.table(caption, Table::of_texts(header, rows))
    }

    /// With a table and what explains it; without rows both are left out.
    pub(crate) fn explained_rows<H: AsRef<str>>(
        self,
        caption: impl Into<String>,
        header: &[H],
        rows: Vec<Vec<String>>,
        explanation: impl Into<String>,
    ) -> Self {
        if rows.is_empty() {
            return self;
        }
        self.rows(caption, header, rows).remark(explanation)
    }

    /// With a picture.
    pub(crate) fn picture(mut self, picture: impl Into<Picture>, caption: impl Into<String>) -> Self {
        self.blocks.push(Block::Picture { picture: picture.into(), caption: caption.into() });
        self
    }

    /// With a text as it was read.
    pub(crate) fn source(mut self, name: impl Into<String>, text: impl Into<String>) -> Self {
        self.blocks.push(Block::Source { name: name.into(), text: text.into() });
        self
    }

    /// With all of another one, its title left out.
    pub(crate) fn then(mut self, other: Self) -> Self {
        self.blocks.extend(other.blocks);
        self
    }

    /// For a terminal: aligned, no wider than 110 characters where it can be broken, a blank line between blocks.
    pub fn to_text(&self) -> String {
        let mut text = if self.title.is_empty() { String::new() } else { format!("{}\n", self.title) };
        let mut is_first = true;
        for block in &self.blocks {
            let words = match block {
                Block::Heading(_) | Block::Picture { .. } | Block::Source { .. } => continue,
                Block::Text(words) | Block::Remark(words) => wrapped(words),
                Block::Caution(words) => wrapped(&format!("caution: {words}")),
                Block::Facts(facts) => facts_text(facts),
                Block::Table { caption, table } => wrapped(caption) + &table.to_text(),
            };
            if !is_first && !matches!(block, Block::Remark(_)) {
                text.push('\n');
            }
            text.push_str(&words);
            is_first = false;
        }
        text
    }
}

fn facts_text(facts: &[(String, String)]) -> String {
    let width = facts.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    // Character counts: the names have letters beyond ASCII.
    let line = |(name, value): &(String, String)| {
        format!("{name}{:pad$}  {value}\n", "", pad = width - name.chars().count())
    };
    facts.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_shows_title_facts_and_tables_one_below_the_other() {
        let report = Report::new("A run")
            .heading("not shown")
            .facts([("gas °C", "1".to_owned()), ("", "2".to_owned())])
            .text("")
            .rows("counts", &["what", "n"], vec![vec!["a".into(), "10".into()]])
            .rows("none", &["what"], Vec::new());
        assert_eq!(report.to_text(), "A run\ngas °C  1\n        2\n\ncounts\nwhat   n\n----  --\na     10\n");
    }
}
