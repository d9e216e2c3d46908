//! A channel that keeps the latest message only: sending replaces a message that nobody has taken.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A channel that holds at most one message, the latest.
#[derive(Debug)]
pub struct LatestChannel<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct State<T> {
    latest: Option<T>,
    closed: bool,
}

impl<T> Default for LatestChannel<T> {
    fn default() -> Self {
        Self { state: Mutex::new(State { latest: None, closed: false }), changed: Condvar::new() }
    }
}

impl<T> LatestChannel<T> {
    /// Sends a message, which replaces one that has not been received.
    pub fn send(&self, message: T) {
        self.state().latest = Some(message);
        self.changed.notify_all();
    }

    /// Waits for a message. `None` once the channel is closed.
    pub fn recv(&self) -> Option<T> {
        let waiting = |state: &mut State<T>| state.latest.is_none() && !state.closed;
        let state = self.changed.wait_while(self.state(), waiting);
        let mut state = state.unwrap_or_else(PoisonError::into_inner);
        if state.closed { None } else { state.latest.take() }
    }

    /// Returns true if a message waits or the channel is closed: current work may be given up.
    pub fn is_interrupted(&self) -> bool {
        let state = self.state();
        state.latest.is_some() || state.closed
    }

    /// Waits until [`Self::is_interrupted`], at most `timeout`, and returns its value.
    pub fn wait(&self, timeout: Duration) -> bool {
        let waiting = |state: &mut State<T>| state.latest.is_none() && !state.closed;
        drop(self.changed.wait_timeout_while(self.state(), timeout, waiting));
        self.is_interrupted()
    }

    /// Closes the channel: every wait ends, now and later.
    pub fn close(&self) {
        self.state().closed = true;
        self.changed.notify_all();
    }

    fn state(&self) -> MutexGuard<'_, State<T>> {
        // A message is stored whole or not at all, so a poisoned lock holds a valid state.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_latest_message_is_kept() {
        let channel = LatestChannel::default();
        assert!(!channel.is_interrupted());
        channel.send(1);
        channel.send(2);
        assert!(channel.is_interrupted());
        assert_eq!(channel.recv(), Some(2));
        assert!(!channel.is_interrupted());
    }

    #[test]
    fn closing_ends_waiting() {
        let channel = LatestChannel::<i32>::default();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| channel.recv());
            channel.close();
            assert_eq!(waiting.join().unwrap(), None);
        });
        assert!(channel.is_interrupted());
    }
}
