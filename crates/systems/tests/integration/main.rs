//! Tests of the public interface of `wayfix-systems`, in one program: it is linked once.

mod cml_external;
mod color;
mod odometry;
mod stop;
