//! What never changes in a run: lattice, slider, surface, drive, damping and friction law.

use std::ops::Range;

use crate::checkpoint::BlockColumn;
use crate::drive::Drive;
use crate::friction::Friction;
use crate::lattice::{K_DRIVE, Lattice};
use crate::slider::Slider;
use crate::surface::Surface;

/// The slider with its surface and drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Blocks and springs, all of them.
    pub lattice: Lattice,
    /// The rows that this process holds: all, unless it is one rank of several.
    pub rows: Range<usize>,
    /// What differs from block to block of these rows.
    pub slider: Slider,
    /// Friction of every block of these rows.
    pub surface: Surface,
    /// How it is pulled.
    pub drive: Drive,
    /// Damping `Omega` per unit of dimensionless time (see [`crate::scales::damping`]).
    pub damping: f64,
    /// The load's strain `eps = P mu_s/E`; 0 makes the springs linear.
    pub epsilon: f64,
    /// The law of friction.
    pub friction: Friction,
}

impl Model {
    /// Puts the parts together, with all blocks alike. The surface must be made for this lattice.
    pub fn new(
        lattice: Lattice,
        surface: Surface,
        drive: Drive,
        damping: f64,
        epsilon: f64,
        friction: impl Into<Friction>,
    ) -> Self {
        Self::of_rows(lattice, 0..lattice.ny, surface, drive, damping, epsilon, friction)
    }

    /// The model of a rank that holds these `rows` of the lattice, for which the surface must be made.
    pub fn of_rows(
        lattice: Lattice,
        rows: Range<usize>,
        surface: Surface,
        drive: Drive,
        damping: f64,
        epsilon: f64,
        friction: impl Into<Friction>,
    ) -> Self {
        assert_eq!(
            lattice.blocks_of(&rows).len(),
            surface.n_blocks(),
            "the surface belongs to another lattice, or to other rows"
        );
        Self {
            lattice,
            rows,
            slider: Slider::default(),
            surface,
            drive,
            damping,
            epsilon,
            friction: friction.into(),
        }
    }

    /// Columns of a checkpoint: numbers that are kept of every block.
    pub fn n_columns(&self) -> usize {
        BlockColumn::ALL.len() + self.friction.n_columns()
    }

    /// Level of mu* in steady sliding:
    ///
    /// ```text
    /// L = mean(mu_ki F_n,i)/(P l^2 mu_s) + Omega V* mean(m_i)
    /// ```
    ///
    /// with the coefficient at V* of a law in which it depends on the speed, and half the mean threshold of springs in contact.
    pub fn steady_level(&self) -> f64 {
        let kinetic = self.friction.steady_force(&self.surface, self.drive.v_star);
        kinetic + self.damping * self.drive.v_star * self.slider.mean_mass
    }

    /// Rise of mu* per path of the drive over [`Drive::k_drive`] while no block moves: 1 if every block has an equal drive spring.
    pub fn driven_share(&self) -> f64 {
        let springs = self.slider.drive_springs.as_ref();
        springs.map_or(1.0, |springs| springs.sum / self.n_blocks() as f64)
    }

    /// Speed of a drive with a spring of stiffness `k_2` on every block that loads the slider as fast as this one does, in which
    /// waiting times are counted: V* times `sum k_s/(k_2 N)`.
    pub fn loading_speed(&self) -> f64 {
        self.drive.v_star * (self.drive.k_drive * self.driven_share() / K_DRIVE)
    }

    /// Number of blocks of the whole lattice that exist.
    pub fn n_blocks(&self) -> usize {
        self.slider.n_blocks(&self.lattice)
    }

    /// Time of the first slip of a block in contact on a surface without texture, exact:
    /// `t* = min_i max(mu_si, mu_ki) F_n,i/(k_s,i V*)`.
    pub fn first_slip_estimate(&self) -> f64 {
        let (k, v_star) = (self.drive.k_drive, self.drive.v_star);
        self.friction.first_slip_pull(&self.surface, k, v_star) / (k * v_star)
    }
}
