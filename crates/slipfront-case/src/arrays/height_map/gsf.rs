//! Gwyddion simple fields: lines of text, padded with zeros to a multiple of four bytes, then 32-bit numbers,
//! the top row first.

use std::io::SeekFrom;
use std::path::Path;

use super::grid::{HeightGrid, Line, Take, points};
use crate::arrays::array_file::ArrayFile;
use crate::arrays::error::{ArrayError, broken, contents_error};
use crate::quantity::Length;
use slipfront_base::text::truncated;

const MAGIC: &[u8] = b"Gwyddion Simple Field 1.0\n";
/// Largest length of a header: comments may make it longer than a few hundred bytes.
const HEADER_MAX_BYTES: u64 = 1 << 20;

pub(super) fn read(file: &mut ArrayFile, take: &mut Take) -> Result<HeightGrid, ArrayError> {
    let path = file.path;
    let read_error = ArrayError::read(path);
    let refuse = |detail: &str| broken(path, ".gsf", detail);
    let (length, head) = file.length_and_head(HEADER_MAX_BYTES)?;
    let Some(lines) = head.strip_prefix(MAGIC) else {
        return Err(refuse("it does not begin with `Gwyddion Simple Field 1.0`"));
    };
    let Some(end) = lines.iter().position(|&byte| byte == 0) else {
        return Err(refuse("no zero byte ends its header"));
    };
    let text = String::from_utf8_lossy(&lines[..end]);
    let grid = GsfHeader { path, text: &text }.grid()?;

    // From one to four zeros follow the text.
    let start = ((MAGIC.len() + end) / 4 * 4 + 4) as u64;
    let [nx, ny] = grid.points;
    let wanted = start + 4 * nx as u64 * ny as u64;
    if length != wanted {
        let detail = format!("it has {length} bytes, but its header requires {wanted}");
        return Err(refuse(&detail));
    }
    file.source.seek(SeekFrom::Start(start)).map_err(&read_error)?;
    let mut bytes = vec![0; 4 * nx];
    let mut heights = vec![0.0; nx];
    for row in 0..ny {
        file.source.read_exact(&mut bytes).map_err(&read_error)?;
        for (height, bytes) in heights.iter_mut().zip(bytes.as_chunks().0) {
            *height = f64::from(f32::from_le_bytes(*bytes));
        }
        take(&Line::of_row(row, &heights))?;
    }
    Ok(grid)
}

/// The header of a file: lines of `name = value`.
struct GsfHeader<'a> {
    path: &'a Path,
    text: &'a str,
}

impl<'a> GsfHeader<'a> {
    fn grid(&self) -> Result<HeightGrid, ArrayError> {
        let points = points(self.path, ".gsf", self.size("XRes")?, self.size("YRes")?)?;
        let lateral = self.in_metres("XYUnits")?;
        let pixel = match (self.real("XReal")?, self.real("YReal")?, lateral) {
            (Some(x), Some(y), Some(unit)) => {
                Some([x * unit / points[0] as f64, y * unit / points[1] as f64])
            }
            _ => None,
        };
        Ok(HeightGrid {
            pixel,
            height_unit: self.in_metres("ZUnits")?,
            ..HeightGrid::without_units(points, true)
        })
    }

    fn value(&self, name: &str) -> Option<&'a str> {
        let lines = self.text.lines().filter_map(|line| line.split_once('='));
        let mut values = lines.filter(|(key, _)| key.trim() == name);
        values.next().map(|(_, value)| value.trim())
    }

    fn size(&self, name: &str) -> Result<u64, ArrayError> {
        let size = self.value(name).and_then(|text| text.parse::<u64>().ok());
        size.ok_or_else(|| self.refuse(&format!("it has no whole number `{name}`")))
    }

    /// A unit of length, in m.
    fn in_metres(&self, name: &str) -> Result<Option<f64>, ArrayError> {
        let Some(unit) = self.value(name).filter(|unit| !unit.is_empty()) else {
            return Ok(None);
        };
        match format!("1 {unit}").parse::<Length>() {
            Ok(length) => Ok(Some(length.si())),
            Err(_) => {
                let unit = truncated(unit);
                let problem =
                    format!("has `{name}` = {unit}, which is no unit of length: export a map of heights");
                Err(contents_error(self.path, problem))
            }
        }
    }

    fn real(&self, name: &str) -> Result<Option<f64>, ArrayError> {
        let Some(text) = self.value(name) else {
            return Ok(None);
        };
        let real = text
            .parse::<f64>()
            .ok()
            .filter(|real| real.is_finite() && *real > 0.0);
        let detail = || format!("`{name}` = {} is no number above 0", truncated(text));
        real.map(Some).ok_or_else(|| self.refuse(&detail()))
    }

    fn refuse(&self, detail: &str) -> ArrayError {
        broken(self.path, ".gsf", detail)
    }
}
