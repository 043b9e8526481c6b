//! `correlation_length`: random coefficients that are correlated over a length.

use crate::case_file::synonyms::{Synonyms, synonyms};

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "correlation" "correlated" "autocorrelation_length" "patch_size" "xi" =>
        "the correlation length of coefficients is `friction.correlation_length` = \"5 um\"";
};

/// Reason why a correlation length does not apply where no coefficient is drawn.
pub(super) const GIVEN: &str =
    "all coefficients are given by files, so none is random; leave it out, or one of the files";

/// Reason why springs do not draw new coefficients from a correlated field.
pub(super) const REDRAW: &str = "a spring that re-forms takes the coefficient of any block, so neighbours would lose their \
                                 correlation over `correlation_length`; leave one of them out";
