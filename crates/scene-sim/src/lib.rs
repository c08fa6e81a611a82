//! Simulated worlds, robots and sensors with the usual sins; knows no estimator.
