//! Answers the questions of an editor about a scene while someone types.
//!
//! # What
//!
//! [`Analysis`] is a scene that was parsed and checked. Every question is a function of it:
//! [`diagnostics`], [`hover`], [`definition`], [`references()`], [`rename`] and so on. [`complete`]
//! takes the text itself. [`late_diagnostics`] elaborates the scene.
//!
//! # How
//!
//! Names and types come from the tables that the checker fills ([`sdfc_lang::uses`]). Nothing here
//! resolves a name. For completion, the word at the cursor is replaced by a name that the checker
//! recognises: it notes the scope and the expected type there.
//!
//! ```
//! use sdfc_ide::{Analysis, NoFiles, hover};
//!
//! let scene = Analysis::new("scene.sdf", "let ball = sphere(0.5)\nball\n", &NoFiles);
//! let shown = hover(&scene, 12, &mut |_| None).expect("there is a name at byte 12");
//! assert!(shown.markdown.contains("sphere(r: length"));
//! ```
//!
//! # Limits
//!
//! Positions are byte offsets. An offset outside of the text or inside of a character has no
//! answer. Files come from a [`Resolver`]; this crate opens none.

mod actions;
mod analysis;
mod calls;
mod colors;
mod completion;
mod declaration;
mod definition;
mod diagnostics;
mod edit;
mod facts;
mod folding;
mod format;
mod hints;
mod hover;
mod imports;
mod library;
mod references;
mod rename;
mod selection;
mod signature;
mod symbols;
mod tokens;
mod tree;

pub use actions::{Action, ActionKind, actions};
pub use analysis::Analysis;
pub use colors::{Color, color_presentations, colors};
pub use completion::{Completion, CompletionKind, complete};
pub use definition::definition;
pub use diagnostics::{Found, Related, diagnostics, late_diagnostics};
pub use edit::{Edit, Location};
pub use facts::{Facts, Lens, ShapeFacts, facts_at, lenses};
pub use folding::{Fold, FoldKind, folds};
pub use format::format;
pub use hints::{Hint, HintKind, hints};
pub use hover::{ExampleScene, Hover, hover};
pub use imports::imports;
pub use library::library_files;
pub use references::{highlights, references};
pub use rename::{prepare_rename, rename};
pub use sdfc_diagnostics::Severity;
pub use sdfc_lang::import::MAX_FILES;
pub use sdfc_lang::{NoFiles, Resolver};
pub use selection::selection;
pub use signature::{SignatureHelp, signature_help};
pub use symbols::{Symbol, SymbolKind, symbols};
pub use tokens::{TokenRole, TokenSpan, tokens};
