//! The figures and tables of the paper. Each has its own file with cases, measurements and drawings.

mod fig01;
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
mod lattice;
mod sensitivity;

use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::runner::FigureRunner;

/// A figure or table of the paper.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Name of the figure, such as `fig12`.
    pub name: &'static str,
    /// Title of the figure.
    pub title: &'static str,
    /// Function that runs the figure's cases and adds its measurements to the data.
    pub(crate) measure: fn(&mut FigureRunner, &mut FigureData) -> Result<(), PaperError>,
}

/// All figures and tables, and an appendix on what the paper leaves open.
#[rustfmt::skip]
pub const FIGURES: [Figure; 20] = [
    Figure { name: "fig01", title: "Fig. 1: the model", measure: fig01::measure },
    Figure { name: "fig02", title: "Fig. 2: a sampled surface", measure: fig02::measure },
    Figure { name: "table1", title: "Table 1: eight materials at one dimensionless speed", measure: fig03::measure_table },
    Figure { name: "fig03", title: "Fig. 3: one friction curve for eight materials", measure: fig03::measure },
    Figure { name: "fig04", title: "Fig. 4: contact stress through the transition", measure: fig04::measure },
    Figure { name: "fig05", title: "Fig. 5: three slider sizes", measure: fig05::measure },
    Figure { name: "fig06", title: "Fig. 6: onset time and number of steps against speed", measure: fig06::measure },
    Figure { name: "fig07", title: "Fig. 7: a fast slider", measure: fig07::measure },
    Figure { name: "fig08", title: "Fig. 8: static friction against speed", measure: fig08::measure },
    Figure { name: "fig09", title: "Fig. 9: damping", measure: fig09::measure },
    Figure { name: "fig10", title: "Fig. 10: kinetic over static friction", measure: fig10::measure },
    Figure { name: "fig11", title: "Fig. 11: starting points of slip", measure: fig11::measure },
    Figure { name: "fig12", title: "Fig. 12: static friction against roughness", measure: fig12::measure },
    Figure { name: "fig13", title: "Fig. 13: shapes of cavities", measure: fig13::measure },
    Figure { name: "fig14", title: "Fig. 14: slip fronts around a circular cavity", measure: fig14::measure },
    Figure { name: "fig15", title: "Fig. 15: reduction of static friction against textured area", measure: fig15::measure },
    Figure { name: "fig16", title: "Fig. 16: elongated cavities and grooves", measure: fig16::measure },
    Figure { name: "fig17", title: "Fig. 17: contact stress around cavities and grooves", measure: fig17::measure },
    Figure { name: "fig18", title: "Fig. 18: the shape of a cavity", measure: fig18::measure },
    Figure { name: "sensitivity", title: "Appendix: what the paper leaves open", measure: sensitivity::measure },
];

/// The figures that a user names: `all`, `fig3` or `fig03`, `table1`, `lattice`, `sensitivity`.
///
/// # Errors
/// [`PaperError::Figure`] names the first unknown one.
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
