//! What users see of a run in progress, and what they may change then.

use crate::Session;
use crate::identify::problem::Run;
use crate::runs::view::{Fitted, Progress, Spread, View, labelled};

/// What a pause explains.
const HELP: &str = "\
Paused. Type NAME = NUMBER to change a setting of the method (such as mutation = 0.3), of the stop
conditions (generations, evaluations, seconds) or a search range (min A = 0.02, max A = 0.2);
an empty line continues; `stop` ends the run with the results found so far.
";
/// What it asks with.
const PROMPT: &str = "change> ";

/// The simulation of the best individual, kept until there is a better one.
#[derive(Default)]
pub(super) struct Live {
    fitness: Option<f64>,
    simulated: Vec<f64>,
}

impl Live {
    /// Shows how far the run is.
    pub(super) fn show(&mut self, session: &mut Session, run: &Run) {
        session.world.progress(&progress(run));
        if session.world.wants_view() {
            let view = self.view(run);
            session.world.show_view(&view);
        }
    }

    fn view(&mut self, run: &Run) -> View {
        let best = run.best.as_ref();
        if let Some(best) = best.filter(|best| Some(best.fitness) != self.fitness) {
            self.fitness = Some(best.fitness);
            self.simulated = run.evaluation.simulate(&best.values).unwrap_or_default();
        }
        let spread = |(k, free): (usize, &crate::identify::problem::Free)| {
            let value = best.map_or(f64::NAN, |best| best.values[k]);
            Some(Spread {
                name: free.name.clone(),
                unit: free.unit.clone(),
                value,
                best: free.fraction(value),
                generation: Spread::of(run.fractions(k))?,
            })
        };
        let mut rest = self.simulated.as_slice();
        let mut fitted = Vec::new();
        for series in &run.problem.series {
            let (own, others) = rest.split_at(series.x.len().min(rest.len()));
            rest = others;
            fitted.push(Fitted {
                y_name: labelled(&series.y_name, &series.y_unit),
                x_name: labelled(&series.x_name, &series.x_unit),
                x: series.x.clone(),
                measured: series.y.clone(),
                simulated: own.to_vec(),
            });
        }
        View {
            title: run.problem.title.clone(),
            progress: progress(run),
            best: run.history.generations.iter().map(|generation| generation.best).collect(),
            spreads: run.problem.parameters.iter().enumerate().filter_map(spread).collect(),
            fitted,
        }
    }
}

fn progress(run: &Run) -> Progress {
    let limits = run.problem.stop;
    let (done, total) = match (limits.evaluations, limits.generations) {
        (_, Some(total)) => (run.generations(), total),
        (Some(total), None) => (run.evaluations.min(total), total),
        (None, None) => (run.evaluations, 0),
    };
    Progress {
        label: run.phase().to_owned(),
        done,
        total,
        best: run.best.as_ref().map(|best| best.fitness),
        failures: run.failed.iter().sum(),
        main_cause: None,
    }
}

/// Carries out what the user types during a pause. Whether the run shall end.
pub(super) fn pause(session: &mut Session, run: &mut Run) -> bool {
    session.world.eprint(HELP);
    while let Some(line) = session.world.ask(PROMPT) {
        match line.trim() {
            "" => return false,
            "stop" | "quit" | "end" => return true,
            line => change(session, run, line),
        }
    }
    false
}

fn change(session: &mut Session, run: &mut Run, line: &str) {
    let pair = line.trim_end_matches(';').split_once('=');
    let pair = pair.map(|(name, value)| (name.trim().trim_end_matches(':'), value.trim()));
    let Some((setting, Ok(value))) = pair.map(|(name, value)| (name.trim(), value.parse::<f64>()))
    else {
        session.world.eprint("expected NAME = NUMBER\n");
        return;
    };
    super::control::change(session, run, setting, value);
}
