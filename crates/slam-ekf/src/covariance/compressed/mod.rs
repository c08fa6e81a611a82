//! The covariance of a large map of which only the area around the robot is kept up to date. [Guivant & Nebot 2001, section III]
//!
//! Let `a` be the robot and the landmarks that were seen of late, the *area*, and `b` the rest. As long as only `a` is observed, everything that
//! happens to `b` goes through the cross covariance at the time when the area was chosen, $`P_{ba,0}`$:
//!
//! ```math
//! P_{ab} = Φ P_{ab,0}, \qquad P_{bb} = P_{bb,0} - P_{ba,0} Ψ P_{ab,0}, \qquad x_b = x_{b,0} + P_{ba,0} θ
//! ```
//!
//! $`Φ, Ψ, θ`$ start as identity, zero and zero. They need no algebra of their own: bordered with *influences* $`v`$, one for each state that the area
//! began with,
//!
//! ```math
//! \begin{pmatrix} P_{aa} & Φ \\ Φ^T & -Ψ \end{pmatrix}
//! ```
//!
//! is moved, corrected and extended by the very formulas of a covariance, and the step of the mean at $`v`$ adds up to $`θ`$. So the area is one more
//! [`JointCovariance`](super::JointCovariance), of twice the size of the area and not of the size of the map. A landmark that comes into the area is
//! $`x_j = P_{ja,0}\, v + …`$ and takes its covariances from the influences.
//!
//! Now and then the area starts anew with what is near then. What that owes to the rest of the map is a square, $`-W W^T`$, which is
//! subtracted a few columns a look; until then it is accounted for whenever something is read.

mod activate;
mod area;
mod backlog;
mod factor;
mod passive;
mod remove;
mod restart;
mod schedule;
mod work;

#[cfg(test)]
mod equivalence;

pub(super) use area::CompressedCovariance;
