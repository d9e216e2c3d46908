//! All that the window does, without the window: files in, pictures and findings out.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sdfc::FrameValues;
use sdfc::render::Pose;

use crate::clerk::{Clerk, Errand, Outcome};
use crate::clock::Clock;
use crate::comparing::Comparing;
use crate::document;
use crate::findings::{Finding, Findings};
use crate::judge::Case;
use crate::knobs::Knobs;
use crate::look::Look;
use crate::mode::{Mode, Slice};
use crate::model::Model;
use crate::orbit::{Kept, Orbit};
use crate::painter::{Painted, Painter, Picture, Request};
use crate::watch::Watch;
use crate::worker::{Build, News, Worker};

/// How often in a row devices are opened anew, without a picture between, before the processor takes over.
const MOST_RENEWALS: u32 = 3;

/// Frames of an animation.
const MOST_FRAMES: f64 = 20_000.0;

/// Wakes the window.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// One scene, open.
#[derive(Debug)]
pub struct Session {
    build: Build,
    worker: Worker,
    news: Receiver<News>,
    painter: Painter,
    painted: Receiver<Painted>,
    clerk: Clerk,
    outcomes: Receiver<Outcome>,
    watch: Watch,
    /// The order that a change on disk repeats.
    standing: Arc<Mutex<Build>>,
    /// The camera; `None` until the first scene says where it stands.
    orbit: Option<Orbit>,
    /// Whether the camera is the scene's own, and has not been moved by hand.
    follows: bool,
    /// What has been moved.
    pub knobs: Knobs,
    /// The time.
    pub clock: Clock,
    /// What is shown.
    pub mode: Mode,
    /// The plane of [`Mode::Slice`].
    pub slice: Slice,
    /// Whether axes and bounds are drawn over the picture.
    pub guides: bool,
    /// Rays for each pixel when all rests.
    pub samples: Option<u32>,
    /// The knob of the method, such as its tolerance, as a multiple of the scene's.
    pub tolerance: f64,
    /// Whether fine pictures are drawn however long they take.
    pub refine: bool,
    /// The last good scene.
    pub model: Option<Arc<Model>>,
    /// What is wrong with the text as it stands.
    pub findings: Findings,
    /// Why there is nothing newer to see, apart from findings.
    pub trouble: Option<String>,
    /// Why the last request gave no picture.
    pub no_picture: Option<String>,
    /// Whether a pipeline is being made for the text.
    pub building: bool,
    /// The last good picture.
    pub picture: Option<Box<Picture>>,
    /// Counts pictures.
    pub pictures: u64,
    /// What came of what was to be written, to be told once.
    pub remarks: Vec<String>,
    /// What is shown held against the oracle.
    pub comparing: Comparing,
    asked: Option<Request>,
    size: [u32; 2],
    /// Devices that were lost since the last picture.
    lost: u32,
}

impl Session {
    /// Opens a scene. `wake` is called, from other threads, when there is something to [`poll`](Self::poll).
    ///
    /// # Errors
    ///
    /// Where the system gives no thread.
    pub fn open(path: &Path, wake: Wake) -> std::io::Result<Self> {
        let build = Build::of(path);
        let (sender, news) = channel();
        let woken = Arc::clone(&wake);
        let worker = Worker::new(sender, move || woken())?;
        let (sender, painted) = channel();
        let woken = Arc::clone(&wake);
        let painter = Painter::new(sender, move || woken())?;
        let (sender, outcomes) = channel();
        let woken = Arc::clone(&wake);
        let clerk = Clerk::new(sender, move || woken())?;
        let comparing = Comparing::new(move || wake())?;
        let standing = Arc::new(Mutex::new(build.clone()));
        let (orders, repeated) = (worker.orders(), Arc::clone(&standing));
        let watch = Watch::new(move || orders.put(lock(&repeated).clone()));
        let mut session = Self {
            build,
            worker,
            news,
            painter,
            painted,
            clerk,
            outcomes,
            watch,
            standing,
            orbit: None,
            follows: true,
            knobs: Knobs::default(),
            clock: Clock::default(),
            mode: Mode::default(),
            slice: Slice::default(),
            guides: false,
            samples: None,
            tolerance: 1.0,
            refine: true,
            model: None,
            findings: Findings::default(),
            trouble: None,
            no_picture: None,
            building: false,
            picture: None,
            pictures: 0,
            remarks: Vec::new(),
            comparing,
            asked: None,
            size: [16, 9],
            lost: 0,
        };
        session.watch_own_folder();
        session.order();
        Ok(session)
    }

    /// The scene's file.
    pub fn path(&self) -> &Path {
        &self.build.path
    }

    /// How it is built.
    pub fn build(&self) -> &Build {
        &self.build
    }

    /// Builds it otherwise.
    pub fn set_build(&mut self, change: impl FnOnce(&mut Build)) {
        let mut build = self.build.clone();
        change(&mut build);
        if build != self.build {
            self.build = build;
            self.order();
        }
    }

    /// Shows another scene in its place.
    pub fn open_other(&mut self, path: PathBuf) {
        self.build = Build { path, method: None, parallel: None, ..self.build.clone() };
        (self.orbit, self.model, self.picture, self.asked) = (None, None, None, None);
        (self.knobs, self.clock) = (Knobs::default(), Clock::default());
        (self.findings, self.trouble, self.no_picture) = (Findings::default(), None, None);
        (self.follows, self.tolerance) = (true, 1.0);
        self.comparing.forget();
        self.watch_own_folder();
        self.order();
    }

    /// Puts camera and params where they were left.
    pub fn recall(&mut self, camera: Option<&Kept>, params: &BTreeMap<String, [f64; 4]>) {
        if let Some(orbit) = camera.and_then(Orbit::of_kept) {
            (self.orbit, self.follows) = (Some(orbit), false);
        }
        self.knobs.params = params.clone();
    }

    /// The camera where it has been moved.
    pub fn moved_camera(&self) -> Option<Kept> {
        self.orbit.filter(|_| !self.follows).map(|orbit| orbit.kept())
    }

    /// Where it stands and how it looks, where it has been moved.
    pub fn moved_pose(&self) -> Option<Pose> {
        self.orbit.filter(|_| !self.follows).map(|orbit| orbit.pose())
    }

    /// The values of frames from time 0 on, each of which lasts so many hundredths of a second.
    pub fn frames(&self, model: &Model, seconds: f64, hundredths: u32) -> Vec<FrameValues> {
        let length = f64::from(hundredths) / 100.0;
        let count = (seconds / length).round().clamp(1.0, MOST_FRAMES) as u32;
        let time = |number: u32| Clock { time: f64::from(number) * length, ..self.clock };
        let times = (0..count).map(time);
        times.map(|clock| self.knobs.frame(model, clock.time, clock.frame())).collect()
    }

    /// Where files are written.
    pub fn clerk(&self) -> &Clerk {
        &self.clerk
    }

    /// Takes in what the threads have to tell. Gives whether anything changed.
    pub fn poll(&mut self) -> bool {
        let mut changed = false;
        while let Ok(news) = self.news.try_recv() {
            self.hear(news);
            changed = true;
        }
        while let Ok(painted) = self.painted.try_recv() {
            self.see(painted);
            changed = true;
        }
        while let Ok(outcome) = self.outcomes.try_recv() {
            self.remarks.push(outcome.unwrap_or_else(|why| why));
            changed = true;
        }
        changed | self.comparing.poll()
    }

    /// Asks for a picture of this size, unless it is what was asked for last. `moving`: the next is likely
    /// to differ.
    pub fn ask(&mut self, size: [u32; 2], moving: bool) {
        if size.contains(&0) {
            return;
        }
        self.size = size;
        self.follow();
        let (Some(model), Some(mut orbit)) = (self.model.clone(), self.orbit) else { return };
        let parallel = orbit.is_parallel();
        if model.parallel != parallel {
            // Until there is a shader for these rays, the others move on.
            self.set_build(|build| build.parallel = Some(parallel));
            orbit.set_parallel(model.parallel);
        }
        let request = Request {
            frame: self.values(&model),
            pose: orbit.pose(),
            size,
            mode: self.mode,
            slice: self.slice,
            moving,
            refine: self.refine,
            samples: self.samples(&model),
            tolerance: self.tolerance,
            model,
        };
        if self.asked.as_ref().is_some_and(|asked| asked.is(&request)) {
            self.compare_what_rests();
            return;
        }
        self.asked = Some(request.clone());
        self.painter.ask(request);
    }

    /// What is asked for, as the judge takes it.
    fn case(&self, all: bool) -> Option<Case> {
        let Request { model, frame, pose, size, tolerance, .. } = self.asked.as_ref()?.clone();
        Some(Case { model, frame, pose, size, tolerance, all })
    }

    /// Has what is shown compared with the oracle, or all methods.
    pub fn compare(&mut self, all: bool) {
        if let Some(case) = self.case(all) {
            self.comparing.ask(case);
        }
    }

    /// Whether the figures are those of what is asked for.
    pub fn judgement_is_of_this(&self) -> bool {
        let now = self.case(false);
        self.comparing.judgement.as_ref().zip(now).is_some_and(|(it, now)| it.case.draws_as(&now))
    }

    /// After drawing, so that both do not share the processor.
    fn compare_what_rests(&mut self) {
        let rests = |picture: &Picture| {
            let asked = self.asked.as_ref();
            picture.finished && asked.is_some_and(|asked| asked.is(&picture.request))
        };
        if self.comparing.at_rest
            && self.picture.as_deref().is_some_and(rests)
            && let Some(case) = self.case(false)
        {
            self.comparing.ask_once(case);
        }
    }

    /// Rays for each pixel when all rests.
    pub fn samples(&self, model: &Model) -> u32 {
        self.samples.or(model.scene.program().settings.samples).unwrap_or(4)
    }

    /// Whether the picture depends on time.
    pub fn moves(&self) -> bool {
        self.model.as_ref().is_some_and(|model| model.moves)
    }

    /// The values of the frame as it stands.
    pub fn values(&self, model: &Model) -> FrameValues {
        self.knobs.frame(model, self.clock.time, self.clock.frame())
    }

    /// The camera that the scene has, or one that sees all of it.
    pub fn home(&self) -> Option<Pose> {
        let model = self.model.as_ref()?;
        let values = self.values(model);
        let (program, bounds) = (model.scene.program(), model.scene.bounds_at(&values));
        Pose::new(program, &values, bounds, self.aspect()).ok()
    }

    /// The camera.
    pub fn orbit(&self) -> Option<&Orbit> {
        self.orbit.as_ref()
    }

    /// The camera, to be moved by hand: from then on it does not follow the scene's.
    pub fn move_camera(&mut self, change: impl FnOnce(&mut Orbit)) {
        if let Some(orbit) = &mut self.orbit {
            change(orbit);
            self.follows = false;
        }
    }

    /// Back to the scene's own camera.
    pub fn go_home(&mut self) {
        self.follows = true;
        self.follow();
    }

    /// Puts the camera where the scene's is, unless it has been moved.
    fn follow(&mut self) {
        if self.follows
            && let Some(pose) = self.home()
        {
            self.orbit = Some(Orbit::new(&pose));
        }
    }

    /// Whether the camera is the scene's own.
    pub fn follows(&self) -> bool {
        self.follows
    }

    /// Sees all of the scene, from where the camera looks.
    pub fn frame_all(&mut self) {
        let Some(model) = &self.model else { return };
        let (values, aspect) = (self.values(model), self.aspect());
        let bounds = model.scene.bounds_at(&values);
        self.move_camera(|orbit| orbit.frame(bounds, aspect));
    }

    /// What is at a place of the picture, from its upper left corner in parts of its sides.
    pub fn look(&self, place: [f64; 2]) -> Option<Look> {
        Look::at(self.picture.as_deref()?, place)
    }

    /// Where a finding is, as an absolute path where there is one.
    pub fn path_of(&self, finding: &Finding) -> PathBuf {
        document::path_of(&self.build.path, &finding.file)
    }

    /// Writes the numbers that have been moved into the scene's file, unless it has changed since. What came of it
    /// is among the [`remarks`](Self::remarks) later.
    pub fn write_literals(&self) {
        let Some(model) = &self.model else { return };
        let (before, after) = (model.text.clone(), self.knobs.rewritten(model));
        self.clerk.send(Errand::Rewrite { path: self.path().to_owned(), before, after });
    }

    fn aspect(&self) -> f64 {
        let [width, height] = self.size;
        f64::from(width) / f64::from(height)
    }

    fn watch_own_folder(&mut self) {
        let own = document::Imports::of(&self.build.path).folders();
        self.watch.set_folders(&own);
    }

    fn order(&self) {
        *lock(&self.standing) = self.build.clone();
        self.worker.order(self.build.clone());
    }

    fn hear(&mut self, news: News) {
        match news {
            News::Unreadable(why) => {
                self.building = false;
                let shown = if self.model.is_some() { "; showing what it was" } else { "" };
                self.trouble = Some(format!("{why}{shown}"));
                self.watch_own_folder();
            }
            News::Builds => self.building = true,
            News::Compiled { findings, folders, draws: _ } => {
                (self.findings, self.building, self.trouble) = (findings, false, None);
                let refused = self.watch.set_folders(&folders);
                if let Some(folder) = refused.first() {
                    self.trouble = Some(format!("changes in {} are not seen", folder.display()));
                }
            }
            News::Empty => {
                self.trouble =
                    Some("the scene draws nothing: a solid on a line of its own is drawn".into());
            }
            News::Failed(why) => (self.building, self.trouble) = (false, Some(why)),
            News::Ready(model) => self.take(model),
        }
    }

    fn take(&mut self, model: Arc<Model>) {
        self.building = false;
        let same_text = self.model.as_ref().is_some_and(|old| old.text == model.text);
        if !same_text {
            self.knobs.forget_literals();
        }
        let edits = self.model.is_some();
        let before = self.stated_camera();
        self.model = Some(model);
        let after = self.stated_camera();
        // Whoever edits the camera wants to see it.
        self.follows |= edits && after.is_some() && before != after;
        if self.orbit.is_none() {
            self.orbit = Some(Orbit::new(&Pose::fitted(None, 1.0)));
        }
    }

    /// The camera that the text states, at its defaults.
    fn stated_camera(&self) -> Option<Pose> {
        let model = self.model.as_ref()?;
        let program = model.scene.program();
        program.settings.camera?;
        Pose::new(program, &model.defaults(), None, 1.0).ok()
    }

    fn see(&mut self, painted: Painted) {
        match painted {
            Painted::Picture(picture) => {
                (self.no_picture, self.lost) = (None, 0);
                self.picture = Some(picture);
                self.pictures += 1;
            }
            Painted::Failed { message, machine, renewed } => {
                self.no_picture = Some(message);
                // Every request that a lost device met fails; new ones are ordered once.
                if machine && renewed == self.build.renewed && !self.build.on_cpu {
                    self.lost += 1;
                    let gives_up = self.lost > MOST_RENEWALS;
                    self.remarks.push(if gives_up {
                        format!("the device was lost {} times: the processor draws", self.lost)
                    } else {
                        "the device was lost and is opened anew".to_owned()
                    });
                    self.set_build(|build| {
                        (build.renewed, build.on_cpu) = (build.renewed + 1, gives_up)
                    });
                }
            }
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What is behind it is replaced whole or not at all.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
