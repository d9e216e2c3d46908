//! Notices that something in the scene's folders has changed. Which file it was does not matter: editors
//! write in place, or write another file and rename it, or delete and write anew; the worker reads the
//! texts and compares them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use notify::event::{AccessKind, AccessMode, ModifyKind, RenameMode};
use notify::{Config, Event, EventKind, PollWatcher, RecommendedWatcher, RecursiveMode, Watcher};

use crate::mailbox::Mailbox;

/// So long nothing more happens before a change is told that may be the first of several.
const QUIET: Duration = Duration::from_millis(4);
/// A change is told after so many quiet times at the latest, however busy the folder is.
const MOST_WAITS: u32 = 10;
/// How often the files are looked at where the system does not tell of changes.
const POLL: Duration = Duration::from_millis(500);

/// Watches folders until it is dropped.
pub struct Watch {
    system: Box<dyn Watcher + Send>,
    folders: BTreeSet<PathBuf>,
    /// Whether the last one left a whole file behind.
    events: Arc<Mailbox<bool>>,
    thread: Option<JoinHandle<()>>,
}

impl Watch {
    /// Calls `changed`, from a thread of its own, after each change.
    pub fn new(changed: impl Fn() + Send + 'static) -> Self {
        let events = Arc::new(Mailbox::default());
        let system = system(&events);
        let mailbox = Arc::clone(&events);
        let thread = std::thread::spawn(move || {
            while let Some(mut is_whole) = mailbox.take() {
                let mut waits = 0;
                while !is_whole && waits < MOST_WAITS && mailbox.wait(QUIET) {
                    waits += 1;
                    match mailbox.take() {
                        Some(next) => is_whole = next,
                        None => return,
                    }
                }
                changed();
            }
        });
        Self { system, folders: BTreeSet::new(), events, thread: Some(thread) }
    }

    /// Watches these folders, and no others; gives those that cannot be watched. A folder that was deleted
    /// and made again is another one, so those are watched anew.
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

impl Drop for Watch {
    fn drop(&mut self) {
        self.events.close();
        drop(self.thread.take().map(JoinHandle::join));
    }
}

impl std::fmt::Debug for Watch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Watch").field("folders", &self.folders).finish_non_exhaustive()
    }
}

/// The system's watcher, or one that looks now and then where there is none.
fn system(events: &Arc<Mailbox<bool>>) -> Box<dyn Watcher + Send> {
    let handler = |events: &Arc<Mailbox<bool>>| {
        let events = Arc::clone(events);
        move |event: notify::Result<Event>| {
            if let Some(event) = event.ok().filter(is_change) {
                events.put(is_whole(&event));
            }
        }
    };
    let config = Config::default();
    if let Ok(watcher) = RecommendedWatcher::new(handler(events), config) {
        return Box::new(watcher);
    }
    let config = config.with_poll_interval(POLL).with_compare_contents(true);
    match PollWatcher::new(handler(events), config) {
        Ok(watcher) => Box::new(watcher),
        Err(_) => Box::new(notify::NullWatcher),
    }
}

/// Whether a file is complete with it, so that nothing more need be waited for: closed by its writer, or renamed.
fn is_whole(event: &Event) -> bool {
    let closed = EventKind::Access(AccessKind::Close(AccessMode::Write));
    let renamed =
        [RenameMode::To, RenameMode::Both].map(|it| EventKind::Modify(ModifyKind::Name(it)));
    event.kind == closed || renamed.contains(&event.kind)
}

/// Reading is no change, but what the system tells of it looks the same: this would go on for ever.
fn is_change(event: &Event) -> bool {
    let written = EventKind::Access(AccessKind::Close(AccessMode::Write));
    !event.kind.is_access() || event.kind == written
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use super::*;

    /// Long enough for a busy machine; reached only where the test fails.
    const PATIENCE: Duration = Duration::from_secs(60);

    fn watched(folder: &Path) -> (Watch, Receiver<()>) {
        let (sender, receiver) = channel();
        let mut watch = Watch::new(move || sender.send(()).unwrap_or_default());
        assert!(watch.set_folders(&BTreeSet::from([folder.to_owned()])).is_empty());
        (watch, receiver)
    }

    #[test]
    fn every_way_of_saving_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "sphere(1)").unwrap();
        let (_watch, changes) = watched(folder.path());
        // In place, by renaming another file over it, deleted, made again.
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
            changes.recv_timeout(PATIENCE).unwrap();
        }
    }

    #[test]
    fn reading_is_no_change() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sdf");
        std::fs::write(&path, "sphere(1)").unwrap();
        let (watch, changes) = watched(folder.path());
        drop(std::fs::read_to_string(&path).unwrap());
        // Dropping ends the thread, so whatever it had noticed has been told by then.
        drop(watch);
        assert!(changes.try_recv().is_err());
    }

    #[test]
    fn folders_that_are_not_there_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing");
        let (mut watch, _changes) = watched(folder.path());
        assert_eq!(watch.set_folders(&BTreeSet::from([missing.clone()])), [missing]);
    }
}
