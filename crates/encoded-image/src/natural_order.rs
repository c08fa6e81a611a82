/// Key that sorts names of files by the numbers in them; the extension counts last.
///
/// `frame9` comes before `frame10`. A dot between two digits is a decimal point: `1.05` comes before `1.1`, and `1700000000.123456.png` is a
/// time. Three numbers with dots between them are three whole numbers. A dash is a minus at the beginning of the name or after a character other
/// than a letter or digit: `-2`, `t_-2`; in `img-1` it separates. The first part of the key is equal for names that differ in leading zeros or the
/// extension only.
/// ```
/// use wayfix_encoded_image::natural_key;
/// let mut names = ["frame10.png", "frame9.png", "frame1.5.png"];
/// names.sort_by_key(|name| natural_key(name));
/// assert_eq!(names, ["frame1.5.png", "frame9.png", "frame10.png"]);
/// assert_eq!(natural_key("01.png").0, natural_key("1.jpg").0);
/// ```
pub fn natural_key(name: &str) -> (Vec<u8>, String) {
    (stem_key(stem(name)), name.to_owned())
}

fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// Text is unchanged. A number becomes its digit count, its digits and its decimals; a negative one has each byte inverted.
fn stem_key(stem: &str) -> Vec<u8> {
    let bytes = stem.as_bytes();
    let n_digits =
        |from: usize| bytes[from.min(bytes.len())..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let is_dot = |at: usize| bytes.get(at) == Some(&b'.');
    let mut key = Vec::with_capacity(bytes.len() + 8);
    let mut at = 0;
    let mut is_negative = false;
    while let Some(&byte) = bytes.get(at) {
        let n_whole = n_digits(at);
        if n_whole == 0 {
            let follows_a_word = at > 0 && bytes[at - 1].is_ascii_alphanumeric();
            is_negative = byte == b'-' && !follows_a_word && n_digits(at + 1) > 0;
            if !is_negative {
                key.push(byte);
            }
            at += 1;
            continue;
        }
        let whole = &bytes[at..at + n_whole];
        let after_dot = at + n_whole + 1;
        let n_decimals = if is_dot(after_dot - 1) { n_digits(after_dot) } else { 0 };
        // `1.2.3` is not a decimal number.
        let is_first = at < 2 || !is_dot(at - 1) || !bytes[at - 2].is_ascii_digit();
        let is_last = !is_dot(after_dot + n_decimals) || n_digits(after_dot + n_decimals + 1) == 0;
        let decimals =
            if is_first && is_last { &bytes[after_dot.min(bytes.len())..][..n_decimals] } else { &[] };
        at += n_whole + if decimals.is_empty() { 0 } else { 1 + n_decimals };

        let n_zeros = whole.iter().take_while(|digit| **digit == b'0').count();
        let digits = &whole[n_zeros..];
        let n_kept = decimals.iter().rposition(|digit| *digit != b'0').map_or(0, |last| last + 1);
        let mut number = vec![digits.len().min(255) as u8];
        number.extend(digits.iter().chain(&decimals[..n_kept]));
        number.push(0);
        if is_negative && number.iter().any(|byte| *byte != 0) {
            key.push(b'-');
            key.extend(number.iter().map(|byte| !byte));
        } else {
            key.push(b'0');
            key.extend(number);
        }
        is_negative = false;
    }
    key
}

#[cfg(test)]
mod tests {
    use super::natural_key;

    #[test]
    fn numbers_count_by_value_and_names_by_their_letters() {
        let sorted = [
            "a.png",
            "frame0.png",
            "frame9.png",
            "frame10.png",
            "frame010b.png",
            "frame0100.png",
            "left.png",
        ];
        let mut names = sorted;
        names.reverse();
        names.sort_by_key(|name| natural_key(name));
        assert_eq!(names, sorted);
    }

    fn check_order(sorted: &[&str]) {
        let mut names = sorted.to_vec();
        names.reverse();
        names.sort_by_key(|name| natural_key(name));
        assert_eq!(names, sorted);
    }

    #[test]
    fn stamps_as_names_sort_by_their_value() {
        check_order(&["1.0.png", "1.05.png", "1.1.png", "1.15.png", "2.png", "10.5.png"]);
        check_order(&["1699999999.9.jpg", "1700000000.05.jpg", "1700000000.123456.jpg", "1700000000.2.jpg"]);
        check_order(&["rgb_9.95.png", "rgb_10.05.png", "rgb_10.1.png"]);
        check_order(&["v1.2.9.png", "v1.2.10.png", "v1.10.1.png"]);
    }

    #[test]
    fn negative_numbers_come_first_and_a_dash_separates() {
        check_order(&["-10.png", "-2.png", "-1.1.png", "-1.05.png", "-1.png", "0.png", "1.png"]);
        check_order(&["t_-2.png", "t_-1.png", "t_0.png"]);
        check_order(&["img-1.png", "img-2.png", "img-10.png"]);
        check_order(&["2024-01-02.png", "2024-01-10.png"]);
    }
}
