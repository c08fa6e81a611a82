//! Tests of the command `wayfix`, in one program: it is linked once.

mod bad_input;
mod carmen_logs;
mod common;
mod contract;
mod documented_commands;
mod estimators;
mod layouts;
mod learn_priors;
mod live;
mod observability;
mod recordings;
mod resume;
mod ros_bags;
mod run;
mod victoria_park;
