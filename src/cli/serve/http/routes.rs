//! What is answered.
use super::Site;
use super::connections::Place;
use super::content::{Content, refusal, text};
use super::limits::{Limit, PAGE_BYTES};
use super::{events, guard, metrics};
use crate::cli::serve::board::Shown;
use crate::report::fleet::{Cylinder, live_page, sort_by_urgency};
use hyper::body::Bytes;
use hyper::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HeaderName, HeaderValue, REFERRER_POLICY, RETRY_AFTER,
    X_CONTENT_TYPE_OPTIONS, X_FRAME_OPTIONS,
};
use hyper::http::StatusCode;
use hyper::{Method, Request, Response};
use serde_json::json;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long a page waits for the loop to show the cylinders.
const WAIT: Duration = Duration::from_secs(3);
/// Between two looks whether it has.
const LOOK: Duration = Duration::from_millis(20);
/// A page that was made serves for so long.
const KEPT: Duration = Duration::from_secs(1);

/// The last page that was made, the number of its last change, and when.
#[derive(Default)]
pub(super) struct Rendered(Mutex<Option<(u64, Instant, Bytes)>>);

/// Answers a request.
pub(super) async fn answer<B>(request: &Request<B>, site: &Arc<Site>, place: &Place) -> Response<Content> {
    let mut response = match guard::refused(request, site).await {
        Some(refused) => refused,
        None => match request.uri().path() {
            "/" => page(site).await,
            "/events" => stream(request, site, place),
            "/metrics" => text(StatusCode::OK, metrics::FORMAT, metrics::text(site)),
            guard::HEALTH => health(site),
            _ => {
                site.counts.refuse(Limit::Path);
                refusal(StatusCode::NOT_FOUND, "there is /, /metrics and /healthz")
            }
        },
    };
    site.counts.answer(response.status().as_u16());
    let headers = response.headers_mut();
    let policy =
        HeaderValue::from_str(&site.policy).unwrap_or(HeaderValue::from_static("default-src 'none'"));
    headers.insert(CONTENT_SECURITY_POLICY, policy);
    for (name, value) in [
        (CACHE_CONTROL, "no-store"),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        (REFERRER_POLICY, "no-referrer"),
        (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
        (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

async fn page(site: &Site) -> Response<Content> {
    let board = &site.status.board;
    let _watching = board.watch();
    let begin = Instant::now();
    while !board.is_fresh() && begin.elapsed() < WAIT {
        tokio::time::sleep(LOOK).await;
    }
    text(StatusCode::OK, "text/html; charset=utf-8", rendered(site))
}

/// The page, made at most once in a while.
fn rendered(site: &Site) -> Bytes {
    let mut last = site.rendered.0.lock().unwrap_or_else(PoisonError::into_inner);
    let newest = site.status.board.version();
    if let Some((version, at, bytes)) = &*last
        && (*version == newest || at.elapsed() < KEPT)
    {
        return bytes.clone();
    }
    let (shown, version) = site.status.board.all();
    let (cylinders, left_out) = most_urgent(&shown, PAGE_BYTES);
    if left_out > 0 {
        site.counts.refuse(Limit::PageBytes);
    }
    let page = live_page(cylinders, left_out, &events::place(site, version), &site.provenance);
    let bytes = Bytes::from(page);
    *last = Some((version, Instant::now(), bytes.clone()));
    bytes
}

/// Those that have room, the most urgent first, and how many have none.
fn most_urgent(shown: &[Arc<Shown>], room: usize) -> (Vec<Cylinder>, usize) {
    let bytes: usize = shown.iter().map(|one| one.json().len()).sum();
    let mut cylinders: Vec<Cylinder> = shown.iter().map(|one| one.cylinder.clone()).collect();
    sort_by_urgency(&mut cylinders);
    let mean = bytes / shown.len().max(1);
    let count = if bytes <= room { shown.len() } else { room / mean.max(1) };
    let left_out = cylinders.len() - count.min(cylinders.len());
    cylinders.truncate(count);
    (cylinders, left_out)
}

fn stream<B>(request: &Request<B>, site: &Arc<Site>, place: &Place) -> Response<Content> {
    const KIND: &str = "text/event-stream";
    if request.method() == Method::HEAD {
        return text(StatusCode::OK, KIND, "");
    }
    let Ok(permit) = Arc::clone(&site.streams).try_acquire_owned() else {
        site.counts.refuse(Limit::Streams);
        let mut response = refusal(StatusCode::SERVICE_UNAVAILABLE, "as many pages are open as may be");
        response.headers_mut().insert(RETRY_AFTER, HeaderValue::from_static("5"));
        return response;
    };
    place.streams();
    let last = request.headers().get("last-event-id").and_then(|id| id.to_str().ok());
    let asked = || request.uri().query().and_then(|query| query.strip_prefix("after="));
    let mut response = text(StatusCode::OK, KIND, "");
    *response.body_mut() = Content::Parts(events::begun(site, last.or_else(asked), permit));
    response
}

fn health(site: &Site) -> Response<Content> {
    let amiss = site.status.amiss();
    let (status, word) = match amiss.is_empty() {
        true => (StatusCode::OK, "ok"),
        false => (StatusCode::SERVICE_UNAVAILABLE, "unwell"),
    };
    text(status, "application/json", format!("{}\n", json!({ "status": word, "reasons": amiss })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::serve::board::Board;

    #[test]
    fn a_page_has_the_cylinders_that_there_is_room_for() {
        let board = Board::default();
        for k in 0..10 {
            board.put(Cylinder {
                name: format!("{k}"),
                vessel: String::new(),
                logs: Vec::new(),
                found: None,
                fault: "no row has come yet".to_owned(),
                cautions: Vec::new(),
                events: 0,
                last_events: Vec::new(),
            });
        }
        let (shown, _) = board.all();
        let bytes = shown[0].json().len();
        assert_eq!(most_urgent(&shown, 10 * bytes).1, 0);
        let (cylinders, left_out) = most_urgent(&shown, 3 * bytes);
        assert_eq!((cylinders.len(), left_out, cylinders[0].name.as_str()), (3, 7, "0"));
        assert_eq!(most_urgent(&[], 1).1, 0);
    }
}
