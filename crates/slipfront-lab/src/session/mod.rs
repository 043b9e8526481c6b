//! A session: the run of one page, in a thread of its own, which works only while somebody looks.

mod brush;
mod clock;
mod edit;
mod find;
mod offline;
mod requests;
mod serve;
mod start;
mod state;
mod steps;
mod updates;

pub use offline::OfflineSession;
pub(crate) use serve::serve;
pub(crate) use state::Setting;
