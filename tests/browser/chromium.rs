//! A Chromium without a window, controlled by the DevTools protocol.

use std::io::{BufRead, BufReader, ErrorKind};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use libtest_mimic::Failed;
use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// The environment variable that makes tests fail instead of being ignored if there is no Chromium.
const REQUIRE: &str = "SDFC_REQUIRE_CHROMIUM";
/// The environment variable that names the program if it is not one of [`PROGRAMS`].
const PROGRAM: &str = "SDFC_CHROMIUM";
const PROGRAMS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// The arguments that enable WebGPU and WebGL 2 on the CPU. With fewer of them, or with
/// `--disable-gpu`, adapters exist and compute, but every canvas stays blank.
const SOFTWARE_GPU: [&str; 5] = [
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--enable-features=Vulkan",
    "--use-vulkan=swiftshader",
    "--use-angle=swiftshader",
];

const QUIET: [&str; 10] = [
    "--headless",
    // Tests often run as root, where the sandbox is not available. Only pages of this repository
    // are opened.
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
    // Compiling a long shader takes the software adapter longer than the watchdog allows.
    "--disable-gpu-watchdog",
    "--remote-debugging-port=0",
];

/// The text on stderr before the address of the DevTools socket.
const LISTENING: &str = "DevTools listening on ";
/// The longest wait for an answer. Shaders are compiled for the CPU, one after the other.
const TIMEOUT: Duration = Duration::from_secs(240);

fn program() -> Option<String> {
    let named = std::env::var(PROGRAM).ok();
    let mut names = named.into_iter().chain(PROGRAMS.map(str::to_owned));
    names.find(|name| {
        let mut command = Command::new(name);
        command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    })
}

/// Returns true if tests fail when something that they need is missing.
pub fn is_required() -> bool {
    std::env::var_os(REQUIRE).is_some_and(|value| value == "1")
}

/// Returns true if tests that need Chromium are ignored: it is not installed and not required.
pub fn is_missing() -> bool {
    !is_required() && program().is_none()
}

/// What a page holds.
#[derive(Debug)]
pub struct Size {
    /// The nodes of its documents.
    pub nodes: u64,
    /// The bytes of its objects, without those of workers.
    pub heap: u64,
    pub workers: usize,
}

/// A browser with one page.
pub struct Chromium {
    process: Child,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    /// The session of the page.
    session: Option<String>,
    calls: u64,
    /// The errors of the page since it was opened.
    errors: Vec<String>,
    _profile: TempDir,
}

impl Chromium {
    pub fn start() -> Result<Self, Failed> {
        let program = program().ok_or("no Chromium is installed")?;
        let profile = TempDir::new()?;
        let mut command = Command::new(program);
        command.args(QUIET).args(SOFTWARE_GPU);
        command.arg(format!("--user-data-dir={}", profile.path().display())).arg("about:blank");
        let mut process = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn()?;
        let mut output = BufReader::new(process.stderr.take().ok_or("no stderr")?).lines();
        let address = output.find_map(|line| Some(line.ok()?.strip_prefix(LISTENING)?.to_owned()));
        // Its output must be read, or it would block.
        std::thread::spawn(move || output.for_each(drop));
        let address = address.ok_or("Chromium ended before it could be controlled")?;
        let (socket, _) = tungstenite::connect(address)?;
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(TIMEOUT))?;
        }
        let (session, errors, calls) = (None, Vec::new(), 0);
        let mut found = Self { process, socket, session, calls, errors, _profile: profile };
        let target = found.call("Target.createTarget", json!({ "url": "about:blank" }))?;
        let attached = json!({ "targetId": target["targetId"], "flatten": true });
        let attached = found.call("Target.attachToTarget", attached)?;
        found.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page.enable", "Runtime.enable", "Log.enable"] {
            found.call(domain, json!({}))?;
        }
        Ok(found)
    }

    /// Calls a method of the page, or of the browser before a page is attached.
    pub fn call(&mut self, method: &str, params: Value) -> Result<Value, Failed> {
        self.call_session(self.session.clone(), method, params)
    }

    /// Calls a method of the page with this session, or of the browser.
    fn call_session(
        &mut self,
        session: Option<String>,
        method: &str,
        params: Value,
    ) -> Result<Value, Failed> {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": params });
        if let Some(session) = session {
            call["sessionId"] = session.into();
        }
        self.socket.send(Message::text(call.to_string()))?;
        loop {
            let mut answer = self.receive()?;
            if answer["id"] != self.calls {
                self.errors.extend(page_error(&answer));
            } else if answer["error"].is_object() {
                return Err(format!("{method}: {}", answer["error"]).into());
            } else {
                return Ok(answer["result"].take());
            }
        }
    }

    fn receive(&mut self) -> Result<Value, Failed> {
        loop {
            match self.socket.read() {
                Ok(message) => return Ok(serde_json::from_str(message.to_text()?)?),
                // A process that was stopped and continues.
                Err(tungstenite::Error::Io(e)) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) => return Err(format!("{e}; {:?}", self.errors).into()),
            }
        }
    }

    /// Opens a page instead of the previous one, in a window of the given size.
    pub fn open(&mut self, url: &str, size: [u32; 2]) -> Result<(), Failed> {
        self.resize(size)?;
        self.errors.clear();
        let opened = self.call("Page.navigate", json!({ "url": url }))?;
        match opened["errorText"].as_str() {
            Some(why) => Err(format!("{url}: {why}").into()),
            None => Ok(()),
        }
    }

    /// Forgets the texts that the pages of a server have stored, so that the next page is opened as
    /// at a first visit.
    pub fn forget_texts_of(&mut self, server: &str) -> Result<(), Failed> {
        let params = json!({ "origin": server, "storageTypes": "local_storage" });
        self.call("Storage.clearDataForOrigin", params).map(drop)
    }

    /// Gives the window another size.
    pub fn resize(&mut self, [width, height]: [u32; 2]) -> Result<(), Failed> {
        let metrics =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", metrics)?;
        Ok(())
    }

    /// The number of the browser's process.
    pub fn process(&self) -> u32 {
        self.process.id()
    }

    /// Evaluates a JavaScript expression and waits for its value if it is a promise.
    pub fn evaluate(&mut self, expression: &str) -> Result<Value, Failed> {
        let params =
            json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let mut found = self.call("Runtime.evaluate", params)?;
        if found["exceptionDetails"].is_object() {
            return Err(format!("{}", found["exceptionDetails"]).into());
        }
        Ok(found["result"]["value"].take())
    }

    /// Calls a JavaScript function with an argument.
    pub fn apply(&mut self, function: &str, argument: &Value) -> Result<Value, Failed> {
        self.evaluate(&format!("({function})({argument})"))
    }

    /// Returns a PNG of an element of the page.
    pub fn screenshot(&mut self, selector: &str) -> Result<Vec<u8>, Failed> {
        let rectangle = self.apply(RECTANGLE, &selector.into())?;
        let params = json!({ "format": "png", "clip": rectangle });
        let found = self.call("Page.captureScreenshot", params)?;
        let text = found["data"].as_str().ok_or("no picture")?;
        Ok(data_encoding::BASE64.decode(text.as_bytes())?)
    }

    /// The errors of the page since it was opened.
    pub fn errors(&self) -> &[String] {
        &self.errors
    }

    /// Clicks on an element, at a fraction of its width and height.
    pub fn click(&mut self, selector: &str, [across, down]: [f64; 2]) -> Result<(), Failed> {
        let found = self.apply(RECTANGLE, &selector.into())?;
        let [x, y, width, height] =
            ["x", "y", "width", "height"].map(|side| found[side].as_f64().unwrap_or_default());
        let at = [x + across * (width - 1.0), y + down * (height - 1.0)];
        for kind in ["mousePressed", "mouseReleased"] {
            let mut params = json!({ "type": kind, "x": at[0], "y": at[1], "button": "left" });
            params["clickCount"] = 1.into();
            self.call("Input.dispatchMouseEvent", params)?;
        }
        Ok(())
    }

    /// Selects the whole text of the focused element.
    pub fn select_all(&mut self) -> Result<(), Failed> {
        self.key(json!({ "key": "a", "code": "KeyA", "windowsVirtualKeyCode": 65, "modifiers": 2 }))
    }

    /// Presses a key that has a name and a number.
    pub fn press(&mut self, name: &str, number: u32) -> Result<(), Failed> {
        self.key(json!({ "key": name, "code": name, "windowsVirtualKeyCode": number }))
    }

    fn key(&mut self, mut params: Value) -> Result<(), Failed> {
        for kind in ["rawKeyDown", "keyUp"] {
            params["type"] = kind.into();
            self.call("Input.dispatchKeyEvent", params.clone())?;
        }
        Ok(())
    }

    /// Inserts text at the cursor of the focused element.
    pub fn insert(&mut self, text: &str) -> Result<(), Failed> {
        self.call("Input.insertText", json!({ "text": text })).map(drop)
    }

    /// Lets pages read and write the clipboard.
    pub fn allow_clipboard(&mut self) -> Result<(), Failed> {
        let permissions = ["clipboardReadWrite", "clipboardSanitizedWrite"];
        let params = json!({ "permissions": permissions });
        self.call_session(None, "Browser.grantPermissions", params).map(drop)
    }

    /// Ends the process that draws for all pages. The browser starts another one.
    pub fn crash_gpu(&mut self) -> Result<(), Failed> {
        self.call_session(None, "Browser.crashGpuProcess", json!({})).map(drop)
    }

    /// Measures what the page holds after its garbage is collected.
    pub fn size(&mut self) -> Result<Size, Failed> {
        self.call("Performance.enable", json!({}))?;
        self.call("HeapProfiler.collectGarbage", json!({}))?;
        let found = self.call("Performance.getMetrics", json!({}))?;
        let metrics = found["metrics"].as_array().ok_or("no metrics")?;
        let metric = |name: &str| {
            let row = metrics.iter().find(|row| row["name"] == name);
            row.and_then(|row| row["value"].as_f64()).unwrap_or_default() as u64
        };
        let targets = self.call_session(None, "Target.getTargets", json!({ "filter": [{}] }))?;
        let targets = targets["targetInfos"].as_array().ok_or("no targets")?;
        let workers = targets.iter().filter(|target| target["type"] == "worker").count();
        Ok(Size { nodes: metric("Nodes"), heap: metric("JSHeapUsedSize"), workers })
    }

    /// Drags the mouse with its left button down.
    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) -> Result<(), Failed> {
        let steps = [("mousePressed", from), ("mouseMoved", to), ("mouseReleased", to)];
        for (kind, [x, y]) in steps {
            let params = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": 1 });
            self.call("Input.dispatchMouseEvent", params)?;
        }
        Ok(())
    }
}

/// Waits two frames, until the last drawing is on the screen, and returns the rectangle of an
/// element.
const RECTANGLE: &str = "async selector => {
    const frame = () => new Promise(requestAnimationFrame);
    await frame();
    await frame();
    const { x, y, width, height } = document.querySelector(selector).getBoundingClientRect();
    return { x, y, width, height, scale: 1 };
}";

/// Returns the error of the page that an event reports, if it reports one.
fn page_error(event: &Value) -> Option<String> {
    let params = &event["params"];
    match event["method"].as_str()? {
        "Runtime.exceptionThrown" => Some(params["exceptionDetails"].to_string()),
        "Runtime.consoleAPICalled" if params["type"] == "error" => Some(params["args"].to_string()),
        // Browsers request an icon that no page here has.
        "Log.entryAdded" if params["entry"]["level"] == "error" => {
            Some(params["entry"].to_string()).filter(|entry| !entry.contains("favicon.ico"))
        }
        _ => None,
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        self.session = None;
        // If it cannot be closed it is killed.
        if self.call("Browser.close", json!({})).is_err() {
            let _ = self.process.kill();
        }
        let _ = self.process.wait();
    }
}
