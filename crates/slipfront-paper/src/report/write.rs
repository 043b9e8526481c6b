//! Writes the results folder and the page of `docs/validation`.

use std::io::Write;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::markdown::page;
use super::tables::{claims_csv, csv, numbers_csv};
use super::{html, markdown};
use crate::error::PaperError;
use crate::figure_data::{FigureData, Panel};
use crate::paper::Paper;
use slipfront_base::disk::{begins_with, write_with_folders};
use slipfront_plot::Picture;
use slipfront_run::folder_error::FolderError;
use slipfront_run::manifest::ManifestFile;
use slipfront_study::project_folder::{Batch, Others, ResultFiles};

/// Writes pictures, tables and the report to a folder, whose list also gets the [`sources`](crate::sources)
/// that they follow from.
///
/// # Errors
/// When a picture cannot be drawn, a file cannot be written, or an existing file was edited.
pub fn write(paper: &Paper, files: &ResultFiles, sources: Vec<ManifestFile>) -> Result<(), PaperError> {
    let figures = paper.figures.par_iter();
    let drawn: Vec<Vec<Picture>> = figures.map(|(_, data)| draw(data)).collect::<Result<_, _>>()?;
    let mut batch = files.begin();
    for ((_, data), pictures) in paper.figures.iter().zip(&drawn) {
        write_figure(data, pictures, &mut batch)?;
    }
    let report = html::page(paper, &drawn);
    for (name, bytes) in [
        ("claims.csv", claims_csv(paper)?),
        ("numbers.csv", numbers_csv(paper)?),
        ("report.html", report.into_bytes()),
    ] {
        batch.write(name, |to| to.write_all(&bytes))?;
    }
    // Keep figures of earlier calls, which took hours.
    Ok(batch.place(Others::Stay, sources)?)
}

/// Writes the pictures and tables of a figure.
fn write_figure(data: &FigureData, pictures: &[Picture], batch: &mut Batch) -> Result<(), PaperError> {
    for (Panel { name, drawing, .. }, picture) in data.panels.iter().zip(pictures) {
        batch.write_picture(name, picture)?;
        let table = drawing.csv()?;
        batch.write(&format!("{name}.csv"), |to| to.write_all(&table))?;
    }
    for table in &data.tables {
        let rows = csv([&table.header].into_iter().chain(&table.rows))?;
        batch.write(&format!("{}.csv", table.name), |to| to.write_all(&rows))?;
    }
    Ok(())
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

/// The first foreign file that [`write_docs`] would replace in a folder.
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

/// Writes the claims table as `paper.md` and all pictures, as in `docs/validation`.
///
/// # Errors
/// When a picture cannot be drawn or a file cannot be written.
pub fn write_docs(paper: &Paper, folder: &Path) -> Result<(), PaperError> {
    let write_file =
        |path: PathBuf, bytes: &[u8]| write_with_folders(&path, bytes).map_err(FolderError::write(&path));
    // The page comes first, since it identifies the pictures as those of an earlier call.
    write_file(folder.join(PAGE), page(paper).as_bytes())?;
    for (_, data) in &paper.figures {
        for (panel, picture) in data.panels.iter().zip(draw(data)?) {
            let name = format!("{IMAGES}/{PICTURE}{}.png", panel.name);
            write_file(folder.join(name), &picture.png)?;
        }
    }
    Ok(())
}
