//! The light of a picture of the surroundings, evaluated for many directions at a time.

use glam::DVec3;
use sdfc_graph::eval::{FrameValues, Packet, Tape, TapeError};
use sdfc_graph::{Environment, Program};

use super::ray::{Batch, LANES, Real, packed_from};

/// The functions of the environment, compiled for the CPU.
#[derive(Clone, Debug)]
pub(super) struct EnvironmentTapes {
    radiance: Tape,
    irradiance: Tape,
}

impl EnvironmentTapes {
    /// `None` if the program has no environment.
    pub(super) fn new(program: &Program) -> Result<Option<Self>, TapeError> {
        let Some(Environment { radiance, irradiance }) = program.settings.environment else {
            return Ok(None);
        };
        let radiance = Tape::for_rays(&program.graph, &[radiance])?;
        let irradiance = Tape::new(&program.graph, &[irradiance])?;
        Ok(Some(Self { radiance, irradiance }))
    }

    pub(super) fn prepare<T: Real>(&self, frame: &FrameValues) -> EnvironmentBatch<'_, T> {
        EnvironmentBatch {
            radiance: self.radiance.prepare::<Packet<T, LANES>>(frame),
            irradiance: self.irradiance.prepare::<Packet<T, LANES>>(frame),
        }
    }
}

/// The same functions for one frame.
#[derive(Clone)]
pub(super) struct EnvironmentBatch<'t, T> {
    radiance: Batch<'t, T>,
    irradiance: Batch<'t, T>,
}

impl<T: Real> EnvironmentBatch<'_, T> {
    /// The light that mirrors receive, each given by the mirrored direction and the roughness.
    pub(super) fn radiance(&mut self, mirrors: &[(DVec3, f64)]) -> Vec<DVec3> {
        let mut found = Vec::with_capacity(mirrors.len());
        for group in mirrors.chunks(LANES) {
            let directions = packed_from(group.iter().map(|&(direction, _)| lanes(direction)));
            let roughness = packed_from(group.iter().map(|&(_, it)| lanes(DVec3::splat(it))));
            let [radiance] = self.radiance.eval_ray(directions, roughness) else { continue };
            found.extend((0..group.len()).map(|lane| lane_of(radiance, lane)));
        }
        found
    }

    /// The light that matt white surfaces reflect, each given by its normal.
    pub(super) fn irradiance(&mut self, normals: &[DVec3]) -> Vec<DVec3> {
        let mut found = Vec::with_capacity(normals.len());
        for group in normals.chunks(LANES) {
            let normals = packed_from(group.iter().map(|&normal| lanes(normal)));
            let [irradiance] = self.irradiance.eval(normals) else { continue };
            found.extend((0..group.len()).map(|lane| lane_of(irradiance, lane)));
        }
        found
    }
}

fn lanes<T: Real>(vector: DVec3) -> [T; 3] {
    vector.to_array().map(T::constant)
}

/// One lane of the values of a root.
fn lane_of<T: Real>(root: &[Packet<T, LANES>; 4], lane: usize) -> DVec3 {
    let [Packet(x), Packet(y), Packet(z), _] = root;
    DVec3::new(x[lane].into(), y[lane].into(), z[lane].into())
}
