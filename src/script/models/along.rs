//! Expressions in variables of a simulation, at every point in time.

use super::places::placed;
use crate::Session;
use crate::builtins::Failure;
use crate::diag::{At, Fault};
use crate::errors::BAD_ARGUMENT;
use crate::eval::{self, Scope};
use crate::fault;
use crate::name::Ident;
use crate::results::ResultTable;
use crate::source::SourceId;
use crate::syntax::ast::{ComponentReference, ExpressionKind, ReferencePart};
use crate::syntax::visit::Rewrite;
use crate::syntax::{self, print};
use crate::value::Value;
use indexmap::IndexMap;

impl Session {
    /// The values of an expression at the time points of a table; `M[end].x` and `x` are both
    /// the variable `x`.
    pub(crate) fn along(&mut self, text: &str, table: &ResultTable) -> Result<Vec<f64>, Failure> {
        let mut expression = syntax::parse_expression(SourceId::NONE, text)?;
        if let ExpressionKind::Call { function, arguments } = &expression.kind
            && function.as_ident().is_some_and(|name| name == "apply")
            && let [only] = arguments.positional.as_slice()
        {
            expression = only.clone();
        }
        let mut columns = Columns { table, found: IndexMap::new() };
        columns.expression(&mut expression);
        let call = self.call_site();
        let mut values = Vec::with_capacity(table.time.len());
        for at in 0..table.time.len() {
            let mut scope = Scope::script();
            for (name, column) in &columns.found {
                scope.set(*name, Value::Real(column[at])).at(call)?;
            }
            let value = eval::evaluate(&expression, &mut scope, self)
                .map_err(|error| placed(error, call))?;
            values.push(value.as_real().ok_or_else(|| no_number(text, &value))?);
        }
        Ok(values)
    }
}

fn no_number(text: &str, value: &Value) -> Fault {
    fault!(BAD_ARGUMENT, "`{text}` is a {}, not a number", value.type_name())
}

/// Makes every variable of the table that an expression names a simple name.
struct Columns<'t> {
    table: &'t ResultTable,
    found: IndexMap<Ident, Vec<f64>>,
}

impl Rewrite for Columns<'_> {
    fn reference(&mut self, reference: &mut ComponentReference) {
        let written = print::reference(reference);
        let name = written.split_once("[end].").map_or(written.as_str(), |(_, name)| name);
        let Ok(column) = self.table.column(name) else { return };
        let ident = Ident::new(name);
        reference.parts = vec![ReferencePart { name: ident, subscripts: Vec::new() }];
        self.found.insert(ident, column);
    }
}
