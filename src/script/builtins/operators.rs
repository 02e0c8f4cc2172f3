//! The operators of the genetic algorithm by name (package `GAPILib.Operators`), for scripts that
//! put a generation together themselves: an entry of a table, or a function of the script.
//!
//! Each takes its random numbers from the generator that `Ram_Gen_ARENA` uses, starts it from
//! `Seed` and returns the seed that continues.

use super::gapilib::{WholeNumbers, check_size, genes, genomes_value, row, take_genomes};
use super::inputs;
use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::eval;
use crate::ga::crossover::Parents;
use crate::ga::errors::{BAD_OPERATOR, BAD_POPULATION, SIZE_MISMATCH};
use crate::ga::mutation::{Child, Course};
use crate::ga::operators::{self, OperatorKind, Size};
use crate::ga::survival::{Brood, Rated, Sizes, Survivor};
use crate::ga::{Genomes, Mrg32k3a, crossover, mutation, sampling, selection, survival};
use crate::registry::{BAD_OPTION, Choice};
use crate::runs::problem::{operators as chosen, own_function};
use crate::teach::{Action, Operation};
use crate::value::{RealMatrix, Value};
use crate::{bail, fault};
use std::sync::Arc;

/// The operators by name.
pub(super) const FAMILY: Family = Family {
    packages: &["GAPILib.Operators"],
    dialect: None,
    builtins: &[
        Builtin { header: SAMPLING, run: sample },
        Builtin { header: SELECTION, run: select },
        Builtin { header: CROSSOVER, run: cross },
        Builtin { header: MUTATION, run: mutate },
        Builtin { header: SURVIVAL, run: survive },
    ],
};

/// More individuals than this in one call are a mistake.
const MOST: i64 = 1_000_000;

/// An operator that a script names.
struct Operator {
    /// The name with its settings, as the script has it.
    text: String,
    choice: Choice,
    /// The script's function of that name.
    function: Option<Arc<eval::Function>>,
    kind: &'static OperatorKind,
    /// What the function has said when it failed.
    error: Option<Diagnostic>,
}

impl Operator {
    fn take(session: &mut Session, args: &mut Args, kind: &str) -> Result<Operator, Failure> {
        let text: String = args.take("Operator")?;
        let choice = Choice::parse(&text)?;
        let Some(kind) = operators::kind(kind) else {
            unreachable!("the commands of this file are named after the kinds")
        };
        if kind.name != "sampling" {
            session.identification().recorder.evolves();
        }
        let mut function = None;
        if !kind.has(&choice.name)
            && let Some(found) = own_function::function(session, &choice.name)?
        {
            chosen::check(kind, &choice.name, &found)?;
            choice.options.clone().finish()?;
            function = Some(found);
        }
        Ok(Operator { text, choice, function, kind, error: None })
    }

    /// Calls the script's function with the numbers of its inputs.
    fn call(
        &mut self,
        session: &mut Session,
        function: &Arc<eval::Function>,
        n_genes: usize,
        inputs: &[f64],
    ) -> Result<Vec<f64>, Fault> {
        let mut rest = inputs;
        let values = self.kind.signature.inputs.iter().map(|(_, size)| {
            let (own, others) = rest.split_at(size.count(n_genes));
            rest = others;
            match size {
                Size::One => Value::Real(own[0]),
                Size::Genes => own.to_vec().into(),
                Size::Random => {
                    let columns = operators::NUMBERS;
                    RealMatrix { rows: n_genes, columns, elements: own.to_vec() }.into()
                }
            }
        });
        let arguments = values.collect::<Vec<_>>().into();
        let span = session.call_site();
        match eval::call_function(function, arguments, span, session) {
            Ok(outputs) => {
                let mut numbers = Vec::new();
                for (value, (name, size)) in outputs.iter().zip(self.kind.signature.outputs) {
                    let (own, expected) = (value.as_vector()?, size.count(n_genes));
                    if own.len() != expected {
                        let (operator, found) = (&self.choice.name, own.len());
                        bail!(
                            BAD_OPERATOR,
                            "`{name}` of the {} `{operator}` has size {found} instead of \
                             {expected}", self.kind.name;
                            help: "return one value per gene"
                        );
                    }
                    numbers.extend(own);
                }
                Ok(numbers)
            }
            Err(diagnostic) => {
                let message = diagnostic.message.clone();
                self.error = Some(diagnostic);
                Err(Fault::new(BAD_OPERATOR, message))
            }
        }
    }

    /// Records the call for learners, where that is asked for.
    fn traced(
        &self,
        session: &mut Session,
        n_genes: usize,
        action: impl FnOnce() -> Action,
    ) -> Result<(), Fault> {
        if !session.traces_operations() {
            return Ok(());
        }
        let (operator, is_own) = (self.text.clone(), self.function.is_some());
        let n_genes = n_genes as u32;
        session.traced(|tracer, place| {
            tracer.operated(Operation { place, operator, is_own, n_genes, action: action() });
        })
    }

    /// What a function has said itself comes before what was made of it.
    fn failure(&mut self, fault: Fault) -> Failure {
        match self.error.take() {
            Some(diagnostic) => diagnostic.into(),
            None => fault.into(),
        }
    }
}

/// The random numbers of a call.
struct Draws {
    rng: Mrg32k3a,
    /// The state of the generator at the beginning.
    before: [f64; 6],
}

impl Draws {
    fn take(session: &mut Session, args: &mut Args) -> Result<Draws, Fault> {
        let seed: Vec<f64> = args.take("Seed")?;
        let rng = session.generator(&seed)?;
        Ok(Draws { before: rng.state(), rng })
    }

    /// The outputs of the call: its value and the seed that continues.
    fn outputs(&self, session: &mut Session, value: Value) -> Value {
        let site = session.site_of_call();
        session.identification().recorder.seeded(self.before, self.rng.state(), site);
        Value::Tuple(vec![value, row(self.rng.state().to_vec())])
    }
}

fn count(args: &mut Args, name: &str) -> Result<usize, Fault> {
    let count: i64 = args.take(name)?;
    match usize::try_from(count).ok().filter(|_| count <= MOST) {
        Some(count) => Ok(count),
        None => bail!(BAD_POPULATION, "`{name}` is {count}; it must be between 0 and {MOST}"),
    }
}

const SAMPLING: &str = concat!(
    r#"
function Op_Sampling "Samples random individuals, as for the first generation."
  input String Operator "name with settings, such as \"latin_hypercube\", or your own function";
  input Integer N_Individuals "number of individuals";
"#,
    inputs::ranges!(),
    inputs::seed!(),
    r#"  output Real Population[:,:] "one individual in each row";
"#,
    inputs::next_seed!(),
    r#"end Op_Sampling;
"#,
);

fn sample(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut operator = Operator::take(session, &mut args, "sampling")?;
    let individuals = count(&mut args, "N_Individuals")?;
    let minima: Vec<f64> = args.take("Param_Min")?;
    let maxima: Vec<f64> = args.take("Param_Max")?;
    let genes = genes(&minima, &maxima, minima.len())?;
    if genes.is_empty() {
        return Err(Fault::new(SIZE_MISMATCH, "the search ranges are empty").into());
    }
    let mut draws = Draws::take(session, &mut args)?;
    let genomes = match operator.function.clone() {
        None => operators::sampling(operator.choice.clone())
            .and_then(|own| own.sample(&genes, individuals, &mut draws.rng)),
        Some(function) => sampling::sample_by(
            &mut |inputs| operator.call(session, &function, genes.len(), inputs),
            &genes,
            individuals,
            &mut draws.rng,
        ),
    };
    let genomes = genomes.map_err(|fault| operator.failure(fault))?;
    session.identification().recorder.searched(&minima, &maxima, &genomes);
    operator.traced(session, genes.len(), || Action::Sampling {
        sampled: genomes.values().to_vec(),
        minima,
        maxima,
    })?;
    Ok(draws.outputs(session, genomes_value(genomes)))
}

const SELECTION: &str = concat!(
    r#"
function Op_Selection "Selects parents by fitness."
  input String Operator "name with settings, such as \"tournament(size = 3)\", or your own function";
  input Any Fit "Real[:]: fitness of all individuals, in any order; smaller is better";
  input Integer Parents "number of parents";
"#,
    inputs::seed!(),
    r#"  output Integer Places[:] "row numbers of the parents; 1 and 2 mate, 3 and 4, and so on";
"#,
    inputs::next_seed!(),
    r#"end Op_Selection;
"#,
);

fn select(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut operator = Operator::take(session, &mut args, "selection")?;
    let fitness: Vec<f64> = args.take("Fit")?;
    let parents = count(&mut args, "Parents")?;
    if fitness.is_empty() {
        return Err(Fault::new(
            SIZE_MISMATCH,
            "`Fit` is empty: there are no individuals to select from",
        )
        .into());
    }
    let mut draws = Draws::take(session, &mut args)?;
    let places = match operator.function.clone() {
        None => operators::selection(operator.choice.clone())
            .and_then(|own| own.select(&fitness, parents, &mut draws.rng)),
        Some(function) => selection::select_by(
            &mut |inputs| operator.call(session, &function, 0, inputs),
            &fitness,
            parents,
            &mut draws.rng,
        ),
    };
    let places = places.map_err(|fault| operator.failure(fault))?;
    operator.traced(session, 0, || {
        let places = places.iter().map(|&place| place as u32).collect();
        Action::Selection { fitness, places }
    })?;
    let places: Vec<i64> = places.into_iter().map(|k| k as i64 + 1).collect();
    Ok(draws.outputs(session, places.into()))
}

const CROSSOVER: &str = concat!(
    r#"
function Op_Crossover "Crossover of parents in adjacent rows; one child per parent."
  input String Operator "name with settings, such as \"sbx(eta = 5)\" or \"blend(probability = 0.9)\", or your own function";
  input Any Parents "Real[:,:]: rows 1 and 2 mate, rows 3 and 4, and so on; a last row without partner mates with row 1";
"#,
    inputs::ranges!(),
    inputs::seed!(),
    r#"  output Real Children[:,:] "one child in each row";
"#,
    inputs::next_seed!(),
    r#"end Op_Crossover;
"#,
);

fn cross(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut operator = Operator::take(session, &mut args, "crossover")?;
    let parents = take_genomes(&mut args, "Parents")?;
    let n_genes = parents.n_genes();
    let genes =
        genes(&args.take::<Vec<f64>>("Param_Min")?, &args.take::<Vec<f64>>("Param_Max")?, n_genes)?;
    let mut draws = Draws::take(session, &mut args)?;
    let children = match operator.function.clone() {
        None => {
            let mut choice = operator.choice.clone();
            let probability = choice.options.take("probability", 0.0..=1.0, 1.0)?;
            let own = operators::crossover(choice)?;
            let own = own.for_run(n_genes, &mut draws.rng).unwrap_or(own);
            crossover::cross_rows(&parents, |first, second| {
                if probability == 1.0 || draws.rng.uniform() < probability {
                    own.cross(Parents { first, second, genes: &genes }, &mut draws.rng)?;
                }
                Ok(())
            })
        }
        Some(function) => crossover::cross_rows(&parents, |first, second| {
            let mut call = |inputs: &[f64]| operator.call(session, &function, n_genes, inputs);
            crossover::cross_by(&mut call, first, second, &genes, &mut draws.rng)
        }),
    };
    let children = children.map_err(|fault| operator.failure(fault))?;
    operator.traced(session, n_genes, || Action::Crossover {
        parents: parents.values().to_vec(),
        children: children.values().to_vec(),
    })?;
    Ok(draws.outputs(session, genomes_value(children)))
}

const MUTATION: &str = concat!(
    r#"
function Op_Mutation "Mutates each gene with probability F_Mut."
  input String Operator "name with settings, such as \"gaussian(sigma = 0.05)\", or your own function";
  input Any Nparameters "Real[:,:]: individuals, one in each row";
  input Real F_Mut "mutation probability of each gene, 0 to 1";
"#,
    inputs::ranges!(),
    inputs::seed!(),
    r#"  input Integer Elitism = 0 "number of first rows that are not changed";
  input Integer Cycle = 1 "generation number, from 1, for operators that depend on it";
  input Integer N_Cycles = 100 "total number of generations";
  output Real Mutated[:,:] "the individuals after mutation";
"#,
    inputs::next_seed!(),
    r#"end Op_Mutation;
"#,
);

fn mutate(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut operator = Operator::take(session, &mut args, "mutation")?;
    let mut genomes = take_genomes(&mut args, "Nparameters")?;
    let before = genomes.values().to_vec();
    let rate: f64 = args.take("F_Mut")?;
    mutation::check_factor(rate)?;
    let n_genes = genomes.n_genes();
    let minima: Vec<f64> = args.take("Param_Min")?;
    let maxima: Vec<f64> = args.take("Param_Max")?;
    let genes = genes(&minima, &maxima, n_genes)?;
    let mut draws = Draws::take(session, &mut args)?;
    let elites = count(&mut args, "Elitism")?;
    let (cycle, cycles) = (count(&mut args, "Cycle")?, count(&mut args, "N_Cycles")?);
    let generation = cycle.saturating_sub(1) as u64;
    let course = Course { generation, planned: Some(cycles as f64) };
    let own = match operator.function {
        None => Some(operators::mutation(operator.choice.clone())?),
        Some(_) => None,
    };
    for k in elites..genomes.len() {
        let genome = genomes.row_mut(k);
        let mutated = match (&own, operator.function.clone()) {
            (Some(own), _) => {
                own.mutate(Child { genome, genes: &genes, rate, course }, &mut draws.rng)
            }
            (None, Some(function)) => mutation::mutate_by(
                &mut |inputs| operator.call(session, &function, n_genes, inputs),
                genome,
                &genes,
                [rate, course.fraction()],
                &mut draws.rng,
            ),
            (None, None) => Ok(()),
        };
        mutated.map_err(|fault| operator.failure(fault))?;
    }
    session.identification().recorder.searched(&minima, &maxima, &genomes);
    operator.traced(session, n_genes, || Action::Mutation {
        before,
        after: genomes.values().to_vec(),
        elites: elites as u32,
        factor: rate,
    })?;
    Ok(draws.outputs(session, genomes_value(genomes)))
}

const SURVIVAL: &str = r#"
function Op_Survival "Survivor selection: forms the next generation from the old one and its offspring."
  input String Operator "name with settings, such as \"mu_plus_lambda\", or your own function";
  input Any Pop "Real[:,:]: the old generation, one individual in each row";
  input Any Fit "Real[:]: its fitness";
  input Any Offspring "Real[:,:]: the offspring, one individual in each row";
  input Any Fit_Offspring "Real[:]: their fitness";
  input Integer Population "number of survivors";
  input Integer Elitism = 1 "number of elites, for the operator elitism";
  input Integer Places[:] = fill(0, 0) "parents as returned by Op_Selection, for crowding" annotation(optional = true);
  input Real Param_Min[:] = fill(0.0, 0) "lower bounds of the search ranges, for crowding" annotation(optional = true);
  input Real Param_Max[:] = fill(1.0, 0) "upper bounds of the search ranges, for crowding" annotation(optional = true);
  output Real Pop_Next[:,:] "the next generation";
  output Real Fit_Next[:] "its fitness";
end Op_Survival;
"#;

fn survive(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut operator = Operator::take(session, &mut args, "survival")?;
    let (old, offspring) = (take_genomes(&mut args, "Pop")?, take_genomes(&mut args, "Offspring")?);
    let fitness: Vec<f64> = args.take("Fit")?;
    let young: Vec<f64> = args.take("Fit_Offspring")?;
    check_size("Fit", fitness.len(), old.len(), "`Pop` has rows:")?;
    check_size("Fit_Offspring", young.len(), offspring.len(), "`Offspring` has rows:")?;
    check_size("Offspring", offspring.n_genes(), old.n_genes(), "the columns of `Pop` number")?;
    let sizes =
        Sizes { population: count(&mut args, "Population")?, elites: count(&mut args, "Elitism")? };
    let own = match operator.function {
        None => Some(operators::survival(operator.choice.clone())?),
        Some(_) => None,
    };
    let parents = match args.optional::<WholeNumbers>("Places")? {
        Some(WholeNumbers(places)) => families(&places, old.len(), offspring.len())?,
        None if own.as_ref().is_some_and(|own| own.needs_parents()) => {
            let name = &operator.choice.name;
            return Err(fault!(BAD_OPTION, "`{name}` needs the parents of the offspring")
                .help("pass `Places` as returned by `Op_Selection`, `Param_Min` and `Param_Max`")
                .into());
        }
        None => Vec::new(),
    };
    let minima: Option<Vec<f64>> = args.optional("Param_Min")?;
    let maxima: Option<Vec<f64>> = args.optional("Param_Max")?;
    let minima = minima.unwrap_or_else(|| vec![0.0; old.n_genes()]);
    let maxima = maxima.unwrap_or_else(|| vec![1.0; old.n_genes()]);
    let brood = Brood {
        old: Rated { genomes: &old, fitness: &fitness },
        ages: &vec![0; old.len()],
        offspring: Rated { genomes: &offspring, fitness: &young },
        parents: &parents,
        genes: &genes(&minima, &maxima, old.n_genes())?,
    };
    let survivors = match (own, operator.function.clone()) {
        (Some(own), _) => own.survivors(&brood, sizes),
        (None, Some(function)) => survival::survivors_by(
            &mut |inputs| operator.call(session, &function, 0, inputs),
            &brood,
            sizes,
        ),
        (None, None) => Ok(Vec::new()),
    };
    let survivors = survivors.map_err(|fault| operator.failure(fault))?;
    operator.traced(session, old.n_genes(), || traced_survival(&brood, &survivors))?;
    let mut next = Genomes::with_capacity(old.n_genes(), survivors.len());
    survivors.iter().for_each(|&one| next.push(brood.genome(one)));
    let next_fitness: Vec<f64> = survivors.iter().map(|&one| brood.fitness(one)).collect();
    Ok(Value::Tuple(vec![genomes_value(next), next_fitness.into()]))
}

/// Who lives on, as a trace has it.
fn traced_survival(brood: &Brood, survivors: &[Survivor]) -> Action {
    let row = |survivor: &Survivor| match survivor {
        Survivor::Old(k) => *k as u32,
        Survivor::Offspring(k) => (brood.old.genomes.len() + k) as u32,
    };
    Action::Survival {
        old: brood.old.genomes.values().to_vec(),
        fitness: brood.old.fitness.to_vec(),
        offspring: brood.offspring.genomes.values().to_vec(),
        fitness_offspring: brood.offspring.fitness.to_vec(),
        survivors: survivors.iter().map(row).collect(),
    }
}

/// The parents of each child, from rows in the order of `Op_Selection`: the children of a pair stand
/// side by side, an odd last parent has mated with the first.
fn families(places: &[i64], old: usize, offspring: usize) -> Result<Vec<[usize; 2]>, Fault> {
    check_size("Places", places.len(), offspring, "`Offspring` has rows:")?;
    let mut rows = Vec::with_capacity(places.len());
    for &place in places {
        match usize::try_from(place).ok().filter(|row| (1..=old).contains(row)) {
            Some(row) => rows.push(row - 1),
            None => bail!(
                SIZE_MISMATCH,
                "`Places` contains row {place}, but the population has {old} rows"
            ),
        }
    }
    let pair = |k: usize| [rows[k & !1], rows.get(k | 1).copied().unwrap_or(rows[0])];
    Ok((0..rows.len()).map(pair).collect())
}
