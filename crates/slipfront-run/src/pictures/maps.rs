//! Maps of a field of a run at its snapshots.

use std::collections::HashMap;

use slipfront::observe::Field;
use slipfront_base::number_format::{in_print, si_prefix};
use slipfront_case::case::{MAX_MAPS, mapped_field, scales};
use slipfront_case::case_file::{CaseFile, Motion};
use slipfront_case::field_info::field_info;
use slipfront_plot::{
    self as plot, CellMeans, DrawnLattice, Picture, PictureSize, SLIDING_SHARE, SnapshotMap, SnapshotMaps,
};

use super::error::{RunPictureError, drawn};
use super::files::case_of;
use crate::fields::{self, FieldFrame, FieldsData, Reduction};
use crate::names::{FIELDS, SERIES, SUMMARY};
use crate::run_files::RunFiles;
use crate::series::{self, SeriesRow};
use crate::summary::{Summary, summary_of};

/// Maps are read as the means that are drawn, so that the memory does not grow with the lattice.
impl Reduction for CellMeans {
    fn begin(columns: usize, rows: usize) -> Self {
        Self::new(columns, rows)
    }

    fn add(&mut self, values: impl Iterator<Item = f32>) {
        self.add(values);
    }

    fn finish(self) -> Vec<f32> {
        self.finish()
    }
}

/// Draws the maps of the stress of a run; none if it kept no such field.
pub(super) fn of_run(run: RunFiles, size: PictureSize) -> Result<Option<Picture>, RunPictureError> {
    let case = case_of(run)?;
    draw_maps(run, case.as_ref(), field_of_maps(case.as_ref()), size)
}

/// Draws the maps of a field of a run from its files, which must be there and undamaged.
///
/// # Errors
/// When the files cannot be read, or hold no such maps; when the size leaves no room for them.
pub fn draw_field(run: RunFiles, field: Field, size: PictureSize) -> Result<Picture, RunPictureError> {
    draw_maps(run, case_of(run)?.as_ref(), field, size)?.ok_or_else(|| RunPictureError::NoMaps {
        path: run.path().join(FIELDS),
        field: field_info(field).name,
    })
}

/// The field that is drawn in the maps of a run.
pub(super) fn field_of_maps(case: Option<&CaseFile>) -> Field {
    case.map_or(Field::ContactStress, mapped_field)
}

/// Title of the maps of a field with these values, in the unit of its file, and the unit in which they are
/// drawn.
pub fn title_of_field(
    field: Field,
    case: Option<&CaseFile>,
    values: impl Iterator<Item = f32>,
) -> (String, f32) {
    let MapScale { title, unit, .. } = MapScale::new(field, case, values);
    (title, unit)
}

/// The scale of the maps of a field.
struct MapScale {
    /// Title of the colour bar.
    title: String,
    /// The symbol and the unit of the field, where there is no room for the title.
    symbol: String,
    /// The unit in which the values of the field are drawn.
    unit: f32,
    /// Values at the ends of the bar.
    range: [f64; 2],
}

impl MapScale {
    /// The scale of maps of a field with these values, in the unit of its file.
    fn new(field: Field, case: Option<&CaseFile>, values: impl Iterator<Item = f32>) -> Self {
        let symbol = match (field, case) {
            (Field::ContactStress, _) => "\u{3c4}_c*",
            (Field::Traction, Some(_)) => "\u{3c4}_f*",
            (Field::Traction, None) => "\u{3c4}_f",
            (Field::DisplacementX, _) => "u_x",
            (Field::DisplacementY, _) => "u_y",
            (Field::VelocityX, _) => "v_x",
            (Field::VelocityY, _) => "v_y",
            (Field::Sliding, _) => "sliding",
        };
        let extent = extent(values);
        let (title, symbol, unit) = match (field, case) {
            (Field::ContactStress, _) => return Self::of_share(format!("contact stress {symbol}"), symbol),
            (Field::Sliding, _) => return Self::of_share(SLIDING_SHARE.to_owned(), symbol),
            (Field::Traction, Some(case)) => {
                let unit = scales(case).stress();
                (format!("traction {symbol}"), symbol.to_owned(), unit)
            }
            _ => {
                let info = field_info(field);
                let (size, prefix) = si_prefix(extent[1].max(-extent[0]));
                let unit = format!("{}{}", in_print(prefix), info.unit.replace(" s-1", "/s"));
                (
                    format!("{} ({unit})", info.long_name),
                    format!("{symbol} ({unit})"),
                    size,
                )
            }
        };
        let [lo, hi] = extent.map(|end| end / unit);
        Self {
            title,
            symbol,
            unit: unit as f32,
            range: if lo < hi { [lo, hi] } else { [0.0, 1.0] },
        }
    }

    /// The scale of values from 0 to 1.
    fn of_share(title: String, symbol: &str) -> Self {
        Self {
            title,
            symbol: symbol.to_owned(),
            unit: 1.0,
            range: [0.0, 1.0],
        }
    }
}

/// The smallest and the largest of some values and of 0.
fn extent(values: impl Iterator<Item = f32>) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite()).map(f64::from);
    finite.fold([0.0, 0.0], |[lo, hi]: [f64; 2], value| {
        [lo.min(value), hi.max(value)]
    })
}

/// Snapshots of a field of a run, and what else its files say of them.
pub(super) struct Snapshots {
    /// Maps of the field in the unit in which they are drawn.
    pub(super) maps: SnapshotMaps,
    /// The symbol and the unit of the field, where there is no room for its title.
    pub(super) symbol: String,
    pub(super) summary: Summary,
    /// Step, time t* and mu* of the rows of the series.
    pub(super) rows: Vec<(u64, f64, f64)>,
}

impl Snapshots {
    /// The snapshots of a field with the numbers that `choose` returns for the letters of all; none if the
    /// run has not kept the field.
    pub(super) fn read(
        run: RunFiles,
        case: Option<&CaseFile>,
        field: Field,
        choose: impl Fn(&[String]) -> Vec<usize>,
    ) -> Result<Option<Self>, RunPictureError> {
        let fields = fields::read_maps::<CellMeans>(run.file(FIELDS)?, field, choose)?;
        if fields.names.is_empty() || fields.frames.is_empty() {
            return Ok(None);
        }
        let values = fields.frames.iter().flat_map(|frame| &frame.values).flatten();
        let scale = MapScale::new(field, case, values.copied());
        let summary = summary_of(&run.file(SUMMARY)?)?;
        let row = |row: SeriesRow| (row.step, row.time_star, row.mu_star);
        let rows = series::read_rows(&run.file(SERIES)?, SERIES, row)?;
        let at_steps: HashMap<u64, f64> = rows.iter().map(|(step, _, mu_star)| (*step, *mu_star)).collect();
        // A thinned series may lack the row of a snapshot.
        let mu_star = |frame: &FieldFrame| {
            let mut instants = summary.instants.iter();
            let instant = instants.find(|instant| instant.time_star == frame.time_star);
            let found = instant.map(|instant| instant.mu_star);
            found.or_else(|| at_steps.get(&frame.step).copied())
        };
        let lattice = drawn_lattice(&fields);
        let map = |frame: FieldFrame| SnapshotMap {
            mu_star: mu_star(&frame).unwrap_or(f64::NAN),
            // The file has the letters joined.
            label: frame
                .label
                .chars()
                .map(String::from)
                .collect::<Vec<_>>()
                .join(", "),
            time_star: frame.time_star,
            values: frame
                .values
                .into_iter()
                .flatten()
                .map(|value| value / scale.unit)
                .collect(),
        };
        Ok(Some(Self {
            maps: SnapshotMaps {
                maps: fields.frames.into_iter().map(map).collect(),
                lattice,
                value_title: scale.title,
                range: scale.range,
            },
            symbol: scale.symbol,
            summary,
            rows,
        }))
    }
}

/// The lattice of fields that were read as means over cells.
pub(super) fn drawn_lattice(fields: &FieldsData) -> DrawnLattice {
    DrawnLattice {
        nx: fields.columns(),
        ny: fields.rows(),
        block_size: fields.block_size * fields.stride as f64,
        textured: fields.textured.clone(),
    }
}

/// Draws the maps of a field of a run; none if it has not kept the field.
fn draw_maps(
    run: RunFiles,
    case: Option<&CaseFile>,
    field: Field,
    size: PictureSize,
) -> Result<Option<Picture>, RunPictureError> {
    let few = |labels: &[String]| fields::choose_snapshots(labels, MAX_MAPS);
    let Some(Snapshots { maps, summary, .. }) = Snapshots::read(run, case, field, few)? else {
        return Ok(None);
    };
    let is_torque = summary.motion == Some(Motion::Rotation);
    drawn(field_info(field).name, plot::stress(&maps, is_torque, size)).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_the_unit_that_suits() {
        let values = [-2e-9_f32, f32::NAN, 5e-9];
        let scale = MapScale::new(Field::DisplacementX, None, values.into_iter());
        assert_eq!((scale.symbol.as_str(), scale.unit), ("u_x (nm)", 1e-9));
        // Rounding of 32-bit numbers.
        assert!((scale.range[0] + 2.0).abs() < 1e-6 && (scale.range[1] - 5.0).abs() < 1e-6);
        for field in [Field::VelocityY, Field::Sliding] {
            let scale = MapScale::new(field, None, [0.0; 3].into_iter());
            assert_eq!(scale.range, [0.0, 1.0]);
        }
        // With a case, in units of P mu_s.
        let case = CaseFile::parse("load.pressure = '2 MPa'\nfriction.mu_static = 0.5", "case", &[]).unwrap();
        let scale = MapScale::new(Field::Traction, Some(&case), [5e5].into_iter());
        assert_eq!(
            (scale.symbol.as_str(), scale.unit, scale.range),
            ("\u{3c4}_f*", 1e6, [0.0, 0.5])
        );
    }
}
