//! Tests of the public interface of `wayfix-color-model`, in one program: it is linked once.

mod hostile;
mod lighting_filter;
mod localizer;
mod look_up_table;
mod prior;
mod span_likelihood;
mod support;
mod switched_light;
mod two_cameras;
