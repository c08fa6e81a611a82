//! Tests of the public interface of `wayfix-gaussian-core`, in one program: it is linked once.

mod hierarchical;
mod hierarchical_oracle;
mod models_and_scalars;
mod numpy_oracle;
mod properties;
