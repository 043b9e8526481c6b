//! `contact` = "springs": springs to the substrate that break and re-form.

use slipfront::{AfterBreak, ContactSprings};

use crate::case_file::synonyms::{Synonyms, synonyms};
use slipfront_base::number_format::four_digits;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "contact_stiffness" "tangential_stiffness" "k_t" "contact_springs" "asperities" "junctions" =>
        "springs in contact are `friction.contact` = \"springs\", of stiffness \
        `friction.contact_stiffness_star`, or `friction.contact_stiffness_per_area` with its unit";
};

/// Reason why laws with varying thresholds do not apply to springs in contact.
pub(super) const ALONE: &str = "with `contact` = \"springs\" a spring holds the block and breaks at a constant threshold; leave \
                                it out, or use `contact` = \"rigid\"";

/// Reason why keys of kinetic friction do not apply to springs that re-form.
pub(super) const NO_KINETIC: &str = "with `contact` = \"springs\" a broken spring re-forms at once, so there is no kinetic \
                                     friction; leave it out, or use `after_break` = \"slide\"";

/// Reason why coefficients are not drawn again where blocks slide.
pub(super) const SLIDES: &str = "with `after_break` = \"slide\" a contact keeps its coefficients; leave it out, or use \
                                 `after_break` = \"form_again\"";

/// Reason why the keys of springs do not apply to another contact.
pub(super) const ELSEWHERE: &str = "it belongs to `contact` = \"springs\"; set that, or leave it out";

/// Error of springs without a stiffness, at the key of this path.
pub(super) fn without_stiffness(path: &str) -> String {
    format!(
        "`{path}` = \"springs\" needs their stiffness, `contact_stiffness_star` or `contact_stiffness_per_area`"
    )
}

/// Reason why springs that are drawn again require a single rank.
pub(super) const ONE_RANK: &str = "a spring that re-forms takes the coefficient of any block of the slider, but a rank knows \
                                   only its own rows: use one rank, or redraw = false";

/// The law in words, to end a sentence about static friction.
pub(super) fn in_words(law: &ContactSprings) -> String {
    let again = match law.after_break {
        AfterBreak::FormsAgain { redraw: Some(_) } => " and re-form, with new thresholds",
        AfterBreak::FormsAgain { redraw: None } => " and form again",
        AfterBreak::Slides => ", after which blocks slide",
    };
    let stiffness = four_digits(law.stiffness);
    format!(", springs of {stiffness} E h that break{again}")
}
