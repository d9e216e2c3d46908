//! The formatter. Every file has one layout, without options.
//!
//! Lines have at most 100 characters unless they cannot be broken. Indentation is two spaces.
//!
//! - A call or list that does not fit has one argument per line, each with a comma. A function with
//!   a block among its arguments, or a list that is the only argument, keeps its brackets beside
//!   those of the call.
//! - A chain of method calls that does not fit breaks before each `.` that begins a call. A chain
//!   of operators breaks before each operator of its level. Both are indented once.
//! - Each clause of a shape has its own line, then `=` has one; all are indented once. The clauses
//!   of a `fn` are on lines of their own if its head does not fit.
//! - A body that does not fit beside its `=` goes below if it fits there.
//! - An `if` is on one line if it fits, else a line ends after every brace. A block with a `let`
//!   stays on one line if it was written so and fits.
//! - At most one blank line is kept. Declarations of several lines get blank lines around them.
//! - A comment stays above or behind the code that it was above or behind. A comment inside of an
//!   expression that stays on one line moves to the end of that line.
//! - Numbers and strings stay as written; colours become lower case. Semicolons stay in blocks on
//!   one line, and before a line that starts with `-`.

mod brackets;
mod decl;
mod doc;
mod expr;
mod print;
mod signature;
mod source;

use sdfc_diagnostics::{Diagnostic, FileId, Sources, has_errors};

use self::doc::{Doc, NOTHING, concat};
use self::source::Source;
use crate::ast::Item;
use crate::lexer::lex;
use crate::token::TokenKind;

/// The greatest number of times that a layout is formatted again. Each time, one more level of
/// nested blocks keeps its lines, so few are needed.
const MAX_PASSES: usize = 32;

/// Formats a file. Formatting the result again changes nothing, and it parses to the same tree
/// except for spans.
///
/// # Errors
///
/// Returns the diagnostics of a file that does not parse.
///
/// ```
/// let mut sources = sdfc_diagnostics::Sources::new();
/// let file = sources.add("scene.sdf", "let  r=1 ;sphere( r ) . color(#FFF)");
/// let text = sdfc_syntax::format(&sources, file);
/// assert_eq!(text.as_deref(), Ok("let r = 1\nsphere(r).color(#fff)\n"));
/// ```
pub fn format(sources: &Sources, file: FileId) -> Result<String, Vec<Diagnostic>> {
    let mut text = laid_out(sources, file)?;
    // A block that gets lines of its own keeps them, so the layout around it may change once more.
    for _ in 0..MAX_PASSES {
        let mut own = Sources::new();
        let file = own.add("", text.as_str());
        let next = laid_out(&own, file)?;
        if next == text {
            break;
        }
        text = next;
    }
    Ok(text)
}

/// Formats a file once.
fn laid_out(sources: &Sources, file: FileId) -> Result<String, Vec<Diagnostic>> {
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

/// Converts an item with the comments behind it on its line.
fn with_end<'a>(source: &mut Source<'a>, item: &Item) -> Doc<'a> {
    let printed = decl::item(source, item);
    source.skip(TokenKind::Semicolon);
    // Without the `;` the next line would continue with a subtraction.
    let end = if source.kind() == TokenKind::Minus { doc::text(";") } else { NOTHING };
    concat(vec![printed, end, source.trailing_comments()])
}
