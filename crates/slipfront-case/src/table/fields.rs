//! The fields of a line.

use std::borrow::Cow;

/// A line whose last field has no closing quotation mark.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct OpenQuote;

/// The fields of a line, without blanks around them. A field may stand in quotation marks, where two of them
/// are one; several blanks that separate are one.
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

/// A field without blanks around it, nor marks of the byte order, which files that were joined have inside.
fn bare(field: &str) -> &str {
    field.trim_matches(|character: char| character.is_whitespace() || character == '\u{feff}')
}

/// Whether a character stands around a field without being a part of it.
fn is_padding(separator: char) -> impl Fn(char) -> bool {
    move |character| character.is_whitespace() && character != separator
}

/// The field behind a quotation mark, and what follows its end.
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
