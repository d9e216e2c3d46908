//! The thread that compiles the scene.
//!
//! It handles the latest request only: a request that arrives while another is being handled
//! replaces the one that waits. [`ModelBuilder`] does the work.

use std::sync::Arc;
use std::sync::mpsc::Sender;

use crate::compile::builder::ModelBuilder;
use crate::compile::request::{BuildRequest, CompileEvent, CompileReport};
use crate::latest_channel::LatestChannel;
use crate::worker_thread::WorkerThread;

/// A handle to the compile worker; dropping it ends the thread.
#[derive(Debug)]
pub struct CompileWorker(WorkerThread<BuildRequest>);

impl CompileWorker {
    /// Starts the thread. It sends `reports` and calls `wake` when there are some.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn new(
        reports: Sender<CompileReport>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let send = move |report: CompileReport| {
            // Another event follows at once; the window shows both together.
            let is_last = !matches!(report.event, CompileEvent::Compiled { draws: true, .. });
            // Sending fails only after the session is dropped.
            let _ = reports.send(report);
            if is_last {
                wake();
            }
        };
        let init = |requests| {
            let mut builder = ModelBuilder::new(requests, send);
            move |request| builder.handle(&request)
        };
        WorkerThread::start("compile", init).map(Self)
    }

    /// Requests a build. Files are read when the build begins. Nothing is done if neither they nor
    /// the request differ from the last build.
    pub fn send(&self, request: BuildRequest) {
        self.0.channel().send(request);
    }

    /// The channel of requests, for the file watcher.
    pub fn requests(&self) -> Arc<LatestChannel<BuildRequest>> {
        Arc::clone(self.0.channel())
    }
}

#[cfg(test)]
mod tests {
    use sdfc_graph::{Program, reachable};

    use crate::compile::diagnostics::SceneDiagnostics;
    use crate::compile::request::{BuildRequest, CompileEvent};
    use crate::test_support::{
        expect_compiled, expect_model, model, next_event, on_cpu, ready_model, start_worker,
    };

    #[test]
    fn a_broken_scene_gives_errors_and_the_next_good_one_a_model() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, events) = start_worker();
        worker.send(on_cpu(&path));
        assert!(matches!(next_event(&events), CompileEvent::Unreadable(_)));
        for number in 1..4 {
            std::fs::write(&path, format!("spere({number})")).unwrap();
            worker.send(on_cpu(&path));
            assert_eq!(expect_compiled(&events).0.errors(), 1);
            std::fs::write(&path, format!("\u{feff}sphere({number})\r\n")).unwrap();
            worker.send(on_cpu(&path));
            assert_eq!(ready_model(&events).serial, number);
        }
        // The same source again gives no event; a scene that draws nothing does.
        worker.send(on_cpu(&path));
        std::fs::write(&path, "let a = 1\n").unwrap();
        worker.send(on_cpu(&path));
        assert_eq!(expect_compiled(&events).0.errors(), 0);
        assert!(matches!(next_event(&events), CompileEvent::Empty));
    }

    /// The file is broken, draws nothing, or is deleted.
    #[test]
    fn the_last_good_scene_can_change_its_camera_while_the_file_is_broken() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, events) = start_worker();
        std::fs::write(&path, "sphere(1)\n").unwrap();
        worker.send(on_cpu(&path));
        let shown = ready_model(&events);
        assert!(!shown.parallel);
        let mut parallel = false;
        for text in [Some("spere(1)\n"), Some("let a = 1\n"), None] {
            match text {
                Some(text) => std::fs::write(&path, text).unwrap(),
                None => std::fs::remove_file(&path).unwrap(),
            }
            parallel = !parallel;
            worker.send(BuildRequest { parallel: Some(parallel), ..on_cpu(&path) });
            let event = next_event(&events);
            assert_eq!(matches!(event, CompileEvent::Unreadable(_)), text.is_none(), "{event:?}");
            if text.is_some_and(|text| text.starts_with("let")) {
                assert!(matches!(next_event(&events), CompileEvent::Empty));
            }
            let model = expect_model(&events);
            assert_eq!((model.parallel, model.source.as_str()), (parallel, "sphere(1)\n"));
            assert_eq!(model.content_id, shown.content_id);
        }
        // No scene of another file has been shown yet.
        worker.send(on_cpu(&folder.path().join("b.sdf")));
        assert!(matches!(next_event(&events), CompileEvent::Unreadable(_)));
        std::fs::write(&path, "sphere(2)\n").unwrap();
        worker.send(on_cpu(&path));
        assert_eq!(ready_model(&events).source, "sphere(2)\n");
    }

    #[test]
    fn an_edited_import_is_noticed_and_its_folder_watched() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let part = folder.path().join("parts").join("ball.sdf");
        std::fs::create_dir(part.parent().unwrap()).unwrap();
        std::fs::write(&path, "import ball from \"parts/ball.sdf\"\nball()\n").unwrap();
        let (worker, events) = start_worker();
        let at = [0.0, 0.0, 2.0];
        for radius in [1.0, 0.5] {
            std::fs::write(&part, format!("solid ball() = sphere({radius:?})(p)\n")).unwrap();
            worker.send(on_cpu(&path));
            let (diagnostics, folders) = expect_compiled(&events);
            assert_eq!(diagnostics.errors(), 0, "{diagnostics:?}");
            assert!(folders.iter().any(|folder| folder.ends_with("parts")), "{folders:?}");
            assert_eq!(expect_model(&events).scene.distance(at).unwrap(), 2.0 - radius);
        }
    }

    #[test]
    fn the_live_literals_of_a_large_scene_are_those_around_the_last_edit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, events) = start_worker();
        let terms: String =
            (0..400).map(|i| format!("\n    + 0.00{i} * sin(1.{i} * p.x)")).collect();
        let moving = |last: &str| {
            let text = format!("solid waves() = p.y{terms}\n    + {last} * cos(p.z)\nwaves()\n");
            std::fs::write(&path, &text).unwrap();
            worker.send(on_cpu(&path));
            let model = ready_model(&events);
            let lines: Vec<usize> = (model.numbers.iter())
                .map(|number| text[..number.span.start as usize].lines().count())
                .collect();
            assert_eq!(lines.len(), sdfc_lang::live_literals::MAX_LIVE_LITERALS);
            lines.into_iter().fold([usize::MAX, 0], |[lo, hi], at| [lo.min(at), hi.max(at)])
        };
        assert_eq!(moving("0.5")[0], 2);
        let after = moving("0.25");
        assert!(after[0] > 2 && after[1] == 402, "{after:?}");
        // An edit of a live literal that makes the source longer.
        assert_eq!(moving("0.1255"), after);
    }

    /// A driver compiles all nodes: with unrolled materials it takes minutes and gigabytes.
    #[test]
    fn a_scene_of_many_coloured_parts_has_as_few_nodes_as_one_of_some() {
        let nodes = |parts| {
            let part = |at: usize| {
                let kind = ["sphere(0.1)", "box(0.1)", "cylinder(0.1, 0.2)"][at % 3];
                let [x, y, z] = [at % 10, at / 10 % 10, at / 100];
                format!("{kind}.translate([{x}, {y}, {z}.5]).color(#{:06x})\n", 7 * at + 1)
            };
            let model = model(&(0..parts).map(part).collect::<String>());
            let Program { graph, distance, material, .. } = model.marched();
            let roots: Vec<_> = distance.iter().chain(material.iter().flatten()).copied().collect();
            assert!(material.is_some());
            reachable(graph, &roots).len()
        };
        let [some, many] = [400, 1000].map(nodes);
        assert!(some < 500 && many <= some + some / 10, "{some} nodes, then {many}");
    }

    #[test]
    fn changing_the_method_keeps_the_content_id() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "sphere(1)\n").unwrap();
        let (worker, events) = start_worker();
        let mut models = Vec::new();
        for method in [None, Some(sdfc::Method::Interval), Some(sdfc::Method::Sphere)] {
            worker.send(BuildRequest { method, ..on_cpu(&path) });
            models.push(ready_model(&events));
        }
        std::fs::write(&path, "sphere(2)\n").unwrap();
        worker.send(on_cpu(&path));
        models.push(ready_model(&events));
        let contents: Vec<u64> = models.iter().map(|model| model.content_id).collect();
        assert_eq!(contents, [1, 1, 1, 2]);
        let serials: Vec<u64> = models.iter().map(|model| model.serial).collect();
        assert_eq!(serials, [1, 2, 3, 4]);
    }

    #[test]
    fn warnings_are_those_of_the_scene_without_live_literals() {
        let text = "let idle = 2\nsphere(1).twist(1)\n";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, text).unwrap();
        let (worker, events) = start_worker();
        worker.send(on_cpu(&path));
        let expected = SceneDiagnostics::new(&sdfc::Compiler::new().check("a.sdf", text));
        assert_eq!(expect_compiled(&events).0, expected);
    }

    /// Hundreds of edits, half of them broken, faster than they can be compiled.
    #[test]
    fn after_a_burst_of_edits_the_last_one_is_shown() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        let (worker, events) = start_worker();
        let broken =
            ["sphere(", "spere(1)", "sphere(1).", "\u{0}", "box(1) |", "sphere(1, 2, 3, 4)"];
        let count = std::env::var("SDFC_SOAK").ok().and_then(|it| it.parse().ok()).unwrap_or(400);
        for edit in 0..count {
            let text = match edit % 2 {
                0 => broken[edit / 2 % broken.len()].to_owned(),
                _ => format!("sphere({}) | box(0.{})\n", edit, edit % 7 + 1),
            };
            std::fs::write(&path, text).unwrap();
            worker.send(on_cpu(&path));
        }
        std::fs::write(&path, "sphere(0.75)\n").unwrap();
        worker.send(on_cpu(&path));
        loop {
            match next_event(&events) {
                CompileEvent::Ready(model) if model.source == "sphere(0.75)\n" => {
                    assert_eq!(model.scene.distance([0.0, 0.0, 2.0]).unwrap(), 1.25);
                    return;
                }
                CompileEvent::Failed(why) => panic!("{why}"),
                CompileEvent::Ready(_)
                | CompileEvent::Compiled { .. }
                | CompileEvent::FilesChanged(_)
                | CompileEvent::BuildingPipeline
                | CompileEvent::Unreadable(_)
                | CompileEvent::Empty => {}
            }
        }
    }
}
