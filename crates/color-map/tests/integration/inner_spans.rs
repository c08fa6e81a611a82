//! Leaving out the pixels near an edge, against its definition.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_color_map::{ColorId, LabelImage, MapRenderer, PinholeCamera};

use crate::support::{field, random_pose};

/// The label of a pixel, if all pixels of the image within `margin` have it too.
fn inner(labels: &LabelImage, column: u32, row: u32, margin: u32) -> Option<ColorId> {
    let label = labels.get(column, row);
    let rows = row.saturating_sub(margin)..(row + margin + 1).min(labels.height());
    let columns = column.saturating_sub(margin)..(column + margin + 1).min(labels.width());
    let same = rows.into_iter().all(|r| columns.clone().all(|c| labels.get(c, r) == label));
    if same { label } else { None }
}

#[test]
fn exactly_the_pixels_away_from_edges_are_left() {
    let mut rng = ChaCha8Rng::seed_from_u64(43);
    let map = Arc::new(field());
    let mut n_left = [0_usize; 2];
    for _ in 0..60 {
        // Widths on both sides of a word's 64 bits; margins beyond the image as well.
        let (width, height) = (rng.random_range(1..140), rng.random_range(1..60));
        let camera = PinholeCamera::from_field_of_view(width, height, 1.0, 0.8).unwrap();
        let mut renderer = MapRenderer::new(Arc::clone(&map), camera);
        let pose = random_pose(&mut rng, 2.0);
        let labels = renderer.labels(&pose).unwrap();
        for margin in [0, 1, 2, 5, 70, u16::MAX] {
            let mut got = vec![None; labels.pixels().len()];
            renderer
                .inner_spans(&pose, margin, &mut |span| {
                    for column in span.start..span.end {
                        got[usize::from(span.row) * width as usize + usize::from(column)] = Some(span.color);
                    }
                })
                .unwrap();
            for (i, &got) in got.iter().enumerate() {
                let (column, row) = (i as u32 % width, i as u32 / width);
                assert_eq!(
                    got,
                    inner(&labels, column, row, u32::from(margin)),
                    "{width} {column} {row} {margin}"
                );
                n_left[usize::from(margin > 0)] += usize::from(got.is_some());
            }
        }
    }
    // There was something to leave out and something to leave.
    assert!(n_left[1] > 1000 && n_left[0] > 1000, "{n_left:?}");
}
