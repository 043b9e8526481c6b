//! Sheets of an `.xlsx`.

use std::collections::HashMap;

use slipfront_base::text::truncated;
use slipfront_case::xml::Piece;

use super::archive::{Budget, NAMED_BYTES, Parts};
use super::sheet::{Sheet, Shown};

/// The sheets of an `.xlsx`.
pub(super) fn sheets(parts: &mut Parts<'_>, budget: &mut Budget) -> Result<Vec<Sheet>, String> {
    // Names of sheets, and the links to their files.
    let mut named = Vec::new();
    parts.read("xl/workbook.xml", &mut |path, piece| {
        if let Piece::Start(sheet) = piece
            && path.ends_with("/sheets/sheet")
        {
            let [name, link] = ["name", "id"].map(|of| sheet.get(of).unwrap_or_default().to_owned());
            budget.take(1, NAMED_BYTES + name.len() + link.len())?;
            named.push((name, link));
        }
        Ok(())
    })?;
    let mut targets = HashMap::new();
    parts.read("xl/_rels/workbook.xml.rels", &mut |path, piece| {
        if let Piece::Start(link) = piece
            && path.ends_with("/Relationship")
        {
            let [id, target] = ["Id", "Target"].map(|of| link.get(of).unwrap_or_default().to_owned());
            budget.take(1, NAMED_BYTES + id.len() + target.len())?;
            targets.insert(id, target);
        }
        Ok(())
    })?;
    let strings = Strings::read(parts, budget)?;
    let styles = styles(parts, budget)?;
    let mut sheets = Vec::new();
    for (name, link) in named {
        let target = targets.get(&link);
        let target = target.ok_or_else(|| format!("its sheet {} has no file", truncated(&name)))?;
        // A path from the folder of the workbook, or from the root of the archive.
        let path = match target.strip_prefix('/') {
            Some(path) => path.to_owned(),
            None => format!("xl/{target}"),
        };
        // Chart sheets have no cells.
        if path.contains("worksheets/") {
            sheets.push(office_sheet(parts, budget, (name, &path), &strings, &styles)?);
        }
    }
    Ok(sheets)
}

/// A sheet of an `.xlsx` of this name and path.
fn office_sheet(
    parts: &mut Parts<'_>,
    budget: &mut Budget,
    (name, path): (String, &str),
    strings: &Strings,
    styles: &[Shown],
) -> Result<Sheet, String> {
    let mut sheet = Sheet::new(name);
    // Rows and cells need not state their position: they then follow the previous ones.
    let (mut row_at, mut at) = (0, [0; 2]);
    let (mut kind, mut style, mut value) = (String::new(), 0, String::new());
    parts.read(path, &mut |path, piece| {
        let Some((_, path)) = path.split_once("sheetData/") else {
            return Ok(());
        };
        match (path, piece) {
            ("row", Piece::Start(row)) => {
                let stated = row
                    .get("r")
                    .and_then(|row| row.parse::<usize>().ok()?.checked_sub(1));
                at = [stated.unwrap_or(row_at), 0];
                row_at = at[0] + 1;
            }
            ("row/c", Piece::Start(cell)) => {
                at = cell.get("r").and_then(place).unwrap_or(at);
                kind.clear();
                kind.push_str(cell.get("t").unwrap_or("n"));
                style = cell.get("s").and_then(|style| style.parse().ok()).unwrap_or(0);
                value.clear();
            }
            (path, Piece::Text(text))
                if path == "row/c/v" || path.starts_with("row/c/is/") && is_text(path) =>
            {
                budget.holds(value.len() + text.len())?;
                value.push_str(text);
            }
            ("row/c", Piece::End) => {
                let value = if kind == "inlineStr" { &value } else { value.trim() };
                let of_style = styles.get(style).copied().unwrap_or(Shown::Number);
                let cell = match kind.as_str() {
                    _ if value.is_empty() => None,
                    "n" => Some((value, of_style)),
                    "d" => Some((value, Shown::Number)),
                    "s" => Some((strings.get(value)?, Shown::Text)),
                    "str" | "inlineStr" => Some((value, Shown::Text)),
                    // Truth values and errors of formulas.
                    _ => None,
                };
                sheet.add(budget, at, cell)?;
                at[1] += 1;
            }
            _ => {}
        }
        Ok(())
    })?;
    sheet.end_row();
    Ok(sheet)
}

/// Whether an element of an `.xlsx` has text that is shown: all but the pronunciation of Japanese.
fn is_text(path: &str) -> bool {
    path.ends_with("/t") && !path.contains("/rPh/")
}

/// The texts that cells of an `.xlsx` share.
#[derive(Default)]
struct Strings {
    text: String,
    /// Where each text ends.
    ends: Vec<usize>,
}

impl Strings {
    fn read(parts: &mut Parts<'_>, budget: &mut Budget) -> Result<Self, String> {
        let mut strings = Self::default();
        parts.read_optional("xl/sharedStrings.xml", &mut |path, piece| {
            let Some((_, path)) = path.split_once('/') else {
                return Ok(());
            };
            match (path, piece) {
                ("si", Piece::End) => {
                    budget.take(1, 0)?;
                    strings.ends.push(strings.text.len());
                }
                (path, Piece::Text(text)) if path.starts_with("si/") && is_text(path) => {
                    budget.take(0, text.len())?;
                    strings.text.push_str(text);
                }
                _ => {}
            }
            Ok(())
        })?;
        Ok(strings)
    }

    /// The text with this number, counted from 0.
    fn get(&self, number: &str) -> Result<&str, String> {
        let found = number.parse::<usize>().ok().and_then(|k| {
            let start = k
                .checked_sub(1)
                .map_or(Some(0), |before| self.ends.get(before).copied());
            Some(&self.text[start?..*self.ends.get(k)?])
        });
        found.ok_or_else(|| {
            let texts = self.ends.len();
            format!(
                "a cell has the text {}, and there are {texts}, from 0",
                truncated(number)
            )
        })
    }
}

/// How cells of each style of an `.xlsx` are shown.
fn styles(parts: &mut Parts<'_>, budget: &mut Budget) -> Result<Vec<Shown>, String> {
    let (mut formats, mut of_cells) = (HashMap::<u32, Shown>::new(), Vec::<u32>::new());
    parts.read_optional("xl/styles.xml", &mut |path, piece| {
        let Piece::Start(style) = piece else { return Ok(()) };
        let id = style.get("numFmtId").and_then(|id| id.parse().ok()).unwrap_or(0);
        if path.ends_with("/numFmt") {
            budget.take(1, 0)?;
            formats.insert(id, shown_by(style.get("formatCode").unwrap_or_default()));
        } else if path.ends_with("/cellXfs/xf") {
            budget.take(1, 0)?;
            of_cells.push(id);
        }
        Ok(())
    })?;
    let shown = |id: &u32| match id {
        9 | 10 => Shown::Percentage,
        14..=22 | 45..=47 => Shown::Time,
        id => formats.get(id).copied().unwrap_or(Shown::Number),
    };
    Ok(of_cells.iter().map(shown).collect())
}

/// How a number format shows numbers: as times or dates if it has a letter of one outside of literal text, as
/// percentages if it has a percent sign there.
fn shown_by(format: &str) -> Shown {
    let mut signs = format.chars();
    while let Some(sign) = signs.next() {
        match sign.to_ascii_lowercase() {
            '"' => {
                signs.find(|sign| *sign == '"');
            }
            // A literal character follows, or one that only sets a width.
            '\\' | '_' | '*' => {
                signs.next();
            }
            // Elapsed hours, minutes or seconds, and not a colour, a currency or a condition.
            '[' => {
                let inside: String = signs.by_ref().take_while(|sign| *sign != ']').collect();
                if ["h", "hh", "m", "mm", "s", "ss"].contains(&inside.to_lowercase().as_str()) {
                    return Shown::Time;
                }
            }
            'y' | 'd' | 'h' | 's' => return Shown::Time,
            '%' => return Shown::Percentage,
            _ => {}
        }
    }
    Shown::Number
}

/// Row and column, from 0, of a cell with a name such as `B4`.
fn place(name: &str) -> Option<[usize; 2]> {
    let digits = name.find(|c: char| c.is_ascii_digit())?;
    let (letters, row) = name.split_at(digits);
    let column = letters.bytes().try_fold(0, |column: usize, letter| {
        let letter = letter.is_ascii_uppercase().then_some(letter - b'A')?;
        column.checked_mul(26)?.checked_add(usize::from(letter) + 1)
    });
    Some([
        row.parse::<usize>().ok()?.checked_sub(1)?,
        column?.checked_sub(1)?,
    ])
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    #[test_case("General", Shown::Number)]
    #[test_case("#,##0.00\\ \\s;[Red]-0.0_d", Shown::Number)]
    #[test_case("0.0 \"s\"", Shown::Number)]
    #[test_case("[$-407]dd/mm/yy\\ hh:mm", Shown::Time)]
    #[test_case("[h]:mm:ss.000", Shown::Time)]
    #[test_case("0.00%", Shown::Percentage)]
    #[test_case("0.0 \"%\"", Shown::Number)]
    #[test_case("0\\%", Shown::Number)]
    fn formats_say_how_numbers_are_shown(format: &str, wanted: Shown) {
        assert!(shown_by(format) == wanted);
    }
}
