//! Limits the nesting of brackets before a text is parsed.
//!
//! `toml` itself refuses what is nested more than 80 deep. But it also counts brackets that close nothing, as in
//! `{ [], a = { [], a = `, so that a text of such mistakes takes it as deep as it is long, and overflows the stack.

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Deepest nesting that is passed on: more than `toml` accepts, so that the error is its own.
const MOST: usize = 200;

/// The text up to the bracket that is nested too deep. Brackets are still open there, so that what is left is no valid
/// TOML and the parser refuses it.
pub fn limit_nesting(text: &str) -> &str {
    let mut open = Vec::new();
    for token in Source::new(text).lex() {
        match token.kind() {
            kind @ (TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket) => {
                if open.len() == MOST {
                    return &text[..token.span().start()];
                }
                open.push(kind);
            }
            // A bracket of the other kind closes nothing.
            TokenKind::RightSquareBracket => {
                open.pop_if(|kind| *kind == TokenKind::LeftSquareBracket);
            }
            TokenKind::RightCurlyBracket => {
                open.pop_if(|kind| *kind == TokenKind::LeftCurlyBracket);
            }
            _ => {}
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_count_where_they_are_open() {
        for text in [
            "a = [1]\n".repeat(1000),
            format!("a = \"{}\"", "[".repeat(1000)),
            format!("# {}\na = 1", "{".repeat(1000)),
            format!("[[a]]\nb = [{}]", "{ c = [] }, ".repeat(1000)),
            "a = '''[[[\n[[['''\n".repeat(100),
        ] {
            assert_eq!(limit_nesting(&text), text);
        }
        for piece in ["[", "{", "{ [], a = ", "{ b = 1 [x], a = ", "[ } ", "{ ] "] {
            let text = format!("a = {}", piece.repeat(1000));
            let shorter = limit_nesting(&text);
            assert!(shorter.len() <= 4 + MOST * piece.len(), "{piece}");
            assert!(shorter.parse::<toml::Table>().is_err(), "{piece}");
        }
    }
}
