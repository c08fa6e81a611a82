//! Maps as files.

use crate::support;

use wayfix_color_map::{ColorMap, ColoredShape};

#[test]
fn the_field_reads_and_comes_back_from_both_formats() {
    let field = support::field();
    assert_eq!(field.colors(), ["green", "white", "yellow", "cyan", "pink"]);
    let posts = field.shapes().iter().filter(|shape| matches!(shape, ColoredShape::Post { .. })).count();
    assert_eq!(posts, 6);

    let again: ColorMap = toml::from_str(&toml::to_string(&field).unwrap()).unwrap();
    assert_eq!(again, field);
    let again: ColorMap = serde_json::from_str(&serde_json::to_string(&field).unwrap()).unwrap();
    assert_eq!(again, field);
}

#[test]
fn what_a_map_refuses_a_file_refuses() {
    let error = |text: &str| toml::from_str::<ColorMap>(text).unwrap_err().to_string();
    let triangle = "vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]".replace("0,", "0.0,");
    let polygon = |more: &str| format!("colors = [\"green\"]\n[[polygon]]\n{more}");

    assert!(toml::from_str::<ColorMap>(&polygon(&format!("color = \"green\"\n{triangle}"))).is_ok());
    assert!(
        error(&polygon(&format!("color = \"grene\"\n{triangle}"))).contains("no colour is called \"grene\"")
    );
    assert!(error(&polygon("color = \"green\"\nvertices = [[0.0, 0.0, 0.0]]")).contains("has 1 vertices"));
    assert!(error(&polygon(&format!("colour = \"green\"\n{triangle}"))).contains("unknown field"));
    assert!(
        error(&polygon("color = \"green\"\nvertices = [[0.0, nan, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]"))
            .contains("is NaN")
    );
}
