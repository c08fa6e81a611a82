use super::SavedMapError;

const MAGIC: [u8; 8] = *b"WAYFIXSM";
/// Counts up with every change of what the payload holds.
const VERSION: u32 = 5;
const HEADER: usize = 24;

/// The payload after a header with its kind and its checksum.
pub(super) fn seal(payload: &[u8]) -> Vec<u8> {
    let mut sealed = Vec::with_capacity(HEADER + payload.len());
    sealed.extend(MAGIC);
    sealed.extend(VERSION.to_le_bytes());
    sealed.extend((payload.len() as u64).to_le_bytes());
    sealed.extend(checksum(&sealed, payload).to_le_bytes());
    sealed.extend(payload);
    sealed
}

/// The payload of what [`seal`] made.
pub(super) fn open(sealed: &[u8]) -> Result<&[u8], SavedMapError> {
    if !sealed.starts_with(&MAGIC) {
        return Err(SavedMapError::NotASavedMap);
    }
    let cut_short = SavedMapError::Length { expected: HEADER as u64, found: sealed.len() as u64 };
    let Some((header, payload)) = sealed.split_at_checked(HEADER) else {
        return Err(cut_short);
    };
    let found = number(&header[8..12]) as u32;
    if found != VERSION {
        return Err(SavedMapError::Version { found, known: VERSION });
    }
    let (expected, found) = (number(&header[12..20]), payload.len() as u64);
    if expected != found {
        return Err(SavedMapError::Length { expected, found });
    }
    let (expected, found) = (number(&header[20..]) as u32, checksum(&header[..20], payload));
    if expected != found {
        return Err(SavedMapError::Checksum { expected, found });
    }
    Ok(payload)
}

/// Over version and length as well: a bit error that gives another known version must be detected.
fn checksum(header: &[u8], payload: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&header[MAGIC.len()..]);
    hasher.update(payload);
    hasher.finalize()
}

/// Little endian, of up to eight bytes.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |number, byte| (number << 8) | u64::from(*byte))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAYLOAD: &[u8] = b"a map of the ground floor";

    #[test]
    fn what_was_sealed_comes_out_again() {
        for payload in [PAYLOAD, &[]] {
            assert_eq!(open(&seal(payload)).unwrap(), payload);
        }
    }

    #[test]
    fn the_checksum_is_the_one_of_everybody() {
        // CRC-32/ISO-HDLC of "123456789" is cbf43926 in every catalogue of checksums.
        assert_eq!(checksum(&[&MAGIC[..], b"12345"].concat(), b"6789"), 0xcbf4_3926);
    }

    #[test]
    fn every_length_but_the_right_one_is_refused() {
        let sealed = seal(PAYLOAD);
        for length in 0..sealed.len() {
            let error = open(&sealed[..length]).unwrap_err();
            let by_length = matches!(error, SavedMapError::Length { .. });
            assert!(
                by_length || (length < 8 && matches!(error, SavedMapError::NotASavedMap)),
                "{length}: {error}"
            );
        }
        let longer = [&sealed[..], &[0]].concat();
        assert!(matches!(open(&longer), Err(SavedMapError::Length { .. })));
    }

    #[test]
    fn every_flipped_bit_is_found_and_another_version_is_named() {
        let sealed = seal(PAYLOAD);
        for bit in 0..8 * sealed.len() {
            let mut flipped = sealed.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(open(&flipped).is_err(), "bit {bit}");
        }
        let mut newer = sealed;
        newer[8] = 6;
        assert!(matches!(open(&newer), Err(SavedMapError::Version { found: 6, known: 5 })));
    }
}
