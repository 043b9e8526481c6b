//! Sheets of an `.ods`.

use jiff::SignedDuration;
use slipfront_base::text::truncated;
use slipfront_case::xml::{Attributes, Piece};

use super::archive::{Budget, NAMED_BYTES, Parts};
use super::sheet::{Sheet, Shown};

/// The sheets of an `.ods`.
pub(super) fn sheets(parts: &mut Parts<'_>, budget: &mut Budget) -> Result<Vec<Sheet>, String> {
    let mut sheets = Vec::<Sheet>::new();
    // The row and the column that are read, and how often each is repeated.
    let (mut row, mut rows, mut column, mut columns) = (0_usize, 1, 0_usize, 1);
    let (mut value, mut shown) = (String::new(), None);
    parts.read("content.xml", &mut |path, piece| {
        let Some((_, path)) = path.split_once("spreadsheet/table") else {
            return Ok(());
        };
        if let ("", Piece::Start(table)) = (path, &piece) {
            let name = table.get("name").unwrap_or_default().to_owned();
            budget.take(1, NAMED_BYTES + name.len())?;
            sheets.push(Sheet::new(name));
            row = 0;
        }
        let Some(sheet) = sheets.last_mut() else {
            return Ok(());
        };
        if let ("", Piece::End) = (path, &piece) {
            sheet.end_row();
        }
        let Some(path) = in_row(path) else {
            return Ok(());
        };
        match (path, piece) {
            ("", Piece::Start(of_row)) => {
                (rows, column) = (repeated(&of_row, "number-rows-repeated")?, 0);
            }
            ("", Piece::End) => {
                sheet.repeat_row(budget, row, rows)?;
                row = row.saturating_add(rows);
            }
            ("/table-cell" | "/covered-table-cell", Piece::Start(cell)) => {
                columns = repeated(&cell, "number-columns-repeated")?;
                shown = read_value(&cell, &mut value)?;
            }
            ("/table-cell" | "/covered-table-cell", Piece::End) => {
                // Empty cells after all others are repeated up to the end of the sheet.
                for k in 0..shown.map_or(0, |_| columns) {
                    let at = [row, column.saturating_add(k)];
                    sheet.add(budget, at, shown.map(|shown| (value.as_str(), shown)))?;
                }
                column = column.saturating_add(columns);
            }
            (path, _) if shown != Some(Shown::Text) || path.contains("/annotation") => {}
            (_, Piece::Text(text)) => {
                budget.holds(value.len() + text.len())?;
                value.push_str(text);
            }
            (path, Piece::Start(_))
                if !value.is_empty() && SEPARATING.iter().any(|name| path.ends_with(name)) =>
            {
                value.push(' ');
            }
            _ => {}
        }
        Ok(())
    })?;
    Ok(sheets)
}

/// Ends of paths of elements that stand for a blank or begin a line within a cell.
const SEPARATING: [&str; 4] = ["/p", "/s", "/tab", "/line-break"];

/// The path of an element within a row of a table. Rows may be in groups and headings.
fn in_row(mut path: &str) -> Option<&str> {
    const GROUPS: [&str; 3] = ["/table-row-group", "/table-header-rows", "/table-rows"];
    while let Some(inside) = GROUPS.iter().find_map(|group| path.strip_prefix(group)) {
        path = inside;
    }
    path.strip_prefix("/table-row")
}

/// How often an element is repeated.
fn repeated(element: &Attributes<'_>, name: &str) -> Result<usize, String> {
    element.get(name).map_or(Ok(1), |times| {
        times.parse().map_err(|_| {
            format!(
                "it has {name} = {}, which is no number of times",
                truncated(times)
            )
        })
    })
}

/// Reads the value of a cell, unless it is text within, and returns how it is shown; none if it is empty.
fn read_value(cell: &Attributes<'_>, value: &mut String) -> Result<Option<Shown>, String> {
    value.clear();
    let (name, shown) = match cell.get("value-type") {
        Some("float" | "currency") => ("value", Shown::Number),
        Some("percentage") => ("value", Shown::Percentage),
        Some("date") => ("date-value", Shown::Number),
        Some("time") => ("time-value", Shown::Time),
        Some("string") => return Ok(Some(Shown::Text)),
        _ => return Ok(None),
    };
    let Some(stated) = cell.get(name) else {
        return Ok(None);
    };
    if shown == Shown::Time {
        let time = stated.parse::<SignedDuration>();
        let time = time.map_err(|_| format!("a cell has the time {}", truncated(stated)))?;
        *value = (time.as_secs_f64() / 86_400.0).to_string();
    } else {
        value.push_str(stated);
    }
    Ok(Some(shown))
}
