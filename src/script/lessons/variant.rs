//! A script with other values of some of its variables: the same idea, other numbers.

use crate::source::SourceId;
use crate::syntax::ast::{InteractiveKind, Script, StatementKind};
use crate::syntax::parse_script;

/// The text of a script in which the first assignment at the top level to `name` assigns `value`
/// instead; `None` where there is no such assignment, or the text is not a script.
pub(crate) fn assigned(text: &str, name: &str, value: &str) -> Option<String> {
    let script = parse_script(SourceId::NONE, text).ok()?;
    let (start, end) = first_value(&script, name)?;
    Some(format!("{}{value}{}", text.get(..start)?, text.get(end..)?))
}

/// Where the value of the first assignment to a variable is written.
fn first_value(script: &Script, name: &str) -> Option<(usize, usize)> {
    script.statements.iter().find_map(|statement| {
        let InteractiveKind::Statement(statement) = &statement.kind else { return None };
        let StatementKind::Assign { target, value } = &statement.kind else { return None };
        let is_meant = target.as_ident().is_some_and(|ident| ident.as_str() == name);
        is_meant.then_some((value.span.start as usize, value.span.end as usize))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_assignment_gets_another_value() {
        let text = "// F_Mut := 7\r\nF_Mut := 0.25; // here\r\nfor k in 1:2 loop\r\n  \
                    F_Mut := 1;\r\nend for\r\nF_Mut := 2;\r\n";
        let changed = assigned(text, "F_Mut", "{1, 2}").unwrap();
        assert_eq!(changed, text.replacen("0.25", "{1, 2}", 1));
        assert_eq!(assigned(text, "Seed", "1"), None);
    }
}
