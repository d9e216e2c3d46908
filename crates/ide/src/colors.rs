//! Colours in the source, for a colour picker.

use std::ops::Range;

use sdfc_diagnostics::Span;
use sdfc_lang::uses::Target;
use sdfc_syntax::ast::{Arg, Element, ExprKind};

use crate::analysis::Analysis;
use crate::edit::range;
use crate::tree::{Node, nodes};

/// A colour in the source.
#[derive(Clone, Debug, PartialEq)]
pub struct Color {
    /// The literal or the call of `rgb`.
    pub range: Range<usize>,
    /// sRGB red, green, blue, and alpha, from 0 to 1.
    pub rgba: [f64; 4],
}

/// Returns all colours of the scene that are written as `#rrggbb` or `rgb(...)`.
pub fn colors(analysis: &Analysis) -> Vec<Color> {
    let colors = nodes(&analysis.tree.items).filter_map(Node::expr).filter_map(|e| {
        let rgba = if let ExprKind::Color(bytes) = &e.kind {
            bytes.map(|byte| f64::from(byte) / 255.0)
        } else if let ExprKind::Call(callee, args) = &e.kind
            && is_rgb(analysis, callee.span)
        {
            parts(args)?
        } else {
            return None;
        };
        Some(Color { range: range(e.span), rgba })
    });
    colors.collect()
}

/// True if a name is that of the kernel's `rgb`.
fn is_rgb(analysis: &Analysis, callee: Span) -> bool {
    analysis.uses.targets.get(&callee) == Some(&Target::Kernel("rgb"))
}

/// The values of `rgb(r, g, b, a)`, if they are plain numbers without names.
fn parts(args: &[Arg]) -> Option<[f64; 4]> {
    let mut rgba = [0.0, 0.0, 0.0, 1.0];
    if !(3..=4).contains(&args.len()) {
        return None;
    }
    for (part, arg) in rgba.iter_mut().zip(args) {
        let (None, Element::Expr(e)) = (&arg.name, &arg.value) else { return None };
        let ExprKind::Number { value, unit: None, .. } = e.kind else { return None };
        *part = value;
    }
    Some(rgba)
}

/// Returns ways to write a colour, the usual one first.
pub fn color_presentations(rgba: [f64; 4]) -> Vec<String> {
    let [r, g, b, a] = rgba.map(|part| part.clamp(0.0, 1.0));
    let bytes = [r, g, b, a].map(|part| (part * 255.0).round() as u8);
    let [red, green, blue, alpha] = bytes;
    let opaque = alpha == 255;
    let literal = format!("#{red:02x}{green:02x}{blue:02x}");
    let round = |part: f64| (part * 1000.0).round() / 1000.0;
    let call = format!("rgb({}, {}, {}", round(r), round(g), round(b));
    match opaque {
        true => vec![literal, format!("{call})")],
        false => vec![format!("{literal}{alpha:02x}"), format!("{call}, {})", round(a))],
    }
}
