//! `slipfront plot`: redraws pictures from the files of runs and studies.

mod files;
mod friction;
mod look;
mod project;

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use slipfront_base::disk::is_same;
use slipfront_case::field_info::{FIELDS, field_info, field_named};
use slipfront_plot::{PictureFormat, PictureLook, PictureSize};
use slipfront_run::names::RunPicture;
use slipfront_run::pictures;
use slipfront_run::run_files::RunFiles;
use slipfront_run::run_folder::inspection::Inspection;
use slipfront_run::verify::{expect_as_written, inspect};

use self::files::{PictureFiles, expect_a_folder, write};
pub(super) use self::files::{expect_memory, expect_results, in_the_way, refuse_other_run};
use self::friction::FrictionArgs;
use self::look::LookArgs;
use crate::failure::Failure;
use crate::signals::Signals;
use crate::threads::set_threads;

/// Draw the pictures of a run or a study in the size and format of a journal, or compare friction curves of
/// runs
///
/// The pictures of a run, a study, a convergence, a design or a calibration are drawn from the files in its
/// folder. Options set the axes of friction curves, and can add a measured record to the curves
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront plot results/baseline
  slipfront plot results/baseline --width 89 --font-size 8 --format pdf -o figures
  slipfront plot results/coverage --width 89 --font-size 8 --format pdf -o figures
  slipfront plot results/coverage --picture static_reduction_percent --width 60 --height 45 -o inset
  slipfront plot results/circle results/groove_across -o results/overlay
  slipfront plot results/circle --units si --against displacement -o results/newtons
  slipfront plot results/baseline --data cases/calibrations/sliding.csv --x t --y F --shift 0 -o both
  slipfront plot results/tribometer --data cases/calibrations/tribometer.csv --x Time --y Fx --instrument cases/calibrations/tribometer.toml
  slipfront plot results/a results/b --width 120 --height 90 --font-size 10 --name smooth --name textured -o both
  slipfront plot results/circle --field traction -o results/traction
  slipfront plot results/circle --field kymograph -o results/kymograph

Formats are svg, png (300 dots per inch) and pdf; svg and pdf files contain their font. For EPS, convert the PDF: pdftops -eps -r 1200 friction.pdf")]
pub(crate) struct PlotCommand {
    /// Folders of runs, or one folder of a study, a convergence, a design or a calibration
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    #[command(flatten)]
    look: LookArgs,
    /// Draw only maps of this field of one run; kymograph is the fraction of sliding blocks against position
    /// and time over the whole run
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(FIELDS.map(|info| info.name).into_iter().chain([KYMOGRAPH])), conflicts_with_all = ["units", "against", "data", "names", "x_label", "y_label"])]
    field: Option<String>,
    #[command(flatten)]
    friction: FrictionArgs,
    /// Folder for the pictures [default: the results folder for all its pictures in their default size,
    /// otherwise results/overlay]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace existing pictures
    #[arg(long)]
    force: bool,
}

/// Name of the kymograph in `--field`, and of its picture.
const KYMOGRAPH: &str = "kymograph";

/// Output folder for pictures that do not belong to a single results folder.
const ELSEWHERE: &str = "results/overlay";

impl PlotCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        self.out.as_deref().map_or(Ok(()), expect_a_folder)?;
        let look = self.look.look();
        if let Some(project) = project::find(&self.folders)? {
            self.refuse_options_of_runs()?;
            let names: Vec<&str> = project.names.iter().map(String::as_str).collect();
            self.look.expect_one_of(&names)?;
            // A signal ends the work, not the process, so no file is left in the folder for temporary files.
            let signals = Signals::catch().map_err(Failure::running)?;
            let drawn = project.draw(&look, &signals.stop);
            Failure::if_stopped(&signals)?;
            let files = drawn.map_err(Failure::input)?;
            return write(&self.place(&look), &files, None, self.force, &signals);
        }
        let runs = self.runs()?;
        self.friction.expect_names(runs.len())?;
        expect_memory(pictures::memory(&self.folders).map_err(Failure::input)?)?;
        let files = self.draw_runs(&look)?;
        let out = self.place(&look);
        let own = match runs.as_slice() {
            [run] if self.draws_as_usual(&look) && is_same(&run.path, &out) => Some(run),
            _ => None,
        };
        // Signals are caught only now: until here they may simply end the process, because nothing is left
        // behind.
        let signals = Signals::catch().map_err(Failure::running)?;
        write(&out, &files, own, self.force, &signals)
    }

    /// Opens the folders, which must be folders of runs.
    fn runs(&self) -> Result<Vec<Inspection>, Failure> {
        let run = |folder: &PathBuf| {
            expect_results(folder)?;
            let run = inspect(folder).map_err(Failure::input)?;
            expect_as_written(&run, pictures::is_drawn_from).map_err(Failure::input)?;
            Ok(run)
        };
        self.folders.iter().map(run).collect()
    }

    /// Refuses options that request pictures of runs.
    fn refuse_options_of_runs(&self) -> Result<(), Failure> {
        let field = self.field.as_ref().map(|_| "--field");
        let Some(option) = field.or_else(|| self.friction.option()) else {
            return Ok(());
        };
        Err(Failure::input(format!(
            "{option} applies to pictures of runs, but {} is not a folder of a run: leave it out, or give a run, such as one in \
             its folder runs/",
            self.folders[0].display()
        )))
    }

    /// Draws the requested pictures of the runs.
    fn draw_runs(&self, look: &PictureLook) -> Result<PictureFiles, Failure> {
        let drawn = match (self.field.as_deref(), self.folders.as_slice()) {
            (Some(name), [folder]) => {
                let run = RunFiles::Folder(folder);
                let (name, picture) = match field_named(name) {
                    Some(field) => (
                        field_info(field).name,
                        pictures::draw_field(run, field, look.size),
                    ),
                    None => (KYMOGRAPH, pictures::draw_kymograph(run, look.size)),
                };
                vec![(name, picture.map_err(Failure::input)?)]
            }
            (Some(_), _) => {
                let sentence = "--field draws the maps of one run: give one folder";
                return Err(Failure::input(sentence));
            }
            (None, [folder]) if !self.friction.is_asked_for() => {
                self.look.expect_one_of(&RunPicture::ALL.map(RunPicture::name))?;
                let drawn = pictures::draw(RunFiles::Folder(folder), look).map_err(Failure::input)?;
                self.expect_drawn(folder, drawn.is_empty())?;
                drawn
            }
            (None, folders) => {
                let friction = RunPicture::Friction.name();
                self.look.expect_one_of(&[friction])?;
                vec![(friction, self.friction.draw(folders, look.size)?)]
            }
        };
        let files = drawn.iter().flat_map(|(name, picture)| {
            let file = move |format: &PictureFormat| {
                let name = format!("{name}.{}", format.ending());
                (name, picture.file(*format).into_owned())
            };
            look.formats.iter().map(file)
        });
        Ok(files.collect())
    }

    /// Refuses a run without data for the requested picture.
    fn expect_drawn(&self, folder: &Path, is_empty: bool) -> Result<(), Failure> {
        match self.look.picture() {
            Some(name) if is_empty => Err(Failure::input(format!(
                "{} has no picture {name}: the run has no data for it",
                folder.display()
            ))),
            _ => Ok(()),
        }
    }

    /// Whether the pictures are the same as in the results folder.
    fn draws_as_usual(&self, look: &PictureLook) -> bool {
        let is_own = self.field.is_none() && !self.friction.is_asked_for() && self.folders.len() == 1;
        is_own && look.size == PictureSize::default()
    }

    /// Output folder of the pictures.
    fn place(&self, look: &PictureLook) -> PathBuf {
        let usual = || match self.folders.as_slice() {
            [folder] if self.draws_as_usual(look) => folder.clone(),
            _ => PathBuf::from(ELSEWHERE),
        };
        self.out.clone().unwrap_or_else(usual)
    }
}
