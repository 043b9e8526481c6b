//! Checkpoints of a run in its folder. A run that was stopped resumes from them and gives the same bytes in
//! every file.
//!
//! A file gets its name when it is complete; the previous one is kept next to it. Each rank writes its own
//! rows, and the bytes do not depend on the number of ranks, so a run can be resumed on another number of
//! ranks.

mod error;
mod file;

use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use jiff::Timestamp;
use slipfront::{Communicator, Execution};
use slipfront_base::disk::{found_at, remove_if_there, sync_folder};
use slipfront_case::case::Case;
use slipfront_case::same_on_ranks::expect_same;

pub use self::error::CheckpointError;
use self::file::{Header, VerifiedFile};
use crate::agree::agree_on_io;
use crate::names::{CHECKPOINT, PREVIOUS};
use crate::run_folder::unfinished::Unfinished;
use crate::running::Running;

/// A checkpoint that was read from a file.
#[derive(Debug)]
pub struct LoadedCheckpoint {
    /// The run folder.
    folder: PathBuf,
    path: PathBuf,
    file: VerifiedFile,
    /// Whether the checkpoint is the latest one rather than the previous one.
    latest: bool,
}

impl LoadedCheckpoint {
    /// The step after which the checkpoint was saved.
    pub fn step(&self) -> u64 {
        self.file.header.step
    }

    /// Resumes the run from the checkpoint; none if the checkpoint belongs to another case.
    ///
    /// # Errors
    /// [`CheckpointError::Unreadable`].
    pub fn resume(self, case: &Arc<Case>, execution: Execution) -> Result<Option<Running>, CheckpointError> {
        // Nothing is allocated for columns that the file does not hold.
        if self.file.state.columns(case) != self.file.header.columns {
            return Ok(None);
        }
        let VerifiedFile {
            state,
            mut file,
            begin,
            ..
        } = self.file;
        let read = |offset: u64, bytes: &mut [u8]| {
            file.seek(SeekFrom::Start(begin + offset))?;
            file.read_exact(bytes)
        };
        let communicator = Arc::clone(&execution.communicator);
        let resumed = Running::resume(case, state, execution, read);
        agree_on_io(&*communicator, resumed).map_err(|source| {
            let path = self.path;
            CheckpointError::Unreadable { path, source }
        })
    }
}

/// Saves the checkpoints of one run.
#[derive(Debug)]
pub struct Checkpoints {
    /// The run folder.
    folder: PathBuf,
    unfinished: Unfinished,
    case_blake3: String,
    started: Timestamp,
    /// Whether the latest checkpoint in the folder is known to be complete.
    latest_is_whole: bool,
    /// Step of the latest checkpoint that was saved, or from which the run was resumed.
    saved_step: Option<u64>,
}

impl Checkpoints {
    /// The checkpoints of a run of `case` in `folder` that begins at `started`.
    pub fn new(folder: &Path, case: &Case, started: Timestamp) -> Self {
        Self {
            folder: folder.to_owned(),
            unfinished: Unfinished::in_folder(folder),
            case_blake3: hash_of(case),
            started,
            latest_is_whole: false,
            saved_step: None,
        }
    }

    /// The checkpoints of a run that was resumed from a loaded one, in the same folder.
    pub fn after(case: &Case, loaded: &LoadedCheckpoint) -> Self {
        Self {
            latest_is_whole: loaded.latest,
            saved_step: Some(loaded.step()),
            ..Self::new(&loaded.folder, case, loaded.file.header.started)
        }
    }

    /// The run folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The step of the latest saved checkpoint, if there is one.
    pub fn saved_step(&self) -> Option<u64> {
        self.saved_step
    }

    /// Time at which the run began.
    pub fn started(&self) -> Timestamp {
        self.started
    }

    /// Saves the state of the run. The latest checkpoint so far is kept as the previous one, unless it is
    /// damaged; whatever happens, one of the two is complete.
    pub fn save(&mut self, running: &Running, communicator: &dyn Communicator) -> std::io::Result<()> {
        let header = Header::new(&self.case_blake3, self.started, running);
        let is_first = communicator.rank() == 0;
        // The name is different for every step: on a shared file system, a machine may still take a name for
        // an earlier file.
        let temporary = format!("{}-{CHECKPOINT}", header.step);
        let temporary = self.unfinished.temporary().join(temporary);
        let written = file::write(&temporary, &header, running, communicator);
        let placed = written.and_then(|()| {
            if is_first {
                self.put_in_place(&temporary)
            } else {
                Ok(())
            }
        });
        if placed.is_err() && is_first {
            // The first error is the one that is reported.
            let _ = remove_if_there(&temporary);
        }
        agree_on_io(communicator, placed)?;
        self.saved_step = Some(header.step);
        Ok(())
    }

    /// Makes a complete checkpoint the latest one.
    fn put_in_place(&mut self, whole: &Path) -> std::io::Result<()> {
        let [latest, previous] = [CHECKPOINT, PREVIOUS].map(|name| self.unfinished.path().join(name));
        if std::mem::take(&mut self.latest_is_whole) {
            match std::fs::rename(&latest, &previous) {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        std::fs::rename(whole, &latest)?;
        self.latest_is_whole = true;
        sync_folder(self.unfinished.path())
    }

    /// Reads the latest checkpoint of a run folder, or the previous one; none if the folder has neither. If a
    /// kill has left only the previous one, it counts as the latest.
    pub fn load(
        folder: &Path,
        case: &Case,
        previous: bool,
        communicator: &dyn Communicator,
    ) -> Result<Option<LoadedCheckpoint>, CheckpointError> {
        for name in [CHECKPOINT, PREVIOUS].into_iter().skip(usize::from(previous)) {
            let path = Unfinished::in_folder(folder).path().join(name);
            // A dangling link must be refused, and not treated as a missing checkpoint.
            let found = agree_on_io(communicator, found_at(&path));
            let is_there = match found {
                Ok(found) => found.is_some(),
                Err(source) => return Err(CheckpointError::Unreadable { path, source }),
            };
            let seen = if is_there { "there" } else { "missing" };
            expect_same(communicator, || vec![(name.to_owned(), seen.to_owned())])?;
            if is_there {
                let file = file::read(&path, &hash_of(case), communicator)?;
                let latest = name == CHECKPOINT;
                let folder = folder.to_owned();
                return Ok(Some(LoadedCheckpoint {
                    folder,
                    path,
                    file,
                    latest,
                }));
            }
        }
        Ok(None)
    }
}

/// Hash of a case and of the files that it reads; equal cases have equal hashes.
pub fn hash_of(case: &Case) -> String {
    let mut hasher = blake3::Hasher::new();
    // A case that was loaded can always be written.
    hasher.update(case.file.to_toml().unwrap_or_default().as_bytes());
    for input in &case.inputs {
        hasher.update(input.hash.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use slipfront::communicator::Alone;
    use slipfront::testing::{FusedDevice, Threads};
    use slipfront_case::case::Ranks;
    use slipfront_case::case_file::CaseFile;

    use super::*;

    fn case() -> Arc<Case> {
        let text = "slider.blocks = [60, 50]\ntime.duration_star = 20\ndrive.v_star = 0.2\n\
                    output.snapshots = { every = 1.0 }\noutput.stride = 3\n";
        Arc::new(Case::parse(text, "case", "", &[]).unwrap())
    }

    /// The state of a run belongs to the files that its case reads, too.
    #[test]
    fn cases_that_read_other_bytes_have_other_hashes() {
        let hash_with = |bytes: &str| {
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join("mu.csv"), bytes).unwrap();
            let text = "slider.blocks = [2, 2]\nfriction.mu_static_field = 'mu.csv'\n";
            hash_of(&Case::parse(text, "case", folder.path(), &[]).unwrap())
        };
        let one = hash_with("0.5,0.6\n0.5,0.6\n");
        assert_eq!(hash_with("0.5,0.6\n0.5,0.6\n"), one);
        assert_ne!(hash_with("0.5,0.6\n0.5,0.7\n"), one);
    }

    /// A run that has recorded some frames.
    fn advanced(case: &Arc<Case>) -> Running {
        let mut running = Running::start(case, None, Execution::default());
        running.advance(case.time_plan.last_step / 2).unwrap();
        running
    }

    fn checkpoints(folder: &Path, case: &Case) -> Checkpoints {
        Unfinished::in_folder(folder).create().unwrap();
        Checkpoints::new(folder, case, Timestamp::UNIX_EPOCH)
    }

    fn latest(folder: &Path) -> Vec<u8> {
        std::fs::read(Unfinished::in_folder(folder).path().join(CHECKPOINT)).unwrap()
    }

    #[test]
    fn any_number_of_ranks_saves_the_same_bytes_and_goes_on() {
        let case = case();
        let running = advanced(&case);
        let alone = tempfile::tempdir().unwrap();
        checkpoints(alone.path(), &case).save(&running, &Alone).unwrap();
        for ranks in [2, 3] {
            let folder = tempfile::tempdir().unwrap();
            checkpoints(folder.path(), &case);
            let steps = Threads::run(ranks, |communicator| {
                let mut checkpoints = Checkpoints::new(folder.path(), &case, Timestamp::UNIX_EPOCH);
                for _ in 0..2 {
                    checkpoints.save(&running, communicator).unwrap();
                }
                let loaded = Checkpoints::load(folder.path(), &case, false, communicator);
                let execution = Execution {
                    communicator: Arc::new(communicator.clone()),
                    ..Execution::default()
                };
                let resumed = loaded.unwrap().unwrap().resume(&case, execution);
                resumed.unwrap().unwrap().snapshot().step
            });
            assert_eq!(steps, vec![running.snapshot().step; ranks]);
            assert!(latest(folder.path()) == latest(alone.path()), "{ranks} ranks");
        }
    }

    /// Ranks that share a lattice, and a device, save the same bytes as a single rank, at many instants of a
    /// run with all kinds of frames, and within events of slip.
    #[test]
    fn ranks_that_share_a_lattice_save_the_bytes_of_one() {
        for text in [
            "slider.blocks = [14, 13]\ndrive.v_star = 0.02\ntime.duration_star = 100\noutput.stride = 2\n",
            "slider.blocks = [12, 11]\nload.shear_star = 0.6\ndrive.v_star = 0.1\ntime.duration_star = 40\noutput.snapshots = { every = 4.0 }\n",
            "slider.blocks = [12, 11]\ndrive.v_star = 0.1\ntime.duration_star = 60\noutput = { events = true, snapshots = [] }\n",
        ] {
            let parsed = || CaseFile::parse(text, "case", &[]).unwrap();
            let alone = tempfile::tempdir().unwrap();
            let case =
                Arc::new(Case::to_run(parsed(), "case", Path::new(""), &mut |_| true, Ranks::ALONE).unwrap());
            let saved = |case: &Arc<Case>, folder: &Path, execution: Execution| {
                let communicator = Arc::clone(&execution.communicator);
                let mut running = Running::start(case, None, execution);
                // The clocks of the ranks differ.
                let started = Timestamp::from_nanosecond(communicator.rank() as i128).unwrap();
                let mut checkpoints = Checkpoints::new(folder, case, started);
                let mut files = Vec::new();
                while running.advance(41).unwrap().is_none() {
                    checkpoints.save(&running, &*communicator).unwrap();
                    files.push(latest(folder));
                }
                files
            };
            Unfinished::in_folder(alone.path()).create().unwrap();
            let expected = saved(&case, alone.path(), Execution::default());
            assert!(expected.len() > 5);
            let on_device = Execution {
                device: Some(Arc::new(FusedDevice)),
                ..Execution::default()
            };
            assert!(saved(&case, alone.path(), on_device) == expected);
            for size in [2, 3, 5] {
                let folder = tempfile::tempdir().unwrap();
                Unfinished::in_folder(folder.path()).create().unwrap();
                Threads::run(size, |rank| {
                    let ranks = Ranks {
                        communicator: rank,
                        on_node: size,
                    };
                    let case = Case::to_run(parsed(), "case", Path::new(""), &mut |_| true, ranks);
                    let of_rank = Execution {
                        communicator: Arc::new(rank.clone()),
                        ..Execution::default()
                    };
                    let found = saved(&Arc::new(case.unwrap()), folder.path(), of_rank);
                    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
                        assert!(found == expected, "{size} ranks, checkpoint {k}");
                    }
                });
            }
        }
    }

    #[test]
    fn where_one_rank_fails_all_do_and_the_latest_is_kept() {
        let case = case();
        let [folder, gone] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        checkpoints(folder.path(), &case)
            .save(&advanced(&case), &Alone)
            .unwrap();
        let before = latest(folder.path());
        let begun = Running::start(&case, None, Execution::default());
        for failing in 0..3 {
            // One rank has lost access to the disk.
            let seen = |rank: usize| {
                if rank == failing {
                    gone.path()
                } else {
                    folder.path()
                }
            };
            let errors = Threads::run(3, |communicator| {
                let seen = seen(communicator.rank());
                let mut checkpoints = Checkpoints::new(seen, &case, Timestamp::UNIX_EPOCH);
                checkpoints.save(&begun, communicator).unwrap_err().to_string()
            });
            // The other ranks name the rank with the error, unless it is the first one.
            let own = &errors[failing];
            let of_others = match failing {
                0 => own.clone(),
                _ => format!("rank {failing}: {own}"),
            };
            for (rank, error) in errors.iter().enumerate() {
                assert_eq!(error, if rank == failing { own } else { &of_others }, "{rank}");
            }
            assert!(latest(folder.path()) == before);
            let temporary = Unfinished::in_folder(folder.path()).temporary();
            assert_eq!(std::fs::read_dir(temporary).unwrap().count(), 0);
        }
    }

    /// On a shared file system, a machine may see a replaced file for a while: another checkpoint, or one
    /// with another layout or length.
    #[test]
    fn where_one_rank_sees_another_checkpoint_all_refuse_it() {
        let case = case();
        let [folder, other] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        checkpoints(folder.path(), &case)
            .save(&advanced(&case), &Alone)
            .unwrap();
        checkpoints(other.path(), &case)
            .save(&Running::start(&case, None, Execution::default()), &Alone)
            .unwrap();
        let earlier = latest(other.path());
        let longer = [latest(folder.path()), vec![0; 10 << 20]].concat();
        let layout = b"{\"slipfront_checkpoint\":1}\n".to_vec();
        for seen in [earlier, longer, layout, Vec::new()] {
            std::fs::write(Unfinished::in_folder(other.path()).path().join(CHECKPOINT), &seen).unwrap();
            for differing in 0..3 {
                let refused = Threads::run(3, |communicator| {
                    let folder = if communicator.rank() == differing {
                        other.path()
                    } else {
                        folder.path()
                    };
                    let loaded = Checkpoints::load(folder, &case, false, communicator);
                    loaded.map(drop).unwrap_err().to_string()
                });
                // If rank 0 differs, rank 1 is the first one that is not like it.
                let named = format!("on rank {} and", differing.max(1));
                assert!(refused[0].contains(&named), "{}", refused[0]);
                assert!(refused.iter().all(|said| *said == refused[0]), "{refused:?}");
            }
        }
    }

    /// Columns are where the first line places them, and are read back with the same bits, also for NaN.
    #[test]
    fn columns_stand_where_the_first_line_tells() {
        let case = case();
        let running = advanced(&case);
        let folder = tempfile::tempdir().unwrap();
        checkpoints(folder.path(), &case).save(&running, &Alone).unwrap();
        let file = latest(folder.path());
        let begin = file.iter().position(|&byte| byte == b'\n').unwrap() + 1;
        let line: serde_json::Value = serde_json::from_slice(&file[..begin]).unwrap();
        let number = |which: usize, key: &str| line["columns"][which][key].as_u64().unwrap() as usize;
        let shape = |which| ["count", "rows", "row_length", "number_bytes"].map(|key| number(which, key));
        let [frames, fields] = [shape(1)[0] / 5, 5];
        assert!(frames > 3);
        assert_eq!(
            [shape(0), shape(1)],
            [[5, 50, 60, 8], [frames * fields, 17, 20, 4]]
        );
        let n = 60 * 50;
        let (columns, rest) = file[begin..].split_at(5 * n * 8);
        for b in 0..n {
            let u = running.snapshot().block(b).displacement;
            for axis in 0..2 {
                let bytes = &columns[(axis * n + b) * 8..][..8];
                assert_eq!(bytes, u[axis].to_le_bytes());
            }
        }
        let record = running.record(slipfront::StopReason::End);
        // Instants A-F come before the other frames, and the record has all frames in order of time.
        let held: Vec<&[u8]> = rest.chunks_exact(fields * 17 * 20 * 4).take(frames).collect();
        assert!(record.frames.len() > 3);
        for (_, frame) in &record.frames {
            let values = frame.values.iter().flatten();
            let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
            assert!(held.contains(&&bytes[..]), "t* = {}", frame.time_star);
        }
    }

    /// Counts in a damaged first line are neither believed nor allocated.
    #[test]
    fn wrong_counts_are_refused() {
        let case = case();
        let folder = tempfile::tempdir().unwrap();
        checkpoints(folder.path(), &case)
            .save(&advanced(&case), &Alone)
            .unwrap();
        let file = latest(folder.path());
        let begin = file.iter().position(|&byte| byte == b'\n').unwrap();
        let line: serde_json::Value = serde_json::from_slice(&file[..begin]).unwrap();
        let body = &file[begin..file.len() - blake3::OUT_LEN];
        for which in 0..2 {
            for key in ["count", "rows", "row_length", "number_bytes"] {
                let right = line["columns"][which][key].as_u64().unwrap();
                for wrong in [0, right - 1, right + 1, 1 << 40, u64::MAX] {
                    let mut changed = line.clone();
                    changed["columns"][which][key] = wrong.into();
                    let contents = [&serde_json::to_vec(&changed).unwrap(), body].concat();
                    let checksum = blake3::hash(blake3::hash(&contents).as_bytes());
                    let path = Unfinished::in_folder(folder.path()).path().join(CHECKPOINT);
                    std::fs::write(path, [&contents, &checksum.as_bytes()[..]].concat()).unwrap();
                    let went_on = match Checkpoints::load(folder.path(), &case, false, &Alone) {
                        Err(CheckpointError::Damaged { .. }) => false,
                        loaded => {
                            let loaded = loaded.unwrap().unwrap();
                            loaded.resume(&case, Execution::default()).unwrap().is_some()
                        }
                    };
                    assert!(!went_on, "{key} {wrong}");
                }
            }
        }
    }
}
