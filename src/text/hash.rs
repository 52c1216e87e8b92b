//! FNV-1a with 128 bits: the same on every machine and in every version of the program.

/// A hash being formed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hash(u128);

impl Default for Hash {
    fn default() -> Self {
        Hash(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Hash {
    /// The hash of a text.
    pub fn of(text: &str) -> Hash {
        Hash::default().and(text.as_bytes())
    }

    /// The hash with more bytes appended.
    #[must_use]
    pub fn and(self, bytes: &[u8]) -> Hash {
        Hash(bytes.iter().fold(self.0, |hash, byte| {
            (hash ^ u128::from(*byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
        }))
    }

    /// 32 hexadecimal digits.
    pub fn long(self) -> String {
        format!("{:032x}", self.0)
    }

    /// Its halves folded into 16 hexadecimal digits.
    pub fn short(self) -> String {
        let folded = (self.0 >> 64) ^ self.0;
        format!("{:016x}", folded & u128::from(u64::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::Hash;

    #[test]
    fn the_published_values() {
        // http://www.isthe.com/chongo/tech/comp/fnv: the offset basis, and "a" and "foobar" of the test vectors
        assert_eq!(Hash::default().long(), "6c62272e07bb014262b821756295c58d");
        assert_eq!(Hash::of("a").long(), "d228cb696f1a8caf78912b704e4a8964");
        assert_eq!(Hash::of("foobar").long(), "343e1662793c64bf6f0d3597ba446f18");
        assert_eq!(Hash::of("foo").and(b"bar"), Hash::of("foobar"));
        assert_eq!(Hash::of("a").short().len(), 16);
    }
}
