//! The models around the paper's: for every option of the engine the exact answers, and what it computes.
//!
//! Each chapter builds its sliders from the physics alone and compares what they do with a closed form or with the integration of
//! an equation that is derived in its text. The command is `slipfront family`; its page is `docs/validation/family.md`.

mod adhesion;
mod answer;
mod fronts;
mod load;
mod page;
mod runs;

pub use self::answer::{Answer, Chapter, Tolerance};
pub use self::page::{docs_page, foreign_docs, summary, write_docs};

use rayon::prelude::*;

use crate::error::PaperError;

/// Computes one chapter.
type Compute = fn() -> Result<Chapter, PaperError>;

/// All chapters, in the order of the page.
const CHAPTERS: &[Compute] = &[load::chapter, adhesion::chapter, fronts::chapter];

/// Computes all chapters, on as many threads as there are workers.
///
/// # Errors
/// When a run diverges.
pub fn chapters() -> Result<Vec<Chapter>, PaperError> {
    CHAPTERS.par_iter().map(|compute| compute()).collect()
}
