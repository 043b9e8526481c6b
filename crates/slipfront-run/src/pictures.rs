//! The pictures of a run, drawn from its files, so that those of a run and those of `slipfront plot` are equal.

#[cfg(feature = "plot")]
use {
    crate::error::ResultsError,
    crate::fields::{self, FieldFrame, Reduction},
    crate::friction_picture::{self, in_print},
    crate::precursors::{self, PrecursorRow},
    crate::run_folder::error::FolderError,
    crate::series::{self, SeriesRow},
    crate::summary::{InstantSummary, Summary, read_summary},
    rayon::prelude::*,
    slipfront::exact_solutions::precursor_load,
    slipfront::observe::Field,
    slipfront::{Edge, Edges},
    slipfront_case::case::{Budget, MAX_MAPS, mapped_field, scales},
    slipfront_case::case_file::{CaseFile, KineticFriction, Motion},
    slipfront_case::disk::found_behind,
    slipfront_case::field_info::field_info,
    slipfront_case::number_format::si_prefix,
    slipfront_plot::{
        self as plot, CellMeans, FrontMap, Picture, Response, Responses, SpaceTime, StressMap, StressMaps,
    },
    std::{
        collections::HashMap,
        fs::Metadata,
        ops::Range,
        path::{Path, PathBuf},
    },
};

use crate::names::{CASE, FIELDS, KYMOGRAPH, PRECURSORS, SERIES, SUMMARY};

/// A picture of a run.
pub struct RunPicture {
    /// Name of its files.
    pub name: &'static str,
    /// What it shows, in words.
    pub shows: &'static str,
    /// Draws it from the files of a run folder; none if the run has kept nothing that it could show.
    #[cfg(feature = "plot")]
    draw: fn(&Path) -> Result<Option<Picture>, ResultsError>,
}

/// Every picture of a run: a new one is a line here, and its drawing.
pub static RUN_PICTURES: &[RunPicture] = &[
    RunPicture {
        name: "friction",
        shows: "friction and sliding blocks against time",
        #[cfg(feature = "plot")]
        draw: |folder| friction_picture::of_run(folder).map(Some),
    },
    RunPicture {
        name: "stress",
        shows: "maps of the contact stress",
        #[cfg(feature = "plot")]
        draw: draw_stress,
    },
    RunPicture {
        name: "front",
        shows: "first slips, and sliding against place and time",
        #[cfg(feature = "plot")]
        draw: draw_front,
    },
    RunPicture {
        name: "precursors",
        shows: "how far events of slip reach under the load",
        #[cfg(feature = "plot")]
        draw: draw_precursors,
    },
];

/// The files that pictures are drawn from.
pub const DRAWN_FROM: [&str; 6] = [CASE, SUMMARY, SERIES, PRECURSORS, KYMOGRAPH, FIELDS];

impl RunPicture {
    /// Names of its files.
    pub fn files(&self) -> [String; 2] {
        ["svg", "png"].map(|ending| format!("{}.{ending}", self.name))
    }
}

/// Bytes of the files of all pictures without those of maps, of the summary and of the manifest (measured: at most 0.7 MB).
#[cfg(feature = "plot")]
pub(crate) const FILE_BYTES: f64 = 2e6;

/// Bytes of a row of the series while pictures are drawn from it: three numbers that are read of it, and the points of its curves.
#[cfg(feature = "plot")]
pub(crate) const ROW_BYTES: f64 = (3 + 2 + 3) as f64 * size_of::<f64>() as f64;

/// Bytes of a cell of a lattice while maps of it are read: whether it is textured, and its mean.
#[cfg(feature = "plot")]
pub(crate) const CELL_BYTES: f64 = (size_of::<bool>() + CellMeans::BYTES_PER_CELL) as f64;

/// Bytes of a cell of a map in the picture of the stress while it is drawn: its value, and what it takes of the files.
#[cfg(feature = "plot")]
pub(crate) const MAP_CELL_BYTES: f64 = (size_of::<f32>() + plot::STRESS_FILE_BYTES) as f64;

/// Bytes while the pictures of the friction and of the stress are drawn at once.
#[cfg(feature = "plot")]
pub(crate) const WITH_MAPS_BYTES: f64 = (plot::FRICTION_BYTES + plot::STRESS_BYTES) as f64;

/// Memory in which the friction curves of these run folders are drawn, or all pictures of a single one, in bytes.
#[cfg(feature = "plot")]
pub fn memory(folders: &[PathBuf]) -> Result<f64, ResultsError> {
    let (mut rows, mut kymograph) = (0.0, 0);
    for folder in folders {
        rows += series::estimate_rows(&folder.join(SERIES))?;
        kymograph = found(&folder.join(KYMOGRAPH))?
            .map_or(0, |file| file.len())
            .max(kymograph);
    }
    let shares = kymograph as f64 / fields::SHARE_BYTES as f64;
    let maps = CellMeans::MAX_CELLS as f64 * (CELL_BYTES + MAX_MAPS as f64 * MAP_CELL_BYTES);
    Ok(Budget::resident(
        maps + Budget::grown(rows) * ROW_BYTES
            + shares * fields::WORKING_SHARE_BYTES as f64
            + WITH_MAPS_BYTES,
    ))
}

/// Draws the pictures of a run folder from its files, which must be there and undamaged.
#[cfg(feature = "plot")]
pub fn draw(folder: &Path) -> Result<Vec<(&'static str, Picture)>, ResultsError> {
    let mut pictures = Vec::new();
    // The budget of a run has room for two at once.
    for two in RUN_PICTURES.chunks(2) {
        let drawn: Vec<_> = two.par_iter().map(|picture| (picture.draw)(folder)).collect();
        for (picture, drawn) in two.iter().zip(drawn) {
            pictures.extend(drawn?.map(|drawn| (picture.name, drawn)));
        }
    }
    Ok(pictures)
}

/// A file that a run may not have written.
#[cfg(feature = "plot")]
fn found(path: &Path) -> Result<Option<Metadata>, ResultsError> {
    Ok(found_behind(path).map_err(FolderError::read(path))?)
}

/// Maps are read as the means that are drawn, so that they take no more memory for a larger lattice.
#[cfg(feature = "plot")]
impl Reduction for CellMeans {
    fn of(columns: usize, rows: usize) -> Self {
        Self::new(columns, rows)
    }

    fn add(&mut self, values: impl Iterator<Item = f32>) {
        self.add(values);
    }

    fn finish(self) -> Vec<f32> {
        self.finish()
    }
}

/// mu* of snapshots: of an instant from the summary, else of its row of the series, which a thinned one may lack.
#[cfg(feature = "plot")]
pub(crate) struct MuStar<'a> {
    instants: &'a [InstantSummary],
    /// By steps.
    rows: HashMap<u64, f64>,
}

#[cfg(feature = "plot")]
impl<'a> MuStar<'a> {
    pub(crate) fn of(instants: &'a [InstantSummary], rows: impl Iterator<Item = (u64, f64)>) -> Self {
        Self {
            instants,
            rows: rows.collect(),
        }
    }

    /// mu* of a snapshot; not a number if it is not known.
    pub(crate) fn at(&self, frame: &FieldFrame) -> f64 {
        let mut instants = self.instants.iter();
        let instant = instants.find(|instant| instant.time_star == frame.time_star);
        let found = instant.map(|instant| instant.mu_star);
        found
            .or_else(|| self.rows.get(&frame.step).copied())
            .unwrap_or(f64::NAN)
    }
}

/// Draws the maps of the stress of a run; none if it kept no such field.
#[cfg(feature = "plot")]
fn draw_stress(folder: &Path) -> Result<Option<Picture>, ResultsError> {
    let case = case_of(folder)?;
    draw_maps(folder, case.as_ref(), field_of_maps(case.as_ref()))
}

/// Draws the maps of a field of a run folder from its files, which must be there and undamaged.
///
/// # Errors
/// When it cannot be read, or holds no such maps.
#[cfg(feature = "plot")]
pub fn draw_field(folder: &Path, field: Field) -> Result<Picture, ResultsError> {
    draw_maps(folder, case_of(folder)?.as_ref(), field)?.ok_or_else(|| ResultsError::NoMaps {
        path: folder.join(FIELDS),
        field: field_info(field).name,
    })
}

/// The field whose maps are drawn of a run.
#[cfg(feature = "plot")]
pub(crate) fn field_of_maps(case: Option<&CaseFile>) -> Field {
    case.map_or(Field::ContactStress, mapped_field)
}

/// The case of a run folder; files that have lost theirs can be drawn as well.
#[cfg(feature = "plot")]
pub(crate) fn case_of(folder: &Path) -> Result<Option<CaseFile>, ResultsError> {
    let path = folder.join(CASE);
    let case = found(&path)?.map(|_| CaseFile::load(&path, &[]));
    Ok(case.transpose()?)
}

/// The scale of the maps of a field.
#[cfg(feature = "plot")]
pub(crate) struct MapScale {
    /// What a colour bar says of it.
    title: String,
    /// The same in short.
    pub(crate) symbol: String,
    /// The unit in which its values are drawn.
    pub(crate) unit: f32,
    /// The values at the ends of the bar.
    pub(crate) range: [f64; 2],
}

#[cfg(feature = "plot")]
impl MapScale {
    /// Of these values of a field, in the unit of its file.
    pub(crate) fn of(field: Field, case: Option<&CaseFile>, values: impl Iterator<Item = f32>) -> Self {
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
            (Field::Sliding, _) => return Self::of_share("share that slides".to_owned(), symbol),
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

    /// Of values from 0 to 1.
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
#[cfg(feature = "plot")]
fn extent(values: impl Iterator<Item = f32>) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite()).map(f64::from);
    finite.fold([0.0, 0.0], |[lo, hi]: [f64; 2], value| {
        [lo.min(value), hi.max(value)]
    })
}

/// Draws the maps of a field of a run; none if it has not kept it.
#[cfg(feature = "plot")]
fn draw_maps(folder: &Path, case: Option<&CaseFile>, field: Field) -> Result<Option<Picture>, ResultsError> {
    let fields = fields::read_maps::<CellMeans>(&folder.join(FIELDS), field, |labels| {
        fields::few_of(labels, MAX_MAPS)
    })?;
    if fields.names.is_empty() || fields.frames.is_empty() {
        return Ok(None);
    }
    let values = fields.frames.iter().flat_map(|frame| &frame.values).flatten();
    let scale = MapScale::of(field, case, values.copied());
    let point = |row: SeriesRow| (row.step, row.mu_star);
    let rows = series::read_rows(&folder.join(SERIES), SERIES, point)?;
    let Summary { instants, motion, .. } = read_summary(folder)?;
    let mu_star = MuStar::of(&instants, rows.into_iter());
    let (nx, ny) = (fields.columns(), fields.rows());
    let maps = fields.frames.into_iter().map(|frame| StressMap {
        mu_star: mu_star.at(&frame),
        label: separated(&frame.label),
        time_star: frame.time_star,
        values: {
            let values = frame.values.into_iter().next().unwrap_or_default();
            values.into_iter().map(|value| value / scale.unit).collect()
        },
    });
    let maps = StressMaps {
        nx,
        ny,
        block_size: fields.block_size * fields.stride as f64,
        textured: fields.textured,
        maps: maps.collect(),
        value_title: scale.title,
        range: scale.range,
        is_torque: motion == Some(Motion::Rotation),
    };
    let drawn = plot::stress(&maps).map(Some);
    drawn.map_err(|source| ResultsError::Picture {
        name: field_info(field).name,
        source,
    })
}

/// The letters of the instants of a map, which its file joins.
#[cfg(feature = "plot")]
pub(crate) fn separated(letters: &str) -> String {
    letters.chars().map(String::from).collect::<Vec<_>>().join(", ")
}

/// Rows of the kymograph that are shown at least, where the run has so many.
#[cfg(feature = "plot")]
const MIN_INSTANTS: usize = 32;

/// Draws how slip has spread, in a run with a transition.
#[cfg(feature = "plot")]
fn draw_front(folder: &Path) -> Result<Option<Picture>, ResultsError> {
    let (summary, path) = (read_summary(folder)?, folder.join(KYMOGRAPH));
    if !summary.transition || found(&path)?.is_none() {
        return Ok(None);
    }
    let kymograph = fields::read_kymograph(&path)?;
    let mut fields = fields::read_first_slips::<CellMeans>(&folder.join(FIELDS))?;
    let first_slips = fields.frames.pop().and_then(|mut frame| frame.values.pop());
    let map = FrontMap {
        nx: fields.columns(),
        ny: fields.rows(),
        block_size: fields.block_size * fields.stride as f64,
        textured: fields.textured,
        first_slips: first_slips.unwrap_or_default(),
        nucleations: summary
            .nucleations
            .iter()
            .map(|site| [site.x_m, site.y_m])
            .collect(),
    };
    let rows = rows_of_the_front(&kymograph.time_star, &summary);
    let columns = kymograph.columns();
    let times = &kymograph.time_star[rows.clone()];
    let [first, last] = [times.first(), times.last()].map(|time| time.copied().unwrap_or_default());
    // A row stands for the time around it.
    let half = 0.5 * (last - first) / (times.len() as f64 - 1.0).max(1.0);
    let space_time = SpaceTime {
        place: match summary.motion {
            Some(Motion::Rotation) => "distance from the axis".to_owned(),
            _ => "place along the drive".to_owned(),
        },
        places: kymograph.places,
        times: [first - half, last + half],
        columns,
        shares: kymograph.sliding_share[rows.start * columns..rows.end * columns].to_vec(),
    };
    let drawn = plot::front(&map, &space_time).map(Some);
    drawn.map_err(|source| ResultsError::Picture {
        name: "front",
        source,
    })
}

/// The rows of a kymograph while the front passes, with a quarter of that time before and as much again after it.
#[cfg(feature = "plot")]
fn rows_of_the_front(times: &[f64], summary: &Summary) -> Range<usize> {
    let from = summary.first_slip_time_star.unwrap_or(summary.onset_time_star);
    let passes = summary.front_duration_star.unwrap_or_default();
    let duration = (1.2 * passes).max(summary.onset_time_star - from).max(0.0);
    let start = times.partition_point(|time| *time < from - 0.25 * duration);
    let end = times.partition_point(|time| *time <= from + 2.0 * duration);
    let more = MIN_INSTANTS.saturating_sub(end.saturating_sub(start)).div_ceil(2);
    start.saturating_sub(more)..(end.max(start) + more).min(times.len())
}

/// Draws how far the events of slip of a slider driven at an edge have reached, against the load after them; none of another run. An
/// event counts if it is longer than all before: a shorter one slips over what these have left behind.
#[cfg(feature = "plot")]
fn draw_precursors(folder: &Path) -> Result<Option<Picture>, ResultsError> {
    let path = folder.join(PRECURSORS);
    if found(&path)?.is_none() {
        return Ok(None);
    }
    let mut longest = 0.0;
    let mut is_longer = |row: &PrecursorRow| {
        let is_longer = row.length > longest;
        longest = row.length.max(longest);
        is_longer
    };
    let rows = precursors::read_csv(&path)?;
    let longer = rows.into_iter().filter(|row| is_longer(row));
    let points = longer.filter_map(|row| Some((row.friction_coefficient_after?, row.length)));
    let curve = |label: &str, points: Vec<(f64, f64)>, line: bool| {
        let (x, mean): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        Response {
            label: label.to_owned(),
            low: vec![f64::NAN; x.len()],
            high: vec![f64::NAN; x.len()],
            x,
            mean,
            line,
            ..Response::default()
        }
    };
    let mut curves = vec![curve("events", points.collect(), false)];
    let case = CaseFile::load(&folder.join(CASE), &[])?;
    if let Some((mu_kinetic, slope)) = equal_chain(&case) {
        let lengths = (0..=100).map(|percent| f64::from(percent) / 100.0);
        let points = lengths.map(|length| (precursor_load(length, mu_kinetic, slope), length));
        curves.push(curve("exact", points.collect(), true));
    }
    let drawn = plot::response(&Responses {
        x_title: "tangential over normal force F\u{209c}/F\u{2099} after the event".to_owned(),
        y_title: "length over that of the slider L\u{209a}/L".to_owned(),
        curves,
        ..Responses::default()
    });
    drawn.map(Some).map_err(|source| ResultsError::Picture {
        name: "precursors",
        source,
    })
}

/// Kinetic coefficient and slope of the pressure from the driven end, of a chain of equal thresholds that is pulled along itself.
#[cfg(feature = "plot")]
fn equal_chain(case: &CaseFile) -> Option<(f64, f64)> {
    let (slider, load, friction) = (&case.slider, &case.load, &case.friction);
    let edge = case.drive.edge()?;
    let axis = edge.axis();
    let is_chain = slider.blocks[1 - axis] == 1 && slider.edges[1 - axis] == Edges::Free;
    let is_pulled_along = case.drive.direction.rem_euclid(180.0) == [0.0, 90.0][axis];
    let is_equal = friction.sigma_static_star == 0.0
        && friction.sigma_kinetic_star == 0.0
        && friction.mu_static_field.is_none()
        && friction.mu_kinetic_field.is_none()
        && friction.adhesion_kinetic.si() == 0.0
        && load.pressure_field.is_none()
        && case.texture.is_empty();
    let slope = match &load.profile {
        None => 0.0,
        Some(profile) if profile.along as usize == axis => profile.relative_slope,
        Some(_) => return None,
    };
    let slope = match edge {
        Edge::Left | Edge::Bottom => slope,
        Edge::Right | Edge::Top => -slope,
    };
    let mu_kinetic = match friction.kinetic {
        KineticFriction::RStar(r_star) => r_star * friction.mu_static,
        KineticFriction::MuKinetic(mu_kinetic) => mu_kinetic,
    };
    (is_chain && is_pulled_along && is_equal).then_some((mu_kinetic, slope))
}

#[cfg(all(test, feature = "plot"))]
mod tests {
    use super::*;

    #[test]
    fn scales_have_the_unit_that_suits() {
        let values = [-2e-9_f32, f32::NAN, 5e-9];
        let scale = MapScale::of(Field::DisplacementX, None, values.into_iter());
        assert_eq!((scale.symbol.as_str(), scale.unit), ("u_x (nm)", 1e-9));
        // Numbers of 32 bits.
        assert!((scale.range[0] + 2.0).abs() < 1e-6 && (scale.range[1] - 5.0).abs() < 1e-6);
        for field in [Field::VelocityY, Field::Sliding] {
            let scale = MapScale::of(field, None, [0.0; 3].into_iter());
            assert_eq!(scale.range, [0.0, 1.0]);
        }
        // Of a case, in units of P mu_s.
        let case = CaseFile::parse("load.pressure = '2 MPa'\nfriction.mu_static = 0.5", "case", &[]).unwrap();
        let scale = MapScale::of(Field::Traction, Some(&case), [5e5].into_iter());
        assert_eq!(
            (scale.symbol.as_str(), scale.unit, scale.range),
            ("\u{3c4}_f*", 1e6, [0.0, 0.5])
        );
    }
}
