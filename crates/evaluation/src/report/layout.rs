/// A Foxglove layout for the output of `wayfix run SYSTEM`, as JSON for import; `None` for an unknown system.
/// ```
/// let layout = wayfix_evaluation::report::foxglove_layout("slam").expect("a system");
/// assert!(layout.contains("/estimate/pose"));
/// assert!(wayfix_evaluation::report::foxglove_layout("weather").is_none());
/// ```
pub fn foxglove_layout(system: &str) -> Option<&'static str> {
    Some(match system {
        "slam" => include_str!("../../layouts/slam.json"),
        "lines" => include_str!("../../layouts/lines.json"),
        "color" => include_str!("../../layouts/color.json"),
        "views" => include_str!("../../layouts/views.json"),
        "track" => include_str!("../../layouts/track.json"),
        "cml" => include_str!("../../layouts/cml.json"),
        _ => return None,
    })
}
