//! Symbols for the words in the texts of figures and claims.

/// Words, and the symbols that the report shows in their place.
const SYMBOLS: [(&str, &str); 11] = [
    ("sqrt(", "\u{221a}("),
    ("square root of ", "\u{221a}"),
    ("sigma_", "\u{3c3}_"),
    ("mu_", "\u{3bc}_"),
    ("mu*", "\u{3bc}*"),
    ("Omega*", "\u{3a9}*"),
    ("lambda", "\u{3bb}"),
    ("epsilon", "\u{3b5}"),
    ("rho", "\u{3c1}"),
    ("dt*", "\u{394}t*"),
    ("^2", "\u{b2}"),
];

/// A text with symbols in place of words. Subscripts remain marked by an underscore.
pub(super) fn greek(text: &str) -> String {
    SYMBOLS
        .iter()
        .fold(text.to_owned(), |text, (word, symbol)| text.replace(word, symbol))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_letters() {
        let seen = greek("dt* = (2/3) V*, sqrt(E/rho), mu_s* and sigma_s*");
        assert_eq!(
            seen,
            "\u{394}t* = (2/3) V*, \u{221a}(E/\u{3c1}), \u{3bc}_s* and \u{3c3}_s*"
        );
        assert_eq!(greek("the throughput"), "the throughput");
    }
}
