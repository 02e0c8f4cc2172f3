//! Runs of which no individual can be simulated: the first population is enough to say so.

use super::identification::Identification;
use crate::Session;
use crate::builtins::Failure;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::ga::Genomes;
use crate::ga::errors::BAD_POPULATION;
use crate::identify::problem::Failed;
use crate::identify::{Failures, ScriptSearch, Simulated, Study};
use crate::models::simulation::{SimulationOptions, Translated, simulate, translated};
use crate::models::static_curve::DRIVER;
use crate::source::Span;
use std::sync::Arc;

/// Fewer failures may be bad luck, and the next population has some that can be simulated: where half of
/// the search space fails, so do ten individuals once in a thousand runs.
const ENOUGH: usize = 10;

impl Session {
    /// Ends a run whose first population fails as a whole.
    pub(super) fn stop_if_all_fail(
        &mut self,
        (study, x): (&Study, &[f64]),
        genomes: &Genomes,
        simulated: &Simulated,
    ) -> Result<(), Failure> {
        let tally = self.extension::<Identification>().recorder.tally();
        if tally.simulations > tally.failures.count || genomes.len() < ENOUGH {
            return Ok(());
        }
        let main = tally.failures.main_cause().map(|(cause, _)| cause);
        let example = simulated.failures.iter().flatten().find(|one| Some(&*one.cause) == main);
        let fault = nothing_simulated(&tally.failures, "the run stops", example);
        self.extension::<Identification>().is_hopeless = true;
        let first = simulated.failures.iter().position(Option::is_some).unwrap_or(0);
        let place = self.place_of_failure((study, x), genomes.row(first));
        Err(match place {
            Some(place) => fault.at(place).into(),
            None => fault.into(),
        })
    }

    /// Reports a search that ends without any success, if that was not reported yet.
    pub(super) fn report_if_all_failed(
        &mut self,
        (search, is_only): (&ScriptSearch, bool),
        interrupted: bool,
    ) {
        let identification = self.extension::<Identification>();
        let has_said = std::mem::take(&mut identification.is_hopeless);
        let failures = &search.observed.failures;
        let all_failed = search.evaluations == failures.count;
        if all_failed && failures.count > 0 && !has_said && !interrupted {
            let what = match is_only {
                true => "the run has no result".to_owned(),
                false => format!("the search of {} has no result", search.models()),
            };
            let fault = nothing_simulated(failures, &what, None).at(Span::NONE);
            // One individual alone is a question of the script, which gets its answer, 1e60.
            self.report(if failures.count == 1 { fault.warning() } else { fault });
        }
    }

    /// Where in the model the simulation of an individual fails: it is simulated once more, at every
    /// point where these are evaluated one by one.
    fn place_of_failure(&mut self, (study, x): (&Study, &[f64]), genes: &[f64]) -> Option<Span> {
        let class = self.class_evaluated()?;
        let before = (self.models.current.clone(), self.models.end.clone());
        let found = self.failure(&class, study, x, genes);
        (self.models.current, self.models.end) = before;
        found.map(|diagnostic| diagnostic.span()).filter(|span| span.is_known())
    }

    fn failure(
        &mut self,
        class: &str,
        study: &Study,
        x: &[f64],
        genes: &[f64],
    ) -> Option<Diagnostic> {
        let model = translated(self, class).ok()?;
        let set = self.models.current.as_ref().map(|current| current.overrides.clone());
        if !self.models.last().is_some_and(|last| Arc::ptr_eq(last, &model)) {
            self.models.refer_anew_to(&model);
            for (name, value) in set.unwrap_or_default() {
                // Those of another model are not meant.
                let _ = self.set_parameter(&name, value);
            }
        }
        for (parameter, gene) in study.parameters.iter().zip(genes) {
            self.set_parameter(&parameter.name, *gene).ok()?;
        }
        if model.program.find_parameter(DRIVER).is_err() {
            return self.failure_of(&model);
        }
        x.iter().find_map(|point| {
            self.set_parameter(DRIVER, *point).ok()?;
            self.failure_of(&model)
        })
    }

    fn failure_of(&mut self, model: &Translated) -> Option<Diagnostic> {
        let done = simulate(self, model, &SimulationOptions::default());
        done.err().map(|unfinished| unfinished.why)
    }
}

fn nothing_simulated(failures: &Failures, consequence: &str, example: Option<&Failed>) -> Fault {
    let all = match failures.count {
        1 => "the only individual could not be simulated".to_owned(),
        all => format!("none of {all} individuals could be simulated"),
    };
    let most = failures.main_cause().map(|(cause, count)| {
        let text = example.map_or_else(|| cause.to_owned(), Failed::to_string);
        match count {
            1 => format!(": {text}"),
            _ => format!("; {count} times: {text}"),
        }
    });
    fault!(
        BAD_POPULATION,
        "{consequence}: {all}{}",
        most.unwrap_or_default();
        help: "correct the model, the units of the data, or the search ranges"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::MemoryWorld;

    const CURVE: &str = include_str!("all_failing/curve.mo");

    /// Exit code and all output.
    fn run(script: &str) -> (u8, String) {
        let world = MemoryWorld::new();
        let streams = world.streams();
        let mut session = Session::new(Box::new(world));
        session.load_text("Curve.mo", CURVE).expect("classes");
        let status = session.run_text("all.mos", script);
        (status.code, streams.output() + &streams.errors())
    }

    const POPULATION: &str = "P := {{1 + i/10} for i in 1:12};\n";

    #[test]
    fn a_population_that_fails_as_a_whole_ends_the_run_and_names_the_equation() {
        let script = format!(
            "{POPULATION}D = Eval(\"\", \"Curve\", {{5.0, 10.0}}, P, {{\"a\"}}, \"i\", \"U\");\n\
             print(\"goes on: \" + String(D[1, 1]));\n"
        );
        let (code, said) = run(&script);
        assert_eq!(code, 1, "{said}");
        for words in ["none of 12 individuals", "12 times: `log`", "X = 5", "log(1 - i/a)"] {
            assert!(said.contains(words), "{words}: {said}");
        }
        assert!(!said.lines().any(|line| line.starts_with("goes on")), "{said}");
        assert_eq!(said.matches("none of").count(), 1, "{said}");
    }

    #[test]
    fn the_time_of_a_failure_is_told() {
        let script = format!(
            "{POPULATION}D = Eval(\"\", \"Growth\", {{0.5, 1.0}}, P, {{\"a\"}}, \"time\", \"x\");\n"
        );
        let (code, said) = run(&script);
        assert_eq!(code, 1, "{said}");
        assert!(said.contains("12 times: too large (at 0."), "{said}");
        assert!(said.contains("assert(x < 2"), "{said}");
    }

    #[test]
    fn individuals_that_are_evaluated_one_by_one_fail_at_the_end() {
        let script = "for i in 1:12 loop
  D = Eval(\"\", \"Growth\", {0.5, 1.0}, [1 + i/10], {\"a\"}, \"time\", \"x\");
end for;
print(\"goes on\");
";
        let (code, said) = run(script);
        assert!(code == 1 && said.contains("goes on") && said.contains("none of 12"), "{said}");
    }

    #[test]
    fn a_run_with_fewer_individuals_than_that_says_so_at_its_end() {
        for (population, said_of, ends_with) in
            [("[1.0]", "the only individual", 0), ("[1; 2; 3]", "none of 3", 1)]
        {
            let script = format!(
                "D = Eval(\"\", \"Growth\", {{0.5, 1.0}}, {population}, {{\"a\"}}, \"time\", \"x\");\n\
                 print(\"goes on\");\n"
            );
            let (code, said) = run(&script);
            assert!(said.contains("goes on") && said.contains(said_of), "{said}");
            assert_eq!(code, ends_with, "{said}");
        }
    }

    #[test]
    fn individuals_have_the_values_that_were_set_by_hand() {
        let script = "translateModel(\"Growth\");
x0 = 0.25;
D = Eval(\"\", \"Growth\", {0.0, 1.0}, [1.0; 2.0], {\"a\"}, \"time\", \"x\");
print(String(D[1, 1]) + \" \" + String(abs(D[2, 2] - 0.25*exp(2)) < 1e-2));
x0 = 0.5;
D = Eval(\"\", \"Growth\", {0.0}, [1.0], {\"a\"}, \"time\", \"x\");
print(String(D[1, 1]));
D = Eval(\"\", \"Growth\", {0.0}, [0.125], {\"x0\"}, \"time\", \"x\");
print(String(D[1, 1]));
translateModel(\"Growth\");
D = Eval(\"\", \"Growth\", {0.0}, [0.5], {\"a\"}, \"time\", \"x\");
print(String(D[1, 1]));
";
        let (code, said) = run(script);
        let lines: Vec<&str> = said.lines().filter(|line| line.starts_with(['0', '1'])).collect();
        assert!(code == 0 && lines == ["0.25 true", "0.5", "0.125", "1"], "{said}");
    }

    #[test]
    fn the_report_shows_what_was_set_by_hand() {
        let script = "translateModel(\"Growth\");
x0 = 0.25;
D = Eval(\"\", \"Growth\", {0.0, 1.0}, [0.9; 1.0; 1.1], {\"a\"}, \"time\", \"x\");
F = Fit(D, {0.25, 0.68});
(P, G) = Fit_Order([0.9; 1.0; 1.1], F, 3, 2, 1);
";
        let (code, said) = run(script);
        assert!(code == 0 && said.contains("Growth(x0 = 0.25)"), "{said}");
    }
}
