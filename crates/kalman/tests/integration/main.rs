//! Tests of the public interface of `wayfix-kalman`, in one program: it is linked once.

mod agreement;
mod breakdown;
mod common;
mod consistency;
mod extremes;
mod hostile;
mod iterated;
mod moves_to_the_truth;
mod oracle;
mod smoother;
mod switching;
