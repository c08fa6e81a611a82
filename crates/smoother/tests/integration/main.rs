//! Tests of the public interface of `wayfix-smoother`, in one program: it is linked once.

mod common;
mod dense_oracle;
mod edge_by_edge;
mod g2o;
mod hostile;
mod laws;
mod marginalize;
mod pose_graph_data;
