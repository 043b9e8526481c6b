//! The laboratory: a page in the browser on which a surface slides while a person looks at it and changes it.
//!
//! ```text
//! browser  <- pictures, curves, numbers ---  server  <- Outbox ---  session (one thread per page)
//!          --- requests ->                           --- channel ->
//! ```
//!
//! The server answers on 127.0.0.1 alone; every page has a session of its own, with its own run, which works
//! only while somebody looks. The session and what it and its page say to each other are slipfront-session's;
//! the page itself stands in `web/`, without a build step.

mod assets;
mod background;
mod connections;
mod export;
mod files;
mod guard;
mod host;
mod offline;
mod opening;
mod outbox;
mod presets;
mod replay;
mod save;
mod saves;
mod serve;
mod server;
mod socket;
mod start_page;
mod token;

pub use export::{ExportError, MODULE, export_folder, export_single, find_module};
pub use offline::OfflineSession;
pub use opening::{OpeningError, Start};
pub use server::{Laboratory, Patience, ServerOptions};
pub use start_page::PrivateFile;
