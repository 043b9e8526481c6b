//! Files that hold the address of the laboratory, and which only their owner can read.
//!
//! Every user of the machine can read the arguments with which a browser is started, so that they must not
//! hold the token of the address. They name the start page, which leads to the address, and which is gone
//! once a page has connected. A log that others can read names a file with the address.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use slipfront_base::unfinished::TemporaryFolder;
use tempfile::{Builder, NamedTempFile};

/// The start page of a laboratory, while its file exists.
#[derive(Clone, Default)]
pub(crate) struct StartPage(Arc<Mutex<Option<PrivateFile>>>);

impl StartPage {
    /// Writes the page that leads to this address; gives its path.
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

/// A file in the folder of temporary files of this process, for this user alone. Dropping the value removes
/// the file.
pub struct PrivateFile {
    file: NamedTempFile,
    _folder: Arc<TemporaryFolder>,
}

impl PrivateFile {
    /// Writes a file whose name has this ending.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub(crate) fn write(ending: &str, text: &str) -> io::Result<Self> {
        let folder = TemporaryFolder::shared()?;
        // Such files are for their owner alone.
        let mut file = Builder::new().suffix(ending).tempfile_in(folder.path())?;
        file.write_all(text.as_bytes())?;
        Ok(Self {
            file,
            _folder: folder,
        })
    }

    /// Path of the file, which may be told to everybody.
    pub fn path(&self) -> &Path {
        self.file.path()
    }
}

/// The start page: it needs no script, and sends servers no address of its own.
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
