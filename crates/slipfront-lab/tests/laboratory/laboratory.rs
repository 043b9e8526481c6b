//! A server for one test.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::sync::Mutex;
use std::thread::JoinHandle;
use std::time::Duration;

use slipfront_lab::{Laboratory, Patience, ServerOptions, Start};
use tempfile::TempDir;
use tokio::sync::oneshot;

/// Time limit of what takes a second at most on an idle machine: only a test that fails waits for it.
pub(crate) const TIMEOUT: Duration = Duration::from_secs(120);

/// Sentences that all servers of the tests have printed in their terminals.
static TOLD: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// A server that ends with the test.
pub(crate) struct Served {
    pub(crate) port: u16,
    pub(crate) token: String,
    /// The page that leads a browser here.
    pub(crate) start_page: PathBuf,
    folder: TempDir,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Served {
    pub(crate) fn new() -> Self {
        Self::with(Start::default())
    }

    pub(crate) fn with(start: Start) -> Self {
        Self::patient(start, Patience::default())
    }

    /// A server that waits one second for clients that send or read nothing.
    pub(crate) fn impatient() -> Self {
        let second = Duration::from_secs(1);
        let patience = Patience {
            header: second,
            message: second,
            end: second,
        };
        Self::patient(Start::default(), patience)
    }

    fn patient(start: Start, patience: Patience) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let laboratory = Laboratory::bind(ServerOptions {
            start,
            results: folder.path().join("results"),
            allow_files: Vec::new(),
            print: |sentence| TOLD.lock().unwrap().push(sentence.to_owned()),
            port: 0,
            threads: 1,
            patience,
        });
        let laboratory = laboratory.unwrap();
        let address = laboratory.address(None);
        let (_, rest) = address.split_once("127.0.0.1:").unwrap();
        let (port, token) = rest.split_once("/#token=").unwrap();
        let start_page = laboratory.start_page(None).unwrap();
        let (stop, stopped) = oneshot::channel();
        let thread = std::thread::spawn(move || {
            let stopped = async {
                let _ = stopped.await;
            };
            laboratory.serve(stopped).unwrap();
        });
        Self {
            port: port.parse().unwrap(),
            token: token.to_owned(),
            start_page,
            folder,
            stop: Some(stop),
            thread: Some(thread),
        }
    }

    pub(crate) fn results(&self) -> PathBuf {
        self.folder.path().join("results")
    }

    /// Sentences in the terminal about this folder in the results of this server.
    pub(crate) fn told_of(&self, name: &str) -> Vec<String> {
        let folder = self.results().join(name).display().to_string();
        let mut told = TOLD.lock().unwrap().clone();
        told.retain(|sentence| sentence.contains(&folder));
        told
    }

    pub(crate) fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(TIMEOUT)).unwrap();
        stream
    }

    /// The answer to these bytes, if the server closes the connection after it.
    pub(crate) fn answer(&self, request: &str) -> String {
        let mut stream = self.connect();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// The status of a request for a file, with this host and further lines.
    pub(crate) fn status(&self, path: &str, host: &str, lines: &str) -> u16 {
        let answer = self.answer(&format!(
            "GET {path} HTTP/1.1\r\nHost: {host}\r\n{lines}Connection: close\r\n\r\n"
        ));
        answer.split(' ').nth(1).unwrap().parse().unwrap()
    }

    pub(crate) fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// Ends the server, and waits until it has ended.
    pub(crate) fn stop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop();
    }
}
