//! The runs of a study: its journal, and the part of each run that the tables need, in memory.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use slipfront_run::manifest::ManifestFile;
use slipfront_run::names::RUN_JOURNAL;

use crate::error::StudyError;
use crate::finished_run::{FinishedRun, RunResult};
use crate::project_folder::Journal;

/// The journal of a study folder, open in only one process; its threads may share it.
#[derive(Debug)]
pub struct RunJournal {
    state: Mutex<JournalState>,
    /// Lines that failed their checksum.
    pub damaged: usize,
}

/// The file, and the results in it.
#[derive(Debug)]
struct JournalState {
    journal: Journal,
    /// Results of the runs, and marks of the folders that were kept.
    results: HashMap<String, (RunResult, Option<String>)>,
}

impl RunJournal {
    /// Name of the journal in its folder.
    pub const FILE: &str = RUN_JOURNAL;

    /// Opens the journal of a study folder, unless another process has it open; a folder without one gets an
    /// empty file.
    pub fn open(folder: &Path) -> Result<Self, StudyError> {
        Journal::open(folder, RUN_JOURNAL).map(Self::from_opened)
    }

    /// The runs of a journal that was opened.
    pub(crate) fn from_opened((journal, runs, damaged): (Journal, Vec<FinishedRun>, usize)) -> Self {
        // Each run is dropped before the next is processed.
        let results = runs.into_iter().map(|run| result_of(&run));
        Self {
            state: Mutex::new(JournalState {
                journal,
                results: results.collect(),
            }),
            damaged,
        }
    }

    /// The file and results, locked for this thread. They are consistent even after a panic of another
    /// thread, because results are added last.
    fn state(&self) -> MutexGuard<'_, JournalState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The result of the run with this identity, if it is recorded.
    pub fn get(&self, id: &str) -> Option<RunResult> {
        self.state().results.get(id).map(|(result, _)| result.clone())
    }

    /// The mark of the folder of this run, if the folder was kept.
    pub(crate) fn mark(&self, id: &str) -> Option<String> {
        self.state().results.get(id)?.1.clone()
    }

    /// The file with its present checksum.
    ///
    /// # Errors
    /// When the system refuses to read it.
    pub fn listed(&self) -> Result<ManifestFile, StudyError> {
        self.state().journal.listed()
    }

    /// Number of runs recorded.
    pub fn len(&self) -> usize {
        self.state().results.len()
    }

    /// Whether no runs are recorded.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Appends finished runs that are not recorded yet, and waits until they are on disk; earlier ones stay
    /// intact.
    pub fn append(&self, runs: &[FinishedRun]) -> Result<(), StudyError> {
        let JournalState { journal, results } = &mut *self.state();
        // Studies that share the file may have made the same run at the same time.
        let unknown = runs.iter().filter(|run| !results.contains_key(&run.id));
        journal.append(unknown)?;
        results.extend(runs.iter().map(result_of));
        Ok(())
    }

    /// Appends the runs of another folder that are not here yet, and returns their number.
    pub fn merge(&mut self, folder: &Path) -> Result<usize, StudyError> {
        let (mut runs, damaged) = Journal::read::<FinishedRun>(folder, RUN_JOURNAL)?;
        self.damaged += damaged;
        runs.retain(|run| self.get(&run.id).is_none());
        // Not all lines need to be in memory at once.
        for some in runs.chunks(LINES_AT_ONCE) {
            self.append(some)?;
        }
        Ok(runs.len())
    }
}

/// The part of a run that stays in memory, by its identity.
fn result_of(run: &FinishedRun) -> (String, (RunResult, Option<String>)) {
    (run.id.clone(), (run.outcome.result(), run.kept.clone()))
}

/// Number of lines per write: each write waits for the disk.
const LINES_AT_ONCE: usize = 1000;

#[cfg(test)]
mod tests {
    use std::fs::File;

    use super::*;
    use crate::error::StudyError;
    use crate::finished_run::Outcome;
    use crate::project_folder::to_line;

    fn finished(id: &str) -> FinishedRun {
        FinishedRun {
            id: id.to_owned(),
            wall_time_s: 0.5,
            outcome: Outcome::Done(Box::default()),
            kept: None,
        }
    }

    /// A line that lacks only its line break is complete.
    #[test]
    fn a_line_cut_short_anywhere_is_not_run_and_does_not_harm_the_next() {
        let whole = to_line(&finished("a"));
        let next = to_line(&finished("b"));
        // Testing every position would wait for the disk a thousand times.
        for cut in (0..40)
            .chain((40..next.len() - 1).step_by(97))
            .chain([next.len() - 2, next.len() - 1])
        {
            let left = usize::from(cut == next.len() - 1);
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(
                folder.path().join(RUN_JOURNAL),
                [&whole[..], &next[..cut]].concat(),
            )
            .unwrap();
            let journal = RunJournal::open(folder.path()).unwrap();
            assert_eq!(
                (journal.len(), journal.get("b").is_some()),
                (1 + left, left == 1),
                "cut at {cut}"
            );
            journal.append(&[finished("c")]).unwrap();
            drop(journal);
            let journal = RunJournal::open(folder.path()).unwrap();
            assert_eq!((journal.len(), journal.damaged), (2 + left, 0), "cut at {cut}");
            // The first line of the file may be incomplete as well.
            std::fs::write(folder.path().join(RUN_JOURNAL), &next[..cut]).unwrap();
            drop(journal);
            let journal = RunJournal::open(folder.path()).unwrap();
            assert_eq!(journal.len(), left, "cut at {cut}");
        }
    }

    #[test]
    fn a_flipped_bit_spoils_its_own_line_only() {
        let lines = [
            to_line(&finished("a")),
            to_line(&finished("b")),
            to_line(&finished("c")),
        ]
        .concat();
        let middle = lines.len() / 2;
        for bit in 0..8 {
            let mut damaged = lines.clone();
            damaged[middle] ^= 1 << bit;
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join(RUN_JOURNAL), damaged).unwrap();
            let (runs, damaged) = Journal::read::<FinishedRun>(folder.path(), RUN_JOURNAL).unwrap();
            let ids: Vec<&str> = runs.iter().map(|run| run.id.as_str()).collect();
            assert_eq!(ids, ["a", "c"]);
            assert!(damaged >= 1);
        }
    }

    #[test]
    fn damaged_lines_of_all_shards_are_counted() {
        let [all, one, two] = [(); 3].map(|()| tempfile::tempdir().unwrap());
        for (shard, id) in [(&one, "b"), (&two, "c")] {
            let mut lines = [to_line(&finished("a")), to_line(&finished(id))].concat();
            lines[10] ^= 1;
            std::fs::write(shard.path().join(RUN_JOURNAL), lines).unwrap();
        }
        let mut journal = RunJournal::open(all.path()).unwrap();
        assert_eq!(journal.merge(one.path()).unwrap(), 1);
        assert_eq!(journal.merge(two.path()).unwrap(), 1);
        assert_eq!((journal.len(), journal.damaged), (2, 2));
    }

    #[test]
    fn one_process_at_a_time_and_no_foreign_file() {
        let folder = tempfile::tempdir().unwrap();
        let first = RunJournal::open(folder.path()).unwrap();
        assert!(matches!(
            RunJournal::open(folder.path()),
            Err(StudyError::Busy { .. })
        ));
        drop(first);
        // The result is the same for any name of the file, with or without a final line break.
        let path = folder.path().join(RUN_JOURNAL);
        for mine in [
            "some notes\nof mine\n",
            "{\"my\": \"notes\"}",
            "deadbeef, and more",
        ] {
            std::fs::write(&path, mine).unwrap();
            let opened = RunJournal::open(folder.path());
            assert!(matches!(opened, Err(StudyError::NotJournal { .. })), "{mine}");
            assert_eq!(std::fs::read(&path).unwrap(), mine.as_bytes());
        }
    }

    /// A file without end, or a directory entry that is not a file, is refused without reading from it or
    /// waiting for it.
    #[cfg(unix)]
    #[test]
    fn what_never_ends_is_refused() {
        let (folder, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let mut journal = RunJournal::open(other.path()).unwrap();
        let path = folder.path().join(RUN_JOURNAL);
        let refused = |journal: &mut RunJournal| {
            let opened = RunJournal::open(folder.path());
            assert!(matches!(opened, Err(StudyError::NotJournal { .. })), "{opened:?}");
            assert!(journal.merge(folder.path()).is_err());
        };
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        refused(&mut journal);
        std::fs::remove_file(&path).unwrap();
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        refused(&mut journal);
    }

    /// Studies that share the journal may make the same run at the same time.
    #[test]
    fn a_run_is_recorded_once() {
        let folder = tempfile::tempdir().unwrap();
        let journal = RunJournal::open(folder.path()).unwrap();
        std::thread::scope(|scope| {
            for other in ["b", "c"] {
                let journal = &journal;
                scope.spawn(move || journal.append(&[finished("a"), finished(other)]).unwrap());
            }
        });
        assert_eq!(journal.len(), 3);
        let lines = std::fs::read_to_string(folder.path().join(RUN_JOURNAL)).unwrap();
        assert_eq!(lines.lines().count(), 3);
    }

    #[test]
    fn merging_twice_is_merging_once() {
        let (one, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        RunJournal::open(one.path())
            .unwrap()
            .append(&[finished("a")])
            .unwrap();
        let mut journal = RunJournal::open(other.path()).unwrap();
        journal.append(&[finished("b")]).unwrap();
        assert_eq!(journal.merge(one.path()).unwrap(), 1);
        assert_eq!(journal.merge(one.path()).unwrap(), 0);
        assert_eq!(journal.len(), 2);
    }
}
