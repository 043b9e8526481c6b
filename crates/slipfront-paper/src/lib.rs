//! The whole paper: every figure and table run again, and every claim judged.
//!
//! ```text
//! cases/paper/*.toml -> runs -> Found (numbers, pictures, tables) -> verdicts -> report
//! ```
//!
//! A figure is a file of its own (`fig12.rs`), its cases stand in `cases/paper/fig12.toml`, and the claims about it in
//! `cases/paper/claims.toml`. Read by the command `slipfront paper`.

mod bench;
mod claims;
mod drawing;
mod error;
mod fig02;
mod fig03;
mod fig04;
mod fig05;
mod fig06;
mod fig07;
mod fig08;
mod fig09;
mod fig10;
mod fig11;
mod fig12;
mod fig13;
mod fig14;
mod fig15;
mod fig16;
mod fig17;
mod fig18;
mod files;
mod found;
mod report;
mod saved;
mod sensitivity;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use bench::Bench;
pub use bench::StepRule;
pub use claims::{Claim, Condition, Judged, Verdict, claims};
pub use drawing::Drawing;
pub use error::PaperError;
pub use found::{Found, Number, Panel, Table};
pub use report::{docs_page, foreign_docs, summary, write, write_docs};
#[doc(hidden)] // Read by the fuzz target of these files.
pub(crate) use saved::FOUND;
pub use saved::Saved;

use slipfront_run::study;
use slipfront_run::study::Records;

/// A figure or table of the paper.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Its name: `fig12`.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    find: fn(&mut Bench) -> Result<Found, PaperError>,
}

/// All figures and tables but the schematic of Fig. 1, and the appendix.
#[rustfmt::skip]
pub const FIGURES: [Figure; 19] = [
    Figure { name: "fig02", title: "Fig. 2: a sampled surface", find: fig02::find },
    Figure { name: "table1", title: "Table 1: eight materials at one dimensionless speed", find: fig03::find_table },
    Figure { name: "fig03", title: "Fig. 3: eight materials, one curve", find: fig03::find },
    Figure { name: "fig04", title: "Fig. 4: contact stress through the transition", find: fig04::find },
    Figure { name: "fig05", title: "Fig. 5: three sizes", find: fig05::find },
    Figure { name: "fig06", title: "Fig. 6: onset time and number of steps against speed", find: fig06::find },
    Figure { name: "fig07", title: "Fig. 7: a fast slider", find: fig07::find },
    Figure { name: "fig08", title: "Fig. 8: static friction against speed", find: fig08::find },
    Figure { name: "fig09", title: "Fig. 9: damping", find: fig09::find },
    Figure { name: "fig10", title: "Fig. 10: kinetic over static friction", find: fig10::find },
    Figure { name: "fig11", title: "Fig. 11: where slip begins", find: fig11::find },
    Figure { name: "fig12", title: "Fig. 12: static friction against roughness", find: fig12::find },
    Figure { name: "fig13", title: "Fig. 13: shapes of cavities", find: fig13::find },
    Figure { name: "fig14", title: "Fig. 14: slip fronts around a circular cavity", find: fig14::find },
    Figure { name: "fig15", title: "Fig. 15: reduction of static friction against textured area", find: fig15::find },
    Figure { name: "fig16", title: "Fig. 16: elongated cavities and grooves", find: fig16::find },
    Figure { name: "fig17", title: "Fig. 17: contact stress around them", find: fig17::find },
    Figure { name: "fig18", title: "Fig. 18: the shape of a cavity", find: fig18::find },
    Figure { name: "sensitivity", title: "Appendix: what the paper leaves open", find: sensitivity::find },
];

/// The figures that a user names: `all`, `fig3` or `fig03`, `table1`, `sensitivity`.
///
/// # Errors
/// [`PaperError::Figure`] names the first that there is not.
pub fn figures(names: &[String]) -> Result<Vec<Figure>, PaperError> {
    if names.is_empty() || names.iter().any(|name| name == "all") {
        return Ok(FIGURES.to_vec());
    }
    let full = |name: &str| match name.strip_prefix("fig") {
        Some(number) if number.len() == 1 => format!("fig0{number}"),
        _ => name.to_owned(),
    };
    if let Some(given) = names
        .iter()
        .find(|name| !FIGURES.iter().any(|figure| figure.name == full(name)))
    {
        return Err(PaperError::Figure {
            given: given.clone(),
            known: FIGURES.map(|figure| figure.name).join(", "),
        });
    }
    let wanted = |figure: &Figure| names.iter().any(|name| full(name) == figure.name);
    Ok(FIGURES.into_iter().filter(wanted).collect())
}

/// How the paper is gone through.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// Runs at once.
    pub threads: usize,
    /// Set by a signal: everything ends, finished runs of studies are safe.
    pub stop: &'a AtomicBool,
    /// Two random surfaces in place of five, one time step, and only the claims that survive that.
    pub reduced: bool,
    /// Folder in which findings are kept: a figure that this program has finished there is not run again.
    pub folder: &'a Path,
}

/// How far it has come.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// Figures done so far, under both step rules together.
    pub done: usize,
    /// Figures to do.
    pub total: usize,
    /// The present one.
    pub figure: &'a Figure,
    /// Its time step.
    pub step: StepRule,
    /// The present study of that figure, if it has come to one.
    pub study: Option<&'a study::Progress>,
}

/// What came of the figures and claims.
#[derive(Debug)]
pub struct Paper {
    /// Each figure and what it found with the step of 0.1.
    pub figures: Vec<(Figure, Found)>,
    /// The claims about them.
    pub judged: Vec<Judged>,
    /// The same claims in the same order, measured with the paper's step; empty in the reduced version.
    pub judged_by_paper_step: Vec<Judged>,
    /// Whether this is the reduced version.
    pub reduced: bool,
}

impl Paper {
    /// The claims whose verdict is not the expected one, under either step rule.
    pub fn surprises(&self) -> impl Iterator<Item = (StepRule, &Judged)> {
        let both = [
            (StepRule::Auto, &self.judged),
            (StepRule::Paper, &self.judged_by_paper_step),
        ];
        both.into_iter().flat_map(|(rule, judged)| {
            judged
                .iter()
                .filter(|judged| !judged.as_expected())
                .map(move |judged| (rule, judged))
        })
    }
}

/// Runs figures and judges the claims about them, and about those that earlier calls have finished, with both time steps.
///
/// # Errors
/// When a run fails, a record cannot be written, or a signal asks to stop.
pub fn run(
    figures: &[Figure],
    records: &mut Records,
    options: &Options,
    watch: &mut dyn FnMut(&Stage),
) -> Result<Paper, PaperError> {
    let rules: &[StepRule] = match options.reduced {
        true => &[StepRule::Auto],
        false => &[StepRule::Auto, StepRule::Paper],
    };
    let saved = Saved::open(options.folder, options.reduced)?;
    // What earlier calls have finished costs nothing, and the report is of all that is there.
    let is_there = |figure: &Figure| rules.iter().all(|&rule| saved.load(figure.name, rule).is_some());
    let is_wanted = |figure: &Figure| figures.iter().any(|wanted| wanted.name == figure.name);
    let figures: Vec<Figure> = FIGURES
        .into_iter()
        .filter(|figure| is_wanted(figure) || is_there(figure))
        .collect();
    let total = figures.len() * rules.len();
    let mut done = 0;
    let mut passes = Vec::new();
    for &step in rules {
        let mut pass = Vec::new();
        for figure in &figures {
            let stage = Stage {
                done,
                total,
                figure,
                step,
                study: None,
            };
            watch(&stage);
            let mut bench = Bench {
                records: &mut *records,
                threads: options.threads,
                stop: options.stop,
                step,
                reduced: options.reduced,
                watch: &mut |progress| {
                    watch(&Stage {
                        study: Some(progress),
                        ..stage
                    });
                },
            };
            let found = match saved.load(figure.name, step) {
                Some(found) => found,
                None => {
                    let found = (figure.find)(&mut bench)?;
                    saved.save(figure.name, step, &found)?;
                    found
                }
            };
            pass.push((*figure, found));
            done += 1;
        }
        passes.push(pass);
    }
    let judge = |pass: &[(Figure, Found)]| judge(pass, options.reduced);
    let judged = passes
        .iter()
        .map(|pass| judge(pass))
        .collect::<Result<Vec<_>, _>>()?;
    let mut judged = judged.into_iter();
    Ok(Paper {
        judged: judged.next().unwrap_or_default(),
        judged_by_paper_step: judged.next().unwrap_or_default(),
        figures: passes.swap_remove(0),
        reduced: options.reduced,
    })
}

/// The claims about these figures.
fn judge(figures: &[(Figure, Found)], reduced: bool) -> Result<Vec<Judged>, PaperError> {
    let numbers: BTreeMap<String, Number> = figures
        .iter()
        .flat_map(|(_, found)| found.numbers.iter().map(|(name, number)| (name.clone(), *number)))
        .collect();
    let about = |claim: &Claim| figures.iter().any(|(figure, _)| figure.name == claim.figure());
    claims()?
        .into_iter()
        .filter(|claim| about(claim) && (claim.reduced || !reduced))
        .map(|claim| claim.judge(&numbers))
        .collect()
}
