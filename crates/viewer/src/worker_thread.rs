//! A thread that handles the latest message sent to it.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use crate::latest_channel::LatestChannel;

/// The longest time that dropping a worker waits for the current message.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(3);
/// The nice value of a worker: from 0, which is normal, to 19.
#[cfg(target_os = "linux")]
const NICE: i32 = 5;
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
            lower_priority();
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

/// Gives way to the window's thread, which does little, if there are fewer cores than busy threads.
/// Threads that this one starts inherit that, such as those of a software driver. Only on Linux
/// does `rustix` set the priority of a single thread.
fn lower_priority() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{getpriority_process, setpriority_process};
        let own = rustix::thread::gettid();
        // A process that was started with a lower priority keeps it. If the call fails, the window
        // is slower, but works.
        if getpriority_process(Some(own)).is_ok_and(|nice| nice < NICE) {
            let _ = setpriority_process(Some(own), NICE);
        }
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

    #[cfg(target_os = "linux")]
    #[test]
    fn a_worker_gives_way_to_the_window() {
        let nice = || rustix::process::getpriority_process(Some(rustix::thread::gettid())).unwrap();
        let before = nice();
        let (sender, values) = std::sync::mpsc::channel();
        let worker =
            WorkerThread::start("test", |_| move |()| sender.send(nice()).unwrap()).unwrap();
        worker.channel().send(());
        assert_eq!(values.recv(), Ok(NICE.max(before)));
        assert_eq!(nice(), before);
    }

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
