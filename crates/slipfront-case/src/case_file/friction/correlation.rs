//! `correlation_length`: random coefficients that are alike over a length.

use crate::case_file::key::{Key, key, quantity, within};

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    key("correlation_length", "", quantity("m", within(1e-13, 1e8)), "length over which random coefficients are alike; without it every block draws its own")
        .title("correlation length", "\u{3be}", "m"),
];

pub(super) const SYNONYMS: &[(&str, &str)] = &[
    ("correlation", ADVICE),
    ("correlated", ADVICE),
    ("autocorrelation_length", ADVICE),
    ("patch_size", ADVICE),
    ("xi", ADVICE),
];
const ADVICE: &str = "coefficients that are alike over a length are `friction.correlation_length` = \"5 um\"";

/// Reason for which a correlation length has no meaning where no coefficient is drawn.
pub(super) const GIVEN: &str =
    "all coefficients are given by files, and none is drawn; leave out it or one of the files";

/// Reason for which springs are not drawn anew from a field.
pub(super) const REDRAW: &str = "a spring that forms again takes the coefficient of any block, so that neighbours would no longer be alike over \
                                 `correlation_length`; leave one of them out";
