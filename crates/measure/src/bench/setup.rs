//! What all variants of a scene share, and the program of each.

use sdfc::Scene;
use sdfc_analyze::{LoopStrategy, cost, prepare_with};
use sdfc_graph::Program;
use sdfc_graph::eval::FrameValues;
use sdfc_render::{Gpu, View};

use super::kind::Kind;
use super::options::BenchOptions;
use crate::baseline::Inexpressible;
use crate::error::MeasureError;

/// Slow variants, and those that compile slowly, are not measured on scenes with more leaves.
const MAX_INTERPRETED_LEAVES: usize = 300;
/// Loops without culling are not measured on scenes with more leaves.
const MAX_UNCULLED_LEAVES: usize = 2000;
/// A field with more operations is not measured unrolled: with normals by its gradient, and by
/// differences.
const MAX_UNROLLED_OPERATIONS: [usize; 2] = [5000, 14_000];

/// The data that all variants of a row share.
pub(super) struct Setup<'a> {
    pub(super) scene: &'a Scene,
    pub(super) live: Result<&'a Scene, &'a str>,
    pub(super) gpu: &'a Gpu,
    pub(super) options: &'a BenchOptions,
    pub(super) view: View,
    /// The unrolled field.
    pub(super) unrolled: Program,
    /// The field with loops, without and with culling. `None` if no parts are similar.
    pub(super) looped: Option<Program>,
    pub(super) culled: Option<Program>,
    /// The variant that [`LoopStrategy::Auto`] chooses.
    pub(super) auto: Kind,
}

impl<'a> Setup<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        live: Result<&'a Scene, &'a str>,
        gpu: &'a Gpu,
        options: &'a BenchOptions,
    ) -> Result<Self, MeasureError> {
        let prepared = |strategy| prepare_with(scene.graph(), [0.0; 3], strategy);
        let unrolled = prepared(LoopStrategy::Unrolled)?.program;
        let found = prepared(LoopStrategy::Looped)?;
        let culled = Some(found.program).filter(|_| !found.report.loops.is_empty());
        let looped =
            culled.clone().map(|program| Program { cullable_loops: Vec::new(), ..program });
        let culled = culled.filter(|program| !program.cullable_loops.is_empty());
        let frame = FrameValues::defaults(scene.params());
        let seen = culled.as_ref().unwrap_or(&unrolled);
        let view = View::new(seen, &frame, scene.bounds_at(&frame), options.size)?;
        let auto = match (scene.report().loops.is_empty(), culled.is_some()) {
            (true, _) => Kind::Specialized,
            (false, true) => Kind::Culled,
            (false, false) => Kind::Looped,
        };
        Ok(Self { scene, live, gpu, options, view, unrolled, looped, culled, auto })
    }

    /// Returns true if the unrolled field compiles in reasonable time.
    pub(super) fn is_unrolled(&self) -> bool {
        self.culled.is_none()
            || cost(&self.unrolled.graph, self.unrolled.distance.as_slice()).operations
                <= self.max_operations()
    }

    fn max_operations(&self) -> usize {
        MAX_UNROLLED_OPERATIONS[usize::from(self.options.baselines)]
    }

    /// Returns the program that a variant is compiled from.
    pub(super) fn program(&self, kind: Kind) -> Result<&Program, Inexpressible> {
        fn alike(program: &Option<Program>) -> Result<&Program, Inexpressible> {
            let why = "few of its parts are similar, or have no Lipschitz constant";
            program.as_ref().ok_or_else(|| Inexpressible(why.to_owned()))
        }
        let leaves = self.scene.report().leaves;
        match kind {
            Kind::Units | Kind::Tape | Kind::LiveLiterals if !self.options.baselines => {
                Err(Inexpressible("left out".to_owned()))
            }
            Kind::Units | Kind::Tape | Kind::LiveLiterals if leaves > MAX_INTERPRETED_LEAVES => {
                let why = format!("over {MAX_INTERPRETED_LEAVES} leaves, which take it minutes");
                Err(Inexpressible(why))
            }
            Kind::Specialized if !self.is_unrolled() => {
                let most = self.max_operations();
                let why = format!("over {most} operations, which take minutes to compile");
                Err(Inexpressible(why))
            }
            Kind::Units | Kind::Tape | Kind::Specialized => Ok(&self.unrolled),
            Kind::LiveLiterals => match self.live {
                Ok(live) => Ok(live.program()),
                Err(why) => Err(Inexpressible(why.to_owned())),
            },
            Kind::Looped if leaves > MAX_UNCULLED_LEAVES => {
                let why =
                    format!("over {MAX_UNCULLED_LEAVES} leaves, all of which it visits each time");
                Err(Inexpressible(why))
            }
            Kind::Looped => alike(&self.looped),
            Kind::Culled => alike(&self.culled),
        }
    }
}
