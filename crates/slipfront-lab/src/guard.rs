//! The check of who sends a request: only pages that this server itself has sent to a browser on this machine
//! are answered.
//!
//! Pages of other sites can send requests to 127.0.0.1 too. The browser then reports their origin, which is
//! refused. A foreign host name that resolves to 127.0.0.1 is detected by the header `Host`.

use axum::extract::{Request, State};
use axum::http::header::{self, HeaderMap, HeaderName, HeaderValue};
use axum::http::{StatusCode, Uri};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// Headers of every answer: the page loads files only from this server, and no other site can embed or read
/// it.
const HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; media-src blob:; connect-src 'self'; \
         frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (
        HeaderName::from_static("cross-origin-resource-policy"),
        "same-origin",
    ),
    (
        HeaderName::from_static("cross-origin-opener-policy"),
        "same-origin",
    ),
];

/// Answers requests from this machine to this server, and refuses all others.
pub(crate) async fn guard(State(port): State<u16>, request: Request, next: Next) -> Response {
    let mut response = match refusal(request.headers(), request.uri(), port) {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    for (name, value) in HEADERS {
        response
            .headers_mut()
            .insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Whether a `Host` header names this machine and the port of the server.
fn is_this_server(host: &str, port: u16) -> bool {
    let names = ["127.0.0.1", "localhost", "[::1]"];
    names.iter().any(|name| host == format!("{name}:{port}"))
}

fn refusal(headers: &HeaderMap, uri: &Uri, port: u16) -> Option<(StatusCode, &'static str)> {
    let text = |name| headers.get(name).map(|value| value.to_str().unwrap_or_default());
    let hosts = headers.get_all(header::HOST).iter().count();
    if hosts != 1
        || uri.authority().is_some()
        || !text(header::HOST).is_some_and(|host| is_this_server(host, port))
    {
        return Some((
            StatusCode::MISDIRECTED_REQUEST,
            "the laboratory answers under 127.0.0.1 alone\n",
        ));
    }
    let foreign = |origin: &str| {
        !origin
            .strip_prefix("http://")
            .is_some_and(|host| is_this_server(host, port))
    };
    if text(header::ORIGIN).is_some_and(foreign) {
        return Some((
            StatusCode::FORBIDDEN,
            "pages of other sites may not use the laboratory\n",
        ));
    }
    None
}
