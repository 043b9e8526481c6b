//! The files of `cases/` in this crate, embedded in the program so that `slipfront paper` needs no other
//! files.

/// Pairs of name and text, from names relative to `cases/` without `.toml`.
macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../cases/", $name, ".toml")))),*]
    };
}

/// Case and study files by their names.
pub(super) const FILES: &[(&str, &str)] = files![
    "fig02",
    "fig05",
    "fig05_long",
    "fig06",
    "fig06_material",
    "fig07",
    "fig07_literal",
    "fig07_steps",
    "fig08",
    "fig09",
    "fig10",
    "fig10_long",
    "fig10_windows",
    "fig11",
    "fig12",
    "fig12_fluctuations",
    "fig12_kinetic",
    "fig12_surfaces",
    "fig13",
    "fig14",
    "fig15",
    "fig15_starts",
    "fig16",
    "fig16_generality",
    "fig16_grooves",
    "fig17",
    "fig18",
    "sensitivity",
    "sensitivity_texture",
    "table1/case1",
    "table1/case2",
    "table1/case3",
    "table1/case3_corrected",
    "table1/case4",
    "table1/case5",
    "table1/case6",
    "table1/case6_corrected",
    "table1/case7",
    "table1/case7_corrected",
    "table1/case8",
];

/// The text of the list of claims.
pub(super) const CLAIMS: &str = include_str!("../cases/claims.toml");

/// Names and texts of the cases and studies behind the figures and tables of the paper.
pub fn cases() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.iter().copied()
}
