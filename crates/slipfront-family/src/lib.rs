//! Models beyond the paper's: exact and computed answers for every option of the engine.
//!
//! Each chapter builds its sliders from the physics alone, and compares their motion with a closed form or
//! with the integration of an equation that its text (in `text/`) derives. Published benchmarks are compared
//! with their reference. The command is `slipfront family`; its pages are `docs/validation/family.md`,
//! `rupture.md` and `transition.md`.

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
mod nucleation;
mod page;
mod patterns;
mod program;
mod rate_and_state;
mod recurrence;
mod runs;
mod rupture;
mod side_push;
mod slip_weakening;
mod torsion;
mod transition;
mod weakening;

use rayon::prelude::*;

pub use answer::{Answer, Chapter, Tolerance};
pub use error::FamilyError;
use slip_weakening::falling_strength;

pub use page::{Book, foreign_docs, summary, write_docs};

/// Computes one chapter.
type Compute = fn() -> Result<Chapter, FamilyError>;

/// Chapters of the options of the engine, in the order of their page.
const OPTIONS: &[Compute] = &[
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

/// Chapters of published benchmarks, in the order of their page.
const BENCHMARKS: &[Compute] = &[
    nucleation::chapter,
    rupture::chapter,
    side_push::chapter,
    recurrence::cycle_chapter,
    recurrence::catalogue_chapter,
];

/// Chapters that take half an hour, in the order of their page.
const LONG: &[Compute] = &[transition::chapter];

/// Computes all chapters of all pages on the threads of rayon's pool, including the page that takes half an
/// hour if `long` is set.
///
/// # Errors
/// When a run diverges.
pub fn books(long: bool) -> Result<Vec<Book>, FamilyError> {
    let long = if long { LONG } else { &[] };
    let all: Vec<&Compute> = long.iter().chain(BENCHMARKS).chain(OPTIONS).collect();
    let mut chapters: Vec<Chapter> = all
        .par_iter()
        .map(|compute| compute())
        .collect::<Result<_, _>>()?;
    let options = chapters.split_off(long.len() + BENCHMARKS.len());
    let benchmarks = chapters.split_off(long.len());
    let mut books = vec![Book::of_options(options), Book::of_benchmarks(benchmarks)];
    if !chapters.is_empty() {
        books.push(Book::of_transition(chapters));
    }
    Ok(books)
}
