//! Bounds of what clients may take, each counted when it is reached.
use crate::cli::serve::status::Counter;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Connections at once; a new one takes the place of the oldest that has not asked yet.
pub(super) const CONNECTIONS: usize = 64;
/// Open pages.
pub(super) const STREAMS: usize = 16;
/// Bytes before the body of a request.
pub(super) const HEAD_BYTES: usize = 16_384;
/// Fields of a request.
pub(super) const FIELDS: usize = 64;
/// Time in which a request must be there.
pub(super) const REQUEST_TIME: Duration = Duration::from_secs(5);
/// Time in which a client must take something of what is sent.
pub(super) const STALL_TIME: Duration = Duration::from_secs(15);
/// Time in which a client must have taken all, unless it listens to events.
pub(super) const ANSWER_TIME: Duration = Duration::from_secs(60);
/// Rows of a page, bytes: the most urgent that have room.
pub(super) const PAGE_BYTES: usize = 24 << 20;
/// After a wrong token.
pub(super) const DELAY: Duration = Duration::from_secs(1);
/// Wrong tokens that are answered late at once; more are answered at once, so that they take no connections.
pub(super) const DELAYS: usize = 8;

/// Why a client does not get what it wants, or not all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Limit {
    Connections,
    Streams,
    HeadBytes,
    RequestTime,
    ReadingTime,
    PageBytes,
    Body,
    Method,
    Host,
    Path,
    Token,
    Tls,
    /// No HTTP, or cut short.
    Form,
}

impl Limit {
    pub(super) const ALL: [Self; 13] = [
        Self::Connections,
        Self::Streams,
        Self::HeadBytes,
        Self::RequestTime,
        Self::ReadingTime,
        Self::PageBytes,
        Self::Body,
        Self::Method,
        Self::Host,
        Self::Path,
        Self::Token,
        Self::Tls,
        Self::Form,
    ];

    /// Value of the label `limit`.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Connections => "connections",
            Self::Streams => "streams",
            Self::HeadBytes => "head_bytes",
            Self::RequestTime => "request_time",
            Self::ReadingTime => "reading_time",
            Self::PageBytes => "page_bytes",
            Self::Body => "body",
            Self::Method => "method",
            Self::Host => "host",
            Self::Path => "path",
            Self::Token => "token",
            Self::Tls => "tls",
            Self::Form => "form",
        }
    }
}

/// How often each limit was reached, and how often each status was answered.
#[derive(Default)]
pub(super) struct Counts {
    refused: [Counter; Limit::ALL.len()],
    answered: Mutex<BTreeMap<u16, u64>>,
}

impl Counts {
    pub(super) fn refuse(&self, limit: Limit) {
        self.refused[limit as usize].add();
    }

    pub(super) fn answer(&self, status: u16) {
        *self.answered.lock().unwrap_or_else(PoisonError::into_inner).entry(status).or_default() += 1;
    }

    pub(super) fn refused(&self) -> impl Iterator<Item = (Limit, u64)> {
        Limit::ALL.into_iter().map(|limit| (limit, self.refused[limit as usize].count()))
    }

    pub(super) fn answered(&self) -> BTreeMap<u16, u64> {
        self.answered.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Why a connection ended before its answer did.
    pub(super) fn broken(&self, error: &hyper::Error) {
        let cause = std::error::Error::source(error).and_then(|cause| cause.downcast_ref::<std::io::Error>());
        let is_slow = cause.is_some_and(|cause| cause.kind() == std::io::ErrorKind::TimedOut);
        if is_slow {
            self.refuse(Limit::ReadingTime);
        } else if error.is_timeout() {
            self.refuse(Limit::RequestTime);
        } else if error.is_parse_too_large() {
            self.refuse(Limit::HeadBytes);
        } else if error.is_parse() || error.is_incomplete_message() {
            self.refuse(Limit::Form);
        }
        // Otherwise the client has gone.
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_limit_has_its_own_count_and_word() {
        let counts = Counts::default();
        for (k, limit) in Limit::ALL.into_iter().enumerate() {
            (0..=k).for_each(|_| counts.refuse(limit));
        }
        let refused: Vec<u64> = counts.refused().map(|(_, count)| count).collect();
        assert_eq!(refused, (1..=Limit::ALL.len() as u64).collect::<Vec<_>>());
        let words: std::collections::BTreeSet<_> = Limit::ALL.map(Limit::label).into();
        assert_eq!(words.len(), Limit::ALL.len());
    }
}
