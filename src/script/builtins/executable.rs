//! The programs that OpenModelica's `buildModel` makes of models. None is written here: a command
//! that would run one is answered by simulating the translated model.

use super::built_models::{self, Executable, init_file};
use super::openmodelica;
use super::simflags::{self, SimulationFlags, unquoted_words};
use super::{Args, Builtin, Failure, Family};
use crate::diag::{At, Diagnostic};
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::value::Value;
use crate::{Dialect, Session};
use std::path::Path;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[Builtin { header: SET_INIT_XML_START_VALUE, run: set_init_xml_start_value }],
};

/// The exit status of a simulation program that failed.
const FAILED: i32 = 255;

/// The exit status of a command that runs the program of a model that was built; `None` for any
/// other command.
pub(super) fn answered(session: &mut Session, command: &str) -> Option<i32> {
    let (words, output) = words(command)?;
    let (first, flags) = words.split_first()?;
    let name = program_name(first);
    let done = match built_models::program(session, name) {
        Some(program) => run(session, name, &program, flags),
        None => {
            let class = built_models::refused(session, name)?;
            let fault = fault!(BAD_ARGUMENT, "there is no program `{name}`: `{class}` could not be \
                                              built";
                help: "correct the error of `buildModel`");
            Err(vec![fault.at(session.call_site())])
        }
    };
    if let Some(file) = output {
        let written = session.world.write_file(Path::new(&file), b"");
        session.or_report(written);
    }
    Some(if session.or_report_all(done).is_some() { 0 } else { FAILED })
}

/// The class that a command simulates and the file that it writes, where it runs the program of a model
/// that was built.
pub(super) fn expected(session: &mut Session, command: &str) -> Option<(String, String)> {
    let (words, _) = words(command)?;
    let (first, flags) = words.split_first()?;
    let name = program_name(first);
    let (class, format, own) = match built_models::program(session, name) {
        Some(program) => (program.model.problem.clone(), program.format, program.flags),
        None => (built_models::refused(session, name)?, "mat".to_owned(), String::new()),
    };
    let mut all = unquoted_words(&own);
    all.extend_from_slice(flags);
    Some((class, simflags::result_file_of(session, &all, &format!("{name}_res.{format}"))))
}

/// The name of the program that a command line begins with.
fn program_name(word: &str) -> &str {
    let name = word.strip_prefix("./").or(word.strip_prefix(".\\")).unwrap_or(word);
    name.strip_suffix(".exe").unwrap_or(name)
}

fn run(
    session: &mut Session,
    name: &str,
    program: &Executable,
    flags: &[String],
) -> Result<(), Vec<Diagnostic>> {
    let mut all = unquoted_words(&program.flags);
    all.extend_from_slice(flags);
    let words = all.iter().map(String::as_str);
    let parsed = SimulationFlags::of_words(words).at(session.call_site());
    let mut flags = parsed.map_err(|error| vec![error])?;
    flags.init_file.get_or_insert_with(|| init_file(name));
    let file = format!("{name}_res.{}", program.format);
    let output = (file.as_str(), &program.filter);
    let model = match flags.csv_input {
        None => program.model(session)?,
        Some(_) => openmodelica::driven_model(session, &program.model.problem, &flags)?,
    };
    openmodelica::run(session, &model, &program.options, flags, output).map(|_| ())
}

/// The words of a command line and the file that its output goes to; `None` if it is more than one
/// command.
fn words(command: &str) -> Option<(Vec<String>, Option<String>)> {
    let (mut words, mut word, mut quote) = (Vec::new(), String::new(), None);
    for c in command.chars() {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), close) if open == close => quote = None,
            (None, ';' | '|' | '`' | '$' | '\n') => return None,
            (None, blank) if blank.is_whitespace() => words.push(std::mem::take(&mut word)),
            (None, '>') => words.extend([std::mem::take(&mut word), ">".to_owned()]),
            (_, c) => word.push(c),
        }
    }
    words.push(word);
    words.retain(|word| !word.is_empty());
    let redirected = words.iter().position(|word| word == ">");
    let Some(at) = redirected else {
        return (!words.iter().any(|w| w == "&&")).then_some((words, None));
    };
    let rest = words.split_off(at);
    let is_stream = |word: &&String| matches!(word.as_str(), ">" | "2" | "&1");
    let file = rest.iter().find(|word| !is_stream(word)).cloned();
    words.retain(|word| word != "2");
    (!rest.iter().any(|word| word == "&&")).then_some((words, file))
}

const SET_INIT_XML_START_VALUE: &str = r#"
function setInitXmlStartValue "Sets a parameter or a start value of a built model, in its init file or a copy of it. The file exists only inside this session, where the model's program uses it."
  input String fileName "name of the model_init.xml, or of an earlier copy";
  input String variableName;
  input String startValue;
  input String outputFile;
  output Boolean success;
end setInitXmlStartValue;
"#;

fn set_init_xml_start_value(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, name): (String, String) = (args.take("fileName")?, args.take("variableName")?);
    let (value, output): (String, String) = (args.take("startValue")?, args.take("outputFile")?);
    let Some(mut values) = built_models::init_file_values(session, &file) else {
        session.report_fault(fault!(BAD_ARGUMENT, "no built model has the init file `{file}`";
            help: "call `buildModel` first"));
        return Ok(false.into());
    };
    values.retain(|(known, _)| *known != name);
    values.push((name, value));
    built_models::keep_init_file(session, output, values);
    Ok(true.into())
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn a_command_line_is_told_apart_as_a_shell_does() {
        let command = r#"./M -override="k=1,x0=2" -r='a b.mat' > log.txt 2>&1"#;
        let (found, file) = words(command).expect("one command");
        assert_eq!(found, ["./M", "-override=k=1,x0=2", "-r=a b.mat"]);
        assert_eq!(file.as_deref(), Some("log.txt"));
        assert_eq!(words("./M; rm x"), None);
        assert_eq!(words("cd b && ./M"), None);
    }
}
