//! Tests of the public interface of `wayfix-slam-ekf`, in one program: it is linked once.

mod anchors;
mod association;
mod common;
mod compressed;
mod consistency;
mod external;
mod hostile;
mod laws;
mod map;
mod observability;
mod oracle;
mod retirement;
mod snapshot;
mod walls;
mod wrapped_sensors;
