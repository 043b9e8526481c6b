//! A session: the run of one page, in a thread of its own, which works only while somebody looks.

mod begin;
mod brush;
mod clock;
mod edit;
mod offline;
mod requests;
mod serve;
mod state;
mod steps;
mod tell;

pub use offline::OfflineSession;
pub(crate) use serve::serve;
pub(crate) use state::Setting;
