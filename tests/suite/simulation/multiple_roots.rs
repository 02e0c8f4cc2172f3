//! Loops at solutions where the Jacobian is singular and that are isolated all the same.

use crate::support::simulated::{near, simulated};

/// A fan whose head is given: its speed is that of r |r| = p.
fn fan(head: &str, pressure: &str) -> String {
    format!(
        "model Fan function head input Real r; output Real p; algorithm {head} \
         annotation(Inline = false); end head; \
         Real p = {pressure}; Real r; Real q(start = 0, fixed = true); \
         equation head(r) = p; der(q) = r; end Fan;"
    )
}

const SQUARE: &str = "if r >= 0 then p := 6e4*r^2; else p := -6e4*r^2; end if;";

#[test]
fn a_fan_starts_from_rest() {
    // At rest the Jacobian is zero, and the slope of r over p is infinite.
    let run = simulated(&fan(SQUARE, "if time < 1 then 0 else 6e4*(time - 1)^2"), 3.0);
    near(run.at("r", 0.6), 0.0, 1e-9);
    near(run.at("r", 3.0), 2.0, 1e-6);
    near(run.at("q", 3.0), 2.0, 1e-3);
}

#[test]
fn rounding_errors_at_rest_do_no_harm() {
    for noise in ["1e-13", "-1e-13", "1e-8", "-1e-8"] {
        let run = simulated(&fan(SQUARE, &format!("6e4*max(time - 1, 0)^2 + {noise}")), 3.0);
        near(run.at("r", 3.0), 2.0, 1e-6);
        near(run.at("q", 3.0), 2.0, 1e-3);
    }
}

#[test]
fn a_solution_that_ends_goes_on_elsewhere() {
    // For p > 0 there is but one solution, beyond r = 1/4.
    let head = "if r >= 0 then p := r^2*(4*r - 1); else p := -r^2; end if;";
    let run = simulated(&fan(head, "if time < 1 then 0 else 1.5*(time - 1)"), 3.0);
    near(run.at("r", 0.6), 0.0, 1e-9);
    near(run.at("r", 3.0), 1.0, 1e-6);
}
