//! Models beyond the paper's: exact and computed answers for every option of the engine.
//!
//! Each chapter builds its sliders from the physics alone, and compares their motion with a closed form or
//! with the integration of an equation that its text (in `text/`) derives. Published benchmarks are compared
//! with their reference. The command is `slipfront family`; its pages are `docs/validation/family.md`,
//! `rupture.md` and `transition.md`.

mod adhesion;
mod ageing;
mod blocks_that_differ;
mod chapter;
mod composite;
mod contact_springs;
mod correlated;
mod edge_drive;
mod error;
mod fronts;
mod held_drive;
mod load;
mod nucleation;
mod page;
mod patterns;
mod rate_and_state;
mod recurrence;
mod runs;
mod rupture;
mod side_push;
mod slip_weakening;
mod speed_program;
mod torsion;
mod transition;
mod weakening;

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use chapter::Topic;
use page::Page;
use slip_weakening::falling_strength;

pub use chapter::{Answer, Chapter};
pub use error::FamilyError;
pub use page::{Book, summary, write_docs};

/// The pages; the last one takes half an hour.
static PAGES: [Page; 3] = [
    Page {
        title: "# The family, answer by answer\n",
        name: "family",
        about: include_str!("text/family.md"),
        compared: "exact",
        topics: OPTIONS,
    },
    Page {
        title: "# Benchmarks of frictional rupture\n",
        name: "rupture",
        about: include_str!("text/rupture.md"),
        compared: "reference",
        topics: BENCHMARKS,
    },
    Page {
        title: "# Fronts faster than shear waves\n",
        name: "transition",
        about: include_str!("text/transition.md"),
        compared: "reference",
        topics: LONG,
    },
];

/// Options of the engine.
#[rustfmt::skip]
const OPTIONS: &[Topic] = &[
    Topic { title: "Driven at an edge: precursors", name: "precursors", text: include_str!("text/edge_drive.md"), compare: edge_drive::compare },
    Topic { title: "Non-uniform load", name: "load", text: include_str!("text/load.md"), compare: load::compare },
    Topic { title: "Drive programs", name: "program", text: include_str!("text/program.md"), compare: speed_program::compare },
    Topic { title: "Slow loading", name: "held", text: include_str!("text/held.md"), compare: held_drive::compare },
    Topic { title: "Torsion", name: "torsion", text: include_str!("text/torsion.md"), compare: torsion::compare },
    Topic { title: "Heterogeneous blocks and dampers", name: "blocks", text: include_str!("text/blocks.md"), compare: blocks_that_differ::compare },
    Topic { title: "Composite surfaces", name: "composite", text: include_str!("text/composite.md"), compare: composite::compare },
    Topic { title: "Hierarchical patterns", name: "patterns", text: include_str!("text/patterns.md"), compare: patterns::compare },
    Topic { title: "Velocity weakening", name: "weakening", text: include_str!("text/weakening.md"), compare: weakening::compare },
    Topic { title: "Slip weakening", name: "slip_weakening", text: include_str!("text/slip_weakening.md"), compare: slip_weakening::compare },
    Topic { title: "Ageing of static friction", name: "ageing", text: include_str!("text/ageing.md"), compare: ageing::compare },
    Topic { title: "Rate-and-state friction", name: "rate-and-state", text: include_str!("text/rate_and_state.md"), compare: rate_and_state::compare },
    Topic { title: "Adhesion", name: "adhesion", text: include_str!("text/adhesion.md"), compare: adhesion::compare },
    Topic { title: "Spatially correlated coefficients", name: "correlated", text: include_str!("text/correlated.md"), compare: correlated::compare },
    Topic { title: "Contact springs", name: "contact-springs", text: include_str!("text/contact_springs.md"), compare: contact_springs::compare },
    Topic { title: "Slip fronts", name: "fronts", text: include_str!("text/fronts.md"), compare: fronts::compare },
];

/// Published benchmarks.
#[rustfmt::skip]
const BENCHMARKS: &[Topic] = &[
    Topic { title: "Nucleation on a line", name: "nucleation", text: include_str!("text/rupture_nucleation.md"), compare: nucleation::compare },
    Topic { title: "Speed of a rupture along an edge", name: "speed", text: include_str!("text/rupture_speed.md"), compare: rupture::compare },
    Topic { title: "Plate pushed at its side", name: "side", text: include_str!("text/rupture_side.md"), compare: side_push::compare },
    Topic { title: "Stick-slip of rate and state with inertia", name: "cycle", text: include_str!("text/rupture_cycle.md"), compare: recurrence::compare_cycle },
    Topic { title: "Event catalogue of a train of blocks", name: "catalogue", text: include_str!("text/rupture_catalogue.md"), compare: recurrence::compare_catalogue },
];

/// Benchmarks that take half an hour.
#[rustfmt::skip]
const LONG: &[Topic] = &[
    Topic { title: "The transition to fronts faster than shear waves", name: "speed", text: include_str!("text/transition_speed.md"), compare: transition::compare },
];

/// Computes all chapters of all pages on the threads of rayon's pool, including the page that takes half an
/// hour if `long` is set.
///
/// # Errors
/// When a run diverges.
pub fn books(long: bool) -> Result<Vec<Book>, FamilyError> {
    let pages = if long { PAGES.len() } else { PAGES.len() - 1 };
    PAGES[..pages].par_iter().map(Book::compute).collect()
}

/// The first foreign page that [`write_docs`] would replace in a folder.
pub fn foreign_docs(folder: &Path) -> Option<PathBuf> {
    PAGES.iter().find_map(|page| page.foreign_in(folder))
}
