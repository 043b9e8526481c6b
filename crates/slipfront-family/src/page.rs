//! The pages `family.md`, `rupture.md` and `transition.md` of `docs/validation`, and the lines that the
//! command prints.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use slipfront_base::disk::{begins_with, write_with_folders};
use slipfront_plot::{Picture, PictureSize, response};
use slipfront_run::folder_error::FolderError;

use crate::answer::{Answer, Chapter};
use crate::error::FamilyError;

const IMAGES: &str = "images";

/// A page of the documentation, with its chapters.
pub struct Book {
    /// The first line of the page, which identifies a page of an earlier call.
    title: &'static str,
    /// Name of the page and its file without the ending; the names of its pictures begin with it.
    name: &'static str,
    /// The first paragraphs of the page, below its title.
    about: &'static str,
    /// Heading of the column with the reference values.
    compared: &'static str,
    /// The chapters of the page.
    pub chapters: Vec<Chapter>,
}

/// The books, each without its chapters.
const BOOKS: [Book; 3] = [
    Book {
        title: "# The family, answer by answer\n",
        name: "family",
        about: include_str!("text/family.md"),
        compared: "exact",
        chapters: Vec::new(),
    },
    Book {
        title: "# Benchmarks of frictional rupture\n",
        name: "rupture",
        about: include_str!("text/rupture.md"),
        compared: "reference",
        chapters: Vec::new(),
    },
    Book {
        title: "# Fronts faster than shear waves\n",
        name: "transition",
        about: include_str!("text/transition.md"),
        compared: "reference",
        chapters: Vec::new(),
    },
];

impl Book {
    pub(crate) fn of_options(chapters: Vec<Chapter>) -> Self {
        let [book, ..] = BOOKS;
        Self { chapters, ..book }
    }

    pub(crate) fn of_benchmarks(chapters: Vec<Chapter>) -> Self {
        let [_, book, _] = BOOKS;
        Self { chapters, ..book }
    }

    pub(crate) fn of_transition(chapters: Vec<Chapter>) -> Self {
        let [.., book] = BOOKS;
        Self { chapters, ..book }
    }

    /// Name of the file of the page.
    pub fn file(&self) -> String {
        format!("{}.md", self.name)
    }

    /// The text of the page.
    pub fn text(&self) -> String {
        let Self {
            title, name, about, ..
        } = self;
        let answers: usize = self.chapters.iter().map(|chapter| chapter.answers.len()).sum();
        let mut text = format!("{title}\n{}", about.replace("{answers}", &answers.to_string()));
        for chapter in &self.chapters {
            let _ = write!(text, "\n## {}\n\n{}\n", chapter.title, chapter.text);
            let _ = writeln!(
                text,
                "| quantity | {} | computed | error | tolerance | source of error |\n|---|---:|---:|---:|---:|---|",
                self.compared
            );
            for answer in &chapter.answers {
                let _ = writeln!(text, "{}", row(answer));
            }
            if let Some((caption, _)) = &chapter.picture {
                let _ = write!(
                    text,
                    "\n{caption}\n\n![{}](images/{name}-{}.png)\n",
                    chapter.title, chapter.name
                );
            }
        }
        text
    }
}

fn row(answer: &Answer) -> String {
    let Answer {
        quantity,
        exact,
        found,
        tolerance,
    } = answer;
    let quantity = quantity.replace('|', "\\|");
    let error = (found - exact).abs();
    let verdict = if answer.holds() {
        ""
    } else {
        " **out of tolerance**"
    };
    format!(
        "| {quantity} | {} | {} | {error:.1e}{verdict} | {:.1e} | {} |",
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

/// One line per chapter, and one for every answer out of its tolerance.
pub fn summary(books: &[Book]) -> String {
    let mut text = String::new();
    for chapter in books.iter().flat_map(|book| &book.chapters) {
        let within = chapter.answers.iter().filter(|answer| answer.holds()).count();
        let _ = writeln!(
            text,
            "{}: {within} of {} within tolerance",
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
                "  {quantity}: computed {found}, expected {exact}, tolerance {} ({})",
                answer.most(),
                tolerance.reason
            );
        }
    }
    text
}

/// The first foreign page that [`write_docs`] would replace in a folder.
pub fn foreign_docs(folder: &Path) -> Option<PathBuf> {
    let foreign = |book: &Book| {
        let page = folder.join(book.file());
        let is_foreign = page.symlink_metadata().is_ok() && !begins_with(&page, book.title.as_bytes());
        is_foreign.then_some(page)
    };
    BOOKS.iter().find_map(foreign)
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
            let name = chapter.name.to_owned();
            let drawn = response(responses, PictureSize::default());
            let picture = drawn.map_err(|source| FamilyError::Picture { name, source });
            Some(picture.map(|picture| (chapter.name, picture)))
        };
        let pictures: Vec<(&str, Picture)> = book
            .chapters
            .par_iter()
            .filter_map(draw)
            .collect::<Result<_, _>>()?;
        write_file(folder.join(book.file()), book.text().as_bytes())?;
        for (name, picture) in pictures {
            write_file(
                folder.join(format!("{IMAGES}/{}-{name}.png", book.name)),
                &picture.png,
            )?;
        }
    }
    Ok(())
}
