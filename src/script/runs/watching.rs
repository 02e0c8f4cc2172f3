//! What the user sees of the generations of a script while it runs, and the statements that he may
//! type between two of them.

use super::changing;
use super::identification::{Identification, Shown};
use super::interaction::reason;
use super::view::{Drawn, Fitted, Progress, Spread, View};
use crate::Session;
use crate::builtins::Failure;
use crate::diag::Diagnostic;
use crate::ga::Genomes;
use crate::identify::{Compared, Quantity, ScriptSearch, Study};
use std::ops::ControlFlow;

const HELP: &str = "\
Paused. Type script statements, such as F_Mut := 0.3; they take effect from this generation on. \
                    An empty line continues; Ctrl-C ends the run.
";
const PROMPT: &str = "> ";

impl Session {
    /// How far the run is: the generations seen, of as many as the loop that the script is in has
    /// iterations.
    pub(crate) fn show_run(&mut self, (study, x): (&Study, &[f64]), genomes: &Genomes) {
        let iterations = match self.loop_iteration() {
            Some((_, Some(iterations))) => iterations as u64,
            _ => 0,
        };
        // It is read only, and put back.
        let recorder = std::mem::take(&mut self.extension::<Identification>().recorder);
        let before = ScriptSearch::default();
        let search = recorder.search_simulating(study, x).unwrap_or(&before);
        let mut progress = progress(search, iterations);
        // Those of the generation at hand are not yet counted in a search.
        if recorder.is_one_search() {
            let failures = &recorder.tally().failures;
            progress.failures = failures.count;
            let main = failures.main_cause();
            progress.main_cause = main.map(|(cause, count)| (cause.to_owned(), count));
        }
        if self.show_search(progress, &search.observed, || drawn(search, study, genomes)) {
            self.extension::<Identification>().shown = Some(Shown {
                study: study.clone(),
                x: x.to_vec(),
                genomes: genomes.clone(),
                generations: iterations,
            });
        }
        self.extension::<Identification>().recorder = recorder;
    }

    /// The view of the whole search that was viewed last: each of the others is drawn before its
    /// generation is rated.
    pub(super) fn show_end(&mut self, searches: &[ScriptSearch]) {
        let Some(shown) = self.extension::<Identification>().shown.take() else { return };
        let is_shown = |search: &&ScriptSearch| search.simulates(&shown.study, &shown.x);
        let Some(search) = searches.iter().rev().find(is_shown) else { return };
        let drawn = drawn(search, &shown.study, &shown.genomes);
        let progress = progress(search, shown.generations);
        self.world.show_view(&View::of(progress, &search.observed, drawn));
    }

    /// Executes what the user types where he asks for a pause, among the variables of the script;
    /// in a run that is resumed, what he typed here before.
    pub(crate) fn pause(&mut self) -> Result<(), Failure> {
        while let Some(line) = self.typed_before() {
            self.typed(&line).map_err(|wrong| Failure::Elsewhere(vec![wrong]))?;
        }
        if !self.world.is_pause_requested() {
            return Ok(());
        }
        if self.execution.is_in_function() {
            self.world
                .eprint("`Eval` is called in a function, whose variables cannot be changed\n");
            return Ok(());
        }
        self.pause_search([HELP, PROMPT], &mut |session, line| {
            match session.typed(line) {
                Ok(()) => {
                    session.journal_typed(line);
                    Ok(ControlFlow::Continue(()))
                }
                // The run continues as it was.
                Err(refused) => {
                    let reason = reason(&refused.message, &refused.helps);
                    session.report(refused.warning());
                    Err(reason)
                }
            }
        });
        Ok(())
    }

    fn typed(&mut self, line: &str) -> Result<(), Diagnostic> {
        let script = changing::parsed(self, "typed during a pause", line)?;
        self.change(&script, true)?;
        self.extension::<Identification>().recorder.changed(line.trim());
        Ok(())
    }
}

/// How far a run is, of so many generations; of an unknown number where there have been more, as with a loop
/// around several runs.
fn progress(search: &ScriptSearch, total: u64) -> Progress {
    let observed = &search.observed;
    let generations = observed.generations();
    let total = if generations > total { 0 } else { total };
    Progress::of(observed, search.counted(), [generations, total])
}

fn drawn(search: &ScriptSearch, study: &Study, genomes: &Genomes) -> Drawn {
    let best = search.best();
    let spread = |(k, quantity): (usize, &Quantity)| {
        let genes: Vec<f64> = genomes.rows().map(|genome| genome[k]).collect();
        let known = search.ranges.as_ref();
        let ends = known.and_then(|(low, high)| Some([*low.get(k)?, *high.get(k)?]));
        let [low, high] = ends.unwrap_or_else(|| ends_of(&genes));
        let fraction = |value: &f64| ((value - low) / (high - low)).clamp(0.0, 1.0);
        let value = best.and_then(|best| best.genome.get(k)).copied().unwrap_or(f64::NAN);
        let generation = genes.iter().map(fraction).collect();
        Spread::of((&quantity.name, &quantity.unit), (value, fraction(&value)), generation)
    };
    let fitted = |compared: &Compared| {
        let measured = compared.measured.as_deref().unwrap_or_default();
        let study = &compared.study;
        let axes = [&study.y, &study.x].map(|quantity| study.axis(quantity));
        Fitted::of([&axes[0], &axes[1]], [&compared.x, measured, &compared.simulated])
    };
    Drawn {
        title: format!("Identification of {}", study.model),
        spreads: study.parameters.iter().enumerate().filter_map(spread).collect(),
        fitted: best.iter().flat_map(|best| best.compared).map(fitted).collect(),
    }
}

fn ends_of(genes: &[f64]) -> [f64; 2] {
    let low = genes.iter().copied().fold(f64::INFINITY, f64::min);
    let high = genes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if high > low { [low, high] } else { [low - 0.5, low + 0.5] }
}
