//! Text: the kernel functions `glyph_curves` and `str`.

use sdfc_diagnostics::{Code, Diagnostic, Span};

use super::elaborator::{Elaborator, Env, Outcome, Poison};
use super::kernel::Application;
use super::limits::MAX_TEXT_BYTES;
use super::report::show_number;
use super::value::Value;
use crate::font::Setting;
use crate::hir::Expr;

/// The values of `align`, and the fraction of a line that each puts to the left of x = 0.
const ALIGNMENTS: [(&str, f64); 3] = [("left", 0.0), ("center", 0.5), ("right", 1.0)];

impl<'p> Elaborator<'p> {
    /// `glyph_curves(text, font, align, spacing, leading)`. All arguments must be known at compile
    /// time.
    pub(super) fn glyph_curves(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
    ) -> Outcome<Value<'p>> {
        let [words, font, align, spacing, leading] = at.args else { return Err(Poison) };
        let words = self.text(env, words, "the words of a text")?;
        let font = self.text(env, font, "the font of a text")?;
        let align = self.alignment(env, align)?;
        let spacing = self.fixed(env, spacing, "the spacing of a text")?;
        let leading = self.fixed(env, leading, "the leading of a text")?;
        let pieces = self.assets.fonts.curves(&words, &font, Setting { align, spacing, leading });
        let pieces = pieces.map_err(|why| {
            let help = "use letters that the font has; `font:` is \"sans\" or a font file beside the scene";
            self.report(Diagnostic::error(Code::TEXT, at.span, why).help(help))
        })?;
        Ok(self.pieces(pieces))
    }

    /// `str(a, ...)`. All arguments must be known at compile time.
    pub(super) fn string(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        self.tick(at.span)?;
        let mut joined = String::new();
        for arg in at.args {
            match self.eval(env, arg)? {
                Value::Text(text) => joined.push_str(&text),
                Value::Node(node) => {
                    let number = self.graph.as_number(node);
                    let number = number
                        .ok_or_else(|| self.not_constant(arg.span, "a number in a string", node))?;
                    joined.push_str(&show_number(number));
                }
                Value::Choice(node, _) => {
                    return Err(self.not_constant(arg.span, "a string", node));
                }
                other => return Err(self.unexpected(arg.span, "a string or a number", &other)),
            }
        }
        if joined.len() > MAX_TEXT_BYTES {
            let message =
                format!("this string has {} bytes; the limit is {MAX_TEXT_BYTES}", joined.len());
            let error = Diagnostic::error(Code::TEXT, at.span, message);
            return Err(self.report(error.help("join fewer or shorter strings")));
        }
        Ok(Value::Text(joined.into()))
    }

    pub(super) fn text(
        &mut self,
        env: &mut Env<'p>,
        e: &'p Expr,
        what: &str,
    ) -> Outcome<std::rc::Rc<str>> {
        match self.eval(env, e)? {
            Value::Text(text) => Ok(text),
            Value::Choice(node, _) => Err(self.not_constant(e.span, what, node)),
            other => Err(self.unexpected(e.span, "a string", &other)),
        }
    }

    fn alignment(&mut self, env: &mut Env<'p>, e: &'p Expr) -> Outcome<f64> {
        let name = self.text(env, e, "the alignment of a text")?;
        let found = ALIGNMENTS.iter().find(|(known, _)| *known == &*name);
        found.map(|(_, part)| *part).ok_or_else(|| self.unknown_alignment(&name, e.span))
    }

    fn unknown_alignment(&mut self, name: &str, span: Span) -> Poison {
        let message = format!("`align` must be \"left\", \"center\" or \"right\", not \"{name}\"");
        self.fail(Code::TEXT, span, message)
    }

    /// A number known at compile time.
    fn fixed(&mut self, env: &mut Env<'p>, e: &'p Expr, what: &str) -> Outcome<f64> {
        let node = self.number(env, e)?;
        self.graph.as_number(node).ok_or_else(|| self.not_constant(e.span, what, node))
    }
}
