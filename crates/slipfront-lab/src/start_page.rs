//! The page that leads a browser to the address of the laboratory.
//!
//! Every user of the machine can read the arguments with which a browser is started, so that they must not hold the token of the
//! address. They name this file, which only its owner can read, and which is gone once a page has connected.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use tempfile::{Builder, NamedTempFile, TempDir};

/// What the name of the folder of such a page begins with.
const FOLDER: &str = "slipfront-lab.";

const PAGE: [&str; 2] = ["open", ".html"];

/// The file in the folder that is locked as long as the server lives.
const LOCK: &str = "lock";

/// The start page, as long as there is one.
#[derive(Clone, Default)]
pub(crate) struct Entrance(Arc<Mutex<Option<StartPage>>>);

impl Entrance {
    /// Writes the page that leads to this address; gives its path.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub(crate) fn open(&self, address: &str) -> io::Result<PathBuf> {
        let page = StartPage::write(address)?;
        let path = page.page.path().to_owned();
        self.put(Some(page));
        Ok(path)
    }

    /// Removes the page.
    pub(crate) fn close(&self) {
        self.put(None);
    }

    fn put(&self, page: Option<StartPage>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = page;
    }
}

/// A page in a folder of its own, which is removed when this is dropped.
struct StartPage {
    _lock: File,
    page: NamedTempFile,
    _folder: TempDir,
}

impl StartPage {
    /// Writes a page that leads to this address, and removes those of servers that were killed.
    ///
    /// # Errors
    /// When the system refuses to write.
    fn write(address: &str) -> io::Result<Self> {
        let mut folder = Builder::new();
        folder.prefix(FOLDER);
        #[cfg(unix)]
        folder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let folder = folder.tempdir()?;
        remove_left_over(folder.path());
        // Before the page, so that a page beside a lock that nobody holds belongs to a server that is gone.
        let lock = File::create_new(folder.path().join(LOCK))?;
        lock.lock()?;
        let [name, ending] = PAGE;
        let mut page = Builder::new()
            .prefix(name)
            .suffix(ending)
            .rand_bytes(0)
            .tempfile_in(folder.path())?;
        page.write_all(html(address).as_bytes())?;
        Ok(Self {
            _lock: lock,
            page,
            _folder: folder,
        })
    }
}

/// It needs no script, and leaves no address of its own in what a server is told.
fn html(address: &str) -> String {
    let address = address
        .replace('&', "&amp;")
        .replace('"', "&quot;")
        .replace('<', "&lt;");
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n\
         <meta http-equiv=\"refresh\" content=\"0; url={address}\">\n<title>slipfront lab</title>\n\
         <p><a href=\"{address}\">Open the laboratory</a></p>\n"
    )
}

/// Removes the folders of servers that were killed, of the same user and beside this folder.
fn remove_left_over(own: &Path) {
    let beside = own.parent().map(fs::read_dir);
    for entry in beside.into_iter().flatten().flatten().flatten() {
        let is_named = entry.file_name().to_string_lossy().starts_with(FOLDER);
        if is_named && is_left_over(&entry.path(), own).unwrap_or(false) {
            // What cannot be removed is no harm: its token opens nothing any more.
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

fn is_left_over(folder: &Path, own: &Path) -> io::Result<bool> {
    let found = folder.symlink_metadata()?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        if found.uid() != own.symlink_metadata()?.uid() {
            return Ok(false);
        }
    }
    if !found.is_dir() || !folder.join(PAGE.concat()).try_exists()? {
        return Ok(false);
    }
    let lock = File::options().write(true).open(folder.join(LOCK))?;
    Ok(lock.try_lock().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ADDRESS: &str = "http://127.0.0.1:1/#token=0123&case=abc";

    #[test]
    fn only_its_owner_can_read_it() {
        let entrance = Entrance::default();
        let page = entrance.open(ADDRESS).unwrap();
        let folder = page.parent().unwrap();
        let text = fs::read_to_string(&page).unwrap();
        assert!(
            text.contains("url=http://127.0.0.1:1/#token=0123&amp;case=abc\""),
            "{text}"
        );
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
            assert_eq!((mode(&page), mode(folder)), (0o600, 0o700));
        }
        entrance.close();
        assert!(!folder.exists());
    }

    #[test]
    fn an_address_cannot_leave_its_attribute() {
        let plain = html(ADDRESS);
        let text = html("http://127.0.0.1:1/#token=0123&case=\"><script>alert(1)</script>");
        assert!(!text.contains("<script"), "{text}");
        assert_eq!(text.matches('"').count(), plain.matches('"').count(), "{text}");
    }

    #[test]
    fn pages_of_servers_that_were_killed_are_removed_and_no_others() {
        let page = StartPage::write(ADDRESS).unwrap();
        let beside = page.page.path().parent().unwrap().parent().unwrap();
        let folder = |files: &[&str]| {
            let folder = tempfile::Builder::new()
                .prefix(FOLDER)
                .tempdir_in(beside)
                .unwrap();
            for file in files {
                fs::write(folder.path().join(file), "").unwrap();
            }
            folder
        };
        let killed = folder(&["open.html", LOCK]);
        // Of a server that begins: its page is not there yet.
        let begins = folder(&[LOCK]);
        let other = folder(&["open.html"]);
        let _second = StartPage::write(ADDRESS).unwrap();
        let there = [killed, begins, other].map(|folder| folder.path().exists());
        assert_eq!(there, [false, true, true]);
        assert!(page.page.path().exists());
    }
}
