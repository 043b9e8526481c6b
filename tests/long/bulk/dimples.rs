//! Sliders with dimples half a pitch wide, for the reference and for the product: periodic squares of equal
//! blocks with R* = 0.5 under slip weakening.

use slipfront::scales;
use slipfront_case::case::Case;
use slipfront_run::run_summary::run_summary;

use crate::half_space::{Blocks, Body};

/// Ratio of kinetic to static friction.
pub(crate) const RATIO: f64 = 0.5;
/// Edge of a block, and Young's modulus, of the product.
pub(crate) const BLOCK: f64 = 10e-6;
pub(crate) const YOUNG_MODULUS: f64 = 2.6e6;
/// Coefficient of static friction of the product; its pressure is 1 Pa.
const MU_STATIC: f64 = 0.6;

/// Dimples on a slider. Lengths are in blocks.
pub(crate) struct Dimples {
    /// Blocks along an edge of the slider.
    pub(crate) side: usize,
    /// Pitch: twice the diameter of a dimple.
    pub(crate) pitch: usize,
    pub(crate) centres: Vec<[f64; 2]>,
}

/// Blocks in contact that carry the load of textured ones.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Sharing {
    /// Every block in contact, in equal parts.
    Equal,
    /// Blocks in contact within a pitch of a textured block.
    Near,
}

impl Dimples {
    /// A square array: one dimple on a periodic square.
    pub(crate) fn array(pitch: usize) -> Self {
        let middle = 0.5 * pitch as f64;
        Self {
            side: pitch,
            pitch,
            centres: vec![[middle, middle]],
        }
    }

    /// Distance from a point to the middle of a block, across periodic edges.
    fn distance(&self, block: usize, from: [f64; 2]) -> f64 {
        let side = self.side as f64;
        let middle = [block % self.side, block / self.side].map(|k| k as f64 + 0.5);
        let apart = |axis: usize| {
            let apart: f64 = (middle[axis] - from[axis]).abs();
            apart.min(side - apart)
        };
        apart(0).hypot(apart(1))
    }

    fn is_textured(&self, block: usize) -> bool {
        let radius = 0.25 * self.pitch as f64;
        self.centres
            .iter()
            .any(|&centre| self.distance(block, centre) < radius)
    }

    /// Load of every block over the mean of all blocks.
    fn load(&self, sharing: Sharing) -> Vec<f64> {
        let n = self.side * self.side;
        let (textured, contact): (Vec<usize>, Vec<usize>) = (0..n).partition(|&b| self.is_textured(b));
        let mut load = vec![0.0; n];
        for &block in &contact {
            load[block] = match sharing {
                Sharing::Equal => n as f64 / contact.len() as f64,
                Sharing::Near => 1.0,
            };
        }
        if sharing == Sharing::Near {
            for block in textured {
                let middle = [block % self.side, block / self.side].map(|k| k as f64 + 0.5);
                let near = contact
                    .iter()
                    .filter(|&&b| self.distance(b, middle) <= self.pitch as f64);
                let near: Vec<usize> = near.copied().collect();
                for &other in &near {
                    load[other] += 1.0 / near.len() as f64;
                }
            }
        }
        load
    }

    /// Slip in blocks over which friction falls, where `w p (1 - nu)/G` is `weakening`: w is
    /// `(mu_s - mu_k) p_c/D_c` with the mean pressure p_c of the blocks in contact. Strength is over its
    /// mean, and stiffness in `G/(1 - nu)` per block.
    fn slip_length(&self, weakening: f64) -> f64 {
        let n = self.side * self.side;
        let contact = (0..n).filter(|&b| !self.is_textured(b)).count();
        let pressure = n as f64 / contact as f64;
        (1.0 - RATIO) * pressure * self.pitch as f64 / weakening
    }

    /// The blocks of the reference.
    pub(crate) fn blocks(&self, weakening: f64, sharing: Sharing) -> Blocks {
        Blocks {
            strength: self.load(sharing),
            ratio: RATIO,
            slip_length: self.slip_length(weakening),
        }
    }

    /// The case of the product, without the keys of its body.
    fn case(&self, poisson: f64, weakening: f64, sharing: Sharing, body: &[String]) -> Case {
        let modulus = YOUNG_MODULUS / (2.0 * (1.0 + poisson) * (1.0 - poisson));
        // A unit of strength is mu_s times 1 Pa.
        let slip_length = self.slip_length(weakening) * MU_STATIC * BLOCK / modulus;
        let within = match sharing {
            Sharing::Equal => 1.0,
            Sharing::Near => self.pitch as f64 * BLOCK,
        };
        let radius = 0.25 * self.pitch as f64 * BLOCK;
        let dimple = |&[x, y]: &[f64; 2]| {
            let [x, y] = [x, y].map(|x| x * BLOCK);
            format!("{{ shape = 'cavity', lambda = '{radius:e} m', center = ['{x:e} m', '{y:e} m'] }}")
        };
        let dimples: Vec<String> = self.centres.iter().map(dimple).collect();
        let text = format!(
            "slider = {{ blocks = [{side}, {side}], block_size = '{BLOCK:e} m', young_modulus = '{YOUNG_MODULUS} Pa', density = '1 g/cm^3',\n\
             edges = 'periodic' }}\nload = {{ pressure = '1 Pa', redistribute = {{ within = '{within:e} m' }} }}\n\
             drive.v_star = 0.002\ntime.stop = 'after_onset'\nfriction = {{ mu_static = {MU_STATIC}, r_star = {RATIO}, sigma_static_star = 0,\n\
             sigma_kinetic_star = 0, slip_weakening.length = '{slip_length:e} m' }}\ntexture = [{dimples}]",
            side = self.side,
            dimples = dimples.join(", "),
        );
        let case = Case::parse(&text, "dimples", "", body).unwrap_or_else(|error| panic!("{text}\n{error}"));
        let surface = &case.model.surface;
        for (block, load) in self.load(sharing).into_iter().enumerate() {
            // Rounding of one sum of quotients.
            assert!((surface.normal_force(block) - load).abs() < 1e-12, "{block}");
        }
        case
    }

    /// Reduction of static friction in % of a half-space, by the reference.
    pub(crate) fn on_half_space(&self, poisson: f64, weakening: f64, sharing: Sharing) -> f64 {
        let body = Body::half_space(self.side, poisson);
        100.0 * (1.0 - body.largest_friction(&self.blocks(weakening, sharing)))
    }

    /// Reduction in % that the product finds with these keys.
    pub(crate) fn in_product(&self, poisson: f64, weakening: f64, sharing: Sharing, keys: &[String]) -> f64 {
        let case = self.case(poisson, weakening, sharing, keys);
        100.0 * (1.0 - run_summary(&case).unwrap().static_friction_star)
    }

    /// Reduction in % that the product finds on a bulk body with these keys, deep without a height.
    pub(crate) fn on_body(&self, poisson: f64, weakening: f64, sharing: Sharing, keys: &[&str]) -> f64 {
        let body = [
            "slider.body='bulk'".to_owned(),
            format!("slider.poisson={poisson}"),
        ];
        let given = keys.iter().map(|&key| key.to_owned());
        let keys: Vec<String> = body.into_iter().chain(given).collect();
        self.in_product(poisson, weakening, sharing, &keys)
    }

    /// Reduction in % on a sheet with Poisson's ratio 1/3. The thickness is in pitches, and the mount in G
    /// over the pitch.
    pub(crate) fn on_sheet(&self, weakening: f64, thickness: f64, mount: f64) -> f64 {
        /// Speed of the drive over the speed with which an oscillation of the mount takes all of the
        /// strength.
        const SPEED: f64 = 1e-3;
        /// Drag over the strength.
        const DRAG: f64 = 5e-4;
        let pitch = self.pitch as f64 * BLOCK;
        let stiffness = mount * 0.375 * YOUNG_MODULUS / pitch;
        // In units of the sheet, E h/l^2.
        let relative = stiffness * BLOCK * BLOCK / (YOUNG_MODULUS * thickness * pitch);
        let speed = SPEED / relative.sqrt();
        let keys = [
            format!("slider.thickness='{:e} m'", thickness * pitch),
            format!("drive.stiffness_per_area='{stiffness:e} N/m^3'"),
            format!("drive.v_star={speed}"),
            format!("slider.omega_star={}", DRAG / speed / scales::damping(1.0)),
        ];
        self.in_product(1.0 / 3.0, weakening, Sharing::Equal, &keys)
    }
}

/// A band of two columns of dimples across the drive, a patch of 2 x 2, and 16 dimples at random places, on a
/// slider of 4 x 4 pitches of `pitch` blocks.
pub(crate) fn patterns(pitch: usize) -> [Dimples; 3] {
    /// Drawn at random, at least 0.6 pitches apart; in pitches.
    const RANDOM: [[f64; 2]; 16] = [
        [1.75, 1.0],
        [2.75, 3.75],
        [0.5, 0.0],
        [3.75, 2.0],
        [3.75, 3.75],
        [3.0, 1.0],
        [0.5, 1.25],
        [3.75, 3.0],
        [2.0, 3.25],
        [3.0, 2.75],
        [1.5, 2.0],
        [3.75, 0.5],
        [2.5, 2.0],
        [1.75, 0.25],
        [0.25, 2.5],
        [1.0, 3.0],
    ];
    let columns = |rows: &[f64]| -> Vec<[f64; 2]> {
        let row = |&y: &f64| [[1.5, y], [2.5, y]];
        rows.iter().flat_map(row).collect()
    };
    let on_slider = |centres: Vec<[f64; 2]>| Dimples {
        side: 4 * pitch,
        pitch,
        centres: centres
            .iter()
            .map(|centre| centre.map(|x| x * pitch as f64))
            .collect(),
    };
    [
        columns(&[0.5, 1.5, 2.5, 3.5]),
        columns(&[1.5, 2.5]),
        RANDOM.to_vec(),
    ]
    .map(on_slider)
}
