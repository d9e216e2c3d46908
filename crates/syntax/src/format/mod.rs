//! The one layout.
//!
//! Lines have at most 100 characters where breaking can help, indentation is two spaces.
//!
//! - A call or list that does not fit puts one argument on each line, with a comma behind each;
//!   a function with a block among its arguments, or a list that is the only one, keeps its
//!   brackets beside those of the call.
//! - A chain of method calls that does not fit breaks before each `.` that begins a call, a chain
//!   of operators before each operator of its level; both are indented once.
//! - The clauses of a shape stand one on a line, then `=` on its own, indented once. Those of a
//!   `fn` do where its head does not fit.
//! - A body that does not fit beside its `=` stands below it if it fits there.
//! - `if` is on one line if it fits, else every brace opens lines. A block with a `let` stays on
//!   one line if it was written so and fits.
//! - At most one blank line is kept, and one is made around declarations of several lines.
//! - Comments keep their place: above what they stand above, behind what they stand behind. One
//!   inside an expression that stays on its line moves to the end of that line.
//! - Numbers and strings stay as written, colours become lower case. Semicolons stay in blocks
//!   on one line, and before a line that starts with `-`.

mod decl;
mod doc;
mod expr;
mod print;
mod source;

use sdfc_diagnostics::{Diagnostic, FileId, Sources, has_errors};

use self::doc::{Doc, NOTHING, concat};
use self::source::Source;
use crate::ast::Item;
use crate::lexer::lex;
use crate::token::TokenKind;

/// The text of a file in the one layout. Formatting that again changes nothing, and it parses to
/// the same tree but for spans.
///
/// # Errors
///
/// A file that does not parse is not formatted: gives what is wrong with it.
///
/// ```
/// let mut sources = sdfc_diagnostics::Sources::new();
/// let file = sources.add("scene.sdf", "let  r=1 ;sphere( r ) . color(#FFF)");
/// let text = sdfc_syntax::format(&sources, file);
/// assert_eq!(text.as_deref(), Ok("let r = 1\nsphere(r).color(#fff)\n"));
/// ```
pub fn format(sources: &Sources, file: FileId) -> Result<String, Vec<Diagnostic>> {
    let (tree, found) = crate::parse(sources, file);
    if has_errors(&found) {
        return Err(found);
    }
    let text = sources.text(file);
    let lexed = lex(text, file, 0);
    let mut source = Source::new(text, &lexed);
    let mut out = String::new();
    let mut after_lines = false;
    for item in &tree.items {
        let blank = source.blank_before();
        let comments = print::print(&source.comments());
        let printed = print::print(&with_end(&mut source, item));
        let printed = printed.trim_end();
        let lines = matches!(item, Item::Decl(_)) && printed.contains('\n');
        if !out.is_empty() && (blank || lines || after_lines) {
            out.push('\n');
        }
        after_lines = lines;
        out.push_str(&comments);
        out.push_str(printed);
        out.push('\n');
    }
    let blank = source.blank_before() || after_lines;
    let last = source.comments();
    if last.hard {
        if blank && !out.is_empty() {
            out.push('\n');
        }
        out.push_str(print::print(&last).trim_end());
        out.push('\n');
    }
    Ok(out)
}

/// An item with what stands behind it on its line.
fn with_end<'a>(source: &mut Source<'a>, item: &Item) -> Doc<'a> {
    let printed = decl::item(source, item);
    source.skip(TokenKind::Semicolon);
    // Without it the next line would go on with a subtraction.
    let end = if source.kind() == TokenKind::Minus { doc::text(";") } else { NOTHING };
    concat(vec![printed, end, source.trailing_comments()])
}
