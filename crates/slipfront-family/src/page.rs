//! The pages `family.md`, `rupture.md` and `transition.md` of `docs/validation`, and the lines that the
//! command prints.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use slipfront_base::disk::{begins_with, write_with_folders};
use slipfront_plot::{Picture, PictureSize, response};
use slipfront_run::folder_error::FolderError;

use crate::chapter::{Answer, Chapter, Topic};
use crate::error::FamilyError;

/// A page of the documentation.
pub(crate) struct Page {
    /// The first line of the page, which identifies a page of an earlier call.
    pub(crate) title: &'static str,
    /// Name of the page and its file without the ending; the names of its pictures begin with it.
    pub(crate) name: &'static str,
    /// The first paragraphs of the page, below its title.
    pub(crate) about: &'static str,
    /// Heading of the column with the reference values.
    pub(crate) compared: &'static str,
    /// Topics of the page's chapters, in their order.
    pub(crate) topics: &'static [Topic],
}

impl Page {
    /// Name of the file of the page.
    pub(crate) fn file(&self) -> String {
        format!("{}.md", self.name)
    }

    /// The file of a foreign page that this page would replace in a folder.
    pub(crate) fn foreign_in(&self, folder: &Path) -> Option<PathBuf> {
        let path = folder.join(self.file());
        let is_foreign = path.symlink_metadata().is_ok() && !begins_with(&path, self.title.as_bytes());
        is_foreign.then_some(path)
    }
}

/// A page of the documentation, with its computed chapters.
pub struct Book {
    page: &'static Page,
    /// The chapters of the page.
    pub chapters: Vec<Chapter>,
}

impl Book {
    /// Computes the chapters of a page.
    pub(crate) fn compute(page: &'static Page) -> Result<Self, FamilyError> {
        let chapters = page.topics.par_iter().map(Chapter::about);
        Ok(Self {
            page,
            chapters: chapters.collect::<Result<_, _>>()?,
        })
    }

    /// Name of the file of the page.
    pub fn file(&self) -> String {
        self.page.file()
    }

    /// The text of the page.
    pub fn text(&self) -> String {
        let Page {
            title, name, about, ..
        } = self.page;
        let answers: usize = self.chapters.iter().map(|chapter| chapter.answers.len()).sum();
        let mut text = format!("{title}\n{}", about.replace("{answers}", &answers.to_string()));
        for chapter in &self.chapters {
            let _ = write!(text, "\n## {}\n\n{}\n", chapter.topic.title, chapter.topic.text);
            let _ = writeln!(
                text,
                "| quantity | {} | computed | error | tolerance | source of error |\n|---|---:|---:|---:|---:|---|",
                self.page.compared
            );
            for answer in &chapter.answers {
                let _ = writeln!(text, "{}", row(answer));
            }
            if let Some((caption, _)) = &chapter.picture {
                let Topic {
                    title,
                    name: of_chapter,
                    ..
                } = chapter.topic;
                let _ = write!(
                    text,
                    "\n{caption}\n\n![{title}](images/{name}-{of_chapter}.png)\n"
                );
            }
        }
        text
    }
}

fn row(answer: &Answer) -> String {
    let quantity = answer.quantity.replace('|', "\\|");
    let error = (answer.found - answer.exact).abs();
    let verdict = if answer.holds() {
        ""
    } else {
        " **out of tolerance**"
    };
    format!(
        "| {quantity} | {} | {} | {error:.1e}{verdict} | {:.1e} | {} |",
        digits(answer.exact),
        digits(answer.found),
        answer.tolerance,
        answer.reason
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

/// One line per chapter, and one for every answer out of its tolerance.
pub fn summary(books: &[Book]) -> String {
    let mut text = String::new();
    for chapter in books.iter().flat_map(|book| &book.chapters) {
        let within = chapter.answers.iter().filter(|answer| answer.holds()).count();
        let _ = writeln!(
            text,
            "{}: {within} of {} within tolerance",
            chapter.topic.title,
            chapter.answers.len()
        );
        for answer in chapter.answers.iter().filter(|answer| !answer.holds()) {
            let most = answer.most();
            let Answer {
                quantity,
                exact,
                found,
                reason,
                ..
            } = answer;
            let _ = writeln!(
                text,
                "  {quantity}: computed {found}, expected {exact}, tolerance {most} ({reason})"
            );
        }
    }
    text
}

/// Writes the pages and their pictures, as in `docs/validation`.
///
/// # Errors
/// When a picture cannot be drawn or a file cannot be written.
pub fn write_docs(books: &[Book], folder: &Path) -> Result<(), FamilyError> {
    let write_file =
        |path: PathBuf, bytes: &[u8]| write_with_folders(&path, bytes).map_err(FolderError::write(&path));
    for book in books {
        let draw = |chapter: &Chapter| {
            let (_, responses) = chapter.picture.as_ref()?;
            let name = chapter.topic.name;
            let drawn = response(responses, PictureSize::default());
            Some(
                drawn
                    .map(|picture| (name, picture))
                    .map_err(|source| FamilyError::Picture {
                        name: name.to_owned(),
                        source,
                    }),
            )
        };
        let pictures = book.chapters.par_iter().filter_map(draw);
        let pictures: Vec<(&str, Picture)> = pictures.collect::<Result<_, _>>()?;
        write_file(folder.join(book.file()), book.text().as_bytes())?;
        for (name, picture) in pictures {
            let path = format!("images/{}-{name}.png", book.page.name);
            write_file(folder.join(path), &picture.png)?;
        }
    }
    Ok(())
}
