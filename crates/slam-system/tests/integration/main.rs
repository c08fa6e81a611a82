//! Tests of the public interface of `wayfix-slam-system`, in one program: it is linked once.

mod contradictions;
mod external_sensors;
mod odometry_faults;
mod overview;
mod point_params;
mod search_bands;
mod slam_system;
mod smoother;
mod wall_batch;
mod walls_resume;
