//! A search with an ask-and-tell interface: the caller measures the loss of each texture.

use std::collections::HashMap;
use std::sync::Arc;

use crate::search::{Proposal, RatedTexture, Search, hash};

/// A search for which the caller makes the runs.
#[derive(Debug)]
pub struct OpenSearch {
    search: Search,
    /// Textures that were proposed and have no known loss yet.
    asked: HashMap<[u8; 32], Proposal>,
}

impl OpenSearch {
    pub(crate) fn new(search: Search) -> Self {
        Self {
            search,
            asked: HashMap::new(),
        }
    }

    /// Proposes up to `n` new textures; fewer if the limits leave few.
    pub fn ask(&mut self, n: usize) -> Vec<Arc<Vec<bool>>> {
        let proposals = self.search.ask(n, &|| false);
        let textures = proposals
            .iter()
            .map(|proposal| Arc::clone(&proposal.texture))
            .collect();
        self.asked.extend(
            proposals
                .into_iter()
                .map(|proposal| (hash(&proposal.texture), proposal)),
        );
        textures
    }

    /// Takes textures with their losses, the lower the better. The textures need not be proposed ones.
    pub fn tell(&mut self, rated: Vec<(Vec<bool>, f64)>) {
        let found = rated.into_iter().map(|(texture, loss)| {
            let asked = self.asked.remove(&hash(&texture));
            let proposal = asked.unwrap_or_else(|| self.search.of_other(texture));
            RatedTexture { proposal, loss }
        });
        let found: Vec<RatedTexture> = found.collect();
        self.search.add_losses(&found);
    }

    /// The best texture with a known loss, and its loss.
    pub fn best(&self) -> Option<(Arc<Vec<bool>>, f64)> {
        let best = self.search.best().first()?;
        Some((Arc::clone(&best.proposal.texture), best.loss))
    }
}
