//! The run folder: everything needed to read a run's results and to reproduce them.
//!
//! Files appear complete or not at all, and `manifest.json` comes last: if it exists, the run is complete.
//! Slipfront's own files are those that the manifest, or the journal of an incomplete run, lists with their
//! present hash.

mod contents;
pub mod inspection;
mod journal;
pub mod unfinished;

use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use slipfront::Communicator;
use slipfront::communicator::text_of;
use slipfront_base::disk::{found_at, found_behind, make_folders, sync_folder, write_temp};
use slipfront_base::text::display_path;
use slipfront_base::unfinished::clear_unfinished;
use slipfront_case::case::{Case, Input};
use tempfile::TempPath;

use self::contents::{managed_files, refuse_unmanaged, remove_files, result_files};
use self::inspection::{Contents, Inspection};
use self::journal::Journal;
use self::unfinished::Unfinished;
use crate::agree::{RankFailure, agree};
use crate::folder_error::FolderError;
use crate::manifest::{Manifest, ManifestFile, Processors, Until};
use crate::names::{CASE, CHECKPOINT, JOURNAL, MANIFEST, PREVIOUS, UNFINISHED};

/// A folder that was locked, if it exists, and inspected, for a run that begins or is resumed there.
#[derive(Debug)]
pub struct OpenedFolder {
    /// Result of the inspection.
    pub inspection: Inspection,
    existed: bool,
    lock: Option<File>,
}

impl OpenedFolder {
    /// Locks a folder and inspects its content.
    ///
    /// # Errors
    /// When another process runs there, or the folder cannot be listed.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        let lock = if is_folder_behind(path)? {
            lock(path)?
        } else {
            None
        };
        Ok(Self {
            lock,
            ..Self::open_unlocked(path)?
        })
    }

    /// Inspects a folder that another process of the same run has locked.
    ///
    /// # Errors
    /// When the folder cannot be listed.
    pub fn open_unlocked(path: &Path) -> Result<Self, FolderError> {
        Ok(Self {
            inspection: Inspection::read(path)?,
            existed: is_folder_behind(path)?,
            lock: None,
        })
    }

    /// Prepares the folder for a run that reads these `inputs`: it is created, or is empty, or with `force`
    /// the files of an earlier run, and nothing else, [may be removed](ClaimedFolder::take).
    ///
    /// # Errors
    /// When the folder holds other files, which includes foreign files in the place of the copies, or cannot
    /// be written.
    pub fn claim(mut self, force: bool, inputs: &[Input]) -> Result<ClaimedFolder, FolderError> {
        let path = self.inspection.path.clone();
        let missing = path.ancestors().take_while(|folder| !folder.exists());
        let mut made: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        let hidden = path.join(UNFINISHED);
        if found_at(&hidden).map_err(FolderError::read(&hidden))?.is_none() {
            made.insert(0, hidden);
        }
        if !self.existed {
            make_folders(&path).map_err(FolderError::unwritable(&path))?;
            // Another process may have created it in the meantime.
            self = Self::open(&path)?;
        }
        let is_complete = matches!(self.inspection.contents, Contents::Complete(_));
        let listed = match self.inspection.contents {
            Contents::Empty => Vec::new(),
            Contents::Complete(Err(error)) if force => return Err(error.into()),
            _ if force => self.inspection.listed()?,
            Contents::Interrupted => return Err(FolderError::Interrupted { path }),
            Contents::Foreign | Contents::Complete(_) => return Err(FolderError::NotEmpty { path }),
        };
        let managed = managed_files(&path, &listed)?;
        let checkpoints = [CHECKPOINT, PREVIOUS].map(|name| format!("{UNFINISHED}/{name}"));
        let inputs = inputs.iter().map(|input| input.name.clone());
        let names = result_files().chain([CASE.to_owned()]).chain(checkpoints);
        refuse_unmanaged(&path, names.chain(inputs), &managed, &listed)?;
        let mut folder = RunFolder::begin(path, self.lock)?;
        folder.new = true;
        if is_complete {
            // Once the manifest is removed, only the journal marks these files as slipfront's.
            folder.list(&listed)?;
        }
        Ok(ClaimedFolder {
            folder,
            replaced: managed,
            made,
        })
    }

    /// Takes over the folder of an interrupted run of this case: removes its results, which are written
    /// again. The case, the files that it reads and the checkpoints stay.
    ///
    /// # Errors
    /// When a file that the run has not written is in the place of a result: then nothing is removed.
    pub fn resume(self, case: &Case) -> Result<RunFolder, FolderError> {
        let listed = self.inspection.listed()?;
        let path = self.inspection.path;
        let managed = managed_files(&path, &listed)?;
        refuse_unmanaged(&path, result_files(), &managed, &listed)?;
        let mut folder = RunFolder::begin(path, self.lock)?;
        remove_files(&folder.path, result_files())?;
        let cleared = folder.unfinished.clear_temporary();
        cleared.map_err(FolderError::unwritable(&folder.temporary()))?;
        // A case that was loaded can always be written.
        let text = case.file.to_toml().unwrap_or_default();
        let mut hasher = blake3::Hasher::new();
        let written = ManifestFile::hashed(CASE, hasher.update(text.as_bytes()));
        folder.written.push(written);
        folder
            .written
            .extend(case.inputs.iter().map(ManifestFile::of_input));
        folder.sync()?;
        Ok(folder)
    }
}

/// A folder that is ready for a new run, except for the files of an earlier one.
#[derive(Debug)]
pub struct ClaimedFolder {
    folder: RunFolder,
    /// Files of the earlier run.
    replaced: Vec<String>,
    /// Folders that were made for this run, each before the folder that contains it.
    made: Vec<PathBuf>,
}

impl ClaimedFolder {
    /// Removes the files of the earlier run.
    ///
    /// # Errors
    /// When a file cannot be removed.
    pub fn take(self) -> Result<RunFolder, FolderError> {
        let (manifest, others): (Vec<_>, Vec<_>) =
            self.replaced.into_iter().partition(|name| name == MANIFEST);
        if !manifest.is_empty() {
            remove_files(&self.folder.path, manifest)?;
            // Otherwise, after a power failure, a manifest could mark the run as complete although other
            // files are gone.
            self.folder.sync()?;
        }
        remove_files(&self.folder.path, others)?;
        Ok(self.folder)
    }

    /// Restores the folder as it was found.
    pub fn release(self) {
        // Errors are ignored here: the reason why the run does not begin is more important.
        if self.made.contains(&self.folder.path.join(UNFINISHED)) {
            let _ = self.folder.unfinished.remove();
        }
        for folder in self.made {
            let _ = std::fs::remove_dir(folder);
        }
    }
}

/// Fails on all ranks, with the same message, unless each of them sees under its path the folder in which
/// rank 0 is about to run. Every rank must call this function.
///
/// # Errors
/// When a rank does not; the sentence names it.
pub fn expect_shared(path: &Path, communicator: &dyn Communicator) -> Result<(), RankFailure> {
    if communicator.size() == 1 {
        return Ok(());
    }
    let is_first = communicator.rank() == 0;
    let failure = |sentence| RankFailure { status: 2, sentence };
    let temporary = Unfinished::in_folder(path).temporary();
    let marked = is_first.then(|| write_temp(&temporary, |_| Ok(()))).transpose();
    let marked = marked.map_err(|error| failure(FolderError::unwritable(path)(error).to_string()));
    let mark = agree(communicator, marked)?;
    let name = mark.as_ref().and_then(|mark| mark.file_name());
    let name = name.unwrap_or_default().to_string_lossy();
    let name = text_of(communicator, 0, &name);
    let of_first = text_of(communicator, 0, &display_path(path));
    let seen = match found_at(&temporary.join(name)) {
        Ok(Some(_)) => Ok(()),
        Ok(None) => Err(format!(
            "the folder {} is not the folder {of_first} of rank 0: all ranks need the same folder, on a shared disk",
            display_path(path)
        )),
        Err(error) => Err(FolderError::read(path)(error).to_string()),
    };
    agree(communicator, seen.map_err(failure))
}

/// A folder to which a run is written.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    unfinished: Unfinished,
    journal: Journal,
    /// Files of the run.
    written: Vec<ManifestFile>,
    /// Whether this process began the run.
    new: bool,
    /// Flag that ends the copying of files that the case reads.
    stop: Arc<AtomicBool>,
    /// Lock of the folder, held as long as the run goes on.
    _lock: Option<File>,
}

impl RunFolder {
    /// Opens and claims a folder, and removes the files of an earlier run: see [`OpenedFolder::open`],
    /// [`OpenedFolder::claim`] and [`ClaimedFolder::take`].
    pub fn prepare(path: &Path, force: bool, inputs: &[Input]) -> Result<Self, FolderError> {
        OpenedFolder::open(path)?.claim(force, inputs)?.take()
    }

    /// Makes the hidden subfolder, with which a run begins or is resumed.
    fn begin(path: PathBuf, lock: Option<File>) -> Result<Self, FolderError> {
        let unfinished = Unfinished::in_folder(&path);
        // A `slipfront plot` that was killed may have left half a picture.
        clear_unfinished(&path);
        Ok(Self {
            journal: unfinished.create()?,
            path,
            unfinished,
            written: Vec::new(),
            new: false,
            stop: Arc::default(),
            _lock: lock,
        })
    }

    /// Lets a flag end the copying of files that the case reads, however long they are.
    pub fn stop_on(&mut self, stop: Arc<AtomicBool>) {
        self.stop = stop;
    }

    /// Ends a run that failed: removes the files that this process has written, if it began the run. A
    /// resumed run keeps its case.
    pub fn discard(self) {
        if self.new {
            let names = self.written.iter().map(|file| &file.name).rev();
            // Errors are ignored here: the error of the run is more important.
            let _ = remove_files(&self.path, names);
            let _ = self.unfinished.remove();
        }
    }

    /// Syncs the folders of the case and of its input files, so that these survive a power failure.
    pub(crate) fn sync(&self) -> Result<(), FolderError> {
        for folder in [self.path.clone(), self.path.join("inputs")] {
            let failed = FolderError::write(&folder);
            if found_at(&folder).map_err(&failed)?.is_some() {
                sync_folder(&folder).map_err(failed)?;
            }
        }
        Ok(())
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file of the run, unless a foreign file is in its place.
    pub fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
        let file = write_temp(&self.temporary(), |file| file.write_all(bytes));
        let path = self.path.join(name);
        self.place(name, file.map_err(FolderError::write(&path))?)
    }

    /// The folder of temporary files.
    pub(crate) fn temporary(&self) -> PathBuf {
        self.unfinished.temporary()
    }

    /// Copies a file that the case reads, unless a foreign file is in its place.
    ///
    /// # Errors
    /// When the file has changed since the case was made from it, or cannot be read or written.
    pub(crate) fn copy(&mut self, input: &Input) -> Result<(), FolderError> {
        let path = self.path.join(&input.name);
        let failed = |source| FolderError::Copy {
            from: input.original.clone(),
            to: path.clone(),
            source,
        };
        let file = input.open().map_err(failed)?;
        let mut original = Until {
            file,
            stop: &self.stop,
        };
        let file = write_temp(&self.temporary(), |to| std::io::copy(&mut original, to).map(drop));
        let file = file.map_err(failed)?;
        let copied = ManifestFile::read_copy(&input.name, &file).map_err(FolderError::write(&path))?;
        if copied != ManifestFile::of_input(input) {
            let path = input.original.clone();
            return Err(FolderError::InputChanged { path });
        }
        self.place_listed(copied, file)
    }

    /// Makes a finished temporary file a file of the run: it is listed in the journal, and then gets its
    /// name, unless a foreign file is in its place.
    pub fn place(&mut self, name: &str, file: TempPath) -> Result<(), FolderError> {
        let listed =
            ManifestFile::read_copy(name, &file).map_err(FolderError::write(&self.path.join(name)))?;
        self.place_listed(listed, file)
    }

    fn place_listed(&mut self, listed: ManifestFile, file: TempPath) -> Result<(), FolderError> {
        let path = self.path.join(&listed.name);
        if found_at(&path).map_err(FolderError::write(&path))?.is_some() {
            return Err(FolderError::Foreign { path });
        }
        if let Some(parent) = path.parent() {
            make_folders(parent).map_err(FolderError::write(parent))?;
        }
        self.list(std::slice::from_ref(&listed))?;
        self.written.push(listed);
        let placed = file.persist(&path).map_err(|error| error.error);
        placed.map_err(FolderError::write(&path))
    }

    /// Lists files in the journal.
    fn list(&mut self, files: &[ManifestFile]) -> Result<(), FolderError> {
        let path = self.unfinished.path().join(JOURNAL);
        self.journal.append(files).map_err(FolderError::write(&path))
    }

    /// Writes the manifest, which makes the run complete, if every file is unchanged since it was written.
    pub fn complete(
        mut self,
        case: &Case,
        started: jiff::Timestamp,
        processors: Processors,
    ) -> Result<Manifest, FolderError> {
        for file in &self.written {
            let path = self.path.join(&file.name);
            let found = ManifestFile::read(&self.path, &file.name).map_err(FolderError::read(&path))?;
            if found != *file {
                return Err(FolderError::Changed { path });
            }
        }
        let files = std::mem::take(&mut self.written);
        let (manifest, bytes) = Manifest::new(files, case, started, processors).with_checksum();
        let file = write_temp(&self.temporary(), |file| file.write_all(&bytes));
        self.place_manifest(file.map_err(FolderError::write(&self.path.join(MANIFEST)))?)?;
        self.close();
        Ok(manifest)
    }

    /// Makes a finished temporary file the manifest. The names of all other files are synced to disk before,
    /// and that of the manifest after, so that no power failure leaves a manifest without the files that it
    /// lists.
    pub(crate) fn place_manifest(&mut self, file: TempPath) -> Result<(), FolderError> {
        self.sync()?;
        self.place(MANIFEST, file)?;
        sync_folder(&self.path).map_err(|error| {
            let path = self.path.join(MANIFEST);
            // A run is not complete if its manifest may not be on the disk.
            let _ = std::fs::remove_file(&path);
            FolderError::write(&path)(error)
        })
    }

    /// Ends a run that is complete: removes the hidden subfolder.
    pub(crate) fn close(self) {
        // Windows cannot remove a folder that holds an open file.
        drop(self.journal);
        // The run is complete, whether the subfolder can be removed or not.
        let _ = self.unfinished.remove();
    }
}

/// Whether a path leads to a folder.
fn is_folder_behind(path: &Path) -> Result<bool, FolderError> {
    let found = found_behind(path).map_err(FolderError::read(path))?;
    Ok(found.is_some_and(|found| found.is_dir()))
}

/// Locks a folder for one process. Some cluster file systems have no locks, and some operating systems cannot
/// lock folders: the run then continues without a lock.
fn lock(path: &Path) -> Result<Option<File>, FolderError> {
    let Ok(folder) = File::open(path) else {
        return Ok(None);
    };
    match folder.try_lock() {
        Ok(()) => Ok(Some(folder)),
        Err(TryLockError::WouldBlock) => Err(FolderError::Busy {
            path: path.to_owned(),
        }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}
