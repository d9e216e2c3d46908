//! A box that holds the newest letter only: what a slow thread has not taken is replaced.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The newest letter, if it has not been taken.
#[derive(Debug)]
pub struct Mailbox<T> {
    slot: Mutex<Slot<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct Slot<T> {
    newest: Option<T>,
    closed: bool,
}

impl<T> Default for Mailbox<T> {
    fn default() -> Self {
        Self { slot: Mutex::new(Slot { newest: None, closed: false }), changed: Condvar::new() }
    }
}

impl<T> Mailbox<T> {
    /// Puts a letter in; one that still lies there is gone.
    pub fn put(&self, letter: T) {
        self.slot().newest = Some(letter);
        self.changed.notify_all();
    }

    /// Waits for a letter. `None` once the box is closed.
    pub fn take(&self) -> Option<T> {
        let waiting = |slot: &mut Slot<T>| slot.newest.is_none() && !slot.closed;
        let slot = self.changed.wait_while(self.slot(), waiting);
        let mut slot = slot.unwrap_or_else(PoisonError::into_inner);
        if slot.closed { None } else { slot.newest.take() }
    }

    /// Whether something lies there, or the box is closed: what is being done need not be finished.
    pub fn calls(&self) -> bool {
        let slot = self.slot();
        slot.newest.is_some() || slot.closed
    }

    /// Waits so long, or until [`Self::calls`].
    pub fn wait(&self, patience: Duration) -> bool {
        let waiting = |slot: &mut Slot<T>| slot.newest.is_none() && !slot.closed;
        drop(self.changed.wait_timeout_while(self.slot(), patience, waiting));
        self.calls()
    }

    /// Ends all waiting for good.
    pub fn close(&self) {
        self.slot().closed = true;
        self.changed.notify_all();
    }

    fn slot(&self) -> MutexGuard<'_, Slot<T>> {
        // A letter is put in whole or not at all, also by a thread that panics later.
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_newest_is_kept() {
        let mailbox = Mailbox::default();
        assert!(!mailbox.calls());
        mailbox.put(1);
        mailbox.put(2);
        assert!(mailbox.calls());
        assert_eq!(mailbox.take(), Some(2));
        assert!(!mailbox.calls());
    }

    #[test]
    fn closing_ends_waiting() {
        let mailbox = Mailbox::<i32>::default();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| mailbox.take());
            mailbox.close();
            assert_eq!(waiting.join().unwrap(), None);
        });
        assert!(mailbox.calls());
    }
}
