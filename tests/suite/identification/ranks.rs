//! Populations on several ranks, which are threads here that pass messages: the same numbers for any
//! number of them, and what becomes of ranks that do not fit, fail or are cancelled.

use gapilib::internals::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{self, Library};
use gapilib::internals::ga::Genomes;
use gapilib::internals::identify::ranks::{About, Connection, Processors, Ranks, Service, serve};
use gapilib::internals::identify::{CompiledModel, Evaluator, Question};
use gapilib::internals::source::SourceMap;
use gapilib::internals::syntax;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A bouncing ball: events, so that the time of a simulation depends on its parameters.
const MODEL: &str = include_str!("../../data/models/ranks_model.mo");

/// Without end: a counter of very many steps.
const ENDLESS: &str = "model Endless
  parameter Real w = 1e9;
  Real x(start = 1, fixed = true);
  Real y(start = 0, fixed = true);
equation
  der(x) = w*y;
  der(y) = -w*x;
  annotation(experiment(StopTime = 1000, Tolerance = 1e-8));
end Endless;";

/// The messages of one process.
struct Post {
    rank: usize,
    others: Vec<Sender<(usize, Vec<u8>)>>,
    own: Mutex<Receiver<(usize, Vec<u8>)>>,
    sent: Arc<AtomicUsize>,
}

impl Connection for Post {
    fn size(&self) -> usize {
        self.others.len()
    }

    fn send(&self, rank: usize, message: &[u8]) {
        self.sent.fetch_add(1, Ordering::SeqCst);
        // A rank that has ended reads nothing.
        let _ = self.others[rank].send((self.rank, message.to_vec()));
    }

    fn receive(&self, message: &mut Vec<u8>) -> Option<usize> {
        let (rank, bytes) = self.own.lock().unwrap().try_recv().ok()?;
        *message = bytes;
        Some(rank)
    }

    fn seconds(&self) -> f64 {
        seconds()
    }
}

fn seconds() -> f64 {
    static STARTED: std::sync::LazyLock<Instant> = std::sync::LazyLock::new(Instant::now);
    STARTED.elapsed().as_secs_f64()
}

fn posts(size: usize) -> Vec<Post> {
    let (senders, receivers): (Vec<_>, Vec<_>) = (0..size).map(|_| channel()).unzip();
    let post = |(rank, own)| Post {
        rank,
        others: senders.clone(),
        own: Mutex::new(own),
        sent: Arc::default(),
    };
    receivers.into_iter().enumerate().map(post).collect()
}

fn about(version: &str, threads: usize) -> About {
    About { version: version.to_owned(), host: "here".to_owned(), threads }
}

/// Ranks that serve, and how many messages each has sent.
struct Job {
    ranks: Arc<Ranks>,
    servants: Vec<JoinHandle<()>>,
    sent: Vec<Arc<AtomicUsize>>,
}

impl Job {
    fn of(size: usize, threads: usize) -> Job {
        let mut posts = posts(size);
        let others = posts.split_off(1);
        let sent = others.iter().map(|post| Arc::clone(&post.sent)).collect();
        let servant = |post: Post| std::thread::spawn(move || follow(&post, "1", threads));
        let servants = others.into_iter().map(servant).collect();
        let ranks = Ranks::connect(Box::new(posts.remove(0)), &about("1", 1)).unwrap();
        Job { ranks, servants, sent }
    }

    fn processors(&self, threads: usize) -> Processors {
        Processors { threads, ranks: Some(Arc::clone(&self.ranks)) }
    }

    fn end(self) {
        self.ranks.end();
        self.servants.into_iter().for_each(|servant| servant.join().unwrap());
    }
}

fn follow(post: &Post, version: &str, threads: usize) {
    let stop = AtomicBool::new(false);
    serve(&Service {
        connection: post,
        about: about(version, threads),
        clock: seconds,
        stop: &stop,
    });
}

fn model(text: &str, name: &str) -> Arc<CompiledModel> {
    let (mut library, sources) = (Library::new(), SourceMap::default());
    let source = sources.add("model.mo", text);
    library.load(&syntax::parse_stored_definition(source, text).unwrap()).unwrap();
    let source = sources.add("problem", name);
    let (class, modification) = syntax::parse_class_with_modification(source, name).unwrap();
    let flat = flatten::flatten(&library, &class, &modification).unwrap();
    let program = Program::compile(causalize::causalize(&flat.model).unwrap()).unwrap();
    Arc::new(CompiledModel::new(name, program))
}

fn ball() -> (Arc<CompiledModel>, Question, Genomes) {
    let question = Question {
        parameters: ["e", "g"].map(str::to_owned).to_vec(),
        x_name: "time".to_owned(),
        y_name: "h".to_owned(),
        x: (0..40).map(|k| f64::from(k) * 0.07).collect(),
    };
    // Every seventh fails: without gravity, by an assertion.
    let genome = |k: u32| [f64::from(k) / 250.0, if k % 7 == 3 { -1.0 } else { 9.81 }];
    let genomes = Genomes::new(2, (0..200).flat_map(genome).collect()).unwrap();
    (model(MODEL, "Ball"), question, genomes)
}

/// Rows with their bits, and the causes of failures.
fn answers(processors: &Processors) -> (Vec<u64>, Vec<String>) {
    let (model, question, genomes) = ball();
    let evaluator = Evaluator::on(model, question, processors).unwrap();
    assert_eq!(evaluator.alone(), None);
    let simulated = evaluator.evaluate(&genomes).unwrap();
    (simulated.rows.iter().map(|value| value.to_bits()).collect(), simulated.messages())
}

#[test]
fn any_number_of_ranks_gives_the_same_bits() {
    let alone = answers(&Processors::threads(1));
    assert!(alone.1.iter().filter(|message| !message.is_empty()).count() > 20, "some fail");
    assert!(alone.1[3].contains("no gravity"), "{}", alone.1[3]);
    for (size, own_threads, other_threads) in
        [(1, 2, 1), (2, 1, 1), (3, 1, 1), (3, 2, 2), (6, 1, 1)]
    {
        let job = Job::of(size, other_threads);
        let found = answers(&job.processors(own_threads));
        assert!(found == alone, "{size} ranks, {own_threads} and {other_threads} threads");
        // Beyond the introduction and what was prepared, every rank has answered.
        for sent in &job.sent {
            assert!(sent.load(Ordering::SeqCst) > 2, "{size}: a rank had no work");
        }
        job.end();
    }
}

#[test]
fn a_rank_of_another_version_is_named() {
    let mut posts = posts(2);
    let other = posts.pop().unwrap();
    let servant = std::thread::spawn(move || follow(&other, "2", 1));
    let post = posts.pop().unwrap();
    let end = post.others[1].clone();
    let fault = Ranks::connect(Box::new(post), &about("1", 1)).err().unwrap();
    assert_eq!(fault.code.slug, "ranks-differ");
    assert_eq!(fault.message, "rank 1 on `here` runs gapi 2, but rank 0 on `here` runs gapi 1");
    // The order to end is the fifth.
    end.send((0, vec![4])).unwrap();
    servant.join().unwrap();
}

#[test]
fn simulations_under_way_end_when_the_run_is_cancelled() {
    let job = Job::of(2, 1);
    let question = Question {
        parameters: vec!["w".to_owned()],
        x_name: "time".to_owned(),
        y_name: "x".to_owned(),
        x: vec![1.0, 999.0],
    };
    let mut evaluator =
        Evaluator::on(model(ENDLESS, "Endless"), question, &job.processors(1)).unwrap();
    let flag = Arc::new(AtomicBool::new(false));
    evaluator.cancel_by(Some(Arc::clone(&flag)));
    let (sent, raised) = (Arc::clone(&job.sent[0]), Arc::clone(&flag));
    let before = sent.load(Ordering::SeqCst);
    let canceller = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(200));
        raised.store(true, Ordering::SeqCst);
    });
    let genomes = Genomes::new(1, (1..9).map(|k| f64::from(k) * 1e9).collect()).unwrap();
    let simulated = evaluator.evaluate(&genomes).unwrap();
    canceller.join().unwrap();
    assert!(evaluator.is_cancelled());
    assert!(simulated.rows.iter().all(|value| value.is_nan()));
    // The other rank reports that its work is over, and is free for the next.
    while sent.load(Ordering::SeqCst) == before {
        std::thread::sleep(Duration::from_millis(5));
    }
    drop(evaluator);
    assert!(answers(&job.processors(1)) == answers(&Processors::threads(1)));
    job.end();
}

#[test]
fn a_rank_that_is_asked_to_end_stops_the_run() {
    let mut posts = posts(2);
    let (other, post) = (posts.pop().unwrap(), posts.pop().unwrap());
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    let servant = std::thread::spawn(move || {
        serve(&Service { connection: &other, about: about("1", 1), clock: seconds, stop: &asked });
    });
    let ranks = Ranks::connect(Box::new(post), &about("1", 1)).unwrap();
    let flag = Arc::new(AtomicBool::new(false));
    ranks.stop_by(Arc::clone(&flag));
    stop.store(true, Ordering::SeqCst);
    let processors = Processors { threads: 1, ranks: Some(Arc::clone(&ranks)) };
    while !flag.load(Ordering::SeqCst) {
        answers(&processors);
    }
    ranks.end();
    servant.join().unwrap();
}

/// Its clock panics, and with it the thread that simulates.
struct Broken(Post);

impl Connection for Broken {
    fn size(&self) -> usize {
        self.0.size()
    }

    fn send(&self, rank: usize, message: &[u8]) {
        self.0.send(rank, message);
    }

    fn receive(&self, message: &mut Vec<u8>) -> Option<usize> {
        self.0.receive(message)
    }

    fn seconds(&self) -> f64 {
        panic!("no clock");
    }
}

#[test]
fn a_rank_whose_thread_has_panicked_serves_no_longer() {
    let mut posts = posts(2);
    let (other, post) = (Broken(posts.pop().unwrap()), posts.pop().unwrap());
    let servant = std::thread::spawn(move || {
        let (about, stop) = (about("1", 1), AtomicBool::new(false));
        serve(&Service { connection: &other, about, clock: seconds, stop: &stop });
    });
    let ranks = Ranks::connect(Box::new(post), &about("1", 1)).unwrap();
    // What waits for its answer is ended by whoever watches over the processes.
    let over = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&over);
    let run = std::thread::spawn(move || {
        let (model, question, genomes) = ball();
        let processors = Processors { threads: 1, ranks: Some(ranks) };
        let mut evaluator = Evaluator::on(model, question, &processors).unwrap();
        evaluator.cancel_by(Some(flag));
        evaluator.evaluate(&genomes).unwrap();
    });
    let begun = Instant::now();
    while !servant.is_finished() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it serves without its thread");
        std::thread::sleep(Duration::from_millis(5));
    }
    over.store(true, Ordering::SeqCst);
    run.join().unwrap();
    assert!(servant.join().is_err(), "it has not told that a thread was lost");
}
