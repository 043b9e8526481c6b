//! Files with the address of the laboratory that only their owner can read.
//!
//! Every user of the machine can read the arguments of a browser process, so they must not contain the token
//! of the address. Instead they name the start page, a file that leads to the address and is removed once a
//! page has connected. A log that others can read names a file with the address.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use slipfront_base::unfinished::TemporaryFolder;
use tempfile::{Builder, NamedTempFile};

/// The start page of a laboratory, while its file exists.
#[derive(Clone, Default)]
pub(crate) struct StartPage(Arc<Mutex<Option<PrivateFile>>>);

impl StartPage {
    /// Writes the page that leads to this address; returns its path.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub(crate) fn open(&self, address: &str) -> io::Result<PathBuf> {
        let page = PrivateFile::write(".html", &html(address))?;
        let path = page.path().to_owned();
        self.put(Some(page));
        Ok(path)
    }

    /// Removes the file of the start page.
    pub(crate) fn close(&self) {
        self.put(None);
    }

    fn put(&self, page: Option<PrivateFile>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = page;
    }
}

/// A file in this process's folder of temporary files that only this user can read. Dropping the value
/// removes the file.
pub struct PrivateFile {
    file: NamedTempFile,
    _folder: Arc<TemporaryFolder>,
}

impl PrivateFile {
    /// Writes a file with a name that ends in `ending`.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub(crate) fn write(ending: &str, text: &str) -> io::Result<Self> {
        let folder = TemporaryFolder::shared()?;
        // The builder makes files that only their owner can read.
        let mut file = Builder::new().suffix(ending).tempfile_in(folder.path())?;
        file.write_all(text.as_bytes())?;
        Ok(Self {
            file,
            _folder: folder,
        })
    }

    /// Path of the file, which need not be secret.
    pub fn path(&self) -> &Path {
        self.file.path()
    }
}

/// The start page: it needs no script, and reveals its own address to no server.
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

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    const ADDRESS: &str = "http://127.0.0.1:1/#token=0123&case=abc";

    #[test]
    fn only_its_owner_can_read_it() {
        let start_page = StartPage::default();
        let page = start_page.open(ADDRESS).unwrap();
        let folder = page.parent().unwrap();
        let text = fs::read_to_string(&page).unwrap();
        assert!(
            text.contains("url=http://127.0.0.1:1/#token=0123&amp;case=abc\""),
            "{text}"
        );
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = |path: &std::path::Path| path.metadata().unwrap().permissions().mode() & 0o777;
            assert_eq!((mode(&page), mode(folder)), (0o600, 0o700));
        }
        start_page.close();
        assert!(!page.exists());
    }

    #[test]
    fn an_address_cannot_leave_its_attribute() {
        let plain = html(ADDRESS);
        let text = html("http://127.0.0.1:1/#token=0123&case=\"><script>alert(1)</script>");
        assert!(!text.contains("<script"), "{text}");
        assert_eq!(text.matches('"').count(), plain.matches('"').count(), "{text}");
    }
}
