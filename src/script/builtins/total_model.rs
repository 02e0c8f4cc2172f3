//! OpenModelica's `saveTotalModel`: a model with all that it uses in one file.
//!
//! A class of a library is read when something is looked up in it. So the classes that were read once
//! the model is flattened are those that it needs; the others are left out of their packages. The
//! text is flattened again before it is written: it gives the same flat model, or no file.

use super::classes::asked;
use super::{Args, Builtin, Failure, Family};
use crate::diag::{Diagnostic, Fault};
use crate::errors::{BAD_ARGUMENT, SCRIPT_ERROR};
use crate::fault;
use crate::flatten::{self, Library};
use crate::models::simulation;
use crate::name::{Ident, Name};
use crate::syntax::ast::{
    ClassDefinition, ClassElement, ClassSpecifier, Element, ElementPrefixes, Section,
};
use crate::syntax::{self, print};
use crate::value::Value;
use crate::{Dialect, Session};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[Builtin { header: SAVE_TOTAL_MODEL, run: save_total_model }],
};

const SAVE_TOTAL_MODEL: &str = r#"
function saveTotalModel "Writes a model and everything it uses to one file."
  input String fileName;
  input TypeName className;
  input Boolean stripAnnotations = false "true is not supported: the simulation needs some annotations";
  input Boolean stripComments = false "true is not supported";
  input Boolean obfuscate = false "true is not supported";
  output Boolean success;
end saveTotalModel;
"#;

fn save_total_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, name): (String, Name) = (args.take("fileName")?, args.take("className")?);
    for option in ["stripAnnotations", "stripComments", "obfuscate"] {
        if args.take::<bool>(option)? {
            let message = format!(
                "`saveTotalModel` writes the source text unchanged: `{option} = true` is not \
                 supported"
            );
            return Err(Fault::new(BAD_ARGUMENT, message).into());
        }
    }
    if asked(session, &name).is_none() {
        return Ok(false.into());
    }
    let text = total_text(session, &file, &name);
    let Some(text) = session.or_report_all(text) else { return Ok(false.into()) };
    let written = session.world.write_file(Path::new(&file), text.as_bytes());
    Ok(session.succeeded(written))
}

fn total_text(session: &mut Session, file: &str, name: &Name) -> Result<String, Vec<Diagnostic>> {
    let original = simulation::flat_model(session, &name.to_string())?;
    let text = used_classes(session.library(), name);
    let source = session.sources.add(file, text.as_str());
    let definition = syntax::parse_stored_definition(source, &text).map_err(|error| vec![error])?;
    let mut library = Library::new();
    library.set_resources(session.resources_for(name));
    library.load(&definition).map_err(|error| vec![error])?;
    let (again, _) = flatten::flatten_unbalanced(&library, name, &[])?;
    if again.model.to_string() != original.to_string() {
        let fault = fault!(SCRIPT_ERROR, "`{name}` would be a different model when read from one \
            file";
            help: "save the model with `saveModel` and load its libraries separately");
        return Err(vec![fault.at(session.call_site())]);
    }
    Ok(text)
}

/// The top-level classes that a class uses, itself included, without what it does not use.
fn used_classes(library: &Library, name: &Name) -> String {
    let read = library.read_names();
    let mut text = String::new();
    let mut pending: Vec<Ident> = name.first().into_iter().collect();
    let mut found: BTreeSet<Ident> = pending.iter().copied().collect();
    while let Some(root) = pending.pop() {
        let Some(class) = total(library, &Name::from(root), &read) else { continue };
        let own = print::class(&class) + ";\n";
        let used = library.roots().filter(|other| mentions(&own, other.as_str()));
        pending.extend(used.filter(|other| found.insert(*other)));
        text.push_str(&own);
    }
    text
}

fn mentions(text: &str, name: &str) -> bool {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    text.split(|c| !is_word(c)).any(|word| word == name)
}

/// A class as one text, with the classes of its folder and without those that were not read.
fn total(library: &Library, name: &Name, read: &BTreeSet<Name>) -> Option<ClassDefinition> {
    let mut class = ClassDefinition::clone(&*library.definition(name)?);
    let ClassSpecifier::Long(long) = &mut class.specifier else { return Some(class) };
    let mut elsewhere: BTreeSet<Ident> = library.children(name).into_iter().collect();
    for section in &mut *long.sections {
        let Section::Elements { elements, .. } = section else { continue };
        elements.retain_mut(|element| {
            let Element::Class(nested) = element else { return true };
            let own = name.child(nested.class.name.node);
            elsewhere.remove(&nested.class.name.node);
            if !read.contains(&own) {
                return may_be_looked_up(nested);
            }
            if let Some(nested_class) = total(library, &own, read) {
                nested.class = Arc::new(nested_class);
            }
            true
        });
    }
    let in_files = library.children(name).into_iter().filter(|child| elsewhere.contains(child));
    let in_files = in_files.map(|child| name.child(child)).filter(|child| read.contains(child));
    let element = |class| {
        let prefixes = ElementPrefixes::default();
        Element::Class(ClassElement { prefixes, class: Arc::new(class), constraint: None })
    };
    let elements: Vec<Element> =
        in_files.filter_map(|child| total(library, &child, read)).map(element).collect();
    if !elements.is_empty() {
        long.sections.insert(0, Section::Elements { visibility: None, elements });
    }
    Some(class)
}

/// A class that has not been read may still be named: one that another replaces, or a short one.
fn may_be_looked_up(element: &ClassElement) -> bool {
    let is_short = !matches!(element.class.specifier, ClassSpecifier::Long(_));
    is_short || element.prefixes.replaceable || element.prefixes.redeclare
}
