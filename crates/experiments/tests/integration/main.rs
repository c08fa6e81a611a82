//! Tests of the public interface of `wayfix-experiments`, in one program: it is linked once.

mod common;
mod composed_scenes;
mod corridor;
mod determinism;
mod fixtures;
mod interrupted;
mod labelled;
mod shards;
mod track_films;
mod venues;
