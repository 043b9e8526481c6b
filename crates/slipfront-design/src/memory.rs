//! Memory of a design, compared with the memory of the machine before the first run.

use slipfront_base::machine::available_of;
use slipfront_base::number_format::byte_size;
use slipfront_case::case::PROGRAM;
use slipfront_case::case_file::CaseError;
use slipfront_run::pictures;

use crate::design::Design;
use crate::evaluate::Evaluator;
use crate::subject::Fidelity;
use slipfront_study::StudyError;
use slipfront_study::room::check_room;

/// Bytes that a draft that was tried keeps beside its blocks: its patches, and its line of the table.
const DRAFT_BYTES: f64 = 2048.0;

/// Memory of a design, in bytes.
#[derive(Clone, Copy, Debug)]
struct DesignMemory {
    /// The program, and the drafts that were tried.
    beside: f64,
    /// The largest run.
    run: f64,
}

impl Design {
    /// Refuses `threads` runs at once if there is no memory for them, and says how many there is memory for; a search keeps
    /// at most `drafts` drafts.
    ///
    /// # Errors
    /// With both figures.
    pub fn check_memory(&self, drafts: usize, threads: usize) -> Result<(), StudyError> {
        let memory = self.memory(drafts)?;
        memory.compare(threads, available_of(memory.of(threads)))
    }

    fn memory(&self, drafts: usize) -> Result<DesignMemory, CaseError> {
        // A mesh that has no room for a single run is left out of the verdict.
        let finer = self.evaluator.on_finer_blocks().ok();
        let run = std::iter::once(&self.evaluator)
            .chain(&finer)
            .map(Evaluator::memory)
            .try_fold(0.0, |largest: f64, run| Ok::<_, CaseError>(largest.max(run?)))?;
        let draft = DRAFT_BYTES + self.evaluator.grid.n_blocks() as f64;
        Ok(DesignMemory {
            beside: PROGRAM + drafts as f64 * draft,
            run,
        })
    }
}

impl DesignMemory {
    /// Memory with `threads` runs at once.
    fn of(&self, threads: usize) -> f64 {
        self.beside + threads as f64 * self.run
    }

    fn compare(&self, threads: usize, available: f64) -> Result<(), StudyError> {
        check_room(
            |threads| self.of(threads),
            threads,
            available,
            |available| StudyError::DesignMemory {
                needed: byte_size(self.of(1)),
                available,
            },
        )
    }
}

impl Evaluator {
    /// Memory of the largest run, in bytes.
    fn memory(&self) -> Result<f64, CaseError> {
        self.subjects.iter().try_fold(0.0, |largest: f64, subject| {
            let case = subject.case(None, 0, Fidelity::Verdict)?;
            Ok(largest.max(pictures::run_budget(&case).memory_beside_others(false)))
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::file::DesignFile;

    /// Memory counts runs as they are on blocks of half the size, and drafts with their blocks.
    #[test]
    fn threads_are_held_against_the_memory() {
        let design = |blocks: usize| {
            let text = format!(
                "[base]\nslider.blocks = [{blocks}, {blocks}]\n[design]\nwish = {{ least = 'static_friction' }}\ncoverage = [0, 10]"
            );
            let file = DesignFile::parse(&text, "design.toml", "design", Path::new("")).unwrap();
            file.design().unwrap()
        };
        let [coarse, fine] = [design(200), design(400)];
        let found = coarse.memory(100).unwrap();
        // Of as many blocks, but for the row of a step at which the onset is expected.
        assert!((found.run / fine.evaluator.memory().unwrap() - 1.0).abs() < 0.01);
        let drafts = fine.memory(100).unwrap().beside - found.beside;
        assert_eq!(drafts, 100.0 * 3.0 * 200.0 * 200.0);
        let available = found.of(2) + 0.5 * found.run;
        assert!(found.compare(2, available).is_ok());
        assert!(matches!(
            found.compare(3, available),
            Err(StudyError::Memory {
                threads: 3,
                fit: 2,
                ..
            })
        ));
        let said = found.compare(2, found.of(1) - 1.0).unwrap_err().to_string();
        assert!(
            said.starts_with("the design takes") && said.contains("lower `slider.blocks` or `design.runs`"),
            "{said}"
        );
    }
}
