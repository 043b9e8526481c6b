//! Height maps as text: a matrix of heights, with or without a header that states units, or a list of points
//! x, y, z on a regular grid.

use std::io::{BufRead, Seek};
use std::path::Path;

use slipfront_base::number_format::with_si_prefix;
use slipfront_base::text::truncated;

use super::grid::{HeightGrid, Line, Take, points};
use crate::arrays::error::{ArrayError, contents_error};
use crate::arrays::head::length_and_head;
use crate::arrays::table;
use crate::quantity::Length;
use crate::table::{Encoding, HEAD_BYTES, TableLayout, TableOptions};

pub(super) fn read(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    options: TableOptions,
    take: &mut Take,
) -> Result<HeightGrid, ArrayError> {
    let (_, head) = length_and_head(path, source, HEAD_BYTES)?;
    let stated = Stated::of(path, &head)?;
    let layout = table::layout_of_map(path, &head, options)?;
    let mut notes = Vec::from_iter(layout.took());
    if let Some((pixel, unit)) = stated.pixel.zip(stated.height_unit) {
        let [pixel, unit] = [pixel, unit].map(|length| with_si_prefix(length, "m"));
        notes.push(format!(
            "lines above its rows state a pixel of {pixel} and a height of {unit} for the value 1"
        ));
    }
    if layout.columns == 3
        && let Some(list) = PointList::of(path, source, &layout)?
    {
        let [nx, ny] = list.points();
        let mut is_seen = vec![false; nx * ny];
        table::rows(path, source, &layout, |_, point| {
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
            points: [nx, ny],
            top_first: false,
            pixel: None,
            height_unit: None,
            notes,
        });
    }
    let take_line = |[row, column]: [usize; 2], heights: &[f64]| take(&Line { row, column, heights });
    let [nx, ny] = table::rows(path, source, &layout, take_line)?;
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
    /// The comments on the left are from Gwyddion, which writes all names but the last in the language of its
    /// user; the lines on the right are from a microscope.
    fn of(path: &Path, head: &[u8]) -> Result<Self, ArrayError> {
        let text = Encoding::of(head).text(head);
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
    fn of(
        path: &Path,
        source: &mut (impl BufRead + Seek),
        layout: &TableLayout,
    ) -> Result<Option<Self>, ArrayError> {
        let (mut axes, mut n_points) = ([Vec::new(), Vec::new()], 0_usize);
        let mut is_list = true;
        table::rows(path, source, layout, |_, point| {
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
            Path::new("m.csv"),
            &mut Cursor::new(text),
            TableOptions::default(),
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
