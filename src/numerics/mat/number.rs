//! Numbers as bytes.

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

impl ByteOrder {
    pub(super) fn u32(self, bytes: [u8; 4]) -> u32 {
        match self {
            ByteOrder::Little => u32::from_le_bytes(bytes),
            ByteOrder::Big => u32::from_be_bytes(bytes),
        }
    }
}

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// IEEE 754 binary64.
    F64,
    /// IEEE 754 binary32.
    F32,
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 64 bits.
    I64,
    /// Unsigned, 64 bits.
    U64,
}

macro_rules! decode_as {
    ($type:ty, $bytes:expr, $order:expr) => {{
        let (chunks, _) = $bytes.as_chunks::<{ size_of::<$type>() }>();
        match $order {
            ByteOrder::Little => chunks.iter().map(|c| <$type>::from_le_bytes(*c) as f64).collect(),
            ByteOrder::Big => chunks.iter().map(|c| <$type>::from_be_bytes(*c) as f64).collect(),
        }
    }};
}

impl Storage {
    /// Bytes of one number.
    pub(super) fn size(self) -> usize {
        match self {
            Storage::I8 | Storage::U8 => 1,
            Storage::I16 | Storage::U16 => 2,
            Storage::F32 | Storage::I32 | Storage::U32 => 4,
            Storage::F64 | Storage::I64 | Storage::U64 => 8,
        }
    }

    /// All numbers in `bytes`; 64-bit integers beyond 2⁵³ are rounded.
    pub(super) fn decode(self, bytes: &[u8], order: ByteOrder) -> Vec<f64> {
        match self {
            Storage::F64 => decode_as!(f64, bytes, order),
            Storage::F32 => decode_as!(f32, bytes, order),
            Storage::I8 => decode_as!(i8, bytes, order),
            Storage::U8 => decode_as!(u8, bytes, order),
            Storage::I16 => decode_as!(i16, bytes, order),
            Storage::U16 => decode_as!(u16, bytes, order),
            Storage::I32 => decode_as!(i32, bytes, order),
            Storage::U32 => decode_as!(u32, bytes, order),
            Storage::I64 => decode_as!(i64, bytes, order),
            Storage::U64 => decode_as!(u64, bytes, order),
        }
    }

    /// Appends a number in little-endian order. Rounds to what the storage can hold.
    pub(super) fn encode(self, value: f64, out: &mut Vec<u8>) {
        match self {
            Storage::F64 => out.extend(value.to_le_bytes()),
            Storage::F32 => out.extend((value as f32).to_le_bytes()),
            Storage::I8 => out.extend((value as i8).to_le_bytes()),
            Storage::U8 => out.extend((value as u8).to_le_bytes()),
            Storage::I16 => out.extend((value as i16).to_le_bytes()),
            Storage::U16 => out.extend((value as u16).to_le_bytes()),
            Storage::I32 => out.extend((value as i32).to_le_bytes()),
            Storage::U32 => out.extend((value as u32).to_le_bytes()),
            Storage::I64 => out.extend((value as i64).to_le_bytes()),
            Storage::U64 => out.extend((value as u64).to_le_bytes()),
        }
    }
}
