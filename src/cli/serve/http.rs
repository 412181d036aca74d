//! The page of the fleet, `/metrics` and `/healthz`, on a thread of its own: read-only, and nothing that a client does makes the loop wait.
//!
//! | file | part |
//! |---|---|
//! | `board` | cylinders as the loop has shown them, while a page is open |
//! | `limits` | bounds and how often each was reached |
//! | `server`, `connections`, `patient` | connections: how many, how slow |
//! | `guard` | method, host and token of a request |
//! | `routes`, `content` | answers |
//! | `events` | the stream of rows that have changed |
//! | `metrics` | the text that Prometheus reads |
mod connections;
mod content;
mod events;
mod guard;
mod limits;
mod metrics;
mod patient;
mod routes;
mod server;

use super::config::Page;
use super::status::Status;
use crate::report::Provenance;
use anyhow::Context;
use limits::Counts;
use std::net::TcpListener;
use std::path::PathBuf;
use std::sync::Arc;

/// What is shown, to whom.
pub(super) struct Site {
    page: Page,
    status: Arc<Status>,
    /// Folder of the journal.
    journal: PathBuf,
    provenance: Provenance,
    counts: Counts,
    policy: String,
    rendered: routes::Rendered,
    streams: Arc<tokio::sync::Semaphore>,
    delays: tokio::sync::Semaphore,
}

impl Site {
    pub(super) fn new(page: Page, status: Arc<Status>, journal: PathBuf, provenance: Provenance) -> Self {
        Self {
            page,
            status,
            journal,
            provenance,
            counts: Counts::default(),
            policy: format!("{}; frame-ancestors 'none'", crate::report::fleet::live_policy()),
            rendered: routes::Rendered::default(),
            streams: Arc::new(tokio::sync::Semaphore::new(limits::STREAMS)),
            delays: tokio::sync::Semaphore::new(limits::DELAYS),
        }
    }
}

/// Takes the address before anything else is done.
pub(super) fn bound(page: &Page) -> anyhow::Result<TcpListener> {
    let address = page.listen;
    let listener = TcpListener::bind(address);
    let listener = listener.with_context(|| {
        format!("[page] cannot listen at {address}: choose another port, or an address of this machine")
    })?;
    listener.set_nonblocking(true)?;
    Ok(listener)
}

/// Serves until the program ends.
pub(super) fn serve(listener: TcpListener, site: Site) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build()?;
    let thread = std::thread::Builder::new().name("page".to_owned());
    thread.spawn(move || runtime.block_on(server::accept(listener, Arc::new(site))))?;
    Ok(())
}
