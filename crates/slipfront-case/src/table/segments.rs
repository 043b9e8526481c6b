//! One of several tables below each other in a text, as instruments write the steps of a test.

use std::ops::Range;

use super::encoding::Encoding;
use super::error::TableError;

/// The text of a table with one segment, from 1, and the lines above the first row of all. Every other line
/// becomes an empty comment, so that lines keep their numbers. A segment is a sequence of rows with the lines
/// of text above it, unless they have no names; a row begins with a number and has another.
///
/// ```
/// let text = "step 1\nt,F\n0,1\n1,2\nstep 2\nt,F\n0,3\n1,4\n";
/// let second = slipfront_case::table::segment(text.as_bytes(), 2)?;
/// assert_eq!(second, "step 1\nt,F\n#\n#\nstep 2\nt,F\n0,3\n1,4\n");
/// assert!(slipfront_case::table::segment(text.as_bytes(), 3).is_err());
/// # Ok::<_, slipfront_case::table::TableError>(())
/// ```
///
/// # Errors
/// When the text has fewer segments.
pub fn segment(table: &[u8], number: u32) -> Result<String, TableError> {
    let text = Encoding::detect(table).text(table);
    let lines: Vec<&str> = text.lines().collect();
    let segments = segments(&lines);
    let place = number
        .checked_sub(1)
        .and_then(|place| segments.get(place as usize));
    let wanted = place.ok_or(TableError::NoSegment {
        wanted: number,
        found: segments.len(),
    })?;
    let first_row = |range: Range<usize>| range.clone().find(|at| is_row(lines[*at])).unwrap_or(range.end);
    let head = 0..first_row(0..lines.len());
    // Text without a separator has no names, and those above all rows hold.
    let rows = first_row(wanted.clone());
    let has_names = lines[wanted.start..rows]
        .iter()
        .any(|line| line.contains(['\t', ';', ',']));
    let wanted = if has_names {
        wanted.clone()
    } else {
        rows..wanted.end
    };
    let mut kept = String::with_capacity(text.len());
    for (at, line) in lines.iter().enumerate() {
        let is_kept = wanted.contains(&at) || head.contains(&at);
        kept.push_str(if is_kept { line } else { "#" });
        kept.push('\n');
    }
    Ok(kept)
}

/// The lines of all segments.
fn segments(lines: &[&str]) -> Vec<Range<usize>> {
    let (mut found, mut start, mut has_rows) = (Vec::new(), 0, false);
    for (at, line) in lines.iter().enumerate() {
        if is_row(line) {
            has_rows = true;
        } else if has_rows && !line.trim().is_empty() {
            found.push(start..at);
            (start, has_rows) = (at, false);
        }
    }
    if has_rows {
        found.push(start..lines.len());
    }
    found
}

/// Whether a line begins with a number and has another, with any separator and decimal sign.
fn is_row(line: &str) -> bool {
    let mut fields = line
        .split(['\t', ';', ',', ' '])
        .filter(|field| !field.is_empty());
    let is_number = |field: &str| field.trim_matches('"').parse::<f64>().is_ok_and(f64::is_finite);
    fields.next().is_some_and(is_number) && fields.any(is_number)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Empty lines end no segment, and text after the last row is none.
    #[test]
    fn segments_are_rows_with_the_text_above_them() {
        let lines = [
            "Samples\t2\t2",
            "X\tF",
            "",
            "0,0\t1,5",
            "",
            "0,1\t1,6\tslip",
            "***End***",
            "X0\t0",
            "0\t2",
            "1\t3",
            "sum",
            "",
        ];
        assert_eq!(segments(&lines), [0..6, 6..10]);
        assert!(segments(&["one", "2 three"]).is_empty());
    }
}
