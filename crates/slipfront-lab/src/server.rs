//! The server: files of the page over HTTP, and a session for every page over a WebSocket, only on 127.0.0.1.

use std::future::Future;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::middleware;
use axum::routing::get;
use tokio::sync::{Semaphore, watch};
use tokio::time::timeout;

use crate::host::Setting;
use crate::saves::Saves;
use crate::socket::{MAX_PAGES, Shared};
use crate::start::Start;
use crate::start_page::{PrivateFile, StartPage};
use crate::token::Token;
use crate::{assets, connections, guard, presets, socket};

/// Time that runs being saved have to remove their unfinished folders when the server ends.
const WORK_TIMEOUT: Duration = Duration::from_secs(10);

/// Options with which the laboratory starts.
pub struct ServerOptions {
    /// The case or run that the page shows first.
    pub start: Start,
    /// The folder of results: where runs are saved, and where saved runs are found again.
    pub results: PathBuf,
    /// Folders, besides the folder of the case, in which files that cases name may lie.
    pub allow_files: Vec<PathBuf>,
    /// Prints a sentence in the terminal: the outcome of saving a run.
    pub print: fn(&str),
    /// The port; 0 for any free port.
    pub port: u16,
    /// Threads of a run.
    pub threads: usize,
    /// How long the server waits for clients that send or read nothing.
    pub patience: Patience,
}

/// How long the server waits for clients that send or read nothing.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// Time to wait for the next header of a connection.
    pub header: Duration,
    /// Time to wait for a page to receive a message.
    pub message: Duration,
    /// Time to wait for all pages together after they were notified that the server ends.
    pub end: Duration,
}

impl Default for Patience {
    fn default() -> Self {
        Self {
            header: Duration::from_secs(5),
            message: Duration::from_secs(10),
            end: Duration::from_secs(5),
        }
    }
}

/// A laboratory that is bound to a port, but does not serve yet.
pub struct Laboratory {
    listener: TcpListener,
    port: u16,
    token: Token,
    start_page: StartPage,
    setting: Arc<Setting>,
    patience: Patience,
}

impl Laboratory {
    /// Binds a port of this machine.
    ///
    /// # Errors
    /// When the port is taken, or the system gives no random numbers.
    pub fn bind(options: ServerOptions) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, options.port))?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            port: listener.local_addr()?.port(),
            listener,
            token: Token::draw()?,
            start_page: StartPage::default(),
            setting: Arc::new(Setting {
                start: options.start,
                results: options.results,
                allow_files: options.allow_files,
                saves: Arc::new(Saves::new(options.print)),
                threads: options.threads,
                presets: presets::all(),
            }),
            patience: options.patience,
        })
    }

    /// The address of the page, with the token that opens it; `link` is the part after `#case=` of a link
    /// from another page.
    pub fn address(&self, link: Option<&str>) -> String {
        let case = link.map_or(String::new(), |link| format!("&case={link}"));
        format!(
            "http://127.0.0.1:{}/#token={}{case}",
            self.port,
            self.token.as_str()
        )
    }

    /// Writes a page that leads to the address, and that only this user can read; its path need not be
    /// secret. It is removed once a page has connected, or when the server ends.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub fn start_page(&self, link: Option<&str>) -> io::Result<PathBuf> {
        self.start_page.open(&self.address(link))
    }

    /// Writes the address to a file that only this user can read.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub fn address_file(&self, link: Option<&str>) -> io::Result<PrivateFile> {
        PrivateFile::write(".txt", &format!("{}\n", self.address(link)))
    }

    /// Serves until `stop` is done. Then pages are notified, open connections are closed, and runs being
    /// saved remove their unfinished folders, each within its time limit.
    ///
    /// # Errors
    /// When the system refuses what a server needs.
    pub fn serve(self, stop: impl Future<Output = ()>) -> io::Result<()> {
        let setting = Arc::clone(&self.setting);
        let saves = Arc::clone(&setting.saves);
        let stopped = async move {
            stop.await;
            saves.end();
        };
        let served = self.listen(stopped);
        setting.saves.wait(WORK_TIMEOUT);
        setting.saves.print_unfinished(&setting.results);
        served
    }

    fn listen(self, stop: impl Future<Output = ()>) -> io::Result<()> {
        let (end, ends) = watch::channel(false);
        let pages = Arc::new(Semaphore::new(MAX_PAGES));
        let start_page = self.start_page.clone();
        let shared = Shared {
            setting: self.setting,
            token: Arc::new(self.token),
            start_page: self.start_page,
            pages: Arc::clone(&pages),
            ends,
            message_timeout: self.patience.message,
        };
        let router = Router::new()
            .route("/ws", get(socket::connect))
            .route("/proof/{tab}/{nonce}", get(socket::prove))
            .fallback(get(assets::serve))
            .layer(middleware::from_fn_with_state(self.port, guard::guard))
            .with_state(shared);
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()?;
        runtime.block_on(async move {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            tokio::select! {
                () = stop => {}
                never = connections::serve(listener, router, self.patience.header) => match never {},
            }
            start_page.close();
            let _ = end.send(true);
            // All permits are free when all pages are gone.
            let _ = timeout(self.patience.end, pages.acquire_many(MAX_PAGES as u32)).await;
            Ok(())
        })
    }
}
