//! The text of a case or study file.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::error::CaseError;

/// The largest file that is read as a case, in MiB.
const MAX_MIB: u64 = 16;

/// Reads a case or study file of at most 16 MiB.
///
/// # Errors
/// When the path is missing, a folder, too large or not UTF-8 text.
pub fn read_text(path: &Path) -> Result<String, CaseError> {
    let path = path.to_owned();
    if path.is_dir() {
        return Err(CaseError::Folder { path });
    }
    let limit = MAX_MIB << 20;
    let mut bytes = Vec::new();
    // The limit holds for what is read, since a device or a pipe tells no size.
    let read = File::open(&path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes));
    if let Err(source) = read {
        return Err(CaseError::Unreadable { path, source });
    }
    if bytes.len() as u64 > limit {
        let limit_mib = MAX_MIB;
        return Err(CaseError::TooLarge { path, limit_mib });
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
        CaseError::NotText { path, line }
    })
}
