//! Tests of the readers of arrays, tables of numbers and masks, also with files that are damaged.

use std::fmt::Debug;
use std::fs;
use std::io::BufReader;
use std::path::PathBuf;

use png::{BitDepth, ColorType, Encoder};
use tempfile::TempDir;
use test_case::test_case;

use super::*;

/// A folder that is removed afterwards, and a file in it.
fn file(name: &str, bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

/// A `.npy` file of version 1.0.
fn npy_bytes(descr: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut text = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}");
    while (10 + text.len() + 1) % 64 != 0 {
        text.push(' ');
    }
    text.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(data);
    bytes
}

fn f64_bytes(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// The field of two rows of three blocks that the tests store in many ways.
const FIELD: [f64; 6] = [0.0, 1.0, 2.0, 3.0, 4.0, 120.0];

fn field_npy() -> Vec<u8> {
    npy_bytes("'<f8'", "False", "(2, 3)", &f64_bytes(&FIELD))
}

fn open(path: &Path, nx: usize, ny: usize) -> Result<BufReader<File>, ArrayError> {
    let (file, length) = super::open(path)?;
    limit_length(path, length, nx, ny)?;
    Ok(BufReader::new(file))
}

/// Reads all rows at once. Dividing the rows among several ranks must give the same result, or the error of
/// the lowest rank.
fn read<T: PartialEq + Debug>(
    nx: usize,
    ny: usize,
    read: impl Fn(&Slab) -> Result<Vec<T>, ArrayError>,
) -> Result<Vec<T>, ArrayError> {
    let whole = read(&Slab::whole(nx, ny));
    for ranks in 2..=ny {
        let rows = |rank: usize| ny * rank / ranks..ny * (rank + 1) / ranks;
        let parts = (0..ranks).map(|rank| {
            read(&Slab {
                nx,
                ny,
                rows: rows(rank),
            })
        });
        let joined: Result<Vec<Vec<T>>, ArrayError> = parts.collect();
        match (&whole, joined) {
            (Ok(whole), Ok(joined)) => assert_eq!(*whole, joined.into_iter().flatten().collect::<Vec<T>>()),
            (Err(whole), Err(first)) => assert_eq!(whole.to_string(), first.to_string()),
            (whole, joined) => panic!("{whole:?} of all rows, {joined:?} of {ranks} ranks"),
        }
    }
    whole
}

fn read_field(path: &Path, nx: usize, ny: usize) -> Result<Vec<f64>, ArrayError> {
    read(nx, ny, |slab| field(path, &mut open(path, nx, ny)?, slab))
}

fn read_mask_npy(path: &Path, nx: usize, ny: usize) -> Result<Vec<bool>, ArrayError> {
    read(nx, ny, |slab| mask_npy(path, &mut open(path, nx, ny)?, slab))
}

/// The mask for a lattice of `nx` x `ny` blocks, the top row first.
fn read_mask_png(path: &Path, threshold: f64, [nx, ny]: [usize; 2]) -> Result<Vec<bool>, ArrayError> {
    let mask = read(nx, ny, |slab| {
        mask_png(path, &mut open(path, 25, 25)?, threshold, slab)
    })?;
    Ok(mask.chunks(nx).rev().flatten().copied().collect())
}

fn message(result: Result<impl std::fmt::Debug, ArrayError>) -> String {
    result.unwrap_err().to_string()
}

#[test_case("'|b1'", |v: f64| vec![u8::from(v != 0.0)])]
#[test_case("'|u1'", |v: f64| vec![v as u8])]
#[test_case("'|i1'", |v: f64| vec![v as i8 as u8])]
#[test_case("'<u2'", |v: f64| (v as u16).to_le_bytes().to_vec())]
#[test_case("'>i2'", |v: f64| (v as i16).to_be_bytes().to_vec())]
#[test_case("'<i4'", |v: f64| (v as i32).to_le_bytes().to_vec())]
#[test_case("'>u4'", |v: f64| (v as u32).to_be_bytes().to_vec())]
#[test_case("'>i8'", |v: f64| (v as i64).to_be_bytes().to_vec())]
#[test_case("'<u8'", |v: f64| (v as u64).to_le_bytes().to_vec())]
#[test_case("'<f4'", |v: f64| (v as f32).to_le_bytes().to_vec())]
#[test_case("'>f4'", |v: f64| (v as f32).to_be_bytes().to_vec())]
#[test_case("'<f8'", |v: f64| v.to_le_bytes().to_vec())]
#[test_case("'>f8'", |v: f64| v.to_be_bytes().to_vec())]
fn npy_of_any_type(descr: &str, store: fn(f64) -> Vec<u8>) {
    let data: Vec<u8> = FIELD.iter().flat_map(|value| store(*value)).collect();
    let (_folder, path) = file("mu.npy", &npy_bytes(descr, "False", "(2, 3)", &data));
    let wanted = if descr == "'|b1'" {
        [0.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    } else {
        FIELD
    };
    assert_eq!(read_field(&path, 3, 2).unwrap(), wanted);
    // A file is a mask only if all its values are 0 or 1.
    let mask = read_mask_npy(&path, 3, 2);
    assert_eq!(mask.is_ok(), descr == "'|b1'");
    let ones: Vec<u8> = [0.0, 1.0, 1.0, 0.0, 1.0, 0.0]
        .into_iter()
        .flat_map(store)
        .collect();
    let (_folder, path) = file("mask.npy", &npy_bytes(descr, "False", "(2, 3)", &ones));
    let mask = read_mask_npy(&path, 3, 2).unwrap();
    assert_eq!(mask, [false, true, true, false, true, false]);
}

#[test]
fn npy_of_half_precision() {
    // 0, the smallest subnormal, 1, 0.333251953125, 2, 65504
    let bits: [u16; 6] = [0x0000, 0x0001, 0x3c00, 0x3555, 0x4000, 0x7bff];
    let data: Vec<u8> = bits.iter().flat_map(|bits| bits.to_le_bytes()).collect();
    let (_folder, path) = file("mu.npy", &npy_bytes("'<f2'", "False", "(2, 3)", &data));
    let wanted = [0.0, 2f64.powi(-24), 1.0, 0.333251953125, 2.0, 65504.0];
    assert_eq!(read_field(&path, 3, 2).unwrap(), wanted);
}

#[test]
fn npy_negative_values_keep_their_sign() {
    for (descr, data) in [
        ("'|i1'", (-7i8).to_le_bytes().to_vec()),
        ("'>i2'", (-7i16).to_be_bytes().to_vec()),
        ("'<i8'", (-7i64).to_le_bytes().to_vec()),
        ("'<f2'", 0xc700u16.to_le_bytes().to_vec()),
    ] {
        let (_folder, path) = file("mu.npy", &npy_bytes(descr, "False", "(1, 1)", &data));
        let text = message(read_field(&path, 1, 1));
        assert!(text.contains("has -7 in row 0, column 0"), "{text}");
    }
}

#[test]
fn npy_in_fortran_order_and_later_versions() {
    let stored = f64_bytes(&[0.0, 3.0, 1.0, 4.0, 2.0, 120.0]);
    let (_folder, path) = file("mu.npy", &npy_bytes("'<f8'", "True", "(2, 3)", &stored));
    assert_eq!(read_field(&path, 3, 2).unwrap(), FIELD);

    let mut version_2 = field_npy();
    version_2[6] = 2;
    version_2.splice(10..10, [0, 0]);
    let (_folder, path) = file("mu.NPY", &version_2);
    assert_eq!(read_field(&path, 3, 2).unwrap(), FIELD);
}

#[test_case(
    "'<f8'",
    "(3, 2)",
    "has the shape (3, 2) where (2, 3), that is (ny, nx), is wanted; transpose"
)]
#[test_case("'<f8'", "(6,)", "has the shape (6) where (2, 3)")]
#[test_case("'<f8'", "(2, 3, 1)", "has the shape (2, 3, 1)")]
#[test_case("'<f8'", "(1000000, 1000000)", "has the shape (1000000, 1000000)")]
#[test_case("'<f8'", "(9999999999, 9999999999)", "does not describe a plain array")]
#[test_case("'<f8'", "(0xffffffffff, 0xffffffffff)", "does not describe a plain array")]
#[test_case("'<f8'", "((((((2, 3))))))", "does not describe a plain array")]
#[test_case("'<f8'", "(2, -3)", "its header is corrupt")]
#[test_case("'<f8'", "(2, 3", "its header is corrupt")]
#[test_case("'<c16'", "(2, 3)", "values of type '<c16'")]
#[test_case("'<f16'", "(2, 3)", "values of type '<f16'")]
#[test_case("'<U3'", "(2, 3)", "values of type '<U3'")]
#[test_case("'|O'", "(2, 3)", "values of type '|O'")]
#[test_case("[('a', '<f8')]", "(2, 3)", "values of type [('a', '<f8')]")]
fn npy_of_another_kind(descr: &str, shape: &str, wanted: &str) {
    let (_folder, path) = file("mu.npy", &npy_bytes(descr, "False", shape, &f64_bytes(&FIELD)));
    let text = message(read_field(&path, 3, 2));
    assert!(text.contains(wanted), "{text}");
    assert!(text.contains(&path.display().to_string()), "{text}");
}

#[test]
fn npy_that_is_cut_short_or_something_else() {
    let whole = field_npy();
    let (_folder, path) = file("mu.npy", &whole[..whole.len() - 1]);
    let text = message(read_field(&path, 3, 2));
    assert!(
        text.contains("it has 175 bytes, but its header requires 176"),
        "{text}"
    );

    for (bytes, wanted) in [
        (&whole[..50], "cut short"),
        (&whole[..9], "ends inside the header"),
        (b"", "does not begin with the signature"),
        (b"PK\x03\x04 an archive", "does not begin with the signature"),
        (b"\x93NUMPY\x09\x00 and more text", "format version is 9.0"),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{}", "cut short or longer"),
    ] {
        let (_folder, path) = file("mu.npy", bytes);
        let text = message(read_field(&path, 3, 2));
        assert!(text.contains(wanted), "{text}");
    }
}

/// More numbers than are decoded at once, along both axes.
#[test]
fn arrays_of_any_size_are_read_by_their_rows() {
    let (nx, ny) = (37, 1100);
    let value = |row: usize, column: usize| (row * 64 + column) as f64;
    let rows = || (0..ny).flat_map(|row| (0..nx).map(move |column| (row, column)));
    let wanted: Vec<f64> = rows().map(|(row, column)| value(row, column)).collect();
    let columns = (0..nx).flat_map(|column| (0..ny).map(move |row| (row, column)));
    let by_columns: Vec<f64> = columns.map(|(row, column)| value(row, column)).collect();
    let shape = format!("({ny}, {nx})");
    let lines: Vec<String> = wanted
        .chunks(nx)
        .map(|row| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(","))
        .collect();
    let files = [
        ("c.npy", npy_bytes("'<f8'", "False", &shape, &f64_bytes(&wanted))),
        (
            "f.npy",
            npy_bytes("'<f8'", "True", &shape, &f64_bytes(&by_columns)),
        ),
        (
            "t.csv",
            format!("# mu\n\n{}\n\n", lines.join("\n#\n")).into_bytes(),
        ),
    ];
    for (name, bytes) in files {
        let (_folder, path) = file(name, &bytes);
        for rows in [0..ny, 0..1, 1..2, 300..1099, ny - 1..ny, 5..5] {
            let values = &wanted[rows.start * nx..rows.end * nx];
            let slab = Slab { nx, ny, rows };
            let read = field(&path, &mut open(&path, nx, ny).unwrap(), &slab).unwrap();
            assert_eq!(read, values, "{name}: {slab:?}");
        }
    }
}

#[test]
fn values_out_of_bounds_are_named() {
    for (bad, shown) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (-0.25, "-0.25")] {
        let mut values = FIELD;
        values[5] = bad;
        let (_folder, path) = file(
            "mu.npy",
            &npy_bytes("'<f8'", "False", "(2, 3)", &f64_bytes(&values)),
        );
        let text = message(read_field(&path, 3, 2));
        assert!(
            text.contains(&format!("has {shown} in row 1, column 2")),
            "{text}"
        );
        assert!(message(read_mask_npy(&path, 3, 2)).contains("0 or 1 (1 is a dark pixel)"));
    }
}

#[test_case("0,1,2\n3,4,120\n")]
#[test_case("0;1;2\n3;4;120")]
#[test_case("0\t1\t2\r\n3\t4\t120\r\n")]
#[test_case("0 1   2\n 3   4 120\n")]
#[test_case("# mu, one number per block; row j = 0 first\n#\n\n0, 1.0, 2e0\n# half-way\n3,4,1.2E+2\n\n")]
#[test_case("\u{feff}0,1,2\n3,4,120\n")]
#[test_case("0,0;1;2\n3;4;120,0\n")]
fn tables_with_any_separator(text: &str) {
    let (_folder, path) = file("mu.csv", text.as_bytes());
    assert_eq!(read_field(&path, 3, 2).unwrap(), FIELD);
}

#[test]
fn tables_of_one_column_or_one_row() {
    let (_folder, path) = file("mu.csv", b"1\n2\n3\n");
    assert_eq!(read_field(&path, 1, 3).unwrap(), [1.0, 2.0, 3.0]);
    let (_folder, path) = file("mu.csv", b"1 2 3");
    assert_eq!(read_field(&path, 3, 1).unwrap(), [1.0, 2.0, 3.0]);
}

#[test_case(
    "",
    "has 0 lines of numbers where one line per row of blocks, 2 lines of 3 numbers, is wanted"
)]
#[test_case("# only a comment", "has 0 lines of numbers")]
#[test_case("0,1,2\n", "has 1 lines of numbers")]
#[test_case("0,1,2\n3,4,5\n6,7,8\n", "has more than 2 lines of numbers")]
#[test_case("0,1,2\n3,4\n", "has 2 numbers in line 2")]
#[test_case("0,1,2,\n3,4,5,\n", "has 4 numbers in line 1")]
#[test_case("x,y,z\n0,1,2\n", "has `x` in line 1, in row 0, column 0")]
#[test_case("0,1,2\n3,,5\n", "has `` in line 2, in row 1, column 1")]
#[test_case("0.5;1;2\n3;4,5;5\n", "but must be a number with a decimal"; "two decimal signs")]
#[test_case(
    "0,1,2\n3,4,nan\n",
    "has NaN in line 2, in row 1, column 2 (both counted from 0), but must be a finite number >= 0"
)]
#[test_case("0,1,1e999\n3,4,5\n", "has inf in line 1, in row 0, column 2")]
#[test_case("0,1,2\n3,-4,5\n", "has -4 in line 2, in row 1, column 1")]
fn tables_of_another_kind(text: &str, wanted: &str) {
    let (_folder, path) = file("mu.csv", text.as_bytes());
    let text = message(read_field(&path, 3, 2));
    assert!(text.contains(wanted), "{text}");
}

#[test]
fn tables_that_are_not_text() {
    let (_folder, path) = file("mu.csv", b"0,1,2\n3,\xff\xfe,5\n");
    let text = message(read_field(&path, 3, 2));
    assert!(
        text.contains("has `\u{ff}\u{fe}` in line 2, in row 1, column 1"),
        "{text}"
    );
    let (_folder, path) = file("mu.csv", format!("{},1,2\n", "9x".repeat(50_000)).as_bytes());
    assert!(message(read_field(&path, 3, 2)).len() < 300);
}

/// The whole line is in memory, with the position of each of its fields.
#[test]
fn lines_longer_than_their_numbers_are_refused() {
    let (_folder, path) = file("mu.csv", format!("0,1,2\n{}\n", "3,".repeat(1 << 20)).as_bytes());
    // The file itself would be too long for six blocks.
    let source = || BufReader::new(File::open(&path).unwrap());
    let text = message(field(&path, &mut source(), &Slab::whole(3, 2)));
    assert!(text.contains("has more than 1048768 bytes in line 2"), "{text}");
    let (_folder, path) = file("mu.csv", &[b'1'; (8 << 20) + 1]);
    let room = Room {
        blocks: [3, 2],
        is_place: false,
    };
    let source = || BufReader::new(File::open(&path).unwrap());
    let text = message(height_map(
        &path,
        &mut source(),
        &HeightMapUnits::default(),
        &Preparation::default(),
        &room,
    ));
    assert!(text.contains("has more than 8388608 bytes in line 1"), "{text}");
}

#[test]
fn paths_that_are_no_files() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.npy");
    for text in [
        message(read_field(&missing, 3, 2)),
        message(read_mask_npy(&missing, 3, 2)),
    ] {
        assert!(
            text.starts_with("cannot read `") && text.contains("missing.npy"),
            "{text}"
        );
    }
    let directory = folder.path().join("folder.csv");
    fs::create_dir(&directory).unwrap();
    for text in [
        message(read_field(&directory, 3, 2)),
        message(read_mask_png(&directory, 0.5, [2, 2])),
    ] {
        assert!(text.contains("is not a regular file"), "{text}");
    }
    fs::write(folder.path().join("mu.txt"), "1").unwrap();
    let text = message(read_field(&folder.path().join("mu.txt"), 3, 2));
    assert!(
        text.contains("the extension `.txt`; give a file with the extension .npy or .csv"),
        "{text}"
    );
    fs::write(folder.path().join("mu"), "1").unwrap();
    let text = message(read_field(&folder.path().join("mu"), 3, 2));
    assert!(text.contains("a name without extension"), "{text}");
}

/// A PNG image of two rows of two pixels from raw rows, with a palette if the colour type requires one.
fn png_bytes(color: ColorType, depth: BitDepth, rows: &[u8], transparency: Option<&[u8]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 2, 2);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == ColorType::Indexed {
        encoder.set_palette(&[255, 255, 255, 200, 0, 0, 0, 255, 0][..]);
    }
    if let Some(transparency) = transparency {
        encoder.set_trns(transparency.to_vec());
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(rows).unwrap();
    writer.finish().unwrap();
    bytes
}

/// Each image is white, dark / dark, white, in a different encoding.
#[test_case(ColorType::Grayscale, BitDepth::One, &[0b1000_0000, 0b0100_0000], None)]
#[test_case(ColorType::Grayscale, BitDepth::Two, &[0b1101_0000, 0b0111_0000], None)]
#[test_case(ColorType::Grayscale, BitDepth::Eight, &[255, 127, 0, 128], None)]
#[test_case(ColorType::Grayscale, BitDepth::Sixteen, &[0x80, 0x00, 0x7f, 0xff, 0x00, 0x00, 0xff, 0xff], None)]
#[test_case(ColorType::Grayscale, BitDepth::Eight, &[10, 20, 30, 10], Some(&[0, 10][..]))]
#[test_case(ColorType::GrayscaleAlpha, BitDepth::Eight, &[0, 0, 0, 255, 0, 200, 0, 60], None)]
#[test_case(ColorType::Rgb, BitDepth::Eight, &[0, 255, 0, 255, 0, 255, 255, 0, 0, 255, 255, 0], None)]
#[test_case(ColorType::Rgba, BitDepth::Eight, &[0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 255, 255, 0, 0, 255, 50], None)]
#[test_case(ColorType::Indexed, BitDepth::Two, &[0b0001_0000, 0b0110_0000], None)]
#[test_case(ColorType::Indexed, BitDepth::Eight, &[2, 1, 1, 0], Some(&[255, 255, 0][..]))]
fn png_of_any_colour(color: ColorType, depth: BitDepth, rows: &[u8], transparency: Option<&[u8]>) {
    let (_folder, path) = file("mask.png", &png_bytes(color, depth, rows, transparency));
    assert_eq!(
        read_mask_png(&path, 0.5, [2, 2]).unwrap(),
        [false, true, true, false]
    );
}

#[test]
fn png_threshold_is_exclusive() {
    let grey = png_bytes(ColorType::Grayscale, BitDepth::Eight, &[51, 51, 50, 52], None);
    let (_folder, path) = file("mask.png", &grey);
    assert_eq!(
        read_mask_png(&path, 51.0 / 255.0, [2, 2]).unwrap(),
        [false, false, true, false]
    );
    assert_eq!(read_mask_png(&path, 1.0, [2, 2]).unwrap(), [true; 4]);
}

/// Five by seven grey pixels in the seven passes of Adam7.
const INTERLACED: [u8; 85] = [
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 5, 0, 0, 0, 7, 8, 0, 0, 0, 1, 146,
    203, 232, 164, 0, 0, 0, 28, 73, 68, 65, 84, 120, 218, 99, 96, 96, 248, 15, 132, 80, 226, 63, 8, 129, 88,
    16, 62, 152, 4, 139, 128, 0, 68, 30, 0, 243, 75, 22, 234, 230, 102, 142, 96, 0, 0, 0, 0, 73, 69, 78, 68,
    174, 66, 96, 130,
];

#[test]
fn png_interlaced() {
    let (_folder, path) = file("mask.png", &INTERLACED);
    let is_dark = |row: usize, column: usize| (3 * row + 2 * column + row * column) % 5 < 2;
    // More blocks than pixels, as many, and fewer: each block takes the pixel at its centre.
    for [nx, ny] in [[5, 7], [12, 30], [3, 2], [1, 1]] {
        let mask = read_mask_png(&path, 0.5, [nx, ny]).unwrap();
        for (row, column) in (0..ny).flat_map(|row| (0..nx).map(move |column| (row, column))) {
            let pixel = |block: usize, blocks: usize, pixels: f64| {
                ((block as f64 + 0.5) * pixels / blocks as f64) as usize
            };
            let dark = is_dark(pixel(row, ny, 7.0), pixel(column, nx, 5.0));
            assert_eq!(
                mask[row * nx + column],
                dark,
                "{nx} x {ny}: row {row}, column {column}"
            );
        }
    }
}

/// A PNG image with a wrong size in its header.
fn png_claiming(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = png_bytes(ColorType::Rgba, BitDepth::Sixteen, &[0; 32], None);
    bytes[16..20].copy_from_slice(&width.to_be_bytes());
    bytes[20..24].copy_from_slice(&height.to_be_bytes());
    repair_checksums(&mut bytes);
    bytes
}

/// Corrects the checksum of every chunk, so that the decoder reads damaged chunks too.
fn repair_checksums(png: &mut [u8]) {
    let mut start = 8;
    while let Some(length) = png.get(start..start + 4) {
        let length = u32::from_be_bytes(length.try_into().unwrap()) as usize;
        let end = start + 8 + length;
        if end + 4 > png.len() {
            return;
        }
        let mut crc = u32::MAX;
        for byte in &png[start + 4..end] {
            crc ^= u32::from(*byte);
            for _ in 0..8 {
                crc = (crc >> 1) ^ (0xedb8_8320 * (crc & 1));
            }
        }
        png[end..end + 4].copy_from_slice(&(!crc).to_be_bytes());
        start = end + 4;
    }
}

#[test_case(
    100_000,
    100_000,
    "has 100000 x 100000 pixels; at most 268435456 pixels are read, and at most 1048576 along a side: scale it down"
)]
#[test_case(u32::MAX, 1, "has 4294967295 x 1 pixels")]
#[test_case(1, (1 << 20) + 1, "and at most 1048576 along a side")]
#[test_case(16_000, 16_000, "where its 16000 x 16000 pixels take at least")]
#[test_case(0, 2, "is not a readable .png file")]
#[test_case(2, 3, "does not have enough data")]
fn png_that_claims_too_much(width: u32, height: u32, wanted: &str) {
    let (_folder, path) = file("mask.png", &png_claiming(width, height));
    let text = message(read_mask_png(&path, 0.5, [2, 2]));
    assert!(text.contains(wanted), "{text}");
}

#[test_case(&[1, 2], "PLTE")]
#[test_case(&[0; 4], "its palette has 4 bytes where 3 for each of 1 to 256 colours are wanted")]
#[test_case(&[0; 3 * 257], "PLTE")]
fn png_with_a_bad_palette(palette: &[u8], wanted: &str) {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(ColorType::Indexed);
    encoder.set_palette(palette);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0]).unwrap();
    writer.finish().unwrap();
    let (_folder, path) = file("mask.png", &bytes);
    let text = message(read_mask_png(&path, 0.5, [2, 2]));
    assert!(text.contains(wanted), "{text}");
}

#[test]
fn png_that_is_cut_short_or_something_else() {
    let whole = png_bytes(ColorType::Rgb, BitDepth::Eight, &[0; 12], None);
    for (bytes, wanted) in [
        (&whole[..20], "ends before the last pixel"),
        (&whole[..whole.len() - 20], "ends before the last pixel"),
        (b"", "ends before the last pixel"),
        (b"GIF89a and the rest of it", "is not a readable .png file"),
    ] {
        let (_folder, path) = file("mask.png", bytes);
        let text = message(read_mask_png(&path, 0.5, [2, 2]));
        assert!(text.contains(wanted), "{text}");
    }
}

/// A file with a hole at its end, which takes no disk space.
fn stretched(name: &str, bytes: &[u8], length: u64) -> (TempDir, PathBuf) {
    let (folder, path) = file(name, bytes);
    let stretched = fs::OpenOptions::new().write(true).open(&path).unwrap();
    stretched.set_len(length).unwrap();
    (folder, path)
}

#[test]
fn files_longer_than_can_be_meant_are_not_read() {
    let most = (1 << 20) + 6 * 64;
    let (_folder, path) = stretched("mu.csv", b"1,2,3\n4,5,6\n#", most + 1);
    let text = message(read_field(&path, 3, 2));
    let wanted = format!(
        "has {} bytes where 2 rows of 3 numbers take at most {most};",
        most + 1
    );
    assert!(text.contains(&wanted), "{text}");
    let (_folder, path) = stretched("mask.png", b"", (1 << 28) + 1);
    let text = message(read_mask_png(&path, 0.5, [2, 2]));
    assert!(
        text.contains("where an image takes at most 268435456; scale it down"),
        "{text}"
    );
    let (_folder, path) = stretched("mu.npy", &field_npy(), 1 << 40);
    let text = message(read_field(&path, 3, 2));
    assert!(
        text.contains("where 2 rows of 3 numbers take at most 10048;"),
        "{text}"
    );
    // Bytes after an array do not belong to it.
    let (_folder, path) = stretched("mu.npy", &field_npy(), 5000);
    let text = message(read_field(&path, 3, 2));
    let wanted = format!("it has 5000 bytes, but its header requires {}", field_npy().len());
    assert!(text.contains(&wanted), "{text}");
}

#[test_case(1, 1)]
#[test_case(8, 3)]
#[test_case(13, 5)]
fn masks_come_back_as_written(nx: usize, ny: usize) {
    let textured: Vec<bool> = (0..nx * ny).map(|block| block * block % 7 < 3).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mask.png");
    fs::write(&path, png_of_mask(nx, ny, &textured).unwrap()).unwrap();
    let mask = read(nx, ny, |slab| {
        mask_png(&path, &mut open(&path, nx, ny)?, 0.5, slab)
    });
    assert_eq!(mask.unwrap(), textured);
}

#[test]
fn masks_that_cannot_be_written() {
    for (nx, ny, textured) in [(2, 2, &[true][..]), (0, 0, &[])] {
        assert!(png_of_mask(nx, ny, textured).is_err(), "{nx} x {ny}");
    }
}

/// Replaces an old file with a new one: some file systems wait for the disk when a file is truncated.
fn replace(path: &Path, bytes: &[u8]) {
    let _ = fs::remove_file(path);
    fs::write(path, bytes).unwrap();
}

/// Readers return without a panic for any damage to the bytes of a file.
#[test]
fn damaged_files_are_refused_or_read() {
    let folder = tempfile::tempdir().unwrap();
    let samples = [
        ("a.npy", field_npy()),
        (
            "b.npy",
            npy_bytes("[('a', '<f8', (2, 3)), ('b', '|O')]", "True", "(2, 3)", &[1; 60]),
        ),
        ("c.csv", b"# mu\n0,1,2\n3,4,120\n".to_vec()),
        ("d.png", INTERLACED.to_vec()),
        (
            "e.png",
            png_bytes(ColorType::Indexed, BitDepth::Eight, &[2, 1, 1, 0], Some(&[9, 9])),
        ),
        (
            "f.png",
            png_bytes(
                ColorType::Grayscale,
                BitDepth::Two,
                &[0b1101_0000, 0b0111_0000],
                Some(&[0, 3]),
            ),
        ),
        (
            "g.png",
            png_bytes(
                ColorType::Rgb,
                BitDepth::Eight,
                &[7; 12],
                Some(&[0, 7, 0, 7, 0, 7]),
            ),
        ),
    ];
    // A linear congruential generator (Knuth's constants): the same damage on every run.
    let mut state: u64 = 1;
    let mut below = |bound: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % bound
    };
    for (name, whole) in &samples {
        let path = folder.path().join(name);
        for _ in 0..500 {
            let mut bytes = whole.clone();
            for _ in 0..=below(3) {
                let at = below(bytes.len());
                bytes[at] = below(256) as u8;
            }
            if below(4) == 0 {
                bytes.truncate(below(whole.len()));
            }
            if name.ends_with("png") && below(4) != 0 {
                repair_checksums(&mut bytes);
            }
            replace(&path, &bytes);
            if name.ends_with("png") {
                let _ = read_mask_png(&path, 0.5, [2, 2]);
            } else {
                let _ = read_field(&path, 3, 2);
            }
        }
    }
}
