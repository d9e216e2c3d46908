//! A box that holds the newest letter only, and a thread that takes them: what it has not taken when the next comes is
//! replaced.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What an attendant is at may take so long when it is dropped.
const PATIENCE: Duration = Duration::from_secs(3);
/// Most of what input controls in depth is bounded by the compiler; this is room for that.
const STACK: usize = 16 << 20;

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

/// A thread that serves one letter after the other, until this is dropped.
#[derive(Debug)]
pub struct Attendant<T> {
    mailbox: Arc<Mailbox<T>>,
    /// Of a sender that the thread has until it ends.
    ended: Receiver<()>,
}

impl<T: Send + 'static> Attendant<T> {
    /// Starts it. `begin` is given the box, so that what serves can see whether a newer letter waits.
    ///
    /// # Errors
    ///
    /// Where the system gives no thread.
    pub fn start<S>(name: &str, begin: impl FnOnce(Arc<Mailbox<T>>) -> S) -> std::io::Result<Self>
    where
        S: FnMut(T) + Send + 'static,
    {
        let mailbox = Arc::new(Mailbox::default());
        let mut serve = begin(Arc::clone(&mailbox));
        let letters = Arc::clone(&mailbox);
        let (until_end, ended) = channel();
        let run = move || {
            while let Some(letter) = letters.take() {
                serve(letter);
            }
            // What it holds of a driver goes first.
            drop(serve);
            drop::<Sender<()>>(until_end);
        };
        std::thread::Builder::new().name(name.to_owned()).stack_size(STACK).spawn(run)?;
        Ok(Self { mailbox, ended })
    }

    /// The way in.
    pub fn mailbox(&self) -> &Arc<Mailbox<T>> {
        &self.mailbox
    }
}

impl<T> Drop for Attendant<T> {
    fn drop(&mut self) {
        self.mailbox.close();
        // A process that ends takes its drivers away from under threads that are in them. But one may compile for minutes.
        let _ = self.ended.recv_timeout(PATIENCE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_served_until_nobody_is_there_to_send_them() {
        let (sender, served) = std::sync::mpsc::channel();
        let attendant =
            Attendant::start("test", |_| move |letter: i32| sender.send(letter).unwrap()).unwrap();
        attendant.mailbox().put(1);
        assert_eq!(served.recv(), Ok(1));
        drop(attendant);
        // The thread is gone, and the sender with it.
        assert!(served.recv().is_err());
    }

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
