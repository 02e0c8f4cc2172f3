//! The flags that OpenModelica's simulation programs take (`simflags`): those that act, those that
//! are refused because results would differ without them, and the rest, which have no effect.

use crate::bail;
use crate::diag::Fault;
use crate::script::Session;
use crate::script::errors::{BAD_ARGUMENT, NO_WINDOW};
use crate::script::models::simulation::SimulationOptions;

/// What `simflags` asks for.
#[derive(Debug, Default, PartialEq)]
pub(super) struct SimulationFlags {
    overrides: Vec<(String, f64)>,
    start: Option<f64>,
    stop: Option<f64>,
    step: Option<f64>,
    tolerance: Option<f64>,
    method: Option<String>,
    /// `-r`: the file for the results.
    pub result: Option<String>,
    /// `-f`: the init file, of which the values are known that scripts wrote into it.
    pub init_file: Option<String>,
    idle: Vec<String>,
}

/// Flags that stand for input that is not read, with what to do instead.
const REFUSED: &[(&str, &str)] = &[
    ("csvInput", "inputs cannot be read from a file: write a model that reads a table"),
    ("exInputFile", "inputs cannot be read from a file: write a model that reads a table"),
    ("overrideFile", "values cannot be read from a file: give them with `-override`"),
    ("iif", "start values cannot be read from a file: use `importInitialResult`"),
    ("iim", "there is only one initialization method"),
    ("iit", "start values cannot be read from a file: use `importInitialResult`"),
    ("l", "use `linearize`"),
    ("steadyState", "simulate longer instead"),
];

impl SimulationFlags {
    /// Reads flags as `-name`, `-name=value` and `-name value`.
    pub(super) fn parse(text: &str) -> Result<SimulationFlags, Fault> {
        SimulationFlags::of_words(text.split_whitespace())
    }

    /// The same from separate words.
    pub(super) fn of_words<'w>(
        words: impl Iterator<Item = &'w str>,
    ) -> Result<SimulationFlags, Fault> {
        let mut flags = SimulationFlags::default();
        let mut words = words.peekable();
        while let Some(word) = words.next() {
            let Some(flag) = word.strip_prefix('-') else {
                bail!(BAD_ARGUMENT, "`{word}` in `simflags` is not a flag: flags start with `-`")
            };
            let (name, value) = match flag.split_once('=') {
                Some((name, value)) => (name, value.to_owned()),
                None => (flag, words.next_if(|next| !next.starts_with('-')).unwrap_or("").into()),
            };
            flags.take(name, value)?;
        }
        Ok(flags)
    }

    fn take(&mut self, name: &str, value: String) -> Result<(), Fault> {
        if let Some((_, instead)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
            bail!(BAD_ARGUMENT, "`-{name}` in `simflags` is not supported: {instead}")
        }
        match name {
            "override" => {
                for setting in value.split(',').filter(|setting| !setting.is_empty()) {
                    self.set(setting)?;
                }
            }
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
        let parsed = setting.split_once('=').and_then(|(name, value)| {
            let value = match value.trim() {
                "true" => 1.0,
                "false" => 0.0,
                number => number.parse().ok()?,
            };
            Some((name.trim(), value))
        });
        let Some((name, value)) = parsed else {
            bail!(BAD_ARGUMENT, "`{setting}` in `simflags` is not `name=value`")
        };
        match name {
            "startTime" => self.start = Some(value),
            "stopTime" => self.stop = Some(value),
            "stepSize" => self.step = Some(value),
            "tolerance" => self.tolerance = Some(value),
            _ => self.overrides.push((name.to_owned(), value)),
        }
        Ok(())
    }

    /// Values that come before those of `-override`.
    pub(super) fn preset(&mut self, values: &[(String, f64)]) {
        self.overrides.splice(0..0, values.iter().cloned());
    }

    /// Sets the values of the model, and says which flags have no effect.
    pub(super) fn apply(&self, session: &mut Session) -> Result<(), Fault> {
        if !self.idle.is_empty() {
            let flags = self.idle.join("`, `");
            session.note(NO_WINDOW, format!("`{flags}` in `simflags` has no effect here"));
        }
        self.overrides.iter().try_for_each(|(name, value)| session.set_parameter(name, *value))
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

#[cfg(test)]
mod tests {
    use super::SimulationFlags;
    use crate::script::models::simulation::SimulationOptions;

    #[test]
    fn flags_are_read_in_all_their_forms() {
        let text = "-lv=LOG_STATS -override=k=1,stopTime=2 -override b=true -s euler -r x.mat";
        let flags = SimulationFlags::parse(text).expect("flags");
        assert_eq!(flags.overrides, [("k".to_owned(), 1.0), ("b".to_owned(), 1.0)]);
        assert_eq!((flags.stop, flags.method.as_deref()), (Some(2.0), Some("euler")));
        assert_eq!((flags.result.as_deref(), flags.idle), (Some("x.mat"), vec!["-lv".to_owned()]));
    }

    #[test]
    fn flags_that_would_change_results_are_refused() {
        for wrong in ["-csvInput=u.csv", "-override=k", "-stopTime=soon", "k=1"] {
            assert!(SimulationFlags::parse(wrong).is_err(), "{wrong}");
        }
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
