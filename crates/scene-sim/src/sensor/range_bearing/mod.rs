//! A sensor that reads range and bearing of points, with the usual sins, each switched on by its own parameter.
//!
//! | sin | parameter | unit | draws from |
//! | --- | --- | --- | --- |
//! | white noise, growing with range, of any [`Tail`](crate::random::Tail) | `range_noise`, `bearing_sigma_rad`, `tail` | m, rad | `RangeNoise`, `BearingNoise` |
//! | range scale and bias, bearing bias | `range_scale`, `range_bias_m`, `bearing_bias_rad` | 1, m, rad | – |
//! | error that hangs together in time, each target its own | `drift` | m, rad, s | `Drift` |
//! | stamped late | `latency_ms` | ms | – |
//! | gross outliers: range and bearing anywhere in view | `outlier_share` | share of detections | `Outlier` |
//! | whole looks lost | `dropout_share` | share of looks | `Dropout` |
//! | missed detections | `missed_share` | share of detections | `Missed` |
//! | false detections | `clutter` | mean number a look | `Clutter` |
//! | detections under another landmark's identity | `mislabelled_share` | share of detections | `Mislabel` |
//! | no identities at all | `labelled` | – | – |
//! | limited range and field of view, walls | `min_range_m`, `max_range_m`, `field_of_view_rad` | m, rad | – |

mod clutter;
mod detector;
mod drift;
mod params;

pub use clutter::{Clutter, ClutterLabel};
pub use detector::RangeBearingDetector;
pub use drift::DriftParams;
pub use params::{RangeBearingParams, RangeSigma};
