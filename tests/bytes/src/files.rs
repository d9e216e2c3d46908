//! Files that a scene imports, in memory.

use std::collections::BTreeMap;

use sdfc::Resolver;

/// Files by their path.
#[derive(Default)]
pub struct Files(pub BTreeMap<String, Vec<u8>>);

impl Resolver for Files {
    fn read(&self, path: &str) -> Result<String, String> {
        String::from_utf8(self.read_bytes(path)?).map_err(|e| e.to_string())
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.0.get(path).cloned().ok_or_else(|| "no such file".to_owned())
    }
}
