//! A thread that handles the latest message sent to it.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use crate::latest_channel::LatestChannel;

/// The longest time that dropping a worker waits for the current message.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(3);
/// Stack size in bytes. The compiler bounds the depth of its recursion; this is enough for it.
const STACK_BYTES: usize = 16 << 20;

/// A thread that handles one message after the other until this is dropped. A message that is
/// still waiting when the next one is sent is replaced by it.
#[derive(Debug)]
pub struct WorkerThread<T> {
    channel: Arc<LatestChannel<T>>,
    /// Disconnected when the thread ends.
    ended: Receiver<()>,
}

impl<T: Send + 'static> WorkerThread<T> {
    /// Starts the thread. `init` receives the channel, so that the handler it returns can see
    /// whether a newer message waits.
    ///
    /// # Errors
    ///
    /// The system cannot start a thread.
    pub fn start<F>(
        name: &str,
        init: impl FnOnce(Arc<LatestChannel<T>>) -> F,
    ) -> std::io::Result<Self>
    where
        F: FnMut(T) + Send + 'static,
    {
        let messages = Arc::new(LatestChannel::default());
        let mut handle = init(Arc::clone(&messages));
        let received = Arc::clone(&messages);
        let (until_end, ended) = channel();
        let run = move || {
            while let Some(message) = received.recv() {
                handle(message);
            }
            // Driver objects are released before the end is signalled.
            drop(handle);
            drop::<Sender<()>>(until_end);
        };
        std::thread::Builder::new().name(name.to_owned()).stack_size(STACK_BYTES).spawn(run)?;
        Ok(Self { channel: messages, ended })
    }

    /// The channel on which the thread receives.
    pub fn channel(&self) -> &Arc<LatestChannel<T>> {
        &self.channel
    }
}

impl<T> Drop for WorkerThread<T> {
    fn drop(&mut self) {
        self.channel.close();
        // A process that exits unloads its drivers while threads may still run in them, so wait for
        // the thread. The wait is bounded because a driver may compile for minutes.
        let _ = self.ended.recv_timeout(SHUTDOWN_TIMEOUT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_handled_until_the_worker_is_dropped() {
        let (sender, handled) = std::sync::mpsc::channel();
        let worker =
            WorkerThread::start("test", |_| move |message: i32| sender.send(message).unwrap())
                .unwrap();
        worker.channel().send(1);
        assert_eq!(handled.recv(), Ok(1));
        drop(worker);
        // The thread is gone, and its sender with it.
        assert!(handled.recv().is_err());
    }
}
