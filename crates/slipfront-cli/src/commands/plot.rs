//! `slipfront plot`: pictures again, from the files of runs.

use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use slipfront_base::disk::{is_same, make_folders, read_limited, write_atomic};
use slipfront_base::machine::available_of;
use slipfront_base::number_format::{byte_size, count, four_digits, with_si_prefix};
use slipfront_case::arrays::extension;
use slipfront_case::case::PROGRAM;
use slipfront_case::field_info::{FIELDS, field_info, field_named};
use slipfront_plot::{Picture, PictureSize};
use slipfront_run::instrument::{Instrument, InstrumentKeys};
use slipfront_run::measured::{Column, Correction, Measure, MeasuredError, MeasuredRecord};
use slipfront_run::names::MANIFEST;
use slipfront_run::pictures;
use slipfront_run::pictures::friction::{
    Against, AxisUnits, Fit, FrictionLook, OverlaidRecord, Overlay, overlay, overlay_measured,
};
use slipfront_run::run_files::RunFiles;
use slipfront_run::run_folder::inspection::Inspection;
use slipfront_run::verify::{expect_as_written, inspect};
use slipfront_study::verify::has_records;

use crate::failure::Failure;
use crate::print::print_message;
use crate::signals::Signals;
use crate::table_args::TableArgs;
use crate::threads::set_threads;

/// Draw the pictures of a run, or compare the curves of several
///
/// The axes are of your choice, and measured records may be drawn over the curves
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront plot results/baseline
  slipfront plot results/circle results/groove_across -o results/overlay
  slipfront plot results/circle --units si --against displacement -o results/newtons
  slipfront plot results/circle --data force.csv --x time_s --y force_n
  slipfront plot results/circle --data force.csv --x time_s --y force_n --instrument rig.toml
  slipfront plot results/a results/b --width 120 --height 90 --font-size 10 --name smooth --name textured -o both
  slipfront plot results/circle --field traction -o results/traction
  slipfront plot results/circle --field kymograph -o results/kymograph")]
pub(crate) struct PlotCommand {
    /// Run folders
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Draw friction alone, in these units
    #[arg(long)]
    units: Option<UnitsName>,
    /// Draw friction alone, against this [default: time, or where runs of different materials can be
    /// compared]
    #[arg(long)]
    against: Option<AgainstName>,
    /// Draw maps of this field of one run alone; kymograph is the share of sliding blocks against place and
    /// time, over the whole run
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(FIELDS.map(|info| info.name).into_iter().chain([KYMOGRAPH])), conflicts_with_all = ["units", "against", "data"])]
    field: Option<String>,
    /// Draw friction alone, this wide, in mm [default: 85]
    #[arg(long, value_name = "MM", value_parser = millimetres, conflicts_with = "field")]
    width: Option<f64>,
    /// Draw friction alone, this high, in mm
    #[arg(long, value_name = "MM", value_parser = millimetres, conflicts_with = "field")]
    height: Option<f64>,
    /// Draw friction alone, with labels of this size, in pt [default: 8]; numbers, lines and marks grow with
    /// them
    #[arg(long, value_name = "PT", value_parser = points, conflicts_with = "field")]
    font_size: Option<f64>,
    /// Draw friction alone, with this name of a run in the legend; once for each folder, and a last time for
    /// the record of --data
    #[arg(long = "name", value_name = "TEXT", conflicts_with = "field")]
    names: Vec<String>,
    /// Draw friction alone, with this title of the horizontal axis; a character after _ is a subscript
    #[arg(long, value_name = "TEXT", conflicts_with = "field")]
    x_label: Option<String>,
    /// Draw friction alone, with this title of the axis of friction
    #[arg(long, value_name = "TEXT", conflicts_with = "field")]
    y_label: Option<String>,
    /// A measured record to draw with the curves, in SI units: a table of text (.csv)
    #[arg(long, value_name = "FILE", requires_all = ["x", "y"])]
    data: Option<PathBuf>,
    /// Column of times of the record, or of displacements with `--against displacement`: name or number from
    /// 1
    #[arg(long, value_name = "COLUMN", requires = "data")]
    x: Option<String>,
    /// Column of forces of the record, or of coefficients if its unit is 1
    #[arg(long, value_name = "COLUMN", requires = "data")]
    y: Option<String>,
    /// Unit of the column of times or displacements [default: that in its header]
    #[arg(long, value_name = "UNIT", requires = "data")]
    x_unit: Option<String>,
    /// Unit of the column of forces [default: that in its header]
    #[arg(long, value_name = "UNIT", requires = "data")]
    y_unit: Option<String>,
    #[command(flatten)]
    table: TableArgs,
    /// Factor of the forces: -1 turns their sign
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "data",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    y_factor: f64,
    /// Number added to the forces after that, in N or 1
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "data",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    y_offset: f64,
    /// Number added to the record's times or displacements, in s or m [default: what fits the first run
    /// best, if nothing else fits about as well]
    #[arg(long, value_name = "NUMBER", requires = "data", allow_negative_numbers = true)]
    shift: Option<f64>,
    /// Draw the curves as an instrument writes them, and compare the record with that: the table
    /// `[instrument]` of this file, such as a calibration file. Marks of instants and peaks, which are
    /// those of friction itself, are left out
    #[arg(long, value_name = "FILE", requires = "data")]
    instrument: Option<PathBuf>,
    /// Folder for the pictures [default: the run's own; results/overlay for several, for friction and for a
    /// field alone]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace pictures that stand there
    #[arg(long)]
    force: bool,
}

/// Units of the axes.
#[derive(Clone, Copy, ValueEnum)]
enum UnitsName {
    /// Dimensionless
    Star,
    /// Newtons, and seconds or metres
    Si,
}

/// The horizontal axis.
#[derive(Clone, Copy, ValueEnum)]
enum AgainstName {
    /// Time
    Time,
    /// Path of the drive
    Displacement,
}

impl PlotCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        self.out.as_deref().map_or(Ok(()), expect_a_folder)?;
        let mut runs = Vec::new();
        for folder in &self.folders {
            expect_results(folder)?;
            let run = inspect(folder).map_err(Failure::input)?;
            expect_as_written(&run, pictures::is_drawn_from).map_err(Failure::input)?;
            runs.push(run);
        }
        self.expect_names()?;
        expect_memory(pictures::memory(&self.folders).map_err(Failure::input)?)?;
        let (out, drawn) = match (self.field.as_deref(), self.folders.as_slice()) {
            (Some(name), [folder]) => {
                let run = RunFiles::Folder(folder);
                let (name, picture) = match field_named(name) {
                    Some(field) => (field_info(field).name, pictures::draw_field(run, field)),
                    None => (KYMOGRAPH, pictures::draw_kymograph(run)),
                };
                let picture = picture.map_err(Failure::input)?;
                (PathBuf::from("results/overlay"), vec![(name, picture)])
            }
            (Some(_), _) => {
                let sentence = "--field draws the maps of one run: name one folder";
                return Err(Failure::input(anyhow::anyhow!(sentence)));
            }
            (None, [folder]) if !self.draws_friction_alone() => {
                let drawn = pictures::draw(RunFiles::Folder(folder));
                (folder.clone(), drawn.map_err(Failure::input)?)
            }
            (None, folders) => {
                let Overlay { picture, note, fit } = self.overlay(folders)?;
                if let Some(note) = note {
                    print_message(&format!("note: {note}\n"));
                }
                if let (Some(fit), Some(data)) = (fit, &self.data) {
                    print_message(&self.fit_report(&fit, data));
                }
                (PathBuf::from("results/overlay"), vec![("friction", picture)])
            }
        };
        let out = self.out.unwrap_or(out);
        let failed = |error: std::io::Error| {
            Failure::running(anyhow::anyhow!(
                "cannot write pictures to {}: {error}",
                out.display()
            ))
        };
        let files: Vec<(String, &[u8])> = drawn
            .iter()
            .flat_map(|(name, Picture { svg, png })| {
                [("svg", svg.as_bytes()), ("png", png)]
                    .map(|(ending, bytes)| (format!("{name}.{ending}"), bytes))
            })
            .collect();
        let own = match runs.as_slice() {
            [run] if is_same(&run.path, &out) => Some(run),
            _ => None,
        };
        if own.is_none() {
            refuse_other_run(&out)?;
        }
        if !self.force {
            refuse_to_replace(&out, &files, own)?;
        }
        // Not before: until here a signal ends the process, and nothing is left behind.
        let signals = Signals::catch().map_err(Failure::running)?;
        make_folders(&out).map_err(failed)?;
        let mut written = String::new();
        for (name, bytes) in files {
            Failure::if_stopped(&signals)?;
            let path = out.join(name);
            write_atomic(&path, bytes).map_err(failed)?;
            written += &format!("{}\n", path.display());
        }
        print_message(&written);
        Ok(())
    }
}

impl PlotCommand {
    fn size(&self) -> PictureSize {
        PictureSize {
            width_mm: self.width,
            height_mm: self.height,
            font_pt: self.font_size,
        }
    }

    /// Whether an option asks for the picture of friction, where a run has others.
    fn draws_friction_alone(&self) -> bool {
        let has_labels = !self.names.is_empty() || self.x_label.is_some() || self.y_label.is_some();
        has_labels
            || self.units.is_some()
            || self.against.is_some()
            || self.data.is_some()
            || self.size() != PictureSize::default()
    }

    fn look(&self) -> FrictionLook {
        FrictionLook {
            names: self.names.clone(),
            x_label: self.x_label.clone(),
            y_label: self.y_label.clone(),
            size: self.size(),
        }
    }

    /// Refuses names of which there are not as many as folders, or one more for a record.
    fn expect_names(&self) -> Result<(), Failure> {
        let (given, runs) = (self.names.len(), self.folders.len());
        let most = runs + usize::from(self.data.is_some());
        if given == 0 || (runs..=most).contains(&given) {
            return Ok(());
        }
        Err(Failure::input(anyhow::anyhow!(
            "{} for {}: give --name once for each, in their order",
            count(given, "name"),
            count(runs, "run")
        )))
    }

    fn against(&self) -> Option<Against> {
        self.against.map(|name| match name {
            AgainstName::Time => Against::Time,
            AgainstName::Displacement => Against::Displacement,
        })
    }

    /// Friction alone, on the axes that were asked for, with a measured record if there is one.
    fn overlay(&self, folders: &[PathBuf]) -> Result<Overlay, Failure> {
        let drawn = match (self.units, &self.data) {
            (Some(UnitsName::Star), Some(_)) => {
                let sentence = "a measured record has units, and is drawn in them: leave `--units star` out";
                return Err(Failure::input(anyhow::anyhow!(sentence)));
            }
            (_, Some(path)) => {
                let mut measured = self.measured(path).map_err(Failure::input)?;
                measured.instrument = self.instrument(measured.record.of)?;
                for note in measured.record.notes() {
                    print_message(&format!("note: {note}\n"));
                }
                overlay_measured(
                    folders,
                    self.against().unwrap_or_default(),
                    &measured,
                    &self.look(),
                )
            }
            (Some(UnitsName::Si), None) => overlay(folders, AxisUnits::Si, self.against(), &self.look()),
            (_, None) => overlay(folders, AxisUnits::Star, self.against(), &self.look()),
        };
        drawn.map_err(Failure::input)
    }

    fn measured(&self, path: &Path) -> Result<OverlaidRecord, MeasuredError> {
        let column = |name: &Option<String>, unit: &Option<String>| Column {
            name: name.clone().unwrap_or_default(),
            unit: unit.clone(),
        };
        let (x, y) = (column(&self.x, &self.x_unit), column(&self.y, &self.y_unit));
        let along = match self.against() {
            Some(Against::Displacement) => Measure::Displacement,
            Some(Against::Time) | None => Measure::Time,
        };
        let mut record = MeasuredRecord::read(path, [&x, &y], along, self.table.options())?;
        record.correct(&Correction {
            y_factor: self.y_factor,
            y_offset: self.y_offset,
            ..Correction::default()
        });
        Ok(OverlaidRecord {
            label: path.display().to_string(),
            record,
            shift: self.shift,
            instrument: None,
        })
    }

    /// The instrument that wrote a record of this quantity.
    fn instrument(&self, friction: Measure) -> Result<Option<Instrument>, Failure> {
        let Some(path) = &self.instrument else {
            return Ok(None);
        };
        let keys = InstrumentKeys::load(path).map_err(Failure::input)?;
        let made = keys.instrument(friction);
        let named = made.map_err(|error| Failure::input(anyhow::anyhow!("{}: {error}", path.display())));
        named.map(Some)
    }

    /// The fit of a measured record to each run, in words.
    fn fit_report(&self, fit: &Fit, data: &Path) -> String {
        let [x, y] = fit.measures.map(Measure::unit);
        let quantity = |value: f64, unit: &str| match unit {
            "1" => four_digits(value),
            unit => with_si_prefix(value, unit),
        };
        let mut text = format!("{}: shifted by {}\n", data.display(), quantity(fit.shift, x));
        for (folder, misfit) in self.folders.iter().zip(&fit.misfits) {
            let misfit = misfit.map_or("too little in common for a misfit".to_owned(), |misfit| {
                format!(
                    "RMS misfit {} over {} of {}",
                    quantity(misfit.rms, y),
                    misfit.points,
                    count(fit.points, "point")
                )
            });
            text += &format!("  {}: {misfit}\n", folder.display());
        }
        text
    }
}

/// The kymograph as `--field` names it, and its picture.
const KYMOGRAPH: &str = "kymograph";

/// A side of a picture in mm.
fn millimetres(text: &str) -> Result<f64, String> {
    within(text, 20.0, PictureSize::MAX_MM, "mm")
}

/// A size of letters in pt.
fn points(text: &str) -> Result<f64, String> {
    within(text, 3.0, 40.0, "pt")
}

/// A number with a unit within bounds.
pub(super) fn within(text: &str, least: f64, most: f64, unit: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("a number of {unit} from {least} to {most}"))
}

/// Refuses the name of a picture where a folder for several is asked for, unless there is such a folder.
fn expect_a_folder(out: &Path) -> Result<(), Failure> {
    if !["svg", "png"].contains(&extension(out).as_str()) || out.is_dir() {
        return Ok(());
    }
    let folder = out.with_extension("");
    Err(Failure::input(anyhow::anyhow!(
        "--out names a folder, in which pictures have names of their own, and {} is that of a picture: write --out {}",
        out.display(),
        folder.display()
    )))
}

/// Refuses pictures for which there is no memory: `bytes` beside the program.
pub(super) fn expect_memory(bytes: f64) -> Result<(), Failure> {
    let needed = PROGRAM + bytes;
    let available = available_of(needed);
    if needed <= available {
        return Ok(());
    }
    Err(Failure::input(anyhow::anyhow!(
        "this takes about {} of memory where {} are available to this process: give it more, in a queue for \
         example with `--mem`",
        byte_size(needed),
        byte_size(available)
    )))
}

pub(super) fn expect_results(folder: &Path) -> Result<(), Failure> {
    if folder.is_file() {
        return Err(Failure::input(anyhow::anyhow!(
            "{} is a file: name the folder of a finished run; a measured record goes with `plot --data`",
            folder.display()
        )));
    }
    let path = folder.join("summary.json");
    let sentence = match path.try_exists() {
        Ok(true) => return Ok(()),
        Ok(false) if has_records(folder) => format!(
            "{} is the folder of a study, which holds its pictures: name folders of runs",
            folder.display()
        ),
        Ok(false) if !folder.exists() => missing_folder(folder),
        Ok(false) => format!(
            "{} holds no summary.json: name the folder of a run that is finished",
            folder.display()
        ),
        Err(error) => format!("cannot read {}: {error}", path.display()),
    };
    Err(Failure::input(anyhow::anyhow!(sentence)))
}

/// The sentence about a folder that is not there, with the one among the results that was probably meant.
pub(super) fn missing_folder(folder: &Path) -> String {
    let among_results = Path::new("results").join(folder);
    let meant = if among_results.is_dir() {
        format!(": did you mean {}?", among_results.display())
    } else {
        String::new()
    };
    format!("there is no folder {}{meant}", folder.display())
}

/// Refuses a folder of a run to which these pictures do not belong.
pub(super) fn refuse_other_run(out: &Path) -> Result<(), Failure> {
    let manifest = out.join(MANIFEST);
    let sentence = match manifest.try_exists() {
        Ok(false) => return Ok(()),
        Ok(true) => format!(
            "{} holds a run, and these are not its pictures: choose another folder with --out",
            out.display()
        ),
        Err(error) => format!("cannot read {}: {error}", manifest.display()),
    };
    Err(Failure::input(anyhow::anyhow!(sentence)))
}

/// Refuses to replace files where the pictures go, unless they are equal, or pictures that the run in the
/// folder has drawn there, if the new ones are its `own`.
pub(super) fn refuse_to_replace(
    out: &Path,
    files: &[(String, &[u8])],
    own: Option<&Inspection>,
) -> Result<(), Failure> {
    for (name, bytes) in files {
        let is_same = |path: &Path| read_limited(path, bytes.len() as u64).is_ok_and(|found| found == *bytes);
        if let Some(sentence) = in_the_way(out, name, own)?
            && !is_same(&out.join(name))
        {
            return Err(Failure::input(anyhow::anyhow!(sentence)));
        }
    }
    Ok(())
}

/// Reason for which a file cannot replace another, unless the run in the folder has drawn that one and the
/// new file is its `own`.
pub(super) fn in_the_way(
    out: &Path,
    name: &str,
    own: Option<&Inspection>,
) -> Result<Option<String>, Failure> {
    let path = out.join(name);
    if path.symlink_metadata().is_err() {
        return Ok(None);
    }
    let is_drawn = own.map(|run| run.has_written(name)).transpose();
    let what = match is_drawn.map_err(Failure::input)? {
        Some(true) => return Ok(None),
        Some(false) => "is not as the run has drawn it",
        None => "exists",
    };
    Ok(Some(format!(
        "{} {what}: choose another place with --out, or replace it with --force",
        path.display()
    )))
}
