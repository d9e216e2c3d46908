//! Watches the scene's folders for changes. Which file changed does not matter: editors write in
//! place, write another file and rename it, or delete and write again. The compile worker reads the
//! files and compares them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use notify::event::{AccessKind, AccessMode, ModifyKind, RenameMode};
use notify::{Config, Event, EventKind, PollWatcher, RecommendedWatcher, RecursiveMode, Watcher};

use crate::latest_channel::LatestChannel;

/// The quiet time after which a change that may be the first of several is reported.
const QUIET_PERIOD: Duration = Duration::from_millis(4);
/// A change is reported after this many quiet periods at the latest, however busy the folder is.
const MAX_WAITS: u32 = 10;
/// The interval of comparing files on a system without change notifications.
const POLL_INTERVAL: Duration = Duration::from_millis(500);

/// Watches folders until it is dropped.
pub struct FileWatcher {
    system: Box<dyn Watcher + Send>,
    folders: BTreeSet<PathBuf>,
    /// Changes; true if the change left a complete file.
    events: Arc<LatestChannel<bool>>,
    thread: Option<JoinHandle<()>>,
}

impl FileWatcher {
    /// Starts a thread that calls `changed` after each change.
    pub fn new(changed: impl Fn() + Send + 'static) -> Self {
        let events = Arc::new(LatestChannel::default());
        let system = system(&events);
        let received = Arc::clone(&events);
        let thread = std::thread::spawn(move || {
            while let Some(mut is_whole) = received.recv() {
                let mut waits = 0;
                while !is_whole && waits < MAX_WAITS && received.wait(QUIET_PERIOD) {
                    waits += 1;
                    match received.recv() {
                        Some(next) => is_whole = next,
                        None => return,
                    }
                }
                changed();
            }
        });
        Self { system, folders: BTreeSet::new(), events, thread: Some(thread) }
    }

    /// Watches these folders and no others; returns those that cannot be watched. A folder that was
    /// deleted and created again is a different one to the system, so all are registered again.
    pub fn set_folders(&mut self, folders: &BTreeSet<PathBuf>) -> Vec<PathBuf> {
        let gone: Vec<&PathBuf> = self.folders.difference(folders).collect();
        gone.into_iter().for_each(|folder| drop(self.system.unwatch(folder)));
        let (watched, refused): (BTreeSet<_>, BTreeSet<_>) =
            folders.iter().cloned().partition(|folder| self.watch(folder));
        self.folders = watched;
        refused.into_iter().collect()
    }

    fn watch(&mut self, folder: &Path) -> bool {
        self.system.watch(folder, RecursiveMode::NonRecursive).is_ok()
    }
}

impl Drop for FileWatcher {
    fn drop(&mut self) {
        self.events.close();
        drop(self.thread.take().map(JoinHandle::join));
    }
}

impl std::fmt::Debug for FileWatcher {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Watch").field("folders", &self.folders).finish_non_exhaustive()
    }
}

/// The system's change notifications, or polling if there are none.
fn system(events: &Arc<LatestChannel<bool>>) -> Box<dyn Watcher + Send> {
    let handler = |events: &Arc<LatestChannel<bool>>| {
        let events = Arc::clone(events);
        move |event: notify::Result<Event>| {
            if let Some(event) = event.ok().filter(is_change) {
                events.send(is_whole(&event));
            }
        }
    };
    let config = Config::default();
    if let Ok(watcher) = RecommendedWatcher::new(handler(events), config) {
        return Box::new(watcher);
    }
    let config = config.with_poll_interval(POLL_INTERVAL).with_compare_contents(true);
    match PollWatcher::new(handler(events), config) {
        Ok(watcher) => Box::new(watcher),
        Err(_) => Box::new(notify::NullWatcher),
    }
}

/// Returns true if the event leaves a complete file, closed by its writer or renamed, so that there
/// is nothing more to wait for.
fn is_whole(event: &Event) -> bool {
    let closed = EventKind::Access(AccessKind::Close(AccessMode::Write));
    let renamed =
        [RenameMode::To, RenameMode::Both].map(|it| EventKind::Modify(ModifyKind::Name(it)));
    event.kind == closed || renamed.contains(&event.kind)
}

/// Returns true if the event may change a file. Reading causes events too: reporting those would
/// make the compile worker read the files again without end.
fn is_change(event: &Event) -> bool {
    let written = EventKind::Access(AccessKind::Close(AccessMode::Write));
    !event.kind.is_access() || event.kind == written
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use super::*;

    /// Long enough for a busy machine; reached only if a test fails.
    const TIMEOUT: Duration = Duration::from_secs(60);

    fn watched(folder: &Path) -> (FileWatcher, Receiver<()>) {
        let (sender, receiver) = channel();
        let mut watch = FileWatcher::new(move || sender.send(()).unwrap_or_default());
        assert!(watch.set_folders(&BTreeSet::from([folder.to_owned()])).is_empty());
        (watch, receiver)
    }

    #[test]
    fn every_way_of_saving_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "sphere(1)").unwrap();
        let (_watch, changes) = watched(folder.path());
        // Written in place, replaced by renaming, deleted, created again.
        let aside = folder.path().join("a.sdf~");
        let steps: [&dyn Fn(); 4] = [
            &|| std::fs::write(&path, "sphere(2)").unwrap(),
            &|| {
                std::fs::write(&aside, "sphere(3)").unwrap();
                std::fs::rename(&aside, &path).unwrap();
            },
            &|| std::fs::remove_file(&path).unwrap(),
            &|| std::fs::write(&path, "sphere(4)").unwrap(),
        ];
        for step in steps {
            while changes.try_recv().is_ok() {}
            step();
            changes.recv_timeout(TIMEOUT).unwrap();
        }
    }

    #[test]
    fn reading_is_not_reported_as_a_change() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "sphere(1)").unwrap();
        let (watch, changes) = watched(folder.path());
        drop(std::fs::read_to_string(&path).unwrap());
        // Dropping joins the thread, so every change has been reported by then.
        drop(watch);
        assert!(changes.try_recv().is_err());
    }

    #[test]
    fn missing_folders_are_returned() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing");
        let (mut watch, _changes) = watched(folder.path());
        assert_eq!(watch.set_folders(&BTreeSet::from([missing.clone()])), [missing]);
    }
}
