//! Translated models that are kept from one process to the next: the same results as translated
//! anew, and never those of what has changed since.

use crate::support::program::{command, folder};
use crate::support::shipped;
use gapilib::Session;
use gapilib::internals::codegen::Program;
use gapilib::internals::script::models::simulation::{self, SimulationOptions};
use gapilib::internals::sim::{OutputGrid, Settings, Simulator, Trajectory};
use gapilib::world::{MemoryWorld, Store};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::{Arc, Mutex};
use tempfile::TempDir;

/// What a program computes: the rows, or how it fails.
fn computed(program: &Arc<Program>) -> (Vec<u64>, Option<String>) {
    let mut system = program.system();
    let output = OutputGrid::Intervals(20);
    let settings = Settings { tolerance: 1e-6, output, ..Settings::default() };
    let mut rows = Trajectory::default();
    let ended = Simulator::new().run(&mut system, &settings, &mut rows);
    let columns = (0..rows.n_columns()).flat_map(|column| rows.column(column));
    let numbers = rows.time().iter().chain(columns).map(|value| value.to_bits());
    (numbers.collect(), ended.err().map(|error| program.explain(&error).message.clone()))
}

#[test]
fn a_program_computes_the_same_after_it_was_written_and_read() {
    let mut count = 0;
    let folders = ["tests/simulation", "tests/models"];
    for path in folders.iter().flat_map(|folder| shipped::files(folder, "mo")) {
        let Ok(text) = fs::read_to_string(&path) else { continue };
        // Those take long.
        if path.iter().any(|part| part == "test_set") {
            continue;
        }
        let mut session = Session::new(Box::new(shipped::world()));
        let Ok(classes) = session.load_text("model.mo", &text) else { continue };
        let Some(class) = classes.first() else { continue };
        let Ok(model) = simulation::translate(&mut session, &class.to_string()) else { continue };
        let program = model.program.clone();
        let Some(bytes) = program.to_bytes() else { panic!("{}", path.display()) };
        let restored = Program::from_bytes(&bytes).expect("the bytes of this version");
        assert_eq!(computed(&program), computed(&restored), "{}", path.display());
        count += 1;
    }
    assert!(count > 25, "only {count} models");
}

/// A store in memory that counts what was found.
#[derive(Default)]
struct Kept {
    files: Mutex<HashMap<String, Vec<u8>>>,
    found: Mutex<usize>,
}

impl Store for Kept {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        let found = self.files.lock().unwrap().get(name).cloned();
        *self.found.lock().unwrap() += usize::from(found.is_some());
        found
    }

    fn keep(&self, name: &str, bytes: &[u8]) {
        self.files.lock().unwrap().insert(name.to_owned(), bytes.to_vec());
    }
}

const PACKAGE: &[(&str, &str)] = &[
    ("/lib/P/package.mo", "package P\n  constant Real k = 2;\nend P;\n"),
    (
        "/lib/P/M.mo",
        "within P;\nmodel M\n  parameter Real p = 3;\n  parameter Integer n = 2;\n  Real x[n];\n  \
         Real y = f(x[1]);\nequation\n  for i in 1:n loop\n    x[i] = k*p + time;\n  end for;\n  \
         assert(y < 100, \"y is large\", AssertionLevel.warning);\nend M;\n",
    ),
    (
        "/lib/P/f.mo",
        "within P;\nfunction f\n  input Real u;\n  output Real y;\nalgorithm\n  y := 10*u;\nend f;\n",
    ),
];

/// What a script prints in a world with the package, changed so; and whether the model that it
/// translates was found.
fn printed(kept: &Arc<Kept>, changes: &[(&str, &str)], script: &str) -> (String, bool) {
    let files = PACKAGE.iter().chain(changes);
    let world = files.fold(MemoryWorld::new(), |world, (path, text)| world.with_file(path, text));
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    session.storage = Some(kept.clone());
    session.add_library_dir(Path::new("/lib"));
    session.run_text("test.mos", script);
    // A model that is translated needs the classes `M` and `f`, too.
    let was_found = session.library().number_read() < 3;
    (streams.output() + &streams.errors(), was_found)
}

const SCRIPT: &str = "simulateModel(\"P.M\", stopTime = 5, resultFile = \"r\");\n\
                      y = readTrajectory(\"r.mat\", {\"y\"}, readTrajectorySize(\"r.mat\"));\n\
                      print(String(y[1, end]));\n";

#[test]
fn a_kept_model_is_taken_only_while_nothing_has_changed() {
    let kept = Arc::new(Kept::default());
    let (first, was_found) = printed(&kept, &[], SCRIPT);
    assert!(!was_found);
    let (again, was_found) = printed(&kept, &[], SCRIPT);
    assert!(was_found, "the model is taken from the store");
    assert_eq!(first, again);

    for change in [
        (
            "/lib/P/f.mo",
            "within P;\nfunction f\n  input Real u;\n  output Real y;\nalgorithm\n  y := 20*u;\nend f;\n",
        ),
        ("/lib/P/package.mo", "package P\n  constant Real k = 4;\nend P;\n"),
        ("/lib/P/other.mo", "within P;\nmodel other\nend other;\n"),
        ("/lib/P/package.order", "M\nf\n"),
    ] {
        let (_, was_found) = printed(&kept, &[change], SCRIPT);
        assert!(!was_found, "{} has changed", change.0);
        let (back, _) = printed(&kept, &[], SCRIPT);
        assert_eq!(back, first, "{} is as it was", change.0);
    }
}

#[test]
fn what_a_script_does_to_the_classes_counts() {
    let kept = Arc::new(Kept::default());
    let (plain, _) = printed(&kept, &[], SCRIPT);
    let own = "function g\n  input Real u;\n  output Real y;\nalgorithm\n  y := u;\nend g;\n";
    let (_, was_found) = printed(&kept, &[], &format!("{own}{SCRIPT}"));
    assert!(!was_found, "there is another class");
    let (_, was_found) = printed(&kept, &[], &format!("{own}{SCRIPT}"));
    assert!(was_found, "the script is the same");
    let other = SCRIPT.replace("P.M\"", "P.M(p = 4)\"");
    let (changed, was_found) = printed(&kept, &[], &other);
    assert!(!was_found && changed != plain, "{changed}");
}

#[test]
fn a_kept_model_takes_parameters_and_is_linearized() {
    let script =
        format!("translateModel(\"P.M\");\np = 5;\nn = 3;\n{SCRIPT}linearizeModel(\"P.M\");\n");
    let kept = Arc::new(Kept::default());
    let (first, _) = printed(&kept, &[], &script);
    assert!(first.contains("150"), "{first}");
    let (again, _) = printed(&kept, &[], &script);
    assert_eq!(first, again);
    assert!(*kept.found.lock().unwrap() > 0);
}

#[test]
fn a_session_finds_what_another_one_has_kept() {
    let kept = Arc::new(Kept::default());
    let tables: Vec<_> = (0..2)
        .map(|_| {
            let mut session = Session::new(Box::new(shipped::world()));
            session.storage = Some(kept.clone());
            let model = simulation::translate(&mut session, "CaseStudies.LoadSteps");
            let model = model.expect("it is translated");
            let options = SimulationOptions::default();
            simulation::simulate(&mut session, &model, &options).expect("it is simulated").table
        })
        .collect();
    assert_eq!(*kept.found.lock().unwrap(), 1);
    assert_eq!(tables[0].time, tables[1].time);
    assert_eq!(tables[0].names().collect::<Vec<_>>(), tables[1].names().collect::<Vec<_>>());
    for name in tables[0].names() {
        let values = |table: &gapilib::results::ResultTable| -> Vec<u64> {
            table.column(name).unwrap().iter().map(|value| value.to_bits()).collect()
        };
        assert_eq!(values(&tables[0]), values(&tables[1]), "{name}");
    }
}

/// A model that is large enough to be kept on a disk.
const LARGE: &str = include_str!("../../data/models/translations_large.mo");

/// Simulates the model with a cache below the folder.
fn simulated(here: &TempDir, arguments: &[&str]) -> Output {
    let mut all = vec!["simulate", "Large.mo", "--variable-filter", "s", "-o", "r.csv"];
    all.extend(arguments);
    let mut command = command(here.path(), &all);
    command.env_remove("GAPI_NO_CACHE").env("XDG_CACHE_HOME", here.path().join("cache"));
    command.env("HOME", here.path().join("home"));
    let done = command.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    done
}

fn kept(here: &TempDir) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(here.path().join("cache/gapi/models")) else {
        return Vec::new();
    };
    entries.map(|entry| entry.unwrap().path()).collect()
}

#[test]
#[cfg(unix)]
fn the_disk_keeps_large_models_and_damage_is_noticed() {
    use std::os::unix::fs::MetadataExt;
    let here = folder(&[("Large.mo", LARGE)]);
    simulated(&here, &["--no-cache"]);
    assert!(kept(&here).is_empty());
    let first = simulated(&here, &[]);
    let results = fs::read(here.path().join("r.csv")).unwrap();
    let [file] = &kept(&here)[..] else { panic!("one model is kept") };
    let number = fs::metadata(file).unwrap().ino();
    let again = simulated(&here, &[]);
    assert_eq!((&first.stdout, &first.stderr), (&again.stdout, &again.stderr));
    assert_eq!(fs::read(here.path().join("r.csv")).unwrap(), results);
    assert_eq!(fs::metadata(file).unwrap().ino(), number, "nothing was written anew");

    let mut bytes = fs::read(file).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(file, &bytes).unwrap();
    simulated(&here, &[]);
    assert_eq!(fs::read(here.path().join("r.csv")).unwrap(), results);
    assert_ne!(fs::read(file).unwrap(), bytes, "what was damaged is replaced");
    fs::write(file, &bytes[..20]).unwrap();
    simulated(&here, &[]);
    assert_eq!(fs::read(here.path().join("r.csv")).unwrap(), results);
}

#[test]
fn a_changed_file_is_translated_anew() {
    let here = folder(&[("Large.mo", LARGE)]);
    simulated(&here, &[]);
    let before = fs::read(here.path().join("r.csv")).unwrap();
    fs::write(here.path().join("Large.mo"), LARGE.replace("Real p = 1", "Real p = 2")).unwrap();
    simulated(&here, &[]);
    assert_ne!(fs::read(here.path().join("r.csv")).unwrap(), before);
}

#[test]
fn what_a_kept_model_prints_is_what_a_translated_one_prints() {
    let lines = include_str!("../../data/models/translations_prints.mo");
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("P.mo"), lines).expect("a file");
    let cache = folder.path().join("cache");
    let run = || {
        let mut command = command(folder.path(), &["simulate", "P.mo", "--output", "o.csv"]);
        let output = command.env("XDG_CACHE_HOME", &cache).output();
        String::from_utf8(output.expect("it runs").stdout).expect("text")
    };
    let (first, second) = (run(), run());
    assert_eq!(first.lines().take(4).collect::<Vec<_>>(), ["at 0.25", "at 0.5", "at 0.75", "at 1"]);
    assert_eq!(first, second);
}

/// A folder with a kept model, and the results of it.
#[cfg(unix)]
fn with_kept() -> (TempDir, PathBuf, Vec<u8>) {
    let here = folder(&[("Large.mo", LARGE)]);
    simulated(&here, &[]);
    let results = fs::read(here.path().join("r.csv")).unwrap();
    let [file] = &kept(&here)[..] else { panic!("one model is kept") };
    (here, file.clone(), results)
}

/// Without the key nobody makes an entry that counts.
#[test]
#[cfg(unix)]
fn an_entry_of_somebody_else_is_translated_again() {
    use std::os::unix::fs::PermissionsExt;
    let (here, file, results) = with_kept();
    let key = here.path().join("home/.local/state/gapi/cache.key");
    assert_eq!(fs::metadata(&key).unwrap().permissions().mode() & 0o777, 0o600);
    let entry = fs::read(&file).unwrap();
    // What somebody else's program has kept, with his key.
    fs::write(&key, [7; 32]).unwrap();
    simulated(&here, &[]);
    assert_ne!(fs::read(&file).unwrap(), entry, "it was written anew");
    assert_eq!(fs::read(here.path().join("r.csv")).unwrap(), results);
    // The entry of another model under this name.
    fs::write(here.path().join("Large.mo"), LARGE.replace("Real p = 1", "Real p = 2")).unwrap();
    simulated(&here, &[]);
    let changed = fs::read(here.path().join("r.csv")).unwrap();
    let other = kept(&here).into_iter().find(|path| *path != file);
    if let Some(other) = other {
        fs::copy(&file, &other).unwrap();
        simulated(&here, &[]);
        assert_eq!(fs::read(here.path().join("r.csv")).unwrap(), changed);
    }
}

/// As ssh and git do: what others can write or read is not used.
#[test]
#[cfg(unix)]
fn a_folder_or_key_that_others_can_use_is_not_used() {
    use std::os::unix::fs::PermissionsExt;
    let (here, file, results) = with_kept();
    let models = file.parent().unwrap().to_owned();
    let set =
        |path: &Path, mode| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    for (path, mode, private) in [
        (models.clone(), 0o777, 0o700),
        (models.parent().unwrap().to_owned(), 0o775, 0o700),
        (here.path().join("home/.local/state/gapi/cache.key"), 0o644, 0o600),
    ] {
        fs::remove_file(&file).unwrap_or_default();
        set(&path, mode);
        simulated(&here, &[]);
        assert!(kept(&here).is_empty(), "{}", path.display());
        assert_eq!(fs::read(here.path().join("r.csv")).unwrap(), results);
        set(&path, private);
        simulated(&here, &[]);
        assert_eq!(kept(&here).len(), 1, "{}", path.display());
    }
    // A folder elsewhere, in which old files would be removed.
    let elsewhere = folder(&[("old.txt", "mine")]);
    fs::remove_dir_all(&models).unwrap();
    std::os::unix::fs::symlink(elsewhere.path(), &models).unwrap();
    simulated(&here, &[]);
    assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 1);
}

/// Scripts neither read nor write the cache and the key, whatever they are allowed.
#[test]
#[cfg(unix)]
fn the_cache_is_closed_to_scripts() {
    let (here, file, _) = with_kept();
    let entry = fs::read(&file).unwrap();
    let name = file.strip_prefix(here.path()).unwrap().display();
    let script = format!(
        "writeFile(\"{name}\", \"evil\");\ndeleteFile(\"{name}\");\nreadFile(\"{name}\");\n\
         writeFile(\"cache/gapi/models/new.model\", \"evil\");\n\
         readFile(\"home/.local/state/gapi/cache.key\");\n"
    );
    fs::write(here.path().join("a.mos"), script).unwrap();
    let arguments = ["run", "a.mos", "--dialect", "openmodelica", "--allow-write", "--allow-read"];
    let mut command = command(here.path(), &arguments);
    command.env("XDG_CACHE_HOME", here.path().join("cache"));
    let done = command.env("HOME", here.path().join("home")).output().unwrap();
    let errors = String::from_utf8_lossy(&done.stderr);
    assert_eq!(errors.matches("closed to scripts and models").count(), 5, "{errors}");
    assert_eq!(fs::read(&file).unwrap(), entry);
    assert_eq!(kept(&here).len(), 1);
}
