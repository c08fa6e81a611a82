//! Original format of the records of an MCAP file: a metadata record, because no message has a field for it.
//!
//! It precedes the first message, so that readers find it even in a truncated file.

use std::collections::BTreeMap;

use mcap::records::Metadata;

use super::reading::fields::Fields;
use crate::LogFormat;

const NAME: &str = "wayfix";
const KEY: &str = "origin";

pub(super) fn encode(origin: LogFormat) -> Metadata {
    Metadata { name: NAME.to_owned(), metadata: BTreeMap::from([(KEY.to_owned(), origin.to_string())]) }
}

/// The origin in a metadata record; `None` for other programs' records and formats of later versions.
pub(super) fn decode(body: &[u8]) -> Option<LogFormat> {
    let mut fields = Fields(body);
    if fields.str()? != NAME {
        return None;
    }
    fields.pairs()?.find(|(key, _)| *key == KEY).and_then(|(_, origin)| origin.parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(name: &str, pairs: &[(&str, &str)]) -> Vec<u8> {
        let text = |text: &str| [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat();
        let map: Vec<u8> = pairs.iter().flat_map(|(key, value)| [text(key), text(value)].concat()).collect();
        [text(name), (map.len() as u32).to_le_bytes().to_vec(), map].concat()
    }

    #[test]
    fn the_key_is_found_among_others_and_nothing_is_made_up() {
        assert_eq!(decode(&body("wayfix", &[("a", "b"), ("origin", "utias")])), Some(LogFormat::Utias));
        assert_eq!(decode(&body("wayfix", &[("origin", "a format of the future")])), None);
        assert_eq!(decode(&body("wayfix", &[("a", "origin")])), None);
        assert_eq!(decode(&body("another program", &[("origin", "utias")])), None);
        let whole = body("wayfix", &[("origin", "tum")]);
        for n_bytes in 0..whole.len() {
            assert_eq!(decode(&whole[..n_bytes]), None, "cut after {n_bytes} bytes");
        }
    }
}
