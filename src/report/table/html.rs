//! A table as an element of a page.
use super::Table;
use maud::{Markup, html};

impl Table {
    /// As an element, below its caption; an empty caption is left out.
    pub(crate) fn to_html(&self, caption: &str) -> Markup {
        // Beside the table, not in it: a caption inside is broken at the width of a narrow table.
        let named = (!caption.is_empty()).then_some(caption);
        let class: Vec<Option<&str>> =
            self.columns.iter().map(|column| column.is_numeric().then_some("number")).collect();
        html! {
            @if let Some(caption) = named { p.caption { (caption) } }
            div.wide {
                table aria-label=[named] {
                    @if self.has_header() {
                        thead { tr {
                            @for (column, class) in self.columns.iter().zip(&class) {
                                th scope="col" class=[*class] { (column.heading()) }
                            }
                        } }
                    }
                    tbody {
                        @for row in 0..self.rows() {
                            tr {
                                @for (k, (column, class)) in self.columns.iter().zip(&class).enumerate() {
                                    @let cell = column.values.cell(row).to_text();
                                    @if k == 0 { th scope="row" class=[*class] { (cell) } }
                                    @else { td class=[*class] { (cell) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
