//! A session of the laboratory: a case that is edited, its run next to a run of the slider without texture,
//! and their display.
//!
//! ```text
//! page -- Message -->  Session  -- replies as JSON, pictures as bytes --> Host
//!                      work(now) -> when to call again
//! ```
//!
//! A session does no input or output of its own and starts no threads. Its [`Host`] passes it the time and
//! the messages of the page, passes on its replies, and does everything else: jobs outside the session,
//! saving, access to folders.

mod base64;
mod controls;
mod document;
mod event;
mod history;
mod host;
mod job;
mod live;
mod names;
#[cfg(test)]
mod page_types;
mod picture;
mod presets;
mod protocol;
mod recorded;
mod replies;
mod run_files;
mod search;
mod sentence;
mod session;
mod shapes;
#[cfg(test)]
mod testing;
mod view;
#[cfg(feature = "work")]
mod work;
mod zip;

pub use document::{Document, MAX_BLOCKS};
pub use event::{Event, Worker};
pub use host::{Host, OpenedCase, Task};
pub use job::Job;
pub use names::{MAX_FILES, is_plain_name};
pub use presets::{Preset, Presets};
pub use protocol::{MAX_MESSAGE, Message};
pub use recorded::RecordedRun;
pub use replies::{failed, hello, refused, saved, saving};
pub use run_files::recorded_run;
pub use sentence::sentence;
pub use session::Session;
#[cfg(feature = "work")]
pub use work::run_archive;
