//! The subcommands, one file or folder each.

pub(crate) mod calibrate;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod converge;
pub(crate) mod design;
pub(crate) mod export;
pub(crate) mod family;
pub(crate) mod lab;
pub(crate) mod licences;
pub(crate) mod man;
pub(crate) mod movie;
pub(crate) mod paper;
pub(crate) mod plot;
pub(crate) mod run;
pub(crate) mod study;
pub(crate) mod texture;
pub(crate) mod verify;
