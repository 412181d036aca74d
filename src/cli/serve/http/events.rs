//! The stream of events of a page: rows that have changed, and how the gateway is. Each part is made when the one before was taken, so that a slow
//! client gets the newest, and nothing waits for it.
use super::Site;
use crate::cli::serve::board::{Change, REFRESH};
use hyper::body::Bytes;
use serde_json::json;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::OwnedSemaphorePermit;
use tokio::sync::mpsc::{Receiver, Sender, channel};

/// At the latest after so long there is a word.
const WORD: Duration = Duration::from_secs(5);

/// A reader's place among the changes, as pages and events name it: the start of the gateway and a number.
pub(super) fn place(site: &Site, version: u64) -> String {
    format!("{:x}-{version}", site.status.started.as_microsecond())
}

/// The number of a place; `None`: it is one of another start.
fn version(site: &Site, place: &str) -> Option<u64> {
    let (start, version) = place.split_once('-')?;
    let version = version.parse().ok()?;
    (self::place(site, version).split_once('-')?.0 == start).then_some(version)
}

/// Events after a place.
pub(super) fn begun(site: &Arc<Site>, after: Option<&str>, permit: OwnedSemaphorePermit) -> Receiver<Bytes> {
    let known = after.and_then(|place| version(site, place));
    let (sender, receiver) = channel(1);
    tokio::spawn(told(Arc::clone(site), known, sender, permit));
    receiver
}

async fn told(site: Arc<Site>, mut known: Option<u64>, sender: Sender<Bytes>, _permit: OwnedSemaphorePermit) {
    let _watching = site.status.board.watch();
    let (mut amiss, mut said) = (None, Instant::now());
    loop {
        let (mut is_new, mut has_more) = (false, true);
        while has_more {
            let change = site.status.board.after(known);
            has_more = change.has_more;
            known = Some(change.version);
            if change.is_all || !change.rows.is_empty() {
                is_new = true;
                if sender.send(rows(&site, &change)).await.is_err() {
                    return;
                }
            }
        }
        let now = Some(site.status.amiss());
        if is_new || amiss != now || said.elapsed() >= WORD {
            (amiss, said) = (now, Instant::now());
            if sender.send(state(&site)).await.is_err() {
                return;
            }
        }
        tokio::time::sleep(REFRESH).await;
        if sender.is_closed() {
            return;
        }
    }
}

fn rows(site: &Site, change: &Change) -> Bytes {
    let event = if change.is_all { "all" } else { "rows" };
    let rows: Vec<&str> = change.rows.iter().map(|shown| shown.json()).collect();
    format!("event: {event}\nid: {}\ndata: [{}]\n\n", place(site, change.version), rows.join(",")).into()
}

fn state(site: &Site) -> Bytes {
    let words = site.status.amiss().into_iter().map(|words| {
        let mut letters = words.chars();
        letters.next().map(|first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
    });
    let words: Vec<String> = words.flatten().collect();
    let state =
        json!({ "rows": site.status.rows.count(), "age_s": site.status.newest_row_age_s(), "amiss": words });
    format!("event: state\ndata: {state}\n\n").into()
}
