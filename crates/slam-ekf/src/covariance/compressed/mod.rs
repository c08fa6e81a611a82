//! The covariance of a large map, of which only the area around the robot is up to date. [Guivant & Nebot 2001]
//!
//! Let `a` be the robot and the recently observed landmarks, the *area*, and `b` the rest. When the area is chosen, $`P_{aa,0} = L L^T`$: its state is
//! $`L v`$ with standardized, uncorrelated variables $`v`$, the *influences*. The rest of the map is $`B v`$ plus a part that is independent of all
//! observations of the area, with $`B = P_{ba,0} L^{-T}`$. The joint covariance of area and influences
//!
//! ```math
//! \begin{pmatrix} P_{aa} & P_{av} \\ P_{va} & P_{vv} \end{pmatrix}, \quad \text{at first} \quad \begin{pmatrix} L L^T & L \\ L^T & I \end{pmatrix},
//! ```
//!
//! is one more [`JointCovariance`](super::JointCovariance), of twice the size of the area, independent of the size of the map. It is moved, corrected
//! and extended as such. At any time
//!
//! ```math
//! P_{ba} = B P_{va}, \qquad P_{bb} = P_{bb,0} - B (I - P_{vv}) B^T, \qquad x_b = x_{b,0} + B \, δv .
//! ```
//!
//! These are the $`Φ, Ψ, θ`$ of the paper in other coordinates: $`Φ = P_{av} L^{-1}`$, $`Ψ = L^{-T} (I - P_{vv}) L^{-1}`$, $`θ = L^{-T} δv`$.
//! In these nothing is larger than the covariances themselves, however nearly singular $`P_{aa,0}`$ is.
//!
//! From time to time a new area is chosen near the robot. The deferred update of the rest of the map is a product, $`-W W^T`$, which is
//! subtracted a few columns per scan; until then every read access includes it.

mod activate;
mod area;
mod deferred;
mod factor;
mod global_update;
mod influence;
mod passive;
mod remove;
mod restart;
mod schedule;
mod work;

#[cfg(test)]
mod equivalence;

pub(super) use area::CompressedCovariance;
