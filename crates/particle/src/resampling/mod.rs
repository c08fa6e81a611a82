//! Which particles have how many children: four unbiased schemes behind one trait.

mod multinomial;
mod resampler;
mod residual;
mod spread;
mod stratified;
mod systematic;
mod walk;

pub use multinomial::Multinomial;
pub use resampler::Resampler;
pub use residual::Residual;
pub use stratified::Stratified;
pub use systematic::Systematic;
