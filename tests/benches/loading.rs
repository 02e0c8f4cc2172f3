//! Reading libraries: the outline of a text, and a model of the standard library from a cold start.
//! The folder that `GAPILIB_MSL` names holds the library; without it the shipped models are
//! outlined, and the model is left out.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use gapilib::internals::flatten::{self, Library, LibraryFiles};
use gapilib::internals::name::Name;
use gapilib::internals::syntax::{self, Outline};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[path = "disk.rs"]
mod disk;
use disk::Disk;

fn texts(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for name in Disk::default().list(folder) {
        let path = folder.join(&name);
        if path.is_dir() {
            found.extend(texts(&path));
        } else if name.ends_with(".mo") {
            found.push(syntax::decode(&std::fs::read(path).unwrap_or_default()).0);
        }
    }
    found
}

fn outline(criterion: &mut Criterion) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let texts = texts(&std::env::var_os("GAPILIB_MSL").map_or(shipped, PathBuf::from));
    let mut group = criterion.benchmark_group("loading");
    group.throughput(Throughput::Bytes(texts.iter().map(|text| text.len() as u64).sum()));
    group.sample_size(20);
    group.bench_function("outline of all files", |bencher| {
        bencher.iter(|| texts.iter().filter(|text| Outline::of(black_box(text)).is_some()).count());
    });
    group.finish();
}

/// A library just found, and all that one of its models needs read.
fn cold_start(criterion: &mut Criterion) {
    let Some(folder) = std::env::var_os("GAPILIB_MSL").map(PathBuf::from) else { return };
    let model = Name::parse("Modelica.Electrical.Analog.Examples.CauerLowPassAnalog");
    criterion.bench_function("loading/a model of the standard library", |bencher| {
        bencher.iter(|| {
            let files: Arc<dyn LibraryFiles> = Arc::new(Disk::default());
            let mut library = Library::new();
            for name in ["Modelica", "ModelicaServices", "Complex.mo"] {
                let loaded = library.load_lazily(&files, &folder.join(name), &Name::default());
                loaded.expect("the library is there");
            }
            // Whether the model can be translated is of no interest here, only what is read.
            let answer = flatten::flatten(&library, &model, &[]);
            (answer.is_ok(), library.number_read())
        });
    });
}

criterion_group!(benches, outline, cold_start);
criterion_main!(benches);
