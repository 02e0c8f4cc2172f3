//! Tests of simulation against exact and reference solutions.

use super::problems::{self, HeatRod, TestProblem};
use super::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

type Exact = fn(f64) -> Vec<f64>;

fn settings(stop: f64, tolerance: f64) -> Settings {
    Settings { stop, tolerance, output: OutputGrid::Intervals(50), ..Settings::default() }
}

fn by(method: &str, settings: Settings) -> Settings {
    Settings { method: find_integrator(method).unwrap(), ..settings }
}

/// Largest error of the columns over all rows, relative to max(|exact|, 1).
fn error(problem: &mut TestProblem, settings: &Settings, exact: Exact) -> f64 {
    let (trajectory, _) = simulate(problem, settings).unwrap();
    let mut largest: f64 = 0.0;
    for (row, t) in trajectory.time().iter().enumerate() {
        for (column, expected) in exact(*t).into_iter().enumerate() {
            let difference = trajectory.column(column)[row] - expected;
            largest = largest.max(difference.abs() / expected.abs().max(1.0));
        }
    }
    largest
}

fn final_values(problem: &mut dyn DaeSystem, settings: &Settings) -> Vec<f64> {
    let (trajectory, _) = simulate(problem, settings).unwrap();
    assert_eq!(trajectory.time().last(), Some(&settings.stop));
    (0..trajectory.n_columns()).map(|i| *trajectory.column(i).last().unwrap()).collect()
}

fn failure(problem: &mut dyn DaeSystem, settings: &Settings) -> SimError {
    simulate(problem, settings).unwrap_err()
}

/// Times at which there are two rows.
fn event_times(trajectory: &Trajectory) -> Vec<f64> {
    trajectory.time().windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect()
}

fn exact_decay(t: f64) -> Vec<f64> {
    vec![(-t).exp()]
}

#[test]
fn errors_follow_the_tolerance() {
    // Problem, end, exact solution, error allowed in tolerances: an oscillation without damping
    // adds up its local errors.
    let table = [
        (problems::decay as fn() -> TestProblem, 5.0, exact_decay as Exact, 2.0),
        (problems::oscillator, 10.0, |t| vec![t.cos(), -t.sin()], 40.0),
        (problems::stiff_linear, 10.0, |t| vec![t.cos()], 2.0),
        (
            problems::algebraic,
            5.0,
            |t| vec![2.0 * t * (-t).exp(), 2.0 * (1.0 - t) * (-t).exp()],
            2.0,
        ),
    ];
    for (problem, stop, exact, allowed) in table {
        for tolerance in [1e-3, 1e-4, 1e-6, 1e-8] {
            let error = error(&mut problem(), &settings(stop, tolerance), exact);
            assert!(error < allowed * tolerance, "{error:e} at {tolerance:e}");
        }
    }
    for (method, tolerances) in
        [("dopri5", [1e-4, 1e-6, 1e-8].as_slice()), ("dop853", &[1e-4, 1e-6, 1e-8, 1e-10, 1e-12])]
    {
        for tolerance in tolerances {
            let settings = by(method, settings(10.0, *tolerance));
            let error = error(&mut problems::oscillator(), &settings, |t| vec![t.cos(), -t.sin()]);
            assert!(error < 20.0 * tolerance, "{method}: {error:e} at {tolerance:e}");
        }
    }
}

/// Errors of the interpolation in the middle of the first of steps of some length.
#[test]
fn explicit_methods_interpolate_with_their_order() {
    for (method, order) in [("dopri5", 4.0), ("dop853", 7.0)] {
        let error_with = |step: f64| {
            let mut settings = by(method, settings(2.0 * step, 1.0));
            settings.output = OutputGrid::At(vec![0.5 * step, 0.8 * step]);
            (settings.initial_step, settings.max_step) = (Some(step), step);
            error(&mut problems::oscillator(), &settings, |t| vec![t.cos(), -t.sin()])
        };
        // The local error is of one order more.
        let estimated = (error_with(0.8) / error_with(0.4)).log2();
        assert!(
            estimated > order + 0.7 && estimated < order + 2.0,
            "{method} interpolates with order {estimated}"
        );
    }
}

/// Where tolerances are tight, the method of order 8 needs far fewer evaluations.
#[test]
fn a_high_order_needs_few_evaluations_at_tight_tolerances() {
    let evaluations = |method: &str| {
        let settings = by(method, settings(20.0, 1e-10));
        simulate(&mut problems::oscillator(), &settings).unwrap().1.rhs_evaluations
    };
    let (high, low) = (evaluations("dop853"), evaluations("dopri5"));
    assert!(2 * high < low, "{high} and {low}");
}

#[test]
fn methods_with_fixed_step_have_their_order() {
    for (method, order) in [("euler", 1.0), ("rungekutta", 4.0)] {
        let error_with = |step: f64| {
            let mut settings = by(method, settings(2.0, 1e-4));
            settings.step = Some(step);
            (final_values(&mut problems::oscillator(), &settings)[0] - 2f64.cos()).abs()
        };
        let estimated = (error_with(0.02) / error_with(0.01)).log2();
        assert!((estimated - order).abs() < 0.2, "{method} has order {estimated}");
    }
}

/// The error at the end with steps of this length, the error test being satisfied by anything.
fn error_with_step(method: &str, problem: &mut TestProblem, step: f64, exact: Exact) -> f64 {
    let stop = 2.0;
    let mut settings = by(method, settings(stop, 1.0));
    (settings.step, settings.initial_step, settings.max_step) = (Some(step), Some(step), step);
    let ends = final_values(problem, &settings).into_iter().zip(exact(stop));
    ends.map(|(value, expected)| (value - expected).abs()).fold(0.0, f64::max)
}

#[test]
fn every_one_step_method_has_its_order_on_every_problem() {
    let oscillator: (fn() -> TestProblem, Exact) =
        (problems::oscillator, |t| vec![t.cos(), -t.sin()]);
    let algebraic: (fn() -> TestProblem, Exact) =
        (problems::algebraic, |t| vec![2.0 * t * (-t).exp(), 2.0 * (1.0 - t) * (-t).exp()]);
    let logistic: (fn() -> TestProblem, Exact) =
        (problems::driven_logistic, |t| vec![1.0 / (1.0 + (-t * t).exp()), (-t).exp()]);
    for (method, order, step) in [
        ("euler", 1.0, 0.01),
        ("rungekutta", 4.0, 0.05),
        ("dopri5", 5.0, 0.1),
        ("dop853", 8.0, 0.25),
        ("rodas4", 4.0, 0.05),
        ("radau", 5.0, 0.2),
    ] {
        for (problem, exact) in [oscillator, algebraic, logistic] {
            if problem().n_algebraic() > 0 && !["rodas4", "radau"].contains(&method) {
                continue;
            }
            let coarse = error_with_step(method, &mut problem(), step, exact);
            let fine = error_with_step(method, &mut problem(), 0.5 * step, exact);
            let estimated = (coarse / fine).log2();
            assert!(
                estimated > order - 0.35 && estimated < order + 1.2,
                "{method} has order {estimated}: {coarse:e}, {fine:e}"
            );
        }
    }
}

#[test]
fn robertson_with_algebraic_equation() {
    for (tolerance, allowed) in [(1e-4, 2e-4), (1e-8, 2e-7)] {
        let y = final_values(&mut problems::robertson(), &settings(40.0, tolerance));
        for (y, expected) in y.iter().zip([0.715_827_068_7, 0.918_553_476_4e-5, 0.284_163_745_7]) {
            assert!((y / expected - 1.0).abs() < allowed, "{y} is not {expected}");
        }
    }
}

#[test]
fn stiff_van_der_pol() {
    let y = final_values(&mut problems::van_der_pol(), &settings(2.0, 1e-8));
    for (y, expected) in y.iter().zip([1.706_167_732_170_469, -0.892_809_701_024_812_5]) {
        assert!((y / expected - 1.0).abs() < 1e-6, "{y} is not {expected}");
    }
}

#[test]
fn stiff_test_set_problems_reach_their_reference_solutions() {
    type Case = (fn() -> TestProblem, f64, &'static [f64], f64);
    // Problem, end, reference, error allowed in tolerances.
    let table: [Case; 4] = [
        (problems::robertson, 40.0, &[0.715_827_068_7, 0.918_553_476_4e-5, 0.284_163_745_7], 5.0),
        (problems::hires, 321.8122, &problems::HIRES_END, 50.0),
        (problems::van_der_pol, 2.0, &[1.706_167_732_170_469, -0.892_809_701_024_812_5], 20.0),
        (problems::oregonator, 360.0, &problems::OREGONATOR_END, 100.0),
    ];
    for method in ["dassl", "rodas4", "radau"] {
        for (problem, stop, reference, allowed) in table {
            for tolerance in [1e-4, 1e-6, 1e-8] {
                let settings = by(method, settings(stop, tolerance));
                let y = final_values(&mut problem(), &settings);
                let errors = y.iter().zip(reference).map(|(y, e)| (y / e - 1.0).abs());
                let largest = errors.fold(0.0, f64::max);
                assert!(
                    largest < allowed * tolerance,
                    "{method} at {tolerance:e} until {stop}: {largest:e}"
                );
            }
        }
    }
}

#[test]
fn steep_algebraic_equations_are_fulfilled_at_every_point() {
    for method in ["dassl", "rodas4", "radau"] {
        let settings = by(method, settings(12.0, 1e-6));
        let (trajectory, _) = simulate(&mut problems::diode(), &settings).unwrap();
        for (row, t) in trajectory.time().iter().enumerate() {
            let (mut low, mut high) = (-10.0f64, 10.0f64);
            while high - low > 1e-12 {
                let v = 0.5 * (low + high);
                let current = (10.0 * t.sin() - v) / 100.0;
                let is_below = current > 1e-9 * ((v / 0.025).exp() - 1.0);
                (low, high) = if is_below { (v, high) } else { (low, v) };
            }
            let v = trajectory.column(1)[row];
            assert!((v - low).abs() < 1e-3, "{method}: v({t}) = {v} instead of {low}");
        }
    }
}

#[test]
fn pendulum_passes_its_lowest_point_after_a_quarter_period() {
    // Complete elliptic integral of the first kind at modulus sin(π/4).
    let quarter = 1.854_074_677_301_371_9 / 9.81f64.sqrt();
    let y = final_values(&mut problems::pendulum(), &settings(quarter, 1e-9));
    let expected = [0.0, -(2.0 * 9.81f64).sqrt(), 0.0, -1.0, 3.0 * 9.81];
    for (y, expected) in y.iter().zip(expected) {
        assert!((y - expected).abs() < 1e-7 * expected.abs().max(1.0), "{y} is not {expected}");
    }
}

#[test]
fn a_long_rod_is_solved_by_sparse_factors() {
    let mut rod = HeatRod::new(400);
    let settings = settings(2.0, 1e-6);
    let (expected, start) = ((-2.0 * rod.rate()).exp(), rod.start(100));
    let y = final_values(&mut rod, &settings);
    assert!((y[100] / (expected * start) - 1.0).abs() < 1e-5, "{}", y[100] / start);
}

#[test]
fn impacts_of_a_ball_are_at_their_times() {
    let fall = (2.0 / 9.81f64).sqrt();
    for method in ["dassl", "dopri5", "rungekutta"] {
        let mut settings = by(method, settings(2.5, 1e-10));
        settings.step = Some(1e-3);
        let (trajectory, statistics) = simulate(&mut problems::bouncing_ball(), &settings).unwrap();
        let bounces: Vec<(f64, f64)> = trajectory
            .time()
            .windows(2)
            .enumerate()
            .filter(|(i, pair)| {
                let speed = trajectory.column(1);
                pair[0] == pair[1] && speed[*i] < 0.0 && speed[i + 1] > 0.0
            })
            .map(|(i, pair)| (pair[0], trajectory.column(1)[i + 1]))
            .collect();
        assert!(bounces.len() >= 9, "{method}: {bounces:?}");
        let (mut time, mut speed) = (fall, 9.81 * fall);
        for (at, after) in &bounces {
            speed *= 0.7;
            assert!((at - time).abs() < 1e-8, "{method}: impact at {at}, not {time}");
            assert!((after - speed).abs() < 1e-6, "{method}: {after} is not {speed}");
            time += 2.0 * speed / 9.81;
        }
        assert!(time > 2.5, "{method} has found all impacts");
        assert!(statistics.state_events >= bounces.len() as u64);
    }
}

#[test]
fn events_without_progress_are_chattering() {
    let error = failure(&mut problems::chattering(), &settings(1.0, 1e-6));
    assert_eq!(error.kind, SimErrorKind::Chattering);
    assert!((error.time - 0.5).abs() < 1e-6, "{error}");
}

#[test]
fn time_events_are_stepped_on() {
    let at = |t: f64| {
        let before = 1.0 - (-t.min(0.5)).exp();
        if t <= 0.5 { before } else { (before + 1.0) * (-(t - 0.5)).exp() - 1.0 }
    };
    for method in ["dassl", "dopri5", "rungekutta"] {
        let settings = by(method, settings(2.0, 1e-7));
        let (trajectory, statistics) =
            simulate(&mut problems::switched_input(), &settings).unwrap();
        assert_eq!(event_times(&trajectory), vec![0.5], "{method}");
        assert_eq!(statistics.time_events, 1);
        for (t, x) in trajectory.time().iter().zip(trajectory.column(0)) {
            assert!((x - at(*t)).abs() < 1e-6, "{method}: {x} at {t}");
        }
    }
}

#[test]
fn every_method_ends_on_time_with_the_rows_asked_for() {
    for entry in INTEGRATORS {
        let settings = by(entry.name, settings(1.0, 1e-5));
        let (trajectory, statistics) = simulate(&mut problems::decay(), &settings).unwrap();
        assert_eq!(trajectory.len(), 51, "{}", entry.name);
        assert_eq!(trajectory.time()[0], 0.0);
        assert_eq!(trajectory.time()[50], 1.0);
        assert!((trajectory.time()[10] - 0.2).abs() < 1e-15);
        assert!(statistics.steps > 0 && statistics.rhs_evaluations >= statistics.steps);
        assert!((trajectory.column(0)[50] - (-1f64).exp()).abs() < 5e-3, "{}", entry.name);
    }
}

#[test]
fn the_grid_may_be_a_list_of_times() {
    let mut settings = settings(1.0, 1e-6);
    settings.output = OutputGrid::At(vec![-1.0, 0.25, 0.5, 0.5, 0.75, 3.0]);
    let (trajectory, _) = simulate(&mut problems::decay(), &settings).unwrap();
    assert_eq!(trajectory.time(), &[0.25, 0.5, 0.5, 0.75]);
    for (t, x) in trajectory.time().iter().zip(trajectory.column(0)) {
        assert!((x - (-t).exp()).abs() < 1e-6);
    }
}

#[test]
fn a_system_without_unknowns_is_only_observed() {
    let mut problem = TestProblem::new(&[], 0, |_, _, _, _| {}).with_crossings(
        1,
        |t, _, _, out| out[0] = t * t - 0.1,
        |_, _, _| EventOutcome::Continue { y_changed: false },
    );
    problem.observed = Some(|t, _| t.sin());
    let (trajectory, statistics) = simulate(&mut problem, &settings(1.0, 1e-4)).unwrap();
    assert_eq!(trajectory.len(), 51 + 2);
    let events = event_times(&trajectory);
    assert_eq!(events.len(), 1);
    assert!((events[0] - 0.1f64.sqrt()).abs() < 1e-10);
    for (t, x) in trajectory.time().iter().zip(trajectory.column(0)) {
        assert_eq!(*x, t.sin());
    }
    assert_eq!((statistics.steps, statistics.rhs_evaluations), (50, 0));
}

/// x' = 1 with a crossing at x = 0.3 that changes nothing continuous.
fn counter(y_changed: bool) -> TestProblem {
    let event: fn(f64, &mut [f64], &mut [f64]) -> EventOutcome = if y_changed {
        |_, _, _| EventOutcome::Continue { y_changed: true }
    } else {
        |_, _, _| EventOutcome::Continue { y_changed: false }
    };
    TestProblem::new(&[0.0], 1, |t, _, _, out| out[0] = t.cos()).with_crossings(
        2,
        |t, y, _, out| {
            out[0] = y[0] - 0.3f64.sin();
            out[1] = t - 0.300_001;
        },
        event,
    )
}

#[test]
fn events_that_change_nothing_need_no_restart() {
    let settings = settings(1.0, 1e-6);
    let (restarted, with_restart) = simulate(&mut counter(true), &settings).unwrap();
    let (resumed, without) = simulate(&mut counter(false), &settings).unwrap();
    assert_eq!((with_restart.state_events, without.state_events), (2, 2));
    assert_eq!((with_restart.continued, without.continued), (0, 2));
    assert!(without.steps < with_restart.steps);
    for trajectory in [restarted, resumed] {
        let events = event_times(&trajectory);
        assert!((events[0] - 0.3).abs() < 1e-5 && (events[1] - 0.300_001).abs() < 1e-10);
    }
}

#[test]
fn leaving_zero_is_an_event() {
    // The crossing function is zero at the start and positive at once.
    let mut problem = TestProblem::new(&[0.0], 1, |_, _, discrete, out| out[0] = discrete[0])
        .with_discrete(&[1.0])
        .with_crossings(
            1,
            |_, y, _, out| out[0] = y[0],
            |_, y, discrete| {
                let changed = discrete[0] != 2.0 && y[0] > 0.0;
                discrete[0] = if y[0] > 0.0 { 2.0 } else { discrete[0] };
                EventOutcome::Continue { y_changed: changed }
            },
        );
    let y = final_values(&mut problem, &settings(1.0, 1e-6));
    assert!((y[0] - 2.0).abs() < 1e-9, "{}", y[0]);
}

#[test]
fn a_model_may_terminate() {
    let mut problem = problems::decay().with_crossings(
        1,
        |_, y, _, out| out[0] = y[0] - 0.5,
        |_, _, _| EventOutcome::Terminate,
    );
    let (trajectory, _) = simulate(&mut problem, &settings(5.0, 1e-9)).unwrap();
    let last = *trajectory.time().last().unwrap();
    assert!((last - 2f64.ln()).abs() < 1e-8, "{last}");
}

/// A step of a method of high order goes far beyond the failure: it has no rows there.
#[test]
fn there_are_no_rows_after_an_assertion_has_failed() {
    for method in ["dassl", "rodas4", "dop853"] {
        let mut asserting = problems::decay();
        asserting.assertion = |y| y[0] > 0.5;
        let mut out = Trajectory::default();
        let run = Simulator::new().run(&mut asserting, &by(method, settings(5.0, 1e-3)), &mut out);
        let failed = run.unwrap_err().time;
        assert!((failed - 2f64.ln()).abs() < 1e-2, "{method}: {failed}");
        assert!(out.time().last().is_some_and(|last| *last <= failed), "{method}");
    }
}

#[test]
fn failures_say_when_and_why() {
    let settings = settings(5.0, 1e-6);
    let error = failure(&mut problems::blow_up(), &settings);
    assert!((error.time - 1.0).abs() < 1e-3, "{error}");
    assert!(matches!(error.kind, SimErrorKind::StepSize | SimErrorKind::NotFinite));

    let error = failure(&mut problems::end_of_domain(), &settings);
    assert!((error.time - 2.0 * (1.0 - 2f64.ln())).abs() < 1e-3, "{error}");
    assert_eq!(error.kind, SimErrorKind::NotFinite);

    let mut asserting = problems::decay();
    asserting.assertion = |y| y[0] > 0.5;
    let error = failure(&mut asserting, &settings);
    assert_eq!(error.kind, SimErrorKind::Evaluation(Failure::Assertion { assertion: 0 }));
    assert!((0.69..1.5).contains(&error.time), "{error}");

    let mut singular = problems::algebraic();
    singular.rhs = |_, y, _, out| (out[0], out[1]) = (y[1], y[0] * 0.0);
    assert_eq!(failure(&mut singular, &settings).kind, SimErrorKind::Singular);

    let error = failure(&mut problems::algebraic(), &by("euler", settings.clone()));
    assert_eq!(error.kind, SimErrorKind::ExplicitMethod);
    for (stop, tolerance) in [(f64::NAN, 1e-6), (1.0, 0.0), (1.0, f64::NAN)] {
        let bad = Settings { stop, tolerance, ..settings.clone() };
        assert_eq!(failure(&mut problems::decay(), &bad).kind, SimErrorKind::Settings);
    }
    let short = Settings { max_steps: 10, max_total_steps: 10, ..settings.clone() };
    assert_eq!(failure(&mut problems::oscillator(), &short).kind, SimErrorKind::StepBudget);
    // As long as it gets on, it may take more, but not without end.
    let within = |max_total_steps| Settings { max_total_steps, ..short.clone() };
    let run = Simulator::new().run(
        &mut problems::oscillator(),
        &within(10_000),
        &mut Trajectory::default(),
    );
    assert!(run.expect("it gets on").attempts() > 20);
    let ended = failure(&mut problems::oscillator(), &within(20));
    assert_eq!(ended.kind, SimErrorKind::StepBudget);
    assert!(ended.time < 0.5, "{ended}");
    let cancelled = Settings { cancel: Some(Arc::new(AtomicBool::new(true))), ..settings };
    assert_eq!(failure(&mut problems::decay(), &cancelled).kind, SimErrorKind::Cancelled);
}

/// The flag is looked at before every attempt of a step: a simulation without end makes few evaluations
/// after it is set.
#[test]
fn a_long_simulation_ends_soon_after_the_flag_is_set() {
    static CALLS: AtomicUsize = AtomicUsize::new(0);
    static FLAG: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
    const BEFORE: usize = 1000;
    for entry in INTEGRATORS {
        CALLS.store(0, Ordering::Relaxed);
        FLAG.store(false, Ordering::Relaxed);
        let mut endless = problems::oscillator();
        endless.rhs = |_, y, _, out| {
            if CALLS.fetch_add(1, Ordering::Relaxed) + 1 == BEFORE {
                FLAG.store(true, Ordering::Relaxed);
            }
            (out[0], out[1]) = (y[1], -y[0]);
        };
        let settings = Settings {
            cancel: Some(Arc::clone(&FLAG)),
            max_total_steps: u64::MAX,
            output: OutputGrid::Intervals(1_000_000),
            ..by(entry.name, settings(1e6, 1e-6))
        };
        assert_eq!(
            failure(&mut endless, &settings).kind,
            SimErrorKind::Cancelled,
            "{}",
            entry.name
        );
        let more = CALLS.load(Ordering::Relaxed) - BEFORE;
        assert!(more < 200, "{}: {more} evaluations", entry.name);
    }
}

#[test]
fn nominal_values_that_are_none_count_as_one() {
    let expected = final_values(&mut problems::decay(), &settings(1.0, 1e-6));
    for nominal in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut problem = problems::decay();
        problem.nominal = vec![nominal];
        assert_eq!(final_values(&mut problem, &settings(1.0, 1e-6)), expected);
    }
}

#[test]
fn a_simulator_can_be_used_again() {
    let mut simulator = Simulator::new();
    let mut out = Trajectory::default();
    let settings = settings(1.0, 1e-6);
    let mut problems = [
        problems::bouncing_ball as fn() -> TestProblem,
        problems::robertson,
        problems::blow_up,
        problems::algebraic,
        problems::decay,
        problems::switched_input,
        problems::oscillator,
    ]
    .map(|problem| (problem(), problem()));
    for (again, fresh) in &mut problems {
        let reused = simulator.run(again, &settings, &mut out);
        match simulate(fresh, &settings) {
            Ok((trajectory, statistics)) => {
                assert_eq!(reused, Ok(statistics));
                assert_eq!(out, trajectory);
            }
            Err(error) => assert_eq!(reused, Err(error)),
        }
    }
}

#[test]
fn methods_are_found_by_the_names_scripts_use() {
    for name in ["dassl", "Dassl", "ida", "cvode", "lsodar", "bdf"] {
        assert_eq!(find_integrator(name).unwrap().name, "dassl");
    }
    assert_eq!(find_integrator("rk4").unwrap().name, "rungekutta");
    let Err(fault) = find_integrator("dasl") else { panic!("there is no `dasl`") };
    assert_eq!(fault.code.slug, "unknown-choice");
    for entry in INTEGRATORS {
        assert!((entry.make)(&mut crate::registry::Options::default()).is_ok());
    }
}

fn cost(problem: &mut TestProblem, stop: f64) -> String {
    let (_, s) = simulate(problem, &settings(stop, 1e-6)).unwrap();
    format!(
        "{} steps, {} + {} rejected, {} right-hand sides, {} Jacobians, {} factorizations",
        s.steps,
        s.error_failures,
        s.newton_failures,
        s.rhs_evaluations,
        s.jacobian_evaluations,
        s.factorizations
    )
}

#[test]
fn costs_are_known() {
    insta::assert_snapshot!(cost(&mut problems::decay(), 5.0), @"64 steps, 0 + 0 rejected, 129 right-hand sides, 1 Jacobians, 12 factorizations");
    insta::assert_snapshot!(cost(&mut problems::robertson(), 40.0), @"195 steps, 3 + 0 rejected, 454 right-hand sides, 4 Jacobians, 38 factorizations");
    insta::assert_snapshot!(cost(&mut problems::pendulum(), 5.0), @"390 steps, 10 + 0 rejected, 993 right-hand sides, 18 Jacobians, 42 factorizations");
}

#[test]
fn a_fast_transient_is_resolved_days_after_the_start() {
    // With a time constant of 1e-6 s the first step has to be shorter than 1e-9 s.
    let mut problem = TestProblem::new(&[0.0], 1, |_, y, _, out| out[0] = 1e6 * (1.0 - y[0]));
    for method in ["dassl", "radau", "rodas4"] {
        let settings = Settings { start: 4e5, ..by(method, settings(4e5 + 1.0, 1e-6)) };
        let y = final_values(&mut problem, &settings);
        assert!((y[0] - 1.0).abs() < 1e-5, "{method}: {}", y[0]);
    }
}

/// A simulation in parts knows from the last part how long steps may be: attempts as long as a part fail.
#[test]
fn transients_shorter_than_the_digits_of_time_are_resolved() {
    // A rest before the experiment: x' = 1e12 (1/(1 + x) - x) from 0, whose root is the golden ratio.
    // At -1e7 s t has digits of 2e-9 s.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for method in ["dassl", "radau5", "rodas4"] {
        let mut problem = TestProblem::new(&[0.0], 1, |_, y, _, out| {
            out[0] = 1e12 * (1.0 / (1.0 + y[0]) - y[0]);
        });
        let to = Settings { start: -1e7, ..by(method, settings(10.0, 1e-9)) };
        let (trajectory, statistics) = simulate(&mut problem, &to).unwrap();
        let last = *trajectory.column(0).last().unwrap();
        assert!((last - golden).abs() < 1e-9, "{method}: {last}");
        assert!(statistics.steps < 2000, "{method}: {statistics:?}");
    }
}

#[test]
fn parts_go_on_with_the_steps_of_the_last_part() {
    static EVALUATIONS: AtomicUsize = AtomicUsize::new(0);
    let run = |keeps_step: bool| {
        let mut problem = TestProblem::new(&[1.0, 0.0], 2, |_, y, _, out| {
            EVALUATIONS.fetch_add(1, Ordering::Relaxed);
            (out[0], out[1]) = (y[1], -y[0]);
        });
        let (mut simulator, mut out) = (Simulator::new(), Trajectory::default());
        let (mut y, mut next) = ([1.0, 0.0], None);
        EVALUATIONS.store(0, Ordering::Relaxed);
        for part in 0..10 {
            let (start, length) = (20.0 * f64::from(part), 20.0);
            let settings = Settings {
                start,
                stop: start + length,
                output: OutputGrid::At(Vec::new()),
                initial_step: Some(next.filter(|_| keeps_step).unwrap_or(length)),
                ..by("rodas4", settings(length, 1e-8))
            };
            let end = simulator.resume(&mut problem, &settings, &mut y, &mut out).unwrap();
            assert_eq!((end.time, end.why), (start + length, Ended::AtStop));
            next = end.next_step;
        }
        assert!((y[0] - 200.0f64.cos()).abs() < 1e-5, "{y:?}");
        EVALUATIONS.load(Ordering::Relaxed)
    };
    let (kept, without) = (run(true), run(false));
    assert!(kept < without, "{kept} of {without}");
}

/// A simulation that is to end at events ends before what the first of them changes.
#[test]
fn a_simulation_ends_at_the_first_event_where_that_is_asked_for() {
    let mut problem = counter(true);
    let settings = Settings {
        stops_at_events: true,
        output: OutputGrid::At(Vec::new()),
        ..by("rodas4", settings(1.0, 1e-8))
    };
    let mut y = [0.0];
    let mut out = Trajectory::default();
    let end = Simulator::new().resume(&mut problem, &settings, &mut y, &mut out).unwrap();
    assert_eq!(end.why, Ended::AtEvent);
    assert!((end.time - 0.3).abs() < 1e-6 && (y[0] - 0.3f64.sin()).abs() < 1e-6, "{end:?}");
}
