//! Stiffness, density and outline of the slider, from the case file or its input files.

use slipfront::{Communicator, Outline, Slider};

use super::inputs::Inputs;
use crate::arrays::Slab;
use crate::case_file::{self, CaseError, CaseFile, DEFAULT_THRESHOLD, EdgeSprings, Grade};
use crate::case_file::{MAX_RELATIVE, MIN_RELATIVE};

/// Marks the blocks of some rows that exist; none if the slider fills its lattice.
pub(super) fn outline(inputs: &mut Inputs, slab: &Slab) -> Result<Option<Vec<bool>>, CaseError> {
    let slider = &inputs.file.slider;
    let exists = match (slider.outline, &slider.outline_file) {
        (case_file::Outline::Disc, _) => Outline::disc(inputs.lattice, slab.rows.clone()),
        (case_file::Outline::Mask, Some(name)) => {
            inputs.read_mask("slider.outline_file", name, DEFAULT_THRESHOLD, slab)?
        }
        _ => return Ok(None),
    };
    Ok(Some(exists))
}

/// Given properties of the blocks of this rank.
pub(super) struct GivenBlocks {
    stiffness: Option<Vec<f64>>,
    density: Option<Vec<f64>>,
    exists: Option<Vec<bool>>,
}

impl GivenBlocks {
    /// Reads the files, and refuses properties outside their bounds.
    pub(super) fn read(inputs: &mut Inputs) -> Result<Self, CaseError> {
        let (file, lattice, slab) = (inputs.file, inputs.lattice, inputs.slab.clone());
        let slider = &file.slider;
        let exists = outline(inputs, &slab)?;
        let mut property = |field: &str, name: &Option<String>, grade: &Option<Grade>| {
            if let Some(Grade { along, from, to }) = *grade {
                let rows = slab.rows.clone();
                return Ok(Some(Slider::grade(lattice, rows, along as usize, [from, to])));
            }
            let key = format!("slider.{field}");
            let values = inputs.read_field(&key, name)?;
            let bounds = MIN_RELATIVE..=MAX_RELATIVE;
            let mut of_blocks = values.iter().flatten().enumerate();
            let is_wrong = |(b, value): &(usize, &f64)| {
                let exists = exists.as_ref().is_none_or(|exists| exists[*b]);
                exists && !bounds.contains(value)
            };
            if let Some((b, value)) = of_blocks.find(is_wrong) {
                let (i, j) = lattice.column_row(b + slab.rows.start * lattice.nx);
                let sentence = format!(
                    "block ({i}, {j}) has {value:?}: it must be at least {MIN_RELATIVE:e} and at most {MAX_RELATIVE:e}; it is relative, \
                     so that 1 changes nothing"
                );
                return Err(file.source.error(&key, sentence));
            }
            Ok(values)
        };
        Ok(Self {
            stiffness: property(
                "stiffness_field",
                &slider.stiffness_field,
                &slider.stiffness_grade,
            )?,
            density: property("density_field", &slider.density_field, &slider.density_grade)?,
            exists,
        })
    }

    /// The slider of these blocks. All ranks make it at once. It is refused if no rank has a block.
    pub(super) fn slider(self, file: &CaseFile, ranks: &dyn Communicator) -> Result<Slider, CaseError> {
        let outline = self.exists.map(|exists| Outline::new(exists, ranks));
        if outline.as_ref().is_some_and(|outline| outline.n_blocks == 0) {
            let sentence =
                "no block exists: no pixel at the centre of a block is dark, and no number of an array is 1";
            return Err(file.source.error("slider.outline_file", sentence));
        }
        Ok(Slider {
            viscosity_time: file.slider.viscosity_time_star,
            halves_edge_springs: file.slider.edge_springs == EdgeSprings::Halved,
            ..Slider::new(self.stiffness, self.density, outline, ranks)
        })
    }
}
