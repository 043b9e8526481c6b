//! The sliders that the examples measure.

use std::error::Error;
use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::device::EnergySteps;
use slipfront::surface::{Coefficients, Contact, Distribution, Load};
use slipfront::{Drive, FrictionLaw, Lattice, Model, Slider, Surface, scales};

pub(crate) type Failure = Box<dyn Error + Send + Sync>;

pub(crate) const DT_STAR: f64 = 0.1;

/// Energies are computed only at the start.
pub(crate) const ENERGIES: EnergySteps = EnergySteps {
    every: u64::MAX,
    last: 0,
};

/// A square slider as in the paper's Fig. 3, `size` blocks long, at the speed `v_star`.
pub(crate) fn model(size: usize, v_star: f64, seed: u64) -> Result<Arc<Model>, Failure> {
    let lattice = Lattice::free(size, size);
    let n = lattice.n_blocks();
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let coefficients = Coefficients::draw_blocks(0..n, gauss(1.0), gauss(0.5), seed);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let surface = Surface::of_ranks(coefficients, vec![false; n], contact, &Slider::default(), &Alone)?;
    let (drive, damping) = (Drive::along_x(v_star), scales::damping(0.1));
    let model = Model::new(lattice, surface, drive, damping, 1e-6, FrictionLaw::Projection);
    Ok(Arc::new(model))
}
