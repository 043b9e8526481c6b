//! Hidden files and folders, which exist while a process works on something, and the leftovers of killed
//! processes.
//!
//! A name is derived from the target of the work: `.slipfront-`, 16 digits of a hash of the target, `-` and 6
//! random letters or digits. The process that creates the file or folder holds its lock. The next process
//! with the same target removes leftovers with a free lock, because their process has ended. The random
//! letters separate living processes, and users, from each other. On a file system without locks, nothing is
//! removed.

use std::fs::{DirEntry, File, Metadata, TryLockError};
use std::io::{Error, Result};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use tempfile::{Builder, NamedTempFile, TempDir};

use crate::folders::{folder_of, sync_folder};
use crate::machine::host_name;

/// The beginning of every hidden name.
const BEGINNING: &str = ".slipfront-";
/// Digits of the hash.
const DIGITS: usize = 16;
/// Random letters or digits.
const RANDOM: usize = 6;
/// Largest number of attempts to create a hidden file: another process may take it for a leftover before it
/// is locked.
const TRIES: usize = 100;

/// Beginning of the hidden names of one target, without the random letters.
fn beginning_for(target: &[u8]) -> String {
    format!("{BEGINNING}{}-", &blake3::hash(target).to_hex()[..DIGITS])
}

/// Whether a name is a hidden name, of any target.
pub fn is_unfinished(name: &str) -> bool {
    let parts = name.strip_prefix(BEGINNING).and_then(|rest| rest.split_once('-'));
    parts.is_some_and(|(hash, random)| {
        (hash.len(), random.len()) == (DIGITS, RANDOM)
            && hash.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
            && random.bytes().all(|byte| byte.is_ascii_alphanumeric())
    })
}

/// Creates an empty, locked file in the folder of its final path, and removes such files of killed processes.
pub(crate) fn file_for(folder: &Path, path: &Path) -> Result<NamedTempFile> {
    let beginning = beginning_for(path.file_name().unwrap_or_default().as_encoded_bytes());
    clear(folder, &beginning, is_file);
    let make = || builder(&beginning, 0o666).tempfile_in(folder);
    until_locked(make, |file| hold(Some(file.as_file()), file.path()))
}

/// Removes the files of killed processes in a folder, for any target.
pub fn clear_unfinished(folder: &Path) {
    clear(folder, BEGINNING, is_file);
}

/// Folder in the system's folder for temporary files (`TMPDIR`), accessible to this user alone. It is removed
/// with its contents when dropped.
#[derive(Debug)]
pub struct TemporaryFolder {
    // Fields are dropped in order: the folder stays locked until it is removed.
    folder: TempDir,
    _lock: Option<File>,
    /// The process that made the folder.
    process: u32,
}

impl TemporaryFolder {
    /// Creates an empty folder for work on a folder, and removes such folders of processes that were killed
    /// on this machine.
    pub fn new(target: &Path) -> Result<Self> {
        let target = target.canonicalize().unwrap_or_else(|_| target.to_owned());
        Self::of_target(target.as_os_str().as_encoded_bytes())
    }

    /// The folder for all work of this process that has no target. It exists while any part of the program
    /// holds it.
    pub fn shared() -> Result<Arc<Self>> {
        static SHARED: Mutex<Weak<TemporaryFolder>> = Mutex::new(Weak::new());
        let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(folder) = shared.upgrade().filter(|folder| folder.is_own()) {
            return Ok(folder);
        }
        let folder = Arc::new(Self::of_target(b"")?);
        *shared = Arc::downgrade(&folder);
        Ok(folder)
    }

    fn of_target(target: &[u8]) -> Result<Self> {
        // Machines may share the folder without seeing each other's locks.
        let host = host_name();
        let beginning = beginning_for(&[host.as_encoded_bytes(), b"\0", target].concat());
        let (folder, lock) = locked_folder(&std::env::temp_dir(), &beginning, 0o700)?;
        Ok(Self {
            folder,
            _lock: lock,
            process: std::process::id(),
        })
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Whether this process made the folder, rather than a parent process that forked it, as Python does.
    fn is_own(&self) -> bool {
        self.process == std::process::id()
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        self.folder.disable_cleanup(!self.is_own());
    }
}

/// Folder under a hidden name, next to the place that it will be renamed to. Until then, it is removed with
/// its contents when dropped.
#[derive(Debug)]
pub struct UnfinishedFolder {
    // Fields are dropped in order: the folder stays locked until it is removed.
    folder: TempDir,
    _lock: Option<File>,
}

impl UnfinishedFolder {
    /// Creates an empty folder, and removes such folders of killed processes for the same place.
    pub fn beside(path: &Path) -> Result<Self> {
        let beginning = beginning_for(path.file_name().unwrap_or_default().as_encoded_bytes());
        let (folder, lock) = locked_folder(folder_of(path), &beginning, 0o777)?;
        Ok(Self { folder, _lock: lock })
    }

    /// Path of the folder under its hidden name.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Renames the folder to its final name, in place of an empty folder if there is one, so that it survives
    /// a power failure.
    pub fn persist(mut self, path: &Path) -> Result<()> {
        sync_folder(self.path())?;
        // Not every system replaces an empty folder.
        let _ = std::fs::remove_dir(path);
        std::fs::rename(self.path(), path)?;
        self.folder.disable_cleanup(true);
        sync_folder(folder_of(path))
    }
}

/// Creates an empty, locked folder with this beginning of its name, and removes such folders of this user
/// that have a free lock.
fn locked_folder(parent: &Path, beginning: &str, mode: u32) -> Result<(TempDir, Option<File>)> {
    let make = || {
        let folder = builder(beginning, mode).tempdir_in(parent)?;
        // Some systems cannot open folders: there the folder has no lock, and no process removes it.
        let lock = File::open(folder.path()).ok();
        Ok((folder, lock))
    };
    let made = until_locked(make, |(folder, lock)| hold(lock.as_ref(), folder.path()))?;
    let (folder, _) = &made;
    if let Ok(own) = folder.path().symlink_metadata() {
        // Where locks fail, the new folder itself must not be taken for a leftover.
        clear(parent, beginning, |entry| {
            let is_alike = |found: Metadata| found.is_dir() && owner(&found) == owner(&own);
            Some(&*entry.file_name()) != folder.path().file_name() && entry.metadata().is_ok_and(is_alike)
        });
    }
    Ok(made)
}

/// Builder of temporary files and folders with this beginning of their names, and this mode.
pub(crate) fn builder<'a>(beginning: &'a str, mode: u32) -> Builder<'a, 'static> {
    let mut builder = Builder::new();
    builder.prefix(beginning).rand_bytes(RANDOM);
    // By default, files are private, unlike results, and folders are not.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
    builder
}

/// The owner of a file or folder, on systems that know it.
#[cfg(unix)]
fn owner(found: &Metadata) -> u32 {
    std::os::unix::fs::MetadataExt::uid(found)
}

#[cfg(not(unix))]
fn owner(_: &Metadata) -> u32 {
    0
}

/// Creates files or folders until one is locked.
fn until_locked<T>(make: impl Fn() -> Result<T>, is_locked: impl Fn(&T) -> bool) -> Result<T> {
    for _ in 0..TRIES {
        let made = make()?;
        if is_locked(&made) {
            return Ok(made);
        }
    }
    Err(Error::other(
        "another process locks or removes whatever is made there",
    ))
}

/// Locks a new file or folder; returns false if another process has already taken it for a leftover. Where
/// there are no locks, no process has.
fn hold(made: Option<&File>, path: &Path) -> bool {
    let is_taken = |made: &File| matches!(made.try_lock(), Err(TryLockError::WouldBlock));
    !made.is_some_and(is_taken) && path.symlink_metadata().is_ok()
}

/// Removes the hidden entries of killed processes from a folder, of the given kind and with the given
/// beginning of the name. Errors are ignored: a leftover does no harm.
fn clear(folder: &Path, beginning: &str, is_meant: impl Fn(&DirEntry) -> bool) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_named = |name: &str| name.starts_with(beginning) && is_unfinished(name);
        if name.to_str().is_some_and(is_named) && is_meant(&entry) {
            let _ = remove_unless_locked(&entry.path());
        }
    }
}

/// Whether an entry is a file, rather than a link to one.
fn is_file(entry: &DirEntry) -> bool {
    entry.metadata().is_ok_and(|found| found.is_file())
}

/// Removes a file, or a folder with all that it holds, unless a living process holds its lock.
fn remove_unless_locked(path: &Path) -> Result<()> {
    // Only a folder opens with `.`. A file is opened for writing, because some network file systems lock it
    // only then.
    let folder = File::open(path.join("."));
    let file = match &folder {
        Ok(folder) => folder,
        Err(_) => &File::options().read(true).write(true).open(path)?,
    };
    // If its writer has renamed the file meanwhile, this name no longer exists, and no other file gets it.
    match file.try_lock() {
        Err(_) => Ok(()),
        Ok(()) if folder.is_ok() => std::fs::remove_dir_all(path),
        Ok(()) => std::fs::remove_file(path),
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::os::unix::fs::{PermissionsExt, chown, symlink};
    use std::path::PathBuf;

    use super::*;
    use crate::disk::write_atomic;

    /// Names in a folder, in order.
    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Path with a hidden name for a target; nothing is created.
    fn hidden(folder: &Path, target: &str) -> PathBuf {
        folder.join(format!("{}AbC123", beginning_for(target.as_bytes())))
    }

    #[test]
    fn what_a_killed_process_left_is_removed_by_the_next_for_its_target() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let (_, left) = file_for(folder.path(), &path).unwrap().keep().unwrap();
        std::fs::write(&left, "half of").unwrap();
        assert_eq!(names(folder.path()).len(), 1);
        write_atomic(&folder.path().join("b.png"), b"b").unwrap();
        assert!(left.exists());
        write_atomic(&path, b"a").unwrap();
        assert_eq!(names(folder.path()), ["a.png", "b.png"]);
        assert_eq!(std::fs::read(&path).unwrap(), b"a");
        let mode = std::fs::metadata(&path).unwrap().permissions().mode();
        std::fs::write(folder.path().join("plain"), "").unwrap();
        let plain = std::fs::metadata(folder.path().join("plain")).unwrap();
        assert_eq!(mode, plain.permissions().mode());
    }

    #[test]
    fn what_a_living_process_writes_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let first = file_for(folder.path(), &path).unwrap();
        std::fs::write(first.path(), "first").unwrap();
        write_atomic(&path, b"second").unwrap();
        clear_unfinished(folder.path());
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        // The last writer to finish replaces the file.
        first.persist(&path).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        assert_eq!(names(folder.path()), ["a.png"]);
    }

    /// Many processes write one file at once: each succeeds, the file is one of theirs, and nothing else
    /// remains.
    #[test]
    fn writers_of_one_file_do_not_disturb_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let text = |writer: usize| vec![b'0' + writer as u8; 1000];
        std::thread::scope(|scope| {
            for writer in 0..8 {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..50 {
                        write_atomic(path, &text(writer)).unwrap();
                        let found = std::fs::read(path).unwrap();
                        assert!((0..8).any(|other| found == text(other)));
                    }
                });
            }
        });
        assert_eq!(names(folder.path()), ["a.png"]);
    }

    #[test]
    fn what_was_taken_away_before_it_was_locked_is_made_anew() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("made");
        let tries = std::cell::Cell::new(0);
        let make = || File::create(&path);
        let is_locked = |file: &File| {
            tries.set(tries.get() + 1);
            // Another process is faster three times: it holds the lock, or has removed the file.
            let other = File::open(&path).unwrap();
            match tries.get() {
                1 => other.try_lock().unwrap(),
                2 | 3 => remove_unless_locked(&path).unwrap(),
                _ => {}
            }
            hold(Some(file), &path)
        };
        until_locked(make, is_locked).unwrap();
        // There are more than four tries if another test starts a process meanwhile: until the child runs its
        // own program, it has a copy of the open file, and thus of the lock.
        assert!(tries.get() >= 4);
        assert!(until_locked(make, |_| false).is_err());
    }

    #[test]
    fn what_slipfront_did_not_write_is_neither_removed_nor_followed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mine = folder.path().join("mine");
        std::fs::write(&mine, "mine").unwrap();
        let link = hidden(folder.path(), "a.png");
        symlink(&mine, &link).unwrap();
        let name = link.file_name().unwrap().to_str().unwrap();
        for other in [
            name.replace("AbC123", "notes1.txt"),
            name.replace("AbC123", "mine"),
        ] {
            assert!(!is_unfinished(&other), "{other}");
            std::fs::write(folder.path().join(other), "mine").unwrap();
        }
        let kept = folder.path().join(name.replace("AbC123", "Folder"));
        std::fs::create_dir(&kept).unwrap();
        std::fs::write(kept.join("mine"), "mine").unwrap();
        let before = names(folder.path());
        write_atomic(&path, b"a").unwrap();
        clear_unfinished(folder.path());
        std::fs::remove_file(&path).unwrap();
        assert_eq!(names(folder.path()), before);
        assert_eq!(std::fs::read(&mine).unwrap(), b"mine");
        assert_eq!(std::fs::read(kept.join("mine")).unwrap(), b"mine");
    }

    /// The hidden name of a file is no longer than the system allows, even if the name of the file has the
    /// largest length.
    #[test]
    fn a_name_may_be_as_long_as_the_system_allows() {
        let folder = tempfile::tempdir().unwrap();
        let name = "n".repeat(255);
        write_atomic(&folder.path().join(&name), b"a").unwrap();
        assert_eq!(names(folder.path()), [name]);
    }

    #[test]
    fn a_temporary_folder_goes_with_its_process_or_with_the_next_for_its_target() {
        let target = tempfile::tempdir().unwrap();
        let first = TemporaryFolder::new(target.path()).unwrap();
        let mode = first.path().metadata().unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o700);
        // Another name of the same target.
        let second = TemporaryFolder::new(&target.path().join(".")).unwrap();
        assert!(first.path().exists() && first.path() != second.path());
        let left = first.path().to_owned();
        std::fs::create_dir(left.join("inner")).unwrap();
        std::fs::write(left.join("inner/fields.nc"), "half of").unwrap();
        drop(TemporaryFolder::new(target.path()).unwrap());
        assert!(left.exists(), "it is locked");
        // As in a fork of the process.
        let mut first = first;
        first.process = 0;
        drop(first);
        assert!(left.exists(), "another process made it");
        let other = tempfile::tempdir().unwrap();
        drop(TemporaryFolder::new(other.path()).unwrap());
        assert!(left.exists(), "it is for another target");
        // A child process that another test starts at this moment holds the lock until it runs its own
        // program.
        let started = std::time::Instant::now();
        while left.exists() && started.elapsed() < std::time::Duration::from_secs(10) {
            drop(TemporaryFolder::new(target.path()).unwrap());
        }
        assert!(!left.exists() && second.path().exists());
        let path = second.path().to_owned();
        drop(second);
        assert!(!path.exists());
    }

    #[test]
    fn a_folder_is_hidden_until_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("crate");
        // As a killed process leaves it.
        let left = hidden(folder.path(), "crate");
        std::fs::create_dir(&left).unwrap();
        std::fs::write(left.join("half"), "half of").unwrap();
        let made = UnfinishedFolder::beside(&path).unwrap();
        assert!(!left.exists() && !path.exists());
        std::fs::write(made.path().join("whole"), "whole").unwrap();
        made.persist(&path).unwrap();
        assert_eq!(names(folder.path()), ["crate"]);
        assert_eq!(names(&path), ["whole"]);
        let plain = folder.path().join("plain");
        std::fs::create_dir(&plain).unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain));
        // An empty folder is replaced, any other one is not.
        let made = UnfinishedFolder::beside(&plain).unwrap();
        std::fs::write(made.path().join("whole"), "whole").unwrap();
        made.persist(&plain).unwrap();
        assert_eq!(names(&plain), ["whole"]);
        let made = UnfinishedFolder::beside(&plain).unwrap();
        assert!(made.persist(&plain).is_err());
        assert_eq!(names(folder.path()), ["crate", "plain"]);
    }

    /// In a shared folder, other users can create entries that look like leftovers.
    #[test]
    fn temporary_folders_of_other_users_and_links_stay() {
        let target = tempfile::tempdir().unwrap();
        let made = TemporaryFolder::new(target.path()).unwrap();
        let sibling = |random: &str| {
            let name = made.path().file_name().unwrap().to_str().unwrap();
            made.path()
                .with_file_name(format!("{}{random}", &name[..name.len() - RANDOM]))
        };
        let (link, foreign, file) = (sibling("AAAAAA"), sibling("BBBBBB"), sibling("CCCCCC"));
        let mine = target.path().join("mine");
        std::fs::create_dir(&mine).unwrap();
        symlink(&mine, &link).unwrap();
        std::fs::write(&file, "mine").unwrap();
        std::fs::create_dir(&foreign).unwrap();
        // Only root can change the owner of a folder.
        let given_away = chown(&foreign, Some(65534), None).is_ok();
        drop(TemporaryFolder::new(target.path()).unwrap());
        assert!(link.symlink_metadata().is_ok() && mine.exists() && file.exists());
        assert_eq!(foreign.exists(), given_away);
        std::fs::remove_file(link).unwrap();
        std::fs::remove_file(file).unwrap();
        if given_away {
            std::fs::remove_dir(foreign).unwrap();
        }
    }

    #[test]
    fn work_without_a_target_shares_a_folder() {
        let first = TemporaryFolder::shared().unwrap();
        let path = first.path().to_owned();
        let second = TemporaryFolder::shared().unwrap();
        assert_eq!(second.path(), path);
        drop(first);
        assert!(path.exists());
        drop(second);
        assert!(!path.exists());
    }
}
