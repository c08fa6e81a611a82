use rand::Rng;

use crate::random::deviate::uniform;

/// Reflectance in red, green and blue, 255 for all of the light.
pub(super) type Rgb8 = [u8; 3];

/// From hue (turns), saturation and value in [0, 1].
pub(super) fn from_hsv(hue: f64, saturation: f64, value: f64) -> Rgb8 {
    let sector = 6.0 * hue.rem_euclid(1.0);
    [5.0, 3.0, 1.0].map(|shift| {
        let k = (shift + sector) % 6.0;
        let share = k.min(4.0 - k).clamp(0.0, 1.0);
        (255.0 * value * (1.0 - saturation * share)).round() as u8
    })
}

/// A grey.
pub(super) fn grey(value: u8) -> Rgb8 {
    [value; 3]
}

/// The colour, brighter or darker.
pub(super) fn shaded(color: Rgb8, factor: f64) -> Rgb8 {
    color.map(|value| (f64::from(value) * factor).clamp(0.0, 255.0) as u8)
}

/// Any colour about a hue.
pub(super) fn about<R: Rng + ?Sized>(hue: f64, spread: f64, rng: &mut R) -> Rgb8 {
    let hue = hue + uniform(-spread, spread, rng);
    from_hsv(hue, uniform(0.25, 0.95, rng), uniform(0.3, 1.0, rng))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_are_where_they_should_be() {
        assert_eq!(from_hsv(0.0, 1.0, 1.0), [255, 0, 0]);
        assert_eq!(from_hsv(1.0 / 3.0, 1.0, 1.0), [0, 255, 0]);
        assert_eq!(from_hsv(-1.0 / 3.0, 1.0, 1.0), [0, 0, 255]);
        assert_eq!(from_hsv(0.7, 0.0, 0.4), [102; 3]);
    }
}
