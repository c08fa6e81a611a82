//! Which particles have how many children: four unbiased schemes behind one trait.

mod multinomial;
mod resampler;
mod residual;
mod spread;
mod stratified;
mod systematic;
mod walk;

pub use multinomial::MultinomialResampler;
pub use resampler::Resampler;
pub use residual::ResidualResampler;
pub use stratified::StratifiedResampler;
pub use systematic::SystematicResampler;
