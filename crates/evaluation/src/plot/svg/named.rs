/// A colour with a name: its value in a picture, and its inks on a light and on a dark page, each at least 4.5 : 1 against the paper.
struct NamedColor {
    names: &'static [&'static str],
    rgb: [u8; 3],
    light: &'static str,
    dark: &'static str,
}

/// White on a light page and black on a dark one are grey, to be seen.
const COLORS: [NamedColor; 12] = [
    NamedColor { names: &["green"], rgb: [40, 140, 60], light: "#1b7f4d", dark: "#63cb95" },
    NamedColor { names: &["white"], rgb: [245, 245, 245], light: "#70757b", dark: "#f4f4f2" },
    NamedColor { names: &["yellow"], rgb: [250, 210, 40], light: "#857000", dark: "#f2d84a" },
    NamedColor { names: &["cyan"], rgb: [60, 190, 235], light: "#0a7a90", dark: "#5fd7ee" },
    NamedColor { names: &["pink", "magenta"], rgb: [245, 120, 180], light: "#c4387f", dark: "#ff8cc4" },
    NamedColor { names: &["orange"], rgb: [245, 130, 30], light: "#b85a00", dark: "#ffa04a" },
    NamedColor { names: &["red"], rgb: [200, 40, 40], light: "#c02a20", dark: "#ff7b72" },
    NamedColor { names: &["blue"], rgb: [50, 70, 200], light: "#1f56c8", dark: "#78aaff" },
    NamedColor { names: &["black"], rgb: [20, 20, 22], light: "#1c1e21", dark: "#84898f" },
    NamedColor { names: &["grey", "gray"], rgb: [140, 144, 150], light: "#62676e", dark: "#9aa0a8" },
    NamedColor { names: &["violet", "purple"], rgb: [140, 80, 200], light: "#6a3fc0", dark: "#b79cff" },
    NamedColor { names: &["brown"], rgb: [140, 90, 40], light: "#80501e", dark: "#c99a66" },
];

/// Number of named colours.
pub(super) const N_NAMED: u8 = COLORS.len() as u8;

/// Number of the colour that is called `name`.
pub(super) fn index_of(name: &str) -> Option<u8> {
    let is_called = |color: &NamedColor| color.names.iter().any(|known| known.eq_ignore_ascii_case(name));
    COLORS.iter().position(is_called).map(|index| index as u8)
}

/// The quoted value of an attribute: the ink of colour number `index`, whatever page shows it.
pub(super) fn attribute(index: u8) -> String {
    format!("\"var(--{})\"", COLORS[usize::from(index % N_NAMED)].names[0])
}

/// Custom properties of the named colours, for a light or a dark page.
pub(crate) fn named_palette(is_dark: bool) -> String {
    let property = |color: &NamedColor| {
        format!(";--{}:{}", color.names[0], if is_dark { color.dark } else { color.light })
    };
    COLORS.iter().map(property).collect()
}

/// The colour with a common English name; `None` for other names.
/// ```
/// use wayfix_evaluation::plot::named_color;
/// assert_eq!(named_color("White"), Some([245, 245, 245]));
/// assert_eq!(named_color("goal"), None);
/// ```
pub fn named_color(name: &str) -> Option<[u8; 3]> {
    index_of(name).map(|index| COLORS[usize::from(index)].rgb)
}
