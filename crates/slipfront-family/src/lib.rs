//! The models around the paper's: for every option of the engine the exact answers, and what it computes.
//!
//! Each chapter builds its sliders from the physics alone and compares their motion with a closed form or
//! with the integration of an equation that is derived in its text. The command is `slipfront family`; its
//! page is `docs/validation/family.md`.

mod adhesion;
mod ageing;
mod answer;
mod blocks_that_differ;
mod composite;
mod contact_springs;
mod correlated;
mod edge_drive;
mod error;
mod fronts;
mod held;
mod load;
mod page;
mod patterns;
mod program;
mod rate_and_state;
mod runs;
mod slip_weakening;
mod torsion;
mod weakening;

use rayon::prelude::*;

pub use answer::{Answer, Chapter, Tolerance};
pub use error::FamilyError;
pub use page::{docs_page, foreign_docs, summary, write_docs};

/// Computes one chapter.
type Compute = fn() -> Result<Chapter, FamilyError>;

/// All chapters, in the order of the page.
const CHAPTERS: &[Compute] = &[
    edge_drive::chapter,
    load::chapter,
    program::chapter,
    held::chapter,
    torsion::chapter,
    blocks_that_differ::chapter,
    composite::chapter,
    patterns::chapter,
    weakening::chapter,
    slip_weakening::chapter,
    ageing::chapter,
    rate_and_state::chapter,
    adhesion::chapter,
    correlated::chapter,
    contact_springs::chapter,
    fronts::chapter,
];

/// Computes all chapters, on as many threads as there are workers.
///
/// # Errors
/// When a run diverges.
pub fn chapters() -> Result<Vec<Chapter>, FamilyError> {
    CHAPTERS.par_iter().map(|compute| compute()).collect()
}
