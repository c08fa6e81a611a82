//! A consumer of spans of one's own: the box around every colour in view, without ever making an image.
//!
//! `cargo run -p wayfix-color-map --example 02_custom_span_consumer`

use std::{collections::BTreeMap, sync::Arc};

use wayfix_color_map::{ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera, PixelSpan, PostBand};
use wayfix_estimation_traits::{LieGroup, Pose3};

/// Columns and rows that a colour reaches, ends excluded.
#[derive(Debug, PartialEq)]
struct Bounds {
    columns: std::ops::Range<u16>,
    rows: std::ops::Range<u16>,
}

impl Bounds {
    fn of(span: PixelSpan) -> Self {
        Self { columns: span.start..span.end, rows: span.row..span.row + 1 }
    }

    fn add(&mut self, span: PixelSpan) {
        self.columns = self.columns.start.min(span.start)..self.columns.end.max(span.end);
        self.rows = self.rows.start.min(span.row)..self.rows.end.max(span.row + 1);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (pink, cyan) = (ColorId(0), ColorId(1));
    // A beacon two metres ahead; its bands meet at the height of the eye.
    let bands =
        vec![PostBand { color: pink, from: -0.1, to: 0.0 }, PostBand { color: cyan, from: 0.0, to: 0.1 }];
    let beacon = ColoredShape::Post { x: 2.0, y: 0.0, radius: 0.05, bands };
    let map = ColorMap::new(vec!["pink".into(), "cyan".into()], vec![beacon])?;
    let camera = PinholeCamera::new(208, 160, 192.0, 192.0, 104.0, 80.0)?;

    let mut bounds: BTreeMap<ColorId, Bounds> = BTreeMap::new();
    MapRenderer::new(Arc::new(map), camera).spans(&Pose3::identity(), &mut |span| {
        bounds.entry(span.color).and_modify(|bounds| bounds.add(span)).or_insert_with(|| Bounds::of(span));
    })?;
    println!("{bounds:?}");

    // 192 pixels / 2 m * 0.1 m = 9.6 pixels wide and, from its nearest side at 1.95 m, 9.8 high.
    assert_eq!(bounds[&cyan], Bounds { columns: 99..109, rows: 70..80 });
    assert_eq!(bounds[&pink], Bounds { columns: 99..109, rows: 80..90 });
    Ok(())
}
