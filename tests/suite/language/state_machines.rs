//! State machines (MLS chapter 17) against values that the specification gives or that follow by
//! hand.

use crate::support::simulated::{Run, attempt, compiled, simulated};

/// The values at the ticks 0, 1, 2, … of a clock with this interval.
#[track_caller]
fn ticks(run: &Run, name: &str, interval: f64, expected: &[f64]) {
    let times = (0..expected.len()).map(|tick| tick as f64 * interval + interval / 4.0);
    let found: Vec<f64> = times.map(|time| run.held(name, time)).collect();
    let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9;
    assert!(found.iter().zip(expected).all(close), "{name}: {found:?}, not {expected:?}");
}

/// The code, message and first place of what is wrong.
#[track_caller]
fn refused(text: &str) -> (String, String, String) {
    match compiled(text) {
        Ok(_) => panic!("the model is accepted: {text}"),
        Err(error) => {
            let place = error.labels.first().map(|label| label.span);
            let place = place.map_or("", |span| &text[span.start as usize..span.end as usize]);
            (error.code.slug.to_owned(), error.message.clone(), place.to_owned())
        }
    }
}

/// States A and B that count their ticks in n and m, and add 1 and 10 to v.
fn two_states(equations: &str) -> String {
    format!(
        "model M inner Integer v(start = 0);
         block A outer output Integer v; Integer n(start = 0);
         equation v = previous(v) + 1; n = previous(n) + 1; end A;
         block B outer output Integer v; Integer m(start = 0);
         equation v = previous(v) + 10; m = previous(m) + 1; end B;
         A a; B b; Integer k(start = 0) = previous(k) + 1;
         Integer tick = sample(1, Clock(1, 10)) + k;
         Boolean ina = activeState(a);
         equation initialState(a); {equations} end M;"
    )
}

#[test]
fn a_state_is_active_for_the_ticks_that_the_specification_gives() {
    // MLS §17.1: A1 at 10 ms to 14 ms.
    let run = simulated(
        "model M block State end State; State A0; State A1; State A2;
         Boolean a1 = activeState(A1); Boolean a2 = activeState(A2);
         equation initialState(A0);
         transition(A0, A1, sample(time, Clock(1, 1000)) > 0.0095);
         transition(A1, A2, ticksInState() >= 5, immediate = false); end M;",
        0.02,
    );
    let active = |from: usize, to: usize| {
        (0..19).map(|tick| f64::from(u8::from((from..to).contains(&tick)))).collect::<Vec<_>>()
    };
    ticks(&run, "a1", 1e-3, &active(10, 15));
    ticks(&run, "a2", 1e-3, &active(15, 19));
}

const HIERARCHICAL: &str = include_str!("../../data/models/state_machines_hierarchical.mo");

/// The values of v, count, i, w and j by the prose of MLS §17.3.7.
fn by_hand(ticks: usize) -> [Vec<f64>; 5] {
    let (mut v, mut count, mut i, mut w, mut j) = (0, 0, 0, 0, 0);
    let (mut in1, mut abcd, mut in_x, mut reset_j) = (true, 'A', true, true);
    let mut rows: [Vec<f64>; 5] = Default::default();
    for _ in 0..ticks {
        if in1 {
            match abcd {
                'A' => v += 2,
                'B' => v -= 1,
                'C' => count += 1,
                _ => {}
            }
            if in_x {
                (i, w) = (i + 1, v);
            } else {
                j = if std::mem::take(&mut reset_j) { 1 } else { j + 1 };
            }
        } else {
            v += 5;
        }
        for (row, value) in rows.iter_mut().zip([v, count, i, w, j]) {
            row.push(f64::from(value));
        }
        // What is active at the next tick.
        match (in1, abcd == 'D' && !in_x, v >= 20) {
            (true, true, _) => in1 = false,
            (false, _, true) => {
                (in1, abcd, in_x, reset_j, count, i) = (true, 'A', true, true, 0, 0);
            }
            (true, false, _) => {
                abcd = match abcd {
                    'A' if v >= 6 => 'B',
                    'B' if v == 0 => 'C',
                    'C' if count >= 2 => 'D',
                    'C' => 'A',
                    same => same,
                };
                in_x &= i <= 20;
            }
            (false, _, false) => {}
        }
    }
    rows
}

/// Values at ticks at which a state is reset are seen at the tick only.
#[test]
fn hierarchical_and_parallel_machines_follow_the_specification() {
    let conditions = [
        "activeState(state1.stateD) and activeState(state1.stateY)",
        // The same by the last paragraph of MLS §17.3.7.
        "true, synchronize = true",
    ];
    for leave in conditions {
        let run = simulated(&HIERARCHICAL.replace("LEAVE", leave), 119.9);
        let names = ["v", "state1.count", "state1.stateX.i", "state1.stateX.w", "state1.stateY.j"];
        let expected = by_hand(119);
        for (name, row) in names.iter().zip(&expected) {
            // `count` and `i` show their start values one tick earlier by hand than they are set.
            ticks(&run, name, 1.0, row);
        }
    }
}

#[test]
fn immediate_transitions_fire_at_the_tick_and_delayed_ones_at_the_next() {
    for (immediate, switch) in [("true", 3), ("false", 4)] {
        let run = simulated(
            &two_states(&format!("transition(a, b, k >= 4, immediate = {immediate});")),
            0.7,
        );
        let v = |tick: i32| f64::from((tick + 1).min(switch) + 10 * (tick + 1 - switch).max(0));
        ticks(&run, "v", 0.1, &(0..6).map(v).collect::<Vec<_>>());
        let active = |tick| f64::from(u8::from(tick < switch));
        ticks(&run, "ina", 0.1, &(0..6).map(active).collect::<Vec<_>>());
    }
}

#[test]
fn the_lower_number_is_the_higher_priority_whatever_the_kind() {
    let text = |one: &str, other: &str| {
        format!(
            "model M block S end S; S a; S b; S c; Boolean inb = activeState(b);
             Integer k(start = 0) = previous(k) + 1; Integer u = sample(1, Clock(1, 10)) + k;
             equation initialState(a); transition(a, b, {one}); transition(a, c, {other}); end M;"
        )
    };
    for (one, other, b) in [
        ("k >= 2, priority = 1", "k >= 2, priority = 2", [0.0, 1.0, 1.0]),
        ("k >= 2, priority = 3", "k >= 2, priority = 2", [0.0, 0.0, 0.0]),
        ("k >= 1, immediate = false, priority = 1", "k >= 2, priority = 2", [0.0, 1.0, 1.0]),
        ("k >= 1, immediate = false, priority = 2", "k >= 2, priority = 1", [0.0, 0.0, 0.0]),
    ] {
        ticks(&simulated(&text(one, other), 0.35), "inb", 0.1, &b);
    }
}

#[test]
fn a_reset_transition_sets_start_values_and_another_one_keeps_them() {
    for (reset, n) in [("true", [1., 2., 2., 1., 2., 2.]), ("false", [1., 2., 2., 3., 4., 4.])] {
        let run = simulated(
            &two_states(&format!(
                "transition(a, b, mod(k, 3) == 2, immediate = false);
                 transition(b, a, true, immediate = false, reset = {reset});"
            )),
            0.7,
        );
        ticks(&run, "a.n", 0.1, &n);
        // m in b is always reset, v never.
        ticks(&run, "b.m", 0.1, &[0., 0., 1., 1., 1., 1.]);
        ticks(&run, "v", 0.1, &[1., 2., 12., 13., 14., 24.]);
    }
}

#[test]
fn a_self_transition_restarts_ticks_and_time_in_a_state() {
    let run = simulated(
        "model M block S Integer n; Real t; equation n = ticksInState(); t = timeInState(); end S;
         S a; Integer k(start = 0) = previous(k) + 1; Integer u = sample(1, Clock(1, 10)) + k;
         equation initialState(a); transition(a, a, k > 0 and ticksInState() >= 3, immediate = false);
         end M;",
        0.7,
    );
    ticks(&run, "a.n", 0.1, &[1., 2., 3., 1., 2., 3.]);
    ticks(&run, "a.t", 0.1, &[0., 0.1, 0.2, 0., 0.1, 0.2]);
}

#[test]
fn a_synchronized_transition_waits_for_final_states() {
    for immediate in ["true", "false"] {
        let run = simulated(
            &format!(
                "model M block S end S;
                 block Meta S one; S two; Integer n(start = 0); equation n = previous(n) + 1;
                 initialState(one); transition(one, two, n >= 3, immediate = false); end Meta;
                 Meta a; S b; Boolean inb = activeState(b); Boolean two = activeState(a.two);
                 Integer u = sample(1, Clock(1, 10));
                 equation initialState(a);
                 transition(a, b, u > 0, synchronize = true, immediate = {immediate}); end M;"
            ),
            0.7,
        );
        ticks(&run, "two", 0.1, &[0., 0., 0., 1., 0., 0.]);
        ticks(&run, "inb", 0.1, &[0., 0., 0., 0., 1., 1.]);
        ticks(&run, "a.n", 0.1, &[1., 2., 3., 4., 4., 4.]);
    }
}

#[test]
fn arrays_algorithms_and_assertions_belong_to_their_states() {
    let text = "model M inner Real x(start = 1);
         block S parameter Real f = 2; parameter Real limit = 5; outer output Real x;
         Real y[2](each start = 0);
         algorithm y := {x, 2*x}; equation x = f*previous(x); assert(x < limit, \"large\"); end S;
         S s[2](f = {2, 3}, limit = {5, 20}); Integer k(start = 0) = previous(k) + 1;
         Integer u = sample(1, Clock(1, 10)) + k;
         equation initialState(s[1]); transition(s[1], s[2], k == 3); transition(s[2], s[1], k == 4);
         end M;";
    // x is 12 at the third tick, when the assertion of s[1] would be violated.
    let run = simulated(text, 0.25);
    ticks(&run, "x", 0.1, &[2., 4., 12.]);
    ticks(&run, "s[1].y[2]", 0.1, &[4., 8., 8.]);
    ticks(&run, "s[2].y[1]", 0.1, &[0., 0., 12.]);
    let (program, _, _, ended) = attempt(text, 0.35);
    let message = program.explain(&ended.expect_err("s[1] is active again")).message.clone();
    assert!(message.contains("large (at t = 0.3"), "{message}");
}

#[test]
fn what_is_no_state_machine_is_refused_with_a_place() {
    let invalid = [
        ("initialState(b); transition(a, b, k > 3);", "initialState(b)"),
        ("transition(a, b, k > 3); transition(a, b, k > 4);", "transition(a, b, k > 4)"),
        ("transition(a, b, k > 3, priority = 0);", "transition(a, b, k > 3, priority = 0)"),
        ("initialState(b);", "b"),
    ];
    for (equations, place) in invalid {
        let (code, message, found) = refused(&two_states(equations));
        assert_eq!((&*code, &*found), ("invalid-state-machine", place), "{message}");
    }
    let model = |declarations: &str, equations: &str| {
        format!(
            "model M block S end S; S a; S b; {declarations}
             Integer k(start = 0) = previous(k) + 1; Integer u = sample(1, Clock(1, 10)) + k;
             equation {equations} end M;"
        )
    };
    let others = [
        ("", "transition(a, b, k > 3);", "invalid-state-machine"),
        ("Boolean c = activeState(a);", "", "invalid-state-machine"),
        ("Integer n = ticksInState() + k;", "", "invalid-state-machine"),
        ("", "initialState(a); transition(a, b, ticksInState() > 3);", "not-supported"),
        (
            "block C Real x(start = 0); equation der(x) = 1; end C; C c;",
            "initialState(a); transition(a, c, k > 3);",
            "not-supported",
        ),
        (
            "block C Integer n = sample(2, Clock(1, 7)); end C; C c;",
            "initialState(a); transition(a, c, k > 3);",
            "clock-conflict",
        ),
        ("", "initialState(u); transition(a, b, k > 3);", "type-mismatch"),
    ];
    for (declarations, equations, expected) in others {
        let (code, message, place) = refused(&model(declarations, equations));
        assert_eq!(code, expected, "{message}");
        assert!(!place.is_empty(), "{message}");
    }
}

#[test]
fn outputs_of_several_states_that_are_connected_are_refused() {
    let (code, message, _) = refused(
        "model M connector Out = output Integer; connector In = input Integer;
         block S Out y(start = 0); equation y = previous(y) + 1; end S;
         block Use In u; Integer w = 2*u; end Use; S a; S b; Use c;
         equation initialState(a); transition(a, b, a.y > 3, immediate = false);
         connect(a.y, c.u); connect(b.y, c.u); end M;",
    );
    assert_eq!(code, "invalid-connection", "{message}");
}
