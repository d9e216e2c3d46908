//! Loads `.sdf` files.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use bevy::asset::io::Reader;
use bevy::asset::{AssetLoader, LoadContext};
use bevy::reflect::TypePath;
use sdfc::Resolver;

use crate::scene::{SdfcError, SdfcScene};

/// Loads scenes from `.sdf` files, with the files that they import. The error of a scene that does
/// not compile shows each fault with its source line.
#[derive(Clone, Copy, Debug, Default, TypePath)]
pub struct SdfcLoader;

/// The files that were read so far, as bytes or as the reason why they cannot be read.
type Files = BTreeMap<String, Result<Vec<u8>, String>>;

/// Knows some files, and notes which others a scene asks for.
struct Known<'f> {
    files: &'f Files,
    missing: RefCell<BTreeSet<String>>,
}

impl Resolver for Known<'_> {
    fn read(&self, path: &str) -> Result<String, String> {
        String::from_utf8(self.read_bytes(path)?).map_err(|_| "not UTF-8 text".to_owned())
    }

    fn read_bytes(&self, path: &str) -> Result<Vec<u8>, String> {
        self.files.get(path).cloned().unwrap_or_else(|| {
            self.missing.borrow_mut().insert(path.to_owned());
            Err("not read yet".to_owned())
        })
    }
}

/// Compiles a scene with the files that were read. Returns the paths of files that it asked for in
/// vain.
fn compile(name: &str, text: &str, files: &Files) -> (Result<SdfcScene, SdfcError>, Vec<String>) {
    let known = Known { files, missing: RefCell::default() };
    let compiled = SdfcScene::compile_with_files(name, text, &known);
    (compiled, known.missing.into_inner().into_iter().collect())
}

impl AssetLoader for SdfcLoader {
    type Asset = SdfcScene;
    type Settings = ();
    type Error = SdfcError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        (): &(),
        context: &mut LoadContext<'_>,
    ) -> Result<SdfcScene, SdfcError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes)?;
        let path = context.path().clone();
        let name = path.to_string();
        let folder = path.parent();
        // Files are read asynchronously, but the compiler asks for them while it compiles. So it
        // compiles again with those that it missed, until it misses none.
        let mut files = Files::new();
        loop {
            let (compiled, missing) = compile(&name, &text, &files);
            if missing.is_empty() {
                return compiled;
            }
            for wanted in missing {
                let read = match folder.as_ref().map(|folder| folder.resolve_str(&wanted)) {
                    Some(Ok(path)) => {
                        context.read_asset_bytes(path).await.map_err(|error| error.to_string())
                    }
                    Some(Err(error)) => Err(error.to_string()),
                    None => Err("the scene has no folder".to_owned()),
                };
                files.insert(wanted, read);
            }
        }
    }

    fn extensions(&self) -> &[&str] {
        &["sdf"]
    }
}
