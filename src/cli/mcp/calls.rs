//! Calls of tools: each on a thread of its own, answered when its work is done, unless it is cancelled.

use super::process::Stop;
use super::tools::{Answer, Tools};
use crate::terminal::print;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Calls at one time, at most: each is a process that computes on all cores.
const MOST: usize = 8;
/// How often the progress of a call is reported.
const EVERY: Duration = Duration::from_secs(2);

/// The calls whose work is not done, by their requests, and how they are stopped.
pub(super) struct Calls {
    tools: Arc<Tools>,
    running: Arc<Mutex<BTreeMap<String, Stop>>>,
}

impl Calls {
    pub(super) fn new(tools: Tools) -> Calls {
        Calls { tools: Arc::new(tools), running: Arc::default() }
    }

    /// Answers a request.
    pub(super) fn answer(&self, id: &Value, result: &Value) {
        send(&json!({ "jsonrpc": "2.0", "id": id, "result": result }));
    }

    /// Answers a request that cannot be served.
    pub(super) fn refuse(&self, id: &Value, code: i64, message: &str) {
        let error = json!({ "code": code, "message": message });
        send(&json!({ "jsonrpc": "2.0", "id": id, "error": error }));
    }

    /// Begins the work of a tool, with the parameters of the request.
    pub(super) fn begin(&self, id: &Value, name: &str, params: &Value) {
        let (key, stop) = (id.to_string(), Stop::default());
        let running = locked(&self.running).len();
        if running >= MOST {
            let text = format!("{running} calls are running: wait for one, or cancel it");
            return self.answer(id, &Answer::error(text).to_json());
        }
        locked(&self.running).insert(key.clone(), stop.clone());
        let (tools, calls, own) = (self.tools.clone(), self.running.clone(), id.clone());
        let (name, params) = (name.to_owned(), params.clone());
        let work = move || {
            let progress = Running::report(&name, &params["_meta"]["progressToken"]);
            let answer = tools.call(&name, &params["arguments"], &stop);
            drop(progress);
            locked(&calls).remove(&key);
            // The protocol has no answer to a call that was cancelled.
            if !stop.is_asked() {
                send(&json!({ "jsonrpc": "2.0", "id": own, "result": answer.to_json() }));
            }
        };
        let thread = std::thread::Builder::new().name("call".to_owned()).stack_size(crate::STACK);
        if let Err(error) =
            thread.spawn(move || crate::script::with_stack(crate::STACK - (4 << 20), work))
        {
            locked(&self.running).remove(&id.to_string());
            self.answer(id, &Answer::error(format!("cannot start a thread: {error}")).to_json());
        }
    }

    /// Stops the work of a call; one that has ended is passed.
    pub(super) fn cancel(&self, id: &Value) {
        if let Some(stop) = locked(&self.running).get(&id.to_string()) {
            stop.ask();
        }
    }

    /// Stops all work: the connection has ended.
    pub(super) fn stop_all(&self) {
        locked(&self.running).values().for_each(Stop::ask);
        for _ in 0..super::process::PATIENCE.as_millis() / 20 {
            if locked(&self.running).is_empty() {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    }
}

/// Reports how long a call has been running, if the request asks for that, until this is dropped.
struct Running(Option<(mpsc::Sender<()>, JoinHandle<()>)>);

impl Running {
    fn report(name: &str, token: &Value) -> Running {
        if token.is_null() {
            return Running(None);
        }
        let (name, token, began) = (name.to_owned(), token.clone(), Instant::now());
        let (done, ended) = mpsc::channel();
        let work = move || {
            while ended.recv_timeout(EVERY) == Err(mpsc::RecvTimeoutError::Timeout) {
                let seconds = began.elapsed().as_secs_f64();
                let message = format!("{name} has been running for {seconds:.0} s");
                let params =
                    json!({ "progressToken": token, "progress": seconds, "message": message });
                let method = "notifications/progress";
                send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
            }
        };
        // Without a thread the call runs all the same.
        let thread = std::thread::Builder::new().name("progress".to_owned()).spawn(work);
        Running(thread.ok().map(|thread| (done, thread)))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some((done, thread)) = self.0.take() {
            drop(done);
            // Nothing is reported after the answer.
            _ = thread.join();
        }
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes a message on a line of its own.
fn send(message: &Value) {
    print(&format!("{message}\n"));
}
