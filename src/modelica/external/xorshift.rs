//! The generator xorshift1024* ([Vigna 2016](gapilib_base::bibliography#vigna-2016)), and the one of a
//! simulation.

/// The hidden state of a simulation: what `initializeImpureRandom` made for `impureRandom`.
#[derive(Debug, Clone, Default)]
pub struct Random(pub(super) Option<(Xorshift1024, f64)>);

/// Sixteen words and the position of the current one.
#[derive(Debug, Clone)]
pub(super) struct Xorshift1024 {
    pub(super) words: [u64; 16],
    pub(super) at: usize,
}

impl Xorshift1024 {
    pub(super) fn next(&mut self) -> u64 {
        let mut a = self.words[self.at];
        self.at = (self.at + 1) % 16;
        let mut b = self.words[self.at];
        b ^= b << 31;
        b ^= b >> 11;
        a ^= a >> 30;
        self.words[self.at] = a ^ b;
        self.words[self.at].wrapping_mul(1_181_783_497_276_652_981)
    }
}
