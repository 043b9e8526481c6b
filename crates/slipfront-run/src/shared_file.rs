//! Files that ranks write together, each its own rows.

use std::fs::File;
use std::io;
use std::path::Path;

use slipfront::communicator::{Communicator, text_of};
use slipfront_base::disk::write_temp;
use tempfile::TempPath;

use crate::agree::agree_on_io;

/// Writes a temporary file to a folder that all ranks see. The first rank, which returns the file, creates it
/// with everything that does not belong to rows; then every rank writes its rows into it. All ranks must call
/// this together.
///
/// # Errors
/// Errors of any rank, on all of them.
pub(crate) fn write_shared(
    temporary: &Path,
    communicator: &dyn Communicator,
    create: impl FnOnce(&mut File) -> io::Result<()>,
    write_rows: impl Fn(&mut File) -> io::Result<()>,
) -> io::Result<Option<TempPath>> {
    let is_first = communicator.rank() == 0;
    let fill = |output: &mut File| {
        create(output)?;
        write_rows(output)
    };
    let created = if is_first {
        write_temp(temporary, fill).map(Some)
    } else {
        Ok(None)
    };
    let created = agree_on_io(communicator, created)?;
    let name = created.as_ref().and_then(|path| path.file_name());
    let name = name.unwrap_or_default().to_string_lossy();
    let shared = temporary.join(text_of(communicator, 0, &name));
    let write_own = || {
        if is_first {
            return Ok(());
        }
        let mut output = File::options().write(true).open(shared)?;
        write_rows(&mut output)?;
        output.sync_all()
    };
    agree_on_io(communicator, write_own())?;
    Ok(created)
}
