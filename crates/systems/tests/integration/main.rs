//! Tests of the public interface of `wayfix-systems`, in one program: it is linked once.

mod cml_external;
mod color;
mod external_sensors;
mod odometry_faults;
mod pipeline;
mod point_params;
mod slam_system;
mod smoother;
mod stop;
mod walls_resume;
