//! The blocks of `sdfc-march` as bytes, written field by field in the order and with the offsets of
//! WGSL.

use sdfc_march::{LightBlock, PixelBlock, ViewBlock};

/// Size of one [`PixelBlock`] in bytes.
pub const PIXEL_BYTES: usize = size_of::<PixelBlock>();
/// Size of one [`ViewBlock`] in bytes.
pub const VIEW_BYTES: usize = size_of::<ViewBlock>();
/// Size of one per-frame value in bytes.
pub const UNIFORM_BYTES: usize = 16;

/// A byte buffer in the machine's byte order, which is that of its GPU.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn floats(&mut self, values: &[f32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_ne_bytes()));
        self
    }

    fn words(&mut self, values: &[u32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_ne_bytes()));
        self
    }

    fn light(&mut self, light: &LightBlock) -> &mut Self {
        let LightBlock { position, kind, color, shadow, axis, sharpness, rim, pad } = light;
        self.floats(position).words(&[*kind]).floats(color).words(&[*shadow]);
        self.floats(axis).floats(&[*sharpness]).floats(rim).floats(pad)
    }
}

/// Returns the bytes of a view block as the shader reads them.
pub fn view_bytes(block: &ViewBlock) -> Vec<u8> {
    // Destructured so that a new field of the block does not compile until it is written here.
    let ViewBlock {
        eye,
        pixel_radius,
        right,
        t_max,
        up,
        epsilon,
        forward,
        steps,
        size,
        tile_origin,
        tile_size,
        light_count,
        tolerance,
        ambient,
        reflections,
        background,
        reflection_strength,
        zenith,
        fog_density,
        horizon,
        occlusion_radius,
        fog_color,
        occlusion_strength,
        lights,
    } = block;
    let mut bytes = Bytes::default();
    bytes.floats(eye).floats(&[*pixel_radius]);
    bytes.floats(right).floats(&[*t_max]);
    bytes.floats(up).floats(&[*epsilon]);
    bytes.floats(forward).words(&[*steps]);
    bytes.words(size).words(tile_origin).words(tile_size);
    bytes.words(&[*light_count]).floats(&[*tolerance]);
    bytes.floats(ambient).words(&[*reflections]);
    bytes.floats(background).floats(&[*reflection_strength]);
    bytes.floats(zenith).floats(&[*fog_density]);
    bytes.floats(horizon).floats(&[*occlusion_radius]);
    bytes.floats(fog_color).floats(&[*occlusion_strength]);
    for light in lights {
        bytes.light(light);
    }
    bytes.0
}

/// Returns the bytes of per-frame values, one `vec4f` each.
pub fn uniform_bytes(values: &[[f32; 4]]) -> Vec<u8> {
    let mut bytes = Bytes::default();
    bytes.floats(values.as_flattened());
    bytes.0
}

/// Reads a pixel block.
pub fn pixel_from_bytes(bytes: &[u8; PIXEL_BYTES]) -> PixelBlock {
    let (words, _) = bytes.as_chunks();
    let word = |index: usize| u32::from_ne_bytes(words[index]);
    PixelBlock {
        color: [0, 1, 2, 3].map(|index| f32::from_bits(word(index))),
        depth: f32::from_bits(word(4)),
        status: word(5) as u16,
        unproven: (word(5) >> 16) as u16,
        evaluations: word(6),
        primary_evaluations: word(7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::offset_of;

    fn word_at(bytes: &[u8], offset: usize) -> u32 {
        u32::from_ne_bytes(bytes[offset..offset + 4].try_into().unwrap())
    }

    #[test]
    fn view_fields_stand_where_the_block_has_them() {
        let mut block = ViewBlock {
            eye: [1.0, 2.0, 3.0],
            t_max: 9.0,
            steps: 77,
            tile_size: [5, 6],
            reflection_strength: 0.25,
            background: [0.1, 0.2, 0.3],
            ..ViewBlock::default()
        };
        block.lights[7].color = [0.5, 0.6, 0.7];
        let bytes = view_bytes(&block);
        assert_eq!(bytes.len(), VIEW_BYTES);
        assert_eq!(word_at(&bytes, 8), 3f32.to_bits());
        assert_eq!(word_at(&bytes, offset_of!(ViewBlock, t_max)), 9f32.to_bits());
        assert_eq!(word_at(&bytes, offset_of!(ViewBlock, steps)), 77);
        assert_eq!(word_at(&bytes, offset_of!(ViewBlock, tile_size) + 4), 6);
        assert_eq!(word_at(&bytes, offset_of!(ViewBlock, reflection_strength)), 0.25f32.to_bits());
        assert_eq!(word_at(&bytes, offset_of!(ViewBlock, background) + 8), 0.3f32.to_bits());
        let last = offset_of!(ViewBlock, lights)
            + 7 * size_of::<LightBlock>()
            + offset_of!(LightBlock, color);
        assert_eq!(word_at(&bytes, last + 8), 0.7f32.to_bits());
    }

    #[test]
    fn vectors_of_the_view_block_stand_at_multiples_of_16_as_wgsl_wants() {
        for offset in [
            offset_of!(ViewBlock, eye),
            offset_of!(ViewBlock, right),
            offset_of!(ViewBlock, up),
            offset_of!(ViewBlock, forward),
            offset_of!(ViewBlock, ambient),
            offset_of!(ViewBlock, background),
            offset_of!(ViewBlock, zenith),
            offset_of!(ViewBlock, horizon),
            offset_of!(ViewBlock, fog_color),
            offset_of!(ViewBlock, lights),
            VIEW_BYTES,
        ] {
            assert_eq!(offset % 16, 0);
        }
        assert_eq!(PIXEL_BYTES, 32);
    }

    #[test]
    fn a_pixel_survives_the_round_trip() {
        let pixel = PixelBlock {
            color: [0.1, 0.2, 0.3, 1.0],
            depth: 4.5,
            status: 2,
            unproven: 1,
            evaluations: 31,
            primary_evaluations: 17,
        };
        let mut bytes = Bytes::default();
        bytes.floats(&pixel.color).floats(&[pixel.depth]);
        bytes.words(&[0x10002, pixel.evaluations, pixel.primary_evaluations]);
        assert_eq!(bytes.0.first_chunk().map(pixel_from_bytes), Some(pixel));
    }
}
