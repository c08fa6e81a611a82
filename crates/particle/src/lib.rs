//! Particle filters: resampling, KLD-sampling, auxiliary and Rao-Blackwellised particles, injection.
