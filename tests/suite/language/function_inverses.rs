//! Inverses that functions declare (MLS §12.8).

use crate::support::simulated::simulated;

#[test]
fn an_inverse_that_is_none_is_not_used() {
    // What is declared gives 2/3 and 20; the solutions are 1 and 12.
    let model = "model Main \
        function rate input Real u; input Real k; output Real y; \
        algorithm y := k*(u + u^3); annotation(Inline = false, inverse(u = drop(y, k = k))); \
        end rate; function drop input Real y; input Real k; output Real u; \
        algorithm u := y/k/3; annotation(Inline = false, inverse(y = rate(u, k))); end drop; \
        parameter Real k = 2; Real x; Real y; \
        equation 3*rate(x, k) + 1 = 13; drop(y, k) = 2; end Main;";
    let run = simulated(model, 1.0);
    assert!((run.values("x")[0] - 1.0).abs() < 1e-12 && (run.values("y")[0] - 12.0).abs() < 1e-12);
}

#[test]
fn an_inverse_of_a_part_of_the_range_solves_an_equation_that_stands_alone() {
    // Below 0.1 `drop` gives half of what solves the equation. Alone, x is what it gives; in the loop
    // the equations hold.
    let model = "model Main \
        function rate input Real u; output Real y; algorithm \
        y := if noEvent(u > 0.1) then u else u/2 + 0.05; \
        annotation(Inline = false, inverse(u = drop(y))); end rate; \
        function drop input Real y; output Real u; \
        algorithm u := if noEvent(y > 0.1) then y else y - 0.05; end drop; \
        Real x; Real y; Real z; \
        equation rate(x) = 0.06; rate(y) = 0.075 - z; z = 0.1*y; end Main;";
    let run = simulated(model, 1.0);
    assert!((run.values("x")[0] - 0.01).abs() < 1e-15);
    assert!((run.values("y")[0] - 0.025 / 0.6).abs() < 1e-9);
}

#[test]
fn a_declared_inverse_solves_its_equation() {
    // No step of Newton's method: the value has the bits of the function.
    let model = "model Main \
        function rate input Real u; input Real k; output Real y; algorithm \
        y := if u >= 0 then k*sqrt(u) else -k*sqrt(-u); \
        annotation(Inline = false, inverse(u = drop(y, k = k))); end rate; \
        function drop input Real y; input Real k; output Real u; \
        algorithm u := y/k*abs(y/k); end drop; \
        parameter Real k = 2; Real x; equation 3*rate(x, k) + 1 = 13; end Main;";
    assert_eq!(simulated(model, 1.0).values("x")[0], 4.0);
}
