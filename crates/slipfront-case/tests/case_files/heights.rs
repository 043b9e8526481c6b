//! Height maps written by public tools (`heights/make.py`), compared with results of numpy.

use std::fs::File;
use std::io::{BufReader, Cursor, Write};
use std::path::{Path, PathBuf};

use serde_json::Value;
use slipfront::testing::Threads;
use slipfront_case::arrays::{
    self, ArrayError, HeightMap, HeightMapUnits, Preparation, Room, Slab, height_map,
    limit_length_of_height_map, open, png_of_mask,
};
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::CaseFile;
use test_case::test_case;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/heights")
}

fn read(path: &Path, units: HeightMapUnits, blocks: [usize; 2]) -> Result<HeightMap, ArrayError> {
    let (file, length) = open(path)?;
    limit_length_of_height_map(path, length)?;
    let mut source = BufReader::new(file);
    let room = Room {
        blocks,
        is_place: false,
    };
    height_map(path, &mut source, &units, &Preparation::default(), &room)
}

fn reference() -> Value {
    serde_json::from_reader(File::open(folder().join("reference.json")).unwrap()).unwrap()
}

const PIXEL: f64 = 0.5e-6;
const SIZE: Option<[f64; 2]> = Some([PIXEL; 2]);
/// Units for a file that states its own.
const OWN: HeightMapUnits = HeightMapUnits {
    height: None,
    pixel: None,
};

/// The map has no symmetry. For every format, it lies on the blocks as SurfaceTopography and Gwyddion show
/// it. Heights stored as 32-bit numbers are accurate to 2^-24 of 6 um; as 64-bit numbers, grey levels and
/// decimals, to rounding; as integers, to half a step: their range, less than 6 um, over 2^32 or 2^16.
#[test_case("map.npy", HeightMapUnits { height: Some(1.0), pixel: SIZE }, 1e-15)]
#[test_case("map_f4_fortran.npy", HeightMapUnits { height: Some(1e-6), pixel: SIZE }, 4e-13)]
#[test_case("map.csv", HeightMapUnits { height: Some(1e-6), pixel: SIZE }, 1e-15)]
#[test_case("map.png", HeightMapUnits { height: Some(2e-9), pixel: SIZE }, 1e-15)]
#[test_case("map.tif", HeightMapUnits { height: Some(2e-9), pixel: SIZE }, 1e-15)]
#[test_case("map_lzw.tif", HeightMapUnits { height: Some(2e-9), pixel: SIZE }, 1e-15)]
#[test_case("map_tiles.tif", HeightMapUnits { height: Some(1e-6), pixel: SIZE }, 4e-13)]
#[test_case("map.gsf", OWN, 4e-13)]
#[test_case("map.x3p", OWN, 1e-15)]
#[test_case("map_f4.x3p", OWN, 4e-13)]
#[test_case("map_i4.x3p", OWN, 1e-15)]
#[test_case("map_i2.x3p", OWN, 5e-11)]
fn every_format_gives_what_numpy_computes(name: &str, units: HeightMapUnits, error: f64) {
    let reference = reference();
    for (grid, means) in reference["blocks"].as_object().unwrap() {
        let (nx, ny) = grid.split_once('x').unwrap();
        let blocks = [nx.parse().unwrap(), ny.parse().unwrap()];
        let map = read(&folder().join(name), units, blocks).unwrap();
        assert_eq!(map.points, [30, 20]);
        // The products with the pixel size are rounded once.
        assert!((map.size[0] - 15e-6).abs() < 1e-20 && (map.size[1] - 10e-6).abs() < 1e-20);
        let means = means.as_array().unwrap();
        assert_eq!(map.blocks.len(), means.len());
        for (found, mean) in map.blocks.iter().zip(means) {
            let mean = mean.as_f64().unwrap();
            assert!((found - mean).abs() < error, "{name} {grid}: {found} and {mean}");
        }
        // Parameters change by no more than the heights, over a roughness of about 0.5 um; the fourth moment
        // by four times as much.
        let near = |key: &str, found: f64, unit: f64| {
            let wanted = reference[key].as_f64().unwrap();
            let bound = 20.0 * error / 0.5e-6 * unit;
            assert!(
                (found - wanted).abs() < bound,
                "{name}: {key} {found} and {wanted}"
            );
        };
        near("sa", map.roughness.sa, 1e-6);
        near("sq", map.roughness.sq, 1e-6);
        near("ssk", map.roughness.ssk.unwrap(), 1.0);
        near("sku", map.roughness.sku.unwrap(), 1.0);
    }
}

/// Blocks that cover unequal shares of points with equal height have equal means: rounding does not break a
/// plateau.
#[test]
fn blocks_over_a_plateau_have_its_height() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.csv");
    let plateau = ["0.1"; 30].join(",");
    let corner = plateau.replacen("0.1", "-1000.3", 1);
    std::fs::write(&path, format!("{corner}\n{}", format!("{plateau}\n").repeat(19))).unwrap();
    let units = HeightMapUnits {
        height: Some(1e-6),
        pixel: SIZE,
    };
    let map = read(&path, units, [21, 14]).unwrap();
    assert!(map.blocks[0] < 0.0);
    // A quantum is 2^-43 um.
    let near = |height: &f64| (height - 0.1e-6).abs() < 1.2e-19;
    assert!(
        map.blocks[1..]
            .iter()
            .all(|height| *height == map.blocks[1] && near(height))
    );
}

/// An incompletely described height map is refused with the error and the remedy.
#[test_case("map.npy", OWN, "gives no pixel size: add `pixel_size`")]
#[test_case(
    "map.png", HeightMapUnits { pixel: SIZE, ..OWN },
    "gives no unit of height: add `height_unit`"
)]
#[test_case(
    "map.gsf", HeightMapUnits { pixel: Some([0.6e-6; 2]), ..OWN },
    "gives a pixel size of 500 nm x 500 nm: leave out `pixel_size`"
)]
#[test_case("map.x3p", HeightMapUnits { height: Some(1e-6), ..OWN }, "in units of 1 m: leave out `height_unit`")]
#[test_case("grey8.png", OWN, "grey levels of 8 bits, too coarse")]
#[test_case("colours.png", OWN, "is a colour picture, which has no heights")]
#[test_case("colours.tif", OWN, "is a colour picture, which has no heights")]
fn what_cannot_be_known_is_refused(name: &str, units: HeightMapUnits, sentence: &str) {
    let said = read(&folder().join(name), units, [15, 10])
        .unwrap_err()
        .to_string();
    assert!(said.contains(sentence), "{said}");
}

#[test]
fn the_aspect_is_kept() {
    let path = folder().join("map.x3p");
    for blocks in [[15, 10], [16, 11], [15, 11], [14, 9]] {
        // 11 rows require 16.5 columns, 9 require 13.5, and 10 require 15: half a block is rounding.
        assert_eq!(read(&path, OWN, blocks).is_ok(), blocks != [15, 11], "{blocks:?}");
    }
    let said = read(&path, OWN, [25, 25]).unwrap_err().to_string();
    let sentence = "is 15 um x 10 um, 1.5 times as wide as high, and the 25 x 25 blocks of the slider are 1 times as wide as high: cut the \
                    map, or take 38 x 25 blocks there";
    assert!(said.contains(sentence), "{said}");
}

/// Tag of the width of a tile.
const TILE_WIDTH: u16 = 322;

/// A TIFF file of grey levels 1, 2 and, in the row below, 3, 4, with changes to its tags, each a number of 16
/// or 32 bits.
fn tiff(changes: &[(u16, u32)]) -> Vec<u8> {
    let pixels = [1_u16, 2, 3, 4].map(u16::to_le_bytes);
    let (header, length) = (8, 8);
    let mut tags = std::collections::BTreeMap::from([
        (256, 2),
        (257, 2),
        (258, 16),
        (259, 1),
        (262, 1),
        (273, header),
        (277, 1),
        (278, 2),
        (279, length),
    ]);
    tags.extend(changes.iter().copied());
    // A file with tiles has no strips.
    if tags.contains_key(&TILE_WIDTH) {
        tags.retain(|tag, _| ![273, 278, 279].contains(tag));
    }
    let mut bytes = b"II*\0".to_vec();
    bytes.extend((header + length).to_le_bytes());
    bytes.extend(pixels.as_flattened());
    bytes.extend((tags.len() as u16).to_le_bytes());
    let four_bytes: u16 = 4;
    for (tag, value) in tags {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(four_bytes.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend([0; 4]);
    bytes
}

/// A single strip may have more rows than its picture.
#[test]
fn tiff_files_have_one_strip_and_one_orientation() {
    const ROWS_PER_STRIP: u16 = 278;
    const ORIENTATION: u16 = 274;
    for changes in [
        &[][..],
        &[(ROWS_PER_STRIP, u32::MAX)],
        &[(ROWS_PER_STRIP, 3), (ORIENTATION, 1)],
    ] {
        let map = read_bytes("a.tif", &tiff(changes)).unwrap();
        for (found, wanted) in map.blocks.iter().zip([3.0, 4.0, 1.0, 2.0]) {
            // Rounding of numbers of 4 um.
            assert!((found - 1e-6 * wanted).abs() < 1e-21, "{changes:?}: {found}");
        }
    }
    for other in [0, 3, 8] {
        let said = read_bytes("a.tif", &tiff(&[(ORIENTATION, other)])).unwrap_err();
        let sentence = format!("says by `Orientation` = {other} that it is to be turned or mirrored");
        assert!(said.to_string().contains(&sentence), "{said}");
    }
}

/// All columns of a tile are decoded, including those outside the picture.
#[test]
fn tiles_far_wider_than_their_picture_are_refused() {
    let tiles = |width| {
        // Height, place and length of the tile.
        let tags = [(TILE_WIDTH, width), (323, 16), (324, 8), (325, 8)];
        read_bytes("a.tif", &tiff(&tags)).unwrap_err().to_string()
    };
    let sentence =
        "has tiles 1040 pixels wide and is 2 wide itself: save it in strips, or in tiles of at most 1024";
    assert!(tiles(1040).contains(sentence), "{}", tiles(1040));
    assert!(!tiles(1024).contains("pixels wide"), "{}", tiles(1024));
}

/// Pictures of grey levels and opacity do not count as colour pictures.
#[test]
fn what_stands_beside_grey_levels_is_told() {
    const SAMPLES_PER_PIXEL: u16 = 277;
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 2, 2);
    encoder.set_color(png::ColorType::GrayscaleAlpha);
    encoder.set_depth(png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0; 16]).unwrap();
    writer.finish().unwrap();
    let tiff = tiff(&[(SAMPLES_PER_PIXEL, 2)]);
    for (name, bytes) in [("a.png", png), ("a.tif", tiff)] {
        let said = read_bytes(name, &bytes).unwrap_err().to_string();
        assert!(
            said.contains("has grey levels with a second channel, such as opacity (alpha)"),
            "{said}"
        );
    }
}

const MASKED: &str = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink><ValidPointsLink>valid.bin</ValidPointsLink></DataLink>";

/// A zip archive of uncompressed files.
fn zip(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, contents) in files {
        let (mut entry, config) = archive.new_file(name).start().unwrap();
        let mut writer = config.wrap(&mut entry);
        writer.write_all(contents).unwrap();
        let (_, descriptor) = writer.finish().unwrap();
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

/// `main.xml` of two by two points.
fn description(z_axis: &str, record3: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><FeatureType>SUR</FeatureType>\
         <Axes><CX><AxisType>I</AxisType><Increment>1e-6</Increment></CX><CY><AxisType>I</AxisType><Increment>1e-6</Increment></CY>\
         <CZ><AxisType>A</AxisType>{z_axis}</CZ></Axes></Record1><Record3><MatrixDimension><SizeX>2</SizeX><SizeY>2</SizeY>\
         <SizeZ>1</SizeZ></MatrixDimension>{record3}</Record3></p:ISO5436_2>"
    )
}

const LINKED: &str = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink>";

/// Reads a file for four blocks, with given units for an array, which states none.
fn read_bytes(name: &str, bytes: &[u8]) -> Result<HeightMap, ArrayError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let units = match name {
        "a.csv" | "a.png" | "a.tif" => HeightMapUnits {
            height: Some(1e-6),
            pixel: SIZE,
        },
        _ => OWN,
    };
    read(&path, units, [2, 2])
}

/// Integers have a step and an offset. The first row is at the top.
#[test]
fn x3p_files_have_heights_of_four_types() {
    let read = |z: &str, heights: &[u8]| {
        let xml = description(z, LINKED);
        let bytes = zip(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", heights)]);
        read_bytes("a.x3p", &bytes).unwrap()
    };
    let z = "<DataType>I</DataType><Increment>1e-9</Increment><Offset>1e-6</Offset>";
    let map = read(z, [-1000i16, 0, 1, 2000].map(i16::to_le_bytes).as_flattened());
    for (found, wanted) in map.blocks.iter().zip([1.001e-6, 3e-6, 0.0, 1e-6]) {
        // Rounding of numbers of 1e-6.
        assert!((found - wanted).abs() < 1e-21, "{found} {wanted}");
    }
    let z = "<DataType>L</DataType><Increment>1e-9</Increment>";
    let map = read(z, [-1i32, 0, 70_000, 2].map(i32::to_le_bytes).as_flattened());
    // Rounding of a number of 1e-4.
    assert!((map.blocks[0] - 70e-6).abs() < 1e-19);
}

#[test]
fn damaged_x3p_files_are_refused() {
    let floats = "<DataType>D</DataType>";
    let heights: Vec<u8> = [0.0, 1e-6, 2e-6, f64::NAN]
        .iter()
        .flat_map(|z: &f64| z.to_le_bytes())
        .collect();
    let flat = [0; 32];
    let whole = description(floats, LINKED);
    let masked = description(floats, MASKED);
    for (files, sentence) in [
        (vec![("a.txt", &b""[..])], "its archive has no `main.xml`"),
        (
            vec![("main.xml", whole.as_bytes())],
            "its archive has no `bindata/data.bin`",
        ),
        (
            vec![
                ("main.xml", whole.as_bytes()),
                ("bindata/data.bin", &heights[..31]),
            ],
            "is not a readable .x3p file: `bindata/data.bin`",
        ),
        (
            vec![("main.xml", whole.as_bytes()), ("bindata/data.bin", &[0; 40])],
            "`bindata/data.bin` is longer than it should be",
        ),
        (
            vec![("main.xml", whole.as_bytes()), ("bindata/data.bin", &heights)],
            "has NaN in row 1, column 1 (both counted from 0), but must have a height: fill missing points",
        ),
        (
            vec![
                ("main.xml", masked.as_bytes()),
                ("bindata/data.bin", &flat),
                ("valid.bin", &[0b1011]),
            ],
            "says that point 2 (counted from 0) was not measured",
        ),
        (vec![("main.xml", b"<a>")], "`main.xml` is no XML"),
        (
            vec![("main.xml", b"<a/>")],
            "`main.xml` has no Record1/FeatureType",
        ),
    ] {
        let said = read_bytes("a.x3p", &zip(&files)).unwrap_err().to_string();
        assert!(said.contains(sentence), "{said}\nlacks\n{sentence}");
    }
    for (z, record3, sentence) in [
        (floats, "<DataList/>", "has its heights as text in `main.xml`"),
        (
            "<DataType>Q</DataType>",
            LINKED,
            "its heights are of unknown type Q",
        ),
        (
            "<DataType>D</DataType><Increment>x</Increment>",
            LINKED,
            "Record1/Axes/CZ/Increment of `main.xml` is no number: x",
        ),
        (
            "<DataType>D</DataType><Increment>0</Increment>",
            LINKED,
            "Record1/Axes/CZ/Increment of `main.xml` is 0, and not above 0",
        ),
    ] {
        let bytes = zip(&[
            ("main.xml", description(z, record3).as_bytes()),
            ("bindata/data.bin", &flat),
        ]);
        let said = read_bytes("a.x3p", &bytes).unwrap_err().to_string();
        assert!(said.contains(sentence), "{said}\nlacks\n{sentence}");
    }
    let profile = whole.replace("SUR", "PRF");
    let said = read_bytes("a.x3p", &zip(&[("main.xml", profile.as_bytes())])).unwrap_err();
    assert!(
        said.to_string()
            .contains("has Record1/FeatureType PRF, where a surface has SUR")
    );
    let said = read_bytes("a.x3p", b"PK").unwrap_err().to_string();
    assert!(said.contains("it is no zip archive"), "{said}");
}

/// A parser that compares all names with each other takes minutes for 10 000 elements within 5000 namespaces.
#[test]
fn descriptions_with_thousands_of_names_are_read_to_their_end_or_to_a_limit() {
    let names = |count: usize, name: &dyn Fn(usize) -> String| (0..count).map(name).collect::<String>();
    let namespaces = names(5000, &|k| format!(" xmlns:n{k}='u:{k}'"));
    let elements = "<a xmlns:a='c'/>".repeat(10_000);
    let attributes = names(20_000, &|k| format!(" a{k} =\n\"\""));
    for (xml, sentence) in [
        (
            format!("<r{namespaces}>{elements}</r>"),
            "`main.xml` has no Record1/FeatureType",
        ),
        (
            format!("<r{attributes}/>"),
            "`main.xml` has no Record1/FeatureType",
        ),
        (
            format!("<r>{}</r>", "<a/>".repeat(100_000)),
            "`main.xml` has more than the 65536 elements, texts and attributes that may still be read",
        ),
    ] {
        let bytes = zip(&[("main.xml", xml.as_bytes())]);
        let said = read_bytes("a.x3p", &bytes).unwrap_err().to_string();
        assert!(said.contains(sentence), "{said}\nlacks\n{sentence}");
    }
}

#[test]
fn comments_and_texts_are_no_names_of_a_description() {
    let lines = format!("{}\n", "=".repeat(72)).repeat(100);
    let comments = format!("<!-- {lines} -->").repeat(5);
    let texts = format!("{comments}<Record2><![CDATA[{lines}]]><Comment a=\"1\">{lines}</Comment></Record2>");
    let whole = description("<DataType>D</DataType>", LINKED);
    let xml = whole.replace("<Record3>", &format!("{texts}<Record3>"));
    let bytes = zip(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &[0; 32])]);
    assert_eq!(read_bytes("a.x3p", &bytes).unwrap().blocks, [0.0; 4]);
}

/// Tests lines within a table and at its end, of height maps and of arrays.
#[test]
fn no_line_of_a_table_is_skipped() {
    let field = |text: &str| {
        let found = arrays::field(Path::new("a.csv"), &mut Cursor::new(text), &Slab::whole(2, 2));
        found.unwrap_err().to_string()
    };
    for (line, of_heights, of_blocks) in [
        (
            "*** sensor overload ***",
            "has `*** sensor overload ***` in line 2,",
            "1 numbers in line 2",
        ),
        ("NaN", "has 1 numbers in line 2", "1 numbers in line 2"),
        (
            "0.5,NaN",
            "has NaN in row 1, column 1",
            "has NaN in line 2, in row 1, column 1",
        ),
        (",0.5", "has an empty field in line 2,", "has `` in line 2,"),
        ("0.5", "has 1 numbers in line 2", "1 numbers in line 2"),
        ("0.5,1,2", "has 3 numbers in line 2", "3 numbers in line 2"),
    ] {
        for rest in ["\n0.5,1\n", "\n", ""] {
            let text = format!("0.5,1\n{line}{rest}");
            let said = read_bytes("a.csv", text.as_bytes()).unwrap_err().to_string();
            assert!(said.contains(of_heights), "{line}: {said}");
            assert!(field(&text).contains(of_blocks), "{line}: {}", field(&text));
        }
    }
}

#[test]
fn damaged_fields_and_tables_are_refused() {
    let field = |header: &str, numbers: usize| {
        let mut bytes = format!("Gwyddion Simple Field 1.0\n{header}").into_bytes();
        bytes.resize(bytes.len() / 4 * 4 + 4, 0);
        bytes.extend(vec![0; 4 * numbers]);
        bytes
    };
    let whole = "XRes = 2\nYRes = 2\nXReal = 2\nYReal = 2\nXYUnits = um\nZUnits = nm\n";
    assert_eq!(read_bytes("a.gsf", &field(whole, 4)).unwrap().size, [2e-6, 2e-6]);
    for (header, numbers, sentence) in [
        (whole, 3, "it has 104 bytes, but its header requires 108"),
        ("XRes = 2\nYRes = 0\n", 0, "it has 2 x 0 points"),
        ("XRes = 2\nYRes = x\n", 0, "it has no whole number `YRes`"),
        (
            "XRes = 2000000\nYRes = 2\n",
            0,
            "has 2000000 x 2 pixels; at most 268435456 pixels are read",
        ),
        (
            "XRes = 2\nYRes = 2\nXReal = -1\n",
            4,
            "`XReal` = -1 is no number above 0",
        ),
        (
            "XRes = 2\nYRes = 2\nXReal = 1\nYReal = 1\nXYUnits = m\nZUnits = V\n",
            4,
            "has `ZUnits` = V, which is no unit of length: export a map of heights",
        ),
        // Without a unit, a size has no meaning.
        (
            "XRes = 2\nYRes = 2\nXReal = 1\nYReal = 1\nZUnits = m\n",
            4,
            "add `pixel_size`",
        ),
        (
            "XRes = 2\nYRes = 2\nXReal = 1\nYReal = 1\nXYUnits = m\n",
            4,
            "add `height_unit`",
        ),
    ] {
        let said = read_bytes("a.gsf", &field(header, numbers))
            .unwrap_err()
            .to_string();
        assert!(said.contains(sentence), "{said}\nlacks\n{sentence}");
    }
    for (name, text, sentence) in [
        ("a.gsf", "Gwyddion Simple Field 2.0", "it does not begin with"),
        (
            "a.gsf",
            "Gwyddion Simple Field 1.0\nXRes = 1",
            "no zero byte ends its header",
        ),
        (
            "a.csv",
            "1,2\n3\n",
            "has 1 numbers in line 2, where the lines before have 2",
        ),
        ("a.csv", "# nothing\n", "it has 0 x 0 points"),
        ("a.csv", "1,nan\n", "has NaN in row 0, column 1"),
        (
            "a.csv",
            "1e300,0\n0,0\n",
            "has heights too far apart to be averaged",
        ),
        ("a.tif", "II*\0\x08\0\0\0", "is not a readable .tif file"),
        (
            "a.jpg",
            "",
            "give a file with the extension .npy, .csv (.txt, .dat, .asc, .xyz), .gsf, .x3p, .png or .tif",
        ),
    ] {
        let said = read_bytes(name, text.as_bytes()).unwrap_err().to_string();
        assert!(said.contains(sentence), "{said}\nlacks\n{sentence}");
    }
}

/// A case with the map on 15 x 10 blocks.
fn case(texture: &str) -> Result<Case, String> {
    let text = format!(
        "slider = {{ blocks = [15, 10], block_size = '1 um' }}\n[[texture]]\nshape = 'height_map'\nfile = 'map.x3p'\n{texture}"
    );
    Case::parse(&text, "case", folder(), &[]).map_err(|error| error.to_string())
}

fn heights() -> Vec<f64> {
    let reference = reference();
    let means = reference["blocks"]["15x10"].as_array().unwrap().iter();
    means.map(|mean| mean.as_f64().unwrap()).collect()
}

/// 40 % of 150 blocks are the 60 highest; a depth is measured from the highest block or from a given height.
#[test]
fn the_highest_blocks_touch() {
    let heights = heights();
    let mut sorted = heights.clone();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let touching = |texture: &str| -> Vec<bool> {
        let case = case(texture).unwrap();
        case.model
            .surface
            .textured
            .iter()
            .map(|textured| !textured)
            .collect()
    };
    let above = |least: f64| -> Vec<bool> { heights.iter().map(|height| *height >= least).collect() };
    // Between two blocks, because heights are rounded when read.
    let between = |rank: usize| 0.5 * (sorted[rank] + sorted[rank + 1]);
    let highest = touching("bearing_percent = 40");
    assert_eq!(highest.iter().filter(|&&touches| touches).count(), 60);
    assert_eq!(highest, above(between(59)));
    let depth = sorted[0] - between(19);
    assert_eq!(touching(&format!("depth = '{depth} m'")), above(between(19)));
    let reference = "reference = '5.5 um'\ndepth = '500 nm'";
    assert_eq!(touching(reference), above(5e-6));
    let inverted = touching("bearing_percent = 40\ninvert = true");
    assert!(inverted.iter().zip(&highest).all(|(one, other)| one != other));

    let case = case("bearing_percent = 40").unwrap();
    assert_eq!(case.texture.asked_percent, Some(60.0));
    let [topography] = &case.texture.topographies[..] else {
        panic!("{:?}", case.texture);
    };
    assert!((topography.contact_height - sorted[59]).abs() < 1e-15);
    assert_eq!(topography.points, [30, 20]);
    assert!(case.warnings().iter().all(|warning| !warning.contains("map.x3p")));
}

#[test]
fn maps_fill_every_place_of_a_pattern() {
    let text = "slider = { blocks = [30, 10], block_size = '1 um' }\n[[texture]]\nshape = 'height_map'\nfile = 'map.gsf'\n\
                bearing_percent = 40\narray = [2, 1]";
    let two = Case::parse(text, "case", folder(), &[]).unwrap();
    let one = case("bearing_percent = 40").unwrap();
    for (b, textured) in two.model.surface.textured.iter().enumerate() {
        assert_eq!(
            *textured,
            one.model.surface.textured[b / 30 * 15 + b % 15],
            "block {b}"
        );
    }
    assert_eq!(two.texture.asked_percent, Some(60.0));
    let three = Case::parse(&text.replace("[2, 1]", "[3, 1]"), "case", folder(), &[]);
    let said = three.unwrap_err().to_string();
    let sentence = "and the 10 x 10 blocks in every place of the pattern are 1 times as wide as high: cut the map, or take 15 x 10 blocks there";
    assert!(said.contains(sentence), "{said}");
}

/// A disc of 20 x 20 blocks over a map that rises from its middle, without equal heights.
fn on_a_disc(texture: &str, ranks: usize) -> Vec<Case> {
    let folder = tempfile::tempdir().unwrap();
    let height =
        |i: i32, j: i32| f64::from((2 * i - 19).pow(2) + (2 * j - 19).pow(2)) + 1e-3 * f64::from(20 * j + i);
    let rows = (0..20).map(|j| {
        (0..20)
            .map(|i| height(i, j).to_string())
            .collect::<Vec<_>>()
            .join(",")
    });
    std::fs::write(folder.path().join("map.csv"), rows.collect::<Vec<_>>().join("\n")).unwrap();
    let text = format!(
        "slider = {{ blocks = [20, 20], outline = 'disc', block_size = '1 um' }}\n[[texture]]\nshape = 'height_map'\nfile = 'map.csv'\n\
         height_unit = '1 nm'\npixel_size = '1 um'\n{texture}"
    );
    Threads::run(ranks, |communicator| {
        let ranks = Ranks {
            communicator,
            on_node: ranks,
        };
        let file = CaseFile::parse(&text, "case", &[]).unwrap();
        Case::to_run(file, "case", folder.path(), &mut |_| true, ranks).unwrap()
    })
}

/// Blocks that do not exist do not count: half of the lattice's blocks would be more than all blocks of the
/// disc.
#[test]
fn blocks_that_do_not_exist_have_no_share() {
    for ranks in [1, 3] {
        let touching = |cases: &[Case]| -> usize {
            let of_rank = |case: &Case| {
                let exists = &case.model.slider().outline.as_ref().unwrap().exists;
                let blocks = case.model.surface.textured.iter().zip(exists);
                blocks
                    .filter(|(textured, exists)| **exists && !**textured)
                    .count()
            };
            cases.iter().map(of_rank).sum()
        };
        let half = on_a_disc("bearing_percent = 50", ranks);
        assert_eq!(half[0].model.n_blocks(), 316);
        assert_eq!(touching(&half), 158, "{ranks} ranks");
        assert_eq!(half[0].texture.asked_percent, Some(50.0));
        assert_eq!(half[0].texture.meshed_percent, 50.0);
        // From the highest block of the disc, at a distance 2 r of at most 20 and lower than the corners.
        let depth = on_a_disc("depth = '100 nm'", ranks);
        let contact_height = depth[0].texture.topographies[0].contact_height;
        assert!((250e-9..300.4e-9).contains(&contact_height), "{contact_height}");
        // A quarter of each of four copies lies in the middle; two of their outer corners are cut off.
        let four = on_a_disc("bearing_percent = 50\narray = [2, 2]", ranks);
        assert_eq!(four[0].texture.asked_percent, Some(50.0));
        // Copies have equal heights, which touch together.
        assert!((158..162).contains(&touching(&four)), "{}", touching(&four));
    }
}

/// At least one block touches, even for a share of less than half a block.
#[test]
fn one_block_touches_at_the_least() {
    let case = case("bearing_percent = 0.1").unwrap();
    let touching = case.model.surface.textured.iter().filter(|textured| !**textured);
    assert_eq!(touching.count(), 1);
    assert!(case.texture.topographies[0].contact_height.is_finite());
}

#[test]
fn a_map_of_another_size_is_told() {
    let said = warnings_of(
        "slider = { blocks = [15, 10], block_size = '10 um' }",
        "bearing_percent = 40",
    );
    let sentence = "map.x3p is 15 um x 10 um and is stretched over 150 um x 100 um of the slider, 10 times its size; with `block_size` = \"1 um\" \
                    it keeps its size";
    assert!(said.contains(sentence), "{said}");
    let said = warnings_of(
        "slider = { blocks = [60, 40], block_size = '0.25 um' }",
        "bearing_percent = 40",
    );
    assert!(
        said.contains("has 30 x 20 points for 60 x 40 blocks: several blocks share a height"),
        "{said}"
    );
    // If a length is given for the places, other block sizes do not change it.
    let slider = "slider = { blocks = [60, 40], block_size = '1 um' }";
    for (pitch, own) in [
        ("pitch = ['30 um', '20 um']", "`pitch` = [\"15 um\", \"10 um\"]"),
        ("array = [2, 2]", "`block_size` = \"500 nm\""),
    ] {
        let said = warnings_of(slider, &format!("bearing_percent = 40\n{pitch}"));
        let sentence = format!("of the slider, 2 times its size; with {own} it keeps its size");
        assert!(said.contains(&sentence), "{said}");
    }
}

fn warnings_of(text: &str, texture: &str) -> String {
    let text = format!("{text}\n[[texture]]\nshape = 'height_map'\nfile = 'map.x3p'\n{texture}");
    let case = Case::parse(&text, "case", folder(), &[]).unwrap();
    case.warnings().join("\n")
}

/// A difference from the requested texture is described in terms of heights, not as clipped or off the
/// slider.
#[test]
fn a_texture_that_is_not_as_asked_is_told_in_words_of_heights() {
    let folder = tempfile::tempdir().unwrap();
    let said = |lowest: &str, bearing: &str| {
        std::fs::write(
            folder.path().join("map.csv"),
            format!("{lowest}\n2,2\n2,2\n2,2\n"),
        )
        .unwrap();
        let text = format!(
            "slider.blocks = [2, 4]\n[[texture]]\nshape = 'height_map'\nfile = 'map.csv'\nheight_unit = '1 um'\npixel_size = '1 um'\n\
             {bearing}"
        );
        let case = Case::parse(&text, "case", folder.path(), &[]).unwrap();
        case.warnings().join("\n")
    };
    for (lowest, bearing, sentence) in [
        (
            "2,2",
            "bearing_percent = 40",
            "texture 1 covers no block: none is lower than the lowest that touch; lower `bearing_percent`",
        ),
        (
            "1,1",
            "depth = '2 um'",
            "texture 1 covers no block: none is below the height of contact; lower `depth`",
        ),
        (
            "1,1",
            "bearing_percent = 40",
            "the texture covers 25.00 % of the blocks instead of 60.00 %: blocks of equal height are in contact together",
        ),
    ] {
        let said = said(lowest, bearing);
        assert!(said.contains(sentence), "{said}");
    }
}

/// The case in the run folder names a copy of the map, and is the same case.
#[test]
fn a_map_is_an_input_like_any_other() {
    let case = case("bearing_percent = 40").unwrap();
    let [input] = &case.inputs[..] else {
        panic!("{:?}", case.inputs)
    };
    assert_eq!(input.name, "inputs/map.x3p");
    assert_eq!(
        input.length,
        std::fs::metadata(folder().join("map.x3p")).unwrap().len()
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("inputs")).unwrap();
    std::fs::copy(&input.original, folder.path().join(&input.name)).unwrap();
    let again = Case::parse(&case.file.to_toml().unwrap(), "case", folder.path(), &[]).unwrap();
    assert_eq!(again.file, case.file);
    assert_eq!(again.model.surface.textured, case.model.surface.textured);
    assert_eq!(again.inputs[0].hash, input.hash);
}

/// A file with more pixels per block than arrays have is an error for a mask, but not for a height map.
#[test]
fn a_height_map_may_be_finer_than_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let row = vec!["1.00000000000000000"; 3000].join(",");
    std::fs::write(folder.path().join("map.csv"), format!("{row}\n").repeat(30)).unwrap();
    let text = "slider.blocks = [100, 1]\n[[texture]]\nshape = 'height_map'\nfile = 'map.csv'\ndepth = '1 nm'\nheight_unit = '1 um'\n\
                pixel_size = '1 um'";
    let case = Case::parse(text, "case", folder.path(), &[]).unwrap();
    assert_eq!(case.texture.topographies[0].roughness.sq, 0.0);
    assert_eq!(case.texture.topographies[0].roughness.ssk, None);
    let field = "slider.blocks = [100, 1]\nfriction.mu_static_field = 'map.csv'";
    let said = Case::parse(field, "case", folder.path(), &[])
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("bytes where 1 rows of 100 numbers take at most"),
        "{said}"
    );
    std::fs::write(
        folder.path().join("mask.png"),
        png_of_mask(2, 2, &[true; 4]).unwrap(),
    )
    .unwrap();
    let mask = text.replace("map.csv", "mask.png");
    let said = Case::parse(&mask, "case", folder.path(), &[])
        .unwrap_err()
        .to_string();
    assert!(said.contains("grey levels of 1 bits"), "{said}");
}

/// Units for a file that states none.
const OF_CASE: HeightMapUnits = HeightMapUnits {
    height: Some(1e-6),
    pixel: SIZE,
};

fn read_here(name: &str, units: HeightMapUnits, blocks: [usize; 2]) -> HeightMap {
    read(&folder().join(name), units, blocks).unwrap()
}

/// The text export of Gwyddion states its size and its unit in comments, and begins with the top row. It is
/// the surface of the simple field of the same data. That one is rounded to 2^-24, and this one to five
/// digits: heights of 2e-7 m to 5e-12 m.
#[test]
fn the_text_export_of_gwyddion_is_its_simple_field() {
    let [text, field] = ["gwyddion.csv", "gwyddion.gsf"].map(|name| read_here(name, OWN, [20, 20]));
    assert_eq!((text.points, field.points), ([20, 20], [20, 20]));
    for (of_text, of_field) in text.blocks.iter().zip(&field.blocks) {
        assert!((of_text - of_field).abs() < 6e-12, "{of_text} {of_field}");
    }
    assert!((text.size[0] - 1e-5).abs() < 1e-18);
}

/// One file has decimal commas and semicolons, the other is in UTF-16.
#[test]
fn tables_of_any_encoding_and_decimal_sign_are_one_map() {
    let [commas, utf_16] = ["decimal_comma.csv", "utf16.csv"].map(|name| read_here(name, OF_CASE, [20, 20]));
    assert_eq!(commas.roughness, utf_16.roughness);
    // numpy: mean |z - mean z| of the table.
    assert!(
        (commas.roughness.sa - 8.466e-8).abs() < 5e-12,
        "to the digits of the reference: {}",
        commas.roughness.sa
    );
}

#[test]
fn a_list_of_points_on_a_grid_is_a_map() {
    let map = read_here("points.csv", OF_CASE, [4, 4]);
    assert_eq!(map.points, [4, 4]);
    // The first points of the list are at the smallest y.
    for (height, wanted) in map
        .blocks
        .iter()
        .zip([0.0, -0.14e-6, 0.1939e-6, -0.0376e-6, -0.0769e-6])
    {
        assert!((height - wanted).abs() < 1e-15, "{height} {wanted}");
    }
}

#[test_case("tilted.csv", OF_CASE, [20, 20], "a plane contains 100 % of the variance"; "tilt")]
#[test_case("other_md5.x3p", OWN, [50, 50], "the checksum of its heights is "; "checksum")]
fn what_makes_a_map_doubtful_is_said(name: &str, units: HeightMapUnits, blocks: [usize; 2], note: &str) {
    let map = read_here(name, units, blocks);
    assert!(
        map.notes.len() == 1 && map.notes[0].starts_with(note),
        "{:?}",
        map.notes
    );
}

#[test]
fn files_of_an_x3p_archive_may_lie_in_a_folder() {
    let [plain, in_folder] = ["other_md5.x3p", "in_folder.x3p"].map(|name| read_here(name, OWN, [50, 50]));
    assert_eq!(plain.blocks, in_folder.blocks);
}

/// A text map with values in micrometres and a pixel of half a micrometre, over as many blocks as it has
/// points.
fn prepared(text: &str, preparation: Preparation) -> Result<HeightMap, String> {
    let lines = text
        .lines()
        .filter(|line| line.starts_with(|sign: char| sign.is_ascii_digit()));
    let blocks = [text.lines().last().unwrap().split(',').count(), lines.count()];
    let room = Room {
        blocks,
        is_place: false,
    };
    let mut source = Cursor::new(text);
    height_map(Path::new("a.csv"), &mut source, &OF_CASE, &preparation, &room)
        .map_err(|error| error.to_string())
}

/// Heights 2 x + 3 y plus a checkerboard of 0 and 1, of four rows of four. A checkerboard of this size has no
/// mean slope along x or y, because the contributions cancel.
#[test]
fn a_map_is_levelled_by_its_plane() {
    let board = |x: usize, y: usize| ((x / 2 + y / 2) % 2) as f64;
    let row = |y: usize| {
        let heights = (0..4).map(|x| (2.0 * x as f64 + 3.0 * y as f64 + board(x, y)).to_string());
        heights.collect::<Vec<_>>().join(",") + "\n"
    };
    let text: String = (0..4).map(row).collect();
    let level = Preparation {
        is_levelled: true,
        ..Preparation::default()
    };
    let map = prepared(&text, level).unwrap();
    let mean = map.blocks.iter().sum::<f64>() / 16.0;
    for (at, height) in map.blocks.iter().enumerate() {
        let wanted = 1e-6 * (board(at % 4, at / 4) - 0.5);
        // Rounding: sixteen numbers below 20 um are added, with errors of 2^-53 each.
        assert!((height - mean - wanted).abs() < 1e-19, "{at}: {height}");
    }
    assert!((map.roughness.sa - 0.5e-6).abs() < 1e-19);
    assert!(map.notes.is_empty(), "{:?}", map.notes);
    assert!(prepared(&text, Preparation::default()).unwrap().notes[0].starts_with("a plane contains"));
}

#[test_case("0,1,-999,3\n4,5,6,9\n", -999.0; "number")]
#[test_case("0,1,nan,3\n4,5,6,9\n", f64::NAN; "no number")]
fn points_that_were_not_measured_count_for_nothing(text: &str, missing: f64) {
    let preparation = Preparation {
        missing: Some(missing),
        ..Preparation::default()
    };
    let room = Room {
        blocks: [2, 1],
        is_place: false,
    };
    let mut source = Cursor::new(text);
    let map = height_map(Path::new("a.csv"), &mut source, &OF_CASE, &preparation, &room).unwrap();
    // The mean of 0, 1, 4 and 5, and of 3, 6 and 9, in micrometres.
    assert_eq!(map.blocks, [2.5 * 1e-6, 6.0 * 1e-6]);
    let note = "1 of its 8 points were not measured: blocks have the mean of the others";
    assert_eq!(map.notes[0], note);
    let refused = prepared(text, preparation).unwrap_err();
    assert!(
        refused.contains("no measured point in the block in column 2 and row 0"),
        "{refused}"
    );
}

#[test]
fn points_that_an_x3p_leaves_out_may_be_missing() {
    let masked = description("<DataType>D</DataType>", MASKED);
    let heights: Vec<u8> = [1.0_f64, 2.0, 3.0, 4.0]
        .iter()
        .flat_map(|z| z.to_le_bytes())
        .collect();
    let bytes = zip(&[
        ("main.xml", masked.as_bytes()),
        ("bindata/data.bin", &heights),
        ("valid.bin", &[0b1011]),
    ]);
    let room = Room {
        blocks: [1, 1],
        is_place: false,
    };
    let preparation = Preparation {
        missing: Some(f64::NAN),
        ..Preparation::default()
    };
    let map = height_map(
        Path::new("a.x3p"),
        &mut Cursor::new(&bytes),
        &OWN,
        &preparation,
        &room,
    )
    .unwrap();
    // The third point is NaN; the sum has one more division than 7/3.
    assert!((map.blocks[0] - 7.0 / 3.0).abs() < 1e-15);
}

#[test_case("h=2 w=3\n1,2,4\n3,5,9\n", "rows of numbers begin in line 2; 1 line above ignored, \"h=2 w=3\""; "size")]
#[test_case("Width,3\nUnit,um\n\n1,2,4\n3,5,9\n", "rows of numbers begin in line 4; 2 lines above ignored, \"Width,3\""; "instrument")]
fn lines_above_a_matrix_are_passed_over_and_told(text: &str, note: &str) {
    let map = prepared(text, Preparation::default()).unwrap();
    assert_eq!(map.points, [3, 2]);
    assert_eq!(map.notes[0], note);
}

#[test]
fn a_first_row_of_coordinates_is_told() {
    let axis: Vec<String> = (0..9).map(|x| (0.5 * f64::from(x)).to_string()).collect();
    let heights: Vec<String> = (0..9).map(|x| (x * x % 5).to_string()).collect();
    let text = format!("{}\n{}\n", axis.join(","), heights.join(","));
    let notes = prepared(&text, Preparation::default()).unwrap().notes;
    assert!(
        notes[0].starts_with("its first row goes evenly from 0.5 to 4"),
        "{notes:?}"
    );
}

#[test]
fn a_list_may_leave_points_out_and_has_none_twice() {
    let list = |text: &str, missing| {
        let preparation = Preparation {
            missing,
            ..Preparation::default()
        };
        let room = Room {
            blocks: [1, 1],
            is_place: false,
        };
        let map = height_map(
            Path::new("a.csv"),
            &mut Cursor::new(text),
            &OF_CASE,
            &preparation,
            &room,
        );
        map.map_err(|error| error.to_string())
    };
    let text = "X,Y,Z\n0,0,1\n1,0,2\n0,1,6\n";
    assert_eq!(list(text, Some(f64::NAN)).unwrap().blocks, [3.0 * 1e-6]);
    assert!(
        list(text, None)
            .unwrap_err()
            .contains("has NaN in row 1, column 1")
    );
    let twice = list("0,0,1\n1,0,2\n0,1,6\n0,0,1\n", None).unwrap_err();
    assert!(twice.contains("has the point 0, 0 twice"), "{twice}");
}

#[test]
fn a_map_that_can_be_read_in_two_ways_is_refused_until_its_case_says_which() {
    let text = "1,050 1,051\n1,052 1,054\n";
    let said = prepared(text, Preparation::default()).unwrap_err();
    assert!(
        said.contains("can be read in two ways: \"1,050\" in line 1"),
        "{said}"
    );
    let mut preparation = Preparation::default();
    preparation.table.decimal = Some(',');
    let room = Room {
        blocks: [1, 1],
        is_place: false,
    };
    let mut source = Cursor::new(text);
    let map = height_map(Path::new("a.csv"), &mut source, &OF_CASE, &preparation, &room).unwrap();
    // The mean of four numbers in micrometres, rounded once.
    assert!((map.blocks[0] - 1.05175e-6).abs() < 1e-21);
}
