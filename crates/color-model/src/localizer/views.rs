use crate::{LightingBank, PixelSums};

/// What a frame, or several, shows to every particle.
pub(crate) struct Views {
    sums: Vec<PixelSums>,
    log_likelihoods: Vec<f64>,
    n_colors: usize,
    n_members: usize,
}

/// What one particle sees.
pub(crate) struct ViewMut<'a> {
    /// Sums of every colour.
    pub(crate) sums: &'a mut [PixelSums],
    /// Log-likelihood under every member of the lighting bank.
    pub(crate) log_likelihoods: &'a mut [f64],
}

impl Views {
    /// Nothing seen yet by `n` particles that share the shape of `bank`.
    pub(crate) fn new(n: usize, bank: &LightingBank) -> Self {
        let (n_colors, n_members) = (bank.n_colors(), bank.n_members());
        Self {
            sums: vec![PixelSums::default(); n * n_colors],
            log_likelihoods: vec![0.0; n * n_members],
            n_colors,
            n_members,
        }
    }

    /// Sums of every colour that a particle sees.
    pub(crate) fn sums(&self, particle: usize) -> &[PixelSums] {
        &self.sums[particle * self.n_colors..][..self.n_colors]
    }

    /// Log-likelihood under every member of the lighting bank.
    pub(crate) fn by_member(&self, particle: usize) -> &[f64] {
        &self.log_likelihoods[particle * self.n_members..][..self.n_members]
    }

    pub(crate) fn n_members(&self) -> usize {
        self.n_members
    }

    /// The views of `size` particles at a time, to be filled in.
    pub(crate) fn chunks_mut(&mut self, size: usize) -> impl Iterator<Item = Vec<ViewMut<'_>>> {
        let (n_colors, n_members) = (self.n_colors, self.n_members);
        let sums = self.sums.chunks_mut(size * n_colors);
        sums.zip(self.log_likelihoods.chunks_mut(size * n_members)).map(move |(sums, log_likelihoods)| {
            let each = sums.chunks_mut(n_colors).zip(log_likelihoods.chunks_mut(n_members));
            each.map(|(sums, log_likelihoods)| ViewMut { sums, log_likelihoods }).collect()
        })
    }
}
