//! Limits the depth of a text and of a key before they are parsed. Recursive functions read, copy, write and
//! free nested tables, and each level takes stack space.
//!
//! `toml` itself refuses keys of 80 parts and brackets 80 deep, but not both together, which give tables 6400
//! deep. The parser also counts brackets that close nothing, as in `{ [], a = { [], a = `, so that with such
//! mistakes its depth grows with the length of the text.

use toml_parser::Source as Tokens;
use toml_parser::lexer::TokenKind;

use super::error::CaseError;
use super::source::Source;

/// Deepest nesting of a text: open brackets, and the parts of the keys in front of them. No case needs ten.
const MAX_DEPTH: usize = 64;

/// Most parts of a key in an override: `texture.0.center.1` is one number of a pair.
const MAX_PARTS: usize = 4;

/// Parts of a key in an override, such as `texture.0.coverage`.
///
/// # Errors
/// A sentence, if there are too many parts or a part is not a name.
pub fn parts_of(key: &str) -> Result<Vec<&str>, &'static str> {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
    let is_name = |part: &&str| !part.is_empty() && part.chars().all(is_bare);
    // Takes one more than allowed, so that a long key is not split to its end.
    let parts: Vec<&str> = key.split('.').take(MAX_PARTS + 1).map(str::trim).collect();
    if parts.len() > MAX_PARTS || !parts.iter().all(is_name) {
        return Err(
            "the key is to be made of up to four names with dots between them, such as drive.v_star or texture.0.coverage",
        );
    }
    Ok(parts)
}

/// Returns the text, which begins at `offset` of the source, if its nesting is not too deep for the parser.
///
/// # Errors
/// [`CaseError::Invalid`] at the bracket or dot that is nested too deep.
pub fn limit_nesting<'t>(source: &Source, offset: usize, text: &'t str) -> Result<&'t str, CaseError> {
    match too_deep(text) {
        None => Ok(text),
        Some(at) => {
            let sentence = format!(
                "brackets and the parts of keys lead more than {MAX_DEPTH} levels deep here, where no case or study needs ten"
            );
            Err(source.error_at(offset + at..offset + at + 1, sentence))
        }
    }
}

/// An open bracket, and the dots since the last key or value within it began.
struct OpenBracket {
    bracket: Option<TokenKind>,
    dots: usize,
}

/// Position of the first bracket or dot that leads too deep.
fn too_deep(text: &str) -> Option<usize> {
    let level = |bracket| OpenBracket { bracket, dots: 0 };
    // The outermost level is never closed: unmatched brackets find no opening bracket of their kind.
    let mut open = vec![level(None)];
    let (mut depth, mut joined) = (0, false);
    for token in Tokens::new(text).lex() {
        let kind = token.kind();
        let innermost = open.last_mut()?;
        match kind {
            TokenKind::Dot => {
                innermost.dots += 1;
                depth += 1;
            }
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => {
                open.push(level(Some(kind)));
                depth += 1;
            }
            // A bracket of the other kind closes nothing.
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                let opening = match kind {
                    TokenKind::RightSquareBracket => TokenKind::LeftSquareBracket,
                    _ => TokenKind::LeftCurlyBracket,
                };
                if let Some(closed) = open.pop_if(|level| level.bracket == Some(opening)) {
                    depth -= 1 + closed.dots;
                }
            }
            TokenKind::Whitespace | TokenKind::Comment | TokenKind::Equals | TokenKind::Eof => continue,
            // Names after a dot belong to the same key.
            _ if joined => {}
            _ => depth -= std::mem::take(&mut innermost.dots),
        }
        if depth > MAX_DEPTH {
            return Some(token.span().start());
        }
        joined = kind == TokenKind::Dot;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::de::DeTable;

    #[test]
    fn brackets_and_dots_count_where_they_are_open() {
        for text in [
            "a = [1]\n".repeat(1000),
            "a.b.c = 1.5\n".repeat(1000),
            "[a.b.c]\nd.e = 1\n".repeat(1000),
            format!("a = \"{}\"", "[".repeat(1000)),
            format!("a = '{}'", "a.".repeat(1000)),
            format!("# {}\na = 1", "{".repeat(1000)),
            format!("[[a]]\nb = [{}]", "{ c.d = [] }, ".repeat(1000)),
            format!("a = [{}]", "1.5, [2.5], ".repeat(1000)),
            // Without commas this is not TOML, but it is not deep.
            format!("a = [{}]", "1.5 2.5\n".repeat(1000)),
            "a = '''[[[\n[[['''\n".repeat(100),
            format!("a = {}1{}", "[".repeat(MAX_DEPTH), "]".repeat(MAX_DEPTH)),
            format!("a{} = 1", ".a".repeat(MAX_DEPTH)),
            format!("a.b.c = {{ {} = 1 }}", ["d"; MAX_DEPTH - 2].join(".")),
        ] {
            assert_eq!(too_deep(&text), None, "{text:.80}");
        }
        for (piece, levels) in [
            ("[", 1),
            ("{", 1),
            ("{ [], a = ", 1),
            ("{ b = 1 [x], a = ", 1),
            ("[ } ", 1),
            ("{ ] ", 1),
            ("a.", 1),
            ("a . ", 1),
            ("\"a.b\".", 1),
            ("{ a.b.c = ", 3),
            ("[{ a.b = ", 3),
        ] {
            let text = format!("a = 1\n{}", piece.repeat(1000));
            let at = too_deep(&text).unwrap_or_else(|| panic!("{piece} is not found"));
            assert!(at <= 6 + (MAX_DEPTH / levels + 1) * piece.len(), "{piece}: {at}");
        }
    }

    /// The parser's own limits, on keys and on brackets alone, are never reached: the sentence is always one
    /// of this crate.
    #[test]
    fn what_is_let_through_is_parsed() {
        let nested = |levels: usize, key: &str| {
            let (opened, closed) = (format!("{{ {key} = ").repeat(levels), "}".repeat(levels));
            format!("a = {opened}1{closed}")
        };
        for text in [
            nested(MAX_DEPTH, "a"),
            nested(MAX_DEPTH / 2, "a.b"),
            nested(1, &["a"; MAX_DEPTH].join(".")),
        ] {
            assert_eq!(too_deep(&text), None, "{text:.80}");
            assert!(DeTable::parse(&text).is_ok(), "{text:.80}");
        }
        for text in [
            nested(MAX_DEPTH + 1, "a"),
            nested(MAX_DEPTH / 2 + 1, "a.b"),
            nested(75, &["a"; 79].join(".")),
        ] {
            let source = Source::new("case.toml", &text);
            let error = limit_nesting(&source, 0, &text).unwrap_err().to_string();
            assert!(
                error.starts_with("case.toml:1:") && error.contains("more than 64 levels deep"),
                "{error}"
            );
        }
    }

    #[test]
    fn keys_have_few_parts() {
        assert_eq!(
            parts_of("texture.0.center.1"),
            Ok(vec!["texture", "0", "center", "1"])
        );
        for key in [
            "",
            ".",
            "drive.",
            "a..b",
            "a.b.c.d.e",
            &"a.".repeat(5000),
            "a b",
            "\u{e9}",
            "\"a\".b",
        ] {
            assert!(parts_of(key).is_err(), "{key:.80}");
        }
    }
}
