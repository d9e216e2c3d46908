//! `rgb`, `linear_rgb`, `hsv`, `hsl` and `oklch`: convert numbers and an alpha to linear colours.

use sdfc_diagnostics::{Code, Diagnostic, Span};
use sdfc_graph::{NodeId, Unary};

use super::elaborator::{Elaborator, Env, Outcome};
use super::kernel::Application;
use super::report::show_number;
use super::value::Value;

/// Oklab to the cube roots of the cone responses (Ottosson 2020).
const OKLAB_TO_CONES: [[f64; 3]; 3] = [
    [1.0, 0.396_337_777_4, 0.215_803_757_3],
    [1.0, -0.105_561_345_8, -0.063_854_172_8],
    [1.0, -0.089_484_177_5, -1.291_485_548_0],
];
/// Cone responses to linear sRGB (Ottosson 2020).
const CONES_TO_LINEAR: [[f64; 3]; 3] = [
    [4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2],
    [-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5],
    [-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701_0],
];

impl<'p> Elaborator<'p> {
    /// `rgb(red, green, blue, alpha)`, each in 0..1 and encoded as sRGB.
    pub(super) fn rgb(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let [red, green, blue, alpha] = self.numbers(env, at.args)?;
        self.warn_above_one(at.span, [red, green, blue]);
        self.joined(at, [red, green, blue].map(Channel::Srgb), alpha)
    }

    /// Warns of components above 1: most are written for a range of 0 to 255.
    fn warn_above_one(&mut self, span: Span, channels: [NodeId; 3]) {
        let above = |node| self.graph.as_number(node).filter(|number| *number > 1.0);
        let Some(first) = channels.into_iter().find_map(above) else { return };
        let message =
            format!("the components of `rgb` go from 0 to 1; this has {}", show_number(first));
        let warning = Diagnostic::warning(Code::BRIGHT_COLOUR, span, message);
        let bytes = channels.map(|node| {
            let byte = self.graph.as_number(node)?;
            ((0.0..=255.0).contains(&byte) && byte.fract() == 0.0).then_some(byte as u8)
        });
        let help = match bytes {
            [Some(red), Some(green), Some(blue)] => {
                format!("if they go from 0 to 255, write #{red:02x}{green:02x}{blue:02x}")
            }
            _ => "for amounts of light above 1, write `linear_rgb`".to_owned(),
        };
        self.report(warning.help(help));
    }

    /// `linear_rgb(red, green, blue, alpha)`.
    pub(super) fn linear_rgb(
        &mut self,
        env: &mut Env<'p>,
        at: Application<'p>,
    ) -> Outcome<Value<'p>> {
        let [red, green, blue, alpha] = self.numbers(env, at.args)?;
        self.joined(at, [red, green, blue].map(Channel::Linear), alpha)
    }

    /// `hsv(hue, saturation, value, alpha)`, each in 0..1; a hue of 1 is a full turn.
    pub(super) fn hsv(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let [hue, saturation, value, alpha] = self.numbers(env, at.args)?;
        let channels = self.pure_hue(hue).map(|pure| {
            // value * (1 - saturation * (1 - pure))
            let graph = &mut self.graph;
            let one = graph.number(1.0);
            let lack = graph.sub(one, pure);
            let lack = graph.mul(saturation, lack);
            let share = graph.sub(one, lack);
            Channel::Srgb(graph.mul(value, share))
        });
        self.joined(at, channels, alpha)
    }

    /// `hsl(hue, saturation, lightness, alpha)`, each in 0..1; a hue of 1 is a full turn.
    pub(super) fn hsl(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let [hue, saturation, lightness, alpha] = self.numbers(env, at.args)?;
        // The chroma that this lightness allows: saturation * (1 - |2 lightness - 1|)
        let graph = &mut self.graph;
        let [one, two, half] = [1.0, 2.0, 0.5].map(|n| graph.number(n));
        let doubled = graph.mul(lightness, two);
        let from_grey = graph.sub(doubled, one);
        let from_grey = graph.abs(from_grey);
        let room = graph.sub(one, from_grey);
        let chroma = graph.mul(saturation, room);
        let channels = self.pure_hue(hue).map(|pure| {
            // lightness + chroma * (pure - 0.5)
            let graph = &mut self.graph;
            let above = graph.sub(pure, half);
            let above = graph.mul(chroma, above);
            Channel::Srgb(graph.add(lightness, above))
        });
        self.joined(at, channels, alpha)
    }

    /// Red, green and blue of a hue at full saturation and value: saturate(|6 fract(hue + shift) -
    /// 3| - 1) with a shift for each.
    fn pure_hue(&mut self, hue: NodeId) -> [NodeId; 3] {
        [1.0, 2.0 / 3.0, 1.0 / 3.0].map(|shift| {
            let graph = &mut self.graph;
            let [shift, one, three, six] = [shift, 1.0, 3.0, 6.0].map(|n| graph.number(n));
            let turned = graph.add(hue, shift);
            let sector = graph.unary(Unary::Fract, turned);
            let sector = graph.mul(sector, six);
            let ramp = graph.sub(sector, three);
            let ramp = graph.abs(ramp);
            let ramp = graph.sub(ramp, one);
            graph.unary(Unary::Saturate, ramp)
        })
    }

    /// `oklch(lightness, chroma, hue, alpha)`: lightness in 0..1, hue an angle. The result is
    /// clipped to the sRGB gamut.
    pub(super) fn oklch(&mut self, env: &mut Env<'p>, at: Application<'p>) -> Outcome<Value<'p>> {
        let [lightness, chroma, hue, alpha] = self.numbers(env, at.args)?;
        let [cosine, sine] = [Unary::Cos, Unary::Sin].map(|op| self.graph.unary(op, hue));
        let (a, b) = (self.graph.mul(chroma, cosine), self.graph.mul(chroma, sine));
        let cones = OKLAB_TO_CONES.map(|row| {
            let root = self.weighted(row, [lightness, a, b]);
            let square = self.graph.mul(root, root);
            self.graph.mul(square, root)
        });
        let channels = CONES_TO_LINEAR.map(|row| {
            let channel = self.weighted(row, cones);
            Channel::Linear(self.graph.unary(Unary::Saturate, channel))
        });
        self.joined(at, channels, alpha)
    }

    fn weighted(&mut self, weights: [f64; 3], values: [NodeId; 3]) -> NodeId {
        let mut sum = self.graph.number(0.0);
        for (weight, value) in weights.into_iter().zip(values) {
            let weight = self.graph.number(weight);
            let part = self.graph.mul(weight, value);
            sum = self.graph.add(sum, part);
        }
        sum
    }

    fn joined(
        &mut self,
        at: Application<'p>,
        channels: [Channel; 3],
        alpha: NodeId,
    ) -> Outcome<Value<'p>> {
        let [red, green, blue] = channels.map(|channel| match channel {
            Channel::Linear(node) => node,
            Channel::Srgb(node) => self.decode(node),
        });
        let color = self.graph.compose(&[red, green, blue, alpha]);
        self.checked(at, &[], color)
    }

    /// Decodes an sRGB value to linear (IEC 61966-2-1); negative values become 0.
    fn decode(&mut self, encoded: NodeId) -> NodeId {
        let graph = &mut self.graph;
        let [zero, knee, slope, offset, scale, gamma] =
            [0.0, 0.040_45, 1.0 / 12.92, 0.055, 1.0 / 1.055, 2.4].map(|n| graph.number(n));
        let encoded = graph.max(encoded, zero);
        let shadows = graph.mul(encoded, slope);
        let shifted = graph.add(encoded, offset);
        let shifted = graph.mul(shifted, scale);
        let lights = graph.binary(sdfc_graph::Binary::Pow, shifted, gamma);
        let dark = graph.le(encoded, knee);
        graph.select(dark, shadows, lights)
    }
}

/// A colour channel and its encoding.
#[derive(Clone, Copy)]
enum Channel {
    Linear(NodeId),
    Srgb(NodeId),
}
