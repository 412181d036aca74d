//! What a log holds, as text for a terminal and as JSON.
mod document;
mod text;

pub use document::document;
pub use text::{summary, text};
