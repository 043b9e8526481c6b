//! The connection to one page.

use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use axum::body::Bytes;
use axum::extract::ws::{CloseFrame, Message, Utf8Bytes, WebSocket, WebSocketUpgrade, close_code};
use axum::extract::{Path, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::json;
use slipfront_base::text::display_path;
use slipfront_session::{Host, MAX_MESSAGE, Message as Request, hello};
use tokio::sync::{Semaphore, watch};
use tokio::time::{sleep, timeout};

use crate::host::{PageHost, Setting};
use crate::outbox::{Outbox, Outgoing};
use crate::replay;
use crate::serve;
use crate::start_page::StartPage;
use crate::token::{Caller, Token};

/// The subprotocol of this version.
const PROTOCOL: &str = "slipfront.lab.v2";

/// Largest number of pages at once.
pub(crate) const MAX_PAGES: usize = 4;

/// Number of requests that may wait for a busy session. Each may have the length of [`MAX_MESSAGE`].
const MAX_WAITING_REQUESTS: usize = 8;

/// Time between two attempts to pass a request to a busy session.
const RETRY_INTERVAL: Duration = Duration::from_millis(5);

/// Time between two pings to a page that has requests waiting for a busy session.
const PING_INTERVAL: Duration = Duration::from_millis(300);

/// Setting, token, start page and limits, shared by all connections.
#[derive(Clone)]
pub(crate) struct Shared {
    pub(crate) setting: Arc<Setting>,
    pub(crate) token: Arc<Token>,
    pub(crate) start_page: StartPage,
    pub(crate) pages: Arc<Semaphore>,
    /// A flag that turns true when the server ends.
    pub(crate) ends: watch::Receiver<bool>,
    /// How long a page may take to receive a message.
    pub(crate) message_timeout: Duration,
}

/// Proves to a page that this server knows the same token, before the page proves anything.
pub(crate) async fn prove(
    State(shared): State<Shared>,
    Path((tab, nonce)): Path<(String, String)>,
) -> Result<String, StatusCode> {
    let caller = Caller::new(&tab, &nonce).ok_or(StatusCode::NOT_FOUND)?;
    Ok(shared.token.proof_of_server(caller))
}

/// Begins a session with a page that knows the token. Browsers send the tab, nonce and proof of a page as
/// subprotocols.
pub(crate) async fn connect(
    State(shared): State<Shared>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    let Some(proof) = proof_for(&headers, &shared.token) else {
        let sentence = "the token is missing or wrong: open the address that the terminal shows\n";
        return (StatusCode::UNAUTHORIZED, sentence).into_response();
    };
    shared.start_page.close();
    let Ok(page) = Arc::clone(&shared.pages).try_acquire_owned() else {
        let sentence = format!("{MAX_PAGES} pages are open already: close one of them\n");
        return (StatusCode::SERVICE_UNAVAILABLE, sentence).into_response();
    };
    upgrade
        .protocols([PROTOCOL])
        .max_message_size(MAX_MESSAGE)
        .max_frame_size(MAX_MESSAGE)
        .on_upgrade(async move |socket| {
            let mut to_page = ToPage {
                socket,
                timeout: shared.message_timeout,
            };
            // The server proves itself on this connection too: another server may have taken the port in the
            // meantime.
            let proof = json!({ "is": "proof", "proof": proof });
            if to_page
                .send(Message::Text(proof.to_string().into()))
                .await
                .is_some()
            {
                serve(to_page, &shared).await;
            }
            drop(page);
        })
}

/// The server's proof for a page that has proved that it knows the token.
fn proof_for(headers: &HeaderMap, token: &Token) -> Option<String> {
    let offered = headers.get(header::SEC_WEBSOCKET_PROTOCOL)?.to_str().ok()?;
    let said = |what| offered.split(',').find_map(|one| one.trim().strip_prefix(what));
    let caller = Caller::new(said("tab.")?, said("nonce.")?)?;
    token
        .is_proof_of_page(caller, said("proof.")?)
        .then(|| token.proof_of_server(caller))
}

async fn serve(mut to_page: ToPage, shared: &Shared) {
    let outbox = Arc::new(Outbox::default());
    let (requests, waiting) = sync_channel(MAX_WAITING_REQUESTS);
    let host = PageHost {
        setting: Arc::clone(&shared.setting),
        outbox: Arc::clone(&outbox),
        working: None,
    };
    let begun = thread::Builder::new()
        .name("session".to_owned())
        .spawn(move || begin(host, &waiting));
    if begun.is_err() {
        let sentence = "the system refuses a thread for the simulation";
        return to_page.close(close_code::ERROR, sentence).await;
    }
    forward(&mut to_page, &outbox, &requests, shared.ends.clone()).await;
    outbox.close();
}

/// Sends a page what it can choose from, and serves it until it is gone.
fn begin(host: PageHost, waiting: &Receiver<Request>) {
    let (setting, outbox) = (&host.setting, Arc::clone(&host.outbox));
    let results = &setting.results;
    outbox.reply(hello(
        &setting.presets,
        &replay::folders(results),
        Some(&display_path(results)),
    ));
    setting.saves.add_page(&outbox);
    let host: Rc<dyn Host> = Rc::new(host);
    serve::serve(&host, &outbox, waiting);
}

/// Passes messages between page and session, until one of them is gone or the server ends.
async fn forward(
    to_page: &mut ToPage,
    outbox: &Outbox,
    requests: &SyncSender<Request>,
    mut ends: watch::Receiver<bool>,
) {
    // A request that waits for a busy session.
    let mut kept = None;
    let mut asked = Instant::now();
    loop {
        if let Some(request) = kept.take() {
            kept = match requests.try_send(request) {
                Ok(()) => None,
                Err(TrySendError::Full(request)) => Some(request),
                Err(TrySendError::Disconnected(_)) => return,
            };
        }
        tokio::select! {
            outgoing = outbox.next() => {
                let message = match outgoing {
                    Outgoing::Reply(text) => Message::Text(text.into()),
                    Outgoing::Picture(bytes) => Message::Binary(bytes),
                };
                if to_page.send(message).await.is_none() {
                    return;
                }
            }
            message = to_page.socket.recv(), if kept.is_none() => match message {
                Some(Ok(Message::Text(text))) => match Request::parse(&text) {
                    Ok(request) => kept = Some(request),
                    Err(sentence) => return to_page.close(close_code::POLICY, &sentence).await,
                },
                Some(Ok(Message::Binary(_))) => {
                    return to_page.close(close_code::POLICY, "requests are texts").await;
                }
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
            },
            () = sleep(RETRY_INTERVAL), if kept.is_some() => {
                // Nothing is read from the page while a request waits: only sending shows that the page is
                // gone.
                if asked.elapsed() > PING_INTERVAL {
                    asked = Instant::now();
                    if to_page.send(Message::Ping(Bytes::new())).await.is_none() {
                        return;
                    }
                }
            }
            _ = ends.changed() => {
                return to_page.close(close_code::AWAY, "the laboratory was stopped in its terminal").await;
            }
        }
    }
}

/// Connection to a page, and the time that the page may take to receive a message.
struct ToPage {
    socket: WebSocket,
    timeout: Duration,
}

impl ToPage {
    /// Sends a message; returns none if the page is gone or does not read.
    async fn send(&mut self, message: Message) -> Option<()> {
        timeout(self.timeout, self.socket.send(message)).await.ok()?.ok()
    }

    /// Closes the connection with a reason, which may have 123 bytes.
    async fn close(&mut self, code: u16, sentence: &str) {
        let reason: String = sentence.chars().filter(char::is_ascii).take(120).collect();
        let frame = CloseFrame {
            code,
            reason: Utf8Bytes::from(reason),
        };
        self.send(Message::Close(Some(frame))).await;
    }
}
