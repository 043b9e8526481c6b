//! Height maps as text: a matrix of heights, with or without a header that states units, or a list of points
//! x, y, z on a regular grid.

use std::path::Path;

use slipfront_base::number_format::with_si_prefix;
use slipfront_base::text::truncated;

use super::grid::{HeightGrid, Line, Take, points};
use super::preparation::Preparation;
use crate::arrays::array_file::ArrayFile;
use crate::arrays::error::{ArrayError, contents_error};
use crate::arrays::table;
use crate::quantity::Length;
use crate::table::{Encoding, HEAD_BYTES, TableLayout};

pub(super) fn read(
    file: &mut ArrayFile,
    preparation: &Preparation,
    take: &mut Take,
) -> Result<HeightGrid, ArrayError> {
    let path = file.path;
    let (_, head) = file.length_and_head(HEAD_BYTES)?;
    let stated = Stated::read(path, &head)?;
    let layout = table::layout_of_map(path, &head, preparation.table)?;
    // Words and empty fields are such points, too.
    let gaps = preparation.is_missing(f64::NAN);
    let mut notes = Vec::from_iter(layout.took());
    if let Some((pixel, unit)) = stated.pixel.zip(stated.height_unit) {
        let [pixel, unit] = [pixel, unit].map(|length| with_si_prefix(length, "m"));
        notes.push(format!(
            "lines above its rows state a pixel of {pixel} and a height of {unit} for the value 1"
        ));
    }
    if layout.columns == 3
        && let Some(list) = PointList::find(file, &layout, gaps)?
    {
        let [nx, ny] = list.points();
        let mut is_seen = vec![false; nx * ny];
        table::rows(file, &layout, gaps, |_, point| {
            let [column, row] = [0, 1].map(|axis| list.place(axis, point[axis]));
            let is_second = is_seen.get_mut(row * nx + column);
            if is_second.is_none_or(|seen| std::mem::replace(seen, true)) {
                let [x, y] = [point[0], point[1]];
                return Err(contents_error(
                    path,
                    format!("has the point {x}, {y} twice: remove one"),
                ));
            }
            take(&Line {
                row,
                column,
                heights: &point[2..],
            })
        })?;
        // Lists leave out unmeasured points.
        for (at, _) in is_seen.iter().enumerate().filter(|(_, seen)| !**seen) {
            take(&Line {
                row: at / nx,
                column: at % nx,
                heights: &[f64::NAN],
            })?;
        }
        return Ok(HeightGrid {
            notes,
            ..HeightGrid::without_units([nx, ny], false)
        });
    }
    let take_line = |[row, column]: [usize; 2], heights: &[f64]| {
        if let Some(mark) = stated.mark.filter(|mark| !preparation.is_missing(*mark))
            && heights.contains(&mark)
        {
            let problem = format!(
                "has points with its NODATA_value, {mark}, which were not measured: omit them with `missing = {mark}`"
            );
            return Err(contents_error(path, problem));
        }
        take(&Line { row, column, heights })
    };
    let [nx, ny] = table::rows(file, &layout, gaps, take_line)?;
    if nx <= WIDTH_OF_LISTS && ny >= LENGTH_OF_LISTS {
        let problem = format!(
            "has {nx} numbers in each of {ny} lines, like a list of points or a profile: a list x, y, z must lie on a regular grid \
             with every point once; interpolate it onto one, or write a matrix of heights"
        );
        return Err(contents_error(path, problem));
    }
    let points = points(path, "table", nx, ny)?;
    let of_size = stated
        .size
        .map(|[x, y]| [x / points[0] as f64, y / points[1] as f64]);
    Ok(HeightGrid {
        points,
        top_first: stated.top_first,
        pixel: of_size.or(stated.pixel.map(|pixel| [pixel; 2])),
        height_unit: stated.height_unit,
        notes,
    })
}

/// Statements in the header that a program writes above its heights.
#[derive(Default)]
struct Stated {
    /// Whether the first row is the top one.
    top_first: bool,
    /// Size of the map along x and along y, m.
    size: Option<[f64; 2]>,
    /// Point spacing, m.
    pixel: Option<f64>,
    /// Height of the value 1, m.
    height_unit: Option<f64>,
    /// Value of points that were not measured.
    mark: Option<f64>,
}

impl Stated {
    /// Reads the lines above the numbers of a table that begins with `head`.
    ///
    /// ```text
    /// # Channel: Topography          h=650 w=650
    /// # Width: 10.00 um              pixel size=3.7e-007 m
    /// # Height: 5.00 um              data unit=rad
    /// # Value units: nm              height conversion factor (-> m)=6.3e-008
    /// ```
    ///
    /// Grids of ESRI (`ncols`, `nrows`, `cellsize`, `NODATA_value`) have the top row first and a cell without
    /// a unit, tables of Keyence (`"XY Calibration","500","nm/pixel"`) the top row first and a pixel.
    ///
    /// The comments on the left are from Gwyddion, which writes all names but the last in the language of its
    /// user; the lines on the right are from a microscope.
    fn read(path: &Path, head: &[u8]) -> Result<Self, ArrayError> {
        let text = Encoding::detect(head).text(head);
        let length = |name: &str, text: &str| {
            let length = text.replace(',', ".").parse::<Length>();
            length.map(|length| length.si()).map_err(|error| {
                let text = truncated(text);
                contents_error(path, format!("has `{name}` = {text} above its heights: {error}"))
            })
        };
        let comments = text.lines().map_while(|line| line.trim().strip_prefix('#'));
        let comments: Vec<(&str, &str)> = comments.filter_map(|line| line.split_once(':')).collect();
        let unit = comments.iter().find(|(name, _)| name.trim() == "Value units");
        let is_gwyddion = unit.is_some() || comments.iter().any(|(name, _)| name.trim() == "Channel");
        if is_gwyddion {
            let side = |at: usize| {
                comments
                    .get(at)
                    .map(|(name, text)| length(name.trim(), text.trim()))
            };
            return Ok(Self {
                top_first: true,
                size: side(1)
                    .transpose()?
                    .zip(side(2).transpose()?)
                    .map(|(x, y)| [x, y]),
                height_unit: unit
                    .map(|(name, unit)| length(name.trim(), &format!("1 {}", unit.trim())))
                    .transpose()?,
                ..Self::default()
            });
        }
        if text.trim_start().starts_with("Zygo XYZ Data File") {
            let problem = "is an XYZ file of Zygo, which is not read: save the map as a matrix or as .x3p, as Gwyddion does";
            return Err(contents_error(path, problem.to_owned()));
        }
        let beginning = || text.lines().take(STATEMENTS_MAX);
        if text.trim_start().to_lowercase().starts_with("ncols") {
            let mark = beginning().find_map(|line| {
                let (name, value) = line.trim().split_once(char::is_whitespace)?;
                name.eq_ignore_ascii_case("nodata_value")
                    .then(|| value.trim().parse().ok())?
            });
            return Ok(Self {
                top_first: true,
                mark,
                ..Self::default()
            });
        }
        let calibration = beginning().find_map(|line| {
            let mut fields = line.split(',').map(|field| field.trim().trim_matches('"'));
            let name = fields.next()?;
            let (number, unit) = (fields.next()?, fields.next()?.strip_suffix("/pixel")?);
            name.eq_ignore_ascii_case("xy calibration")
                .then(|| format!("{number} {unit}"))
        });
        if let Some(pixel) = calibration {
            return Ok(Self {
                top_first: true,
                pixel: Some(length("XY calibration", &pixel)?),
                ..Self::default()
            });
        }
        let stated = |name: &str| {
            let lines = text
                .lines()
                .take(STATEMENTS_MAX)
                .filter_map(|line| line.split_once('='));
            let mut of_name = lines.filter(|(key, _)| key.trim().eq_ignore_ascii_case(name));
            of_name.next().map(|(_, value)| value.trim())
        };
        let pixel = stated("pixel size").map(|text| length("pixel size", text));
        let factor = "height conversion factor (-> m)";
        let height_unit = stated(factor).map(|text| length(factor, &format!("{text} m")));
        Ok(Self {
            pixel: pixel.transpose()?,
            height_unit: height_unit.transpose()?,
            ..Self::default()
        })
    }
}

/// Most numbers of a line of a list of points or a profile, which may have an index or a brightness.
const WIDTH_OF_LISTS: u64 = 5;
/// Least number of lines by which a table with so few columns is no map.
const LENGTH_OF_LISTS: u64 = 64;

/// Number of lines that are searched for statements.
const STATEMENTS_MAX: usize = 64;

/// The coordinates of a list of points that form a regular grid.
struct PointList {
    /// Rising coordinates along x and along y.
    axes: [Vec<f64>; 2],
}

impl PointList {
    /// The coordinates of a table of three columns, if the first two form a regular grid: those of a map that
    /// is three points wide do not.
    fn find(file: &mut ArrayFile, layout: &TableLayout, gaps: bool) -> Result<Option<Self>, ArrayError> {
        let (mut axes, mut n_points) = ([Vec::new(), Vec::new()], 0_usize);
        let mut is_list = true;
        table::rows(file, layout, gaps, |_, point| {
            n_points += 1;
            for (axis, &coordinate) in axes.iter_mut().zip(point) {
                let place = axis.partition_point(|other: &f64| *other < coordinate);
                // A grid has far fewer coordinates than points.
                if axis.get(place) != Some(&coordinate) && axis.len() < MOST_COORDINATES {
                    axis.insert(place, coordinate);
                }
            }
            is_list &= point[..2].iter().all(|number| number.is_finite());
            Ok(())
        })?;
        let list = Self { axes };
        let [nx, ny] = list.points();
        let is_grid = nx > 1
            && ny > 1
            // At most a quarter of the points may be left out, so that two rows of a map are never taken for
            // a list.
            && n_points <= nx.saturating_mul(ny)
            && 3 * nx.saturating_mul(ny) <= 4 * n_points
            && list.axes.iter().all(|axis| is_even(axis));
        Ok((is_list && is_grid).then_some(list))
    }

    fn points(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.axes[axis].len())
    }

    /// Index of a coordinate along an axis.
    fn place(&self, axis: usize, coordinate: f64) -> usize {
        self.axes[axis].partition_point(|other| *other < coordinate)
    }
}

/// Most coordinates along an axis of a list of points.
const MOST_COORDINATES: usize = 1 << 14;

/// Whether coordinates are evenly spaced, to a tenth of their spacing: they are written with few digits.
fn is_even(axis: &[f64]) -> bool {
    let step = (axis[axis.len() - 1] - axis[0]) / (axis.len() - 1) as f64;
    axis.iter()
        .enumerate()
        .all(|(at, coordinate)| (coordinate - axis[0] - step * at as f64).abs() < 0.1 * step)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn read_text(text: &str) -> (HeightGrid, Vec<(usize, usize, f64)>) {
        let mut points = Vec::new();
        let grid = read(
            &mut ArrayFile {
                path: Path::new("m.csv"),
                source: &mut Cursor::new(text),
            },
            &Preparation::default(),
            &mut |line| {
                let heights = line.heights.iter().enumerate();
                points.extend(heights.map(|(k, &height)| (line.row, line.column + k, height)));
                Ok(())
            },
        );
        (grid.unwrap(), points)
    }

    #[test]
    fn the_text_export_of_gwyddion_states_its_units() {
        let text = "# Channel: Topography\n# Width: 10.00 \u{b5}m\n# Height: 5,00 \u{b5}m\n# Value units: nm\n1\t2\n3\t4\n";
        let (grid, points) = read_text(text);
        assert!(grid.top_first);
        assert_eq!((grid.pixel, grid.height_unit), (Some([5e-6, 2.5e-6]), Some(1e-9)));
        assert_eq!(points, [(0, 0, 1.0), (0, 1, 2.0), (1, 0, 3.0), (1, 1, 4.0)]);
    }

    #[test]
    fn names_of_the_export_are_in_the_language_of_its_user() {
        let text = "# Kanal: Topographie\n# Breite: 10.00 \u{b5}m\n# H\u{f6}he: 5,00 \u{b5}m\n# Value units: nm\n1\t2\n3\t4\n";
        let (grid, _) = read_text(text);
        assert!(grid.top_first);
        assert_eq!((grid.pixel, grid.height_unit), (Some([5e-6, 2.5e-6]), Some(1e-9)));
    }

    /// Reads a text as a map of no particular size.
    fn refusal(text: &str, preparation: &Preparation) -> Option<String> {
        let found = read(
            &mut ArrayFile {
                path: Path::new("m.csv"),
                source: &mut Cursor::new(text),
            },
            preparation,
            &mut |_| Ok(()),
        );
        found.err().map(|error| error.to_string())
    }

    #[test]
    fn grids_of_esri_begin_with_the_top_row_and_state_their_gaps() {
        let text = "ncols 3\nnrows 2\nxllcorner 0.0\nyllcorner 0.0\ncellsize 0.5\nnodata_value -9999\n1 2 -9999\n3 4 5\n";
        let (grid, _) = read_text(&text.replace("-9999\n3", "6\n3"));
        assert_eq!((grid.points, grid.top_first, grid.pixel), ([3, 2], true, None));
        let said = refusal(text, &Preparation::default()).unwrap();
        assert!(said.contains("omit them with `missing = -9999`"), "{said}");
        let missing = Preparation {
            missing: Some(-9999.0),
            ..Preparation::default()
        };
        assert_eq!(refusal(text, &missing), None);
    }

    #[test]
    fn tables_of_keyence_begin_with_the_top_row_and_state_their_pixel() {
        let (grid, _) = read_text("\"XY Calibration\",\"277.5\",\"nm/pixel\"\n\"Height\"\n1,2,3\n4,5,7\n");
        assert_eq!((grid.points, grid.top_first), ([3, 2], true));
        assert_eq!((grid.pixel, grid.height_unit), (Some([277.5e-9; 2]), None));
    }

    #[test]
    fn words_and_empty_fields_are_gaps_if_gaps_are_left_out() {
        let missing = Preparation {
            missing: Some(f64::NAN),
            ..Preparation::default()
        };
        for word in ["Bad", "***", "---", "", "No Data"] {
            let text = format!("{word},1,2\n3,{word},5\n6,7,8\n");
            assert_eq!(refusal(&text, &missing), None, "{word:?}");
            let said = refusal(&text, &Preparation::default()).unwrap();
            assert!(
                said.contains("in row 0, column 0") && said.contains("remove this row") == word.is_empty(),
                "{said}"
            );
            assert!(word.is_empty() || said.contains("`missing = \"nan\"`"), "{said}");
        }
        // A number that is written in another way is none.
        let said = refusal("1,2,3\n3,4x,5\n6,7,8\n", &missing).unwrap();
        assert!(said.contains("`4x` in line 2"), "{said}");
    }

    #[test]
    fn lists_that_are_no_grid_are_told_from_maps() {
        let list = |rows: usize, columns: usize| {
            let row = |k: usize| {
                (0..columns)
                    .map(|column| format!("{}", (k * 7 + column * 3) % 11))
                    .collect::<Vec<_>>()
                    .join(",")
            };
            (0..rows).map(|k| row(k) + "\n").collect::<String>()
        };
        for columns in 2..=5 {
            let said = refusal(&list(64, columns), &Preparation::default()).unwrap();
            assert!(said.contains("like a list of points or a profile"), "{said}");
            assert_eq!(refusal(&list(20, columns), &Preparation::default()), None);
        }
        let said = refusal("Zygo XYZ Data File - Format 2\n1 2 3\n", &Preparation::default()).unwrap();
        assert!(said.contains("is an XYZ file of Zygo"), "{said}");
    }

    #[test]
    fn statements_of_a_microscope_are_taken() {
        let text = "h=2 w=3\npixel size=3.5e-007 m\ndata unit=rad\nheight conversion factor (-> m)=6.25e-008\n1 2 4\n3 4 9\n";
        let (grid, points) = read_text(text);
        assert_eq!((grid.pixel, grid.height_unit), (Some([3.5e-7; 2]), Some(6.25e-8)));
        assert_eq!((grid.points, points.len()), ([3, 2], 6));
        assert!(grid.notes[0].contains("4 lines above ignored"));
    }

    #[test]
    fn points_on_a_grid_are_read_in_any_order() {
        let (grid, points) = read_text("0.5 0 2\n0 0 1\n0 0.5 3\n0.5 0.5 4\n0 1 5\n0.5 1 6\n");
        assert_eq!(grid.points, [2, 3]);
        assert_eq!(points[..3], [(0, 1, 2.0), (0, 0, 1.0), (1, 0, 3.0)]);
    }

    #[test]
    fn a_map_of_three_columns_is_one() {
        let (grid, _) = read_text("0 1 2\n3 4 5\n0 2 1\n7 8 9\n");
        assert_eq!(grid.points, [3, 4]);
    }
}
