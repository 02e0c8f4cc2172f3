//! The functions of the paper (package `GAPILib.Basics`): random numbers, measured data, and one
//! generation of the genetic algorithm. The same functions as Modelica code lie in
//! `models/GAPILib`.

use super::inputs;
use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::bail;
use crate::diag::Fault;
use crate::errors::FOLLOW_UP;
use crate::ga::errors::{BAD_CROSS_POINT, BAD_POPULATION, SIZE_MISMATCH};
use crate::ga::{self, Gene, Genomes};
use crate::identify::Question;
use crate::identify::errors::{BAD_DATA, POINTS_OUTSIDE};
use crate::identify::fitness::sum_of_squares;
use crate::identify::problem::Free;
use crate::name::Ident;
use crate::runs::identification::Request;
use crate::runs::refinement::Refinement;
use crate::teach::MutationCall;
use crate::value::errors::TYPE_MISMATCH;
use crate::value::{ArrayValue, FromValue, Marks, RealMatrix, Value};

/// The functions of the paper.
pub(super) const FAMILY: Family = Family {
    packages: &["GAPILib.Basics"],
    dialect: None,
    builtins: &[
        Builtin { header: RAM_GEN_ARENA, run: ram_gen_arena },
        Builtin { header: EXP_ADQ_SISO, run: exp_adq_siso },
        Builtin { header: EVAL, run: eval },
        Builtin { header: FIT, run: fit },
        Builtin { header: FIT_ORDER, run: fit_order },
        Builtin { header: CROSS, run: cross },
        Builtin { header: MUTATION, run: mutation },
        Builtin { header: REFINE, run: refine },
    ],
};

/// More numbers than this in one call are a mistake.
const MOST_NUMBERS: i64 = 100_000_000;

/// A matrix and the marks of its rows; a vector is one row.
struct Rows(RealMatrix, Marks);

/// Whole numbers: one, or a vector of them, also as Reals.
pub(super) struct WholeNumbers(pub(super) Vec<i64>);

impl FromValue for Rows {
    fn from_value(value: Value) -> Result<Rows, Fault> {
        let value = match value {
            Value::Array(array) if array.rank() == 1 => {
                Value::Array(ArrayValue { dims: vec![1, array.dims[0]], ..array })
            }
            other => other,
        };
        let marks = match &value {
            Value::Array(array) => array.marks.clone(),
            _ => Marks::default(),
        };
        Ok(Rows(RealMatrix::from_value(value)?, marks))
    }
}

impl FromValue for WholeNumbers {
    fn from_value(value: Value) -> Result<WholeNumbers, Fault> {
        let numbers = value.as_vector()?;
        match numbers.iter().find(|number| number.fract() != 0.0 || number.abs() > 1e15) {
            Some(number) => bail!(TYPE_MISMATCH, "expected integers, got {number}"),
            None => Ok(WholeNumbers(numbers.into_iter().map(|number| number as i64).collect())),
        }
    }
}

pub(super) fn row(elements: Vec<f64>) -> Value {
    RealMatrix { rows: 1, columns: elements.len(), elements }.into()
}

pub(super) fn genomes_value(genomes: Genomes) -> Value {
    let (rows, columns) = (genomes.len(), genomes.n_genes());
    RealMatrix { rows, columns, elements: genomes.into_values() }.into()
}

pub(super) fn take_genomes(args: &mut Args, name: &str) -> Result<Genomes, Fault> {
    let Rows(matrix, _) = args.take(name)?;
    if matrix.columns == 0 {
        bail!(SIZE_MISMATCH, "`{name}` has no columns; it needs one column per gene");
    }
    Genomes::new(matrix.columns, matrix.elements)
}

/// Whether `name` has as many elements as `of` says.
pub(super) fn check_size(name: &str, size: usize, expected: usize, of: &str) -> Result<(), Fault> {
    if size == expected {
        return Ok(());
    }
    bail!(
        SIZE_MISMATCH,
        "`{name}` has {size} elements, but {of} {expected}";
        help: "use matching sizes"
    )
}

const RAM_GEN_ARENA: &str = r#"
function Ram_Gen_ARENA "Pseudo-random numbers of the generator that Arena uses (MRG32k3a)."
  input Any Seed "Real[1,6]: seed {x(n-3), x(n-2), x(n-1), y(n-3), y(n-2), y(n-1)}";
  input Integer N_Ram "number of pseudo-random numbers to generate";
  output Real Ram_list[:,:] "Real[1,N_Ram]: uniformly distributed numbers between 0 and 1, both excluded";
  output Real Seed_Next[:,:] "Real[1,6]: generator state after N_Ram draws, to pass to the next call";
end Ram_Gen_ARENA;
"#;

fn ram_gen_arena(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let seed: Vec<f64> = args.take("Seed")?;
    let count: i64 = args.take("N_Ram")?;
    if !(0..=MOST_NUMBERS).contains(&count) {
        bail!(SIZE_MISMATCH, "`N_Ram` is {count}; it must be between 0 and {MOST_NUMBERS}");
    }
    let mut rng = session.generator(&seed)?;
    let first = rng.state();
    let numbers = (0..count).map(|_| rng.uniform()).collect();
    let site = session.site_of_call();
    session.identification().recorder.seeded(first, rng.state(), site);
    session.traced(|tracer, place| tracer.drawn(place, first, count as usize))?;
    Ok(Value::Tuple(vec![row(numbers), row(rng.state().to_vec())]))
}

const EXP_ADQ_SISO: &str = r#"
function Exp_Adq_SISO "Reads the measured data of one input and one output from a file."
  input String namefile "name of the .mat file (or .csv file with a header line)";
  input String Xmatrixname "name of the matrix of X values";
  input String Ymatrixname "name of the matrix of Y values";
  output Boolean State_Exp_Adq "true when both matrices were read and their sizes agree";
  output Integer SizeMatrix[2] "numbers of elements of the X and of the Y matrix";
  output Real Xexp[:] "array of experimental X data";
  output Real Yexp[:] "array of experimental Y data";
end Exp_Adq_SISO;
"#;

fn exp_adq_siso(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("namefile")?;
    let names: [String; 2] = [args.take("Xmatrixname")?, args.take("Ymatrixname")?];
    match session.read_measurement(&file, &names) {
        Ok(measurement) => {
            let (x, y) = (measurement.x.clone(), measurement.y.clone());
            session.measured(measurement)?;
            Ok(acquired(true, x, y))
        }
        Err(fault) => {
            session.report_fault(fault);
            session.identification().data_missing = true;
            Ok(acquired(false, Vec::new(), Vec::new()))
        }
    }
}

fn acquired(state: bool, x: Vec<f64>, y: Vec<f64>) -> Value {
    let sizes = vec![x.len() as i64, y.len() as i64];
    Value::Tuple(vec![state.into(), sizes.into(), x.into(), y.into()])
}

const EVAL: &str = concat!(
    r#"
function Eval "Simulates the model with the genes of each individual, in parallel."
"#,
    inputs::model!(),
    r#"  input Any New_Generation "Real[:,:]: complete set of population values, one individual in each row";
"#,
    inputs::variables!(),
    r#"  output Real DATASim_Int[:,:] "Y_Name interpolated at Xexp, one individual in each row; NaN where the simulation failed";
  output String Messages[:] "empty where the simulation succeeded";
end Eval;
"#,
);

fn eval(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let request = take_request(&mut args)?;
    let genomes = take_genomes(&mut args, "New_Generation")?;
    if request.question.x.is_empty() && session.identification().data_missing {
        // One cause, one error: reading the data has failed, and has said so.
        let message = "nothing was simulated because the measured data could not be read";
        let note = Fault::new(FOLLOW_UP, message).at(session.call_site()).note();
        return Err(note.into());
    }
    let columns = request.question.x.len();
    let falls = falling_time(&request.question);
    let (simulated, first) =
        session.evaluate_population(request, &genomes).map_err(|failure| match (failure, falls) {
            (Failure::Here(fault), Some([before, after])) if fault.code == POINTS_OUTSIDE => {
                Failure::Here(fault.help(format!(
                    "times rise, but `Xexp` falls from {before} to {after}: if the columns of X and Y \
                     are swapped in the call that reads them, swap them back"
                )))
            }
            (failure, _) => failure,
        })?;
    let messages = simulated.messages();
    session.generation_simulated()?;
    session.pause()?;
    let rows = ArrayValue {
        marks: Marks::from(first, genomes.len()),
        ..ArrayValue::matrix(genomes.len(), columns, simulated.rows)
    };
    Ok(Value::Tuple(vec![Value::Array(rows), messages.into()]))
}

/// The first two of the measured times of which the second is less.
fn falling_time(question: &Question) -> Option<[f64; 2]> {
    let falls = |pair: &&[f64]| pair[1] < pair[0];
    let pair = question.x.windows(2).find(falls).filter(|_| question.x_name == "time")?;
    Some([pair[0], pair[1]])
}

fn take_request(args: &mut Args) -> Result<Request, Fault> {
    Ok(Request {
        path: args.take("SimuPath")?,
        model: args.take("SimuCaseStudyName")?,
        question: Question {
            x: args.take("Xexp")?,
            parameters: args.take("Parameter_Names")?,
            x_name: args.take("X_Name")?,
            y_name: args.take("Y_Name")?,
        },
    })
}

const FIT: &str = r#"
function Fit "Fitness: sum of the squared differences between experiment and simulation."
  input Any DATASim_Int "Real[:,:]: interpolated values, one individual in each row";
  input Any Yexp "Real[:]: array of experimental Y data";
  output Real Eval_Mod[:] "sum of squared differences; 1e60 for a failed simulation";
end Fit;
"#;

fn fit(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let Rows(simulated, marks) = args.take("DATASim_Int")?;
    let given: Value = args.take("Yexp")?;
    let is_simulated = matches!(&given, Value::Array(array) if array.marks.of(0).is_some());
    args.put_back("Yexp", given);
    let mut measured: Vec<f64> = args.take("Yexp")?;
    check_size("Yexp", measured.len(), simulated.columns, "the rows of `DATASim_Int` have")?;
    if let Some(k) = measured.iter().position(|value| !value.is_finite()) {
        bail!(BAD_DATA, "measured Y value {} is {}", k + 1, measured[k]; help: "remove this point");
    }
    if measured.is_empty() {
        bail!(BAD_DATA, "`Yexp` is empty"; help: "read them with `Exp_Adq_SISO`");
    }
    let recorder = &session.identification().recorder;
    let individuals = (0..simulated.rows).flat_map(|row| match marks.of(row) {
        Some(number) => vec![number],
        None => recorder.copied(simulated.row(row)),
    });
    let individuals: Vec<u64> = individuals.collect();
    if is_simulated && individuals.is_empty() {
        note_simulated_data(session);
    }
    if let Some(converted) = session.fitted(&individuals, &measured) {
        measured = converted;
    }
    let rows = (0..simulated.rows).map(|k| simulated.row(k));
    let fitness: Vec<f64> = rows.map(|row| sum_of_squares(row, &measured)).collect();
    session.identification().recorder.rated(individuals, &measured);
    session
        .traced(|tracer, place| tracer.rated(place, &fitness, &simulated.elements, &measured))?;
    Ok(fitness.into())
}

/// Says once that data come from `Eval` and what is compared with them does not: scripts that invent
/// measurements mean that, others have swapped the arguments.
fn note_simulated_data(session: &mut Session) {
    if session.models.is_new_note(Ident::new("simulated data")) {
        let text = "`Yexp` is the result of `Eval`, and `DATASim_Int` is not: if they are swapped, write \
                    `Fit(DATASim_Int, Yexp)`, the simulation first";
        session.note(BAD_DATA, text.to_owned());
    }
}

const FIT_ORDER: &str = r#"
function Fit_Order "Sorts the individuals by fitness, best first."
  input Any Pop "Real[:,:]: population to be ordered";
  input Any Fit "Real[:]: fitness of all population";
  input Integer Population "number of individuals of the population";
  input Integer Parents "number of parents";
  input Integer Elitism "number of elites";
  output Real Pop_Ordered[:,:] "population sorted by fitness value; ties keep their order";
  output Real Fit_Ordered[:] "the fitness in the same order";
end Fit_Order;
"#;

fn fit_order(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let population = take_genomes(&mut args, "Pop")?;
    let fitness: Vec<f64> = args.take("Fit")?;
    let individuals: i64 = args.take("Population")?;
    let (parents, elites): (i64, i64) = (args.take("Parents")?, args.take("Elitism")?);
    ga::selection::check_sizes(individuals, parents, elites)?;
    if individuals != population.len() as i64 {
        let rows = population.len();
        bail!(SIZE_MISMATCH, "`Pop` has {rows} rows, but `Population` is \
                              {individuals}"; help: "use matching sizes");
    }
    let (ordered, fitness_ordered) = ga::sort_by_fitness(&population, &fitness)?;
    session.identification().recorder.ordered(&population, &fitness);
    let pairs = (parents as usize, elites as usize);
    session.traced(|tracer, place| tracer.sorted(place, (population.values(), &fitness), pairs))?;
    Ok(Value::Tuple(vec![genomes_value(ordered), fitness_ordered.into()]))
}

const CROSS: &str = r#"
function Cross "Elitism and n-point crossover: parents of adjacent rank exchange the genes after each crossing point."
  input Integer Parents "number of parents";
  input Integer Elitism "number of elites";
  input Any OldGeneration "Real[:,:]: old generation, ordered by fitness";
  input Integer Cross_Point[:] = {div(size(OldGeneration, 2), 2)} "crossing points" annotation(optional = true);
  output Real NewGeneration_Cross[:,:] "Elitism + Parents rows: first the unchanged elites, then the children";
end Cross;
"#;

fn cross(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (parents, elites): (i64, i64) = (args.take("Parents")?, args.take("Elitism")?);
    let old = take_genomes(&mut args, "OldGeneration")?;
    let n_genes = old.n_genes();
    let points = match args.optional::<WholeNumbers>("Cross_Point")? {
        Some(WholeNumbers(points)) => ga::crossover::check_points(&points, n_genes)?,
        None => vec![n_genes / 2],
    };
    note_idle_points(session, &points, n_genes);
    ga::selection::check_sizes(old.len() as i64, parents, elites)?;
    let pairs = (parents as usize, elites as usize);
    session.identification().recorder.evolves();
    session.traced(|tracer, place| {
        tracer.crossed(place, (old.values(), n_genes), pairs, &points);
    })?;
    let mut chosen = Genomes::with_capacity(n_genes, parents as usize);
    old.rows().take(parents as usize).for_each(|genome| chosen.push(genome));
    let children = ga::crossover::cross_adjacent(&chosen, &points);
    Ok(genomes_value(ga::survival::elites_first(&old, elites as usize, &children)))
}

/// Says once that children are copies of their parents.
fn note_idle_points(session: &mut Session, points: &[usize], n_genes: usize) {
    let is_idle = |point: &usize| *point == 0 || *point == n_genes;
    let is_new = n_genes > 1 && points.iter().all(is_idle) && !points.is_empty();
    if is_new && session.models.is_new_note(Ident::new("crossing points")) {
        let points = points.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        let text = format!(
            "with the crossing point {points} of {n_genes} genes all children are copies of their \
             parents: choose crossing points from 1 to {}",
            n_genes - 1
        );
        session.note(BAD_CROSS_POINT, text);
    }
}

const MUTATION: &str = r#"
function Mutation "Uniform mutation: replaces each gene, with probability F_Mut, by a random value."
  input Any Nparameters "Real[:,:]: population returned by Cross";
  input Real F_Mut "mutation probability of each gene, 0 to 1";
  input Any RamMut "Real[:,:]: pseudo-random numbers, one per gene, in the shape of Nparameters or in one row";
  input Real Param_Min[:] = {min(Nparameters[:,j]) for j in 1:size(Nparameters, 2)} "lower bounds of the search ranges" annotation(optional = true);
  input Real Param_Max[:] = {max(Nparameters[:,j]) for j in 1:size(Nparameters, 2)} "upper bounds of the search ranges" annotation(optional = true);
  input Integer Elitism = 0 "number of first rows that are not changed";
  output Real NewGeneration_Mut[:,:] "population after elitism, crossover and mutation";
end Mutation;
"#;

fn mutation(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut genomes = take_genomes(&mut args, "Nparameters")?;
    let factor: f64 = args.take("F_Mut")?;
    let Rows(numbers, _) = args.take("RamMut")?;
    let minima: Option<Vec<f64>> = args.optional("Param_Min")?;
    let maxima: Option<Vec<f64>> = args.optional("Param_Max")?;
    let elites: i64 = args.take("Elitism")?;
    ga::mutation::check_factor(factor)?;
    check_sizes_of_mutation(&genomes, numbers.elements.len(), [&minima, &maxima])?;
    let Some(elites) = usize::try_from(elites).ok().filter(|&count| count <= genomes.len()) else {
        let rows = genomes.len();
        bail!(BAD_POPULATION, "`Elitism` is {elites}, but `Nparameters` has {rows} rows");
    };
    let searched = minima.is_some() || maxima.is_some();
    let minima = minima.unwrap_or_else(|| extremes(&genomes, f64::min));
    let maxima = maxima.unwrap_or_else(|| extremes(&genomes, f64::max));
    let genes = genes(&minima, &maxima, genomes.n_genes())?;
    session.identification().recorder.evolves();
    let call = MutationCall {
        genes: genomes.values(),
        numbers: &numbers.elements,
        elites,
        factor,
        minima: &minima,
        maxima: &maxima,
    };
    session.traced(|tracer, place| tracer.mutated(place, &call))?;
    ga::mutation::mutate_uniform(&mut genomes, elites, &genes, factor, &numbers.elements);
    if searched {
        session.identification().recorder.searched(&minima, &maxima, &genomes);
    }
    Ok(genomes_value(genomes))
}

/// Refuses numbers that do not fit the genes, all in one message.
fn check_sizes_of_mutation(
    genomes: &Genomes,
    numbers: usize,
    [minima, maxima]: [&Option<Vec<f64>>; 2],
) -> Result<(), Fault> {
    let (rows, n_genes) = (genomes.len(), genomes.n_genes());
    let mut wrong = Vec::new();
    if numbers != rows * n_genes {
        wrong.push(format!(
            "`RamMut` has {numbers} numbers, but {rows} individuals of {n_genes} genes need {}",
            rows * n_genes
        ));
    }
    for (name, bounds) in [("Param_Min", minima), ("Param_Max", maxima)] {
        if let Some(count) = bounds.as_ref().map(Vec::len).filter(|count| *count != n_genes) {
            wrong.push(format!("the length of `{name}` is {count}, the number of genes {n_genes}"));
        }
    }
    if wrong.is_empty() {
        return Ok(());
    }
    bail!(SIZE_MISMATCH, "{}", wrong.join("; ");
        help: "give a random number for every gene of every individual that `Cross` returned, \
               (N_Elitism + N_Parents)*N_Parameters, and bounds for every parameter")
}

/// The extreme of every gene over the population.
fn extremes(genomes: &Genomes, extreme: fn(f64, f64) -> f64) -> Vec<f64> {
    let mut rows = genomes.rows();
    let first = rows.next().map(<[f64]>::to_vec).unwrap_or_default();
    rows.fold(first, |sofar, row| sofar.iter().zip(row).map(|(a, b)| extreme(*a, *b)).collect())
}

pub(super) fn genes(minima: &[f64], maxima: &[f64], n_genes: usize) -> Result<Vec<Gene>, Fault> {
    check_size("Param_Min", minima.len(), n_genes, "the columns of the population number")?;
    check_size("Param_Max", maxima.len(), n_genes, "the columns of the population number")?;
    let ranges = minima.iter().zip(maxima).enumerate();
    ranges.map(|(k, (&min, &max))| Gene::new(format!("parameter {}", k + 1), min, max)).collect()
}

const REFINE: &str = concat!(
    r#"
function Refine "Nonlinear least squares: moves individuals to a local optimum by the Levenberg-Marquardt method."
"#,
    inputs::model!(),
    r#"  input Any Yexp "Real[:]: array of experimental Y data";
  input Any Individuals "Real[:,:]: starting points, one individual in each row";
  input Any Param_Min "Real[:]: lower bound of every parameter";
  input Any Param_Max "Real[:]: upper bound of every parameter; a positive range wider than a decade is searched on a logarithmic scale";
"#,
    inputs::variables!(),
    r#"  output Real Refined[:] "the best individual found";
  output Real Fit_Refined "its sum of squared differences";
  output Integer Simulations "number of simulations used";
end Refine;
"#,
);

fn refine(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let request = take_request(&mut args)?;
    let measured: Vec<f64> = args.take("Yexp")?;
    check_size("Yexp", measured.len(), request.question.x.len(), "`Xexp` has")?;
    let starts = take_genomes(&mut args, "Individuals")?;
    let n_genes = starts.n_genes();
    let (minima, maxima): (Vec<f64>, Vec<f64>) = (args.take("Param_Min")?, args.take("Param_Max")?);
    for (name, bounds) in [("Param_Min", &minima), ("Param_Max", &maxima)] {
        check_size(name, bounds.len(), n_genes, "the rows of `Individuals` have")?;
    }
    let range = |k: usize| {
        let name = request.question.parameters.get(k).cloned();
        let name = name.unwrap_or_else(|| format!("parameter {}", k + 1));
        Free::new(name, "", [minima[k], maxima[k]], None, None)
    };
    let ranges = (0..n_genes).map(range).collect::<Result<_, Fault>>()?;
    let refinement = Refinement { request, measured, ranges };
    let (refined, simulations) = session.refine(refinement, &starts)?;
    let simulations = i64::try_from(simulations).unwrap_or(i64::MAX);
    Ok(Value::Tuple(vec![refined.genome.into(), refined.fitness.into(), simulations.into()]))
}
