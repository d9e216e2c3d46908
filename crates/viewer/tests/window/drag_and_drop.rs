//! Drops a file on a window as a file manager does, with version 5 of the XDND protocol.

use std::path::Path;
use std::time::{Duration, Instant};

use libtest_mimic::Failed;
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConnectionExt, CreateWindowAux, EventMask, PropMode,
    SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;
use x11rb::{CURRENT_TIME, NONE};

use crate::display::{TIMEOUT, expect};

const VERSION: u32 = 5;

/// The program that the file comes from.
struct Source {
    connection: RustConnection,
    window: Window,
    target: Window,
}

impl Source {
    fn new(display: &str, target: Window) -> Result<Self, Failed> {
        let (connection, screen) = x11rb::connect(Some(display))?;
        let root = connection.setup().roots.get(screen).ok_or("no screen")?.root;
        let window = connection.generate_id()?;
        let (class, aux) = (WindowClass::INPUT_ONLY, CreateWindowAux::new());
        connection.create_window(0, window, root, 0, 0, 1, 1, 0, class, 0, &aux)?.check()?;
        Ok(Self { connection, window, target })
    }

    fn atom(&self, name: &str) -> Result<u32, Failed> {
        Ok(self.connection.intern_atom(false, name.as_bytes())?.reply()?.atom)
    }

    /// Sends a message of the protocol; each begins with the source window.
    fn send(&self, what: &str, [a, b, c, d]: [u32; 4]) -> Result<(), Failed> {
        let data = [self.window, a, b, c, d];
        let event = ClientMessageEvent::new(32, self.target, self.atom(what)?, data);
        Ok(self.connection.send_event(false, self.target, EventMask::NO_EVENT, event)?.check()?)
    }

    /// Answers a request for the dragged data.
    fn answer(&self, request: &SelectionRequestEvent, text: &str) -> Result<(), Failed> {
        let SelectionRequestEvent { time, requestor, selection, target, property, .. } = *request;
        let bytes = text.as_bytes();
        self.connection
            .change_property8(PropMode::REPLACE, requestor, property, target, bytes)?
            .check()?;
        let (response_type, sequence) = (SELECTION_NOTIFY_EVENT, 0);
        let event = SelectionNotifyEvent {
            response_type,
            sequence,
            time,
            requestor,
            selection,
            target,
            property,
        };
        Ok(self.connection.send_event(false, requestor, EventMask::NO_EVENT, event)?.check()?)
    }
}

/// Drops a file at a position of the screen.
pub fn drop_file(
    display: &str,
    target: Window,
    [x, y]: [u32; 2],
    file: &Path,
) -> Result<(), Failed> {
    let source = Source::new(display, target)?;
    let selection = source.atom("XdndSelection")?;
    source.connection.set_selection_owner(source.window, selection, CURRENT_TIME)?.check()?;
    let (list, none) = (source.atom("text/uri-list")?, u32::from(AtomEnum::NONE));
    source.send("XdndEnter", [VERSION << 24, list, none, none])?;
    let copies = source.atom("XdndActionCopy")?;
    source.send("XdndPosition", [0, x << 16 | y, CURRENT_TIME, copies])?;
    let text = format!("file://{}\r\n", file.display());
    let (status, finished) = (source.atom("XdndStatus")?, source.atom("XdndFinished")?);
    let (mut answered, mut accepted, mut dropped) = (false, false, false);
    let start = Instant::now();
    loop {
        match source.connection.poll_for_event()? {
            Some(Event::SelectionRequest(request)) => {
                source.answer(&request, &text)?;
                answered = true;
            }
            Some(Event::ClientMessage(message)) if message.type_ == status => {
                accepted = message.data.as_data32()[1] & 1 == 1;
                expect(accepted, "the window refuses the file")?;
            }
            Some(Event::ClientMessage(message)) if message.type_ == finished => return Ok(()),
            Some(_) => {}
            None => {
                expect(start.elapsed() < TIMEOUT, "the file is still being dragged")?;
                std::thread::sleep(Duration::from_millis(10));
            }
        }
        if answered && accepted && !dropped {
            source.send("XdndDrop", [0, CURRENT_TIME, NONE, NONE])?;
            dropped = true;
        }
    }
}
