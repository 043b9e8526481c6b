//! Tables that are printed: columns of one width, numbers one below the other.

/// The sign between a value and the half width of its interval.
const PLUS_MINUS: &str = " \u{b1} ";

/// A table as text, a line a row: each column as wide as its widest cell, numbers to the right and words to the left. Cells beyond the
/// columns of the header are remarks.
pub(crate) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let columns = header.iter().enumerate().map(|(column, name)| {
        let cells: Vec<&str> = rows.iter().map(|row| row[column].as_str()).collect();
        Column::of(name, &cells)
    });
    let columns: Vec<Column> = columns.collect();
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

/// A column, its name first, with every cell filled up to its width.
struct Column {
    cells: Vec<String>,
}

impl Column {
    fn of(name: &str, cells: &[&str]) -> Self {
        let aligned = aligned(cells);
        let is_number = |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit() || c == '-');
        let is_right = cells.iter().all(|cell| is_number(cell));
        let all = [name.to_owned()].into_iter().chain(aligned);
        let all: Vec<String> = all.collect();
        let width = all.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        let filled = |cell: &String| match is_right {
            true => format!("{cell:>width$}"),
            false => format!("{cell:<width$}"),
        };
        Self {
            cells: all.iter().map(filled).collect(),
        }
    }
}

/// Cells of values with half widths: decimal points of both stand below each other. Columns without half widths stay as they are.
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
    let values = at_the_point(parts.iter().map(|(value, _)| *value).collect());
    let halves = at_the_point(parts.iter().map(|(_, half)| half.unwrap_or_default()).collect());
    let joined = values.into_iter().zip(halves).zip(parts);
    joined
        .map(|((value, half), (_, given))| match given {
            Some(_) => value + PLUS_MINUS + &half,
            // As wide as the others, so that the column does not move.
            None => value + &" ".repeat(PLUS_MINUS.chars().count()) + &half,
        })
        .collect()
}

/// Texts filled up on both sides, so that their first points, or their ends, stand below each other.
fn at_the_point(texts: Vec<&str>) -> Vec<String> {
    let halves = texts.into_iter().map(|text| {
        let point = text.find('.').unwrap_or(text.len());
        text.split_at(point)
    });
    let halves: Vec<(&str, &str)> = halves.collect();
    let widest = |widths: &mut dyn Iterator<Item = usize>| widths.max().unwrap_or(0);
    let before = widest(&mut halves.iter().map(|(before, _)| before.chars().count()));
    let after = widest(&mut halves.iter().map(|(_, after)| after.chars().count()));
    let filled = |(left, right): (&str, &str)| format!("{left:>before$}{right:<after$}");
    halves.into_iter().map(filled).collect()
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

    #[test]
    fn a_table_may_have_one_column_or_no_row() {
        assert_eq!(table(&["mean"], &[]), "  mean\n");
        let rows = [vec!["0.5".to_owned()], vec!["-0.25".to_owned()]];
        assert_eq!(table(&["mean"], &rows), "   mean\n    0.5\n  -0.25\n");
    }
}
