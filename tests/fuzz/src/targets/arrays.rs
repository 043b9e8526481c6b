//! Arrays and images that a case names.

use std::io::{Cursor, Write};
use std::path::Path;

use png::{BitDepth, ColorType, Encoder};
use slipfront_case::arrays;
use slipfront_case::arrays::{ArrayError, HeightMapUnits, Preparation, Room, Slab, mask_npy, png_of_mask};

use crate::checks::readable;
use crate::long::{LONG_BYTES, many, nested};
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The lattice that arrays are read for: not square, so that exchanged rows and columns are noticed.
const NX: usize = 3;
const NY: usize = 2;

/// Arrays of numpy: coefficients, masks, and the last states of runs.
pub(crate) const NPY: Target = Target {
    name: "npy",
    check: npy,
    generated: npy_files,
    files: &[],
    dictionary: Some("npy.dict"),
    max_bytes: 1024,
    // Headers of at most 10 000 bytes, twice in memory and as a tree.
    memory: Memory {
        bytes: 1 << 20,
        per_byte: 512,
    },
    time: Time::READING,
    mutations: 3000,
    repetitions: 20,
    long: long_headers,
};

/// Tables of numbers as text.
pub(crate) const CSV_TABLE: Target = Target {
    name: "csv_table",
    check: csv_table,
    generated: tables,
    files: &["cases/mu_s.csv"],
    dictionary: Some("table.dict"),
    max_bytes: 1024,
    // A line of nothing but separators is as many empty fields, of 16 bytes each in two lists that grow.
    memory: Memory {
        bytes: 256 << 10,
        per_byte: 128,
    },
    time: Time::READING,
    mutations: 3000,
    repetitions: 20,
    long: long_tables,
};

/// Masks as images.
pub(crate) const MASK_PNG: Target = Target {
    name: "mask_png",
    check: mask_png,
    generated: images,
    files: &["cases/herringbone.png", "docs/images/texture-mask.png"],
    dictionary: Some("png.dict"),
    max_bytes: 8192,
    // The decoder's own buffers, some rows of the image: it may be a single one, with 8 x 1040 pixels in a
    // byte of the file.
    memory: Memory {
        bytes: 4 << 20,
        per_byte: 2 * 8 * 1040,
    },
    time: Time::DRAWN,
    mutations: 500,
    repetitions: 20,
    long: long_images,
};

/// Height maps, read as each of their formats.
pub(crate) const HEIGHT_MAP: Target = Target {
    name: "height_map",
    check: height_map,
    generated: || {
        vec![
            b"Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 1\nZUnits = nm\n\0\0\0\x01\0\0\0\x02\0\0\0"
                .to_vec(),
        ]
    },
    files: &[
        "crates/slipfront-case/tests/heights/map.csv",
        "crates/slipfront-case/tests/heights/map.gsf",
        "crates/slipfront-case/tests/heights/map.npy",
        "crates/slipfront-case/tests/heights/map.png",
        "crates/slipfront-case/tests/heights/map.tif",
        "crates/slipfront-case/tests/heights/map.x3p",
        "crates/slipfront-case/tests/heights/map_lzw.tif",
        "crates/slipfront-case/tests/heights/map_tiles.tif",
        "crates/slipfront-case/tests/heights/colours.tif",
    ],
    dictionary: None,
    max_bytes: 8192,
    // A strip or tile of a TIFF file has 64 MiB, packed and unpacked; a line of a picture may be all of it.
    memory: Memory {
        bytes: 160 << 20,
        per_byte: 2 * 8 * 1040,
    },
    time: Time::DRAWN,
    mutations: 700,
    repetitions: 20,
    long: long_maps,
};

fn npy_files() -> Vec<Vec<u8>> {
    let header = |descr: &str, order: &str, shape: &str, version: u8| {
        let mut text = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}");
        while (10 + text.len() + 1) % 16 != 0 {
            text.push(' ');
        }
        text.push('\n');
        let mut bytes = b"\x93NUMPY".to_vec();
        bytes.extend([version, 0]);
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(if version > 1 { vec![0; 2] } else { Vec::new() });
        bytes.extend(text.as_bytes());
        bytes
    };
    let file = |descr: &str, order: &str, data: &[u8], version| {
        [
            header(&format!("'{descr}'"), order, "(2, 3)", version),
            data.to_vec(),
        ]
        .concat()
    };
    let numbers: Vec<u8> = [0.0, 1.0, 2.5, 0.25, 4.0, 1e-3f64]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let mut files = vec![
        file("<f8", "False", &numbers, 1),
        file("<f8", "True", &numbers, 2),
        file("<f8", "False", &numbers, 3),
        header("[('a', '<f8')]", "False", "(2, 3)", 1),
        [header("'<f8'", "False", "(4, 2, 3)", 1), numbers.repeat(4)].concat(),
    ];
    for descr in [
        "|b1", "|u1", "|i1", "<u2", ">i2", "<i4", ">u4", "<i8", ">u8", "<f2", ">f4", ">f8", "<c16",
    ] {
        let size: usize = descr[2..].parse().unwrap();
        files.push(file(descr, "False", &vec![1; 6 * size], 1));
    }
    files
}

fn tables() -> Vec<Vec<u8>> {
    let texts = [
        "1.0,0.9,1.1\n0.8,1.2,1\n",
        "# mu_s\n1.0;0.9;1.1\n\n0.8;1.2;1",
        "1.0\t0.9\t1.1\r\n0.8\t1.2\t1\r\n",
        "  1.0  0.9   1.1\n  0.8  1.2  1e-3\n",
        "\"1.0\",0.9,+1.1\n0.8,1.2,0.0\n",
        "1,5;2,5;3,5\n1;2;3\n",
        "1,2,nan\n1,2,-3\n",
    ];
    texts.map(|text| text.as_bytes().to_vec()).into()
}

/// Headers of arrays with many keys, lengths and brackets.
fn long_headers() -> Vec<Vec<u8>> {
    let texts = [
        many("{", "'a#': 1, ", "}"),
        many(
            "{'descr': '",
            "<f8",
            "', 'fortran_order': False, 'shape': (2, 3), }",
        ),
        many(
            "{'descr': '<f8', 'fortran_order': False, 'shape': (",
            "1, ",
            "), }",
        ),
        nested("{'descr': ", "[", "", "]", "}"),
        nested("", "{'descr': ", "1", "}", ""),
        nested("", "(", "", ")", ""),
        many(
            "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }",
            " ",
            "\n",
        ),
    ];
    // As long as can be, and beyond.
    let lengths = [9000, LONG_BYTES];
    let file = |(text, length): (&Vec<u8>, usize)| {
        let text = &text[..text.len().min(length)];
        [b"\x93NUMPY\x02\0", &(text.len() as u32).to_le_bytes()[..], text].concat()
    };
    let all = texts.iter().flat_map(|text| lengths.map(|length| (text, length)));
    all.map(file).collect()
}

/// Tables with many lines, columns, comments and quotes, and with long numbers.
fn long_tables() -> Vec<Vec<u8>> {
    vec![
        many("", "1,2,3\n", ""),
        many("", "1,", "1\n1,2,3\n"),
        many("1,2,3\n", "1 ", "\n"),
        many("", "# a comment\n", "1,2,3\n4,5,6\n"),
        many("#", " a comment", "\n1,2,3\n4,5,6\n"),
        many("", "#", "\n1,2,3\n4,5,6\n"),
        many("", "\n", "1,2,3\n4,5,6\n"),
        many("", "\r", "1,2,3\n4,5,6\n"),
        many("", " \n", "1,2,3\n4,5,6\n"),
        many("", "\"", "\n1,2,3\n"),
        many("\"", "1,2,3\n", ""),
        many("1.", "0", ",2,3\n4,5,6\n"),
        many("", "0", "1,2,3\n4,5,6\n"),
        many("", " ", "1 2 3\n4 5 6\n"),
        many("", ";", ""),
        many("1,2,3\n", "*** sensor overload *** # ", "\n"),
    ]
}

/// Compressed zeros.
fn packed_zeros(count: usize) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(&vec![0; count]).unwrap();
    encoder.finish().unwrap()
}

/// Images with many chunks, or a large one, and as large as so many bytes can be.
fn long_images() -> Vec<Vec<u8>> {
    let seed = &images()[3];
    // Behind the signature and the header.
    let (begin, end) = seed.split_at(33);
    let chunks = |kind: &[u8; 4], data: &[u8], count: usize| {
        let chunk = [&(data.len() as u32).to_be_bytes()[..], kind, data, &[0; 4]].concat();
        with_checksums(&[begin, &chunk.repeat(count), end].concat())
    };
    let mut images = Vec::new();
    for kind in [
        b"tEXt", b"IDAT", b"prVt", b"gAMA", b"acTL", b"PLTE", b"tRNS", b"IHDR",
    ] {
        // The decoder makes room for 32 KiB at each of them.
        images.push(chunks(kind, b"", LONG_BYTES / 120));
    }
    let text = packed_zeros(1000 * LONG_BYTES);
    for kind in [b"tEXt", b"iCCP", b"zTXt", b"iTXt", b"PLTE", b"eXIf"] {
        images.push(chunks(kind, &[0; LONG_BYTES], 1));
        images.push(chunks(kind, &[b"a\0\0", &text[..]].concat(), 1));
    }
    // One bit a pixel: 2^28 pixels, in lines as long as can be and in as many.
    for (width, height) in [(1 << 20, 1 << 8), (1 << 8, 1 << 20)] {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, width, height);
        encoder.set_depth(BitDepth::One);
        encoder.set_color(ColorType::Grayscale);
        let mut writer = encoder.write_header().unwrap();
        let pixels = vec![0; (width / 8 * height) as usize];
        writer.write_image_data(&pixels).unwrap();
        writer.finish().unwrap();
        images.push(bytes);
    }
    images
}

/// Height maps with many of each thing that a format counts.
fn long_maps() -> Vec<Vec<u8>> {
    let mut maps = long_tables();
    let names = |piece: &str, count: usize| {
        (0..count)
            .map(|k| piece.replace('#', &k.to_string()))
            .collect::<String>()
    };
    let namespaces = names(" xmlns:n#='u:#'", 3000);
    let descriptions = [
        format!("<r{namespaces}>{}</r>", "<a xmlns:a='c'/>".repeat(4000)),
        format!("<r{}/>", names(" a#='1'", 20_000)),
        names("<r a='#'>", 20_000),
        format!("<r>{}</r>", "<a/>".repeat(200_000)),
        format!("<r>{}</r>", "&amp;".repeat(50_000)),
        format!("<r a='{}'/>", "&#65;".repeat(50_000)),
        format!("<r>{}</r>", "<![CDATA[a]]>".repeat(20_000)),
        format!("<r>{}</r>", "<!-- a -->".repeat(20_000)),
        format!("{}<r/>", "<?a b?>".repeat(20_000)),
        "<!".repeat(100_000),
        "<![CDATA[".repeat(30_000),
        "=".repeat(1 << 19),
    ];
    maps.extend(descriptions.map(|xml| zip(&[("main.xml".to_owned(), xml.into_bytes())])));
    let entries: Vec<_> = (0..4000).map(|k| (format!("a{k}"), Vec::new())).collect();
    maps.push(zip(&entries));
    maps.push(many("Gwyddion Simple Field 1.0\n", "Xres# = 2\n", "\0"));
    maps.push(many(
        "Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 1\nTitle = ",
        "=",
        "\n\0",
    ));
    maps.extend(long_tiffs());
    maps
}

/// A zip archive of these files.
fn zip(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, contents) in files {
        let file = archive
            .new_file(name)
            .compression_method(rawzip::CompressionMethod::DEFLATE);
        let (mut entry, config) = file.start().unwrap();
        let encoder = flate2::write::DeflateEncoder::new(&mut entry, flate2::Compression::fast());
        let mut writer = config.wrap(encoder);
        writer.write_all(contents).unwrap();
        let (encoder, descriptor) = writer.finish().unwrap();
        encoder.finish().unwrap();
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

/// A tag of a TIFF file with its numbers.
type TiffTag = (u16, Vec<u32>);

/// A picture of 16 bits with these tags more, whose `data` stands at byte 8; the next picture stands at
/// `next`, 0 for none.
fn tiff([width, height]: [u32; 2], own: Vec<TiffTag>, data: &[u8], next: u32) -> Vec<u8> {
    /// Type of a number of 32 bits.
    const LONG: u16 = 4;
    let of_all = [(256, width), (257, height), (258, 16), (262, 1), (277, 1)];
    let mut tags: Vec<TiffTag> = of_all.map(|(tag, value)| (tag, vec![value])).into();
    tags.extend(own);
    tags.sort_by_key(|(tag, _)| *tag);
    let start = 8 + data.len() as u32;
    let mut bytes = [b"II*\0", &start.to_le_bytes()[..], data].concat();
    bytes.extend((tags.len() as u16).to_le_bytes());
    let lists_start = start + 2 + 12 * tags.len() as u32 + 4;
    let mut lists: Vec<u8> = Vec::new();
    for (tag, values) in &tags {
        bytes.extend([tag.to_le_bytes(), LONG.to_le_bytes()].as_flattened());
        bytes.extend((values.len() as u32).to_le_bytes());
        if let [value] = values[..] {
            bytes.extend(value.to_le_bytes());
        } else {
            bytes.extend((lists_start + lists.len() as u32).to_le_bytes());
            lists.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
    }
    bytes.extend(next.to_le_bytes());
    bytes.extend(lists);
    bytes
}

/// Pictures of many strips or tiles, all of them the same bytes, and of many tags.
fn long_tiffs() -> Vec<Vec<u8>> {
    const DEFLATE: u32 = 8;
    let pieces = |shape: [TiffTag; 2], [places, lengths]: [u16; 2], count: usize, data: &[u8]| {
        let mut tags = vec![(259, vec![DEFLATE])];
        tags.extend(shape);
        tags.push((places, vec![8; count]));
        tags.push((lengths, vec![data.len() as u32; count]));
        tags
    };
    let strips = |count: usize, data: &[u8]| {
        let shape = [(278, vec![1]), (284, vec![1])];
        pieces(shape, [273, 279], count, data)
    };
    let tiles = |count: usize, [width, height]: [u32; 2], data: &[u8]| {
        let shape = [(322, vec![width]), (323, vec![height])];
        pieces(shape, [324, 325], count, data)
    };
    let count = LONG_BYTES / 8;
    let (row, tile) = (packed_zeros(2 * 6), packed_zeros(32 << 20));
    let unknown = (0..20_000).map(|tag| (tag + 40_000, vec![1])).collect();
    vec![
        tiff([6, count as u32], strips(count, &row), &row, 0),
        // Tiles of which one column, or one row, has points.
        tiff([1, 16 * 2000], tiles(2000, [1 << 20, 16], &tile), &tile, 0),
        tiff([16 * 2000, 1], tiles(2000, [16, 1 << 20], &tile), &tile, 0),
        tiff([2, 2], unknown, &[0; 8], 0),
        // The next picture is this one.
        tiff([6, 2], strips(2, &row), &row, 8 + row.len() as u32),
    ]
}

/// Small images of every colour type and depth.
fn images() -> Vec<Vec<u8>> {
    use BitDepth::{Eight, Four, One, Sixteen, Two};
    use ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};
    let kinds = [
        (Grayscale, One),
        (Grayscale, Two),
        (Grayscale, Four),
        (Grayscale, Eight),
        (Grayscale, Sixteen),
        (GrayscaleAlpha, Eight),
        (GrayscaleAlpha, Sixteen),
        (Rgb, Eight),
        (Rgb, Sixteen),
        (Rgba, Eight),
        (Rgba, Sixteen),
        (Indexed, One),
        (Indexed, Two),
        (Indexed, Eight),
    ];
    let (width, height) = (5, 3);
    let image = |&(color, depth): &(ColorType, BitDepth)| {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, width, height);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == Indexed {
            encoder.set_palette(vec![0, 0, 0, 255, 255, 255, 128, 0, 64]);
            encoder.set_trns(vec![255, 128]);
        }
        let bits = width as usize * color.samples() * depth as usize;
        let data: Vec<u8> = (0..bits.div_ceil(8) * height as usize)
            .map(|k| if color == Indexed { 0x01 } else { (k * 37) as u8 })
            .collect();
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&data).unwrap();
        writer.finish().unwrap();
        bytes
    };
    let mut images: Vec<Vec<u8>> = kinds.iter().map(image).collect();
    // An image whose header wrongly says that it is interlaced.
    let mut interlaced = images[3].clone();
    interlaced[28] = 1;
    images.push(interlaced);
    images
}

/// Reads all rows at once and row by row, and demands the same result; the first error counts.
fn read<T>(read: impl Fn(&Slab) -> Result<Vec<T>, ArrayError>) -> Result<Vec<T>, ArrayError>
where
    T: PartialEq + std::fmt::Debug,
{
    let whole = read(&Slab::whole(NX, NY));
    let row = |row: usize| Slab {
        rows: row..row + 1,
        ..Slab::whole(NX, NY)
    };
    let by_rows = (0..NY).map(|j| read(&row(j))).collect::<Result<Vec<_>, _>>();
    let by_rows = by_rows.map(|rows| rows.into_iter().flatten().collect::<Vec<_>>());
    let said = |read: &Result<Vec<T>, ArrayError>| read.as_ref().err().map(ToString::to_string);
    assert_eq!(said(&whole), said(&by_rows));
    assert_eq!(whole.as_ref().ok(), by_rows.as_ref().ok());
    whole
}

/// Coefficients are finite and not negative, and keep their bits when written and read again.
fn field(name: &str, input: &[u8]) {
    let values = match read(|slab| arrays::field(Path::new(name), &mut Cursor::new(input), slab)) {
        Ok(values) => values,
        Err(error) => return readable(&error),
    };
    assert_eq!(values.len(), NX * NY);
    assert!(values.iter().all(|value| value.is_finite() && *value >= 0.0));
    let rows: Vec<String> = values
        .chunks(NX)
        .map(|row| {
            row.iter()
                .map(|value| format!("{value:?}"))
                .collect::<Vec<_>>()
                .join(",")
        })
        .collect();
    let text = rows.join("\n");
    let again = arrays::field(
        Path::new("again.csv"),
        &mut Cursor::new(text),
        &Slab::whole(NX, NY),
    )
    .unwrap();
    let bits = |values: &[f64]| -> Vec<u64> { values.iter().map(|value| value.to_bits()).collect() };
    assert_eq!(bits(&again), bits(&values));
}

fn npy(input: &[u8]) {
    field("field.npy", input);
    match read(|slab| mask_npy(Path::new("field.npy"), &mut Cursor::new(input), slab)) {
        Ok(mask) => assert_eq!(mask.len(), NX * NY),
        Err(error) => readable(&error),
    }
    state(input);
}

/// The last state of a run is finite.
fn state(input: &[u8]) {
    let by_block = |slab: &Slab| {
        let layers = arrays::state_npy(Path::new("state.npy"), &mut Cursor::new(input), slab)?;
        let block = |b: usize| layers.each_ref().map(|layer| layer[b]);
        Ok((0..slab.n_blocks()).map(block).collect())
    };
    match read(by_block) {
        Ok(blocks) => {
            assert_eq!(blocks.len(), NX * NY);
            assert!(blocks.iter().flatten().all(|value| value.is_finite()));
        }
        Err(error) => readable(&error),
    }
}

fn csv_table(input: &[u8]) {
    field("field.csv", input);
}

/// A height map that is read has a finite mean in every block, within the range of the file, and a roughness.
fn height_map(input: &[u8]) {
    let room = Room {
        blocks: [NX, NY],
        is_place: false,
    };
    for ending in ["csv", "gsf", "npy", "png", "tif", "x3p"] {
        let path = format!("map.{ending}");
        // A file that says nothing of its units is asked about them, and then answered.
        let plain = Preparation::default();
        let treated = Preparation {
            missing: Some(f64::NAN),
            is_levelled: true,
            ..plain
        };
        for (units, preparation) in [(HeightMapUnits::default(), plain), (UNITS, treated)] {
            let mut source = Cursor::new(input);
            match arrays::height_map(Path::new(&path), &mut source, &units, &preparation, &room) {
                Err(error) => readable(&error),
                Ok(map) => {
                    assert_eq!(map.blocks.len(), NX * NY);
                    assert!(map.points[0] > 0 && map.points[1] > 0);
                    assert!(
                        map.roughness.sa <= map.roughness.sq * (1.0 + 1e-9) || map.roughness.sq.is_infinite()
                    );
                }
            }
        }
    }
}

/// Units for a file without.
const UNITS: HeightMapUnits = HeightMapUnits {
    height: Some(1e-6),
    pixel: Some([1e-6; 2]),
};

fn mask_png(input: &[u8]) {
    mask(input);
    // With valid checksums the decoder goes on to the contents of the chunks.
    mask(&with_checksums(input));
}

fn mask(input: &[u8]) {
    let read = |bytes: &[u8]| {
        let path = Path::new("mask.png");
        read(|slab| arrays::mask_png(path, &mut Cursor::new(bytes), 0.5, slab))
    };
    let mask = match read(input) {
        Ok(mask) => mask,
        Err(error) => return readable(&error),
    };
    assert_eq!(mask.len(), NX * NY);
    let again = scratch::file("again.png", b"");
    std::fs::write(&again, png_of_mask(NX, NY, &mask).unwrap()).unwrap();
    assert_eq!(read(&std::fs::read(&again).unwrap()).unwrap(), mask);
}

/// The image with the right checksum behind every chunk.
fn with_checksums(image: &[u8]) -> Vec<u8> {
    let mut sealed = image.to_vec();
    let mut start = 8;
    while let Some(length) = image.get(start..start + 4) {
        let length = u32::from_be_bytes(length.try_into().unwrap()) as usize;
        let end = start + 8 + length;
        let Some(chunk) = image.get(start + 4..end) else {
            break;
        };
        let sum = crc32(chunk).to_be_bytes();
        if let Some(place) = sealed.get_mut(end..end + 4) {
            place.copy_from_slice(&sum);
        }
        start = end + 4;
    }
    sealed
}

/// The checksum of a PNG chunk.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum: u32, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
            (sum >> 1) ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 }
        })
    })
}
