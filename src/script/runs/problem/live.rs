//! What users see of a run in progress, and what they may change then.

use crate::Session;
use crate::identify::problem::Free;
use crate::identify::problem::Run;
use crate::plot::Axis;
use crate::runs::view::{Drawn, Fitted, Progress, Spread};
use std::ops::ControlFlow;

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
        session.show_search(progress(run), &run.observed, || self.drawn(run));
    }

    fn drawn(&mut self, run: &Run) -> Drawn {
        let best = run.observed.best.as_ref();
        if let Some(best) = best.filter(|best| Some(best.fitness) != self.fitness) {
            self.fitness = Some(best.fitness);
            self.simulated = run.evaluation.simulate(&best.values).unwrap_or_default();
        }
        let spread = |(k, free): (usize, &Free)| {
            let value = best.map_or(f64::NAN, |best| best.values[k]);
            let values = (value, free.fraction(value));
            Spread::of((&free.name, &free.unit), values, run.fractions(k))
        };
        let mut rest = self.simulated.as_slice();
        let descriptions = &run.problem.descriptions;
        let mut fitted = Vec::new();
        for series in &run.problem.series {
            let (own, others) = rest.split_at(series.x.len().min(rest.len()));
            rest = others;
            let axis =
                |name: &str, unit: &str| Axis::of_variable(name, descriptions.of(name), unit);
            let y = axis(&series.y_name, &series.y_unit);
            let x = axis(&series.x_name, &series.x_unit);
            fitted.push(Fitted::of([&y, &x], [&series.x, &series.y, own]));
        }
        Drawn {
            title: run.problem.title.clone(),
            spreads: run.problem.parameters.iter().enumerate().filter_map(spread).collect(),
            fitted,
        }
    }
}

fn progress(run: &Run) -> Progress {
    let limits = run.problem.stop;
    let units = match (limits.evaluations, limits.generations) {
        (_, Some(total)) => [run.generations(), total],
        (Some(total), None) => [run.evaluations().min(total), total],
        (None, None) => [run.evaluations(), 0],
    };
    Progress::of(&run.observed, run.phase(), units)
}

/// Carries out what the user types during a pause. Whether the run shall end.
pub(super) fn pause(session: &mut Session, run: &mut Run) -> bool {
    session.pause_search([HELP, PROMPT], &mut |session, line| match line.trim() {
        "stop" | "quit" | "end" => Ok(ControlFlow::Break(())),
        line => change(session, run, line).map(ControlFlow::Continue),
    })
}

fn change(session: &mut Session, run: &mut Run, line: &str) -> Result<(), String> {
    let pair = line.trim_end_matches(';').split_once('=');
    let pair = pair.map(|(name, value)| (name.trim().trim_end_matches(':'), value.trim()));
    let Some((setting, Ok(value))) = pair.map(|(name, value)| (name.trim(), value.parse::<f64>()))
    else {
        let reason = "expected NAME = NUMBER";
        session.world.eprint(&format!("{reason}\n"));
        return Err(reason.to_owned());
    };
    super::control::change(session, run, setting, value)
}
