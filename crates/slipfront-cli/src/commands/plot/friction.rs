//! Options of the friction picture: its axes, its names, and a measured record over the curves.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use slipfront_base::number_format::{count, four_digits, with_si_prefix};
use slipfront_plot::{Picture, PictureSize};
use slipfront_run::instrument::{Instrument, InstrumentKeys};
use slipfront_run::measured::{Column, Correction, Measure, MeasuredError, MeasuredRecord};
use slipfront_run::pictures::friction::{
    Against, AxisUnits, Fit, FrictionLook, OverlaidRecord, Overlay, overlay, overlay_measured,
};

use crate::bounds::{factor, summand};
use crate::failure::Failure;
use crate::print::print_message;
use crate::table_args::TableArgs;

/// The picture of friction.
#[derive(Args)]
pub(super) struct FrictionArgs {
    /// Draw only friction, in these units
    #[arg(long)]
    units: Option<UnitsName>,
    /// Draw only friction, against this quantity [default: time, or the quantity that makes runs of different
    /// materials comparable]
    #[arg(long)]
    against: Option<AgainstName>,
    /// Draw only friction, with this name of a run in the legend; one per folder, then one for the record of
    /// --data
    #[arg(long = "name", value_name = "TEXT", conflicts_with = "field")]
    names: Vec<String>,
    /// Draw only friction, with this title of the horizontal axis; a character after _ is a subscript
    #[arg(long, value_name = "TEXT", conflicts_with = "field")]
    x_label: Option<String>,
    /// Draw only friction, with this title of the friction axis
    #[arg(long, value_name = "TEXT", conflicts_with = "field")]
    y_label: Option<String>,
    /// Measured record to draw with the curves, in SI units: a text table (.csv)
    #[arg(long, value_name = "FILE", requires_all = ["x", "y"])]
    data: Option<PathBuf>,
    /// Column of times in the record, or of displacements with `--against displacement`: name or number from
    /// 1
    #[arg(long, value_name = "COLUMN", requires = "data")]
    x: Option<String>,
    /// Column of forces in the record, or of coefficients if its unit is 1
    #[arg(long, value_name = "COLUMN", requires = "data")]
    y: Option<String>,
    /// Unit of the column of times or displacements [default: unit in its header]
    #[arg(long, value_name = "UNIT", requires = "data")]
    x_unit: Option<String>,
    /// Unit of the column of forces [default: unit in its header]
    #[arg(long, value_name = "UNIT", requires = "data")]
    y_unit: Option<String>,
    #[command(flatten)]
    table: TableArgs,
    /// Factor of the forces; -1 changes their sign
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "data",
        default_value_t = 1.0,
        value_parser = factor,
        allow_negative_numbers = true
    )]
    y_factor: f64,
    /// Number added to the forces after multiplication, in N or 1
    #[arg(
        long,
        value_name = "NUMBER",
        requires = "data",
        default_value_t = 0.0,
        value_parser = summand,
        allow_negative_numbers = true
    )]
    y_offset: f64,
    /// Number added to the times or displacements of the record, in s or m [default: the best fit to the
    /// first run, if it is unique]
    #[arg(long, value_name = "NUMBER", requires = "data", value_parser = summand, allow_negative_numbers = true)]
    shift: Option<f64>,
    /// Draw the curves as recorded by an instrument, and compare them with the record. The file, such as a
    /// calibration file, has a table `[instrument]`. Marks of instants and peaks of the true friction are
    /// omitted
    #[arg(long, value_name = "FILE", requires = "data")]
    instrument: Option<PathBuf>,
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

impl FrictionArgs {
    /// Whether an option requests the friction picture, in place of the other pictures of a run.
    pub(super) fn is_asked_for(&self) -> bool {
        self.option().is_some()
    }

    /// An option that requests the friction picture; none if there is none.
    pub(super) fn option(&self) -> Option<&'static str> {
        let options = [
            ("--units", self.units.is_some()),
            ("--against", self.against.is_some()),
            ("--name", !self.names.is_empty()),
            ("--x-label", self.x_label.is_some()),
            ("--y-label", self.y_label.is_some()),
            ("--data", self.data.is_some()),
        ];
        options
            .iter()
            .find(|(_, is_given)| *is_given)
            .map(|(option, _)| *option)
    }

    /// Draws friction alone, and prints notes on it.
    pub(super) fn draw(&self, folders: &[PathBuf], size: PictureSize) -> Result<Picture, Failure> {
        let Overlay { picture, note, fit } = self.overlay(folders, size)?;
        if let Some(note) = note {
            print_message(&format!("note: {note}\n"));
        }
        if let (Some(fit), Some(data)) = (fit, &self.data) {
            print_message(&fit_report(folders, &fit, data));
        }
        Ok(picture)
    }

    fn look(&self, size: PictureSize) -> FrictionLook {
        FrictionLook {
            names: self.names.clone(),
            x_label: self.x_label.clone(),
            y_label: self.y_label.clone(),
            size,
        }
    }

    /// Refuses names unless there is one for each run, and optionally one more for a record.
    pub(super) fn expect_names(&self, runs: usize) -> Result<(), Failure> {
        let given = self.names.len();
        let most = runs + usize::from(self.data.is_some());
        if given == 0 || (runs..=most).contains(&given) {
            return Ok(());
        }
        Err(Failure::input(format!(
            "{} for {}: give --name once for each, in the same order",
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

    /// Friction alone, on the requested axes, with a measured record if there is one.
    fn overlay(&self, folders: &[PathBuf], size: PictureSize) -> Result<Overlay, Failure> {
        let look = self.look(size);
        let drawn = match (self.units, &self.data) {
            (Some(UnitsName::Star), Some(_)) => {
                let sentence = "a measured record is drawn in its units: leave `--units star` out";
                return Err(Failure::input(sentence));
            }
            (_, Some(path)) => {
                let mut measured = self.measured(path).map_err(Failure::input)?;
                measured.instrument = self.instrument(measured.record.quantity)?;
                for note in measured.record.notes() {
                    print_message(&format!("note: {note}\n"));
                }
                overlay_measured(folders, self.against().unwrap_or_default(), &measured, &look)
            }
            (Some(UnitsName::Si), None) => overlay(folders, AxisUnits::Si, self.against(), &look),
            (_, None) => overlay(folders, AxisUnits::Star, self.against(), &look),
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
        let named = made.map_err(|error| Failure::input(format!("{}: {error}", path.display())));
        named.map(Some)
    }
}

/// The fit of a measured record to each run, in words.
fn fit_report(folders: &[PathBuf], fit: &Fit, data: &Path) -> String {
    let [x, y] = fit.measures.map(Measure::unit);
    let quantity = |value: f64, unit: &str| match unit {
        "1" => four_digits(value),
        unit => with_si_prefix(value, unit),
    };
    let mut text = format!("{}: shifted by {}\n", data.display(), quantity(fit.shift, x));
    for (folder, misfit) in folders.iter().zip(&fit.misfits) {
        let misfit = misfit.map_or("too little overlap for a misfit".to_owned(), |misfit| {
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
