//! Name and free disk space of a machine without a disk, such as a page of a browser: neither is known.

use std::ffi::OsString;
use std::path::Path;

/// The name of this machine: it has none.
pub fn host_name() -> OsString {
    OsString::new()
}

/// Bytes that are free on the disk of a folder: nobody knows.
pub fn free_disk(_folder: &Path) -> Option<f64> {
    None
}
