//! Standard deviations that are formulas of variables and parameters, such as `a + b*abs(y)`: they
//! become variables of the class around the model. Parameters of the problem that the model does not
//! have are declared there; so are those that only expressions in `set` and `start` contain.

use super::enclosing_class::{
    EnclosingClass, QuotedNames, References, deviation_of, expression, literal, own_name, reference,
};
use super::file::{ExperimentEntry, ProblemFile, Role, SigmaEntry, ValueEntry};
use super::sigma;
use crate::diag::{At as _, Diagnostic, suggest};
use crate::fault;
use crate::flatten::FlatModel;
use crate::mat::MatFile;
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::syntax::ast::{Expression, ExpressionKind};
use crate::syntax::print;
use crate::syntax::visit::{Rewrite, rewrite_expression};
use std::fmt::Write;

/// A formula for the deviation of an output.
pub(super) struct Formula {
    y_name: String,
    tree: Expression,
    place: Span,
}

/// What the class around the model calls a parameter that the model does not have.
pub(super) fn parameter(name: &str) -> String {
    own_name("parameter of the problem", name)
}

/// The formulas of an experiment that contain more than their output.
///
/// # Errors
///
/// Formulas that are no expressions, and those of delayed outputs, at their places.
pub(super) fn formulas(
    entry: &ExperimentEntry,
    table: &MatFile,
) -> Result<Vec<Formula>, Diagnostic> {
    let mut found: Vec<Formula> = Vec::new();
    for (y_name, column) in entry.all_outputs() {
        let Some(SigmaEntry::Words(text)) = &column.sigma else { continue };
        let is_known = found.iter().any(|own| own.y_name == *y_name);
        if is_known || sigma::is_of_output(text, y_name) || table.column(text).is_ok() {
            continue;
        }
        let way = ["outputs", y_name, "sigma"];
        let place = entry.places.at(&way);
        let Ok(mut tree) = expression(text, entry.places.text(&way)) else {
            return Err(sigma::neither(y_name, text).at(place));
        };
        let mut names = References(Vec::new());
        names.expression(&mut tree);
        if names.0.is_empty() {
            continue;
        }
        if column.delay.is_some() {
            let fault = fault!(
                BAD_OPTION,
                "the sigma of `{y_name}` is a formula, and the output is delayed, which is not supported"
            );
            return Err(fault.help("make the delayed output a variable of the model").at(place));
        }
        OwnOutput(y_name).expression(&mut tree);
        found.push(Formula { y_name: y_name.clone(), tree, place });
    }
    Ok(found)
}

/// The parameters of the problem that formulas and values of any of its experiments contain.
pub(super) fn parameters_of(file: &ProblemFile) -> Vec<String> {
    let mut names = References(Vec::new());
    file.experiment.iter().for_each(|entry| names.0.extend(names_in_values(entry, file)));
    let outputs = file.experiment.iter().flat_map(|entry| entry.all_outputs());
    for (y_name, column) in outputs {
        let Some(SigmaEntry::Words(text)) = &column.sigma else { continue };
        if !sigma::is_of_output(text, y_name)
            && let Ok(mut tree) = expression(text, None)
        {
            names.expression(&mut tree);
        }
    }
    names.0.retain(|name| file.parameters.contains_key(name));
    add_tied(&mut names.0, file, |_| true);
    names.0
}

/// The parameters of the problem in the values of `set` and `start`.
fn names_in_values(entry: &ExperimentEntry, file: &ProblemFile) -> Vec<String> {
    let values = entry.set.values.values().chain(entry.start.values());
    let mut names = References(Vec::new());
    values
        .filter_map(|own| value_expression(own, file))
        .for_each(|mut own| names.expression(&mut own));
    names.0
}

/// What a string of names that `[parameters]` lists is: an expression of these parameters; another one is a
/// String or a literal.
pub(super) fn value_expression(value: &ValueEntry, file: &ProblemFile) -> Option<Expression> {
    let ValueEntry::Text(text) = value else { return None };
    let mut read = expression(text, None).ok()?;
    QuotedNames.expression(&mut read);
    let mut names = References(Vec::new());
    names.expression(&mut read);
    let is_listed = |own: &String| file.parameters.contains_key(own);
    (!names.0.is_empty() && names.0.iter().all(is_listed)).then_some(read)
}

/// The first name in a string that `[parameters]` does not list; `None` where it is not an expression with
/// names.
pub(super) fn unknown_in(text: &str, file: &ProblemFile) -> Option<String> {
    let mut read = expression(text, None).ok()?;
    QuotedNames.expression(&mut read);
    let mut names = References(Vec::new());
    names.expression(&mut read);
    names.0.into_iter().find(|own| !file.parameters.contains_key(own))
}

/// Adds the parameters of the problem that those among these depend on that are tied.
fn add_tied(names: &mut Vec<String>, file: &ProblemFile, is_meant: impl Fn(&str) -> bool) {
    let mut next = 0;
    while let Some(name) = names.get(next) {
        next += 1;
        let text = file.parameters.get(name).and_then(|own| own.tied.as_deref());
        let Some(Ok(mut tree)) = text.map(|text| expression(text, None)) else { continue };
        let mut found = References(Vec::new());
        found.expression(&mut tree);
        for name in found.0 {
            let is_new = file.parameters.contains_key(&name) && !names.contains(&name);
            if is_new && is_meant(&name) {
                names.push(name);
            }
        }
    }
}

/// `y` in a formula is its output.
struct OwnOutput<'a>(&'a str);

impl Rewrite for OwnOutput<'_> {
    fn expression(&mut self, e: &mut Expression) {
        if matches!(e.kind, ExpressionKind::Reference(_)) && print::expression(e) == "y" {
            e.kind = reference(self.0, e.span).kind;
        }
        rewrite_expression(self, e);
    }
}

/// Parameters get the names that they have in the class.
pub(super) struct Renamed<'a>(pub(super) &'a [String]);

impl Rewrite for Renamed<'_> {
    fn expression(&mut self, e: &mut Expression) {
        let written = print::expression(e);
        if matches!(e.kind, ExpressionKind::Reference(_)) && self.0.contains(&written) {
            e.kind = reference(&parameter(&written), e.span).kind;
        }
        rewrite_expression(self, e);
    }
}

/// Declares the deviations in the class around the model; returns the names of the parameters that only
/// they and values of the experiment have. `types`: the model, which is needed where there are such.
///
/// # Errors
///
/// Names that neither the model nor the problem has.
pub(super) fn declare(
    formulas: Vec<Formula>,
    (file, entry): (&ProblemFile, &ExperimentEntry),
    types: Option<&FlatModel>,
    enclosing: &mut EnclosingClass,
) -> Result<Vec<String>, Diagnostic> {
    let Some(flat) = types else { return Ok(Vec::new()) };
    let mut own: Vec<String> = names_in_values(entry, file);
    own.retain(|name| !is_of_model(name, flat));
    for formula in &formulas {
        let mut names = References(Vec::new());
        names.expression(&mut formula.tree.clone());
        for name in names.0 {
            if is_of_model(&name, flat) || own.contains(&name) {
                continue;
            }
            if !file.parameters.contains_key(&name) {
                return Err(unknown(&name, formula, (file, flat)));
            }
            own.push(name);
        }
    }
    add_tied(&mut own, file, |name| !is_of_model(name, flat));
    for mut formula in formulas {
        // A variable alone keeps its unit, which is compared.
        let is_reference = matches!(formula.tree.kind, ExpressionKind::Reference(_));
        if is_reference && flat.variables.contains_key(&*print::expression(&formula.tree)) {
            continue;
        }
        Renamed(&own).expression(&mut formula.tree);
        let (name, text) = (deviation_of(&formula.y_name), print::expression(&formula.tree));
        // Writing into a String cannot fail.
        _ = writeln!(enclosing.declarations, "  Real {name} = {text};");
        enclosing.elements.push((name, format!("the standard deviation of {}", formula.y_name)));
    }
    Ok(own)
}

/// Whether the model has a variable, or what an element belongs to.
pub(super) fn is_of_model(name: &str, flat: &FlatModel) -> bool {
    let base = name.split('[').next().unwrap_or(name);
    name == "time"
        || flat.variables.contains_key(name)
        || flat.variables.keys().any(|own| own.split('[').next() == Some(base))
}

fn unknown(name: &str, formula: &Formula, (file, flat): (&ProblemFile, &FlatModel)) -> Diagnostic {
    let known = flat.variables.keys().map(|own| &**own);
    let known = known.chain(file.parameters.keys().map(String::as_str));
    let near = suggest::nearest(name, known);
    let fault = fault!(
        BAD_OPTION,
        "the sigma of `{}` contains `{name}`, which is neither a column of the data, nor a variable \
         of the model, nor a parameter of the problem",
        formula.y_name
    );
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => {
            format!("give it a range in `[parameters]`, as `{name} = {{ min = 0.1, max = 10 }}`")
        }
    };
    fault.help(help).at(formula.place)
}

/// Declares a parameter that the model does not have in the class around it; its name there.
///
/// # Errors
///
/// Values that are no numbers or expressions.
pub(super) fn declare_parameter(
    (name, role): (&str, &Role),
    (file, own): (&ProblemFile, &[String]),
    enclosing: &mut EnclosingClass,
) -> Result<String, Diagnostic> {
    let place = file.context.places.parameter(name);
    let value = match role {
        Role::Free { range: [low, high], .. } => format!("{:e}", 0.5 * (low + high)),
        Role::Fixed(value) => print::expression(&literal(value, name, place).at(place)?),
        Role::Tied(text) => {
            let read = expression(text, file.context.places.text(&["parameters", name, "tied"]));
            let mut tree = read.map_err(|error| error.or_at(place))?;
            Renamed(own).expression(&mut tree);
            print::expression(&tree)
        }
    };
    let own = parameter(name);
    _ = writeln!(enclosing.declarations, "  parameter Real {own} = {value};");
    enclosing.elements.push((own.clone(), format!("the parameter {name} of the problem")));
    Ok(own)
}
