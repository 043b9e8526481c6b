//! The page that leads a browser to the address of the laboratory.
//!
//! Every user of the machine can read the arguments with which a browser is started, so that they must not hold the token of the
//! address. They name this file, which only its owner can read, and which is gone once a page has connected.

use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use slipfront_case::unfinished::TemporaryFolder;
use tempfile::{Builder, NamedTempFile};

/// The start page of a laboratory, while its file exists.
#[derive(Clone, Default)]
pub(crate) struct StartPage(Arc<Mutex<Option<StartPageFile>>>);

impl StartPage {
    /// Writes the page that leads to this address; gives its path.
    ///
    /// # Errors
    /// When the system refuses to write.
    pub(crate) fn open(&self, address: &str) -> io::Result<PathBuf> {
        let page = StartPageFile::write(address)?;
        let path = page.page.path().to_owned();
        self.put(Some(page));
        Ok(path)
    }

    /// Removes the file of the start page.
    pub(crate) fn close(&self) {
        self.put(None);
    }

    fn put(&self, page: Option<StartPageFile>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = page;
    }
}

/// The file of a start page in the folder of temporary files of this process. Dropping the value removes the file.
struct StartPageFile {
    page: NamedTempFile,
    _folder: Arc<TemporaryFolder>,
}

impl StartPageFile {
    /// Writes a page that leads to this address.
    ///
    /// # Errors
    /// When the system refuses to write.
    fn write(address: &str) -> io::Result<Self> {
        let folder = TemporaryFolder::shared()?;
        // Such files are for their owner alone.
        let mut page = Builder::new().suffix(".html").tempfile_in(folder.path())?;
        page.write_all(html(address).as_bytes())?;
        Ok(Self {
            page,
            _folder: folder,
        })
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
