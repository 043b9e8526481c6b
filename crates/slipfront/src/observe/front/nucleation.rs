//! Nucleation of slip: clusters of neighbours that grow in the order in which blocks slip.

use std::cmp::Ordering;

use crate::lattice::Lattice;

/// Marks a block that has not slipped yet, in place of its cluster.
const NOT_YET: u32 = u32::MAX;

const NEIGHBOURS: [[isize; 2]; 8] = [
    [-1, -1],
    [0, -1],
    [1, -1],
    [-1, 0],
    [1, 0],
    [-1, 1],
    [0, 1],
    [1, 1],
];

/// The first block of every cluster that has reached `least` blocks, not all at once, before an older cluster
/// absorbed it, in order of time.
pub(super) fn nucleations(lattice: &Lattice, times: &[f64], least: usize) -> Vec<usize> {
    assert!(times.len() < NOT_YET as usize, "blocks are numbered with 32 bits");
    let slipped = times.iter().zip(0..).filter(|(time, _)| !time.is_nan());
    let mut order: Vec<(f64, u32)> = slipped.map(|(time, block)| (*time, block)).collect();
    order.sort_unstable_by(earlier);

    let mut clusters = Clusters {
        parent: vec![NOT_YET; times.len()],
        size: vec![0; times.len()],
        has_grown: vec![false; times.len()],
        least,
    };
    let mut sites: Vec<(f64, u32)> = Vec::new();
    let mut met: Vec<(f64, u32)> = Vec::with_capacity(NEIGHBOURS.len());
    for &(_, block) in &order {
        let (i, j) = lattice.column_row(block as usize);
        met.clear();
        for offset in NEIGHBOURS {
            let neighbour = lattice.neighbour(i, j, offset);
            if let Some(root) = neighbour.and_then(|neighbour| clusters.root_of(neighbour as u32)) {
                let cluster = (times[root as usize], root);
                if !met.contains(&cluster) {
                    met.push(cluster);
                }
            }
        }
        // A cluster that is no site is absorbed at any age: a block that slips alone and early is not a
        // nucleation.
        let by_age = |one: &&(f64, u32), other: &&(f64, u32)| earlier(one, other);
        let oldest_site = met
            .iter()
            .filter(|(_, root)| clusters.is_site(*root))
            .min_by(by_age);
        let oldest = oldest_site.or_else(|| met.iter().min_by(by_age)).copied();
        let oldest_root = oldest.map_or(block, |(_, root)| root);
        for &younger in met.iter().filter(|(_, root)| *root != oldest_root) {
            if clusters.is_site(younger.1) {
                sites.push(younger);
            }
        }
        for &(_, younger) in met.iter().filter(|(_, root)| *root != oldest_root) {
            clusters.merge(oldest_root, younger, times);
        }
        clusters.add(block, oldest_root, times);
    }
    let is_left = |block: u32| clusters.parent[block as usize] == block && clusters.is_site(block);
    sites.extend(order.iter().filter(|(_, block)| is_left(*block)));
    sites.sort_unstable_by(earlier);
    sites.into_iter().map(|(_, block)| block as usize).collect()
}

/// Order by time, and by index for blocks that slip at once.
fn earlier(one: &(f64, u32), other: &(f64, u32)) -> Ordering {
    one.0.total_cmp(&other.0).then(one.1.cmp(&other.1))
}

/// Disjoint sets of blocks. The root of each is its first block.
struct Clusters {
    /// Another block of the same cluster, nearer to the root; the root itself for a root.
    parent: Vec<u32>,
    /// Number of blocks of the cluster of a root.
    size: Vec<u32>,
    /// Whether a block of the cluster of a root has slipped later than the root.
    has_grown: Vec<bool>,
    /// Number of blocks that make a cluster a site.
    least: usize,
}

impl Clusters {
    fn is_site(&self, root: u32) -> bool {
        self.size[root as usize] as usize >= self.least && self.has_grown[root as usize]
    }

    /// The root of the cluster of a block, if the block has slipped.
    fn root_of(&mut self, mut block: u32) -> Option<u32> {
        let mut parent = self.parent[block as usize];
        if parent == NOT_YET {
            return None;
        }
        while parent != block {
            // Shortens the path to the root for later searches.
            let above = self.parent[parent as usize];
            self.parent[block as usize] = above;
            block = above;
            parent = self.parent[block as usize];
        }
        Some(block)
    }

    fn merge(&mut self, older: u32, younger: u32, times: &[f64]) {
        let [to, from] = [older, younger].map(|root| root as usize);
        self.parent[from] = older;
        self.size[to] += self.size[from];
        self.has_grown[to] |= self.has_grown[from] || times[from] != times[to];
    }

    /// Adds a block to the cluster of a root, or begins a cluster if it is its own root.
    fn add(&mut self, block: u32, root: u32, times: &[f64]) {
        let [to, added] = [root, block].map(|block| block as usize);
        self.parent[added] = root;
        self.size[to] += 1;
        self.has_grown[to] |= times[added] != times[to];
    }
}
