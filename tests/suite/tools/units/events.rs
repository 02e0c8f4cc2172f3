//! Events: of the importer, within steps, and between them.

use super::*;

/// When the ball reaches the ground first, and how fast it is after a time before the second impact.
fn ball(t: f64) -> (f64, f64, f64) {
    let (g, impact) = (9.81, (2.0f64 / 9.81).sqrt());
    let up = 0.7 * g * impact;
    let since = t - impact;
    (impact, up * since - g / 2.0 * since * since, up - g * since)
}

#[test]
fn a_ball_bounces_at_its_event_indicator() {
    let unit = export("Ball", Version::V3).unwrap();
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    exchange.update();
    exchange.plain("fmi3EnterContinuousTimeMode");
    let mut x = exchange.fill("fmi3GetContinuousStates", 2);
    let (impact, _, _) = ball(0.6);
    let indicator = |exchange: &Instance| exchange.fill("fmi3GetEventIndicators", 1)[0];
    runge_kutta(&exchange, 0.0, impact - 1e-6, &mut x);
    let before = indicator(&exchange);
    runge_kutta(&exchange, impact - 1e-6, 2e-6, &mut x);
    assert!(before > 0.0 && indicator(&exchange) < 0.0, "{before}");
    exchange.plain("fmi3EnterEventMode");
    let updated = exchange.update();
    assert_eq!((updated.again, updated.states_changed), (false, true));
    let after = exchange.fill("fmi3GetContinuousStates", 2);
    close(after[1], -0.7 * x[1], 1e-12);
    assert!(indicator(&exchange) > 0.0, "the relation holds now");
}

#[test]
fn a_ball_bounces_within_a_step() {
    let unit = export("Ball", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    assert_eq!(own.step(0.0, 0.6), (0.6, false));
    let (_, h, v) = ball(0.6);
    close(own.get("Float64", "h"), h, 1e-6);
    close(own.get("Float64", "v"), v, 1e-6);
}

/// The importer lets the ball bounce where steps may end early.
#[test]
fn a_step_ends_at_an_event_that_the_importer_handles() {
    let unit = export("Ball", Version::V3).unwrap();
    let interface = unit.description.co_simulation.as_ref().unwrap();
    assert!(interface.has_event_mode && interface.might_return_early);
    let own = Instance::made(&unit, Kind::Events(true));
    own.initialize();
    own.update();
    own.plain("fmi3EnterStepMode");
    let (impact, h, v) = ball(0.6);
    let stepped = own.stepped(0.0, 0.6);
    let expected = Stepped { needs_event: true, is_early: true, terminates: false, ..stepped };
    assert_eq!(stepped, expected);
    close(stepped.time, impact, 1e-7);
    close(own.get("Float64", "v"), -9.81 * impact, 1e-6);
    own.plain("fmi3EnterEventMode");
    assert!(own.update().states_changed);
    own.plain("fmi3EnterStepMode");
    close(own.get("Float64", "v"), 0.7 * 9.81 * impact, 1e-6);
    // That the ball leaves the ground is another event, at which nothing jumps.
    let leaves = own.stepped(stepped.time, 0.6 - stepped.time);
    assert!(leaves.needs_event && (leaves.time - impact).abs() < 1e-6, "{leaves:?}");
    own.plain("fmi3EnterEventMode");
    assert!(!own.update().states_changed);
    own.plain("fmi3EnterStepMode");
    assert_eq!(own.step(leaves.time, 0.6 - leaves.time), (0.6, false));
    close(own.get("Float64", "h"), h, 1e-6);
    close(own.get("Float64", "v"), v, 1e-6);

    // Without early returns it bounces within the step; without event mode there are no modes.
    let own = Instance::made(&unit, Kind::Events(false));
    own.initialize();
    own.update();
    own.plain("fmi3EnterStepMode");
    assert_eq!(own.step(0.0, 0.6), (0.6, false));
    close(own.get("Float64", "h"), h, 1e-6);
    let own = Instance::new(&unit, true);
    own.initialize();
    let enter: Symbol<Plain> = function("fmi3EnterEventMode");
    assert_eq!(unsafe { enter(own.pointer) }, 3);
    let said = |what: &str| MESSAGES.lock().unwrap().iter().any(|message| message.contains(what));
    assert!(said("the instance was made without event mode"));
}

/// A time event at the end of a step is the importer's, and so is one that an input has made due.
#[test]
fn events_between_steps_are_those_of_the_importer() {
    let unit = export("Stair", Version::V3).unwrap();
    let own = Instance::made(&unit, Kind::Events(true));
    own.initialize();
    assert_eq!(own.update().next, Some(1.0));
    own.plain("fmi3EnterStepMode");
    let at_one = Stepped { time: 1.0, needs_event: true, is_early: false, terminates: false };
    assert_eq!(own.stepped(0.0, 1.0), at_one);
    assert_eq!(own.get::<i64>("Int64", "n"), 1);
    own.plain("fmi3EnterEventMode");
    assert_eq!(own.update().next, Some(2.0));
    assert_eq!(own.get::<i64>("Int64", "n"), 2);
    own.plain("fmi3EnterStepMode");
    let at_two = Stepped { time: 2.0, needs_event: true, is_early: true, terminates: false };
    assert_eq!(own.stepped(1.0, 5.0), at_two);

    let unit = export("Driven", Version::V3).unwrap();
    let own = Instance::made(&unit, Kind::Events(true));
    own.initialize();
    own.update();
    own.plain("fmi3EnterStepMode");
    own.set("Float64", "u", 3.0);
    let due = own.stepped(0.0, 1.0);
    assert_eq!((due.time, due.needs_event, due.is_early), (0.0, true, true));
    own.plain("fmi3EnterEventMode");
    own.update();
    own.plain("fmi3EnterStepMode");
    assert!(own.get::<bool>("Boolean", "high"));
    assert_eq!(own.step(0.0, 1.0), (1.0, false));
    close(own.get("Float64", "x"), 3.0 * (1.0 - (-1.0f64).exp()), 1e-6);
}

#[test]
fn an_event_beside_the_end_of_a_step_is_not_missed() {
    let unit = export("Limited", Version::V3).unwrap();
    // The ramp reaches its limit at t = 1: just before the end of the first step, there, or after it.
    for first in [1.0 - 1e-13, 1.0, 1.0 + 1e-13, 1.0 + 1e-11] {
        let own = Instance::new(&unit, true);
        own.initialize();
        own.step(0.0, first);
        own.step(first, 1.0);
        own.step(first + 1.0, 1.0);
        close(own.get("Float64", "x"), 1.0, 1e-7);
        assert!(own.get::<bool>("Boolean", "full"));
    }
}

#[test]
fn time_events_come_when_they_are_announced() {
    let unit = export("Stair", Version::V3).unwrap();
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    let mut updated = exchange.update();
    for n in 1..=3 {
        assert_eq!(exchange.get::<i64>("Int64", "n"), n);
        assert_eq!(updated, Updated { next: Some(n as f64), ..Updated::default() });
        exchange.plain("fmi3EnterContinuousTimeMode");
        exchange.place(n as f64, &[]);
        exchange.plain("fmi3EnterEventMode");
        updated = exchange.update();
    }
    assert!(updated.terminates, "{updated:?}");

    let own = Instance::new(&unit, true);
    own.initialize();
    assert_eq!(own.step(0.0, 2.5), (2.5, false));
    assert_eq!(own.get::<i64>("Int64", "n"), 3);
    assert_eq!(own.step(2.5, 2.5), (3.0, true), "the model ends the simulation");
    let own = Instance::new(&unit, true);
    own.initialize();
    assert_eq!(own.step(0.0, 3.0), (3.0, true), "also where it is the end of a step");
}

/// Periodic clocks tick at announced times, whatever the start time is; clocks of a condition at events.
#[test]
fn clocks_of_a_model_tick_in_its_unit() {
    let unit = export("Clocked", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    for (step, ticks) in [(1, 1), (2, 2), (3, 3), (4, 4), (5, 5), (6, 5), (7, 6)] {
        own.step(0.2 * f64::from(step - 1), 0.2);
        // The first tick, at the start, adds the interval, too.
        close(own.get("Float64", "y"), 0.25 * f64::from(ticks), 1e-12);
    }
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    let next = exchange.update().next;
    assert_eq!(next, Some(0.25));

    let unit = export("Triggered", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    // sin(3 t) rises through 0.5 at t = (pi/6 + 2 pi n)/3.
    for step in 0..50 {
        own.step(0.2 * f64::from(step), 0.2);
        let t = 0.2 * f64::from(step + 1);
        let rises = ((3.0 * t - std::f64::consts::FRAC_PI_6) / std::f64::consts::TAU).floor() + 1.0;
        assert_eq!(own.get::<i64>("Int64", "k"), rises as i64, "{t}");
    }
}

/// x where der(x) = -delay(x, 1), and x = 1 before the start, by the method of steps.
fn late(t: f64) -> f64 {
    let term = |from: f64, power: i32, factor: f64| factor * (t - from).max(0.0).powi(power);
    1.0 - t + term(1.0, 2, 0.5) - term(2.0, 3, 1.0 / 6.0)
}

/// An importer that makes small steps up to the events that are announced.
fn integrated(unit: &Unpacked, stop: f64, mut at: impl FnMut(f64, &Instance)) {
    let own = Instance::new(unit, false);
    own.initialize();
    let mut next = own.update().next;
    own.plain("fmi3EnterContinuousTimeMode");
    let n = unit.description.structure.derivatives.len();
    let indicators = unit.description.structure.event_indicators.len();
    let signs = |own: &Instance| -> Vec<bool> {
        own.fill("fmi3GetEventIndicators", indicators).iter().map(|z| *z > 0.0).collect()
    };
    let (mut t, mut x) = (0.0, own.fill("fmi3GetContinuousStates", n));
    while t < stop {
        let before = signs(&own);
        let to = next.unwrap_or(stop).min(t + 0.02).min(stop);
        runge_kutta(&own, t, to - t, &mut x);
        t = to;
        let is_due = own.complete() || next == Some(t) || signs(&own) != before;
        if is_due {
            own.plain("fmi3EnterEventMode");
            let updated = own.update();
            assert!(!updated.again && updated.next.is_none_or(|next| next > t), "{updated:?}");
            next = updated.next;
            own.plain("fmi3EnterContinuousTimeMode");
        }
        at(t, &own);
    }
}

/// Units read values of the past, whoever integrates them.
#[test]
fn values_of_the_past_are_kept() {
    let unit = export("Late", Version::V3).unwrap();
    let interface = unit.description.model_exchange.as_ref().unwrap();
    assert!(interface.needs_completed_step && !interface.provides_directional_derivatives);
    assert_eq!(unit.description.structure.derivatives[0].dependencies, None);
    integrated(&unit, 3.0, |t, own| close(own.get("Float64", "x"), late(t), 1e-6));
    let own = Instance::new(&unit, true);
    own.initialize();
    for step in 0..10 {
        let t = 0.3 * f64::from(step);
        own.set("Float64", "u", f64::from(step));
        own.step(t, 0.3);
        close(own.get("Float64", "x"), late(t + 0.3), 1e-6);
        close(own.get("Float64", "y"), f64::from(step), 1e-12);
    }
    let pipe = export("Pipe", Version::V3).unwrap();
    let check = |t: f64, own: &Instance| {
        let s: f64 = own.get("Float64", "s");
        close(s, 0.5 * t + 0.25 * (1.0 - t.cos()), 1e-6);
        // The first content is linear from 1 at the entry to e at the exit.
        let first = 1.0 + (1.0 - s) * (1.0f64.exp() - 1.0);
        close(own.get("Float64", "w"), if s > 1.0 { (1.0 - s).exp() } else { first }, 1e-5);
        close(own.get("Float64", "z"), (0.9 * t - 0.5).max(0.0).sin(), 1e-5);
    };
    integrated(&pipe, 5.0, check);
    let own = Instance::new(&pipe, true);
    own.initialize();
    for step in 0..20 {
        own.step(0.25 * f64::from(step), 0.25);
        check(0.25 * f64::from(step + 1), &own);
    }
}

/// A step that is longer than a delay has no result: an importer that does not heed the announced event
/// gets a refusal rather than wrong values.
#[test]
fn steps_past_what_is_known_are_discarded() {
    let unit = export("Late", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    own.initialize();
    assert_eq!(own.update().next, Some(0.25));
    own.plain("fmi3EnterContinuousTimeMode");
    own.place(0.5, &[1.0]);
    let mut out = [0.0];
    let run: Symbol<Array> = function("fmi3GetContinuousStateDerivatives");
    assert_eq!(unsafe { run(own.pointer, out.as_mut_ptr(), 1) }, 2);
    let said = |what: &str| MESSAGES.lock().unwrap().iter().any(|message| message.contains(what));
    assert!(said("is longer than a `delay` of the model"));
}
