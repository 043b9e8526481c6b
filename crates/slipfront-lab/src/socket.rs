//! The connection with one page.

use std::sync::Arc;
use std::sync::mpsc::{Sender, SyncSender, TrySendError, sync_channel};
use std::thread;
use std::time::Duration;

use axum::extract::State;
use axum::extract::ws::{CloseFrame, Message, Utf8Bytes, WebSocket, WebSocketUpgrade, close_code};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use tokio::sync::{Semaphore, watch};
use tokio::time::{sleep, timeout};

use crate::outbox::{Outbox, Outgoing};
use crate::protocol::{MAX_MESSAGE, PROTOCOL, Request};
use crate::session::{self, Setting};

/// Most pages at once.
pub(crate) const MAX_PAGES: usize = 4;

/// Requests that wait for the session.
const WAITING: usize = 64;

/// How long a page may take to receive a message.
const PATIENCE: Duration = Duration::from_secs(10);

/// Time between two attempts to hand a request to a session that is busy.
const RETRY: Duration = Duration::from_millis(5);

/// What every connection is given.
#[derive(Clone)]
pub(crate) struct Shared {
    pub(crate) setting: Arc<Setting>,
    pub(crate) token: Arc<str>,
    pub(crate) pages: Arc<Semaphore>,
    /// Turns true when the server ends.
    pub(crate) ends: watch::Receiver<bool>,
    /// Held by every thread as long as it works.
    pub(crate) working: Sender<()>,
}

/// Begins a session with a page that has the token. Browsers send it as a subprotocol, so that it stands in no address.
pub(crate) async fn connect(
    State(shared): State<Shared>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    let offered = headers.get(header::SEC_WEBSOCKET_PROTOCOL);
    let offered = offered.and_then(|value| value.to_str().ok()).unwrap_or_default();
    let mut tokens = offered
        .split(',')
        .filter_map(|one| one.trim().strip_prefix("token."));
    if !tokens.any(|token| is_equal(token, &shared.token)) {
        let sentence = "the token is missing or wrong: open the address that the terminal shows\n";
        return (StatusCode::UNAUTHORIZED, sentence).into_response();
    }
    let Ok(page) = Arc::clone(&shared.pages).try_acquire_owned() else {
        let sentence = format!("{MAX_PAGES} pages are open already: close one of them\n");
        return (StatusCode::SERVICE_UNAVAILABLE, sentence).into_response();
    };
    upgrade
        .protocols([PROTOCOL])
        .max_message_size(MAX_MESSAGE)
        .max_frame_size(MAX_MESSAGE)
        .on_upgrade(async move |socket| {
            serve(socket, &shared).await;
            drop(page);
        })
}

/// In a time that does not depend on where they differ.
fn is_equal(one: &str, other: &str) -> bool {
    let differences = one
        .bytes()
        .zip(other.bytes())
        .fold(0, |all, (a, b)| all | (a ^ b));
    one.len() == other.len() && differences == 0
}

async fn serve(mut socket: WebSocket, shared: &Shared) {
    let outbox = Arc::new(Outbox::default());
    let (requests, waiting) = sync_channel(WAITING);
    let (setting, filled, working) = (
        Arc::clone(&shared.setting),
        Arc::clone(&outbox),
        shared.working.clone(),
    );
    let begun = thread::Builder::new().name("session".to_owned()).spawn(move || {
        session::serve(&setting, &filled, &waiting, &working);
    });
    if begun.is_err() {
        return close(
            &mut socket,
            close_code::ERROR,
            "the system refuses a thread for the simulation",
        )
        .await;
    }
    let mut ends = shared.ends.clone();
    loop {
        tokio::select! {
            outgoing = outbox.next() => {
                let message = match outgoing {
                    Outgoing::Reply(text) => Message::Text(text.into()),
                    Outgoing::Picture(bytes) => Message::Binary(bytes),
                };
                if !matches!(timeout(PATIENCE, socket.send(message)).await, Ok(Ok(()))) {
                    return;
                }
            }
            message = socket.recv() => match message {
                Some(Ok(Message::Text(text))) => match serde_json::from_str(&text) {
                    Ok(request) => if hand_over(&requests, request).await.is_none() { return },
                    Err(error) => {
                        let sentence = format!("not a request: {error}");
                        return close(&mut socket, close_code::POLICY, &sentence).await;
                    }
                },
                Some(Ok(Message::Binary(_))) => {
                    return close(&mut socket, close_code::POLICY, "requests are texts").await;
                }
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
            },
            _ = ends.changed() => {
                return close(&mut socket, close_code::AWAY, "the laboratory was stopped in its terminal").await;
            }
        }
    }
}

/// Gives a request to the session, which may be behind; none if it is gone.
async fn hand_over(requests: &SyncSender<Request>, request: Request) -> Option<()> {
    let mut request = request;
    loop {
        request = match requests.try_send(request) {
            Ok(()) => return Some(()),
            Err(TrySendError::Full(request)) => request,
            Err(TrySendError::Disconnected(_)) => return None,
        };
        sleep(RETRY).await;
    }
}

/// Ends the connection with a reason, of which there is room for 123 bytes.
async fn close(socket: &mut WebSocket, code: u16, sentence: &str) {
    let reason: String = sentence.chars().filter(char::is_ascii).take(120).collect();
    let frame = CloseFrame {
        code,
        reason: Utf8Bytes::from(reason),
    };
    let _ = timeout(PATIENCE, socket.send(Message::Close(Some(frame)))).await;
}
