//! `gapi teach` and `gapi run --trace` as a user starts them.

use crate::support::program::{folder, gapi};

/// Two searches of thirty generations with twelve individuals, without an elite and with one.
pub(crate) const SEARCH: &str = include_str!("../../teach/search.mos");

/// A generation put together from operators by name, one of them a function of the script.
pub(crate) const OPERATORS: &str = include_str!("../../teach/operators.mos");

/// A folder with it.
fn with_search() -> tempfile::TempDir {
    folder(&[("search.mos", SEARCH)])
}

#[test]
fn a_recorded_run_is_walked_through() {
    let here = with_search();
    let (code, _, errors) = gapi(&here, &["run", "search.mos", "--trace", "search.trace"]);
    assert_eq!(code, 0, "{errors}");
    let bytes = std::fs::read(here.path().join("search.trace")).unwrap();
    let genes = 2 * 30 * 12 * 2;
    assert!(bytes.len() < 50 * genes, "{} bytes for {genes} genes", bytes.len());
    let (code, out, _) = gapi(&here, &["teach", "search.trace"]);
    assert_eq!(code, 0);
    for part in [
        "Generation 1, step 1 of",
        "search.mos:38  ",
        "Fit is the sum of squared residuals",
        "Parents 1 and 2 (by rank) have two children",
        "below F_Mut = 0.5",
        "Individual 9 of the next generation is sampled at random",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
    // The file may lie anywhere: it is the user who names it.
    let elsewhere = folder(&[]);
    let there = elsewhere.path().join("there.trace");
    let (code, _, errors) = gapi(&here, &["run", "search.mos", "--trace", there.to_str().unwrap()]);
    assert!(code == 0 && std::fs::read(there).unwrap() == bytes, "{errors}");
    // What an interrupted run leaves is read up to there.
    std::fs::write(here.path().join("cut.trace"), &bytes[..bytes.len() / 2]).unwrap();
    let (code, out, _) = gapi(&here, &["teach", "cut.trace"]);
    assert!(code == 0 && out.contains("Generation 1, step 1 of"), "{out}");
}

/// Scripts that only call operators have calls where others have generations.
#[test]
fn operators_alone_are_watched() {
    let script = "Seed := {1, 2, 3, 4, 5, 6};\n\
        (Pop, Fit) := Fit_Order([1, 10; 2, 20; 3, 30], {9.0, 1.0, 4.0}, 3, 2, 1);\n\
        Crossed := Cross(2, 1, Pop, {1});\n(Ram, Seed) := Ram_Gen_ARENA(Seed, 6);\n\
        Mutated := Mutation(Crossed, 1, Ram, {0, 0}, {1, 1}, 1);\n\
        Alone := Cross(2, 0, [5, 6, 7; 8, 9, 10], {2});\n\
        Alone := Mutation([5, 6; 7, 8], 0, zeros(2, 2), {0, 0}, {9, 9}, 2);\n";
    let here = folder(&[("calls.mos", script)]);
    let (code, out, errors) = gapi(&here, &["teach", "calls.mos"]);
    assert_eq!(code, 0, "{errors}");
    for part in [
        // The three calls that belong together are one.
        "Call 1, step 1 of 5: selection",
        "    2      1.000      2.000      20.00  elite and parent",
        "Call 1, step 3 of 5: crossover",
        "child   1             2.000|     30.00",
        "Call 1, step 5 of 5: mutation",
        "Call 2, step 1 of 1: crossover",
        "child   2             8.000      9.000|     7.000",
        "Call 3, step 1 of 1: stop",
        "The operator leaves all individuals as they are.",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
    assert!(!out.contains("Generation") && !out.contains("generation  "), "{out}");
    let (code, _, errors) = gapi(&here, &["teach", "calls.mos", "--html", "calls.html"]);
    assert_eq!(code, 0, "{errors}");
    let page = std::fs::read_to_string(here.path().join("calls.html")).unwrap();
    assert!(page.contains("calls.mos - step by step") && page.contains("\"call\":true"));
}

/// Scripts that call operators by name and nothing of the paper have these calls.
#[test]
fn operators_by_name_are_watched() {
    let here = folder(&[("operators.mos", OPERATORS)]);
    let (code, out, errors) = gapi(&here, &["teach", "operators.mos"]);
    assert_eq!(code, 0, "{errors}");
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/teach"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("operators_by_name", out));
    let (code, _, errors) = gapi(&here, &["teach", "operators.mos", "--svg", "figure.svg"]);
    assert!(code == 1 && errors.contains("calls of operators have no figure"), "{errors}");
}

#[test]
fn a_crossover_alone_is_watched() {
    let script = "Seed := {1, 2, 3, 4, 5, 6};\n\
        (Children, Seed) := Op_Crossover(\"one_point\", [1, 2, 3; 4, 5, 6; 7, 2, 9], {0, 0, 0}, \
        {9, 9, 9}, Seed);\n";
    let here = folder(&[("cross.mos", script)]);
    let (code, out, errors) = gapi(&here, &["teach", "cross.mos"]);
    assert_eq!(code, 0, "{errors}");
    for part in [
        "Call 1, step 1 of 2: crossover",
        "Child 1 has 1 gene of parent a, 2",
        "child 1        1.000a     5.000b     6.000b",
        "child 2        4.000b     2.000a     3.000a",
        "Call 1, step 2 of 2: crossover",
        // The second gene of both parents is the same.
        "child 3        7.000a     2.000=     3.000b",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
}

/// Two generations of a size that stands before it.
const SMALL: &str = include_str!("../../teach/small.mos");

/// A small run, and what its steps say.
struct SmallRun {
    population: usize,
    parents: usize,
    elites: usize,
    genes: usize,
    points: &'static str,
    says: &'static [&'static str],
}

/// What `Cross` makes of few parents and genes, and what becomes of the others, is said as it is.
#[test]
fn small_runs_are_described_as_they_are() {
    let run = |population, parents, elites, genes, points, says| SmallRun {
        population,
        parents,
        elites,
        genes,
        points,
        says,
    };
    let table: [SmallRun; 9] = [
        run(
            2,
            1,
            1,
            1,
            "{0}",
            &[
                "The best one (N_Parents = 1) will be the parent, the other one is discarded",
                "The only parent has no partner to exchange genes with: its child is a copy of it.",
                "1 elite and 1 child form the next generation: 2 individuals.",
            ],
        ),
        run(
            1,
            1,
            0,
            2,
            "{1}",
            &[
                "The only one (N_Parents = 1) will be the parent.",
                "its child is a copy of it",
                "1 child forms the next generation: 1 individual.",
            ],
        ),
        run(
            3,
            1,
            0,
            2,
            "{1}",
            &[
                "will be the parent, the other 2 are discarded",
                "1 child and 2 random individuals form the next generation: 3 individuals.",
            ],
        ),
        run(
            3,
            1,
            2,
            1,
            "{0}",
            &[
                "will be the parent, the other 2 will not.",
                "The best 2 individuals (N_Elitism = 2) survive unchanged",
                "2 elites and 1 child form the next generation",
            ],
        ),
        run(
            2,
            2,
            0,
            1,
            "{0}",
            &[
                "All 2 (N_Parents = 2) will be parents.",
                "Parents 1 and 2 (by rank) have two children: they exchange their only gene \
             (Cross_Point = 0), so each is a copy of one of them.",
                "2 children form the next generation",
            ],
        ),
        run(
            3,
            2,
            1,
            2,
            "{2}",
            &[
                "two children: they exchange no gene (Cross_Point = 2), so each is a copy",
                "1 elite and 2 children form the next generation",
            ],
        ),
        run(
            4,
            3,
            1,
            2,
            "{0}",
            &[
                "The best 3 (N_Parents) will be parents, the other one is discarded",
                "Parents 1 and 2 (by rank) have two children: they exchange all genes (Cross_Point = 0)",
                "Parents 3 and 1 (by rank) have a child: they exchange all genes (Cross_Point = 0), so \
             it is a copy of 1.",
            ],
        ),
        run(
            4,
            3,
            0,
            2,
            "{1, 1}",
            &[
                "Parents 3 and 1 (by rank) have a child: they exchange no gene (Cross_Point = 1, 1), so \
             it is a copy of 3.",
            ],
        ),
        run(
            4,
            3,
            0,
            2,
            "{1}",
            &[
                "Parents 1 and 2 (by rank) have two children that exchange the genes after gene 1",
                "Parents 3 and 1 (by rank) have a child: they exchange the genes after gene 1",
            ],
        ),
    ];
    for size in &table {
        let SmallRun { population, parents, elites, genes, points, .. } = size;
        let script = format!(
            "N_Population = {population}; N_Parents = {parents}; N_Elitism = {elites}; \
             N_Genes = {genes}; Cross_Point = {points};\n{SMALL}"
        );
        let here = folder(&[("small.mos", &script)]);
        let (code, out, errors) = gapi(&here, &["teach", "small.mos", "--count", "2"]);
        assert_eq!(code, 0, "{errors}\n{script}");
        let words = out.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in size.says {
            assert!(words.contains(part), "`{part}` is missing:\n{out}");
        }
        for part in
            ["1 individuals", "1 are", "Parents 1 and 1", "after gene 0", "child of 1 and 1"]
        {
            assert!(!words.contains(part), "`{part}` in\n{out}");
        }
        // `Cross` makes one child for each parent.
        let first = out.split("Generation 2").next().unwrap_or_default();
        let children = first.lines().filter(|line| line.starts_with("child ")).count();
        assert_eq!(children, size.parents, "{out}");
        // A lesson with questions asks nothing that there is not.
        let (code, out, errors) = gapi(&here, &["teach", "small.mos", "--quiz"]);
        assert_eq!(code, 0, "{errors}");
        assert!(!out.contains("Which 1 ") && !out.contains("after gene 0"), "{out}");
    }
}

/// What is called on nobody is told all the same, and an operator that does not exist is an error.
#[test]
fn operators_on_nobody() {
    let seed = "Seed := {1, 2, 3, 4, 5, 6};\n";
    let nobody = "(P, Seed) := Op_Sampling(\"uniform\", 0, {0, 0}, {1, 1}, Seed);\n\
        (C, Seed) := Op_Crossover(\"uniform\", P, {0, 0}, {1, 1}, Seed);\n\
        (M, Seed) := Op_Mutation(\"uniform\", P, 0.5, {0, 0}, {1, 1}, Seed);\n\
        (Q, Seed) := Op_Selection(\"tournament\", {1.0}, 0, Seed);\n\
        (N, F) := Op_Survival(\"mu_plus_lambda\", P, fill(0.0, 0), P, fill(0.0, 0), 0);\n\
        (C, Seed) := Op_Crossover(\"uniform\", [0.1, 0.2], {0, 0}, {1, 1}, Seed);\n";
    let unknown = "(C, Seed) := Op_Crossover(\"unifrom\", [0, 1], {0, 0}, {1, 1}, Seed);\n";
    let here = folder(&[
        ("nobody.mos", &format!("{seed}{nobody}")),
        ("unknown.mos", &format!("{seed}{unknown}")),
    ]);
    let (code, out, errors) = gapi(&here, &["teach", "nobody.mos"]);
    assert_eq!(code, 0, "{errors}");
    for part in [
        "Op_Sampling with `uniform` returns no individuals.",
        "is given no parents and returns no children.",
        "Op_Mutation with `uniform` is given no individuals and returns none.",
        "returns 0 parents.",
        "Call 5, step 1 of 1: survivor selection",
        "is given 1 parent: row 1 has a child, which is a\ncopy of it.",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
    let (code, _, errors) = gapi(&here, &["teach", "nobody.mos", "--html", "nobody.html"]);
    assert_eq!(code, 0, "{errors}");
    let (code, _, errors) = gapi(&here, &["teach", "unknown.mos"]);
    assert!(code == 1 && errors.contains("unknown crossover `unifrom`"), "{errors}");
}

/// Operators by name are shown in their place beside functions of the paper.
#[test]
fn operators_beside_functions_of_the_paper_are_shown() {
    let operator = "(C, s) := Op_Crossover(\"uniform\", [1; 2], {0}, {9}, Seed);\n";
    let paper = "Alone := Cross(2, 0, [5, 6, 7; 8, 9, 10], {2});\n";
    let seed = "Seed := {1, 2, 3, 4, 5, 6};\n";
    let here = folder(&[("calls.mos", &format!("{seed}{operator}{paper}{operator}"))]);
    let (code, out, errors) = gapi(&here, &["teach", "calls.mos"]);
    assert_eq!(code, 0, "{errors}");
    for part in [
        "Call 1, step 1 of 1: crossover\n------------------------------\ncalls.mos:2",
        "Call 2, step 1 of 1: crossover\n------------------------------\ncalls.mos:3",
        "Call 3, step 1 of 1: crossover\n------------------------------\ncalls.mos:4",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
}

/// A genetic algorithm whose operators are called by name has generations with these steps.
#[test]
fn operators_by_name_are_steps_of_a_run() {
    let script = "model Line\n  parameter Real a = 1;\n  output Real y = a*time;\n\
        annotation(experiment(StopTime = 1));\nend Line;\nSeed := {1, 2, 3, 4, 5, 6};\n\
        (Pop, Seed) := Op_Sampling(\"uniform\", 4, {0}, {2}, Seed);\nfor k in 1:3 loop\n\
        Fitness := Fit(Eval(\"\", \"Line\", {0.5, 1.0}, Pop, {\"a\"}, \"time\", \"y\"), {0.4, 0.8});\n\
        (Places, Seed) := Op_Selection(\"tournament\", Fitness, 4, Seed);\n\
        (Pop, Seed) := Op_Crossover(\"sbx\", Pop[Places,:], {0}, {2}, Seed);\n\
        (Pop, Seed) := Op_Mutation(\"uniform\", Pop, 0.5, {0}, {2}, Seed);\nend for\n";
    let here = folder(&[("run.mos", script)]);
    let (code, out, errors) = gapi(&here, &["teach", "run.mos"]);
    assert_eq!(code, 0, "{errors}");
    for part in [
        "Generation 1, step 1 of 11: sampling",
        "Generation 1, step 2 of 11: simulation",
        "Generation 1, step 3 of 11: fitness",
        "Generation 1, step 4 of 11: selection",
        "Op_Selection with `tournament",
        "Generation 1, step 6 of 11: crossover",
        "Generation 1, step 10 of 11: mutation",
        "Generation 1, step 11 of 11: next generation",
        "The script makes the next generation: 4 individuals.",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
    let (code, out, _) = gapi(&here, &["teach", "run.mos", "--generation", "3"]);
    assert!(code == 0 && out.contains("Generation 3, step 1 of 10: simulation"), "{out}");
    assert!(out.contains("The run ends here, after 3 generations."), "{out}");
}

/// Scripts that simulate without a genetic algorithm have evaluations: nothing is said of stop
/// conditions, first populations and search ranges that there are not.
#[test]
fn evaluations_are_no_generations() {
    let model = "model Line\n  parameter Real a = 1;\n  output Real y = a*time;\n\
        annotation(experiment(StopTime = 1));\nend Line;\n";
    let eval = "Fit(Eval(\"\", \"Line\", {0.5, 1.0}, P, {\"a\"}, \"time\", \"y\"), {0.4, 0.8})";
    let once = format!(
        "{model}P := [0.7];\nS := Eval(\"\", \"Line\", {{1.0}}, P, {{\"a\"}}, \"time\", \"y\");\n"
    );
    let random = format!(
        "{model}Seed := {{1, 2, 3, 4, 5, 6}};\nfor Count in {{1, 3, 9}} loop\n\
         (R, Seed) := Ram_Gen_ARENA(Seed, Count);\nP := transpose(R);\nF := {eval};\nend for\n"
    );
    let scaled = random.replace("P := transpose(R)", "P := 2*transpose(R)");
    let squared = random.replace("P := transpose(R)", "P := {{R[1, k]^2} for k in 1:Count}");
    let (once, random) = (("once.mos", &*once), ("random.mos", &*random));
    let here = folder(&[once, random, ("scaled.mos", &scaled), ("squared.mos", &squared)]);
    let shown = |name: &str| {
        let (code, out, errors) = gapi(&here, &["teach", name]);
        assert_eq!(code, 0, "{errors}");
        for word in ["stop condition", "N_Population", "eneration", "Param_Min", "NaN"] {
            assert!(!out.contains(word), "`{word}` in {name}:\n{out}");
        }
        out
    };
    let out = shown("once.mos");
    assert!(out.contains("Evaluation 1, step 1 of 2: simulation"), "{out}");
    assert!(out.contains("Eval simulates `Line` once, with one set of values of a."), "{out}");
    assert!(out.contains("1 individual in all. No fitness was"), "{out}");
    assert!(out.contains("    1          -     0.7000"), "the table is not empty:\n{out}");
    let out = shown("random.mos");
    for part in [
        "Evaluation 1, step 1 of 3: sampling",
        "1 individual is sampled: Ram_Gen_ARENA returned 1 random number between 0 and\n1. It sets the gene, as it is.",
        "Evaluation 3, step 1 of 4: sampling",
        "9 individuals are sampled: Ram_Gen_ARENA returned 9 random numbers between 0\nand 1. Each number u sets one gene, as it is.",
        "The script simulates nothing further: 13 individuals in all. The best is",
    ] {
        assert!(out.contains(part), "`{part}` is missing:\n{out}");
    }
    let out = shown("scaled.mos");
    let words = out.split_whitespace().collect::<Vec<_>>().join(" ");
    let range = "Each number u sets one gene: a from 0 (u = 0) to 2.000 (u = 1).";
    assert!(words.contains(range), "{out}");
    assert!(shown("squared.mos").contains("The script makes the genes of them."));
}

/// A page of calls, or of evaluations, names them so, and no model where there is none.
#[test]
fn pages_name_what_they_count() {
    let script = "Alone := Cross(2, 0, [5, 6, 7; 8, 9, 10], {2});\n";
    let here = folder(&[("calls.mos", script)]);
    let (code, _, errors) = gapi(&here, &["teach", "calls.mos", "--html", "calls.html"]);
    assert_eq!(code, 0, "{errors}");
    let page = std::fs::read_to_string(here.path().join("calls.html")).unwrap();
    assert!(page.contains("\"unit\":\"Call\"") && page.contains("\"model\":\"\""));
    assert!(!page.contains("DATA.model + \": \" +"), "the name of the model may be empty");
}

#[test]
fn a_script_becomes_a_page() {
    let here = with_search();
    let (code, _, errors) = gapi(&here, &["teach", "search.mos", "--html", "steps.html"]);
    assert_eq!(code, 0, "{errors}");
    let page = std::fs::read_to_string(here.path().join("steps.html")).unwrap();
    let report = std::fs::read_to_string(here.path().join("results/search/result.json")).unwrap();
    assert!(page.contains("Discharge") && report.contains("least squares from there"));
    assert!(page.contains("least squares from there"), "the page has no report");
}

#[test]
fn what_is_no_trace_is_refused() {
    let here = folder(&[("notes.txt", "hello"), ("nothing.mos", "// t\nx := 1;\n")]);
    let (code, _, errors) = gapi(&here, &["teach", "notes.txt"]);
    assert!(code == 1 && errors.contains("this is not a trace of gapilib"), "{errors}");
    let (code, _, errors) = gapi(&here, &["teach", "nothing.mos"]);
    assert!(code == 1 && errors.contains("the trace contains no generation"), "{errors}");
}

#[test]
fn a_run_is_compared_with_what_it_would_have_been() {
    let here = with_search();
    let what_if = |statement: &str, generation: &str| {
        let options = ["--what-if", statement, "--generation", generation];
        gapi(&here, &[&["teach", "search.mos"], options.as_slice()].concat())
    };
    let (code, out, errors) = what_if("F_Mut := 1.0", "3");
    assert_eq!(code, 0, "{errors}");
    assert!(out.contains("What if F_Mut := 1.0 from generation 3?"), "{out}");
    assert!(here.path().join("results/search/what_if.svg").exists());
    let of = |number: &str| -> Vec<String> {
        let line = out.lines().find(|line| line.trim_start().starts_with(number)).expect("a row");
        line.split_whitespace().skip(1).map(str::to_owned).collect()
    };
    // The change comes after the simulation of its generation.
    assert_eq!(of("3 ")[0], of("3 ")[1], "{out}");
    assert_ne!(of("60")[0], of("60")[1], "{out}");
    let page = ["teach", "search.mos", "--what-if", "F_Mut := 1.0", "--generation", "3", "--html"];
    let (code, _, errors) = gapi(&here, &[&page[..], &["both.html"]].concat());
    assert_eq!(code, 0, "{errors}");
    let [run, changed] = both_curves(&here.path().join("both.html"));
    assert_eq!(run.len(), changed.len());
    assert_eq!(run[..3], changed[..3], "both are the same up to the change");
    assert_ne!(run, changed);
    let (code, _, errors) = what_if("F_Mut := 1.0", "61");
    assert!(code == 1 && errors.contains("the run has no generation 61"), "{errors}");
    let (code, _, errors) = what_if("F_Mut := := 1", "3");
    assert!(code == 1 && errors.contains("what if:1:"), "{errors}");
}

#[test]
fn answers_are_read_and_counted() {
    let here = with_search();
    let (code, out, errors) = gapi(&here, &["teach", "search.mos", "--quiz"]);
    assert_eq!(code, 0, "{errors}");
    assert!(out.contains("? Which ") || out.contains("become parents"), "{out}");
    assert!(out.ends_with("No question was answered.\n"), "{out}");
}

#[test]
fn a_function_that_calls_eval_cannot_be_changed() {
    let script = "model Line\n  parameter Real a = 0;\n  output Real y = a*time;\n\
        annotation(experiment(StopTime = 2));\nend Line;\nfunction Try\n  output Real y;\n\
        protected\n  Real r[1,2];\nalgorithm\n  \
        r := Eval(\"\", \"Line\", {0, 1}, [1], {\"a\"}, \"time\", \"y\");\n  y := r[1,2];\n\
        end Try;\nx := Try();\n";
    let here = folder(&[("in_function.mos", script)]);
    let (code, _, errors) =
        gapi(&here, &["teach", "in_function.mos", "--what-if", "x := 1", "--generation", "1"]);
    assert!(code == 1 && errors.contains("[cannot-branch]"), "{errors}");
}

/// The curves of the run and of the changed one that a page has: generations and best fitness.
fn both_curves(page: &std::path::Path) -> [Vec<serde_json::Value>; 2] {
    let page = std::fs::read_to_string(page).unwrap();
    let curve = |id: &str| {
        let (_, rest) = page.split_once(&format!("id=\"{id}\">")).expect("the data");
        let (json, _) = rest.split_once("</script>").expect("its end");
        let data: serde_json::Value = serde_json::from_str(json).unwrap();
        data["curve"].as_array().expect("a curve").clone()
    };
    [curve("data"), curve("what-if-data")]
}
