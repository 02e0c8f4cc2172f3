//! How fast scripts run: a scalar loop, a product of matrices, a function call, a new session.

use criterion::{Criterion, criterion_group, criterion_main};
use gapilib::Session;
use gapilib::world::MemoryWorld;
use nalgebra::DMatrix;
use std::hint::black_box;

fn run(text: &str) -> Session {
    let mut session = Session::new(Box::new(MemoryWorld::new()));
    let status = session.run_text("bench.mos", text);
    assert_eq!(status.code, 0);
    session
}

fn scripts(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scripts");
    group.sample_size(10);
    group.bench_function("100 000 turns of a scalar loop", |bencher| {
        let text = "x = 0; for i in 1:100000 loop x = x + 0.5*i - 1; end for";
        bencher.iter(|| run(black_box(text)));
    });
    group.bench_function("100 000 function calls", |bencher| {
        let text = "function f input Real u; output Real y; algorithm y := u + 1; end f;\n\
                    x = 0; for i in 1:100000 loop x = f(x); end for";
        bencher.iter(|| run(black_box(text)));
    });
    group.bench_function("1000 x 1000 product", |bencher| {
        let mut session = run("a = fill(1.5, 1000, 1000);");
        bencher.iter(|| session.run_text("bench.mos", black_box("b = a*a;")));
    });
    group.bench_function("1000 x 1000 product by nalgebra", |bencher| {
        let a = DMatrix::from_element(1000, 1000, 1.5);
        bencher.iter(|| black_box(&a) * black_box(&a));
    });
    group.bench_function("a session and one statement", |bencher| bencher.iter(|| run("x = 1")));
    group.finish();
}

criterion_group!(benches, scripts);
criterion_main!(benches);
