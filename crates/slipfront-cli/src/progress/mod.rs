//! Progress on stderr: of a texture, of a run, of a study, of a design, of a calibration, of the figures of
//! the paper.

pub(crate) mod calibrate;
pub(crate) mod case;
pub(crate) mod design;
pub(crate) mod display;
pub(crate) mod paper;
pub(crate) mod run;
pub(crate) mod study;
