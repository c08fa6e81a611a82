//! Tests of the public interface of `wayfix-sensor-log`, in one program: it is linked once.

mod bags;
mod cameras;
mod carmen;
mod carmen_mounts;
mod common;
mod image_folders;
mod image_portability;
mod mcap_damage;
mod mcap_round_trip;
mod mcap_scans;
mod real_data;
mod scan_json;
mod summary;
mod text_encodings;
mod text_formats;
mod victoria_park;
