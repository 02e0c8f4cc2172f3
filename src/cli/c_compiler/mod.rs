//! The system's C compiler, for functions that libraries bring along (MLS §12.9).
//!
//! `$CC`, else `cc`, `gcc` or `clang`. A unit is preprocessed first: the digest of what comes out,
//! of the compiler's version and of the libraries that are linked is the name of the shared object
//! in the user's cache folder, next to which its own digest stands. What is damaged there is
//! recompiled.

mod cache;
mod library;

use crate::diag::Fault;
use crate::external::c::{CCompiler, CLibrary, Frame, HEADER, UTILITIES, Unit};
use crate::external::errors::EXTERNAL_COMPILER;
use crate::script::access::policy::ExternalCode;
use crate::{bail, fault};
use library::Loaded;
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::SystemTime;

/// Without contraction a product and a sum are rounded as everywhere else; an undeclared function
/// would be called with wrong types.
const FLAGS: &[&str] = &[
    "-O2",
    "-fPIC",
    "-ffp-contract=off",
    "-Werror=implicit-function-declaration",
    "-Werror=int-conversion",
    "-Werror=incompatible-pointer-types",
];

/// What older compilers did: functions of the standard library that are not declared. Where the
/// code is not accepted otherwise, the headers that declare them are included first.
const LENIENT: &[&str] = &[
    "-include", "stdlib.h", "-include", "string.h", "-include", "stdio.h", "-include", "time.h",
    "-include", "ctype.h", "-include", "math.h",
];
/// What the compiler or the linker says then.
const UNDECLARED: &[&str] = &["implicit declaration of function", "undefined reference"];

/// What all compilers took with a warning until 2022, and code of that time is written for:
/// undeclared functions, which return int, and conversions between pointers and integers.
const TOLERANT: &[&str] = &[
    "-Wno-error=implicit-function-declaration",
    "-Wno-error=int-conversion",
    "-Wno-error=incompatible-pointer-types",
];
/// What the compiler says of it.
const TOLERATED: &[&str] =
    &["implicit-function-declaration", "int-conversion", "incompatible-pointer-types"];

/// Families of functions of the standard library in C whose sources stand alone.
const STANDARD: &[&str] = &["ModelicaStrings", "ModelicaInternal", "ModelicaFFT", "ModelicaRandom"];
/// The library that other tools have built from these; where a model does not bring it along, the
/// sources take its place.
const STANDARD_LIBRARY: &str = "ModelicaExternalC";

/// Longest part of a compiler's complaints that is shown, in lines.
const SHOWN: usize = 12;

/// The compiler for libraries that the user allows.
pub(super) fn for_libraries(allowed: ExternalCode) -> Arc<dyn CCompiler> {
    /// The one of the process: what is loaded stays loaded.
    static COMPILER: LazyLock<Arc<SystemCompiler>> = LazyLock::new(Arc::default);
    Arc::new(Allowed { libraries: allowed, compiler: COMPILER.clone() })
}

/// The compiler for some libraries.
#[derive(Debug)]
struct Allowed {
    libraries: ExternalCode,
    compiler: Arc<SystemCompiler>,
}

impl CCompiler for Allowed {
    fn permits(&self, class: &str) -> bool {
        self.libraries.permits(class)
    }

    fn load(&self, unit: &Unit) -> Result<Arc<dyn CLibrary>, Fault> {
        match self.libraries.is_only_checked {
            true => Ok(Arc::new(NotCalled { key: hex(&Sha256::digest(format!("{unit:?}"))) })),
            false => self.compiler.load(unit),
        }
    }
}

/// A unit whose models are only checked: not even what runs when a library is loaded is executed.
struct NotCalled {
    key: String,
}

impl CLibrary for NotCalled {
    fn key(&self) -> &str {
        &self.key
    }

    fn invoke(&self, _: usize, _: &mut Frame) -> Result<(), String> {
        Err("functions in C are not called while a model is only checked".to_owned())
    }
}

#[derive(Default)]
struct SystemCompiler {
    /// What was loaded for a unit, and the files that it was made of.
    known: Mutex<HashMap<String, Known>>,
}

/// What was loaded, and the files that it was made of.
type Known = (Vec<FileState>, Arc<Loaded>);

impl std::fmt::Debug for SystemCompiler {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SystemCompiler").finish_non_exhaustive()
    }
}

/// A file as it was.
type FileState = (PathBuf, Option<(SystemTime, u64)>);

fn state_of(path: PathBuf) -> FileState {
    let state = std::fs::metadata(&path)
        .ok()
        .and_then(|metadata| Some((metadata.modified().ok()?, metadata.len())));
    (path, state)
}

impl SystemCompiler {
    fn load(&self, unit: &Unit) -> Result<Arc<dyn CLibrary>, Fault> {
        let name = format!("{unit:?}");
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((files, loaded)) = known.get(&name)
            && files.iter().all(|file| state_of(file.0.clone()) == *file)
        {
            return Ok(loaded.clone());
        }
        let (files, loaded) = compiled(unit)?;
        // The same content has the same variables: it is loaded once.
        let same = known.values().map(|(_, other)| other).find(|other| other.key() == loaded.key());
        let loaded = same.cloned().unwrap_or_else(|| Arc::new(loaded));
        known.insert(name, (files, loaded.clone()));
        Ok(loaded)
    }
}

/// A compiler that answers, and what it says of itself.
struct Compiler {
    command: Vec<String>,
    version: Vec<u8>,
}

fn compiler() -> Result<Compiler, Fault> {
    let named = std::env::var("CC").ok().filter(|named| !named.trim().is_empty());
    let candidates = match &named {
        Some(named) => vec![named.as_str()],
        None => vec!["cc", "gcc", "clang"],
    };
    for candidate in &candidates {
        let command: Vec<String> = candidate.split_whitespace().map(str::to_owned).collect();
        let Some(program) = command.first() else { continue };
        let answer =
            |question| match Command::new(program).args(&command[1..]).arg(question).output() {
                Ok(output) if output.status.success() => Some(output.stdout),
                _ => None,
            };
        if let Some(mut version) = answer("--version") {
            version.extend(answer("-dumpmachine").unwrap_or_default());
            return Ok(Compiler { command, version });
        }
    }
    let tried = candidates.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    Err(fault!(
        EXTERNAL_COMPILER,
        "there is code in C to be compiled, but there is no C compiler: tried {tried}";
        help: "install one (`apt install gcc`, `xcode-select --install`), or name it in the \
               environment variable `CC`"
    ))
}

/// Compiles a unit, unless the cache has it, and loads it.
fn compiled(unit: &Unit) -> Result<(Vec<FileState>, Loaded), Fault> {
    if cfg!(target_feature = "crt-static") {
        bail!(
            EXTERNAL_COMPILER,
            "the library brings functions in C, which this program cannot load because it is \
             linked statically";
            help: "use the package `gapi.deb`, the one for Python, or `cargo install gapilib`"
        );
    }
    let compiler = compiler()?;
    let folder = cache::Scratch::new()?;
    for (name, text) in [
        ("unit.c", unit.source.as_str()),
        ("utilities.c", UTILITIES),
        ("ModelicaUtilities.h", HEADER),
    ] {
        std::fs::write(folder.path().join(name), text).map_err(|error| cache::cannot(&error))?;
    }
    let preprocessed = run(&compiler, folder.path(), unit, &["-E", "unit.c"])?.stdout;
    let standard = standard_sources(unit, &preprocessed);
    let linked = [linked_files(unit), standard.clone()].concat();
    let key = key(&compiler, unit, &preprocessed, &linked);
    let object = match cache::find(&key) {
        Some(object) => object,
        None => {
            build(&compiler, folder.path(), unit, &standard)?;
            cache::keep(&key, &folder.path().join("unit.so"))?
        }
    };
    let included = included_files(&preprocessed, folder.path()).into_iter();
    let files = included.chain(linked).map(state_of).collect();
    Ok((files, Loaded::open(&object, key)?))
}

/// Compiles and links `unit.so`. Code that calls what it does not declare gets the headers of C, and
/// the standard library's functions, which other tools link to every model; what is then accepted
/// with a warning alone is old code.
fn build(
    compiler: &Compiler,
    folder: &Path,
    unit: &Unit,
    standard: &[PathBuf],
) -> Result<(), Fault> {
    let linking = linking(unit);
    let mut arguments = vec!["-shared", "-o", "unit.so", "unit.c", "utilities.c"];
    arguments.extend(linking.iter().map(String::as_str));
    let Err(fault) = run(compiler, folder, unit, &arguments) else { return Ok(()) };
    let says = |list: &[&str]| list.iter().any(|words| fault.message.contains(words));
    if !says(UNDECLARED) && !says(TOLERATED) {
        return Err(fault);
    }
    let mut lenient: Vec<String> = LENIENT.iter().map(|&word| word.to_owned()).collect();
    for source in standard {
        // On its own: it says which functions of the system it needs before it includes headers.
        let file = source.display().to_string();
        run(compiler, folder, unit, &["-c", &file])?;
        let object = Path::new(source.file_name().unwrap_or_default()).with_extension("o");
        let header = source.with_extension("h").display().to_string();
        lenient.extend(["-include".to_owned(), header, object.display().to_string()]);
    }
    arguments.splice(0..0, lenient.iter().map(String::as_str));
    if run(compiler, folder, unit, &arguments).is_ok() {
        return Ok(());
    }
    arguments.splice(0..0, TOLERANT.iter().copied());
    run(compiler, folder, unit, &arguments).map(drop).map_err(|_| fault)
}

/// The sources of the standard library's functions that the code may call.
fn standard_sources(unit: &Unit, preprocessed: &[u8]) -> Vec<PathBuf> {
    let Some(folder) = &unit.standard_sources else { return Vec::new() };
    let text = String::from_utf8_lossy(preprocessed);
    let called = STANDARD.iter().filter(|family| text.contains(&format!("{family}_")));
    called.map(|family| folder.join(family).with_extension("c")).filter(|s| s.is_file()).collect()
}

fn run(
    compiler: &Compiler,
    folder: &Path,
    unit: &Unit,
    arguments: &[&str],
) -> Result<Output, Fault> {
    let mut all = vec!["-I.".to_owned()];
    for directory in &unit.include_directories {
        all.extend(["-I".to_owned(), directory.display().to_string()]);
    }
    all.extend(arguments.iter().map(|&argument| argument.to_owned()));
    let words = match invoke(compiler, folder, &all)? {
        Ok(output) => return Ok(output),
        Err(words) => words,
    };
    Err(fault!(
        EXTERNAL_COMPILER,
        "the C compiler `{}` does not accept the code of the library:\n{words}",
        compiler.command.join(" ");
        help: "correct the C code, or the annotations `Include`, `IncludeDirectory`, `Library` and \
               `LibraryDirectory`"
    ))
}

/// Runs the compiler in a folder; what it says where it does not accept the code.
fn invoke(
    compiler: &Compiler,
    folder: &Path,
    arguments: &[String],
) -> Result<Result<Output, String>, Fault> {
    let mut command = Command::new(&compiler.command[0]);
    command.args(&compiler.command[1..]).args(FLAGS).args(arguments).current_dir(folder);
    let output = command.output().map_err(|error| cache::cannot(&error))?;
    if output.status.success() {
        return Ok(Ok(output));
    }
    let words = String::from_utf8_lossy(&output.stderr);
    let mut lines: Vec<&str> = words.lines().collect();
    let more = lines.len().saturating_sub(SHOWN);
    lines.truncate(SHOWN);
    let rest = if more > 0 { format!("\n({more} more lines)") } else { String::new() };
    Ok(Err(format!("{}{rest}", lines.join("\n"))))
}

/// Compiles a shared library in a folder, with these arguments besides those of all code.
///
/// # Errors
/// There is no compiler, or it does not accept the code, in words.
pub(super) fn shared_library(folder: &Path, arguments: &[String]) -> Result<(), String> {
    let compiler = compiler().map_err(|fault| fault.message)?;
    let all = ["-shared".to_owned()].iter().chain(arguments).cloned().collect::<Vec<_>>();
    match invoke(&compiler, folder, &all).map_err(|fault| fault.message)? {
        Ok(_) => Ok(()),
        Err(words) => Err(format!(
            "the C compiler `{}` does not accept its sources:\n{words}",
            compiler.command.join(" ")
        )),
    }
}

/// The options of the linker, relative paths absolute.
fn linking(unit: &Unit) -> Vec<String> {
    let mut arguments = Vec::new();
    for directory in unit.library_directories.iter().filter(|directory| directory.is_dir()) {
        let directory = directory.display();
        arguments.extend([format!("-L{directory}"), format!("-Wl,-rpath,{directory}")]);
    }
    let is_there = |library: &str| {
        let names = library_files(library);
        unit.library_directories.iter().any(|d| names.iter().any(|name| d.join(name).is_file()))
    };
    for library in &unit.libraries {
        if library == STANDARD_LIBRARY && unit.standard_sources.is_some() && !is_there(library) {
            continue;
        }
        let is_file = Path::new(library).is_absolute();
        arguments.push(if is_file { library.clone() } else { format!("-l{library}") });
    }
    arguments.push("-lm".to_owned());
    if !cfg!(target_os = "macos") {
        // Undefined functions are found now, not when they are called.
        arguments.push("-Wl,--no-undefined".to_owned());
    }
    arguments
}

/// The names that the file of a library may have.
fn library_files(library: &str) -> [String; 3] {
    ["so", "a", "dylib"].map(|ending| format!("lib{library}.{ending}"))
}

/// Files of the library that are linked.
fn linked_files(unit: &Unit) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for library in &unit.libraries {
        if Path::new(library).is_absolute() {
            found.push(PathBuf::from(library));
        }
        for directory in &unit.library_directories {
            let names = library_files(library);
            found
                .extend(names.map(|name| directory.join(name)).into_iter().filter(|p| p.is_file()));
        }
    }
    found
}

/// The files of the library that the line markers of the preprocessor name.
fn included_files(preprocessed: &[u8], folder: &Path) -> Vec<PathBuf> {
    let text = String::from_utf8_lossy(preprocessed);
    let mut found = std::collections::BTreeSet::new();
    for line in text.lines() {
        let Some(rest) = line.strip_prefix("# ") else { continue };
        let Some(name) = rest.split('"').nth(1) else { continue };
        let path = folder.join(name);
        if !path.starts_with(folder) && path.is_file() {
            found.insert(path);
        }
    }
    found.into_iter().collect()
}

fn key(compiler: &Compiler, unit: &Unit, preprocessed: &[u8], linked: &[PathBuf]) -> String {
    let mut digest = Sha256::new();
    let mut part = |bytes: &[u8]| {
        digest.update((bytes.len() as u64).to_le_bytes());
        digest.update(bytes);
    };
    part(env!("CARGO_PKG_VERSION").as_bytes());
    part(std::env::consts::ARCH.as_bytes());
    part(std::env::consts::OS.as_bytes());
    part(compiler.command.join(" ").as_bytes());
    part(&compiler.version);
    part(FLAGS.join(" ").as_bytes());
    part(UTILITIES.as_bytes());
    part(linking(unit).join(" ").as_bytes());
    part(preprocessed);
    for file in linked {
        part(&std::fs::read(file).unwrap_or_default());
    }
    hex(&digest.finalize())
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
