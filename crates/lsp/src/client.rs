//! The abilities of the editor.

use serde_json::{Value, json};

use crate::lines::Encoding;

/// The abilities of the editor.
#[derive(Clone, Copy, Debug)]
pub struct Client {
    /// The unit of columns.
    pub encoding: Encoding,
    /// True if completions may have gaps to fill in.
    pub snippets: bool,
    /// True if descriptions may have pictures.
    pub pictures: bool,
    /// True if the server may ask for reports of changed files.
    pub registers_watchers: bool,
}

impl Client {
    /// Reads the parameters of `initialize`.
    pub fn new(params: &Value) -> Self {
        let capabilities = &params["capabilities"];
        let encodings = capabilities["general"]["positionEncodings"].as_array();
        let utf8 = encodings.is_some_and(|list| list.first() == Some(&json!("utf-8")));
        let watched = &capabilities["workspace"]["didChangeWatchedFiles"];
        let item = &capabilities["textDocument"]["completion"]["completionItem"];
        Self {
            encoding: if utf8 { Encoding::Utf8 } else { Encoding::Utf16 },
            snippets: item["snippetSupport"] == json!(true),
            pictures: params["initializationOptions"]["hoverPictures"] == json!(true),
            registers_watchers: watched["dynamicRegistration"] == json!(true),
        }
    }
}
