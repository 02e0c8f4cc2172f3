//! Populations of scripts, evaluated: simulated or taken from the journal, recorded, traced and shown.

use super::identification::{Prepared, Request};
use super::tracing;
use crate::Session;
use crate::bail;
use crate::builtins::Failure;
use crate::diag::Fault;
use crate::errors::INTERRUPTED;
use crate::ga::Genomes;
use crate::identify::problem::Fingerprint;
use crate::identify::{Evaluator, Simulated, Study};
use crate::registry::BAD_OPTION;

impl Session {
    /// The evaluator of a request, made unless it is at hand: a run begins with it.
    fn prepared(&mut self, request: &Request) -> Result<Prepared, Failure> {
        self.load_model_of(request)?;
        let in_use = self.in_use(&request.model, &request.question.parameters)?;
        self.identification();
        match self.take_prepared(request, &in_use) {
            Some(prepared) => Ok(prepared),
            None => self.prepare(request, &in_use),
        }
    }

    /// Measured values in the unit of the variable that a request compares them with.
    pub(super) fn measured_in_unit_of(
        &mut self,
        request: &Request,
        measured: &[f64],
    ) -> Result<Option<Vec<f64>>, Failure> {
        let prepared = self.prepared(request)?;
        let study = prepared.evaluator.study().clone();
        let is_relative = prepared.evaluator.model().is_relative(&study.y.name);
        self.identification().prepared.push(prepared);
        Ok(self.in_unit_of(measured, &study.model, (&study.y, is_relative)))
    }

    /// Simulates a population, whose individuals have numbers from the second value on; the evaluator
    /// is kept for the next one.
    pub(crate) fn evaluate_population(
        &mut self,
        request: Request,
        genomes: &Genomes,
    ) -> Result<(Simulated, u64), Failure> {
        let mut prepared = self.prepared(&request)?;
        // From here on it is a request for the model with what was set by hand.
        let request = prepared.request.clone();
        let evaluator = &mut prepared.evaluator;
        let simulated = match self.journaled(&request, &evaluator.settings_text(), genomes)? {
            Some(known) => {
                if self.is_to_be_checked() {
                    check(evaluator, genomes, &known).inspect_err(|_| self.refuse_to_resume())?;
                }
                known
            }
            None => {
                evaluator.cancel_by(self.world.interrupt_flag());
                let simulated = evaluator.evaluate(genomes)?;
                if evaluator.is_cancelled() {
                    // The population is simulated again when the run is resumed.
                    return Err(Fault::new(INTERRUPTED, "interrupted").into());
                }
                self.journal(&request, &evaluator.settings_text(), genomes, &simulated);
                simulated
            }
        };
        let now = self.world.monotonic_seconds();
        let identification = self.identification();
        let recorder = &mut identification.recorder;
        recorder.at(now - identification.started.unwrap_or(now));
        let first = recorder.evaluated(evaluator.study(), evaluator.x(), genomes, &simulated);
        let (study, x) = (evaluator.study().clone(), evaluator.x().to_vec());
        let is_relative = evaluator.model().is_relative(&study.y.name);
        identification.prepared.push(prepared);
        let individuals = first..first + genomes.len() as u64;
        self.population_simulated(&study, individuals, is_relative);
        self.trace_simulation((&study, &x), genomes, &simulated)?;
        self.show_run((&study, &x), genomes);
        self.stop_if_all_fail((&study, &x), genomes, &simulated)?;
        Ok((simulated, first))
    }

    fn trace_simulation(
        &mut self,
        (study, x): (&Study, &[f64]),
        genomes: &Genomes,
        simulated: &Simulated,
    ) -> Result<(), Fault> {
        self.traced(|tracer, place| {
            let failed = simulated.failures.iter().enumerate();
            let failures =
                failed.filter_map(|(k, why)| Some((k as u32, why.as_ref()?.to_string())));
            let subject = tracing::subject(study);
            tracer.simulated(place, (&subject, x), genomes.values(), failures.collect());
        })
    }
}

/// The first individual, which is the best where elites are kept, and another one are computed
/// again: if a bit differs, the earlier run was that of another model.
fn check(evaluator: &mut Evaluator, genomes: &Genomes, known: &Simulated) -> Result<(), Failure> {
    let mut site = Fingerprint::default();
    site.add_numbers(genomes.values());
    let rows = [0, site.number() as usize % genomes.len().max(1)];
    let points = known.rows.len() / genomes.len().max(1);
    for row in rows.into_iter().filter(|row| *row < genomes.len()) {
        let one = Genomes::new(genomes.row(row).len(), genomes.row(row).to_vec())?;
        let now = evaluator.evaluate(&one)?;
        let before = &known.rows[row * points..(row + 1) * points];
        let differs =
            |(a, b): (&f64, &f64)| a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan());
        if before.len() != now.rows.len() || before.iter().zip(&now.rows).any(differs) {
            bail!(
                BAD_OPTION,
                "the run cannot be resumed: individual {} now gives a different simulation \
                 result", row + 1;
                help: "restore the model, its libraries and tables, the settings of the \
                       simulation, the program and the machine, or start again without `--resume`"
            );
        }
    }
    Ok(())
}
