//! One evaluation of a point of the polarization curve: parameters set, two variables observed.

use criterion::{Criterion, criterion_group, criterion_main};
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::sim::Residual;
use std::hint::black_box;

#[path = "../suite/support/flat_class.rs"]
mod flat_class;

const MODEL: &str = "model P parameter Real Eoc = 1.2; parameter Real R = 0.73;
    parameter Real In = 1.4e-3; parameter Real A = 0.039; parameter Real Io = 1.5856e-6;
    parameter Real B = 0.0918; parameter Real Ilim = 0.2265; parameter Real i_max = 0.22;
    Real i; Real V; equation i = i_max*time; assert(i + In < Ilim, \"limit\");
    V = Eoc - R*(i + In) - A*log((i + In)/Io) + B*log(1 - (i + In)/Ilim); end P;";

fn evaluation(criterion: &mut Criterion) {
    let sorted = causalize(&flat_class::flat(MODEL)).expect("the model can be sorted");
    let program = Program::compile(sorted).expect("the model compiles");
    let variables = ["i", "V"].map(|name| program.find_variable(name).expect("declared"));
    let mut system = program.system();
    system.observe_only(&variables);
    system.initialize(0.0, &mut []).expect("nothing can fail at zero");
    let mut out = [0.0; 2];
    criterion.bench_function("observe a polarization point", |bencher| {
        bencher.iter(|| system.observe(black_box(0.5), &[], &mut out).map(|()| out[1]));
    });
}

criterion_group!(benches, evaluation);
criterion_main!(benches);
