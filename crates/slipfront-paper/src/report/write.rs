//! Writes the results folder and the page of `docs/validation`.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::markdown::page;
use super::tables::{claims_csv, csv, numbers_csv};
use super::{html, markdown};
use crate::error::PaperError;
use crate::figure_data::{FigureData, Panel};
use crate::paper::Paper;
use slipfront_case::disk::{begins_with, make_folders, write_atomic};
use slipfront_plot::Picture;
use slipfront_run::folder_error::FolderError;

/// Writes pictures, tables and the report to a folder.
///
/// # Errors
/// When a picture cannot be drawn or a file not be written.
pub fn write(paper: &Paper, folder: &Path) -> Result<(), PaperError> {
    let figures = paper.figures.par_iter();
    let drawn: Vec<Vec<Picture>> = figures
        .map(|(_, data)| write_figure(data, folder))
        .collect::<Result<_, _>>()?;
    write_file(folder, "claims.csv", &claims_csv(paper)?)?;
    write_file(folder, "numbers.csv", &numbers_csv(paper)?)?;
    write_file(folder, "report.html", html::page(paper, &drawn).as_bytes())
}

/// Writes the pictures and tables of a figure, and returns the pictures.
fn write_figure(data: &FigureData, folder: &Path) -> Result<Vec<Picture>, PaperError> {
    let pictures = draw(data)?;
    for (Panel { name, drawing, .. }, picture) in data.panels.iter().zip(&pictures) {
        write_file(folder, &format!("{name}.svg"), picture.svg.as_bytes())?;
        write_file(folder, &format!("{name}.png"), &picture.png)?;
        write_file(folder, &format!("{name}.csv"), &drawing.csv()?)?;
    }
    for table in &data.tables {
        let rows = [&table.header].into_iter().chain(&table.rows);
        write_file(folder, &format!("{}.csv", table.name), &csv(rows)?)?;
    }
    Ok(pictures)
}

fn draw(data: &FigureData) -> Result<Vec<Picture>, PaperError> {
    let panels = data.panels.par_iter().map(|Panel { name, drawing, .. }| {
        let name = name.clone();
        drawing
            .draw()
            .map_err(|source| PaperError::Picture { name, source })
    });
    panels.collect()
}

/// The first file of others that [`write_docs`] would replace in a folder.
pub fn foreign_docs(folder: &Path) -> Option<PathBuf> {
    let page = folder.join(PAGE);
    if begins_with(&page, markdown::TITLE.as_bytes()) {
        return None;
    }
    if page.symlink_metadata().is_ok() {
        return Some(page);
    }
    let pictures = std::fs::read_dir(folder.join(IMAGES))
        .into_iter()
        .flatten()
        .flatten();
    let mut pictures = pictures.filter(|file| file.file_name().to_string_lossy().starts_with(PICTURE));
    pictures.next().map(|file| file.path())
}

const PAGE: &str = "paper.md";
/// The folder of the pictures of the page.
const IMAGES: &str = "images";
/// Beginning of the pictures' names.
const PICTURE: &str = "paper-";

/// Writes the claims table as `paper.md` with all pictures, as they stand in `docs/validation`.
///
/// # Errors
/// When a picture cannot be drawn or a file not be written.
pub fn write_docs(paper: &Paper, folder: &Path) -> Result<(), PaperError> {
    // First, since it tells that the pictures are of an earlier call.
    write_file(folder, PAGE, page(paper).as_bytes())?;
    for (_, data) in &paper.figures {
        for (panel, picture) in data.panels.iter().zip(draw(data)?) {
            write_file(
                folder,
                &format!("{IMAGES}/{PICTURE}{}.png", panel.name),
                &picture.png,
            )?;
        }
    }
    Ok(())
}

pub(crate) fn write_file(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), PaperError> {
    let path = folder.join(name);
    let parent = path.parent().unwrap_or(folder).to_owned();
    let written = make_folders(&parent).and_then(|()| write_atomic(&path, bytes));
    written.map_err(|source| FolderError::Write { path, source }.into())
}
