//! A sensor that measures range and bearing of points. Each error source has its own parameter:
//!
//! | error source | parameter | unit | draws from |
//! | --- | --- | --- | --- |
//! | white noise, growing with range, of any [`NoiseShape`](crate::random::NoiseShape) | `range_noise`, `bearing_sigma_rad`, `noise_shape` | m, rad | `RangeNoise`, `BearingNoise` |
//! | range scale and bias, bearing bias | `range_scale`, `range_bias_m`, `bearing_bias_rad` | 1, m, rad | – |
//! | time-correlated error, separate for each target | `drift` | m, rad, s | `Drift` |
//! | stamped late | `stamp_delay_ms` | ms | – |
//! | gross outliers: range and bearing anywhere in view | `outlier_share` | share of detections | `Outlier` |
//! | whole scans lost | `scan_dropout_share` | share of scans | `Dropout` |
//! | missed detections | `missed_target_share` | share of detections | `Missed` |
//! | false detections | `clutter` | mean number per scan | `Clutter` |
//! | detections under another landmark's identity | `mislabelled_share` | share of detections | `Mislabel` |
//! | no identities at all | `labelled` | – | – |
//! | limited range and field of view, walls | `min_range_m`, `max_range_m`, `field_of_view_rad` | m, rad | – |

mod clutter;
mod detector;
mod drift;
mod params;

pub use clutter::{Clutter, ClutterIdentity};
pub use detector::RangeBearingDetector;
pub use drift::CorrelatedErrorParams;
pub use params::{RangeBearingParams, RangeDependentSigma};
