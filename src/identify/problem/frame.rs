//! Payloads in files: each with its length and a checksum, so that a damaged or unfinished one is
//! noticed.

/// Bytes of the length and of the checksum (CRC-32), both little-endian.
const LENGTH: usize = 8;
const CHECKSUM: usize = 4;

/// A payload with its length and its checksum before it.
pub fn frame(payload: &[u8]) -> Vec<u8> {
    let mut bytes = (payload.len() as u64).to_le_bytes().to_vec();
    bytes.extend(checksum(payload).to_le_bytes());
    bytes.extend(payload);
    bytes
}

/// The first frame's payload and what follows it; `None` where it is damaged or not finished.
pub fn first_frame(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_at_checked(LENGTH)?;
    let (sum, rest) = rest.split_at_checked(CHECKSUM)?;
    let length = usize::try_from(u64::from_le_bytes(length.try_into().ok()?)).ok()?;
    let (payload, rest) = rest.split_at_checked(length)?;
    let sum = u32::from_le_bytes(sum.try_into().ok()?);
    (checksum(payload) == sum).then_some((payload, rest))
}

fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum()
}
