//! A number made of data: another number means other data. The same on every machine.

/// FNV-1a.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Fingerprint {
        Fingerprint(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Adds numbers, bit by bit.
    pub fn add_numbers(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.add(&value.to_bits().to_le_bytes()));
    }

    /// The number.
    pub fn number(self) -> u64 {
        self.0
    }
}
