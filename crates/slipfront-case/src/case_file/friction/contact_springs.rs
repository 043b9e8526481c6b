//! `contact` = "springs": springs to the substrate that break and form again.

use slipfront::ContactSprings;

use slipfront_base::number_format::four_digits;

pub(super) const SYNONYMS: &[(&str, &str)] = &[
    ("contact_stiffness", ADVICE),
    ("tangential_stiffness", ADVICE),
    ("k_t", ADVICE),
    ("contact_springs", ADVICE),
    ("asperities", ADVICE),
    ("junctions", ADVICE),
];
const ADVICE: &str = "springs in contact are `friction.contact` = \"springs\", of stiffness `friction.contact_stiffness_star`, or \
     `friction.contact_stiffness_per_area` with its unit";

/// Reason for which other keys have no meaning beside springs.
pub(super) const ALONE: &str = "with `contact` = \"springs\" a block is held by its spring at any speed, and there is no kinetic \
                                friction; leave it out, or take `contact` = \"rigid\"";

/// Reason for which the keys of springs have no meaning beside another contact.
pub(super) const ELSEWHERE: &str = "it belongs to `contact` = \"springs\"; set that, or leave it out";

/// Error of springs without a stiffness, at the key of this path.
pub(super) fn without_stiffness(path: &str) -> String {
    format!(
        "`{path}` = \"springs\" needs their stiffness, `contact_stiffness_star` or `contact_stiffness_per_area`"
    )
}

/// Reason for which springs that are drawn anew take one rank.
pub(super) const ONE_RANK: &str = "a spring that forms again takes the coefficient of any block of the slider, and a rank knows those of its own \
                                   rows alone: take one rank, or redraw = false";

/// The law in words, for the end of a sentence about static friction.
pub(super) fn in_words(law: &ContactSprings) -> String {
    let again = if law.redraw.is_some() {
        ", thresholds drawn anew"
    } else {
        ""
    };
    let stiffness = four_digits(law.stiffness);
    format!(", springs of {stiffness} E h that break{again}")
}
