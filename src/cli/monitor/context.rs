//! What a run of the monitor over a log uses.
use super::options::Options;
use super::state::Identity;
use crate::cli::input::Inputs;
use crate::cli::message::Messages;
use crate::cli::selection::Selection;

/// What a run uses.
pub(super) struct RunContext<'a> {
    pub options: &'a Options,
    pub inputs: &'a Inputs,
    pub selection: &'a Selection,
    pub messages: &'a Messages,
    pub identity: Identity,
}
