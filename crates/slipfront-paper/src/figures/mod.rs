//! The figures and tables of the paper, a file each: which runs it takes, what is measured on them, what is drawn.

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
mod sensitivity;

use crate::error::PaperError;
use crate::measurements::Found;
use crate::runner::Bench;

/// A figure or table of the paper.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Its name: `fig12`.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    pub(crate) find: fn(&mut Bench) -> Result<Found, PaperError>,
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
