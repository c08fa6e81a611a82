use crate::{
    ColorModelError, LightingBank, PixelLikelihoodParams, PixelSumDensity,
    classify::{NO_COLOR, most_probable},
};

/// A particle's knowledge of the light: a bank of filters, and its colours' densities ready for weighing.
///
/// Particles with a common ancestor share it until one of them sees something.
#[derive(Clone, Debug)]
pub(crate) struct Light {
    pub(crate) bank: LightingBank,
    /// Of every colour under every member, member by member.
    densities: Vec<PixelSumDensity>,
    n_colors: usize,
}

impl Light {
    pub(crate) fn new(bank: LightingBank, pixels: &PixelLikelihoodParams) -> Result<Self, ColorModelError> {
        let n_colors = bank.n_colors();
        let densities = bank
            .members()
            .iter()
            .flat_map(|filter| pixels.uneven(filter.colors()))
            .map(|density| PixelSumDensity::new(&density))
            .collect::<Result<_, _>>()?;
        Ok(Self { bank, densities, n_colors })
    }

    /// The colour that explains a pixel best under one member, as a number; 255 where the background, of this log-density, does better.
    pub(crate) fn label(&self, member: usize, pixel: [u8; 3], background: f64) -> u8 {
        most_probable(self.member(member), pixel, background).map_or(NO_COLOR, |color| color.0)
    }

    /// Densities of the colours under one member.
    pub(crate) fn member(&self, member: usize) -> &[PixelSumDensity] {
        &self.densities[member * self.n_colors..][..self.n_colors]
    }
}
