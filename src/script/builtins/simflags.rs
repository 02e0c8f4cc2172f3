//! The flags that OpenModelica's simulation programs take (`simflags`): those that act, those that
//! are refused because results would differ without them, and the rest, which have no effect.

use crate::Session;
use crate::bail;
use crate::diag::Fault;
use crate::errors::{BAD_ARGUMENT, NO_WINDOW, UNKNOWN_PARAMETER};
use crate::fault;
use crate::models::simulation::SimulationOptions;
use std::path::Path;

/// What `simflags` asks for.
#[derive(Debug, Default, PartialEq)]
pub(super) struct SimulationFlags {
    overrides: Vec<(String, String)>,
    /// Those of files: names that the model does not have are left out, with a warning.
    of_files: Vec<(String, String)>,
    /// `-overrideFile`: files with lines `name=value`.
    override_files: Vec<String>,
    /// `-csvInput`: the file whose columns the inputs follow.
    pub(crate) csv_input: Option<String>,
    /// The ending of the result file.
    pub format: Option<String>,
    /// Which variables are stored, as a regular expression.
    pub filter: Option<String>,
    start: Option<f64>,
    stop: Option<f64>,
    step: Option<f64>,
    tolerance: Option<f64>,
    method: Option<String>,
    /// `-r`: the file for the results.
    result: Option<String>,
    /// `-f`: the init file, of which the values are known that scripts wrote into it.
    pub(crate) init_file: Option<String>,
    idle: Vec<String>,
}

/// Flags that stand for what is not done, with what to do instead.
const REFUSED: &[(&str, &str)] = &[
    ("exInputFile", "write the inputs to a table in CSV and give it with `-csvInput`"),
    ("iif", "start values cannot be read from a file: use `importInitialResult`"),
    ("iim", "there is only one initialization method"),
    ("iit", "start values cannot be read from a file: use `importInitialResult`"),
    ("l", "use `linearize`"),
    ("steadyState", "simulate longer instead"),
];

impl SimulationFlags {
    /// Reads flags as `-name`, `-name=value` and `-name value`.
    pub(super) fn parse(text: &str) -> Result<SimulationFlags, Fault> {
        SimulationFlags::of_words(unquoted_words(text).iter().map(String::as_str))
    }

    /// The same from separate words.
    pub(super) fn of_words<'w>(
        words: impl Iterator<Item = &'w str>,
    ) -> Result<SimulationFlags, Fault> {
        match SimulationFlags::read(words) {
            (flags, None) => Ok(flags),
            (_, Some(fault)) => Err(fault),
        }
    }

    /// What can be read of flags, and what is wrong with the first of the others.
    fn read<'w>(words: impl Iterator<Item = &'w str>) -> (SimulationFlags, Option<Fault>) {
        let (mut flags, mut wrong) = (SimulationFlags::default(), None);
        let mut words = words.peekable();
        while let Some(word) = words.next() {
            let taken = match word.strip_prefix('-').map(|flag| (flag, flag.split_once('='))) {
                None => Err(fault!(
                    BAD_ARGUMENT,
                    "`{word}` in `simflags` is not a flag: flags start with `-`"
                )),
                Some((_, Some((name, value)))) => flags.take(name, value.to_owned()),
                Some((name, None)) => {
                    let next = words.next_if(|next| !next.starts_with('-'));
                    flags.take(name, next.unwrap_or("").to_owned())
                }
            };
            wrong = wrong.or(taken.err());
        }
        (flags, wrong)
    }

    fn take(&mut self, name: &str, value: String) -> Result<(), Fault> {
        if let Some((_, instead)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
            bail!(BAD_ARGUMENT, "`-{name}` in `simflags` is not supported: {instead}")
        }
        match name {
            "override" => {
                let set = settings(&value).into_iter().map(|setting| self.set(&setting));
                // All that can be read, whatever is wrong with one of them.
                set.collect::<Vec<_>>().into_iter().collect::<Result<(), Fault>>()?;
            }
            "overrideFile" => self.override_files.push(value),
            "csvInput" => self.csv_input = Some(value),
            "startTime" | "stopTime" | "stepSize" | "tolerance" => {
                self.set(&format!("{name}={value}"))?;
            }
            "s" => self.method = Some(value),
            "r" => self.result = Some(value),
            "f" => self.init_file = Some(value),
            _ => self.idle.push(format!("-{name}")),
        }
        Ok(())
    }

    /// `name=value`, of the experiment or the model.
    fn set(&mut self, setting: &str) -> Result<(), Fault> {
        let parsed = setting.split_once('=').map(|(name, value)| (name.trim(), value.trim()));
        let Some((name, value)) =
            parsed.filter(|(name, value)| !name.is_empty() && !value.is_empty())
        else {
            bail!(BAD_ARGUMENT, "`{setting}` in `simflags` is not `name=value`")
        };
        let number = || {
            let not_a_number = |_| {
                fault!(BAD_ARGUMENT, "`{name}` in `simflags` is `{value}`, which is not a number")
            };
            value.parse().map_err(not_a_number).map(Some)
        };
        match name {
            "startTime" => self.start = number()?,
            "stopTime" => self.stop = number()?,
            "stepSize" => {
                self.step = number()?;
                if let Some(step) = self.step.filter(|step| !(*step > 0.0 && step.is_finite())) {
                    bail!(BAD_ARGUMENT, "`stepSize` in `simflags` is {step}; it must be positive and finite";
                        help: "give the length of an output interval in seconds");
                }
            }
            "tolerance" => self.tolerance = number()?,
            "solver" => self.method = Some(value.to_owned()),
            "outputFormat" => self.format = Some(value.to_owned()),
            "variableFilter" => self.filter = Some(value.to_owned()),
            _ => self.overrides.push((name.to_owned(), value.to_owned())),
        }
        Ok(())
    }

    /// Takes the lines of the files that `-overrideFile` names. What `-override` gives comes later.
    pub(super) fn read_override_files(&mut self, session: &Session) -> Result<(), Fault> {
        for file in std::mem::take(&mut self.override_files) {
            let text = session.world.read_text(Path::new(&file))?;
            let own = std::mem::take(self);
            let lines = text.lines().map(str::trim);
            let is_setting =
                |line: &&str| !line.is_empty() && !line.starts_with('#') && !line.starts_with("//");
            for line in lines.filter(is_setting) {
                self.set(line)?;
            }
            self.of_files.append(&mut self.overrides);
            self.put_before(own);
        }
        Ok(())
    }

    /// The file that they name for the results, or else the usual one with the ending that they name.
    pub(super) fn result_file(&self, usual: &str) -> String {
        match (&self.result, &self.format) {
            (Some(file), _) => file.clone(),
            (None, Some(format)) => {
                let stem = usual.rsplit_once('.').map_or(usual, |(stem, _)| stem);
                format!("{stem}.{format}")
            }
            (None, None) => usual.to_owned(),
        }
    }

    /// These flags, with others that come later.
    fn put_before(&mut self, later: SimulationFlags) {
        let before = std::mem::replace(self, later);
        self.of_files.splice(0..0, before.of_files);
        self.start = self.start.or(before.start);
        self.stop = self.stop.or(before.stop);
        self.step = self.step.or(before.step);
        self.tolerance = self.tolerance.or(before.tolerance);
        self.method = self.method.take().or(before.method);
        self.format = self.format.take().or(before.format);
        self.filter = self.filter.take().or(before.filter);
    }

    /// Values that come before those of `-override`.
    pub(super) fn preset(&mut self, values: &[(String, String)]) {
        self.overrides.splice(0..0, values.iter().cloned());
    }

    /// The values that they give, by name; later ones count.
    pub(super) fn values(&self) -> impl Iterator<Item = (&str, &str)> {
        let all = self.of_files.iter().chain(&self.overrides);
        all.map(|(name, value)| (name.as_str(), value.as_str()))
    }

    /// Sets the values of the model, and says which flags have no effect.
    pub(super) fn apply(&self, session: &mut Session) -> Result<(), Fault> {
        if !self.idle.is_empty() {
            let flags = self.idle.join("`, `");
            session.note(NO_WINDOW, format!("`{flags}` in `simflags` has no effect here"));
        }
        for (name, value) in &self.of_files {
            match session.set_parameter_text(name, value) {
                // One file serves several versions of a library: OpenModelica leaves such lines out, too.
                Err(mut fault) if fault.code == UNKNOWN_PARAMETER => {
                    fault.message.push_str("; its line in the file is left out");
                    let warning = fault.at(session.call_site()).warning();
                    session.report(warning);
                }
                set => set?,
            }
        }
        let mut overrides = self.overrides.iter();
        overrides.try_for_each(|(name, value)| session.set_parameter_text(name, value))
    }

    /// The settings of a simulation, complete, with those of the flags. The length of the output
    /// intervals stays unless it is given.
    pub(super) fn applied_to(&self, options: SimulationOptions) -> SimulationOptions {
        let length = match (options.start, options.stop, options.intervals) {
            (Some(start), Some(stop), Some(count)) => Some((stop - start) / count as f64),
            _ => options.interval,
        };
        let moved = self.start.is_some() || self.stop.is_some() || self.step.is_some();
        SimulationOptions {
            start: self.start.or(options.start),
            stop: self.stop.or(options.stop),
            intervals: options.intervals.filter(|_| !moved),
            interval: self.step.or(length),
            tolerance: self.tolerance.or(options.tolerance),
            method: self.method.clone().or(options.method),
            ..options
        }
    }
}

/// The result file that flags name, whatever is wrong with others, or else the usual one.
pub(super) fn result_file(session: &Session, flags: &str, usual: &str) -> String {
    result_file_of(session, &unquoted_words(flags), usual)
}

/// The same from separate words.
pub(super) fn result_file_of(session: &Session, words: &[String], usual: &str) -> String {
    let (mut flags, _) = SimulationFlags::read(words.iter().map(String::as_str));
    // What is wrong with these files is reported where they are used.
    let _ = flags.read_override_files(session);
    flags.result_file(usual)
}

/// The words of a text; quotes keep blanks together and are taken away.
pub(super) fn unquoted_words(text: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), String::new(), None);
    for c in text.chars() {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), close) if open == close => quote = None,
            (None, blank) if blank.is_whitespace() => words.push(std::mem::take(&mut word)),
            (_, c) => word.push(c),
        }
    }
    words.push(word);
    words.retain(|word| !word.is_empty());
    words
}

/// The settings between commas, those within brackets aside: `A[1,2]=7,k=2`.
fn settings(list: &str) -> Vec<String> {
    let (mut all, mut one, mut depth) = (Vec::new(), String::new(), 0usize);
    for c in list.chars() {
        match c {
            '[' | '(' | '{' => depth += 1,
            ']' | ')' | '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        match c {
            ',' if depth == 0 => all.push(std::mem::take(&mut one)),
            c => one.push(c),
        }
    }
    all.push(one);
    all.retain(|setting| !setting.trim().is_empty());
    all
}

#[cfg(test)]
mod tests {
    use super::SimulationFlags;
    use crate::models::simulation::SimulationOptions;

    #[test]
    fn flags_are_read_in_all_their_forms() {
        let text = "-lv=LOG_STATS -override=k=1,stopTime=2 -override b=true -s euler -r x.mat";
        let flags = SimulationFlags::parse(text).expect("flags");
        let own = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        assert_eq!(flags.overrides, [own("k", "1"), own("b", "true")]);
        assert_eq!((flags.stop, flags.method.as_deref()), (Some(2.0), Some("euler")));
        assert_eq!((flags.result.as_deref(), flags.idle), (Some("x.mat"), vec!["-lv".to_owned()]));
    }

    #[test]
    fn flags_that_would_change_results_are_refused() {
        for wrong in ["-exInputFile=u.csv", "-override=k", "-override==2", "-stopTime=soon", "k=1"]
        {
            assert!(SimulationFlags::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn settings_of_the_experiment_are_no_parameters() {
        let text = "-override=A[1,2]=7,solver=euler,outputFormat=csv,variableFilter=\".*\",f='a b'";
        let flags = SimulationFlags::parse(text).expect("flags");
        let own = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        assert_eq!(flags.overrides, [own("A[1,2]", "7"), own("f", "a b")]);
        assert_eq!(flags.method.as_deref(), Some("euler"));
        assert_eq!((flags.format.as_deref(), flags.filter.as_deref()), (Some("csv"), Some(".*")));
    }

    #[test]
    fn the_length_of_output_intervals_stays() {
        let whole = SimulationOptions {
            start: Some(0.0),
            stop: Some(1.0),
            intervals: Some(10),
            ..SimulationOptions::default()
        };
        let flags = SimulationFlags::parse("-stopTime=2").expect("flags");
        let applied = flags.applied_to(whole.clone());
        assert_eq!((applied.stop, applied.intervals), (Some(2.0), None));
        assert_eq!(applied.interval, Some(0.1));
        let none = SimulationFlags::default().applied_to(whole);
        assert_eq!(none.intervals, Some(10));
    }
}
