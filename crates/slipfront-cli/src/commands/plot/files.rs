//! Folders of `slipfront plot`: the results folders that are drawn, and the output folder of the pictures.

use std::path::Path;

use slipfront_base::disk::{make_folders, read_limited, write_atomic};
use slipfront_base::machine::available_of;
use slipfront_base::number_format::byte_size;
use slipfront_case::arrays::extension;
use slipfront_case::case::PROGRAM;
use slipfront_plot::PictureFormat;
use slipfront_run::names::MANIFEST;
use slipfront_run::run_folder::inspection::Inspection;
use slipfront_study::verify::has_records;

use crate::failure::Failure;
use crate::print::print_message;
use crate::signals::Signals;

/// Names and contents of picture files.
pub(super) type PictureFiles = Vec<(String, Vec<u8>)>;

/// Writes pictures to a folder, unless a signal stops the command, and prints their names; `own` is the run
/// in that folder if the pictures are its own.
pub(super) fn write(
    out: &Path,
    files: &PictureFiles,
    own: Option<&Inspection>,
    force: bool,
    signals: &Signals,
) -> Result<(), Failure> {
    if own.is_none() {
        refuse_other_run(out)?;
    }
    if !force {
        refuse_to_replace(out, files, own)?;
    }
    let failed = |error: std::io::Error| {
        Failure::running(format!("cannot write pictures to {}: {error}", out.display()))
    };
    make_folders(out).map_err(failed)?;
    let mut written = String::new();
    for (name, bytes) in files {
        Failure::if_stopped(signals)?;
        let path = out.join(name);
        write_atomic(&path, bytes).map_err(failed)?;
        written += &format!("{}\n", path.display());
    }
    print_message(&written);
    Ok(())
}

/// Refuses a picture name as the output folder for several pictures, unless a folder of this name exists.
pub(super) fn expect_a_folder(out: &Path) -> Result<(), Failure> {
    let is_picture = PictureFormat::ALL
        .iter()
        .any(|format| format.ending() == extension(out));
    if !is_picture || out.is_dir() {
        return Ok(());
    }
    let folder = out.with_extension("");
    Err(Failure::input(format!(
        "--out must be a folder, but {} is the name of a picture: write --out {}",
        out.display(),
        folder.display()
    )))
}

/// Refuses pictures that need too much memory: `bytes` in addition to the program.
pub(in crate::commands) fn expect_memory(bytes: f64) -> Result<(), Failure> {
    let needed = PROGRAM + bytes;
    let available = available_of(needed);
    if needed <= available {
        return Ok(());
    }
    Err(Failure::input(format!(
        "this needs about {} of memory, but {} are available to this process: allow more, in a queue for example with `--mem`",
        byte_size(needed),
        byte_size(available)
    )))
}

pub(in crate::commands) fn expect_results(folder: &Path) -> Result<(), Failure> {
    if folder.is_file() {
        return Err(Failure::input(format!(
            "{} is a file: give the folder of a finished run; a measured record is given with `plot --data`",
            folder.display()
        )));
    }
    let path = folder.join("summary.json");
    let sentence = match path.try_exists() {
        Ok(true) => return Ok(()),
        Ok(false) if has_records(folder) => format!(
            "{} is the folder of a study: give the folder of a run, such as one in its folder runs/",
            folder.display()
        ),
        Ok(false) if !folder.exists() => missing_folder(folder),
        Ok(false) => format!(
            "{} contains no summary.json: give the folder of a finished run",
            folder.display()
        ),
        Err(error) => format!("cannot read {}: {error}", path.display()),
    };
    Err(Failure::input(sentence))
}

/// Error message for a missing folder, with the folder in `results` that was probably meant.
fn missing_folder(folder: &Path) -> String {
    let among_results = Path::new("results").join(folder);
    let meant = if among_results.is_dir() {
        format!(": did you mean {}?", among_results.display())
    } else {
        String::new()
    };
    format!("there is no folder {}{meant}", folder.display())
}

/// Refuses the folder of a run to which these pictures do not belong.
pub(in crate::commands) fn refuse_other_run(out: &Path) -> Result<(), Failure> {
    let manifest = out.join(MANIFEST);
    let sentence = match manifest.try_exists() {
        Ok(false) => return Ok(()),
        Ok(true) => format!(
            "{} contains another run: choose another folder with --out",
            out.display()
        ),
        Err(error) => format!("cannot read {}: {error}", manifest.display()),
    };
    Err(Failure::input(sentence))
}

/// Refuses to replace existing files in the output folder, unless they are equal. If the pictures belong to
/// the run in the folder (`own`), pictures that this run has drawn may also be replaced.
fn refuse_to_replace(out: &Path, files: &PictureFiles, own: Option<&Inspection>) -> Result<(), Failure> {
    for (name, bytes) in files {
        let is_same = |path: &Path| read_limited(path, bytes.len() as u64).is_ok_and(|found| found == *bytes);
        if let Some(sentence) = in_the_way(out, name, own)?
            && !is_same(&out.join(name))
        {
            return Err(Failure::input(sentence));
        }
    }
    Ok(())
}

/// Reason why a new file cannot replace an existing one; none if the run in the folder has drawn the existing
/// file and the new file belongs to that run (`own`).
pub(in crate::commands) fn in_the_way(
    out: &Path,
    name: &str,
    own: Option<&Inspection>,
) -> Result<Option<String>, Failure> {
    let path = out.join(name);
    if path.symlink_metadata().is_err() {
        return Ok(None);
    }
    let is_drawn = own.map(|run| run.has_written(name)).transpose();
    let what = match is_drawn.map_err(Failure::input)? {
        Some(true) => return Ok(None),
        Some(false) => "was changed after the run drew it",
        None => "exists",
    };
    Ok(Some(format!(
        "{} {what}: choose another place with --out, or replace it with --force",
        path.display()
    )))
}
