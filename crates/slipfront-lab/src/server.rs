//! The server: files of the page over HTTP, and a session for every page over a WebSocket, on 127.0.0.1 alone.

use std::future::Future;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use axum::Router;
use axum::middleware;
use axum::routing::get;
use tokio::sync::{Semaphore, watch};

use crate::opening::Start;
use crate::saves::Saves;
use crate::session::Setting;
use crate::socket::{MAX_PAGES, Shared};
use crate::{assets, guard, presets, socket};

/// How long runs that are being saved have to take their unfinished folders away when the server ends.
const TIME_TO_END: Duration = Duration::from_secs(10);

/// How the laboratory is started.
pub struct Options {
    /// What the page shows first.
    pub start: Start,
    /// The folder of results: where runs are saved, and of which runs can be shown again.
    pub results: PathBuf,
    /// Other folders in which files that cases name may lie: else they lie in the folder of the case.
    pub allow_files: Vec<PathBuf>,
    /// Tells a sentence in the terminal: what became of a run that was saved.
    pub tell: fn(&str),
    /// The port; 0 for any that is free.
    pub port: u16,
    /// Threads of a run.
    pub threads: usize,
}

/// A laboratory that can be reached, and is not served yet.
pub struct Laboratory {
    listener: TcpListener,
    port: u16,
    token: String,
    setting: Arc<Setting>,
}

impl Laboratory {
    /// Takes a port of this machine.
    ///
    /// # Errors
    /// When the port is taken, or the system gives no random numbers.
    pub fn bind(options: Options) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, options.port))?;
        listener.set_nonblocking(true)?;
        let mut random = [0; 16];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        Ok(Self {
            port: listener.local_addr()?.port(),
            listener,
            token: random.iter().map(|byte| format!("{byte:02x}")).collect(),
            setting: Arc::new(Setting {
                start: options.start,
                results: options.results,
                allow_files: options.allow_files,
                saves: Arc::new(Saves::new(options.tell)),
                threads: options.threads,
                presets: presets::entries(),
            }),
        })
    }

    /// The address of the page, with the token that opens it; `link` is what follows `#case=` in the link of another page.
    pub fn address(&self, link: Option<&str>) -> String {
        let case = link.map_or(String::new(), |link| format!("&case={link}"));
        format!("http://127.0.0.1:{}/#token={}{case}", self.port, self.token)
    }

    /// Answers until `stop` is done, and then until what is being saved has taken its unfinished folder away.
    ///
    /// # Errors
    /// When the system refuses what a server needs.
    pub fn serve(self, stop: impl Future<Output = ()> + Send + 'static) -> io::Result<()> {
        let (working, all_work) = channel();
        let setting = Arc::clone(&self.setting);
        let saves = Arc::clone(&setting.saves);
        let stopped = async move {
            stop.await;
            saves.end();
        };
        let served = self.answer(stopped, working);
        wait_for(&all_work);
        setting.saves.tell_left(&setting.results);
        served
    }

    fn answer(self, stop: impl Future<Output = ()> + Send + 'static, working: Sender<()>) -> io::Result<()> {
        let (end, ends) = watch::channel(false);
        let shared = Shared {
            setting: self.setting,
            token: self.token.into(),
            pages: Arc::new(Semaphore::new(MAX_PAGES)),
            ends,
            working,
        };
        let router = Router::new()
            .route("/ws", get(socket::connect))
            .fallback(get(assets::serve))
            .layer(middleware::from_fn_with_state(self.port, guard::guard))
            .with_state(shared);
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()?;
        runtime.block_on(async move {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let stopped = async move {
                stop.await;
                let _ = end.send(true);
            };
            axum::serve(listener, router)
                .with_graceful_shutdown(stopped)
                .await
        })
    }
}

/// Waits until all threads have ended, or for as long as they are given.
fn wait_for(all_work: &Receiver<()>) {
    let _ = all_work.recv_timeout(TIME_TO_END);
}
