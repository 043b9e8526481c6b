//! Name of the machine and free bytes on its disks, from the operating system.

use std::ffi::OsString;
use std::path::Path;

/// The name of this machine.
pub fn host_name() -> OsString {
    gethostname::gethostname()
}

/// Bytes that are free on the disk of a folder, which need not exist yet. `None` if the system does not
/// report it.
pub fn free_disk(folder: &Path) -> Option<f64> {
    let whole = std::path::absolute(folder).ok()?;
    let there = whole.ancestors().find(|path| path.is_dir())?;
    Some(fs4::available_space(there).ok()? as f64)
}
