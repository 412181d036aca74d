//! Whether a request may be answered: its method, that it has no body, the host it was sent to, and the token.
use super::Site;
use super::content::{Content, refusal};
use super::limits::{DELAY, Limit};
use crate::cli::serve::config::Token;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use hyper::header::{
    ALLOW, AUTHORIZATION, CONTENT_LENGTH, HOST, HeaderMap, HeaderValue, TRANSFER_ENCODING, WWW_AUTHENTICATE,
};
use hyper::http::StatusCode;
use hyper::{Method, Request, Response};

/// Path for health checks, which needs no token.
pub(super) const HEALTH: &str = "/healthz";
/// How a browser is asked for the token: it then sends it with every request, those for events as well.
const CHALLENGE: &str = "Basic realm=\"cylwatch: any user, the token as password\", charset=\"UTF-8\"";

/// What a request is refused with; `None`: it may be answered.
pub(super) async fn refused<B>(request: &Request<B>, site: &Site) -> Option<Response<Content>> {
    let refused = |limit: Limit, status: StatusCode, words| {
        site.counts.refuse(limit);
        Some(refusal(status, words))
    };
    let headers = request.headers();
    if ![Method::GET, Method::HEAD].contains(request.method()) {
        let mut response =
            refused(Limit::Method, StatusCode::METHOD_NOT_ALLOWED, "only GET and HEAD are answered")?;
        response.headers_mut().insert(ALLOW, HeaderValue::from_static("GET, HEAD"));
        return Some(response);
    }
    let has_length = headers.get(CONTENT_LENGTH).is_some_and(|length| length != "0");
    if has_length || headers.contains_key(TRANSFER_ENCODING) {
        return refused(Limit::Body, StatusCode::PAYLOAD_TOO_LARGE, "a request has no body here");
    }
    if site.page.listen.ip().is_loopback() && !is_own(request, &site.page.host_names) {
        let words = "the host is not this gateway: a name that it has is named in host_names of [page]";
        return refused(Limit::Host, StatusCode::MISDIRECTED_REQUEST, words);
    }
    match &site.page.token {
        Some(token) if request.uri().path() != HEALTH => unadmitted(headers, token, site).await,
        _ => None,
    }
}

/// Whether the host is this machine by its address or a name that it has: the page of another name that leads here is none of ours.
fn is_own<B>(request: &Request<B>, names: &[String]) -> bool {
    let host = match request.uri().authority() {
        Some(authority) => Some(authority.as_str()),
        None => request.headers().get(HOST).and_then(|host| host.to_str().ok()),
    };
    let Some(host) = host else { return false };
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    let name = name.trim_start_matches('[').trim_end_matches(']');
    let is_loopback = name.parse::<std::net::IpAddr>().is_ok_and(|address| address.is_loopback());
    let is_named = |known: &str| name.eq_ignore_ascii_case(known);
    is_loopback || is_named("localhost") || names.iter().any(|known| is_named(known))
}

async fn unadmitted(headers: &HeaderMap, token: &Token, site: &Site) -> Option<Response<Content>> {
    let given = headers.get(AUTHORIZATION).and_then(|value| value.to_str().ok()).map(token_of);
    match given {
        Some(Some(given)) if token.is(&given) => return None,
        None => {}
        Some(_) => {
            site.counts.refuse(Limit::Token);
            if let Ok(_delay) = site.delays.try_acquire() {
                tokio::time::sleep(DELAY).await;
            }
        }
    }
    let mut response =
        refusal(StatusCode::UNAUTHORIZED, "a token is needed: as Bearer, or as password of any user");
    response.headers_mut().insert(WWW_AUTHENTICATE, HeaderValue::from_static(CHALLENGE));
    Some(response)
}

/// The token of a header: `Bearer TOKEN`, or `Basic` with any user and the token.
fn token_of(header: &str) -> Option<Vec<u8>> {
    let (scheme, rest) = header.split_once(' ')?;
    if scheme.eq_ignore_ascii_case("bearer") {
        return Some(rest.trim().as_bytes().to_vec());
    }
    if !scheme.eq_ignore_ascii_case("basic") {
        return None;
    }
    let login = BASE64_STANDARD.decode(rest.trim()).ok()?;
    let colon = login.iter().position(|byte| *byte == b':')?;
    Some(login[colon + 1..].to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(host: &str) -> Request<()> {
        Request::builder().uri("/").header(HOST, host).body(()).unwrap()
    }

    #[test]
    fn only_hosts_that_are_this_machine_are_answered() {
        let names = ["gateway.depot".to_owned()];
        for host in
            ["localhost", "localhost:8742", "127.0.0.1:1", "127.9.9.9", "[::1]:8742", "Gateway.Depot:80"]
        {
            assert!(is_own(&asked(host), &names), "{host}");
        }
        for host in
            ["", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "10.0.0.1", "gateway"]
        {
            assert!(!is_own(&asked(host), &names), "{host}");
        }
        assert!(!is_own(&Request::builder().uri("/").body(()).unwrap(), &names));
        let absolute =
            Request::builder().uri("http://evil.example/").header(HOST, "localhost").body(()).unwrap();
        assert!(!is_own(&absolute, &names));
    }

    #[test]
    fn a_token_comes_as_bearer_or_as_password() {
        let token = |header: &str| token_of(header).map(|token| String::from_utf8(token).unwrap());
        assert_eq!(token("Bearer abc").as_deref(), Some("abc"));
        assert_eq!(token("basic dXNlcjphOmI=").as_deref(), Some("a:b"));
        assert_eq!(token("Basic OmFiYw==").as_deref(), Some("abc"));
        for header in ["", "abc", "Basic", "Basic dXNlcg==", "Basic !", "Digest abc"] {
            assert_eq!(token(header), None, "{header}");
        }
    }
}
