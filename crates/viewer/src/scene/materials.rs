//! Evaluates the scene's materials on the CPU at the points that a picture shows.

use sdfc::FrameValues;
use sdfc_graph::eval::Tape;
use sdfc_graph::{MaterialField, Program};
use sdfc_render::linear_to_srgb8;

use crate::scene::field_probe::{IsInterrupted, in_parallel};

/// A material, rounded so that equal values look equal: colours to 8-bit sRGB, the rest to
/// hundredths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Material {
    /// Red, green, blue in sRGB.
    pub color: [u8; 3],
    /// From 0 (mirror) to 100 (matt).
    pub roughness: u8,
    /// From 0 (dielectric) to 100 (metal).
    pub metallic: u8,
    /// Emitted light: red, green, blue in sRGB.
    pub emission: [u8; 3],
}

impl Material {
    fn from_fields(fields: &[[f64; 4]]) -> Self {
        let field = |field: MaterialField| fields.get(field.index()).copied().unwrap_or_default();
        let coverage = field(MaterialField::Coverage)[0];
        let default = MaterialField::Color.default_value();
        let color = field(MaterialField::Color);
        let mixed = |lane: usize| default[lane] + (color[lane] - default[lane]) * coverage;
        let byte = |linear: f64| linear_to_srgb8(linear as f32);
        let hundredths = |kind| (field(kind)[0] * 100.0).round() as u8;
        let emission = field(MaterialField::Emission);
        Self {
            color: [0, 1, 2].map(|lane| byte(mixed(lane))),
            roughness: hundredths(MaterialField::Roughness),
            metallic: hundredths(MaterialField::Metallic),
            emission: [0, 1, 2].map(|lane| byte(emission[lane])),
        }
    }

    /// The material as a scene writes it.
    pub fn text(&self) -> String {
        let hex = |[red, green, blue]: [u8; 3]| format!("#{red:02x}{green:02x}{blue:02x}");
        let fraction = |hundredths: u8| f64::from(hundredths) / 100.0;
        let mut text = format!("{}, roughness {}", hex(self.color), fraction(self.roughness));
        if self.metallic > 0 {
            text += &format!(", metallic {}", fraction(self.metallic));
        }
        if self.emission != [0; 3] {
            text += &format!(", emission {}", hex(self.emission));
        }
        text
    }
}

/// The materials of a scene, in f64.
#[derive(Debug)]
pub struct Materials {
    tape: Option<Tape>,
}

impl Materials {
    /// The materials of a program. Points are relative to the program's origin. A program without
    /// materials has the default material everywhere.
    pub fn new(program: &Program) -> Self {
        let tape = program.material.and_then(|fields| Tape::new(&program.graph, &fields).ok());
        Self { tape }
    }

    /// The materials at points, computed on all cores. `None` stays `None`.
    pub fn at(
        &self,
        frame: &FrameValues,
        points: &[Option<[f64; 3]>],
        interrupted: IsInterrupted<'_>,
    ) -> Vec<Option<Material>> {
        let Some(tape) = &self.tape else {
            let default =
                Material::from_fields(&MaterialField::ALL.map(MaterialField::default_value));
            return points.iter().map(|point| point.map(|_| default)).collect();
        };
        in_parallel(points, interrupted, || {
            let mut fields = tape.prepare::<f64>(frame);
            move |point: &Option<[f64; 3]>| {
                point.map(|point| Material::from_fields(fields.eval(point)))
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, point: [f64; 3]) -> Material {
        let scene = sdfc::Compiler::new().compile("a", text).unwrap();
        let frame = FrameValues::defaults(scene.params());
        Materials::new(scene.program()).at(&frame, &[Some(point)], &|| false)[0].unwrap()
    }

    #[test]
    fn materials_are_shown_as_the_scene_writes_them() {
        let text = "sphere(1).color(#d94f30).metallic(0.5)\nsphere(1).translate(x: 4)\n";
        let stated = at(text, [0.0, 0.0, 1.0]);
        assert_eq!(stated.text(), "#d94f30, roughness 0.5, metallic 0.5");
        assert_eq!(at(text, [4.0, 0.0, 1.0]).color, [231; 3]);
        assert_eq!(at("sphere(1)", [0.0, 0.0, 1.0]).text(), "#e7e7e7, roughness 0.5");
    }
}
