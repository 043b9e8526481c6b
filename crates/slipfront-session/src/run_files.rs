//! Reads a recorded run from the files of its folder, wherever they are.

use std::path::Path;

use slipfront_base::text::display_path;
use slipfront_run::fields::read_fields;
use slipfront_run::manifest::{Manifest, ManifestFile};
use slipfront_run::names::{CASE, FIELDS, MANIFEST, SERIES, SUMMARY};
use slipfront_run::run_files::RunFile;
use slipfront_run::series;
use slipfront_run::summary::contact_stress_max_of;

use crate::document::Document;
use crate::host::OpenedCase;
use crate::recorded::RecordedRun;
use crate::sentence::sentence;

/// Reads a complete run and gives it a name: its case with the files that the case names, its curve, and its
/// snapshots if the fields are present. `read` returns the contents of a file of the run's folder, or none if
/// there is no such file; errors call the folder `place`. Each file is checked against the manifest, if the
/// folder has one.
///
/// # Errors
/// A sentence, if the folder is not a run, or a file cannot be read or was changed since it was written.
pub fn recorded_run(
    name: &str,
    place: &Path,
    read: impl Fn(&str) -> Result<Option<Vec<u8>>, String>,
) -> Result<OpenedCase, String> {
    let manifest = read(MANIFEST)?
        .map(|bytes| Manifest::of_bytes(&place.join(MANIFEST), &bytes))
        .transpose()
        .map_err(sentence)?;
    let listed = |file: &str| manifest.as_ref()?.files.iter().find(|listed| listed.name == file);
    let written = |file: &str| {
        let contents = read(file)?;
        match (&contents, listed(file)) {
            (Some(contents), Some(listed)) if ManifestFile::of_bytes(file, contents) != *listed => {
                Err(format!(
                    "{} has other bytes than its run has written, so that it would not show what was run: run the case again",
                    display_path(&place.join(file))
                ))
            }
            _ => Ok(contents),
        }
    };
    let needed = |file: &str| {
        let missing = || {
            let place = display_path(place);
            format!("{place} is no folder of a run: it has no {file}")
        };
        written(file)?.ok_or_else(missing)
    };
    let text = String::from_utf8(needed(CASE)?)
        .map_err(|_| format!("{} is no text", display_path(&place.join(CASE))))?;
    let rows = series::read_csv(RunFile::of_bytes(place.join(SERIES), &needed(SERIES)?)).map_err(sentence)?;
    if rows.is_empty() {
        return Err(format!(
            "{} has no rows: it is no curve of a run",
            display_path(&place.join(SERIES))
        ));
    }
    let summary = needed(SUMMARY)?;
    let stress_max =
        contact_stress_max_of(&RunFile::of_bytes(place.join(SUMMARY), &summary)).map_err(sentence)?;
    let input = |file: &str| written(file)?.ok_or_else(|| "there is no such file".to_owned());
    let document = Document::new(name, &text, input).map_err(sentence)?;
    let fields = written(FIELDS)?
        .map(|bytes| read_fields(RunFile::of_bytes(place.join(FIELDS), &bytes)))
        .transpose()
        .map_err(sentence)?;
    let recorded = RecordedRun {
        contact_stress_max_pa: stress_max.unwrap_or(f64::NAN) as f32,
        time_star: rows
            .iter()
            .map(|row| row.drive_time_star.unwrap_or(row.time_star))
            .collect(),
        mu_star: rows.iter().map(|row| row.mu_star).collect(),
        snapshots: fields.filter(|fields| fields.stride == 1 && !fields.frames.is_empty()),
    };
    Ok(OpenedCase {
        document,
        recorded: Some(recorded),
    })
}
