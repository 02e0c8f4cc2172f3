//! Models at the limits of their events: what rounding decides, what steps do not see, what
//! statements choose at run time.

use super::hybrid::{near, simulated};

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
    let text = "model Block
        parameter Real limit = 1;
        Real v(start = 0, fixed = true);
        Real s;
        Real a;
        Boolean slides(start = false, fixed = true);
        Boolean begins(start = false, fixed = true);
      equation
        begins = not pre(slides) and (s > limit or pre(begins) and s > limit);
        slides = begins and v > 0 or pre(slides) and v > 0;
        a = if not (begins or pre(slides)) then 0 else s - limit;
        a = time - (if not (begins or pre(slides)) then s else limit);
        der(v) = a;
      end Block;";
    let run = simulated(text, 3.0);
    near(run.last("v"), 2.0, 1e-7);
    near(run.at("v", 1.5), 0.125, 1e-7);
}

#[test]
fn a_loop_is_left_under_a_condition_that_varies() {
    let text = "model First
        Integer n(start = 0, fixed = true);
        Integer first(start = 0, fixed = true);
        Integer turns(start = 0, fixed = true);
        constant Integer limits[4] = {2, 4, 6, 8};
      algorithm
        when sample(0.5, 1) then
          n := pre(n) + 1;
          first := 0;
          turns := 0;
          for i in 1:4 loop
            turns := turns + 1;
            if limits[i] > n then
              first := i;
              break;
            end if;
            turns := turns + 10;
          end for;
        end when;
      end First;";
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
    let text = "model Buffer
        Integer n(start = 0, fixed = true);
        Real values[3](each start = 0, each fixed = true);
        Real pairs[2, 2](each start = 0, each fixed = true);
      algorithm
        when sample(0.5, 1) then
          n := mod(pre(n), 3) + 1;
          values[n] := time;
          pairs[if n > 1 then 2 else 1, :] := {time, n};
        end when;
      end Buffer;";
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
        format!(
            "model Checked
               function check
                 input Real table[:];
               algorithm
                 for i in 2:size(table, 1) loop
                   assert(table[i] > table[i - 1], \"not ascending\");
                 end for;
               end check;
               parameter Real table[3] = {{0, {second}, 2}};
               Real x(start = 1, fixed = true);
             initial algorithm
               check(table);
             equation
               der(x) = -x;
             end Checked;"
        )
    };
    simulated(&text(1.0), 1.0);
    let (program, _, _, ended) = super::hybrid::attempt(&text(3.0), 1.0);
    let message = program.explain(&ended.unwrap_err()).message.clone();
    assert!(message.contains("not ascending"), "{message}");
}

#[test]
fn a_function_of_scalars_takes_arrays_element_by_element() {
    let text = "model Elements
        function f
          input Real a;
          input Real b;
          output Real y = 2*a + b;
          output Real z = a - b;
        end f;
        Real y[2] = f({time, 1}, 3);
        Real m[2, 2] = f([1, 2; 3, 4], [time, 0; 0, time]);
        Real u[2];
        Real w[2];
      equation
        (u, w) = f({1, time}, {time, 2});
      end Elements;";
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
