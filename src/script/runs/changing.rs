//! Changes of a run that continues: statements are executed between two generations and checked before
//! they are accepted. A change that is refused leaves all variables as they were.

use crate::Session;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::errors::BAD_CHANGE;
use crate::fault;
use crate::ga::{self, Mrg32k3a};
use crate::name::Ident;
use crate::syntax::{self, ast::Script};
use crate::value::{Value, sizes};

/// The variables before a change, with their values.
type Values = Vec<(Ident, Value)>;

/// Parses the statements of a change.
///
/// # Errors
///
/// They are not a script.
pub(super) fn parsed(session: &mut Session, name: &str, text: &str) -> Result<Script, Diagnostic> {
    let source = session.sources.add(name, text);
    syntax::parse_script(source, text)
}

impl Session {
    /// Executes the statements of a change and checks what they have made of the variables.
    pub(super) fn change(&mut self, script: &Script, outermost: bool) -> Result<(), Diagnostic> {
        let Some(first) = script.statements.first() else { return Ok(()) };
        let before: Values =
            self.workspace.variables.iter().map(|(name, value)| (name, value.clone())).collect();
        let mut statements = script.statements.iter();
        let done = statements.try_for_each(|statement| self.top_level(statement, outermost));
        let done =
            done.and_then(|()| self.check_change(&before).map_err(|fault| fault.at(first.span)));
        if done.is_err() {
            self.restore(before);
        }
        done
    }

    /// Whether the run can continue with the variables as they are now.
    fn check_change(&self, before: &[(Ident, Value)]) -> Result<(), Fault> {
        let variables = &self.workspace.variables;
        for (name, value) in variables.iter() {
            match before.iter().find(|(known, _)| *known == name) {
                None => return Err(unknown(name, before)),
                Some((_, old)) if old == value => {}
                Some((_, old)) => check_value(name, old, value)?,
            }
        }
        let whole = |name: &str| match variables.get(Ident::new(name)) {
            Some(Value::Integer(number)) => Some(*number),
            _ => None,
        };
        let vector = |name: &str| variables.get(Ident::new(name))?.as_vector().ok();
        check_ranges(vector("Param_Min"), vector("Param_Max"))?;
        if let (Some(points), Some(genes)) = (vector("Cross_Point"), whole("N_Parameters")) {
            let points: Vec<i64> = points.iter().map(|point| *point as i64).collect();
            ga::crossover::check_points(&points, usize::try_from(genes).unwrap_or(0))?;
        }
        match ["N_Population", "N_Parents", "N_Elitism"].map(whole) {
            [Some(individuals), Some(parents), Some(elites)] => {
                ga::selection::check_sizes(individuals, parents, elites)
            }
            _ => Ok(()),
        }
    }

    fn restore(&mut self, before: Values) {
        let is_new = |name: &Ident| !before.iter().any(|(known, _)| known == name);
        let new: Vec<Ident> =
            self.workspace.variables.iter().map(|(name, _)| name).filter(is_new).collect();
        for name in new {
            self.workspace.variables.remove(name);
        }
        for (name, value) in before {
            // It had this value before, so that its declaration permits it; a loop variable cannot
            // be assigned and keeps its value.
            let _ = self.workspace.variables.set(name, value);
        }
    }
}

/// Whether each gene has a range.
fn check_ranges(least: Option<Vec<f64>>, greatest: Option<Vec<f64>>) -> Result<(), Fault> {
    let (Some(least), Some(greatest)) = (least, greatest) else { return Ok(()) };
    let empty = least.iter().zip(&greatest).position(|(least, greatest)| {
        least.partial_cmp(greatest).is_none_or(std::cmp::Ordering::is_gt)
    });
    match empty {
        Some(at) => Err(fault!(
            BAD_CHANGE,
            "the range of parameter {} would begin at {} and end at {}",
            at + 1, least[at], greatest[at];
            help: "keep `Param_Min` below `Param_Max`"
        )),
        None => Ok(()),
    }
}

/// A change that names something that the script does not have.
fn unknown(name: Ident, before: &[(Ident, Value)]) -> Fault {
    let names = before.iter().map(|(name, _)| name.as_str());
    let suggestion = suggest::did_you_mean(name.as_str(), names);
    let fault = fault!(
        BAD_CHANGE,
        "the script has no variable `{name}`, so that setting it would \
                                    change nothing"
    );
    match suggestion {
        Some(suggestion) => fault.help(suggestion),
        None => fault.help("assign a variable of the script, such as `F_Mut := 0.3`"),
    }
}

/// Whether a variable may get another value in the middle of a run.
fn check_value(name: Ident, old: &Value, new: &Value) -> Result<(), Fault> {
    if kind(old) != kind(new) || extents(old) != extents(new) {
        return Err(fault!(
            BAD_CHANGE,
            "`{name}` is {}, but the change makes it {}", described(old), described(new);
            help: "keep the type and the size of the variable"
        ));
    }
    match (name.as_str(), new) {
        ("F_Mut", _) => new.as_real().map_or(Ok(()), ga::mutation::check_factor),
        ("Seed", _) => match new.as_vector() {
            Ok(seed) => Mrg32k3a::new(&seed).map(drop),
            Err(_) => Ok(()),
        },
        ("N_Parents" | "N_Elitism", Value::Real(number)) => {
            Err(fault!(BAD_CHANGE, "`{name}` is a number of individuals, but the change makes it \
                                    {number}"; help: "use a whole number"))
        }
        ("N_Population" | "N_Parameters", _) => Err(fault!(
            BAD_CHANGE,
            "`{name}` cannot change in a run: the population has this size already";
            help: "change it in the script and run it again"
        )),
        _ => Ok(()),
    }
}

/// What kind of values it has: an Integer is as good as a Real.
fn kind(value: &Value) -> String {
    let name = match value {
        Value::Array(array) => array.elements.type_name(),
        other => other.type_name(),
    };
    if matches!(name.as_str(), "Real" | "Integer") { "number".to_owned() } else { name }
}

/// The sizes other than 1: the functions of the paper take `{1, 2}` and `[1, 2]` alike.
fn extents(value: &Value) -> Vec<usize> {
    value.dims().iter().copied().filter(|size| *size != 1).collect()
}

fn described(value: &Value) -> String {
    match value.dims() {
        [] => format!("a {}", kind(value)),
        dims => format!("an array {} of type {}", sizes(dims), kind(value)),
    }
}
