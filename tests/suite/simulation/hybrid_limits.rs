//! Models at the limits of their events: what rounding decides, what steps do not see, what
//! statements choose at run time.

use crate::support::simulated::{all_near, near, program, simulated, simulated_with};
use gapilib::internals::sim::Settings;

#[test]
fn a_crossing_that_time_alone_makes_is_seen_though_steps_are_long() {
    let text = "model Switch
        Integer n(start = 0, fixed = true);
        Real x(start = 1, fixed = true);
      equation
        der(x) = 0;
        when sin(7*time) > 0.5 then
          n = pre(n) + 1;
        end when;
      end Switch;";
    let run = simulated(text, 9.0);
    // sin(7 t) > 0.5 begins at (π/6 + 2 π k)/7.
    let expected =
        ((7.0 * 9.0 - std::f64::consts::FRAC_PI_6) / std::f64::consts::TAU).floor() + 1.0;
    assert_eq!(run.last("n"), expected);
}

#[test]
fn a_block_at_the_limit_of_its_friction_begins_to_slide_once() {
    // The force grows to the limit and beyond; a = force - 1 from t = 1 on, so v = (t - 1)²/2.
    let text = include_str!("../../data/models/hybrid_limits_friction.mo");
    let run = simulated(text, 3.0);
    near(run.last("v"), 2.0, 1e-7);
    near(run.at("v", 1.5), 0.125, 1e-7);
}

#[test]
fn a_loop_is_left_under_a_condition_that_varies() {
    let text = include_str!("../../data/models/hybrid_limits_loop.mo");
    let run = simulated(text, 9.0);
    for (t, n) in (0..9).map(|k| (f64::from(k) + 0.5, k + 1)) {
        let first = [2, 4, 6, 8].iter().position(|limit| *limit > n);
        let turns = first.map_or(44, |at| 11 * at + 1);
        assert_eq!(run.at("first", t), first.map_or(0, |at| at + 1) as f64, "n = {n}");
        assert_eq!(run.at("turns", t), turns as f64, "n = {n}");
    }
}

#[test]
fn a_subscript_computed_at_an_event_chooses_what_is_assigned() {
    let text = include_str!("../../data/models/hybrid_limits_subscript.mo");
    let run = simulated(text, 5.0);
    // Written at 0.5, 1.5, 2.5, 3.5, 4.5 with n = 1, 2, 3, 1, 2.
    near(run.last("values[1]"), 3.5, 1e-12);
    near(run.last("values[2]"), 4.5, 1e-12);
    near(run.last("values[3]"), 2.5, 1e-12);
    near(run.last("pairs[1,1]"), 3.5, 1e-12);
    near(run.last("pairs[2,1]"), 4.5, 1e-12);
    assert_eq!(run.last("pairs[2,2]"), 2.0);
}

#[test]
fn a_function_without_outputs_checks_its_arguments() {
    let text = |second: f64| {
        let model = include_str!("../../data/models/hybrid_limits_checked.mo");
        model.replace("{0, 1, 2}", &format!("{{0, {second}, 2}}"))
    };
    simulated(&text(1.0), 1.0);
    let (program, _, _, ended) = crate::support::simulated::attempt(&text(3.0), 1.0);
    let message = program.explain(&ended.unwrap_err()).message.clone();
    assert!(message.contains("not ascending"), "{message}");
}

#[test]
fn a_function_of_scalars_takes_arrays_element_by_element() {
    let text = include_str!("../../data/models/hybrid_limits_elements.mo");
    let run = simulated(text, 2.0);
    let last = ["y[1]", "y[2]", "m[1,1]", "m[2,1]", "m[2,2]", "u[2]", "w[1]"].map(|n| run.last(n));
    assert_eq!(last, [7.0, 5.0, 4.0, 6.0, 10.0, 6.0, -1.0]);
}

#[test]
fn a_delayed_value_began_as_the_first_events_left_it() {
    let text = "model Late
        Integer n(start = 1, fixed = true);
        Real r;
        Integer late;
      equation
        n = if time < 0.75 then 3 else 2;
        r = pre(n);
        late = integer(delay(r, 0.5));
      end Late;";
    let run = simulated(text, 2.0);
    assert_eq!(run.at("late", 0.0), 3.0);
    assert_eq!(run.at("late", 0.52), 3.0);
    assert_eq!(run.at("late", 1.2), 3.0);
    assert_eq!(run.at("late", 1.28), 2.0);
}

#[test]
fn a_trigger_jumps_from_one_branch_to_the_other() {
    // y = limited(1e4 (u + y)/2): up where u passes 1, down where it passes -1.
    let text = "model Trigger
        Real u = 3*sin(time);
        Real v(start = -0.5) = (u + y)/2;
        Real y(start = -1);
      equation
        y = smooth(0, noEvent(if 1e4*v > 1 then 1 elseif 1e4*v < -1 then -1 else 1e4*v));
      end Trigger;";
    let run = simulated(text, 10.0);
    assert_eq!(run.at("y", 0.2), -1.0);
    assert_eq!(run.at("y", 1.0), 1.0);
    assert_eq!(run.at("y", 3.4), 1.0);
    assert_eq!(run.at("y", 4.0), -1.0);
    assert_eq!(run.at("y", 6.4), -1.0);
    assert_eq!(run.at("y", 7.0), 1.0);
}

#[test]
fn smooth_of_order_zero_has_events_at_its_kinks_and_smooth_of_order_one_has_none() {
    let text = |order: u32| {
        format!(
            "model Kink
               Real x(start = -1, fixed = true);
               Real area(start = 0, fixed = true);
             equation
               der(x) = 2;
               der(area) = smooth({order}, if x > 0 then x else 0);
             end Kink;"
        )
    };
    let zero = simulated(&text(0), 2.0);
    // x = 2 t - 1, so the area is (2 t - 1)²/4 from t = 1/2 on.
    near(zero.last("area"), 2.25, 1e-9);
    all_near(&zero.events(), &[0.5], 1e-9);
    let one = simulated(&text(1), 2.0);
    near(one.last("area"), 2.25, 1e-5);
    assert!(one.events().is_empty(), "{:?}", one.events());
}

#[test]
fn semi_linear_has_another_slope_on_each_side() {
    let text = "model Two
        Real m(start = -1, fixed = true);
        Real h;
        Real sum(start = 0, fixed = true);
      equation
        der(m) = 1;
        h = semiLinear(m, 3, 5);
        der(sum) = h;
      end Two;";
    let run = simulated(text, 3.0);
    near(run.at("h", 0.6), -2.0, 1e-9);
    near(run.last("h"), 6.0, 1e-9);
    near(run.last("sum"), -2.5 + 6.0, 1e-9);
    all_near(&run.events(), &[1.0], 1e-9);
}

#[test]
fn no_event_has_none_and_a_plain_branch_has_one() {
    let text = |condition: &str| {
        format!(
            "model Branch
               Real x(start = -1, fixed = true);
               Real y;
             equation
               der(x) = 2;
               y = if {condition} then 1 else 0;
             end Branch;"
        )
    };
    all_near(&simulated(&text("x > 0"), 2.0).events(), &[0.5], 1e-9);
    let live = simulated(&text("noEvent(x > 0)"), 2.0);
    assert!(live.events().is_empty(), "{:?}", live.events());
    assert_eq!((live.at("y", 0.48), live.at("y", 0.52)), (0.0, 1.0));
}

#[test]
fn texts_change_at_events() {
    let text = include_str!("../../data/models/hybrid_limits_strings.mo");
    let run = simulated(text, 3.0);
    assert_eq!((run.at("code", 0.6), run.at("fresh", 0.6)), (331.0, 1.0));
    assert_eq!((run.at("code", 1.5), run.at("fresh", 1.5)), (222.0, 0.0));
    assert_eq!((run.at("code", 2.4), run.at("changes", 2.4)), (112.0, 2.0));
}

#[test]
fn a_dip_within_one_step_is_seen() {
    let text = "model M Real x(start = 1, fixed = true); Integer n(start = 0, fixed = true);
        Integer never(start = 0, fixed = true);
        equation der(x) = 2*(time - 1);
        when x < 1e-5 then n = pre(n) + 1; end when;
        when x < -1e-6 then never = pre(never) + 1; end when; end M;";
    // x = (t - 1)², a polynomial, so that steps are as long as they may be.
    for (method, tolerance) in [("dassl", 1e-6), ("dassl", 1e-9), ("radau", 1e-6)] {
        let method = gapilib::internals::sim::find_integrator(method).unwrap();
        let settings = Settings { method, tolerance, stop: 2.0, ..Settings::default() };
        let run = simulated_with(text, &settings);
        assert_eq!(run.values("n").last(), Some(&1.0), "{tolerance}");
        assert_eq!(run.values("never").last(), Some(&0.0), "{tolerance}");
        run.follows("x", 1e-4, |t| (t - 1.0) * (t - 1.0));
    }
}

#[test]
fn an_assertion_fails_at_the_time_when_it_begins_to() {
    let text = "model M Real x(start = 1, fixed = true); equation der(x) = -1;
        assert(x > 0.5, \"level below half\"); end M;";
    for method in ["dassl", "radau", "rodas4", "dopri5", "dop853", "euler"] {
        let method = gapilib::internals::sim::find_integrator(method).unwrap();
        let settings = Settings { method, ..Settings::default() };
        let error = gapilib::internals::sim::simulate(&mut program(text).system(), &settings);
        let error = error.expect_err("the assertion fails");
        assert!((error.time - 0.5).abs() < 1e-6, "{}: {}", method.name, error.time);
    }
}

/// What holds behind an instant has no values at the instant itself: it begins a little later.
#[test]
fn a_branch_that_begins_behind_an_instant_is_not_evaluated_at_it() {
    let mean = "model Mean
        Real y(start = 0, fixed = true);
        Real z;
      equation
        der(y) = 2;
        z = if time <= 0 then 5 else y/time;
      end Mean;";
    let run = simulated(mean, 1.0);
    assert_eq!(run.values("z")[0], 5.0);
    near(run.last("z"), 2.0, 1e-9);
    let later = include_str!("../../data/models/hybrid_limits_instant_later.mo");
    let run = simulated(later, 1.0);
    near(run.at("z", 0.25), 5.0, 0.0);
    near(run.last("z"), 2.0, 1e-9);
    // The samples of the instant itself come once.
    assert_eq!([run.last("n"), run.last("m")], [5.0, 1.0]);
    // Elsewhere all that happens at one time is one event.
    let plain = later.replace("(time - 0.5)", "(time + 0.5)");
    assert_eq!(simulated(&plain, 1.0).events(), [0.25, 0.5, 0.75, 1.0]);
}
