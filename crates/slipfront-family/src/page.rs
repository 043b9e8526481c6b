//! The page `docs/validation/family.md`, and the lines that the command prints.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use slipfront_base::disk::{begins_with, write_with_folders};
use slipfront_plot::{Picture, PictureSize, response};
use slipfront_run::folder_error::FolderError;

use crate::answer::{Answer, Chapter};
use crate::error::FamilyError;

/// The first line of the page, by which a page of an earlier call is recognised.
const TITLE: &str = "# The family, answer by answer\n";
const PAGE: &str = "family.md";
const IMAGES: &str = "images";
const PICTURE: &str = "family-";

/// The text of the page.
pub fn docs_page(chapters: &[Chapter]) -> String {
    let answers: usize = chapters.iter().map(|chapter| chapter.answers.len()).sum();
    let mut text = format!(
        "{TITLE}\n\
         The options of the engine beyond the paper's model, each with what is known exactly about it and what the engine computes:\n\n\
         ```console\n$ slipfront family --docs docs/validation\n```\n\n\
         {answers} answers, each measured in a run, in units of P μ̄_s l² (forces), P μ̄_s l/E (displacements) and l √(ρ/E) (times). What is\n\
         derived here is derived in the text. Works are named for what they studied; none of their figures is repeated here.\n\n\
         \"At most\" is an estimate of the error of the run, from what \"because\" names, not from what was found. Some of it is certain, and found\n\
         nearly as large: an error of first order in the step, a drag. Some is a bound below which chance decides: at which part of a step a\n\
         block slips, which way digits are rounded.\n"
    );
    for chapter in chapters {
        let _ = write!(text, "\n## {}\n\n{}\n", chapter.title, chapter.text);
        text += "| answer | exact | computed | apart | at most | because |\n|---|---:|---:|---:|---:|---|\n";
        for answer in &chapter.answers {
            let _ = writeln!(text, "{}", row(answer));
        }
        if let Some((caption, _)) = &chapter.picture {
            let _ = write!(
                text,
                "\n{caption}\n\n![{}](images/{PICTURE}{}.png)\n",
                chapter.title, chapter.name
            );
        }
    }
    text
}

fn row(answer: &Answer) -> String {
    let Answer {
        quantity,
        exact,
        found,
        tolerance,
    } = answer;
    let quantity = quantity.replace('|', "\\|");
    let apart = (found - exact).abs();
    let verdict = if answer.holds() { "" } else { " **too far**" };
    format!(
        "| {quantity} | {} | {} | {apart:.1e}{verdict} | {:.1e} | {} |",
        digits(*exact),
        digits(*found),
        tolerance.distance,
        tolerance.reason
    )
}

/// A number to six significant digits.
fn digits(value: f64) -> String {
    let places = if value == 0.0 {
        0
    } else {
        5 - libm::log10(value.abs()).floor() as i32
    };
    format!("{value:.*}", places.clamp(0, 12) as usize)
}

/// One line per chapter, and one for every answer that is too far from the exact one.
pub fn summary(chapters: &[Chapter]) -> String {
    let mut text = String::new();
    for chapter in chapters {
        let within = chapter.answers.iter().filter(|answer| answer.holds()).count();
        let _ = writeln!(
            text,
            "{}: {within} of {} answers",
            chapter.title,
            chapter.answers.len()
        );
        for answer in chapter.answers.iter().filter(|answer| !answer.holds()) {
            let Answer {
                quantity,
                exact,
                found,
                tolerance,
            } = answer;
            let _ = writeln!(
                text,
                "  {quantity}: {found}, exactly {exact}, farther than {}: {}",
                answer.most(),
                tolerance.reason
            );
        }
    }
    text
}

/// The page of another origin that [`write_docs`] would replace in a folder.
pub fn foreign_docs(folder: &Path) -> Option<PathBuf> {
    let page = folder.join(PAGE);
    (page.symlink_metadata().is_ok() && !begins_with(&page, TITLE.as_bytes())).then_some(page)
}

/// Writes the page and its pictures, as they stand in `docs/validation`.
///
/// # Errors
/// When a picture cannot be drawn or a file not be written.
pub fn write_docs(chapters: &[Chapter], folder: &Path) -> Result<(), FamilyError> {
    let draw = |chapter: &Chapter| {
        let (_, responses) = chapter.picture.as_ref()?;
        let name = chapter.name.to_owned();
        let drawn = response(responses, PictureSize::default());
        let picture = drawn.map_err(|source| FamilyError::Picture { name, source });
        Some(picture.map(|picture| (chapter.name, picture)))
    };
    let pictures: Vec<(&str, Picture)> = chapters.par_iter().filter_map(draw).collect::<Result<_, _>>()?;
    let write_file =
        |path: PathBuf, bytes: &[u8]| write_with_folders(&path, bytes).map_err(FolderError::write(&path));
    write_file(folder.join(PAGE), docs_page(chapters).as_bytes())?;
    for (name, picture) in pictures {
        write_file(folder.join(format!("{IMAGES}/{PICTURE}{name}.png")), &picture.png)?;
    }
    Ok(())
}
