//! What never changes in a run: lattice, surface, drive, damping and friction law.

use std::ops::Range;

use crate::friction::FrictionLaw;
use crate::lattice::{K_DRIVE, Lattice};
use crate::surface::Surface;
use crate::vector_field::unit_vector;

/// How the slider is pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Dimensionless speed `V*` (Eq. 11a).
    pub v_star: f64,
    /// Unit vector of the sliding direction.
    pub direction: [f64; 2],
    /// Stiffness `k_s` of the spring on every block, in units of `E l`.
    pub k_drive: f64,
    /// A constant force on every block in addition to the drive spring's, in units of `P mu_s l^2`; zero in the paper.
    pub constant_force: [f64; 2],
}

impl Drive {
    /// Along x at `v_star`.
    pub fn along_x(v_star: f64) -> Self {
        Self {
            v_star,
            direction: [1.0, 0.0],
            k_drive: K_DRIVE,
            constant_force: [0.0, 0.0],
        }
    }

    /// At `v_star`, `degrees` from x towards y.
    pub fn at_angle(v_star: f64, degrees: f64) -> Self {
        Self {
            direction: unit_vector(degrees),
            ..Self::along_x(v_star)
        }
    }

    /// Displacement of the driven ends of the drive springs at `time_star`.
    #[inline]
    pub fn position(&self, time_star: f64) -> [f64; 2] {
        let along = self.v_star * time_star;
        [along * self.direction[0], along * self.direction[1]]
    }

    /// Force of the drive spring on a block at displacement `u` (Eq. 2), `F_s = k_s (V t - u)`, with the constant force.
    pub fn force(&self, u: [f64; 2], time_star: f64) -> [f64; 2] {
        let position = self.position(time_star);
        [0, 1].map(|axis| self.k_drive * (position[axis] - u[axis]) + self.constant_force[axis])
    }
}

/// The slider with its surface and drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Blocks and springs, all of them.
    pub lattice: Lattice,
    /// The rows that this process holds: all, unless it is one rank of several.
    pub rows: Range<usize>,
    /// Friction of every block of these rows.
    pub surface: Surface,
    /// How it is pulled.
    pub drive: Drive,
    /// Damping `Omega` per unit of dimensionless time (see [`crate::scales::damping`]).
    pub damping: f64,
    /// The load's strain `eps = P mu_s/E`; 0 makes the springs linear.
    pub epsilon: f64,
    /// Reading of Eq. 4.
    pub law: FrictionLaw,
}

impl Model {
    /// Puts the parts together. The surface must be made for this lattice.
    pub fn new(
        lattice: Lattice,
        surface: Surface,
        drive: Drive,
        damping: f64,
        epsilon: f64,
        law: FrictionLaw,
    ) -> Self {
        Self::of_rows(lattice, 0..lattice.ny, surface, drive, damping, epsilon, law)
    }

    /// The model of a rank that holds these `rows` of the lattice, for which the surface must be made.
    pub fn of_rows(
        lattice: Lattice,
        rows: Range<usize>,
        surface: Surface,
        drive: Drive,
        damping: f64,
        epsilon: f64,
        law: FrictionLaw,
    ) -> Self {
        assert_eq!(
            lattice.blocks_of(&rows).len(),
            surface.n_blocks(),
            "the surface belongs to another lattice, or to other rows"
        );
        Self {
            lattice,
            rows,
            surface,
            drive,
            damping,
            epsilon,
            law,
        }
    }

    /// Level of mu* in steady sliding:
    ///
    /// ```text
    /// L = mean(mu_ki F_n,i)/(P l^2 mu_s) + Omega V*
    /// ```
    pub fn steady_level(&self) -> f64 {
        self.surface.mean_kinetic_force() + self.damping * self.drive.v_star
    }

    /// Time of the first slip of a block in contact on a surface without texture, exact:
    /// `t* = min_i max(mu_si, mu_ki) F_n,i/(k_s V*)`.
    pub fn first_slip_estimate(&self) -> f64 {
        self.surface.min_slip_threshold() / (self.drive.k_drive * self.drive.v_star)
    }
}
