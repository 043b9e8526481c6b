//! Dead shear load of a case, and the part of friction that it leaves to the drive.

use slipfront::communicator::lowest_rank;
use slipfront::{Communicator, DeadLoad, Model, Scales};

use crate::case_file::{CaseError, CaseFile, FrictionAlong};
use slipfront_base::number_format::{count, four_digits};

/// The dead load of a case on the blocks of a model, along its drive. For an upright sheet, it acts on the
/// lowest row. All ranks call this at once.
pub(super) fn dead_load(
    file: &CaseFile,
    scales: &Scales,
    model: &Model,
    field: Option<Vec<f64>>,
    ranks: &dyn Communicator,
) -> DeadLoad {
    let of_stress = file.load.shear.as_ref().map(|shear| shear.si() / scales.stress());
    let shear = of_stress.or(file.load.shear_star).unwrap_or(0.0);
    let force = model.drive.direction.map(|d| shear * d);
    let is_upright = file.friction.along == FrictionAlong::X && shear != 0.0;
    let field = if is_upright {
        let blocks = model.lattice.blocks_of(&model.rows);
        // Only on the interface, which is the lowest row.
        let relative = |(k, b): (usize, usize)| match &field {
            _ if b >= model.lattice.nx => 0.0,
            Some(field) => field[k],
            None => 1.0,
        };
        Some(blocks.enumerate().map(relative).collect())
    } else {
        field
    };
    match field {
        Some(field) => DeadLoad::of_blocks(force, field, model.slider(), ranks),
        None => DeadLoad::uniform(force),
    }
}

/// Refuses a dead load that is larger than the friction of the whole slider: nothing would be left for the
/// drive.
pub(super) fn refuse_runaway(file: &CaseFile, model: &Model) -> Result<(), CaseError> {
    let ([borne, _], held) = (model.mean_dead_load(), model.surface.mean_static_force());
    if !model.friction.has_thresholds() || borne.abs() <= held {
        return Ok(());
    }
    let key = file.load.shear_key().unwrap_or_default();
    let sentence = format!(
        "the mean shear load is {} of P mu_s, but static friction holds only {}: the slider would run away at t = 0; reduce the \
         shear load, or increase `load.pressure` or `friction.mu_static`",
        four_digits(borne),
        four_digits(held)
    );
    Err(file.source.error(&format!("load.{key}"), sentence))
}

/// Blocks in contact that slip at t = 0 under the dead load alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AtOnce {
    /// Number of these blocks in the whole lattice.
    pub count: usize,
    /// Column and row of the first of them.
    pub first: [usize; 2],
}

impl AtOnce {
    /// Counts the blocks of all ranks, which call this at once.
    pub(super) fn count(model: &Model, ranks: &dyn Communicator) -> Self {
        let is_pulled = model.dead_load().acts() && model.friction.has_thresholds();
        let slips = |b: &usize| !model.surface.textured[*b] && model.slips_at_once(*b);
        let blocks = if is_pulled { model.surface.n_blocks() } else { 0 };
        let mut own = (0..blocks).filter(slips);
        let first = own.next();
        let lowest = lowest_rank(ranks, first.is_some());
        let mut sums = [first.map_or(0, |_| 1 + own.count() as i64), 0];
        if let Some(first) = first
            && lowest == Some(ranks.rank())
        {
            sums[1] = (model.lattice.blocks_of(&model.rows).start + first) as i64;
        }
        ranks.sum(&mut sums);
        let (i, j) = model.lattice.column_row(sums[1] as usize);
        Self {
            count: sums[0] as usize,
            first: [i, j],
        }
    }

    /// A warning if blocks already slip at t = 0.
    pub(super) fn warning(self) -> Option<String> {
        let Self {
            count: n,
            first: [i, j],
        } = self;
        let (slip, their) = if n == 1 {
            ("slips", "its")
        } else {
            ("slip", "their")
        };
        (n > 0).then(|| {
            format!(
                "{} {slip} at t = 0, because the shear load exceeds {their} static friction; the first is ({i}, {j})",
                count(n, "block")
            )
        })
    }
}
