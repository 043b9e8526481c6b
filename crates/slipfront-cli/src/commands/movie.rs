//! `slipfront movie`: a movie of the snapshots of a run next to its friction curve.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use clap::{Args, ValueEnum};
use slipfront::observe::Field;
use slipfront_base::disk::{folder_of, is_same, write_atomic};
use slipfront_base::number_format::{count, four_digits};
use slipfront_base::unfinished::TemporaryFolder;
use slipfront_case::arrays::extension;
use slipfront_case::case::{MAX_PICTURES, mapped_field};
use slipfront_case::case_file::{CaseFile, Snapshots};
use slipfront_case::field_info::{FIELDS, field_info, field_named};
use slipfront_plot::{Movie, MoviePictures, MovieSize};
use slipfront_run::names::MOVIE;
use slipfront_run::pictures::error::RunPictureError;
use slipfront_run::pictures::movie::MoviePace;
use slipfront_run::pictures::{self, movie};
use slipfront_run::run_files::RunFiles;
use slipfront_run::run_folder::inspection::{CaseDefect, Inspection};
use slipfront_run::verify::{expect_as_written, inspect};

use super::plot::{expect_memory, expect_results, in_the_way, refuse_other_run};
use crate::bounds::within;
use crate::failure::Failure;
use crate::print::print_message;
use crate::print_stderr::print_stderr;
use crate::run_again::{RunAgain, case_to_run, of_file};
use crate::signals::Signals;
use crate::threads::set_threads;

/// Make an animation of the snapshots of a run
///
/// Writes an animated GIF with the field and the friction curve, which marks the instant
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront movie results/circle
  slipfront movie results/circle --frames 300
  slipfront movie results/circle --seconds 8 --size 1600x800 -o circle.gif
  slipfront movie results/circle --field displacement_x -o circle.mp4    needs ffmpeg")]
pub(crate) struct MovieCommand {
    /// Run folder
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Minimum number of snapshots, at equal time intervals, in addition to the instants A-F. If the run has
    /// fewer snapshots, its case is run again in the folder for temporary files (TMPDIR) [default: 100, or
    /// the snapshots of the run if its case has `output.snapshots` or `output.movie`]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_FRAMES))]
    frames: Option<u16>,
    /// Field to show [default: the field of the maps in stress.png]
    #[arg(long, value_parser = known_field)]
    field: Option<Field>,
    /// Output file: .gif, or .mp4 (needs ffmpeg) [default: movie.gif in the folder of the run]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Duration of the movie in seconds; instants A-F are shown five times as long as other snapshots
    /// [default: about 16, and 1 more for each of these instants]
    #[arg(long, value_name = "S", value_parser = seconds)]
    seconds: Option<f64>,
    /// Snapshots per second, all shown for the same time
    #[arg(long, value_name = "N", value_parser = per_second, conflicts_with = "seconds")]
    fps: Option<f64>,
    /// Size in pixels
    #[arg(long, default_value = "800x400")]
    size: SizeName,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Number of snapshots of a run that is repeated for its movie, by default.
const FRAMES: u16 = 100;
/// Largest number of snapshots that can be requested; the start and the instants A-F are added to them.
const MOST_FRAMES: i64 = MAX_PICTURES as i64 - 7;

/// Size of a movie in pixels.
#[derive(Clone, Copy, ValueEnum)]
enum SizeName {
    #[value(name = "400x200")]
    Small,
    #[value(name = "800x400")]
    Usual,
    #[value(name = "1600x800")]
    Large,
}

fn seconds(text: &str) -> Result<f64, String> {
    within(text, 0.1, 3600.0, "s")
}

fn per_second(text: &str) -> Result<f64, String> {
    within(text, 0.1, 50.0, "1/s")
}

/// Pictures per second of an MP4 file with these durations of pictures, so that no picture is left out.
fn rate(delays: &[u16]) -> usize {
    if delays.iter().any(|delay| *delay < 4) {
        50
    } else {
        25
    }
}

fn known_field(name: &str) -> Result<Field, String> {
    let names = || FIELDS.iter().map(|info| info.name).collect::<Vec<_>>().join(", ");
    field_named(name).ok_or_else(|| format!("the fields are {}", names()))
}

impl MovieCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        let folder = &self.folder;
        expect_results(folder)?;
        let run = inspect(folder).map_err(Failure::input)?;
        expect_as_written(&run, pictures::is_drawn_from).map_err(Failure::input)?;
        let out = self.out.clone().unwrap_or_else(|| folder.join(MOVIE));
        let is_mp4 = match extension(&out).as_str() {
            "gif" => false,
            "mp4" => true,
            _ => {
                return Err(refused(format!(
                    "cannot determine the format of `{}`: use the extension .gif or .mp4",
                    out.display()
                )));
            }
        };
        let parent = folder_of(&out);
        let own = is_same(&run.path, parent).then_some(&run);
        if own.is_none() {
            refuse_other_run(parent)?;
        }
        let name = out.file_name().unwrap_or_default().to_string_lossy();
        if !self.force
            && let Some(sentence) = in_the_way(parent, &name, own)?
        {
            return Err(refused(sentence));
        }
        expect_memory(movie::memory(folder).map_err(Failure::input)?)?;
        let kept = movie::of_run(RunFiles::Folder(folder), self.field).map_err(Failure::input)?;
        let n_kept = kept.as_ref().map_or(0, |movie| movie.snapshots.maps.len());
        let more = self.case_of_more(&run, n_kept).map_err(Failure::input)?;
        let movie = match more {
            Some((case, frames)) => {
                print_stderr(&format!(
                    "{} has {}: its case is run again for {frames}",
                    folder.display(),
                    count(n_kept, "snapshot")
                ));
                let signals = Signals::catch().map_err(Failure::running)?;
                let movie = self.of_more(case, &signals)?;
                Failure::if_stopped(&signals)?;
                movie
            }
            None => kept,
        };
        let movie = movie.ok_or_else(|| refused(self.no_snapshots(run.case.as_ref().ok())))?;
        let delays = movie::delays(&movie, self.pace()).map_err(Failure::input)?;
        let bytes = if is_mp4 {
            mp4(folder, &movie, self.size(), &delays)?
        } else {
            let bytes = movie::gif(&movie, self.size(), &delays).map_err(Failure::input)?;
            // Signals are caught only now: until here they may simply end the process, because nothing is
            // left behind.
            Signals::catch().map_err(Failure::running)?;
            bytes
        };
        write_atomic(&out, &bytes)
            .map_err(|error| Failure::running(format!("cannot write {}: {error}", out.display())))?;
        let hundredths: u64 = delays.iter().map(|delay| u64::from(*delay)).sum();
        let [width, height] = self.size().pixels();
        print_message(&format!(
            "{} in {} s, {width} x {height} pixels\n{}\n",
            count(delays.len(), "picture"),
            four_digits(hundredths as f64 / 100.0),
            out.display()
        ));
        Ok(())
    }
}

impl MovieCommand {
    /// The case of a run with more snapshots than the run has kept, and their number, if the movie needs
    /// more.
    fn case_of_more(
        &self,
        run: &Inspection,
        kept: usize,
    ) -> Result<Option<(CaseFile, u16)>, RunPictureError> {
        let case = match &run.case {
            Ok(case) => case,
            Err(CaseDefect::NotResolved(case)) => case,
            Err(CaseDefect::Unreadable(_) | CaseDefect::Invalid(_)) => return Ok(None),
        };
        let is_open = case.output.snapshots == Snapshots::Auto && !case.output.movie;
        let frames = self.frames.or(is_open.then_some(FRAMES));
        let Some(frames) = frames.filter(|frames| kept < usize::from(*frames)) else {
            return Ok(None);
        };
        let mut case = case.clone();
        let spacing = movie::spacing(RunFiles::Folder(&self.folder), frames.into())?;
        case.output.snapshots = Snapshots::Every(spacing);
        let usual = mapped_field(&case);
        let field = self.field.unwrap_or(usual);
        case.output.fields = vec![field];
        // This also reserves the memory for drawing the movie. The case has a movie only of its usual field.
        case.output.movie = field == usual;
        Ok(Some((case, frames)))
    }

    /// The movie of a case that is run again.
    fn of_more(&self, case: CaseFile, signals: &Signals) -> Result<Option<Movie>, Failure> {
        let folder = &self.folder;
        let field = case.output.fields.first().copied();
        let case = case_to_run(folder, signals, false, |watch| of_file(case, folder, watch))?;
        let again = RunAgain::run(case, folder, signals, false)?;
        movie::of_run(RunFiles::Folder(again.made.path()), field).map_err(Failure::input)
    }

    fn size(&self) -> MovieSize {
        match self.size {
            SizeName::Small => MovieSize::Small,
            SizeName::Usual => MovieSize::Usual,
            SizeName::Large => MovieSize::Large,
        }
    }

    fn pace(&self) -> MoviePace {
        let seconds = self.seconds.map(MoviePace::Seconds);
        seconds.or(self.fps.map(MoviePace::PerSecond)).unwrap_or_default()
    }

    /// Error message that the run has no snapshots of the field, with a list of the fields that it has.
    fn no_snapshots(&self, case: Option<&CaseFile>) -> String {
        let field = self
            .field
            .or(case.map(mapped_field))
            .unwrap_or(Field::ContactStress);
        let kept = case.iter().flat_map(|case| &case.output.fields);
        let names: Vec<&str> = kept.map(|field| field_info(*field).name).collect();
        format!(
            "{} has no snapshots of {}: choose a field with --field (its case writes {}), or run the case again with --frames",
            self.folder.display(),
            field_info(field).name,
            names.join(", ")
        )
    }
}

fn refused(sentence: String) -> Failure {
    Failure::input(sentence)
}

/// Makes an MP4 file of the movie of a run folder, with ffmpeg.
fn mp4(run: &Path, movie: &Movie, size: MovieSize, delays: &[u16]) -> Result<Vec<u8>, Failure> {
    let failed = |error: std::io::Error| Failure::running(format!("cannot make the movie: {error}"));
    // Players want the index at the beginning of an MP4 file, which cannot be written through a pipe.
    let signals = Signals::catch().map_err(failed)?;
    let folder = TemporaryFolder::new(run).map_err(failed)?;
    let path = folder.path().join("movie.mp4");
    let [width, height] = size.pixels();
    let pictures = movie::pictures(movie, size).map_err(Failure::input)?;
    let started = Command::new("ffmpeg")
        .args(["-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"])
        .args([
            "-s",
            &format!("{width}x{height}"),
            "-r",
            &rate(delays).to_string(),
            "-i",
            "-",
        ])
        .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"])
        .arg(&path)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn();
    let child = started.map_err(|error| match error.kind() {
        ErrorKind::NotFound => refused(
            "an MP4 file needs the program ffmpeg, which is not installed: install it, or use a .gif file"
                .to_owned(),
        ),
        _ => failed(error),
    })?;
    feed(child, movie, &pictures, delays, &signals)?;
    std::fs::read(&path).map_err(failed)
}

/// Passes all pictures to ffmpeg, each as many times as its duration requires, and waits for ffmpeg to end.
fn feed(
    mut child: Child,
    movie: &Movie,
    pictures: &MoviePictures,
    delays: &[u16],
    signals: &Signals,
) -> Result<(), Failure> {
    let palette = pictures.palette();
    let mut pipe = child.stdin.take();
    let (rate, mut delays) = (rate(delays), delays.iter());
    // Hundredths of a second before a picture; the picture begins at the nearest frame of the file.
    let mut before = 0;
    let nearest = |hundredths: usize| (hundredths * rate + 50) / 100;
    let fed: Result<(), ()> = movie::draw(movie, pictures, |pixels| {
        if signals.stopped().is_some() {
            return Err(());
        }
        let bytes: Vec<u8> = pixels
            .iter()
            .flat_map(|&pixel| palette[usize::from(pixel)])
            .collect();
        let end = before + delays.next().map_or(0, |delay| usize::from(*delay));
        let times = nearest(end) - nearest(before);
        before = end;
        for _ in 0..times {
            // If ffmpeg ends early, its own message says why.
            let written = pipe.as_mut().map(|pipe| pipe.write_all(&bytes));
            written.and_then(Result::ok).ok_or(())?;
        }
        Ok(())
    });
    drop(pipe);
    let ended = child.wait_with_output();
    let ended = ended.map_err(|error| Failure::running(format!("cannot run ffmpeg: {error}")))?;
    Failure::if_stopped(signals)?;
    if ended.status.success() && fed.is_ok() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&ended.stderr);
    Err(Failure::running(format!(
        "ffmpeg could not make the movie: {}",
        slipfront_base::text::single_line(said.trim())
    )))
}
