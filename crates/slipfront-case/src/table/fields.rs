//! The fields of a line.

use std::borrow::Cow;

/// A line without a closing quotation mark in its last field.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct OpenQuote;

/// The fields of a line, without surrounding blanks. A field may be in quotation marks, with a doubled mark
/// for one inside it. Several blanks count as one separator.
pub(super) fn fields(line: &str, separator: char) -> Result<Vec<Cow<'_, str>>, OpenQuote> {
    let mut fields = Vec::new();
    let mut rest = line;
    loop {
        let (field, behind) = match rest.trim_start_matches(is_padding(separator)).strip_prefix('"') {
            Some(quoted) => {
                let (field, behind) = quoted_field(quoted)?;
                (field, behind.split_once(separator).map(|(_, behind)| behind))
            }
            None => match rest.split_once(separator) {
                Some((field, behind)) => (Cow::Borrowed(bare(field)), Some(behind)),
                None => (Cow::Borrowed(bare(rest)), None),
            },
        };
        if separator != ' ' || !field.is_empty() {
            fields.push(field);
        }
        match behind {
            Some(behind) => rest = behind,
            None => return Ok(fields),
        }
    }
}

/// A field without surrounding blanks and byte order marks, which concatenated files contain.
fn bare(field: &str) -> &str {
    field.trim_matches(|character: char| character.is_whitespace() || character == '\u{feff}')
}

/// Whether a character may surround a field without being a part of it.
fn is_padding(separator: char) -> impl Fn(char) -> bool {
    move |character| character.is_whitespace() && character != separator
}

/// The field after an opening quotation mark, and the text after its end.
fn quoted_field(text: &str) -> Result<(Cow<'_, str>, &str), OpenQuote> {
    let mut end = text.find('"').ok_or(OpenQuote)?;
    let mut has_quotes = false;
    while text[end + 1..].starts_with('"') {
        has_quotes = true;
        end += 2 + text[end + 2..].find('"').ok_or(OpenQuote)?;
    }
    let field = text[..end].trim();
    let field = match has_quotes {
        true => Cow::Owned(field.replace("\"\"", "\"")),
        false => Cow::Borrowed(field),
    };
    Ok((field, &text[end + 1..]))
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    #[test_case("1, 2 ,3", ',' => vec!["1", "2", "3"]; "blanks around")]
    #[test_case("\"Time, s\",\"a \"\"b\"\"\",", ',' => vec!["Time, s", "a \"b\"", ""]; "quotes")]
    #[test_case("  1   2 ", ' ' => vec!["1", "2"]; "columns")]
    #[test_case("\t1\t", '\t' => vec!["", "1", ""]; "tabs")]
    #[test_case("", ',' => vec![""]; "nothing")]
    fn lines_have_fields(line: &str, separator: char) -> Vec<String> {
        let fields = fields(line, separator).unwrap();
        fields.iter().map(ToString::to_string).collect()
    }

    #[test_case("1,\"2")]
    #[test_case("1,\"2\"\"")]
    fn a_quotation_mark_is_closed_in_its_line(line: &str) {
        assert_eq!(fields(line, ','), Err(OpenQuote));
    }
}
