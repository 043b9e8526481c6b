//! The laboratory: a page in the browser on which a surface slides while the user watches and changes it.
//!
//! ```text
//! browser  <- pictures, curves, numbers ---  server  <- Outbox ---  session (one thread per page)
//!          --- requests ->                           --- channel ->
//! ```
//!
//! The server answers only on 127.0.0.1. Every page has its own session with its own run, which works only
//! while the page is visible. slipfront-session holds the session and the messages between it and its page;
//! the page itself is in `web/`, without a build step.

mod assets;
mod background;
mod connections;
mod export;
mod files;
mod guard;
mod host;
mod offline;
mod outbox;
mod presets;
mod replay;
mod save;
mod saves;
mod serve;
mod server;
mod socket;
mod start;
mod start_page;
mod token;

pub use export::{ExportError, MODULE, export_folder, export_single, find_module};
pub use offline::OfflineSession;
pub use server::{Laboratory, Patience, ServerOptions};
pub use start::{OpeningError, Start};
pub use start_page::PrivateFile;
