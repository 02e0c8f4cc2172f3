//! Outputs that are measured at the same instants with correlated errors: a covariance or correlations
//! as the problem file gives them, of the whole problem or of one experiment, or an estimated one.

use super::file::{CovarianceEntry, CovarianceTable, ExperimentEntry, MatrixEntry, ProblemFile};
use crate::diag::{At as _, Diagnostic, Fault};
use crate::identify::fitness::Law;
use crate::identify::problem::{Joint, Series, Sigma};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::{bail, fault};
use nalgebra::DMatrix;

/// What is written for a covariance that is estimated.
const ESTIMATE: &str = "estimate";
/// Matrices whose entries differ from their counterparts by less than this part are symmetric.
const ROUNDING: f64 = 1e-9;
/// An estimated covariance needs so many complete rows more than it has outputs.
const MORE: usize = 2;

/// The place of an entry.
type PlaceOf<'a> = Box<dyn Fn(&[&str]) -> Span + 'a>;

/// The covariance of an experiment, and the place of what it says.
struct Stated<'a> {
    table: CovarianceTable,
    place: PlaceOf<'a>,
    /// The name of the group where nothing else is said.
    usual: String,
}

impl<'a> Stated<'a> {
    fn of(file: &'a ProblemFile, entry: &'a ExperimentEntry, label: &str) -> Option<Stated<'a>> {
        let (places, own, usual) = match (&entry.covariance, &file.covariance) {
            (Some(own), _) => (&entry.places, own, label.to_owned()),
            (None, Some(own)) => (&file.context.places, own, "all experiments".to_owned()),
            (None, None) => return None,
        };
        let table = match own {
            CovarianceEntry::Estimated(word) => CovarianceTable {
                matrix: Some(MatrixEntry::Estimated(word.clone())),
                ..CovarianceTable::default()
            },
            CovarianceEntry::Given(rows) => CovarianceTable {
                matrix: Some(MatrixEntry::Given(rows.clone())),
                ..CovarianceTable::default()
            },
            CovarianceEntry::More(table) => table.clone(),
        };
        let place = Box::new(move |way: &[&str]| places.at(&[&["covariance"], way].concat()));
        Some(Stated { table, place, usual })
    }

    /// The outputs whose errors are correlated.
    fn outputs(
        &self,
        file: &ProblemFile,
        entry: &ExperimentEntry,
        is_own: bool,
    ) -> Result<Vec<String>, Diagnostic> {
        let all = || entry.outputs.keys().cloned().collect::<Vec<String>>();
        let outputs =
            if self.table.outputs.is_empty() { all() } else { self.table.outputs.clone() };
        let place = (self.place)(&["outputs"]);
        let is_output = |name: &String| match is_own {
            true => all().contains(name),
            false => file.experiment.iter().any(|own| own.outputs.contains_key(name)),
        };
        if let Some(name) = outputs.iter().find(|name| !is_output(name)) {
            let fault = fault!(BAD_OPTION, "`covariance` names `{name}`, which is not an output");
            return Err(fault.help("name variables of `outputs`").at(place));
        }
        if outputs.len() < 2 {
            let fault = fault!(BAD_OPTION, "`covariance` is one of at least two outputs");
            return Err(fault.help("remove it, and give the output its `sigma`").at(place));
        }
        if let Some(name) = (1..outputs.len()).find(|k| outputs[..*k].contains(&outputs[*k])) {
            let fault = fault!(BAD_OPTION, "`covariance` names `{}` twice", outputs[name]);
            return Err(fault.at(place));
        }
        Ok(outputs)
    }
}

/// Whether a given matrix is one of correlations, or of covariances; or nothing is given.
enum Given {
    Covariance(DMatrix<f64>),
    Correlation(DMatrix<f64>),
    Estimated,
}

impl Given {
    fn of(stated: &Stated<'_>, outputs: &[String]) -> Result<Given, Diagnostic> {
        let CovarianceTable { matrix, correlation, group, .. } = &stated.table;
        let own = match (matrix, correlation) {
            (Some(MatrixEntry::Estimated(word)), None) if word == ESTIMATE => Ok(Given::Estimated),
            (Some(MatrixEntry::Given(rows)), None) => {
                let place = (stated.place)(&["matrix"]);
                Ok(Given::Covariance(matrix_of(rows, outputs).at(place)?))
            }
            (None, Some(rows)) => {
                let place = (stated.place)(&["correlation"]);
                let matrix = matrix_of(rows, outputs).at(place)?;
                if let Some(k) = (0..outputs.len()).find(|k| matrix[(*k, *k)] != 1.0) {
                    let (name, own) = (&outputs[k], matrix[(k, k)]);
                    let fault =
                        fault!(BAD_OPTION, "the correlation of `{name}` with itself is {own}");
                    return Err(fault.help("write 1, or the entry `matrix`").at(place));
                }
                Ok(Given::Correlation(matrix))
            }
            _ => Err(fault!(
                BAD_OPTION,
                "`covariance` has to say one thing";
                help: "write a matrix, `[[1e-4, 2e-5], [2e-5, 4e-4]]`, \"estimate\", or \
                       `{{ correlation = [[1, 0.5], [0.5, 1]] }}`"
            )),
        };
        let own = own.at((stated.place)(&[]))?;
        if group.is_some() && !matches!(own, Given::Estimated) {
            let fault = fault!(BAD_OPTION, "`group` names a covariance that is estimated");
            return Err(fault.help("remove it").at((stated.place)(&["group"])));
        }
        Ok(own)
    }

    /// Gives an output, the one with this number in its group, its part of the matrix.
    fn put(
        &self,
        entry: &ExperimentEntry,
        (outputs, member, group): (&[String], usize, &str),
        own: &mut Series,
    ) -> Result<(), Diagnostic> {
        let name = &outputs[member];
        let key = |key: &str| entry.places.at(&["outputs", name, key]);
        let joint = |correlations| Joint { group: group.to_owned(), member, correlations };
        match self {
            Given::Estimated => {
                if !matches!(own.sigma, Sigma::Unknown | Sigma::Estimated) {
                    let fault =
                        fault!(BAD_OPTION, "`{name}` has a sigma, and its covariance is estimated");
                    let help = "remove `sigma`, or give the `correlation`";
                    return Err(fault.help(help).at(key("sigma")));
                }
                own.sigma = Sigma::Shared(format!("{group} {}", member + 1));
                own.joint = Some(joint(None));
            }
            Given::Covariance(matrix) => {
                if own.sigma != Sigma::Unknown {
                    let fault = fault!(
                        BAD_OPTION,
                        "`{name}` has a sigma, and its variance is in `covariance`"
                    );
                    let help = "remove `sigma`, or give the `correlation` instead of a matrix";
                    return Err(fault.help(help).at(key("sigma")));
                }
                let sigma = |k: usize| matrix[(k, k)].sqrt();
                let row = |k: usize| matrix[(member, k)] / (sigma(member) * sigma(k));
                own.sigma = Sigma::Given(vec![sigma(member); own.x.len()]);
                own.joint = Some(joint(Some((0..outputs.len()).map(row).collect())));
            }
            Given::Correlation(matrix) => {
                if !matches!(own.sigma, Sigma::Given(_)) {
                    let fault =
                        fault!(BAD_OPTION, "`{name}` has a correlation, but no given sigma");
                    let help = "give `sigma` as a number or a column, or a `matrix` of covariances";
                    return Err(fault.help(help).at(entry.places.at(&["outputs", name])));
                }
                own.joint = Some(joint(Some(matrix.row(member).iter().copied().collect())));
            }
        }
        Ok(())
    }
}

/// A matrix with a row for each output.
fn matrix_of(rows: &[Vec<f64>], outputs: &[String]) -> Result<DMatrix<f64>, Fault> {
    let n = outputs.len();
    if rows.len() != n || rows.iter().any(|row| row.len() != n) {
        bail!(BAD_OPTION, "the matrix does not have {n} rows and columns, one for each output: {}", outputs.join(", "); help: "name the outputs that it is meant for: `outputs = [\"a\", \"b\"]`");
    }
    let matrix = DMatrix::from_fn(n, n, |a, b| rows[a][b]);
    if matrix.iter().any(|own| !own.is_finite()) {
        bail!(BAD_OPTION, "the matrix contains what is not a finite number");
    }
    for a in 0..n {
        for b in 0..a {
            let (one, other) = (matrix[(a, b)], matrix[(b, a)]);
            if (one - other).abs() > ROUNDING * one.abs().max(other.abs()) {
                bail!(
                    BAD_OPTION,
                    "the matrix is not symmetric: {one} and {other} for `{}` and `{}`", outputs[a], outputs[b];
                    help: "write the same number twice"
                );
            }
        }
    }
    if matrix.clone().cholesky().is_none() {
        bail!(
            BAD_OPTION,
            "the matrix is not positive definite";
            help: "variances are positive, and a covariance is smaller than the root of their product"
        );
    }
    Ok(matrix)
}

/// Gives the series of an experiment the covariance that its file states.
///
/// # Errors
///
/// Matrices that are none of errors, outputs that there are not, and errors that have no covariance.
pub(super) fn correlate(
    file: &ProblemFile,
    (entry, label): (&ExperimentEntry, &str),
    series: &mut [Series],
) -> Result<(), Diagnostic> {
    let Some(stated) = Stated::of(file, entry, label) else { return Ok(()) };
    let outputs = stated.outputs(file, entry, entry.covariance.is_some())?;
    let given = Given::of(&stated, &outputs)?;
    let group = stated.table.group.clone().unwrap_or_else(|| stated.usual.clone());
    if entry.spectrum.is_some() || !file.noise.is_empty() {
        let what = if file.noise.is_empty() { "spectra" } else { "process noise" };
        let fault = fault!(BAD_OPTION, "`covariance` cannot be combined with {what}");
        return Err(fault.help("remove `covariance`").at((stated.place)(&[])));
    }
    for (member, name) in outputs.iter().enumerate() {
        let own = series.iter().filter(|own| own.y_name == *name).count();
        if own > 1 {
            let fault = fault!(BAD_OPTION, "`{name}` has replicates, and a covariance with others");
            let help = "write the replicates as further rows, or as experiments of their own";
            return Err(fault.help(help).at(entry.places.at(&["outputs", name])));
        }
        let Some(at) = series.iter().position(|own| own.y_name == *name) else { continue };
        check(entry, &series[at])?;
        given.put(entry, (&outputs, member, &group), &mut series[at])?;
    }
    same_instants(&stated, (&outputs, &group), series)
}

/// Refuses a covariance of an experiment that is not fitted.
///
/// # Errors
///
/// Such an entry, at its place.
pub(super) fn refuse_kept(entry: &ExperimentEntry) -> Result<(), Diagnostic> {
    if entry.covariance.is_none() {
        return Ok(());
    }
    let fault = fault!(BAD_OPTION, "the experiment is for validation: it has no `covariance`");
    Err(fault.help("remove `covariance`").at(entry.places.at(&["covariance"])))
}

/// Refuses errors of an output that have no covariance with others.
fn check(entry: &ExperimentEntry, series: &Series) -> Result<(), Diagnostic> {
    let name = &series.y_name;
    let is_weighted = series.weight != 1.0;
    let (why, key) = if series.law != Law::Normal {
        ("errors that are neither normal nor log-normal", "error")
    } else if !series.censored.is_empty() {
        ("values beyond a limit (`below`, `above`)", "below")
    } else if matches!(series.sigma, Sigma::Variable(_) | Sigma::Formula(_)) {
        ("a sigma that is a formula", "sigma")
    } else if is_weighted {
        ("a `weight`", "weight")
    } else {
        return Ok(());
    };
    let fault = fault!(BAD_OPTION, "`{name}` has {why}: its errors have no covariance with others");
    let help = "leave the output out of `covariance`: `outputs = [\"a\", \"b\"]`";
    Err(fault.help(help).at(entry.places.at(&["outputs", name, key])))
}

/// Refuses outputs that are never measured at once.
fn same_instants(
    stated: &Stated<'_>,
    (outputs, group): (&[String], &str),
    series: &[Series],
) -> Result<(), Diagnostic> {
    let is_own = |own: &&Series| own.joint.as_ref().is_some_and(|joint| joint.group == group);
    let all: Vec<&Series> = series.iter().filter(is_own).collect();
    if all.len() < 2 {
        return Ok(());
    }
    let is_measured = |own: &&&Series, row: &usize| own.rows.contains(row);
    let rows = || all.iter().flat_map(|own| &own.rows);
    if rows().any(|row| all.iter().filter(|own| is_measured(own, row)).count() > 1) {
        return Ok(());
    }
    let fault = fault!(
        BAD_OPTION,
        "no row of the data has values of two of {}: they are measured at different instants",
        outputs.join(", ");
        help: "remove `covariance`, or leave out the output that is measured at other instants"
    );
    Err(fault.at((stated.place)(&[])))
}

/// Refuses groups that do not mean the same in all of their experiments, and estimated covariances of
/// too few rows.
///
/// # Errors
///
/// Such groups, at the place of the first one.
pub(super) fn check_all(file: &ProblemFile, series: &[Series]) -> Result<(), Diagnostic> {
    let place = || {
        let own = file.experiment.iter().find(|own| own.covariance.is_some());
        own.map_or(file.context.places.at(&["covariance"]), |own| own.places.at(&["covariance"]))
    };
    let mut known: Vec<(&str, Vec<(usize, &str)>)> = Vec::new();
    for own in series {
        let Some(joint) = &own.joint else { continue };
        let at = known.iter().position(|(name, _)| *name == joint.group).unwrap_or_else(|| {
            known.push((&joint.group, Vec::new()));
            known.len() - 1
        });
        known[at].1.push((joint.member, &own.y_name));
    }
    for (group, members) in known {
        let differs = |(member, name): &(usize, &str)| {
            members.iter().any(|(other, own)| (other == member) != (own == name))
        };
        if members.iter().any(differs) {
            let fault = fault!(
                BAD_OPTION,
                "the covariance `{group}` is one of different outputs in different experiments";
                help: "name its `outputs`, in the same order everywhere"
            );
            return Err(fault.at(place()));
        }
        let own = || {
            series.iter().filter(|own| own.joint.as_ref().is_some_and(|joint| joint.group == group))
        };
        if own().any(|own| !own.sigma.is_estimated()) {
            continue;
        }
        let size = 1 + members.iter().map(|own| own.0).max().unwrap_or(0);
        let first = own().filter(|own| own.joint.as_ref().is_some_and(|joint| joint.member == 0));
        let is_complete = |experiment: &str, row: &usize| {
            let all = own().filter(|own| own.experiment == experiment);
            all.filter(|own| own.rows.contains(row)).count() == size
        };
        let complete: usize = first
            .map(|first| {
                first.rows.iter().filter(|row| is_complete(&first.experiment, row)).count()
            })
            .sum();
        if complete < size + MORE {
            let fault = fault!(
                BAD_OPTION,
                "the covariance of {size} outputs cannot be estimated from {complete} complete rows";
                help: "give it as a matrix, or share one `group` among experiments"
            );
            return Err(fault.at(place()));
        }
    }
    Ok(())
}
