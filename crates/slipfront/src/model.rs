//! The model of a run, which never changes: lattice, slider, surface, drive, damping and friction law.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

use crate::body::Body;
use crate::communicator::Communicator;
use crate::dead_load::DeadLoad;
use crate::drive::{Drive, Loading, Program};
use crate::friction::Friction;
use crate::lattice::{Edges, K_DRIVE, Lattice};
use crate::slider::Slider;
use crate::surface::Surface;
use crate::vector_field::{dot, length};
use slipfront_kernel::fixed_point::sum_over;

/// Path of the drive to the onset of sliding where all blocks are in contact, in units of displacement:
/// t_s* = 2.5/V* (Eq. 12).
pub const ONSET_PATH: f64 = 2.5;

/// The slider with its surface and drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// All blocks and springs of the lattice.
    pub lattice: Lattice,
    /// The rows of the lattice that this process holds: all, unless it is one rank of several.
    pub rows: Range<usize>,
    /// Heterogeneous properties of the blocks of these rows.
    pub(crate) slider: Slider,
    /// The bulk body of which the blocks are the face; none for a sheet, with springs between its blocks.
    pub(crate) body: Option<Body>,
    /// Friction of every block of these rows.
    pub surface: Surface,
    /// The drive of the slider.
    pub drive: Drive,
    /// Constant forces in addition to the drive springs; none in the paper.
    pub(crate) dead_load: DeadLoad,
    /// Damping `Omega` per unit of dimensionless time (see [`crate::scales::damping`]).
    pub damping: f64,
    /// The load's strain `eps = P mu_s l/(E h)`; 0 makes the springs linear.
    pub epsilon: f64,
    /// The law of friction.
    pub friction: Friction,
}

impl Model {
    /// Creates a model with equal blocks; [`with_slider`](Self::with_slider) makes them differ. The surface
    /// must be made for this lattice.
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

    /// The model of a rank that holds these `rows` of the lattice. The surface must be made for these rows.
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
            body: None,
            surface,
            drive,
            dead_load: DeadLoad::default(),
            damping,
            epsilon,
            friction: friction.into(),
        }
    }

    /// Returns the model with a heterogeneous slider; the surface must be made for it.
    ///
    /// # Panics
    /// Unless every array of the slider has one value for each block that this process holds, and an outline
    /// comes with drive springs, 0 where there is no block.
    pub fn with_slider(self, slider: Slider) -> Self {
        slider.assert_fits(self.surface.n_blocks());
        Self { slider, ..self }
    }

    /// Returns the model with a bulk body above its blocks in place of springs between them. The drive
    /// springs pull the body as a whole. Its slider must be set before.
    ///
    /// # Panics
    /// If edges are free, blocks differ, there are dampers between them, the drive rotates, or friction acts
    /// along x alone; or if this rank does not hold all rows.
    pub fn with_body(self, body: Body) -> Self {
        let is_plain = self.slider == Slider::default()
            && self.drive.rotation.is_none()
            && self.friction.interface().is_none();
        assert!(
            is_plain && self.lattice.edges == [Edges::Periodic; 2] && self.rows.len() == self.lattice.ny,
            "a bulk body has periodic edges, equal blocks without dampers on one rank, a drive that does not rotate, and \
             friction in the plane"
        );
        Self {
            body: Some(body),
            ..self
        }
    }

    /// Returns the model with constant forces on its blocks. Its slider and body must be set before.
    ///
    /// # Panics
    /// If forces that differ do not have one value for each block that this process holds, or if the drive
    /// rotates, since no constant force has its direction.
    pub fn with_dead_load(self, dead_load: DeadLoad) -> Self {
        if let Some(field) = &dead_load.field {
            let (forces, blocks) = (field.relative.len(), self.surface.n_blocks());
            assert_eq!(
                forces, blocks,
                "there are {forces} forces for {blocks} blocks: give one each"
            );
        }
        assert!(
            self.drive.rotation.is_none() || !dead_load.acts(),
            "a drive that rotates has no constant forces beside it"
        );
        Self { dead_load, ..self }
    }

    /// Returns the model with the given loading of its drive.
    pub fn with_loading(mut self, loading: Loading) -> Self {
        self.drive.loading = loading;
        self
    }

    /// Returns the model with a program of speeds for its drive, if there is one.
    pub fn with_program(mut self, program: Option<Arc<Program>>) -> Self {
        self.drive.program = program;
        self
    }

    /// The model of some of the rows that this process holds.
    pub(crate) fn of_some_rows(&self, rows: Range<usize>) -> Self {
        let first = self.rows.start;
        let blocks = self.lattice.blocks_of(&(rows.start - first..rows.end - first));
        Self {
            rows,
            slider: self.slider.of_some_blocks(&blocks),
            surface: self.surface.of_some_blocks(&blocks),
            drive: self.drive.clone(),
            dead_load: self.dead_load.of_some_blocks(&blocks),
            ..*self
        }
    }

    /// Heterogeneous properties of the blocks of the rows that this process holds.
    pub fn slider(&self) -> &Slider {
        &self.slider
    }

    /// Constant forces on the blocks in addition to the drive springs.
    pub fn dead_load(&self) -> &DeadLoad {
        &self.dead_load
    }

    /// Mean over the [facing blocks](Surface::n_facing) of the constant forces along the drive and to its
    /// left, over the load: their contribution to mu*.
    pub fn mean_dead_load(&self) -> [f64; 2] {
        let n_facing = self.surface.n_facing() as f64;
        let sum = self
            .dead_load
            .field
            .as_ref()
            .map_or(self.n_blocks() as f64, |field| field.sum);
        self.along_and_across(self.dead_load.force)
            .map(|force| force * (sum / n_facing))
    }

    /// Components of a vector along the direction of a drive that does not rotate, and to the left of it.
    fn along_and_across(&self, vector: [f64; 2]) -> [f64; 2] {
        let [dx, dy] = self.drive.direction;
        [dot(vector, [dx, dy]), dot(vector, [-dy, dx])]
    }

    /// The bulk body of which the blocks are the face, if they are no sheet.
    pub fn body(&self) -> Option<&Body> {
        self.body.as_ref()
    }

    /// Whether a held drive waits until no force on a block exceeds its strength by more than a small share,
    /// as it does for a bulk body; else until no block in contact slides.
    pub fn rests_by_excess(&self) -> bool {
        self.body.is_some() && self.drive.is_held()
    }

    /// Index in the whole lattice of the first block that this process holds.
    pub(crate) fn first_block(&self) -> usize {
        self.lattice.blocks_of(&self.rows).start
    }

    /// Number of existing blocks of the whole lattice.
    pub fn n_blocks(&self) -> usize {
        self.slider.n_blocks(&self.lattice)
    }

    /// Fall of strength per slip of a block in contact, `W = (S - K)/D_c`, with the mean strength of all
    /// blocks in contact, in units of `E h`; none if strength does not fall with slip.
    pub fn weakening(&self) -> Option<f64> {
        let law = self.friction.strength_over_slip()?;
        let drop = self.surface.mean_static_force() - self.surface.mean_kinetic_force();
        Some(drop / self.surface.share_in_contact() / law.length)
    }

    /// Divisor of the sum of the forces of the drive springs in mu*: the number of [facing
    /// blocks](Surface::n_facing); for a rotation `sum r_i/r_max`, which makes mu* the torque of the
    /// drive springs over `P mu_s l^2 sum r_i`.
    pub fn mu_star_divisor(&self) -> f64 {
        match &self.drive.rotation {
            None => self.surface.n_facing() as f64,
            Some(rotation) => rotation.sum_radii,
        }
    }

    /// Rise of mu* per path of the drive over [`Drive::k_drive`] while no block moves: 1 if every block has a
    /// drive spring and the drive does not rotate.
    pub fn driven_share(&self) -> f64 {
        let driven = match &self.drive.rotation {
            None => self.slider.sum_of_drive_springs(&self.lattice),
            Some(rotation) => rotation.sum_squares,
        };
        driven / self.mu_star_divisor()
    }

    /// Speed of a drive with a spring of stiffness `k_2` on every block that loads the slider as fast as this
    /// one. Waiting times are counted in it. The speed is V* times `sum k_s/(k_2 N)`, with the stiffness in
    /// series of the rows of an upright sheet.
    pub fn loading_speed(&self) -> f64 {
        let per_contact = self.pull_through_rows();
        let stiffness = per_contact.unwrap_or_else(|| self.drive.k_drive * self.driven_share());
        self.drive.v_star * (stiffness * self.share_along_friction() / K_DRIVE)
    }

    /// Share of a pull along the drive that friction opposes: `|d_x|` for an upright sheet, where friction
    /// acts along x, and otherwise 1.
    pub(crate) fn share_along_friction(&self) -> f64 {
        match self.friction.interface() {
            Some(_) => self.drive.direction[0].abs(),
            None => 1.0,
        }
    }

    /// Speed at which the paper's drive loads equal blocks as fast as this drive loads these, per time in
    /// which a slip front passes a block: the [loading speed](Self::loading_speed) times
    /// [`Slider::mean_slowness`]. For equal blocks of any modulus and density this is their own V*.
    pub fn speed_against_front(&self) -> f64 {
        self.loading_speed() * self.slider.mean_slowness
    }

    /// Share of the load that the blocks in contact bear: less than 1 if the load of textured blocks is not
    /// redistributed.
    pub fn share_of_load(&self) -> f64 {
        (self.surface.share_in_contact() * self.surface.load_factor()).min(1.0)
    }

    /// The longest time in which mu* falls from its peak half-way to the [level of
    /// sliding](Self::steady_level) in a transition; a slower fall is creep. The largest of three times: the
    /// loading time, 2.5/V* (Eq. 12), after which kinetic friction is measured; the time of a slip front
    /// across the slider, a block per t*; and the period of the slider on its drive springs.
    pub fn longest_fall(&self) -> f64 {
        let delay = self.friction.loading_delay(self.drive.k_drive);
        let loading = ONSET_PATH / self.loading_speed() * delay;
        loading.max(self.response_time())
    }

    /// The longer of two times, in t*: of a slip front across the slider, a block per t*, and the period of
    /// the slider on its drive springs.
    fn response_time(&self) -> f64 {
        let front = self.lattice.nx.max(self.lattice.ny) as f64;
        front.max(TAU / self.drive.k_drive.sqrt())
    }

    /// The longest time, in t*, for which a held drive stands still. Without damping, kinetic friction of R*
    /// times static friction stops an oscillation on the drive springs after some (1 - R*)/(4 R*) periods, so
    /// that a slider that slides for 1000 periods has an R* of less than 3e-4.
    pub(crate) fn longest_stop(&self) -> f64 {
        1000.0 * self.response_time()
    }

    /// Drag of the damping in steady sliding at V*; 0 under a held drive. The part of
    /// [`steady_level`](Self::steady_level) that is not friction. All `ranks` of a lattice must call this
    /// together.
    pub fn steady_drag(&self, ranks: &dyn Communicator) -> f64 {
        let drag = self.damping * self.drive.steady_speed();
        let Some(rotation) = &self.drive.rotation else {
            let blocks_per_facing = self.n_blocks() as f64 / self.surface.n_facing() as f64;
            return drag * self.slider.mean_mass * blocks_per_facing;
        };
        let torque = sum_over(ranks, self.surface.n_blocks(), |b| {
            if self.slider.exists(b) {
                drag * self.slider.mass(b) * self.relative_radius(b).powi(2)
            } else {
                0.0
            }
        });
        torque / rotation.sum_radii
    }

    /// Level of mu* in steady sliding at V*:
    ///
    /// ```text
    /// L = mean(mu_ki F_n,i)/(P l^2 mu_s) + Omega V* mean(m_i) N/N_facing
    /// L = [sum_i mu_ki F_n,i r_i/(P l^2 mu_s) + Omega V* sum_i m_i r_i^2/r_max]/sum_i r_i    of a rotation
    /// ```
    ///
    /// `N_facing` is the
    /// number of [facing blocks](Surface::n_facing). V* counts as 0 under a held drive; a coefficient that
    /// depends on the speed is taken at V*. For contact springs that form again, half the mean threshold
    /// replaces kinetic friction. All `ranks` of a lattice must call this together.
    pub fn steady_level(&self, ranks: &dyn Communicator) -> f64 {
        let Some(rotation) = &self.drive.rotation else {
            let kinetic = self
                .friction
                .steady_force(&self.surface, self.drive.steady_speed());
            return kinetic * self.share_along_friction() + self.steady_drag(ranks);
        };
        let force = |b: usize| {
            let relative = self.relative_radius(b);
            let speed = self.drive.steady_speed() * relative;
            let kinetic = self.friction.steady_force_of(&self.surface, b, speed);
            relative * (kinetic + self.damping * self.slider.mass(b) * speed)
        };
        let torque = sum_over(ranks, self.surface.n_blocks(), |b| {
            if self.slider.exists(b) { force(b) } else { 0.0 }
        });
        torque / rotation.sum_radii
    }

    /// Dead load on block `b` along x and y; none where no block exists.
    pub(crate) fn dead_load_of(&self, b: usize) -> [f64; 2] {
        let relative = if self.slider.exists(b) {
            self.dead_load.relative(b)
        } else {
            0.0
        };
        self.dead_load.force.map(|force| relative * force)
    }

    /// Dead load on block `b` along the drive and to the left of it.
    pub(crate) fn dead_load_on(&self, b: usize) -> [f64; 2] {
        self.along_and_across(self.dead_load_of(b))
    }

    /// Relative radius `r_i/r_max` of block `b` of these rows in a rotation.
    pub(crate) fn relative_radius(&self, b: usize) -> f64 {
        length(self.drive.direction_at(&self.lattice, self.first_block() + b))
    }
}
