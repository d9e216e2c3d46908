//! The identity of a compiled source: its name and a hash.

use sdfc_diagnostics::{FileId, Sources};

/// Name and hash of the sources that a scene was compiled from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SourceId {
    /// File name without its folder: the same scene gives the same bytes wherever it lies.
    pub(crate) name: String,
    /// FNV-1a over the sources of the scene, the library and all imports.
    pub(crate) hash: u64,
}

impl SourceId {
    /// Returns the identity of `scene` and all other files in `sources`.
    pub(crate) fn new(sources: &Sources, scene: FileId) -> Self {
        let name = sources.name(scene);
        let name = name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned();
        let texts = (0..sources.len()).map(|file| sources.text(FileId(file as u32)));
        Self { name, hash: texts.fold(FNV_OFFSET, fnv) }
    }
}

const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0000_0100_0000_01b3;

/// Extends a 64-bit FNV-1a hash by a text and a final 0.
fn fnv(hash: u64, text: &str) -> u64 {
    let bytes = text.bytes().chain([0]);
    bytes.fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(FNV_PRIME))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv() {
        // Published vector of FNV-1a: "foobar" gives 85944171f73967e8.
        let bytes = "foobar".bytes();
        let hash = bytes.fold(FNV_OFFSET, |h, b| (h ^ u64::from(b)).wrapping_mul(FNV_PRIME));
        assert_eq!(hash, 0x8594_4171_f739_67e8);
        assert_ne!(fnv(fnv(FNV_OFFSET, "a"), "b"), fnv(fnv(FNV_OFFSET, "ab"), ""));
    }
}
