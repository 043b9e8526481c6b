//! HTTP connections, which every user of this machine may open: few at once, with small headers that must
//! arrive soon.
//!
//! A page that has proved that it knows the token continues over a WebSocket, which does not count here.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;
use tokio::task::{AbortHandle, yield_now};
use tokio::time::sleep;

/// Largest number of connections at once; a browser opens six for a page.
const MAX_CONNECTIONS: usize = 64;

/// Largest size of a header; browsers send one or two thousand bytes.
const MAX_HEADER_BYTES: usize = 16 << 10;

/// Time to the next attempt after the system has refused a connection for lack of files or memory.
const RETRY_INTERVAL: Duration = Duration::from_millis(100);

/// Serves all connections, for ever; a connection has `header_timeout` to send its next header. When there
/// are too many, the oldest is closed. An attacker who holds connections open therefore blocks no page,
/// because a page needs its own connections only for some milliseconds.
pub(crate) async fn serve(listener: TcpListener, router: Router, header_timeout: Duration) -> Infallible {
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new())
        .header_read_timeout(header_timeout)
        .max_buf_size(MAX_HEADER_BYTES);
    let service = TowerToHyperService::new(router);
    let mut open = VecDeque::new();
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            sleep(RETRY_INTERVAL).await;
            continue;
        };
        make_room(&mut open);
        let connection = http.serve_connection(TokioIo::new(stream), service.clone());
        open.push_back(tokio::spawn(connection.with_upgrades()).abort_handle());
        // The connection may answer before later ones take its place.
        yield_now().await;
    }
}

/// Makes room for one more connection.
fn make_room(open: &mut VecDeque<AbortHandle>) {
    open.retain(|connection| !connection.is_finished());
    if open.len() >= MAX_CONNECTIONS
        && let Some(oldest) = open.pop_front()
    {
        oldest.abort();
    }
}
