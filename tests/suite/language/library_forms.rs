//! What libraries write that the specification allows, or that other programs accept: every case is
//! simulated, and `x` at the end is the value that follows from the specification.

use gapilib::Diagnostic;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Access, Program};
use gapilib::internals::flatten::{Flattened, Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::sim::{Settings, simulate};
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;

/// The model `P.M` of a package whose contents these are.
pub fn flattened(contents: &str) -> Flattened {
    attempted(contents).expect("a model")
}

pub fn attempted(contents: &str) -> Result<Flattened, Vec<Diagnostic>> {
    let text = format!("package P {contents} end P;");
    let file = parse_stored_definition(SourceId::NONE, &text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    flatten(&library, &Name::parse("P.M"), &[])
}

/// Values of `x` at the start and at t = 1.
fn both_ends(contents: &str) -> [f64; 2] {
    let flat = flattened(contents).model;
    let program = Program::compile(causalize(&flat).expect("it can be sorted"));
    let program = program.expect("it compiles");
    let mut system = program.system();
    let to_one = Settings { stop: 1.0, ..Settings::default() };
    let trajectory = simulate(&mut system, &to_one).expect("a simulation").0;
    let at = program.find_variable("x").expect("there is an x");
    match program.variables()[at].access {
        Access::Observed { column, negated } => {
            let column = trajectory.column(column);
            let sign = if negated { -1.0 } else { 1.0 };
            [sign * column[0], sign * column[trajectory.len() - 1]]
        }
        _ => [system.value(at).expect("x has a value"); 2],
    }
}

pub fn at_end(contents: &str) -> f64 {
    both_ends(contents)[1]
}

/// The codes of the warnings.
fn warnings(contents: &str) -> Vec<&'static str> {
    flattened(contents).warnings.iter().map(|one| one.code.slug).collect()
}

/// A position in an array of Strings, by a loop whose subscript is computed.
const POSITION: &str = "function position input String names[:]; input String name; \
    output Integer k; algorithm k := 0; for i in 1:size(names, 1) loop \
    if names[i] == name then k := i; end if; end for; end position;";

#[test]
fn elements_and_sizes_of_constant_strings_are_known() {
    let array_iteration = "package Air constant String names[3] = {\"a\", \"b\", \"c\"}; end Air; \
        model M replaceable package Medium = Air; \
        Real y[3] = {if Medium.names[i] == \"b\" then i else 0 for i in 1:3}; \
        Real x = sum(y); end M;";
    assert_eq!(at_end(array_iteration), 2.0);
    let size = "model A parameter String names[:] = {\"a\", \"b\"}; Real y[size(names, 1)] = \
        fill(2, size(names, 1)); end A; model M A a(names = {\"p\", \"q\", \"r\"}); \
        Real x = sum(a.y); end M;";
    assert_eq!(at_end(size), 6.0);
    let arranged = "model M parameter String n[2, 2] = {{\"a\", \"b\"}, {\"c\", \"d\"}}; \
        parameter String row[:] = cat(1, n[2, :], fill(\"e\", 2)); \
        Real x = (if row[2] == \"d\" then 1 else 0) + (if row[4] == \"e\" then 2 else 0) \
        + 10*size(row, 1); end M;";
    assert_eq!(at_end(arranged), 43.0);
}

#[test]
fn functions_take_arrays_of_strings() {
    let of_constants = format!(
        "{POSITION} model M Real x = position({{\"a\", \"b\", \"c\"}}, \"b\")*time; end M;"
    );
    assert_eq!(at_end(&of_constants), 2.0);
    // What depends on time too is compiled: the loop is unrolled.
    let compiled = "function weight input String names[:]; input Real t; output Real w; \
        algorithm w := 0; for i in 1:size(names, 1) loop \
        if names[i] == \"b\" and t > 0.5 then w := w + i*t; end if; end for; end weight; \
        model M Real x = weight({\"a\", \"b\", \"b\"}, time); end M;";
    assert_eq!(at_end(compiled), 5.0);
    let initial = "package Air constant String names[2] = {\"a\", \"b\"}; end Air; \
        model M parameter Integer k(fixed = false); Real x = k; initial algorithm k := 0; \
        for i in 1:size(Air.names, 1) loop if Air.names[i] == \"b\" then k := i; end if; end for; \
        end M;";
    assert_eq!(at_end(initial), 2.0);
}

#[test]
fn a_replaceable_class_is_judged_where_it_is_used() {
    let text = "partial package One constant Integer n = 1; end One; \
        partial package Two extends One; constant Integer k = 3; end Two; \
        package Medium extends Two; end Medium; \
        model Part replaceable package Used = Two; Real y = Used.k; end Part; \
        model Whole replaceable package Used = One; Part part(redeclare package Used = Used); \
        end Whole; model M Whole w(redeclare package Used = Medium); Real x = w.part.y; end M;";
    assert_eq!(at_end(text), 3.0);
}

#[test]
fn a_protected_constant_may_stand_in_the_default_of_an_output() {
    let text = "record R Real y[:]; Real z[size(y, 1)]; end R; \
        function f input Real p; output R r(y = {0, 1, 2}, z = fill(p, n)); \
        protected constant Integer n = 3; algorithm r.y := {0, p, 2}; end f; \
        function g input Real t; output Real s; protected R r = f(t); \
        algorithm s := r.z[2] + r.y[2]; end g; \
        model M parameter R r = f(2); Real x = r.z[2] + r.y[2] + g(time); end M;";
    assert_eq!(at_end(text), 6.0);
}

#[test]
fn old_forms_are_warnings() {
    let bound = "model M Real x(start = 2, fixed = true, unbounded = true); equation der(x) = 0; \
        end M;";
    assert_eq!(at_end(bound), 2.0);
    assert!(warnings(bound).is_empty());

    let from_outside = "model M model Part Real y = 3; end Part; M.Part part; Real x = part.y; \
        end M;";
    assert_eq!(at_end(from_outside), 3.0);
    assert_eq!(warnings(from_outside), ["illegal-access"]);

    let unbalanced = "connector W flow Real q; Real a; Real b; end W; \
        model S W w; equation w.a = 1; w.b = 2; end S; \
        model T W w; Real x; equation w.q = 1; x = w.a + w.b; end T; \
        model M S s; T t; Real x = t.x; equation connect(s.w, t.w); end M;";
    assert_eq!(at_end(unbalanced), 3.0);
    assert!(warnings(unbalanced).contains(&"class-restriction"));

    let ordinal = "type Side = enumeration(n, p); function f input Side side; output Integer s; \
        algorithm s := 7 - 2*side; end f; model M Real x = f(Side.p); end M;";
    assert_eq!(at_end(ordinal), 3.0);
    assert_eq!(warnings(ordinal), ["type-mismatch"]);

    let stored = "type Side = enumeration(n, p, q); model S parameter Side side = Side.n; \
        Real y = if side == Side.q then 4 else 1; end S; \
        model M final parameter Integer k = 3; S s(side = k); Real x = s.y; end M;";
    assert_eq!(at_end(stored), 4.0);
    assert_eq!(warnings(stored), ["type-mismatch"]);
}

#[test]
fn enumerations_with_the_same_literals_are_one_type() {
    let text = "type A = enumeration(a, b); type B = enumeration(a, b); \
        model I parameter A a = A.a; Real y = if a == A.b then 2 else 1; end I; \
        model M import P.B.b; parameter B given = b; I i(a = given); Real x = i.y; end M;";
    assert_eq!(at_end(text), 2.0);
    let other = "package P type A = enumeration(a, b); type B = enumeration(b, a); \
        model M parameter B b = B.b; parameter A a = b; end M; end P;";
    let file = parse_stored_definition(SourceId::NONE, other).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let errors = flatten(&library, &Name::parse("P.M"), &[]).expect_err("other literals");
    assert_eq!(errors[0].code.slug, "type-mismatch");
}

#[test]
fn constructors_are_told_apart_by_what_calls_give() {
    let text = "operator record Z Real k; encapsulated operator 'constructor' \
        function a import P.Z; input Boolean z[:] = fill(false, 0); input Real k = 1; \
        output Z r(k = k); algorithm end a; \
        function b import P.Z; input Real n[:] = fill(0, 0); input Real k = 1; \
        output Z r(k = 2*k); algorithm end b; end 'constructor'; end Z; \
        model M Z z = Z({1.0, 2.0}, time); Real x = z.k; end M;";
    assert_eq!(at_end(text), 2.0);
}

#[test]
fn components_declared_alike_are_one_however_their_type_is_spelled() {
    let text = "package Units type Frequency = Real(unit = \"1/s\"); end Units; \
        model B import P.Units; parameter Units.Frequency f = 50 \"one\"; end B; \
        model M extends B; parameter P.Units.Frequency f = 50 \"another\"; Real x = f; end M;";
    assert_eq!(at_end(text), 50.0);
    let other = "package P type F = Real; type G = Real(unit = \"m\"); \
        model B parameter F f = 50; end B; model M extends B; parameter G f = 50; end M; end P;";
    let file = parse_stored_definition(SourceId::NONE, other).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    let errors = flatten(&library, &Name::parse("P.M"), &[]).expect_err("other types");
    assert_eq!(errors[0].code.slug, "duplicate-element");
}

#[test]
fn elements_of_empty_arrays_are_no_errors_where_parameters_switch_them_off() {
    let part = "connector C Real p; flow Real m; end C;";
    let first = format!(
        "{part} model M parameter Integer n = 0; C c[n]; Real x = if n > 0 then c[1].p else 4; \
         end M;"
    );
    assert_eq!(at_end(&first), 4.0);
    let last = format!(
        "{part} model M parameter Integer n = 0; C c[n]; \
         Real x = if n == 0 then 5 elseif time > 2 then 1 else c[1].p; end M;"
    );
    assert_eq!(at_end(&last), 5.0);
}

#[test]
fn sizes_follow_from_records_within_records() {
    let text = "record T parameter Real m = 1; parameter Real tot = m*n; \
        parameter Integer n = size(coo, 1); parameter Real coo[:, 2]; end T; \
        record E extends T(coo = {{0, 0}, {1, 1}, {2, 2}}); end E; \
        record C parameter T con; end C; record D extends C(con = E()); end D; \
        model B parameter C d; Real y = d.con.tot; end B; \
        model M parameter D c; B b(d = c); Real x = b.y; end M;";
    assert_eq!(at_end(text), 3.0);
    let field = "record W parameter Integer m = 2; parameter Real a = 1; end W; \
        function f input W w; input Real t; output Real y[w.m]; \
        protected Real z[w.m]; algorithm z := fill(w.a, w.m); y := t*z; end f; \
        model M parameter W w(m = 3, a = 2); Real y[3] = f(w, time); Real x = sum(y); end M;";
    assert_eq!(at_end(field), 6.0);
}

#[test]
fn vectors_of_subscripts_may_be_parameters() {
    let known = "model M parameter Integer id[2] = {3, 1}; Real u[3] = {1, 2, 3}*time; \
        Real y[2] = u[id]; Real x = 10*y[1] + y[2]; end M;";
    assert_eq!(at_end(known), 31.0);
    let booleans = "model M parameter Integer id[2] = {3, 1}; \
        Boolean u[3] = {time > 0.5, true, false}; Boolean y[2]; Real x; \
        equation y = u[id]; x = (if y[1] then 1 else 0) + (if y[2] then 2 else 0); end M;";
    assert_eq!(at_end(booleans), 2.0);
    // Here the positions change during the simulation.
    let discrete = "model M Integer k = if time > 0.5 then 3 else 2; Real u[3] = {1, 2, 3}*time; \
        Real y[2] = u[{k, k - 1}]; Real x = 10*y[1] + y[2]; end M;";
    assert_eq!(at_end(discrete), 32.0);
}

#[test]
fn a_function_s_variable_has_not_the_sizes_of_a_model_s_array() {
    let text = "function g input Real u; output Real y; end g; \
        function h extends g; input Real p; algorithm y := p*u; end h; \
        function apply input g f; input Real u; output Real y; algorithm y := f(u); end apply; \
        function q input Real len; output Real y; algorithm y := apply(function h(p = len), 2); \
        end q; model M parameter Real len[2] = {10, 20}; Real y[2]; Real x = y[1] + y[2]; \
        equation for j in 1:2 loop y[j] = q(len = len[j]); end for; end M;";
    assert_eq!(at_end(text), 60.0);
}

#[test]
fn a_connection_of_a_disabled_component_adds_nothing_to_a_bus() {
    let text = "expandable connector Bus end Bus; connector In = input Real; \
        model Part parameter Boolean use = false; In t if use; Bus bus; \
        equation connect(t, bus.temperature); end Part; \
        model M Part part; Real x = 7; end M;";
    assert_eq!(at_end(text), 7.0);
}

#[test]
fn a_fixed_start_is_the_value_of_one_s_own_pre() {
    let text = "model M Boolean y; Boolean u(start = false, fixed = true); Real x; \
        initial algorithm y := true; \
        equation when sample(0.7, 1) then y = not pre(y); end when; \
        u = y; x = (if change(u) then 1 else 0) + (if y then 2 else 0); end M;";
    // At the start `u` has changed; the iteration of events ends with `pre(u) = u`.
    assert_eq!(both_ends(text), [2.0, 0.0]);
}

/// Records and functions of libraries that were written before Modelica 3.
#[test]
fn variables_that_should_be_protected_or_public_are_warnings() {
    let within_record = "model S parameter Real f = 50; end S; \
        record N parameter Real f = s.f; parameter Real g = 2; protected outer S s; end N; \
        function twice input N n; output Real y; algorithm y := 2*n.f + n.g; end twice; \
        model A parameter N n; Real y = twice(n); end A; \
        model M inner S s(f = 60); A a; Real x = a.y; end M;";
    assert_eq!(at_end(within_record), 122.0);
    assert!(warnings(within_record).contains(&"class-restriction"));

    let within_function = "function f input Real u; output Real y; Real half = u/2; \
        algorithm y := half + 1; end f; model M Real x = f(4); end M;";
    assert_eq!(at_end(within_function), 3.0);
}

#[test]
fn an_input_that_nothing_uses_needs_no_connection() {
    let reference = "connector In = input Real; model S parameter Boolean driven = false; In w; \
        Real omega; equation if driven then omega = w; else omega = 3; end if; end S;";
    assert_eq!(at_end(&format!("{reference} model M S s; Real x = s.omega; end M;")), 3.0);
    let driven = format!("{reference} model M S s(driven = true); end M;");
    let errors = attempted(&driven).expect_err("an input is missing");
    assert_eq!(errors[0].code.slug, "unbalanced-model");
}

#[test]
fn arrays_of_strings_may_be_determined_by_equations_and_loops() {
    let by = |section: &str, equals: &str| {
        format!(
            "model M String s[3]; Real x = (if s[1] == \"a\" then 1 else 0) \
             + (if s[2] == \"b\" then 2 else 0) + (if s[3] == \"c\" then 4 else 0); \
             {section} for t in {{\"a\", \"b\", \"c\"}} loop if t == \"a\" then s[1] {equals} t; \
             elseif t == \"b\" then s[2] {equals} if time < 0.5 then \"q\" else t; \
             else s[3] {equals} t; end if; end for; end M;"
        )
    };
    assert_eq!(both_ends(&by("equation", "=")), [5.0, 7.0]);
    assert_eq!(both_ends(&by("algorithm", ":=")), [5.0, 7.0]);
}

#[test]
fn a_string_of_an_operator_record_is_that_of_its_operator() {
    let text = "operator record Pair Integer a; encapsulated operator function 'String' \
        import P.Pair; input Pair p; input Integer offset = 0; output String s; algorithm \
        s := \"<\" + String(p.a + offset) + \">\"; end 'String'; end Pair; \
        model M Pair p = Pair(7); Boolean b = String(p) == \"<7>\"; \
        Boolean c = String(p, offset = 2) == \"<9>\"; \
        Real x = (if b then 1 else 0) + (if c then 2 else 0); end M;";
    assert_eq!(at_end(text), 3.0);
}

/// MLS §3.8.4 requires discrete-time expressions for Integers; functions that sort return both.
#[test]
fn integers_among_several_outputs_may_change_between_events() {
    let text = "function largest input Real u[:]; output Real y; output Integer at; algorithm \
        y := u[1]; at := 1; for i in 2:size(u, 1) loop if u[i] > y then y := u[i]; at := i; \
        end if; end for; end largest; \
        model M Real y; Integer at; Real x = at; equation (y, at) = largest({1 - time, time}); \
        end M;";
    assert_eq!(both_ends(text), [1.0, 2.0]);
}

#[test]
fn a_sum_with_iterators_has_the_sizes_of_what_is_added() {
    let text = "function columns input Real v[:, :]; input Integer n; output Real s[size(v, 1)]; \
        protected Integer k = 0; algorithm while k < 1 loop k := k + 1; \
        s := sum(v[:, j] for j in 1:n); end while; end columns; \
        model M Real y[2] = sum({i*time, 2*i} for i in 1:3); \
        Real w[2] = columns([1, 2, time; 4, 5, 6], 3); \
        Real x = y[1] + 10*y[2] + 100*w[1] + 1000*w[2]; end M;";
    assert_eq!(at_end(text), 6.0 + 120.0 + 400.0 + 15_000.0);
    let scalar = "model M Real x = sum({i, 2*i} for i in 1:3); end M;";
    assert!(causalize(&flattened(scalar).model).is_err(), "a vector is not a scalar");
}

/// MLS §9.4.1: a type keeps the function of the one that it is made of.
#[test]
fn types_made_of_overdetermined_ones_are_overdetermined() {
    let parts = "type Angle extends Real; function equalityConstraint input Angle a[:]; \
        input Angle b[:]; output Real r[0]; algorithm end equalityConstraint; end Angle; \
        package S type A = Angle; end S; type Further = S.A; \
        connector C Further phi[2]; Real v; flow Real i; end C; \
        model Source parameter Real v = 1; C c; equation c.v = v; \
        Connections.potentialRoot(c.phi); \
        if Connections.isRoot(c.phi) then c.phi = {time, 2}; end if; end Source; \
        model Line C a; C b; equation a.i + b.i = 0; a.v - b.v = a.i; \
        Connections.branch(a.phi, b.phi); b.phi = a.phi; end Line; ";
    let model = "model M Source s; Source t(v = 3); Line l; \
        Real x = l.b.phi[1] + 10*l.b.phi[2] + 100*l.b.i; \
        equation connect(s.c, l.a); connect(l.b, t.c); end M;";
    assert_eq!(at_end(&format!("{parts}{model}")), 1.0 + 20.0 + 200.0);
}

#[test]
fn the_level_of_an_assertion_may_be_a_parameter() {
    let text = "model M parameter AssertionLevel level = AssertionLevel.warning; Real x = time; \
        equation assert(x < 0.5, \"x is large\", level); end M;";
    assert_eq!(at_end(text), 1.0);
}

#[test]
fn parameters_may_be_called_inputs() {
    let text = "block B parameter input Integer n = 1; output Real y = n*time; end B; \
        model M B b(n = 3); Real x = b.y; end M;";
    assert_eq!(at_end(text), 3.0);
    assert!(warnings(text).contains(&"illegal-prefix"));
}

/// MLS §7.2.5: `each` says that all elements have the value; libraries forget it.
#[test]
fn one_value_without_each_is_that_of_all_elements() {
    let part = "model Part parameter Boolean on = false; parameter Real k = 1; \
        Real y = if on then k*time else 0; end Part; ";
    let model = "model M parameter Real k = 2; Part p[2](on = true, k = 3*k); \
        Real x = p[1].y + p[2].y; end M;";
    let text = format!("{part}{model}");
    assert_eq!(at_end(&text), 12.0);
    assert!(warnings(&text).contains(&"size-mismatch"));
}

/// `each` is about the array of components: what follows is the whole value of each of them.
#[test]
fn the_value_of_each_component_may_be_a_computed_array() {
    let part = "model Part parameter Real a[3] = {1, 1, 1}; parameter Real s = 1; \
        Real x = s*sum(a)*time; end Part; \
        function f input Real x; output Real y[3]; algorithm y := {x, 2*x, 3*x}; end f; ";
    for (value, expected) in [
        ("2*{1, 2, 3}", 24.0),
        ("{1, 2, 3}*2", 24.0),
        ("{1, 2, 3} + {1, 1, 1}", 18.0),
        ("{1, 2, 3} .* {2, 2, 2}", 24.0),
        ("[1, 0, 0; 0, 2, 0; 0, 0, 3]*{1, 1, 1}", 12.0),
        ("f(1)", 12.0),
        ("b", 30.0),
        ("b/5", 6.0),
        ("if k > 1 then b else {0, 0, 0}", 30.0),
        ("{i for i in 1:3}", 12.0),
        ("1:3", 12.0),
        ("7", 42.0),
        ("{1, 2, 3}*{1, 1, 1}", 36.0),
    ] {
        let model = format!(
            "{part} model M parameter Real k = 2; parameter Real b[3] = {{4, 5, 6}}; \
             Part p[2](each a = {value}); Real x = p[1].x + p[2].x; end M;"
        );
        assert_eq!(at_end(&model), expected, "{value}");
    }
}

#[test]
fn modifiers_of_a_class_are_those_of_each_element_of_an_array_of_it() {
    let text = "record R parameter Real c[2] = {0, 0}; parameter Real k = 0; end R; \
        record Data = R(c = {1, 2}, k = 3); \
        model Base parameter Real a = 1; Real y; end Base; \
        model Element extends Base; parameter Real f = 1; equation y = a*f*time; end Element; \
        model Holder parameter Integer n = 2; \
        replaceable model El = Element constrainedby Base(final a = 10/n); El el[n]; end Holder; \
        model M parameter Data d[2]; Holder h(redeclare model El = Element(f = 100)); \
        Real x = d[2].c[2] + 10*d[1].k + h.el[2].y; end M;";
    assert_eq!(at_end(text), 2.0 + 30.0 + 500.0);
    assert!(!warnings(text).contains(&"size-mismatch"));
}

#[test]
fn each_element_of_an_array_of_records_has_the_arrays_of_one_value() {
    let text = "record Mat parameter Real k; end Mat; \
        record Layers parameter Integer n; parameter Mat mat[n]; end Layers; \
        record Par parameter Real a = 0; parameter Layers layers; end Par; \
        model M parameter Layers dummy(n = 2, mat = {Mat(k = 1), Mat(k = 5)}); \
        parameter Par p[2](each a = 4, each layers = dummy); \
        Real x = p[2].layers.mat[2].k + 10*p[1].a; end M;";
    assert_eq!(at_end(text), 45.0);
}

/// MLS §7.3.2: they hold for the class that the clause stands behind as well.
#[test]
fn constraining_modifiers_of_a_redeclaration_hold_for_its_own_class() {
    let records = "record Data parameter Real k = 1; parameter Real l = 1; end Data; \
        record Other extends Data; end Other; \
        model Part replaceable parameter Data d constrainedby Data(l = 2); \
        Real y = d.k + 10*d.l; end Part; \
        model Base extends Part(redeclare replaceable parameter Other d \
        constrainedby Data(k = 7)); end Base; ";
    let model = |text: &str| at_end(&format!("{records} model M {text} Real x = p.y; end M;"));
    assert_eq!(model("Base p;"), 27.0);
    assert_eq!(model("Base p(redeclare Other d);"), 27.0);
    assert_eq!(model("Base p(redeclare Other d(k = 3));"), 23.0);
    let classes = "model A parameter Real k = 1; Real y = k*time; end A; \
        model B extends A; end B; \
        model Part replaceable model T = A; T t; end Part; \
        model Base extends Part(redeclare replaceable model T = B constrainedby A(k = 7)); \
        end Base; model C extends A; end C; ";
    let model = |text: &str| at_end(&format!("{classes} model M {text} Real x = p.t.y; end M;"));
    assert_eq!(model("Base p;"), 7.0);
    assert_eq!(model("Base p(redeclare model T = C);"), 7.0);
    assert_eq!(model("Base p(redeclare model T = C(k = 2));"), 2.0);
}

#[test]
fn what_is_not_replaceable_is_redeclared_with_a_warning() {
    let text = "model A Real y = 1; end A; model B Real y = 2; end B; \
        model Part A a; Real y = a.y; end Part; \
        model M Part p(redeclare B a); Real x = p.y; end M;";
    assert_eq!(at_end(text), 2.0);
    assert!(warnings(text).contains(&"illegal-redeclaration"));
}

#[test]
fn arrays_inherited_twice_are_one() {
    let text = "partial model A parameter Integer n = 2; Real u[n] \"one\"; end A; \
        partial model B parameter Integer n = 2; Real u[n] \"another\"; end B; \
        model M extends A; extends B; Real x = u[2]; equation u = {1, 2}; end M;";
    assert_eq!(at_end(text), 2.0);
    let other = text.replacen("Real u[n] \"another\"", "Real u[3]", 1);
    assert!(attempted(&other).is_err(), "two sizes");
}

#[test]
fn a_slice_of_components_gives_each_element_its_record() {
    let text = "record R Real a; Real b; end R; model Pin R v; equation v = R(time, 2*time); \
        end Pin; model M Pin pin[3]; R all[3] = pin[:].v; Real x = all[2].a + 10*all[3].b; end M;";
    assert_eq!(at_end(text), 21.0);
}

#[test]
fn overloaded_constructors_are_found_by_enumerations() {
    let text = "type E = enumeration(a, b); operator record D Real m; E e; \
        encapsulated operator 'constructor' import P.D; import P.E; \
        function both input Real m; input E e; output D d(m = m, e = e); algorithm end both; \
        function named input Real a = 1; input E kind = E.a; output D d(m = 10*a, e = kind); \
        algorithm end named; end 'constructor'; end D; \
        model M parameter D d = D(a = 2, kind = E.b); Real x = d.m + (if d.e == E.b then 1 else 0); \
        end M;";
    assert_eq!(at_end(text), 21.0);
}

/// MLS §4.4.5: the connection goes with the component.
#[test]
fn connections_with_what_does_not_exist_need_no_element() {
    let text = "connector C Real p; flow Real f; end C; \
        model Part C c[1]; equation c.p = {time}; end Part; \
        model M parameter Boolean on = false; parameter Integer at[2] = {1, 0}; Part s; \
        C a; C b if on; Real x = a.p; equation connect(s.c[at[1]], a); \
        connect(s.c[at[2]], b); end M;";
    assert_eq!(at_end(text), 1.0);
    assert!(attempted(&text.replacen("on = false", "on = true", 1)).is_err(), "no such element");
}

#[test]
fn extremes_of_no_elements_are_those_of_the_type() {
    let text = "model M parameter Integer n = 0; Real u[n] = {time for i in 1:n}; \
        Real x = min(min(u), 3) + max(max(u), 4); end M;";
    assert_eq!(at_end(text), 7.0);
}

#[test]
fn icons_of_packages_may_be_classes() {
    let text = "partial package Icon end Icon; partial class Own extends Icon; end Own; \
        package Q extends Own; constant Real k = 2; end Q; model M Real x = Q.k; end M;";
    assert_eq!(at_end(text), 2.0);
}

#[test]
fn protected_variables_and_conditional_components_are_read_with_a_warning() {
    let text = "model A protected Real q = 2*time; end A; \
        model M parameter Boolean on = true; A a; Real u if on; Real x = a.q + u; \
        equation if on then u = 1; end if; end M;";
    assert_eq!(at_end(text), 3.0);
    let codes = warnings(text);
    assert!(codes.contains(&"protected-access") && codes.contains(&"conditional-component"));
}

#[test]
fn arrays_of_components_have_sizes() {
    let text = "model Zone Real t = time; end Zone; model Rooms parameter Integer n = 2; \
        Zone zone[n, 3]; end Rooms; \
        model M Rooms rooms; Real q[size(rooms.zone, 2)] = rooms.zone[1, :].t; \
        Real x = sum(q) + 10*size(rooms.zone, 1); equation \
        assert(size(rooms.zone, 1) == 2, \"two rows\"); end M;";
    assert_eq!(at_end(text), 23.0);
}

#[test]
fn elements_of_arrays_of_components_are_chosen_at_events() {
    let text = "record R parameter Real k = 1; end R; model S Real y = time; end S; \
        model M parameter R r[2] = {R(1), R(2)}; S s[2]; \
        Integer stage = if time < 0.5 then 1 else 2; \
        Real x = r[stage].k + 10*s[stage].y; end M;";
    assert_eq!(both_ends(text), [1.0, 12.0]);
}

#[test]
fn slices_in_algorithms_have_sizes_of_run_time() {
    let text = "model M parameter Real p[4] = {1, 2, 4, 8}; \
        Boolean on[4] = {time > 0.1, time > 0.9, time > 0.3, time > 2}; \
        Integer list[4](each start = 0, each fixed = true); Integer n(start = 0, fixed = true); \
        discrete Real s(start = 0, fixed = true); discrete Real part[4](each start = 0, \
        each fixed = true); Real x = s + 100*sum(part); \
        algorithm when sample(0.2, 0.3) then n := 0; list := zeros(4); for i in 1:4 loop \
        if on[i] then n := n + 1; list[n] := i; end if; end for; s := sum(p[list[1:n]]); \
        part := zeros(4); if n > 1 then part[2:n] := fill(1/n, n - 1); end if; end when; end M;";
    // At t = 0.8 the first and the third are on.
    assert_eq!(at_end(text), 1.0 + 4.0 + 100.0 * 0.5);
}

#[test]
fn functions_cut_arrays_at_computed_places() {
    let text = "function without input Real v[:]; input Integer at; \
        output Real rest[size(v, 1) - 1]; protected Integer n; algorithm n := size(v, 1); \
        rest[1:at - 1] := v[1:at - 1]; rest[at:n - 1] := v[at + 1:n]; end without; \
        model M Integer at = integer(2*time) + 1; Real y[3] = without({1, 2, 4, 8}, at); \
        Real x = y[1] + 10*y[2] + 100*y[3]; end M;";
    assert_eq!(both_ends(text), [2.0 + 40.0 + 800.0, 1.0 + 20.0 + 800.0]);
}

#[test]
fn a_computed_size_that_does_not_fit_is_a_fault() {
    let text = "function cut input Real v[:]; input Integer n; output Real s; \
        algorithm s := 0; for i in 1:2 loop s := s + sum(v[1:n + i]); end for; end cut; \
        model M Integer n = integer(8*time); Real x = cut({1, 2, 4}, n); end M;";
    let flat = flattened(text).model;
    let program = Program::compile(causalize(&flat).expect("it can be sorted"));
    let program = program.expect("it compiles");
    let to_one = Settings { stop: 1.0, ..Settings::default() };
    let failed = simulate(&mut program.system(), &to_one).expect_err("five elements of three");
    let message = program.explain(&failed).message.clone();
    assert!(message.contains("the subscript 4 is outside 1:3"), "{message}");
}

#[test]
fn recursive_functions_count_their_depth() {
    // The depth is a number in the first call; the sizes depend on another number.
    let text = "function best input Integer depth; input Integer n; input Real v[:]; \
        input Boolean used[:]; output Boolean chosen[n]; output Real sum; \
        protected Boolean other[n]; Real more; algorithm chosen := used; sum := 0; \
        if depth <= n then (other, more) := best(depth + 1, n, v, used, limit = 0); \
        chosen := other; chosen[depth] := v[depth] > time_of(v); \
        sum := more + (if chosen[depth] then v[depth] else 0); end if; end best; \
        function time_of input Real v[:]; output Real t; algorithm t := v[1]; end time_of; \
        model M Boolean chosen[3]; Real x; equation \
        (chosen, x) = best(1, 3, {time, 2*time, 3*time}, {false, false, false}); end M;"
        .replace(", limit = 0", "");
    assert_eq!(at_end(&text), 5.0);
}

#[test]
fn what_a_when_clause_assigns_is_discrete_behind_it_too() {
    let text = "function positive input Real u; output Boolean y; algorithm y := u > 0; \
        end positive; block Choice input Real t; output Boolean done; Boolean inner_; \
        Boolean tick = time > 0.5; algorithm inner_ := false; when tick then \
        inner_ := positive(t); end when; done := inner_ and tick; end Choice; \
        model M Real s(start = 1, fixed = true); Choice c(t = s); \
        discrete Real x(start = 0, fixed = true); equation der(s) = 1; \
        when c.done then x = time; end when; end M;";
    assert!((at_end(text) - 0.5).abs() < 1e-9);
}

#[test]
fn loops_with_computed_ends_read_previous_values() {
    let text = "model M Integer n(start = 0, fixed = true); \
        discrete Real x(start = 1, fixed = true); \
        algorithm when sample(0.25, 0.25) then n := pre(n) + 1; x := 0; \
        for i in 1:n loop x := x + i*pre(x); end for; end when; end M;";
    // 1·1, then 1·(1 + 2), then 3·(1 + 2 + 3), then 18·(1 + 2 + 3 + 4).
    assert_eq!(at_end(text), 180.0);
}

#[test]
fn connectors_that_are_passed_on_have_the_sizes_of_the_first() {
    let text = "connector T parameter Integer n; Real phi[n]; flow Real f[n]; end T; \
        expandable connector Node end Node; model S parameter Integer n_in = 2; \
        parameter Real k = 1; T port[2](each n = n_in); equation for i in 1:2 loop \
        port[i].f = k*port[i].phi - fill(time, n_in); end for; end S; \
        model M parameter Integer m = 2; S a(n_in = m), b(k = 3, n_in = m); Node common, other; \
        Real x = sum(a.port[1].phi); equation connect(a.port[1], common.node); \
        connect(b.port[1], common.node); connect(a.port[2], other.node); \
        connect(b.port[2], other.node); end M;";
    // φ - t + 3 φ - t = 0, two elements.
    assert_eq!(at_end(text), 1.0);
}

/// What is passed on into a component whose part for it is switched off has one equation for each flow.
#[test]
fn what_is_passed_on_to_a_disabled_part_flows_nowhere() {
    let text = "connector Pin Real v; flow Real i; end Pin; \
        expandable connector Phase end Phase; expandable connector Bus end Bus; \
        model Source Pin p; equation p.v = 3 + 2*p.i; end Source; \
        model Gas Phase phase; Source h2; equation connect(h2.p, phase.H2); end Gas; \
        model Region parameter Boolean has_gas = true; Bus bus; Gas gas if has_gas; Gas other; \
        equation connect(gas.phase, bus.gas); connect(other.phase, bus.other); end Region; \
        model Layer parameter Boolean has_gas = true; Bus bus; Region region(has_gas = has_gas); \
        equation connect(region.bus, bus); end Layer; \
        model M Layer a; Layer b(has_gas = false); Real x = a.region.gas.h2.p.v; \
        equation connect(a.bus, b.bus); end M;";
    assert_eq!(at_end(text), 3.0);
}

#[test]
fn expandable_connectors_within_new_members_get_members_too() {
    let text = "connector Pin Real v; flow Real i; end Pin; expandable connector Bus end Bus; \
        model Source Pin p; equation p.v = time; end Source; \
        model Sensor Pin p; equation p.i = 0; end Sensor; \
        model Phase Bus side; Source s; equation connect(s.p, side.H2); end Phase; \
        model Region Bus side; Phase gas; equation connect(gas.side, side.gas); end Region; \
        model Load Bus side; Sensor s; Real v = s.p.v; equation connect(s.p, side.H2); end Load; \
        model M Region region; Load load; Bus bus; Real x = load.v; equation \
        connect(region.side, bus); connect(bus.gas, load.side); end M;";
    assert_eq!(at_end(text), 1.0);
}

/// MLS §9.1.3, §9.2: nothing flows into a component that does not use what its bus carries.
#[test]
fn flows_that_a_component_does_not_use_are_zero() {
    let text = "connector Flange Real phi; flow Real tau; end Flange; \
        expandable connector Bus end Bus; connector Out = output Real; \
        model Hand Flange wheel; equation wheel.phi = time; end Hand; \
        model Driver Bus bus; Hand hand; equation connect(hand.wheel, bus.wheel); end Driver; \
        model Two Out y = 2; end Two; model ByWire Bus bus; Two two; equation \
        connect(two.y, bus.u); end ByWire; model M Driver d; ByWire e; \
        Real x = d.hand.wheel.phi + d.hand.wheel.tau; equation connect(d.bus, e.bus); end M;";
    assert_eq!(at_end(text), 1.0);
}

/// BioChem: which side of a connector with flows gives its signals shows in the whole.
#[test]
fn signals_in_connectors_with_flows_may_be_outputs_on_both_sides() {
    let text = "connector Node Real c; flow Real r; output Real V; end Node; \
        model Pool Node n; Real amount(start = 1, fixed = true); equation \
        der(amount) = n.r; n.c = amount; n.V = 2; end Pool; \
        model Inside Node n; Real seen; equation n.r = 0.5; seen = n.V; end Inside; \
        model M Pool a; Inside b; Real x = b.seen + a.amount; equation connect(a.n, b.n); end M;";
    assert!((at_end(text) - 2.5).abs() < 1e-6);
    let signals = "block A output Real y = time; end A; block B output Real y; end B; \
        model M A a; B b; Real x = b.y; equation connect(a.y, b.y); end M;";
    // Two sources that agree are a warning.
    assert_eq!(at_end(signals), 1.0);
}

#[test]
fn empty_arrays_of_vectors_have_the_sizes_of_the_vectors() {
    let text = "model M parameter Integer n = 0; Real p[n, 3] = {{0, i, time} for i in 1:n}; \
        Real x = size(p, 2) + sum(p); end M;";
    assert_eq!(at_end(text), 3.0);
}

/// MLS §3.7.4.4.
#[test]
fn defaults_of_inputs_may_ask_for_the_instance_that_calls() {
    let text = "function length input String s = getInstanceName(); output Integer n; \
        algorithm n := 0; if s == \"M.part\" then n := 6; end if; end length; \
        model Part Integer n = length(); end Part; \
        model M Part part; Real x = part.n; end M;";
    assert_eq!(at_end(text), 6.0);
}

/// MLS §6.7: enumerations with the same literals in the same order are one type.
#[test]
fn relations_and_modifiers_accept_enumerations_with_the_same_literals() {
    let types = |literals: &str| {
        format!(
            "package A type E = enumeration(low, high); end A; \
             package B type E = enumeration({literals}); end B; \
             model Part parameter A.E kind = A.E.low; Real y = if kind == B.E.high then 2 else 1; \
             end Part; model M Part part(kind = B.E.high); Real x = part.y; end M;"
        )
    };
    assert_eq!(at_end(&types("low, high")), 2.0);
    let other = attempted(&types("high, low")).expect_err("other types");
    assert_eq!(other[0].code.slug, "type-mismatch");
    let in_functions = "type D = enumeration(low, high); type E = enumeration(low, high); \
        function f input D d; input Real t; output Real y; algorithm \
        y := if d == E.high then 3*t else t; end f; \
        model M E e = E.high; Real x = f(e, time); end M;";
    assert_eq!(at_end(in_functions), 3.0);
}

/// IDEAS: `22*.ones(n)`, the name of a function of the language in the global scope.
#[test]
fn functions_of_the_language_stand_in_the_global_scope() {
    assert_eq!(at_end("model M Real v[2] = 3*.ones(2) .+ .cos(0); Real x = sum(v); end M;"), 8.0);
    let other = "function cos input Real u; output Real y = 5*u; end cos; \
        model M Real x = .cos(0); end M;";
    assert!(attempted(other).is_err(), "the global scope has no such class");
}

/// MLS §10.3.4.1: the sum of arrays is an array, even if these have no elements, if there are no
/// arrays, or if only numbers can choose them.
#[test]
fn sums_of_arrays_are_arrays() {
    let of_none = "model M parameter Integer n = 0; Real v[n, 3]; \
        Real y[3] = {1, 2, 3} + sum(v[i, :] .* {1, 2, 3} for i in 1:n); Real x = y[3]; end M;";
    assert_eq!(at_end(of_none), 3.0);
    let manifold = |substances: u8| {
        format!(
            "connector C parameter Integer n = {substances}; Real p; flow Real m; stream Real X[n]; \
             end C; model Manifold C a; C b[2]; equation b[1].m = -a.m/2; b[2].m = b[1].m; \
             b[1].p = a.p; for i in 1:2 loop inStream(a.X) = b[i].X; end for; \
             a.X = sum(inStream(b[i].X) for i in 1:2)/2; end Manifold; \
             model Source C a; equation a.m = -1; a.X = fill(0.25, a.n); end Source; \
             model Sink C a; parameter Real X0 = 0; equation a.p = 1; a.X = fill(X0, a.n); end Sink; \
             model M Source s; Manifold q; Sink d[2](X0 = {{0.5, 1.5}}); \
             Real x = 3 + sum(inStream(s.a.X)); equation connect(s.a, q.a); connect(q.b, d.a); end M;"
        )
    };
    assert_eq!(at_end(&manifold(0)), 3.0);
    assert_eq!(at_end(&manifold(1)), 4.0);
    assert_eq!(at_end(&manifold(2)), 5.0);
}

/// MLS §3.3: branches are evaluated only where their condition holds; the same is expected of `and`
/// and `or`. What divides by p, or takes its logarithm, is evaluated at p = 0 in none of these.
#[test]
fn what_a_condition_excludes_is_not_evaluated() {
    let p = "Real p = max(0, time - 0.5); Real x = ";
    for guarded in [
        "if p > 0 and 1/p < 3 then 1 else 0",
        "if p <= 0 or 1/p >= 3 then 0 else 1",
        "if p > 0 then (if 1/p < 3 then 1 else 0) else 0",
        "if noEvent(p > 0 and 1/p < 3) then 1 else 0",
        "if p > 0 and log(p) > -1 then 1 else 0",
        "f(p)",
    ] {
        let f = "function f input Real p; output Real y; algorithm y := 0; \
            if p > 0 and 1/p < 3 then y := 1; end if; end f;";
        assert_eq!(
            both_ends(&format!("{f} model M {p} {guarded}; end M;")),
            [0.0, 1.0],
            "{guarded}"
        );
    }
    let sampled = "model M discrete Real p(start = 0, fixed = true); \
        Integer n(start = 0, fixed = true); Real x = n; algorithm when sample(0, 0.25) then \
        p := if time > 0.3 then time else 0; \
        if p > 0 and 1/p < 3 then n := pre(n) + 1; end if; end when; end M;";
    assert_eq!(at_end(sampled), 3.0);
    let nothing = "model M parameter Integer n = 0; Real v[n] = fill(time, n); \
        Real x = if n > 0 and v[1] > 0.5 then 1 else 2; end M;";
    assert_eq!(at_end(nothing), 2.0);
}

/// LinearSystems2: the sizes of a redeclaration name what the function around it declares, not what
/// the record has under the same names (MLS §7.3).
const STATE_SPACE: &str = include_str!("../../data/models/library_forms_state_space.mo");

#[test]
fn sizes_of_redeclared_components_name_the_function() {
    let known = "model M parameter S a = S([1, 2; 3, 4], [5; 6]); \
        parameter Real b[:, :] = a.B; Real x = a.A[2, 1] + b[2, 1] + time; end M;";
    assert_eq!(at_end(&format!("{STATE_SPACE} {known}")), 3.0 + 12.0 + 1.0);
    let at_run_time = "function f input Real a; output Real y; \
        protected S s(redeclare Real A[2, 2], redeclare Real B[2, 1]); \
        algorithm s := S([a, 2; 3, 4], [5; 6]); \
        y := s.A[1, 1] + s.B[2, 1]; end f; model M Real x = f(time); end M;";
    assert_eq!(at_end(&format!("{STATE_SPACE} {at_run_time}")), 1.0 + 12.0);
}

/// The second argument is a scalar: no constructor whose input is a matrix is called element by
/// element where another one takes it.
#[test]
fn a_constructor_with_the_right_numbers_of_dimensions_is_chosen() {
    let model = "model M parameter S a = S([1, 2; 3, 4], 3); \
        Real x = a.B[2, 3] + size(a.B, 2)*time; end M;";
    assert_eq!(at_end(&format!("{STATE_SPACE} {model}")), 23.0 + 3.0);
}

/// FCSys ElectricalConduction: nothing tells the sizes of the elements of a sum over no connectors.
#[test]
fn a_sum_over_no_components_adds_nothing_to_an_array() {
    let model = "connector C Real v[2]; flow Real q[2]; end C; \
        model M parameter Integer n = 0; C c[n]; \
        Real y[2] = {time, 2*time} + sum(c[i].v for i in 1:n); \
        Real z[2] = sum(c[i].q for i in 1:n) + {3, 4*time}; \
        Real w[2] = {5, 6*time} - 3*sum(c[i].q for i in 1:n); \
        Real x = y[2] + 10*z[2] + 100*w[2]; end M;";
    assert_eq!(at_end(model), 2.0 + 40.0 + 600.0);
}

/// SolarTherm connects inputs and variables of type Real, which no connector declares (MLS §9.1).
#[test]
fn connected_variables_are_equal() {
    let model = "model Cooler input Real T; Real y = 2*T; end Cooler; \
        model M Cooler cooler; Real T; Real x = cooler.y; \
        equation connect(cooler.T, T); T = 3 + time; end M;";
    assert_eq!(at_end(model), 8.0);
    let two = "model M Real a; Real b; Real x = b; equation connect(a, b); a = time; end M;";
    assert_eq!(at_end(two), 1.0);
    let record = "record R Real a; end R; model M R a; R b; Real x = b.a; \
        equation connect(a, b); a.a = time; end M;";
    assert!(attempted(record).is_err());
}

/// TRANSFORM MFBS: the size of a local variable follows from what the function computed before, with
/// a parameter that could be set otherwise.
#[test]
fn parameters_of_functions_with_computed_sizes_are_evaluated() {
    let model = "function changes input Real a[:]; input Real bias; \
        output Real y[integer(sum(a)) + 1]; \
        protected Real b[size(a, 1)] = a .+ bias; Integer n = integer(sum(b)); Real c[n]; \
        algorithm for i in 1:n loop c[i] := i*i; end for; \
        for i in 1:size(y, 1) loop y[i] := sum(c[1:min(i, n)]); end for; end changes; \
        model M parameter Real w[2] = {1, 2}; parameter Real bias = 1; \
        final parameter Real t[:] = changes(w, bias); Real x = t[end] + 100*size(t, 1)*time; end M;";
    assert_eq!(at_end(model), 1.0 + 4.0 + 9.0 + 16.0 + 400.0);
    let program = Program::compile(causalize(&flattened(model).model).expect("it can be sorted"));
    let program = program.expect("it compiles");
    let at = program.find_variable("bias").expect("there is a bias");
    assert!(matches!(program.variables()[at].access, Access::Constant(_)), "it can be set");
}

/// FrequencySweepVoltageSource of the standard library 4.0.0 declares what it inherits again, without
/// its attribute `min`; MLS §7.1 requires declarations that are identical.
#[test]
fn what_is_inherited_and_declared_may_differ_in_attributes() {
    let model = |value: &str| {
        format!(
            "partial model Base parameter Integer m(min = 1) = 3; end Base; \
             model M extends Base; parameter Integer m = {value} \"phases\"; Real x = m*time; end M;"
        )
    };
    assert_eq!(at_end(&model("3")), 3.0);
    assert!(attempted(&model("4")).is_err());
}
