//! The header of a `.npy` file: a Python dictionary of `descr`, `fortran_order` and `shape`.

/// The header of a `.npy` file.
#[derive(Debug, PartialEq)]
pub(super) struct NpyHeader<'a> {
    /// The type of the numbers as the header states it: `'<f8'`, or a list for a structured type.
    pub(super) descr: &'a str,
    /// Whether the first axis runs fastest.
    pub(super) fortran_order: bool,
    /// Numbers along every axis.
    pub(super) shape: Vec<u64>,
}

impl<'a> NpyHeader<'a> {
    /// Reads the text of a header; none if it does not describe an array of numbers, or if their count
    /// exceeds 64 bits.
    pub(super) fn parse(text: &'a [u8]) -> Option<Self> {
        let text = std::str::from_utf8(text).ok()?.trim();
        let entries = text.strip_prefix('{')?.strip_suffix('}')?;
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        for entry in split(entries, ',')? {
            let [key, value] = split(entry, ':')?.try_into().ok()?;
            let is_new = match quoted(key)? {
                "descr" => descr.replace(value).is_none(),
                "fortran_order" => fortran_order.replace(truth(value)?).is_none(),
                "shape" => shape.replace(sizes(value)?).is_none(),
                _ => false,
            };
            if !is_new {
                return None;
            }
        }
        let (descr, fortran_order, shape) = (descr?, fortran_order?, shape?);
        Some(Self {
            descr,
            fortran_order,
            shape,
        })
    }

    /// The type of plain numbers, without its quotes.
    pub(super) fn plain_type(&self) -> Option<&'a str> {
        quoted(self.descr)
    }
}

/// The parts of a text between separators outside quotes and brackets, without blanks around them. An empty
/// last part is left out. None if quotes or brackets do not close.
fn split(text: &str, separator: char) -> Option<Vec<&str>> {
    let (mut parts, mut start) = (Vec::new(), 0);
    let (mut depth, mut quote) = (0_usize, None);
    for (at, letter) in text.char_indices() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (Some(_), _) => {}
            (None, '\'' | '"') => quote = Some(letter),
            (None, '(' | '[' | '{') => depth += 1,
            (None, ')' | ']' | '}') => depth = depth.checked_sub(1)?,
            (None, _) if letter == separator && depth == 0 => {
                parts.push(text[start..at].trim());
                start = at + letter.len_utf8();
            }
            (None, _) => {}
        }
    }
    let last = text[start..].trim();
    if !last.is_empty() {
        parts.push(last);
    }
    (depth == 0 && quote.is_none()).then_some(parts)
}

/// The text between quotes.
fn quoted(text: &str) -> Option<&str> {
    let inner = |quote| text.strip_prefix(quote)?.strip_suffix(quote);
    inner('\'').or_else(|| inner('"'))
}

fn truth(text: &str) -> Option<bool> {
    match text {
        "True" => Some(true),
        "False" => Some(false),
        _ => None,
    }
}

/// The numbers of a tuple, if their product fits into 64 bits.
fn sizes(text: &str) -> Option<Vec<u64>> {
    let inner = text.strip_prefix('(')?.strip_suffix(')')?;
    let sizes: Option<Vec<u64>> = split(inner, ',')?.iter().map(|size| size.parse().ok()).collect();
    let sizes = sizes?;
    sizes.iter().try_fold(1_u64, |all, size| all.checked_mul(*size))?;
    Some(sizes)
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    #[test_case("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }   \n", "'<f8'", false, &[3, 4])]
    #[test_case("{\"shape\":(),\"fortran_order\":True,\"descr\":\"|b1\"}", "\"|b1\"", true, &[])]
    #[test_case(
        "{'descr': [('a, b}', '<f8', (2,))], 'fortran_order': False, 'shape': (7,)}", "[('a, b}', '<f8', (2,))]",
        false, &[7]
    )]
    fn headers_of_numpy_are_read(text: &str, descr: &str, fortran_order: bool, shape: &[u64]) {
        let shape = shape.to_vec();
        let expected = NpyHeader {
            descr,
            fortran_order,
            shape,
        };
        assert_eq!(NpyHeader::parse(text.as_bytes()), Some(expected));
    }

    #[test_case(""; "nothing")]
    #[test_case("{}"; "an empty one")]
    #[test_case("{'descr': '<f8', 'fortran_order': False}"; "no shape")]
    #[test_case("{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (1,)}"; "a key twice")]
    #[test_case("{'descr': '<f8', 'fortran_order': False, 'shape': (1,), 'more': 1}"; "another key")]
    #[test_case("{'descr': '<f8, 'fortran_order': False, 'shape': (1,)}"; "an open quote")]
    #[test_case("{'descr': '<f8', 'fortran_order': False, 'shape': (1, }"; "an open bracket")]
    #[test_case("{'descr': '<f8'), 'fortran_order': False, 'shape': (1,)}"; "a closed one")]
    #[test_case("{'descr': '<f8', 'fortran_order': False, 'shape': (1, two)}"; "no number")]
    #[test_case("{'descr': '<f8', 'fortran_order': False, 'shape': (1,, 2)}"; "a gap")]
    #[test_case("{'descr': '<f8', 'fortran_order': 0, 'shape': (1,)}"; "no truth")]
    #[test_case("{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296)}"; "too many")]
    fn other_texts_are_refused(text: &str) {
        assert_eq!(NpyHeader::parse(text.as_bytes()), None);
    }
}
