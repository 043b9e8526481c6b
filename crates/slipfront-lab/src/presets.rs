//! Cases to choose from: the cases of the folder `cases/`, and the cases of the paper's figures.

use std::collections::BTreeMap;

use include_dir::{Dir, File, include_dir};
use slipfront_session::{Document, Preset, Presets};
use toml::{Table, Value};

/// The file with the small pictures of all cases, by their names.
const PICTURES: &str = "pictures.json";

static CASES: Dir = include_dir!("$CARGO_MANIFEST_DIR/cases");

/// The text of a file of the folder that is not a case.
fn text_of(name: &str) -> &'static str {
    CASES
        .get_file(name)
        .and_then(File::contents_utf8)
        .unwrap_or_default()
}

/// The groups of the list, in order, each with the cases of the folder that belong to it. The cases of the
/// paper are another group.
fn groups() -> impl Iterator<Item = (&'static str, &'static str)> {
    let groups = text_of("groups.txt")
        .lines()
        .filter_map(|line| line.split_once(": "));
    groups.flat_map(|(group, names)| names.split(", ").map(move |name| (group, name)))
}

/// The case with which the page opens unless another one is named.
///
/// # Errors
/// A sentence, if the case cannot be made.
pub(crate) fn opening(presets: &Presets) -> Result<Document, String> {
    presets.document("circle")
}

/// Names and texts of the cases of the folder.
fn cases() -> impl Iterator<Item = (&'static str, &'static str)> {
    CASES.files().filter_map(|file| {
        let name = file.path().to_str()?.strip_suffix(".toml")?;
        Some((name, file.contents_utf8()?))
    })
}

/// Names and texts of the cases of the paper.
fn figures() -> impl Iterator<Item = (&'static str, &'static str)> {
    slipfront_paper::cases().filter(|(name, _)| name.starts_with("fig") || name.starts_with("table"))
}

/// All cases to choose from.
pub(crate) fn all() -> Presets {
    let mut all: Vec<_> = cases().map(|(name, text)| case(name, text)).collect();
    all.sort_by_key(|preset| groups().position(|(_, name)| name == preset.name));
    all.extend(figures().map(|(name, text)| figure(name, text)));
    let mut pictures: BTreeMap<String, String> = serde_json::from_str(text_of(PICTURES)).unwrap_or_default();
    for preset in &mut all {
        preset.picture = pictures.remove(&preset.name).unwrap_or_default();
    }
    Presets(all)
}

/// A case of the folder, with the files next to it that it names. The case is parsed only when it is chosen.
/// Until then, any quoted text that is the name of an existing file counts as that file.
fn case(name: &str, text: &str) -> Preset {
    let files = CASES.files().filter_map(|file| {
        let name = file.path().to_str()?;
        text.contains(&format!("\"{name}\""))
            .then(|| (name.to_owned(), file.contents().to_vec()))
    });
    let files = files.collect();
    Preset {
        name: name.to_owned(),
        group: groups()
            .find(|(_, other)| *other == name)
            .map_or("other", |(group, _)| group)
            .to_owned(),
        picture: String::new(),
        is_study: false,
        title: title(text),
        toml: text.to_owned(),
        files,
    }
}

/// A case of the paper.
fn figure(name: &str, text: &str) -> Preset {
    Preset {
        name: format!("paper/{name}"),
        group: "paper".to_owned(),
        picture: String::new(),
        is_study: text
            .parse::<Table>()
            .is_ok_and(|table| table.contains_key("base")),
        title: title(text),
        toml: case_of_study(text),
        files: BTreeMap::new(),
    }
}

/// The first sentence of the comment with which a case begins.
fn title(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix('#'));
    let comment = lines.map(str::trim).collect::<Vec<_>>().join(" ");
    // A period after "Fig" or "Eq" does not end the sentence.
    let ends = comment.match_indices(". ").map(|(end, _)| &comment[..end]);
    let is_abbreviated =
        |part: &&str| part.ends_with("Fig") || part.ends_with("Figs") || part.ends_with("Eq");
    let sentence = ends.into_iter().find(|part| !is_abbreviated(part));
    sentence.unwrap_or(&comment).trim_end_matches('.').to_owned()
}

/// The case of a file of the paper: the whole case, or the base of its study. The run continues to its full
/// duration, so that it can be watched.
fn case_of_study(text: &str) -> String {
    // Errors of a case are reported when it is chosen.
    let Ok(mut table) = text.parse::<Table>() else {
        return text.to_owned();
    };
    let mut case = match table.remove("base") {
        Some(Value::Table(base)) => base,
        _ => table,
    };
    if let Some(Value::Table(time)) = case.get_mut("time") {
        time.remove("stop");
    }
    case.to_string()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use base64::Engine;
    use slipfront_case::case::Case;

    use super::*;

    /// Pixels along each side of the small picture of a case.
    const SIZE: usize = 32;
    /// Pixel values without contact and without a block; the values between them are static coefficients.
    const NO_CONTACT: u8 = 0;
    const NO_BLOCK: u8 = 15;

    /// The small picture of a case from its upper left corner on, half a byte per pixel: the static
    /// coefficient over its mean, from 0.7 to 1.3.
    fn small_picture(case: &Case) -> String {
        let (lattice, surface) = (&case.model.lattice, &case.model.surface);
        let exists = |b: usize| case.model.slider().exists(b);
        let touching: Vec<f64> = (0..lattice.n_blocks())
            .filter(|&b| exists(b) && !surface.textured[b])
            .map(|b| surface.mu_static[b])
            .collect();
        let mean = touching.iter().sum::<f64>() / touching.len() as f64;
        let pixel = |k: usize| {
            let (column, row) = (k % SIZE, SIZE - 1 - k / SIZE);
            let b = lattice.block(column * lattice.nx / SIZE, row * lattice.ny / SIZE);
            if !exists(b) {
                NO_BLOCK
            } else if surface.textured[b] {
                NO_CONTACT
            } else {
                let share = (surface.mu_static[b] / mean - 0.7) / 0.6;
                1 + (13.0 * share.clamp(0.0, 1.0)).round() as u8
            }
        };
        let bytes: Vec<u8> = (0..SIZE * SIZE / 2)
            .map(|k| pixel(2 * k) << 4 | pixel(2 * k + 1))
            .collect();
        base64::engine::general_purpose::STANDARD.encode(bytes)
    }

    /// Every case of the folder has a group, and the list has a small picture of every case.
    #[test]
    fn cases_have_a_group_and_a_small_picture() {
        let presets = all();
        assert_eq!(groups().count(), cases().count());
        let mut lines = Vec::new();
        for preset in &presets.0 {
            assert_ne!(preset.group, "other", "{} has no group", preset.name);
            let document = presets.document(&preset.name).unwrap();
            let case = document.case_to_show(&mut |_| true).unwrap();
            lines.push(format!("  \"{}\": \"{}\"", preset.name, small_picture(&case)));
        }
        let text = format!("{{\n{}\n}}\n", lines.join(",\n"));
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(PICTURES);
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&file, &text).unwrap();
        }
        let written = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(
            written == text,
            "{} is not of these cases: `UPDATE=1 cargo test -p slipfront-lab --lib presets` writes it anew",
            file.display()
        );
    }
}
