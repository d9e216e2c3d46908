//! Serves files over HTTP to a browser on this machine.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A server of the files in a folder and of additional files.
pub struct Server {
    address: SocketAddr,
    files: Arc<Files>,
}

struct Files {
    folder: PathBuf,
    /// The additional files by path, without a slash at the start. They take precedence.
    added: Mutex<BTreeMap<String, Vec<u8>>>,
}

impl Server {
    /// Starts a server that runs until the process ends.
    pub fn start(folder: &Path) -> std::io::Result<Self> {
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let address = listener.local_addr()?;
        let added = Mutex::default();
        let files = Arc::new(Files { folder: folder.to_owned(), added });
        let served = Arc::clone(&files);
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let files = Arc::clone(&served);
                // Browsers open connections in advance and may send no request.
                std::thread::spawn(move || files.answer(&stream));
            }
        });
        Ok(Self { address, files })
    }

    /// Returns the address of a file. Pages of `localhost` may use WebGPU without encryption.
    pub fn url(&self, path: &str) -> String {
        format!("http://localhost:{}/{path}", self.address.port())
    }

    /// Adds a file, which takes precedence over the folder's.
    pub fn put(&self, path: &str, bytes: Vec<u8>) {
        self.files.added().insert(path.to_owned(), bytes);
    }
}

impl Files {
    fn added(&self) -> std::sync::MutexGuard<'_, BTreeMap<String, Vec<u8>>> {
        self.added.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn find(&self, path: &str) -> Option<Vec<u8>> {
        let laid = self.added().get(path).cloned();
        laid.or_else(|| std::fs::read(self.folder.join(path)).ok())
    }

    fn answer(&self, mut stream: &TcpStream) -> Option<()> {
        let mut request = BufReader::new(stream).lines();
        let asked = request.next()?.ok()?;
        while !request.next()?.ok()?.is_empty() {}
        let path = asked.split_whitespace().nth(1)?;
        let path = path.split('?').next()?.trim_start_matches('/');
        let (status, bytes) = match self.find(path) {
            Some(bytes) => ("200 OK", bytes),
            None => ("404 Not Found", Vec::new()),
        };
        let head = format!(
            "HTTP/1.1 {status}\r\nContent-Type: {}\r\nContent-Length: {}\r\n\
             Cache-Control: no-store\r\nConnection: close\r\n\r\n",
            kind(path),
            bytes.len()
        );
        stream.write_all(head.as_bytes()).ok()?;
        stream.write_all(&bytes).ok()
    }
}

fn kind(path: &str) -> &'static str {
    match Path::new(path).extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js" | "mjs") => "text/javascript; charset=utf-8",
        Some("json") => "application/json",
        Some("css") => "text/css",
        Some("wasm") => "application/wasm",
        _ => "text/plain; charset=utf-8",
    }
}
