//! Writes the files of a run from its [`RunData`].

use std::io::{self, Cursor};
use std::path::Path;

use slipfront::communicator::{Alone, Communicator};
use slipfront::observe::Frame;
use slipfront::observe::frames::kept;
use slipfront_base::disk;
use slipfront_case::case::Case;
use tempfile::TempPath;

use crate::error::ResultsError;
use crate::fields::{self, FieldFrame, FieldsData, FieldsWriter, thin};
use crate::final_state;
use crate::folder_error::FolderError;
use crate::names::{CASE, FIELDS, KYMOGRAPH, SERIES, STATE, SUMMARY};
use crate::run_folder::RunFolder;
use crate::run_folder::unfinished::Unfinished;
use crate::running::RunData;
use crate::series::{self, SeriesRow};
use crate::shared_file::write_shared;

/// Writes the results of a run on one rank to its folder, which already contains the case: the tables, then
/// the numbers of blocks, which are moved out of the data. Pictures and the manifest follow.
pub fn write(case: &Case, data: &mut RunData, folder: &mut RunFolder) -> Result<(), ResultsError> {
    write_tables(case, data, folder)?;
    for (name, file) in write_blocks(case, data, folder.path(), &Alone)? {
        folder.place(name, file)?;
    }
    Ok(())
}

/// Writes the files with numbers of every block to temporary files of the run in folder `out`, with each rank
/// writing its own rows: the fields, and the last state if the case requests it. Both are moved out of the
/// data. Only the first rank returns the files, each with its final name.
pub fn write_blocks(
    case: &Case,
    data: &mut RunData,
    out: &Path,
    communicator: &dyn Communicator,
) -> Result<Vec<(&'static str, TempPath)>, ResultsError> {
    let temporary = Unfinished::in_folder(out).temporary();
    let frames = std::mem::take(&mut data.frames);
    let fields = fields_of(case, data, frames);
    let file = fields::write_fields(&temporary, &out.join(FIELDS), &fields, communicator)?;
    drop(fields);
    let mut files = Vec::from_iter(file.map(|file| (FIELDS, file)));
    if let Some(state) = data.final_state.take() {
        let file = write_shared(
            &temporary,
            communicator,
            |output| final_state::create(case, output),
            |output| final_state::write_rows(case, &state, output),
        );
        let file = file.map_err(FolderError::write(&out.join(STATE)))?;
        files.extend(file.map(|file| (STATE, file)));
    }
    Ok(files)
}

/// Writes summary, series, kymograph and events, the first results of a run, on one of its ranks.
pub fn write_tables(case: &Case, data: &RunData, folder: &mut RunFolder) -> Result<(), ResultsError> {
    each_table(case, data, |name, contents| Ok(folder.write(name, contents)?))
}

/// Passes the first results of a run to `take`, each with its name.
fn each_table(
    case: &Case,
    data: &RunData,
    mut take: impl FnMut(&str, &[u8]) -> Result<(), ResultsError>,
) -> Result<(), ResultsError> {
    take(SUMMARY, &disk::json(&data.summary))?;
    let rows = data
        .rows
        .iter()
        .map(|row| SeriesRow::new(row, &case.scales, &data.model));
    take(SERIES, &series::to_csv(rows)?)?;
    take(KYMOGRAPH, &fields::kymograph_bytes(&data.kymograph, case))?;
    for (table, contents) in data.observers.tables(&case.scales)? {
        take(table.file, &contents)?;
    }
    Ok(())
}

/// The files of a run on one rank, by their names in its folder, with the bytes that they have there: the
/// case and the files that it reads, tables and fields, which are moved out of the data.
///
/// # Errors
/// When a file that the case reads has changed since the case was made.
pub fn in_memory(case: &Case, data: &mut RunData) -> Result<Vec<(String, Vec<u8>)>, ResultsError> {
    let mut files = vec![(CASE.to_owned(), case.file.to_toml()?.into_bytes())];
    for input in &case.inputs {
        files.push((input.name.clone(), input.read_again()?.to_vec()));
    }
    each_table(case, data, |name, contents| {
        files.push((name.to_owned(), contents.to_vec()));
        Ok(())
    })?;
    let frames = std::mem::take(&mut data.frames);
    let fields = fields_of(case, data, frames);
    let writer = FieldsWriter::new(&fields);
    files.push(filled(FIELDS, |bytes| {
        writer.create(&mut *bytes)?;
        writer.write_rows(bytes)
    })?);
    if let Some(state) = data.final_state.take() {
        files.push(filled(STATE, |bytes| {
            final_state::create(case, bytes)?;
            final_state::write_rows(case, &state, bytes)
        })?);
    }
    Ok(files)
}

/// A file in memory, filled by `fill`.
fn filled(
    name: &str,
    fill: impl FnOnce(&mut Cursor<Vec<u8>>) -> io::Result<()>,
) -> Result<(String, Vec<u8>), FolderError> {
    let mut bytes = Cursor::new(Vec::new());
    fill(&mut bytes).map_err(FolderError::write(Path::new(name)))?;
    Ok((name.to_owned(), bytes.into_inner()))
}

/// Writes the case and copies of the files that it reads: enough to run it again.
pub fn write_case(case: &Case, folder: &mut RunFolder) -> Result<(), ResultsError> {
    folder.write(CASE, case.file.to_toml()?.as_bytes())?;
    for input in &case.inputs {
        folder.copy(input)?;
    }
    Ok(folder.sync()?)
}

/// The content of the [fields file](write_blocks) of a run with these frames, in the rows that this rank
/// holds.
pub fn fields_of(case: &Case, data: &RunData, frames: Vec<(String, Frame)>) -> FieldsData {
    let (lattice, surface, output) = (&case.model.lattice, &case.model.surface, &case.output);
    let scale = data.contact_stress_max;
    let frame = |(label, frame)| FieldFrame::in_si_units(frame, label, &output.fields, &case.scales, scale);
    FieldsData {
        nx: lattice.nx,
        ny: lattice.ny,
        stride: output.stride,
        first_row: kept(case.model.rows.clone(), output.stride).start,
        block_size: case.scales.block_size,
        time_unit_s: case.scales.time(),
        names: output.fields.clone(),
        textured: thinned(case, &surface.textured, false),
        mu_static: thinned(case, &surface.mu_static, f64::NAN),
        mu_kinetic: thinned(case, &surface.mu_kinetic, f64::NAN),
        first_slip_time_star: thinned(case, &data.first_slip_time_star, f64::NAN),
        frames: frames.into_iter().map(frame).collect(),
    }
}

/// The values of blocks that a fields file keeps, with `outside` for blocks that do not exist.
fn thinned<T: Copy>(case: &Case, values: &[T], outside: T) -> Vec<T> {
    let (model, stride) = (&case.model, case.output.stride);
    let nx = model.lattice.nx;
    // Values of the rows before the first one that is kept.
    let skipped = (kept(model.rows.clone(), stride).start * stride - model.rows.start) * nx;
    let values = thin(values.get(skipped..).unwrap_or_default(), nx, stride);
    let Some(outline) = &model.slider().outline else {
        return values.collect();
    };
    let exists = thin(outline.exists.get(skipped..).unwrap_or_default(), nx, stride);
    let values = values.zip(exists);
    values
        .map(|(value, exists)| if exists { value } else { outside })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use slipfront::testing::Threads;
    use slipfront::{Execution, VectorField};
    use slipfront_case::case::{Files, FilesInMemory, Ranks};
    use slipfront_case::case_file::CaseFile;

    use super::*;
    use crate::running::{Running, run};

    /// A disc that slides with parts of it at rest, and leaves its last state.
    const ENDED: &str = "slider = { blocks = [20, 20], outline = 'disc' }\ntexture = [{ shape = 'cavity', coverage = 10 }]\n\
                         time.duration_star = 70\noutput.final_state = true\noutput.snapshots = []";

    /// The bytes of the last state of a case.
    fn last_state(case: &Arc<Case>) -> Vec<u8> {
        let files = in_memory(case, &mut run(case, 1).unwrap()).unwrap();
        files.into_iter().find(|(name, _)| name == STATE).unwrap().1
    }

    /// While nothing slips, friction is proportional to the path of the drive, though its increments are
    /// first large and then small.
    #[test]
    fn the_series_of_a_bulk_body_has_the_path_of_its_increments() {
        let text = "slider = { blocks = [8, 8], body = 'bulk' }\n\
                    friction = { sigma_static_star = 0, sigma_kinetic_star = 0, slip_weakening.length_star = 4 }\n\
                    time.stop = 'after_onset'";
        let case = Arc::new(Case::parse(text, "body", "", &[]).unwrap());
        let mut data = run(&case, 1).unwrap();
        let (first_slip, pull) = (
            data.summary.first_slip_time_star.unwrap(),
            case.model.drive.k_drive,
        );
        let files = in_memory(&case, &mut data).unwrap();
        let (_, series) = files.into_iter().find(|(name, _)| name == SERIES).unwrap();
        let mut reader = csv::Reader::from_reader(&series[..]);
        let rows: Vec<SeriesRow> = reader.deserialize().map(Result::unwrap).collect();
        let path = |row: &SeriesRow| row.drive_displacement_m.unwrap() / case.scales.displacement();
        let time = |row: &SeriesRow| row.drive_time_star.unwrap();
        let elastic: Vec<&SeriesRow> = rows.iter().filter(|row| time(row) < first_slip).collect();
        for row in &elastic {
            // Rounding of units.
            assert!((pull * path(row) - row.mu_star).abs() < 1e-12, "{row:?}");
        }
        let [first, last] = [elastic[1], elastic[elastic.len() - 1]].map(|row| path(row) / time(row));
        assert!(elastic.len() > 5 && last < 0.9 * first, "{first} {last}");
    }

    fn began_in(state: Vec<u8>, overrides: &[&str]) -> Arc<Case> {
        let in_memory = FilesInMemory::from([(STATE.to_owned(), state.into())]);
        let files = Files {
            folder: Path::new(""),
            in_memory: Some(&in_memory),
        };
        let overrides: Vec<String> = overrides.iter().map(|&set| set.to_owned()).collect();
        let text = ENDED.replace("output.final_state = true", "initial.state_file = 'state.npy'");
        let file = CaseFile::parse(&text, "case", &overrides).unwrap();
        Arc::new(Case::to_run(file, "case", files, &mut |_| true, Ranks::ALONE).unwrap())
    }

    /// Displacements since rest, m, of a run that was begun when the driven ends had moved by `path` along x.
    fn in_metres(running: &Running, path: f64) -> Vec<f64> {
        let unit = running.case().scales.displacement();
        let VectorField { x, y } = running.motion().displacement;
        let slider = running.case().model.slider();
        let x = x
            .iter()
            .enumerate()
            .map(|(b, x)| if slider.exists(b) { x * unit + path } else { 0.0 });
        x.chain(y.into_iter().map(|y| y * unit)).collect()
    }

    /// A case that begins in the last state of a run continues as the run would have.
    #[test]
    fn a_case_goes_on_where_a_run_has_ended() {
        let case = Arc::new(Case::parse(ENDED, "case", "", &[]).unwrap());
        let steps = case.time_plan.last_step + 1;
        let long = ["time.duration_star = 200".to_owned()];
        let long = Arc::new(Case::parse(ENDED, "case", "", &long).unwrap());
        let mut plain = Running::start(&long, None, Execution::default());
        plain.advance(steps).unwrap();
        let begun = began_in(last_state(&case), &["time.duration_star = 200"]);
        let mut begun = Running::start(&begun, None, Execution::default());
        let mu_star = [&plain, &begun].map(|running| running.snapshot().point.mu_star);
        // Rounding of displacements relative to the drive, and of units.
        assert!((mu_star[1] / mu_star[0] - 1.0).abs() < 1e-13, "{mu_star:?}");
        let sliding = plain.snapshot().totals.n_slipping;
        assert!(
            sliding > 0 && sliding == begun.snapshot().totals.n_slipping,
            "{sliding}"
        );
        let path = plain.snapshot().model.drive.path(plain.snapshot().time_star) * case.scales.displacement();
        for running in [&mut plain, &mut begun] {
            running.advance(200).unwrap();
        }
        let (one, other) = (in_metres(&plain, 0.0), in_metres(&begun, path));
        let largest = one.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        let apart = one
            .iter()
            .zip(&other)
            .map(|(one, other)| (one - other).abs())
            .fold(0.0, f64::max);
        // One rounding per step, which springs pass on.
        assert!(apart < 1e-12 * largest, "{apart:e} {largest:e}");
    }

    /// Under twice the load, the same metres and metres per second are half as many units; mu* is also
    /// halved.
    #[test]
    fn metres_are_kept_under_another_load() {
        let case = Arc::new(Case::parse(ENDED, "case", "", &[]).unwrap());
        let state = last_state(&case);
        let [one, other] = [&[][..], &["load.pressure = '200 kPa'"]].map(|set| began_in(state.clone(), set));
        let [one, other] = [one, other].map(|case| case.state().unwrap());
        for (one, other) in [
            (&one.displacement.x, &other.displacement.x),
            (&one.velocity.y, &other.velocity.y),
        ] {
            assert!(one.iter().any(|&value| value != 0.0));
            let is_half = |(one, other): (&f64, &f64)| (0.5 * one - other).abs() <= f64::EPSILON * one.abs();
            assert!(one.iter().zip(other).all(is_half));
        }
    }

    #[test]
    fn ranks_write_the_last_state_of_one() {
        let expected = last_state(&Arc::new(Case::parse(ENDED, "case", "", &[]).unwrap()));
        for size in [2, 3, 7] {
            let folder = tempfile::tempdir().unwrap();
            Unfinished::in_folder(folder.path()).create().unwrap();
            let files = Threads::run(size, |communicator| {
                let ranks = Ranks {
                    communicator,
                    on_node: size,
                };
                let file = CaseFile::parse(ENDED, "case", &[]).unwrap();
                let case = Case::to_run(file, "case", Path::new(""), &mut |_| true, ranks).unwrap();
                let case = Arc::new(case);
                let execution = Execution {
                    communicator: Arc::new(communicator.clone()),
                    ..Execution::default()
                };
                let mut running = Running::start(&case, None, execution);
                let reason = loop {
                    if let Some(reason) = running.advance(u64::MAX).unwrap() {
                        break reason;
                    }
                };
                let mut data = running.record(reason);
                let files = write_blocks(&case, &mut data, folder.path(), communicator).unwrap();
                let state = files.into_iter().find(|(name, _)| *name == STATE);
                state.map(|(_, file)| std::fs::read(file).unwrap())
            });
            assert!(files[0].as_ref() == Some(&expected), "{size} ranks");
            assert!(files[1..].iter().all(Option::is_none));
        }
    }

    /// Blocks outside an outline have no values, and do not count as texture.
    #[test]
    fn blocks_outside_an_outline_have_no_values() {
        let folder = tempfile::tempdir().unwrap();
        let text = "slider.blocks = [6, 6]\nslider.outline = 'disc'\ntime.duration_star = 5\noutput.snapshots = [5]\n\
                    [[texture]]\nshape = 'cavity'\ncoverage = 12.5";
        let case = Case::parse(text, "case", "", &[]).unwrap();
        let case = Arc::new(case);
        let mut data = run(&case, 1).unwrap();
        let in_memory = fields_of(&case, &data, data.frames.clone());
        let out = folder.path().join("out");
        let mut folder = RunFolder::prepare(&out, false, &case.inputs).unwrap();
        write_case(&case, &mut folder).unwrap();
        write(&case, &mut data, &mut folder).unwrap();
        let fields = fields::read_fields(out.join(FIELDS)).unwrap();
        // Compared as text, in which NaN equals NaN.
        assert_eq!(format!("{in_memory:?}"), format!("{fields:?}"));
        let slider = case.model.slider();
        let outside: Vec<usize> = (0..36).filter(|&b| !slider.exists(b)).collect();
        assert_eq!(outside.len(), 36 - 32);
        let middle = [14, 15, 20, 21];
        for b in 0..36 {
            let is_outside = outside.contains(&b);
            assert_eq!(fields.textured[b], middle.contains(&b), "block {b}");
            assert_eq!(fields.mu_static[b].is_nan(), is_outside);
            assert_eq!(fields.mu_kinetic[b].is_nan(), is_outside);
            for (field, values) in fields.names.iter().zip(&fields.frames[0].values) {
                let is_blank =
                    is_outside || (*field == slipfront::observe::Field::Traction && middle.contains(&b));
                assert_eq!(values[b].is_nan(), is_blank, "{field:?} of block {b}");
            }
        }
        assert_eq!((data.summary.n_blocks, data.summary.texture_percent), (32, 12.5));
    }

    /// A copy holds the contents from which the case was made, or there is none.
    #[test]
    fn a_file_that_has_changed_since_is_not_copied() {
        let folder = tempfile::tempdir().unwrap();
        let table = folder.path().join("mu.csv");
        std::fs::write(&table, "1,1\n1,1\n").unwrap();
        let text = "slider.blocks = [2, 2]\nfriction.mu_static_field = 'mu.csv'";
        let file = CaseFile::parse(text, "case", &[]).unwrap();
        let case = Case::new(file, "case", folder.path(), &mut |_| true, Ranks::ALONE).unwrap();
        let write = |name: &str| {
            let out = folder.path().join(name);
            let mut run = RunFolder::prepare(&out, false, &case.inputs).unwrap();
            (write_case(&case, &mut run), out.join("inputs/mu.csv"))
        };
        let (written, copy) = write("one");
        written.unwrap();
        assert_eq!(std::fs::read(copy).unwrap(), std::fs::read(&table).unwrap());
        std::fs::write(&table, "1,1\n1,2\n").unwrap();
        let (written, copy) = write("other");
        let said = written.unwrap_err().to_string();
        assert!(
            said.contains("mu.csv was changed after the case was prepared"),
            "{said}"
        );
        assert!(!copy.exists());
    }
}
