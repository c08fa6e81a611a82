//! Prints what a robot's camera sees of one end of a field, a letter a pixel.
//!
//! `cargo run -p wayfix-color-map --example 01_what_a_camera_sees`

use std::sync::Arc;

use wayfix_color_map::{
    ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera, PostBand,
    nalgebra::{UnitQuaternion, Vector3},
};
use wayfix_estimation_traits::Pose3;

const COLORS: [&str; 4] = ["green", "white", "yellow", "pink"];
const LETTERS: [char; 4] = ['.', 'w', 'Y', 'P'];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let camera = PinholeCamera::from_field_of_view(96, 40, 57_f64.to_radians(), 45_f64.to_radians())?;
    let mut renderer = MapRenderer::new(Arc::new(one_end()?), camera);

    // In the middle of the field, 20 cm up, looking 10° to the left of the goal and 5° down.
    let (pitch, yaw) = (5_f64.to_radians(), 10_f64.to_radians());
    let pose = Pose3 {
        translation: Vector3::new(0.0, 0.0, 0.2),
        rotation: UnitQuaternion::from_euler_angles(0.0, pitch, yaw),
    };
    let labels = renderer.labels(&pose)?;
    for row in 0..labels.height() {
        let letter = |column| labels.get(column, row).map_or(' ', |color| LETTERS[color.index()]);
        println!("{}", (0..labels.width()).map(letter).collect::<String>());
    }
    for (i, name) in COLORS.iter().enumerate() {
        println!("{name}: {} pixels", labels.count(ColorId(i as u8)));
    }

    // The goal's back, 0.6 m by 0.3 m, is 2.4 m away: 88 / 2.4 * 0.6 = 22 columns by 48 / 2.4 * 0.3 = 6 rows. Its sides and the lower half of
    // the beacon come on top, and are less than that again.
    let yellow = labels.count(ColorId(2));
    assert!((132..2 * 132).contains(&yellow), "{yellow} yellow pixels");
    // The lower half of the image is carpet but for what stands on it.
    let green = labels.count(ColorId(0));
    assert!((96 * 19..96 * 20).contains(&green), "{green} green pixels");
    Ok(())
}

fn one_end() -> Result<ColorMap, wayfix_color_map::ColorMapError> {
    let [green, white, yellow, pink] = [0, 1, 2, 3].map(ColorId);
    let floor = |color, x: [f64; 2], y: [f64; 2]| ColoredShape::Polygon {
        color,
        vertices: [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| Vector3::new(x[i], y[j], 0.0)).to_vec(),
    };
    let panel = |color, from: [f64; 2], to: [f64; 2], height| ColoredShape::Polygon {
        color,
        vertices: vec![
            Vector3::new(from[0], from[1], 0.0),
            Vector3::new(to[0], to[1], 0.0),
            Vector3::new(to[0], to[1], height),
            Vector3::new(from[0], from[1], height),
        ],
    };
    let bands =
        vec![PostBand { color: yellow, from: 0.2, to: 0.3 }, PostBand { color: pink, from: 0.3, to: 0.4 }];
    let shapes = vec![
        floor(green, [-2.4, 2.4], [-1.35, 1.35]),
        floor(white, [2.05, 2.1], [-0.3, 0.3]), // later, so on top
        panel(yellow, [2.4, -0.3], [2.4, 0.3], 0.3),
        panel(yellow, [2.1, -0.3], [2.4, -0.3], 0.3),
        panel(yellow, [2.1, 0.3], [2.4, 0.3], 0.3),
        panel(white, [2.1, 0.3], [2.1, 1.35], 0.1),
        panel(white, [2.1, -1.35], [2.1, -0.3], 0.1),
        panel(white, [-2.1, 1.35], [2.1, 1.35], 0.1),
        ColoredShape::Post { x: 2.1, y: 1.5, radius: 0.05, bands },
    ];
    ColorMap::new(COLORS.map(String::from).to_vec(), shapes)
}
