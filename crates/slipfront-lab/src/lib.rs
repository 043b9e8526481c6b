//! The laboratory: a page in the browser on which a surface slides while a person looks at it and changes it.
//!
//! ```text
//! browser  <- pictures, curves, numbers ---  server  <- Outbox ---  session (one thread per page)
//!          --- requests ->                           --- channel ->
//! ```
//!
//! The server answers on 127.0.0.1 alone; every page has a session of its own, with its own run, which works only while
//! somebody looks. What they say to each other stands in `protocol.rs`; the page itself in `web/`, without a build step.

mod assets;
mod background;
mod base64;
mod connections;
mod controls;
mod document;
mod files;
mod find;
mod guard;
mod history;
mod live;
mod opening;
mod outbox;
#[cfg(test)]
mod page_types;
mod picture;
mod presets;
mod protocol;
mod repeat;
mod replay;
mod save;
mod saves;
mod server;
mod session;
mod shapes;
mod socket;
mod start_page;
mod token;
mod view;
mod zip;

pub use opening::{OpeningError, Start};
pub use server::{Laboratory, Patience, ServerOptions};
pub use session::OfflineSession;
