//! Files over HTTP, for a browser on this machine.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A server of the files in a folder and of others that lie over them.
pub struct Server {
    address: SocketAddr,
    files: Arc<Files>,
}

struct Files {
    folder: PathBuf,
    /// By path, without the slash at its start.
    laid_over: Mutex<BTreeMap<String, Vec<u8>>>,
}

impl Server {
    /// Serves until the process ends.
    pub fn start(folder: &Path) -> std::io::Result<Self> {
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let address = listener.local_addr()?;
        let laid_over = Mutex::default();
        let files = Arc::new(Files { folder: folder.to_owned(), laid_over });
        let served = Arc::clone(&files);
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let files = Arc::clone(&served);
                // Browsers open connections ahead, on which nothing is asked.
                std::thread::spawn(move || files.answer(&stream));
            }
        });
        Ok(Self { address, files })
    }

    /// Address of a file. Pages of `localhost` may use WebGPU without encryption.
    pub fn url(&self, path: &str) -> String {
        format!("http://localhost:{}/{path}", self.address.port())
    }

    /// Lays a file over the folder's.
    pub fn lay(&self, path: &str, bytes: Vec<u8>) {
        self.files.laid_over().insert(path.to_owned(), bytes);
    }
}

impl Files {
    fn laid_over(&self) -> std::sync::MutexGuard<'_, BTreeMap<String, Vec<u8>>> {
        self.laid_over.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn find(&self, path: &str) -> Option<Vec<u8>> {
        let laid = self.laid_over().get(path).cloned();
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
