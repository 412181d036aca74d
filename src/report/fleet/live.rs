//! The page of a fleet that goes on: that of [`page`](super::page()) with rows that are replaced while they come.
//!
//! The script listens to events of the server beside the page. `rows` has cylinders that have changed, `all` the first of all of them, and `state`
//! how old the newest row is and what is amiss.
use super::order::{self, sort_by_urgency};
use super::page::{OWN_STYLE, Own, SCRIPT, data, row, whole};
use super::row::Cylinder;
use crate::report::Provenance;
use crate::report::page::STYLE;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::html;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

const LIVE_SCRIPT: &str = include_str!("live.js");
const LIVE_STYLE: &str = include_str!("live.css");

fn script() -> String {
    [SCRIPT, LIVE_SCRIPT].concat()
}

fn style() -> String {
    [OWN_STYLE, LIVE_STYLE].concat()
}

/// What a browser may do with the page: run its own script, and ask where it comes from.
pub(crate) fn live_policy() -> String {
    let hash = |text: &str| format!("'sha256-{}'", BASE64_STANDARD.encode(Sha256::digest(text)));
    format!(
        "default-src 'none'; style-src {} {}; script-src {}; connect-src 'self'; base-uri 'none'; form-action 'none'",
        hash(STYLE),
        hash(&style()),
        hash(&script())
    )
}

/// The page of cylinders as they were at a version of them; `left_out`: how many more there are.
pub(crate) fn live_page(
    mut cylinders: Vec<Cylinder>,
    left_out: usize,
    version: &str,
    provenance: &Provenance,
) -> String {
    sort_by_urgency(&mut cylinders);
    let mut data = data(cylinders.iter().map(live_row).collect());
    data["version"] = json!(version);
    let own = Own {
        policy: live_policy(),
        style: style(),
        top: html! {
            p #link .link { "Reload the page for newer rows." }
            @if left_out > 0 { p.caution { "The page has room for " (cylinders.len()) " cylinders; " (left_out) " more are left out." } }
        },
        data,
        script: script(),
    };
    whole(&cylinders, &[], provenance, &own)
}

/// A cylinder for the script, with what it is sorted by.
pub(crate) fn live_row(one: &Cylinder) -> Value {
    let mut value = row(one);
    // An infinite time is null.
    value["u"] = json!(order::key(one));
    value
}
