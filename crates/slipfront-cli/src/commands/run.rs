//! `slipfront run`: one case, from the file to the pictures.

use std::path::{Path, PathBuf};

use clap::Args;
use jiff::Timestamp;
use slipfront_case::case::Case;
use slipfront_case::folder::{RunFolder, own_bytes};
use slipfront_case::{results, run};

use super::{CaseArgs, print, set_threads};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::report;

/// Run a case: print its physics, show progress, write results and pictures
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront run
  slipfront run cases/groove_across.toml --set texture.0.coverage=5 -o results/groove-5
  slipfront run results/baseline/case.toml -o results/again    repeats a run bit for bit
  slipfront run --json --quiet | python3 -c 'import json,sys; print(json.load(sys.stdin)[\"static_friction_star\"])'")]
pub(crate) struct Run {
    #[command(flatten)]
    case: CaseArgs,
    /// Folder for the results [default: results/ and the name of the case]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the files of an earlier run in that folder, and nothing else
    #[arg(long)]
    force: bool,
    /// Most threads to use [default: one per core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Show neither physics nor progress nor summary
    #[arg(short, long)]
    quiet: bool,
    /// Print the summary as JSON on stdout, and nothing else there
    #[arg(long)]
    json: bool,
}

impl Run {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        let started = Timestamp::now();
        let threads = set_threads(self.threads)?;
        let case_path = self.case.path().map(Path::to_owned);
        let case = self.case.load()?;
        let talks = !self.quiet && !self.json;
        let out = self.out.unwrap_or_else(|| Path::new("results").join(&case.name));
        refuse_to_replace(case_path.as_deref(), &out)?;
        let replaced = if self.force { own_bytes(&out) } else { 0 };
        case.check_disk(&out, replaced).map_err(Failure::input)?;
        let folder = RunFolder::prepare(&out, self.force).map_err(Failure::input)?;
        let inputs = case.inputs.iter().map(|input| input.name.as_str());
        folder.expect_free(inputs).map_err(Failure::input)?;

        if talks {
            print(&report::physics(&case))?;
        }
        let mut progress = Progress::new(&case, self.quiet);
        let mut record =
            run::run(&case, threads, case.steps_per_look(), &mut progress).map_err(Failure::running)?;
        progress.finish();
        results::write(&case, &mut record, folder, started, threads).map_err(Failure::running)?;

        if self.json {
            print(&results::summary_json(&record.summary))?;
        } else if talks {
            print(&report::summary(&case, &record.summary))?;
            print(&files(&case, &out))?;
        }
        Ok(())
    }
}

/// Refuses a folder whose `case.toml` is the case to be run: with `--force` it would be gone, and lost if the run fails.
fn refuse_to_replace(case: Option<&Path>, out: &Path) -> Result<(), Failure> {
    let Some(case) = case.and_then(|case| case.canonicalize().ok()) else {
        return Ok(());
    };
    if out.join("case.toml").canonicalize().ok() != Some(case) {
        return Ok(());
    }
    let sentence = format!(
        "the results would replace the case itself, {}: choose another folder with --out",
        out.join("case.toml").display()
    );
    Err(Failure::input(anyhow::anyhow!(sentence)))
}

fn files(case: &Case, out: &Path) -> String {
    let mut text = format!("files in {}\n", out.display());
    for (name, what) in [
        ("friction.svg .png", "friction and sliding blocks against time"),
        ("stress.svg .png", "maps of the contact stress"),
        ("series.csv", "the curve, row by row"),
        ("fields.nc", "the fields, for ParaView, Python, MATLAB"),
        ("summary.json", "the numbers above"),
        ("case.toml", "the case, every default filled in"),
    ] {
        let exists = out.join(name.split(' ').next().unwrap_or(name)).exists();
        if exists {
            text += &format!("  {name:<18} {what}\n");
        }
    }
    if !case.inputs.is_empty() {
        text += &format!(
            "  {:<18} {}\n",
            "inputs/", "copies of the files that the case reads"
        );
    }
    text
}
