//! Name and free disk space of a machine that has neither, such as a page in a browser.

use std::ffi::OsString;
use std::path::Path;

/// The name of this machine: empty, since a page in a browser has none.
pub fn host_name() -> OsString {
    OsString::new()
}

/// Bytes that are free on the disk of a folder: always `None`, since there is no disk.
pub fn free_disk(_folder: &Path) -> Option<f64> {
    None
}
