//! X3P files (ISO 25178-72): a zip archive of `main.xml`, which describes the points, and of a file with
//! their heights in metres, row by row.
//!
//! ISO 25178-72 counts y in the order of the rows and does not define how to show a surface. Programs show
//! the first row at the top, and export it so to other formats. The first row therefore lies at the largest
//! y, so that no file is the mirror image of another.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

use flate2::read::DeflateDecoder;
use md5::{Digest, Md5};
use rawzip::{CompressionMethod, RECOMMENDED_BUFFER_SIZE, ZipArchive};

use super::grid::{HeightGrid, Line, Take, points};
use crate::arrays::array_file::ArrayFile;
use crate::arrays::error::{ArrayError, broken, contents_error};
use crate::arrays::number_type::NumberType;
use crate::xml::{self, Piece};
use slipfront_base::text::truncated;

/// Largest length of `main.xml`: a description takes a few thousand bytes.
const XML_MAX_BYTES: u64 = 1 << 20;
/// Most nodes and attributes of `main.xml`: a description takes a few hundred.
const NODES_MAX: usize = 1 << 16;
/// Largest length of a path of elements that is kept, bytes: twice that of those which are asked for.
const PATH_MAX_BYTES: usize = 80;

/// Reads the points of a file. If a map may have gaps, unmeasured points become NaN.
pub(super) fn read(file: &mut ArrayFile, has_gaps: bool, take: &mut Take) -> Result<HeightGrid, ArrayError> {
    let path = file.path;
    let refuse = |detail: &str| broken(path, ".x3p", detail);
    let mut buffer = vec![0; RECOMMENDED_BUFFER_SIZE];
    let archive = ZipArchive::from_seekable(&mut *file.source, &mut buffer);
    let archive = archive.map_err(|error| refuse(&format!("it is no zip archive ({error})")))?;
    let mut entry = |name: &str, read: &mut dyn FnMut(&mut dyn Read) -> Result<(), ArrayError>| {
        let said =
            |error: rawzip::Error| refuse(&format!("`{name}` of its archive cannot be read ({error})"));
        let mut entries = archive.entries(&mut buffer);
        let (place, method) = loop {
            let Some(entry) = entries.next_entry().map_err(said)? else {
                return Err(refuse(&format!("its archive has no `{}`", truncated(name))));
            };
            if is_called(entry.file_path().as_ref(), name) {
                break (entry.wayfinder(), entry.compression_method());
            }
        };
        let entry = archive.get_entry(place).map_err(said)?;
        let mut stored: Box<dyn Read> = match method {
            CompressionMethod::STORE => Box::new(entry.verifying_reader(entry.reader())),
            CompressionMethod::DEFLATE => {
                Box::new(entry.verifying_reader(DeflateDecoder::new(entry.reader())))
            }
            _ => {
                return Err(refuse(&format!(
                    "`{name}` is compressed otherwise than by deflate"
                )));
            }
        };
        read(&mut stored)?;
        // The reader compares checksums at the end of a file.
        match stored.read(&mut [0]) {
            Ok(0) => Ok(()),
            Ok(_) => Err(refuse(&format!("`{name}` is longer than it should be"))),
            Err(error) => Err(refuse(&format!("`{name}`: {error}"))),
        }
    };

    let mut xml = String::new();
    entry("main.xml", &mut |stored| {
        let read = stored.take(XML_MAX_BYTES).read_to_string(&mut xml);
        read.map(|_| ())
            .map_err(|error| refuse(&format!("`main.xml`: {error}")))
    })?;
    let description = Description::parse(path, &xml)?;
    let [nx, ny] = description.points;
    let mut valid = Vec::new();
    if let Some(name) = &description.valid {
        entry(name, &mut |stored| {
            valid = valid_points(path, stored, nx * ny, has_gaps)?;
            Ok(())
        })?;
    }
    let is_valid = |point: usize| {
        valid
            .get(point / 8)
            .is_none_or(|bits| bits >> (point % 8) & 1 == 1)
    };
    let mut bytes = vec![0; description.number.size * nx];
    let mut heights = vec![0.0; nx];
    let mut checksum = Md5::new();
    entry(&description.data, &mut |stored| {
        for row in 0..ny {
            let read = stored.read_exact(&mut bytes);
            if read.is_ok() {
                checksum.update(&bytes);
            }
            read.map_err(|error| refuse(&format!("`{}`: {error}", description.data)))?;
            description.number.decode(&bytes, &mut heights);
            for (column, height) in heights.iter_mut().enumerate() {
                *height = match is_valid(row * nx + column) {
                    true => *height * description.increment + description.offset,
                    false => f64::NAN,
                };
            }
            take(&Line::of_row(row, &heights))?;
        }
        Ok(())
    })?;
    Ok(HeightGrid {
        points: description.points,
        top_first: true,
        pixel: Some(description.pixel),
        height_unit: Some(1.0),
        notes: Vec::from_iter(description.other_checksum(&checksum.finalize())),
    })
}

/// Whether a file of an archive has this name, in the archive itself or in a folder that holds all of its
/// files: programs write both.
fn is_called(file: &[u8], name: &str) -> bool {
    let is_name = |file: &[u8]| file.eq_ignore_ascii_case(name.as_bytes());
    let below_folder = file
        .iter()
        .position(|&byte| byte == b'/')
        .map(|at| &file[at + 1..]);
    is_name(file) || below_folder.is_some_and(is_name)
}

/// Whether each point was measured: one bit per point, the lowest of a byte first. A map with gaps is
/// refused, unless it may have gaps.
fn valid_points(
    path: &Path,
    stored: &mut dyn Read,
    n_points: usize,
    has_gaps: bool,
) -> Result<Vec<u8>, ArrayError> {
    let mut bytes = vec![0; n_points.div_ceil(8)];
    let read = stored.read_exact(&mut bytes);
    read.map_err(|error| broken(path, ".x3p", &format!("its list of valid points: {error}")))?;
    let mut points = 0..n_points;
    match points.find(|point| !has_gaps && bytes[point / 8] >> (point % 8) & 1 == 0) {
        None => Ok(bytes),
        Some(gap) => {
            let problem = format!(
                "says that point {gap} (counted from 0) was not measured: fill such points by interpolation, or leave them out \
                 with `missing = \"nan\"`"
            );
            Err(contents_error(path, problem))
        }
    }
}

/// Contents of `main.xml`.
struct Description {
    points: [usize; 2],
    pixel: [f64; 2],
    number: NumberType,
    /// Height of the stored number 1, m; `offset` is added.
    increment: f64,
    offset: f64,
    /// The file with the heights.
    data: String,
    /// The file with one bit per point for whether it was measured, if there is one.
    valid: Option<String>,
    /// MD5 of the file with the heights, in hexadecimal digits, if the description has it.
    checksum: Option<String>,
}

impl Description {
    /// A sentence if the checksum of the heights differs from that of the description.
    fn other_checksum(&self, found: &[u8]) -> Option<String> {
        let stated = self.checksum.as_ref()?;
        let found: String = found.iter().map(|byte| format!("{byte:02x}")).collect();
        (!stated.eq_ignore_ascii_case(&found)).then(|| {
            format!(
                "the checksum of its heights is {found}, and `main.xml` has {}: the file was damaged or edited",
                truncated(stated)
            )
        })
    }

    fn parse(path: &Path, xml: &str) -> Result<Self, ArrayError> {
        let refuse = |detail: &str| broken(path, ".x3p", detail);
        let texts = texts(xml).map_err(|detail| refuse(&detail))?;
        let text = |place: &str| {
            texts
                .get(place)
                .map(|text| text.trim())
                .filter(|text| !text.is_empty())
        };
        let wanted = |place: &str| text(place).ok_or_else(|| refuse(&format!("`main.xml` has no {place}")));
        let must_be = |place: &str, right: &str, what: &str| match wanted(place)? {
            found if found == right => Ok(()),
            found => {
                let problem = format!(
                    "has {place} {}, where a {what} has {right}: export an areal height map",
                    truncated(found)
                );
                Err(contents_error(path, problem))
            }
        };
        must_be("Record1/FeatureType", "SUR", "surface")?;
        must_be("Record1/Axes/CX/AxisType", "I", "regular grid")?;
        must_be("Record1/Axes/CY/AxisType", "I", "regular grid")?;
        must_be("Record1/Axes/CZ/AxisType", "A", "height")?;
        must_be("Record3/MatrixDimension/SizeZ", "1", "single layer")?;
        let number = |place: &str, text: &str| {
            let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
            let detail = || format!("{place} of `main.xml` is no number: {}", truncated(text));
            number.ok_or_else(|| refuse(&detail()))
        };
        let above_0 = |place: &str, text: &str| {
            let step = number(place, text)?;
            let detail = || format!("{place} of `main.xml` is {step}, and not above 0");
            (step > 0.0).then_some(step).ok_or_else(|| refuse(&detail()))
        };
        let increment = |axis: &str| {
            let place = format!("Record1/Axes/{axis}/Increment");
            above_0(&place, wanted(&place)?)
        };
        let size = |axis: &str| {
            let place = format!("Record3/MatrixDimension/Size{axis}");
            let size = wanted(&place)?.parse::<u64>();
            size.map_err(|_| refuse(&format!("{place} of `main.xml` is no whole number")))
        };
        // These elements are optional.
        let step = "Record1/Axes/CZ/Increment";
        let offset = "Record1/Axes/CZ/Offset";
        let Some(data) = text("Record3/DataLink/PointDataLink") else {
            let problem = "has its heights as text in `main.xml`: export it with binary data";
            return Err(contents_error(path, problem.to_owned()));
        };
        Ok(Self {
            points: points(path, ".x3p", size("X")?, size("Y")?)?,
            pixel: [increment("CX")?, increment("CY")?],
            number: number_type(wanted("Record1/Axes/CZ/DataType")?).map_err(|detail| refuse(&detail))?,
            increment: text(step).map_or(Ok(1.0), |text| above_0(step, text))?,
            offset: text(offset).map_or(Ok(0.0), |text| number(offset, text))?,
            data: data.to_owned(),
            valid: text("Record3/DataLink/ValidPointsLink").map(str::to_owned),
            checksum: text("Record3/DataLink/MD5ChecksumPointData").map(str::to_owned),
        })
    }
}

/// The type of the stored heights, by its letter in `main.xml`.
fn number_type(letter: &str) -> Result<NumberType, String> {
    let name = match letter {
        "I" => "<i2",
        "L" => "<i4",
        "F" => "<f4",
        "D" => "<f8",
        _ => "",
    };
    NumberType::from_name(name)
        .ok_or_else(|| format!("its heights are of unknown type {}", truncated(letter)))
}

/// The texts of the elements below the root by their paths, such as `Record1/Axes/CX/AxisType`; of elements
/// with the same path, that of the first.
fn texts(xml: &str) -> Result<BTreeMap<String, String>, String> {
    let mut texts = BTreeMap::<String, String>::new();
    let mut is_first = false;
    xml::read(
        "main.xml",
        xml.as_bytes(),
        &mut { NODES_MAX },
        &mut |path, piece| {
            let place = path.split_once('/').map_or("", |(_, place)| place);
            match piece {
                Piece::Start(_) => {
                    is_first = place.len() <= PATH_MAX_BYTES && !texts.contains_key(place);
                    if is_first {
                        texts.insert(place.to_owned(), String::new());
                    }
                }
                Piece::Text(text) if is_first => texts.entry(place.to_owned()).or_default().push_str(text),
                Piece::Text(_) => {}
                Piece::End => is_first = false,
            }
            Ok(())
        },
    )?;
    Ok(texts)
}
