//! The model of a case: its blocks, surface, slider and drive, made in the order of their dependencies.

use slipfront::scales::damping;
use slipfront::surface::share_load;
use slipfront::{Communicator, Loading, Model, State, Surface, SurfaceError};

use super::coefficients::{coefficients, contact, sharing_distance};
use super::derived::Derived;
use super::drive::{attach, attached, drive};
use super::initial;
use super::inputs::{Inputs, NamedFiles};
use super::ranks::Ranks;
use super::shear;
use super::slider::GivenBlocks;
use super::textures;
use super::topography::Topography;
use crate::case_file::{self, CaseError};

/// The texture as requested and as meshed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextureReport {
    /// Requested A*, %; none if there is a mask, a polygon, a drawing or the depth of a height map, which
    /// have an area only after meshing.
    pub asked_percent: Option<f64>,
    /// A* as meshed, % (Eq. 15).
    pub meshed_percent: f64,
    /// The height maps.
    pub topographies: Vec<Topography>,
    /// Sentences on what files of drawings contain besides texture.
    pub notes: Vec<String>,
    /// Positions in the case file, from 0, of the textures that a free edge clips.
    pub clipped: Vec<usize>,
    /// Positions of the textures that cover no block.
    pub empty: Vec<usize>,
}

/// Makes the model of some rows of the lattice, without the program of its drive, which needs the time step,
/// and the state in which a run begins, unless it begins at rest. Refuses files that changed while they were
/// read.
pub(super) fn make(
    derived: &Derived,
    named: &NamedFiles,
    inputs: &mut Inputs,
    ranks: &Ranks,
) -> Result<(Model, TextureReport, Option<State>), CaseError> {
    let (file, scales, groups) = (inputs.file, &derived.scales, &derived.groups);
    let (lattice, rows) = (*inputs.lattice, inputs.slab.rows.clone());
    let blocks = ranks.agree_on_rows(GivenBlocks::read(inputs))?;
    let mut slider = blocks.slider(file, ranks.communicator)?;
    let made = textures::mesh(inputs, slider.n_blocks(&lattice)).and_then(|meshed| {
        let coefficients = coefficients(inputs, groups)?;
        let contact = contact(inputs)?;
        let shear = inputs.read_signed_field("load.shear_field", &file.load.shear_field)?;
        let attached = attached(inputs)?;
        let state = initial::state(inputs, &slider)?;
        Ok((meshed, coefficients, contact, shear, attached, state))
    });
    let ((meshed, report), coefficients, mut contact, shear, attached, state) = ranks.agree_on_rows(made)?;
    ranks.agree(named.expect_unchanged(file))?;
    attach(&mut slider, file, &lattice, &rows, attached, ranks.communicator)?;
    if let Some(distance) = sharing_distance(file, scales, &lattice)? {
        let exists = slider.outline.as_ref().map(|outline| &*outline.exists);
        let (textured, pressure) = (&meshed.textured, contact.pressure.take());
        let shared = share_load(
            &lattice,
            &rows,
            textured,
            exists,
            pressure,
            distance,
            ranks.communicator,
        );
        let refused = |error: SurfaceError| file.source.error("load.redistribute", error.to_string());
        contact.pressure = Some(shared.map_err(refused)?);
    }
    let surface = Surface::of_ranks(
        coefficients,
        meshed.textured,
        contact,
        &slider,
        ranks.communicator,
    )
    .map_err(|error| file.source.error("texture", error.to_string()))?;
    let texture = TextureReport {
        meshed_percent: surface.texture_percent(),
        clipped: meshed.clipped,
        empty: empty_on_all(&meshed.empty, file.texture.len(), ranks.communicator),
        ..report
    };
    let drive = drive(file, derived, (&lattice, &rows), &slider, ranks.communicator)?;
    let (damping, friction) = (damping(groups.omega_star), derived.friction);
    let model = Model::of_rows(lattice, rows, surface, drive, damping, groups.epsilon, friction);
    let model = model.with_slider(slider);
    let model = match file.slider.bulk_body() {
        None => model,
        Some(body) => model.with_body(body),
    };
    // How many of its steps count is decided with the time step.
    let model = match file.drive.loading {
        case_file::Loading::Constant => model,
        case_file::Loading::Held => model.with_loading(Loading::Held {
            onset_steps: u64::MAX,
        }),
    };
    let load = shear::dead_load(file, scales, &model, shear, ranks.communicator);
    let model = model.with_dead_load(load);
    shear::refuse_runaway(file, &model)?;
    Ok((model, texture, state))
}

/// The textures, out of `n_textures`, that cover no block of any rank; `empty` lists those that cover none of
/// this rank.
fn empty_on_all(empty: &[usize], n_textures: usize, communicator: &dyn Communicator) -> Vec<usize> {
    let mut covers = vec![1.0; n_textures];
    for &texture in empty {
        covers[texture] = 0.0;
    }
    communicator.largest(&mut covers);
    (0..n_textures)
        .filter(|&texture| covers[texture] == 0.0)
        .collect()
}
