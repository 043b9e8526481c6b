//! Printed tables: columns of constant width, with numbers aligned.

/// The sign between a value and the half width of its interval.
const PLUS_MINUS: &str = " \u{b1} ";

/// A table as text, one line per row. Each column is as wide as its widest cell; numbers are right-aligned,
/// and words left-aligned. Cells beyond the columns of the header are remarks.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let columns = header.iter().enumerate().map(|(column, name)| {
        let cells: Vec<&str> = rows.iter().map(|row| row[column].as_str()).collect();
        TableColumn::new(name, &cells)
    });
    let columns: Vec<TableColumn> = columns.collect();
    let line = |row: usize| {
        let remarks = row
            .checked_sub(1)
            .map_or(&[][..], |row| &rows[row][header.len()..]);
        let cells = columns.iter().map(|column| column.cells[row].as_str());
        let cells: Vec<&str> = cells.chain(remarks.iter().map(String::as_str)).collect();
        format!("  {}\n", cells.join("   ").trim_end())
    };
    (0..=rows.len()).map(line).collect()
}

/// A column that begins with its name, with every cell padded to its width.
struct TableColumn {
    cells: Vec<String>,
}

impl TableColumn {
    fn new(name: &str, cells: &[&str]) -> Self {
        let aligned = aligned(cells);
        let is_number = |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit() || "-(<".contains(c));
        let is_right = cells.iter().all(|cell| is_number(cell));
        let all = [name.to_owned()].into_iter().chain(aligned);
        let all: Vec<String> = all.collect();
        let width = all.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        let filled = |cell: &String| {
            if is_right {
                format!("{cell:>width$}")
            } else {
                format!("{cell:<width$}")
            }
        };
        Self {
            cells: all.iter().map(filled).collect(),
        }
    }
}

/// Cells of values with half widths, with the decimal points of both aligned. Columns without half widths are
/// not changed.
fn aligned(cells: &[&str]) -> Vec<String> {
    if !cells.iter().any(|cell| cell.contains(PLUS_MINUS)) {
        return cells.iter().map(|&cell| cell.to_owned()).collect();
    }
    let parts: Vec<(&str, Option<&str>)> = cells
        .iter()
        .map(|cell| {
            cell.split_once(PLUS_MINUS)
                .map_or((*cell, None), |(value, half)| (value, Some(half)))
        })
        .collect();
    let values: Vec<&str> = parts.iter().map(|(value, _)| *value).collect();
    let values = at_the_point(&values, |text, width| format!("{text:>width$}"));
    let halves: Vec<&str> = parts.iter().map(|(_, half)| half.unwrap_or_default()).collect();
    let halves = at_the_point(&halves, |text, width| format!("{text:<width$}"));
    let joined = values.into_iter().zip(halves).zip(parts);
    joined
        .map(|((value, half), (_, given))| match given {
            Some(_) => value + PLUS_MINUS + &half,
            // Padded to the width of the others, so that the columns stay aligned.
            None => value + &" ".repeat(PLUS_MINUS.chars().count()) + &half,
        })
        .collect()
}

/// Pads texts to one width so that their first decimal points, or their ends, are aligned. The two parts of a
/// bracket before a power of ten are padded only on the outside.
fn at_the_point(texts: &[&str], fill: fn(&str, usize) -> String) -> Vec<String> {
    let split = |text: &str| {
        let (before, after) = text.split_at(text.find('.').unwrap_or(text.len()));
        (!text.contains(['(', ')'])).then(|| (before.to_owned(), after.to_owned()))
    };
    let length = |text: &str| text.chars().count();
    let plain: Vec<(String, String)> = texts.iter().filter_map(|text| split(text)).collect();
    let before = plain.iter().map(|(before, _)| length(before)).max().unwrap_or(0);
    let after = plain.iter().map(|(_, after)| length(after)).max().unwrap_or(0);
    let placed = texts.iter().map(|&text| match split(text) {
        Some((left, right)) => format!("{left:>before$}{right:<after$}"),
        None => text.to_owned(),
    });
    let placed: Vec<String> = placed.collect();
    let width = placed.iter().map(|text| length(text)).max().unwrap_or(0);
    placed.iter().map(|text| fill(text, width)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_below_each_other() {
        let row = |cells: &[&str]| cells.iter().map(|&cell| cell.to_owned()).collect::<Vec<_>>();
        let rows = [
            row(&["1", "circle", "22.8 \u{b1} 0.4", "5"]),
            row(&["10", "groove along", "9.315 \u{b1} 0.0012", "12", "(remark)"]),
            row(&["10", "none", "none", "0"]),
        ];
        let expected = "  \
  coverage   shape          mean                 n
         1   circle           22.8   \u{b1} 0.4       5
        10   groove along      9.315 \u{b1} 0.0012   12   (remark)
        10   none           none                 0
";
        assert_eq!(table(&["coverage", "shape", "mean", "n"], &rows), expected);
    }

    /// A power of ten belongs to the whole bracket, so no padding is added inside it.
    #[test]
    fn brackets_stay_whole() {
        let rows = [
            "-0.00775 \u{b1} 0.00051",
            "(-7.4 \u{b1} 1.8)e-4",
            "(0.0 \u{b1} 2.5)e-11",
        ]
        .map(|cell| vec![cell.to_owned()]);
        let expected = "  \
  lateral
  -0.00775 \u{b1} 0.00051
     (-7.4 \u{b1} 1.8)e-4
      (0.0 \u{b1} 2.5)e-11
";
        let lines: Vec<String> = table(&["lateral"], &rows)
            .lines()
            .map(|line| line.trim_end().to_owned())
            .collect();
        assert_eq!(
            lines[1..],
            expected.lines().skip(1).map(str::to_owned).collect::<Vec<_>>()
        );
    }

    #[test]
    fn a_table_may_have_one_column_or_no_row() {
        assert_eq!(table(&["mean"], &[]), "  mean\n");
        let rows = [vec!["0.5".to_owned()], vec!["-0.25".to_owned()]];
        assert_eq!(table(&["mean"], &rows), "   mean\n    0.5\n  -0.25\n");
    }
}
