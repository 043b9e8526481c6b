//! Tests of `fields.nc`: files are read as they were written, and damaged ones are refused.

use std::fs;
use std::io::{Cursor, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use slipfront::observe::Field;
use slipfront::observe::frames::kept;

use slipfront::communicator::Alone;

use super::*;
use slipfront_case::field_info::{field_info, field_named};

/// Writes a file through a temporary one next to it.
fn write(path: &Path, file: &FieldsData) -> Result<(), FieldsError> {
    let written = write_fields(path.parent().unwrap(), path, file, &Alone)?.unwrap();
    written.persist(path).map_err(|error| FieldsError::Write {
        path: path.to_owned(),
        source: error.error,
    })
}

const NX: usize = 5;
const NY: usize = 3;

/// The arrays of a lattice of 5 x 3 blocks that differs from its mirror images.
struct Lattice {
    textured: Vec<bool>,
    mu_static: Vec<f64>,
    mu_kinetic: Vec<f64>,
    first_slip: Vec<f64>,
}

fn lattice() -> Lattice {
    let blocks = 0..NX * NY;
    let textured = |block: usize| block == 1 || block == 7;
    Lattice {
        textured: blocks.clone().map(textured).collect(),
        mu_static: blocks
            .clone()
            .map(|block| {
                if textured(block) {
                    0.0
                } else {
                    1.0 + 0.1 * block as f64
                }
            })
            .collect(),
        mu_kinetic: blocks.clone().map(|block| 0.5 + 0.01 * block as f64).collect(),
        first_slip: blocks
            .map(|block| {
                if block % 4 == 0 {
                    -f64::NAN
                } else {
                    80.0 + block as f64 / 3.0
                }
            })
            .collect(),
    }
}

impl Lattice {
    fn file(&self, stride: usize, names: &[Field], frames: &[FieldFrame]) -> FieldsData {
        let thinned = |values: &[f64]| thin(values, NX, stride).collect();
        FieldsData {
            nx: NX,
            ny: NY,
            stride,
            first_row: 0,
            block_size: 1e-6,
            time_unit_s: 3.162e-10,
            names: names.to_vec(),
            textured: thin(&self.textured, NX, stride).collect(),
            mu_static: thinned(&self.mu_static),
            mu_kinetic: thinned(&self.mu_kinetic),
            first_slip_time_star: thinned(&self.first_slip),
            frames: frames.to_vec(),
        }
    }
}

fn frames(names: &[Field], stride: usize) -> Vec<FieldFrame> {
    let labels = ["A", "", "CD"];
    let field = |seed: usize| {
        (0..NX * NY)
            .map(|block| (seed * 100 + block) as f32 / 7.0)
            .collect::<Vec<f32>>()
    };
    (0..3)
        .map(|frame| FieldFrame {
            time_star: 16.7 * (frame + 1) as f64,
            label: labels[frame].to_owned(),
            step: 167 * (frame as u64 + 1),
            values: (0..names.len())
                .map(|name| thin(&field(10 * frame + name), NX, stride).collect())
                .collect(),
        })
        .collect()
}

fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.nc");
    (folder, path)
}

/// Compares numbers; NaN equals NaN.
fn same(left: &[f64], right: &[f64]) -> bool {
    left.len() == right.len()
        && left
            .iter()
            .zip(right)
            .all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
}

#[test]
fn names_are_those_of_the_case_file() {
    for name in Field::ALL {
        assert_eq!(
            serde_json::to_string(&name).unwrap(),
            format!("\"{}\"", field_info(name).name)
        );
        assert_eq!(field_named(field_info(name).name), Some(name));
        assert!(!field_info(name).long_name.is_empty() && !field_info(name).unit.is_empty());
    }
    assert_eq!(field_named("contact_stress"), None);
}

#[test]
fn what_is_written_is_read() {
    let lattice = lattice();
    for stride in [1, 2, 3, 9] {
        let frames = frames(&Field::ALL, stride);
        let file = lattice.file(stride, &Field::ALL, &frames);
        let (_folder, path) = folder();
        write(&path, &file).unwrap();
        let data = read_fields(&path).unwrap();
        assert_eq!((data.nx, data.ny, data.stride), (NX, NY, stride));
        assert_eq!((data.block_size, data.time_unit_s), (1e-6, 3.162e-10));
        assert_eq!(data.columns() * data.rows(), data.mu_static.len());
        assert_eq!(data.names, Field::ALL);
        assert!(thin(&lattice.textured, NX, stride).eq(data.textured));
        assert!(thin(&lattice.mu_static, NX, stride).eq(data.mu_static));
        assert!(thin(&lattice.mu_kinetic, NX, stride).eq(data.mu_kinetic));
        let first_slip: Vec<f64> = thin(&lattice.first_slip, NX, stride).collect();
        assert!(same(&data.first_slip_time_star, &first_slip));
        assert_eq!(data.frames, frames);
    }
}

#[test]
fn maps_are_one_field_at_a_few_instants() {
    let lattice = lattice();
    let (_folder, path) = folder();
    let names = [Field::Sliding, Field::Traction];
    let frames = frames(&names, 1);
    write(&path, &lattice.file(1, &names, &frames)).unwrap();
    for (most, instants) in [
        (1, vec![0]),
        (2, vec![0, 2]),
        (3, vec![0, 1, 2]),
        (9, vec![0, 1, 2]),
    ] {
        let maps =
            read_maps::<Vec<f32>>(&path, Field::Traction, |labels| choose_snapshots(labels, most)).unwrap();
        assert_eq!(maps.names, [Field::Traction]);
        assert_eq!(maps.textured, lattice.textured);
        let wanted = instants
            .iter()
            .map(|&instant| (frames[instant].step, &frames[instant].values[1]));
        let found = maps.frames.iter().map(|frame| (frame.step, &frame.values[0]));
        assert!(found.eq(wanted), "{most}");
    }
    let maps = read_maps::<Vec<f32>>(&path, Field::VelocityX, |labels| choose_snapshots(labels, 6)).unwrap();
    assert!(maps.names.is_empty());
}

#[test]
fn of_many_snapshots_those_with_letters_are_shown() {
    let labels = ["", "A", "", "B, C", "", ""].map(str::to_owned);
    assert_eq!(choose_snapshots(&labels, 6), [0, 1, 2, 3, 4, 5]);
    assert_eq!(choose_snapshots(&labels, 3), [1, 3]);
    assert_eq!(choose_snapshots(&labels, 1), [0]);
    assert_eq!(choose_snapshots(&labels[4..], 1), [0]);
    assert_eq!(choose_snapshots(&[], 6), [0; 0]);
}

#[test]
fn thinning_starts_at_block_0() {
    let blocks: Vec<usize> = (0..15).collect();
    assert!(thin(&blocks, 5, 1).eq(0..15));
    assert!(thin(&blocks, 5, 2).eq([0, 2, 4, 10, 12, 14]));
    assert!(thin(&blocks, 5, 3).eq([0, 3]));
    assert!(thin(&blocks, 5, 100).eq([0]));
    assert_eq!(thin::<f64>(&[], 0, 0).count(), 0);
}

#[test]
fn a_run_without_instants_or_fields_still_has_its_surface() {
    let lattice = lattice();
    let (_folder, path) = folder();
    write(&path, &lattice.file(1, &Field::ALL, &[])).unwrap();
    let data = read_fields(&path).unwrap();
    assert!(data.frames.is_empty() && data.names.is_empty());
    assert_eq!(data.mu_static, lattice.mu_static);

    let frames = frames(&[], 1);
    write(&path, &lattice.file(1, &[], &frames)).unwrap();
    assert_eq!(read_fields(&path).unwrap().frames, frames);
}

#[test]
fn equal_input_gives_equal_bytes() {
    let lattice = lattice();
    let mut frames = frames(&[Field::Traction], 1);
    let (_folder, path) = folder();
    let mut bytes_with = |nan: f32| {
        frames[1].values[0][7] = nan;
        write(&path, &lattice.file(1, &[Field::Traction], &frames)).unwrap();
        fs::read(&path).unwrap()
    };
    let first = bytes_with(f32::NAN);
    assert_eq!(first, bytes_with(f32::NAN));
    assert_eq!(
        first,
        bytes_with(f32::from_bits(0xffc0_1234)),
        "one NaN is like another"
    );
    assert_ne!(first, bytes_with(0.0));
}

/// The header begins as the format document says.
#[test]
fn the_header_is_netcdf_3() {
    let lattice = lattice();
    let (_folder, path) = folder();
    write(&path, &lattice.file(1, &Field::ALL, &frames(&Field::ALL, 1))).unwrap();
    let bytes = fs::read(&path).unwrap();
    let dimensions =
        b"CDF\x02\0\0\0\x03\0\0\0\x0a\0\0\0\x04\0\0\0\x01y\0\0\0\0\0\0\x03\0\0\0\x01x\0\0\0\0\0\0\x05\0\0\0\x04time\0\0\0\0";
    assert_eq!(&bytes[..dimensions.len()], dimensions);
    assert_eq!(bytes.len() % 4, 0);
}

#[test]
#[should_panic(expected = "other lengths")]
fn arrays_of_another_length_are_refused() {
    let mut file = lattice().file(1, &[Field::Traction], &frames(&[Field::Traction], 1));
    file.mu_kinetic.pop();
    FieldsWriter::new(&file);
}

/// An output that is full after some bytes, or that fails when it is flushed.
struct Full {
    output: Cursor<Vec<u8>>,
    room: u64,
    flushes: bool,
}

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.output.position() + bytes.len() as u64 > self.room {
            return Err(std::io::Error::other("no space left"));
        }
        self.output.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        if self.flushes {
            Ok(())
        } else {
            Err(std::io::Error::other("no flush"))
        }
    }
}

impl Seek for Full {
    fn seek(&mut self, position: SeekFrom) -> std::io::Result<u64> {
        self.output.seek(position)
    }
}

#[test]
fn a_full_disk_is_reported_wherever_it_happens() {
    let lattice = lattice();
    let frames = frames(&Field::ALL, 1);
    let file = lattice.file(1, &Field::ALL, &frames);
    let writer = FieldsWriter::new(&file);
    let write_to = |room: u64, flushes: bool| {
        let output = Cursor::new(Vec::new());
        let mut full = Full {
            output,
            room,
            flushes,
        };
        writer.create(&mut full)?;
        writer.write_rows(&mut full)?;
        Ok(full.output.into_inner())
    };
    let whole = write_to(u64::MAX, true).unwrap();
    for room in 0..whole.len() as u64 {
        let error: std::io::Error = write_to(room, true).unwrap_err();
        assert_eq!(error.to_string(), "no space left", "with room for {room} bytes");
    }
    let room = whole.len() as u64;
    assert_eq!(write_to(room, true).unwrap(), whole);
    assert_eq!(write_to(room, false).unwrap_err().to_string(), "no flush");
}

#[test]
fn folders_that_take_no_file_are_reported() {
    let lattice = lattice();
    let (folder, _) = folder();
    let nowhere = folder.path().join("missing").join("fields.nc");
    let text = write(&nowhere, &lattice.file(1, &[], &[]))
        .unwrap_err()
        .to_string();
    assert!(
        text.contains("missing/fields.nc`: ") && text.contains("check that the folder exists"),
        "{text}"
    );

    let occupied = folder.path().join("occupied");
    fs::create_dir(&occupied).unwrap();
    fs::write(occupied.join("file"), "").unwrap();
    assert!(matches!(
        write(&occupied, &lattice.file(1, &[], &[])),
        Err(FieldsError::Write { .. })
    ));
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        1,
        "no temporary file is left"
    );
}

#[cfg(unix)]
#[test]
fn the_file_is_as_readable_as_any_other_and_replaces_one_that_is_there() {
    use std::os::unix::fs::PermissionsExt;
    let lattice = lattice();
    let (folder, path) = folder();
    fs::write(&path, "before").unwrap();
    let other = folder.path().join("other");
    fs::write(&other, "").unwrap();
    write(&path, &lattice.file(1, &[], &[])).unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&other));
    assert!(read_fields(&path).is_ok());
}

/// Replaces a file by removing it first: some file systems wait for the disk when a file is truncated.
fn replace(path: &Path, bytes: &[u8]) {
    let _ = fs::remove_file(path);
    fs::write(path, bytes).unwrap();
}

#[test]
fn files_of_another_kind_are_refused() {
    let lattice = lattice();
    let (folder, path) = folder();
    let message = |path: &PathBuf| read_fields(path).unwrap_err().to_string();
    assert!(message(&path).starts_with("cannot read `"));
    assert!(message(&folder.path().to_owned()).contains("is not a regular file"));

    fs::write(&path, b"\x89HDF\r\n\x1a\n and so on").unwrap();
    assert!(message(&path).contains("does not begin like NetCDF-3"));
    fs::write(
        &path,
        b"CDF\x02\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
    )
    .unwrap();
    assert!(
        message(&path).contains("it has no attribute `blocks`"),
        "{}",
        message(&path)
    );

    write(&path, &lattice.file(1, &Field::ALL, &frames(&Field::ALL, 1))).unwrap();
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        replace(&path, &whole[..length]);
        assert!(
            matches!(read_fields(&path), Err(FieldsError::Broken { .. })),
            "cut after {length} bytes"
        );
    }
}

/// If the record dimension has a fixed length, there are no records, and no variable needs bytes for them.
/// Without a check against the file, only the number in the header would decide how many frames are created.
#[test]
fn instants_that_the_file_does_not_hold_are_refused() {
    let lattice = lattice();
    let (_folder, path) = folder();
    let names = [Field::Traction];
    write(&path, &lattice.file(1, &names, &frames(&names, 1))).unwrap();
    let whole = fs::read(&path).unwrap();
    let time = whole
        .windows(8)
        .position(|bytes| bytes == b"\0\0\0\x04time")
        .unwrap();
    for (dimension, instants) in [(0u32, u32::MAX - 1), (0, 1000), (1, u32::MAX - 1), (1, 1)] {
        let mut bytes = whole.clone();
        bytes[4..8].copy_from_slice(&instants.to_be_bytes());
        bytes[time + 8..time + 12].copy_from_slice(&dimension.to_be_bytes());
        replace(&path, &bytes);
        let said = read_fields(&path).unwrap_err().to_string();
        assert!(said.contains(&format!("promises {instants} instants")), "{said}");
    }
}

/// Inserts `more` at the byte `behind`, and adds 1 to the count at the end of the first `tag`.
fn with_one_more(bytes: &[u8], tag: &[u8; 8], more: &[u8], behind: usize) -> Vec<u8> {
    let at = bytes.windows(8).position(|bytes| bytes == tag).unwrap();
    let mut bytes = bytes.to_vec();
    bytes[at + 7] += 1;
    bytes.splice(behind..behind, more.iter().copied());
    bytes
}

/// Without records, the whole of each array would be read for every instant that the header promises, which
/// takes memory in proportion to the square of the file's length.
#[test]
fn instants_that_are_no_records_are_refused() {
    let lattice = lattice();
    let (_folder, path) = folder();
    let names = [Field::Traction];
    write(&path, &lattice.file(1, &names, &frames(&names, 1))).unwrap();
    let whole = fs::read(&path).unwrap();
    let end_of =
        |mark: &[u8]| whole.windows(mark.len()).position(|bytes| bytes == mark).unwrap() + mark.len();
    // Another record dimension with a variable of one byte, so that the file holds any number of records.
    let variables = end_of(b"\0\0\0\x0b\0\0\0\x0b");
    let variable = b"\0\0\0\x04more\0\0\0\x01\0\0\0\x04\0\0\0\0\0\0\0\0\0\0\0\x01\0\0\0\x04\0\0\0\0\0\0\0\0";
    let bytes = with_one_more(&whole, b"\0\0\0\x0b\0\0\0\x0b", variable, variables);
    let time = end_of(b"\0\0\0\x04time");
    let dimensions = end_of(b"instant_length\0\0") + 4;
    let mut bytes = with_one_more(
        &bytes,
        b"\0\0\0\x0a\0\0\0\x04",
        b"\0\0\0\x04more\0\0\0\0",
        dimensions,
    );
    bytes[time..time + 4].copy_from_slice(&3u32.to_be_bytes());
    bytes[4..8].copy_from_slice(&100u32.to_be_bytes());
    replace(&path, &bytes);
    let said = read_fields(&path).unwrap_err().to_string();
    assert!(said.contains("`time` has a fixed length"), "{said}");
}

#[test]
fn an_array_that_stands_twice_is_refused() {
    let lattice = lattice();
    let (_folder, path) = folder();
    let names = [Field::VelocityX, Field::VelocityY];
    write(&path, &lattice.file(1, &names, &frames(&names, 1))).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let second = bytes
        .windows(10)
        .position(|bytes| bytes == b"velocity_y")
        .unwrap();
    bytes[second + 9] = b'x';
    replace(&path, &bytes);
    let said = read_fields(&path).unwrap_err().to_string();
    assert!(said.contains("its header defines `velocity_x` twice"), "{said}");
}

/// Damaged files are refused or read, without a panic and without memory for missing values.
#[test]
fn damaged_files_are_refused_or_read() {
    let lattice = lattice();
    let (_folder, path) = folder();
    let names = [Field::Traction, Field::Sliding];
    write(&path, &lattice.file(2, &names, &frames(&names, 2))).unwrap();
    let whole = fs::read(&path).unwrap();
    // A linear congruential generator (Knuth's constants): the same damage on every run.
    let mut state: u64 = 1;
    let mut below = |bound: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % bound
    };
    for _ in 0..2000 {
        let mut bytes = whole.clone();
        for _ in 0..=below(3) {
            let at = below(bytes.len());
            bytes[at] = [0, 1, 0x0c, 0x7f, 0x80, 0xff][below(6)];
        }
        replace(&path, &bytes);
        let _ = read_fields(&path);
    }
}

/// Processes that each hold some rows write the same bytes, in any order, as one that holds all rows.
#[test]
fn rows_that_are_written_apart_give_the_same_file() {
    let lattice = lattice();
    let names = [Field::Sliding, Field::Traction];
    for stride in [1, 2, 3] {
        let frames = frames(&names, stride);
        let file = lattice.file(stride, &names, &frames);
        let (_folder, path) = folder();
        write(&path, &file).unwrap();
        let whole = fs::read(&path).unwrap();
        for ends in [vec![0, 1, 2, 3], vec![0, 2, 3], vec![0, 0, 3], vec![0, 3]] {
            let mut apart = Cursor::new(Vec::new());
            for rows in ends.windows(2).rev() {
                let kept = kept(rows[0]..rows[1], stride);
                let values = kept.start * file.columns()..kept.end * file.columns();
                let mut part = file.clone();
                part.first_row = kept.start;
                part.textured = part.textured[values.clone()].to_vec();
                for array in [
                    &mut part.mu_static,
                    &mut part.mu_kinetic,
                    &mut part.first_slip_time_star,
                ] {
                    *array = array[values.clone()].to_vec();
                }
                for field in part.frames.iter_mut().flat_map(|frame| &mut frame.values) {
                    *field = field[values.clone()].to_vec();
                }
                let writer = FieldsWriter::new(&part);
                // Any process may create the file, at any time.
                if rows[1] == NY {
                    writer.create(&mut apart).unwrap();
                }
                writer.write_rows(&mut apart).unwrap();
            }
            assert!(apart.into_inner() == whole, "rows {ends:?}, stride {stride}");
        }
    }
}

/// The bytes of files of all kinds, the same in every version: with and without instants and fields, labels
/// of other lengths, and an odd number of flags, which is padded.
#[test]
fn the_bytes_of_a_file_are_pinned() {
    let lattice = lattice();
    let hash = |file: &FieldsData| {
        let (_folder, path) = folder();
        write(&path, file).unwrap();
        let mut bytes = fs::read(&path).unwrap();
        // The file contains the version of the package.
        let version = concat!("slipfront ", env!("CARGO_PKG_VERSION")).as_bytes();
        let at = bytes.windows(version.len()).position(|found| found == version);
        bytes[at.unwrap()..][..version.len()].fill(b'.');
        blake3::hash(&bytes).to_hex()[..16].to_owned()
    };
    let found =
        [1, 2, 9].map(|stride| hash(&lattice.file(stride, &Field::ALL, &frames(&Field::ALL, stride))));
    let bare = [&frames(&[], 1)[..], &[]].map(|frames| hash(&lattice.file(1, &[], frames)));
    let found = [&found[..], &bare[..]].concat();
    assert_eq!(
        found,
        [
            "d1d3832f7c6044f2",
            "d1c28f39bc0f60cd",
            "831a49d7ab46808e",
            "b935366d81b68de1",
            "397a708906e813d5"
        ]
    );
}
