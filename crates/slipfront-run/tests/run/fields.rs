//! Fields files of known values: one of an ordinary lattice, one of a lattice so large that its arrays have
//! more than 2 and 4 GiB, and one that netCDF-C has written; and a kymograph. `tests/fields/run.sh` lets
//! other programs read all but the third.

use std::fs::{self, File};
#[cfg(unix)]
use std::io::Read;
use std::ops::Range;
#[cfg(unix)]
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use slipfront::observe::Field;
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::CaseFile;
use slipfront_run::fields::{
    FieldFrame, FieldsData, FieldsWriter, kymograph_bytes, read_fields, read_kymograph, read_maps, read_rows,
};
use slipfront_run::running;
use tempfile::TempDir;

/// Value that is written for a block: a multiple of an eighth, which every type of the file holds exactly,
/// different for different blocks, arrays and instants. `tests/fields/check.py` has the same formulas.
fn value(array: usize, row: usize, column: usize) -> f64 {
    ((31 * row + 17 * column + 1000 * array) % 4096) as f64 / 8.0
}

fn is_textured(row: usize, column: usize) -> bool {
    (row + column).is_multiple_of(3)
}

/// Time of first slip, with NaN in some places.
fn first_slip(row: usize, column: usize) -> f64 {
    match (row + 2 * column) % 5 {
        0 => f64::NAN,
        _ => value(2, row, column),
    }
}

/// The number of the array of a field at an instant.
fn array(instant: usize, field: usize) -> usize {
    10 * (instant + 1) + field
}

const FIELDS: [Field; 2] = [Field::ContactStress, Field::Traction];

/// A lattice of known values; some of its rows are written.
struct ExpectedFields {
    nx: usize,
    ny: usize,
    /// Ranges of rows, which one process after the other writes.
    written: Vec<Range<usize>>,
}

fn small() -> ExpectedFields {
    ExpectedFields {
        nx: 7,
        ny: 5,
        written: vec![2..5, 0..2],
    }
}

/// A field of floats takes more than 2 GiB, an array of doubles more than 4 GiB, and the number of flags is
/// odd. Rows in the middle and at the end lie beyond both limits; the others are holes.
#[cfg(unix)]
fn large() -> ExpectedFields {
    let (nx, ny) = (30_001, 17_999);
    let blocks = nx * ny;
    assert!(4 * blocks > 1 << 31 && 8 * blocks > 1 << 32 && blocks % 2 == 1);
    ExpectedFields {
        nx,
        ny,
        written: vec![ny - 2..ny, 9_000..9_003, 0..1],
    }
}

impl ExpectedFields {
    fn blocks<T>(&self, rows: &Range<usize>, value: impl Fn(usize, usize) -> T) -> Vec<T> {
        let blocks = rows
            .clone()
            .flat_map(|row| (0..self.nx).map(move |column| (row, column)));
        blocks.map(|(row, column)| value(row, column)).collect()
    }

    fn field(&self, rows: &Range<usize>, instant: usize, field: usize) -> Vec<f32> {
        self.blocks(rows, |row, column| {
            value(array(instant, field), row, column) as f32
        })
    }

    /// Writes the file like processes that each hold a range of rows; the first one creates it.
    fn write(&self, path: &Path) {
        let mut output = File::create(path).unwrap();
        for (process, rows) in self.written.iter().enumerate() {
            let frames: Vec<FieldFrame> = (0..2)
                .map(|instant| FieldFrame {
                    time_star: 1.5 * (instant + 1) as f64,
                    label: ["A", "BC"][instant].to_owned(),
                    step: 15 * (instant as u64 + 1),
                    values: vec![self.field(rows, instant, 0), self.field(rows, instant, 1)],
                })
                .collect();
            let file = FieldsData {
                nx: self.nx,
                ny: self.ny,
                stride: 1,
                first_row: rows.start,
                block_size: 0.25,
                time_unit_s: 0.5,
                names: FIELDS.to_vec(),
                textured: self.blocks(rows, is_textured),
                mu_static: self.blocks(rows, |row, column| value(0, row, column)),
                mu_kinetic: self.blocks(rows, |row, column| value(1, row, column)),
                first_slip_time_star: self.blocks(rows, first_slip),
                frames,
            };
            let writer = FieldsWriter::new(&file);
            if process == 0 {
                writer.create(&mut output).unwrap();
            }
            writer.write_rows(&mut output).unwrap();
        }
    }
}

/// A file in a new folder, or where `SLIPFRONT_FIELDS` says, which is left there for other programs to read.
fn place(name: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let kept = std::env::var_os("SLIPFRONT_FIELDS").map(PathBuf::from);
    let path = kept.unwrap_or(folder.path().to_owned()).join(name);
    (folder, path)
}

#[test]
fn a_small_file_is_read_back() {
    let (_folder, path) = place("small.nc");
    let known = small();
    known.write(&path);
    assert_known(&path, &known, 0..known.ny);
    assert_known(&path, &known, 1..3);
    assert!(fs::read(&path).unwrap().starts_with(b"CDF\x02"));
}

/// A kymograph is read back, of a run of 30 x 4 blocks in which none slides at first and each does at some
/// time. The bins are columns of blocks, of which one has no contact.
#[test]
fn a_kymograph_is_read_back() {
    let (_folder, path) = place("kymograph.nc");
    let text = "slider = { blocks = [30, 4], block_size = '0.5 um' }\ntime.duration_star = 80\ndrive.v_star = 0.1\n\
                [[texture]]\nshape = 'groove'\nwidth = '0.5 um'\noffset = '-3.75 um'";
    let file = CaseFile::parse(text, "case", &[]).unwrap();
    let case = Arc::new(Case::new(file, "case", Path::new(""), &mut |_| true, Ranks::ALONE).unwrap());
    let record = running::run(&case, 1).unwrap();
    fs::write(&path, kymograph_bytes(&record.kymograph, &case)).unwrap();
    let data = read_kymograph(&path).unwrap();
    assert_eq!((data.columns(), data.places), (30, [0.0, 30.0 * 0.5e-6]));
    let rows: Vec<&[f32]> = data.sliding_share.chunks(30).collect();
    for bin in 0..30 {
        let mut shares = rows.iter().map(|row| row[bin]);
        match bin {
            7 => assert!(shares.all(f32::is_nan)),
            _ => assert!(rows[0][bin] == 0.0 && shares.any(|share| share == 1.0), "{bin}"),
        }
    }
}

/// Reads rows of a file and compares all that was read with the values that were written.
fn assert_known(path: &Path, known: &ExpectedFields, rows: Range<usize>) {
    let data = read_rows(path, rows.clone()).unwrap();
    assert_eq!((data.nx, data.ny, data.stride), (known.nx, known.ny, 1));
    assert_eq!((data.block_size, data.time_unit_s), (0.25, 0.5));
    assert_eq!(data.names, FIELDS);
    assert!(data.textured == known.blocks(&rows, is_textured));
    assert!(data.mu_static == known.blocks(&rows, |row, column| value(0, row, column)));
    assert!(data.mu_kinetic == known.blocks(&rows, |row, column| value(1, row, column)));
    // As text, where NaN equals NaN.
    let first_slip = known.blocks(&rows, first_slip);
    assert!(format!("{:?}", data.first_slip_time_star) == format!("{first_slip:?}"));
    assert_eq!(data.frames.len(), 2);
    for (instant, frame) in data.frames.iter().enumerate() {
        assert_eq!(frame.time_star, 1.5 * (instant + 1) as f64);
        assert_eq!(
            (frame.label.as_str(), frame.step),
            [("A", 15), ("BC", 30)][instant]
        );
        for (field, values) in frame.values.iter().enumerate() {
            assert!(*values == known.field(&rows, instant, field));
        }
    }
}

/// The small file as netCDF-C writes it with 64-bit data (`tests/fields/check.py`): the reader reads it, and
/// never takes a part of it for the whole.
#[test]
fn files_with_64_bit_data_of_another_program_are_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fields/netcdf-c-64-bit-data.nc");
    assert_known(&path, &small(), 0..small().ny);
    let maps = read_maps::<Vec<f32>>(&path, Field::Traction, |_| vec![0, 1]).unwrap();
    for (instant, frame) in maps.frames.iter().enumerate() {
        assert_eq!(frame.values, [small().field(&(0..small().ny), instant, 1)]);
    }
    assert_eq!(maps.frames.len(), 2);
    let whole = fs::read(&path).unwrap();
    assert!(whole.starts_with(b"CDF\x05"));
    let folder = tempfile::tempdir().unwrap();
    for length in 0..whole.len() {
        // A new name each time: some file systems wait for the disk when a file is replaced.
        let path = folder.path().join(format!("{length}.nc"));
        fs::write(&path, &whole[..length]).unwrap();
        assert!(read_fields(&path).is_err(), "cut after {length} bytes");
    }
}

// On other systems, a file has holes only on request.
#[cfg(unix)]
#[test]
fn a_file_of_more_than_4_gib_is_read_back() {
    let (_folder, path) = place("large.nc");
    let known = large();
    known.write(&path);
    let mut begin = [0; 4];
    File::open(&path).unwrap().read_exact(&mut begin).unwrap();
    assert_eq!(&begin, b"CDF\x05");
    let length = fs::metadata(&path).unwrap().len();
    // Flags, three arrays of doubles, two instants of two fields.
    assert!(length > (known.nx * known.ny * (2 + 3 * 8 + 2 * 2 * 4)) as u64);
    let on_disk = 512 * fs::metadata(&path).unwrap().blocks();
    let folder = path.parent().unwrap().display();
    assert!(
        on_disk < 1 << 28,
        "the file takes {on_disk} bytes: {folder} has no sparse files"
    );
    for rows in &known.written {
        assert_known(&path, &known, rows.clone());
    }
    // A row that no process wrote.
    let hole = read_rows(&path, 1..2).unwrap();
    assert_eq!(hole.mu_kinetic, vec![0.0; known.nx]);
}
