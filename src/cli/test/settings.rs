//! How a script is compared: options of the command line, and those that the script itself has in a line
//! such as `// gapi test: tolerance = 1e-3`.

use crate::script::language::expectation::Tolerance;
use clap::Args;

/// What the line of a script begins with that has its settings.
const MARK: &str = "// gapi test:";

/// How a script is compared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Args)]
pub(crate) struct Settings {
    /// Relative tolerance of numbers that are not integers [default: 2e-6; for embedded results 5e-3]
    #[arg(long, value_name = "T", value_parser = number)]
    pub tolerance: Option<f64>,
    /// Absolute tolerance of these numbers [default: 1e-9; for embedded results 5e-3]
    #[arg(long, value_name = "A", value_parser = number)]
    pub absolute: Option<f64>,
    /// Compare whole reports of identifications, not only their estimates
    #[arg(long)]
    pub report: bool,
    /// The script is not a test.
    #[arg(skip)]
    pub skip: bool,
}

impl Settings {
    /// The settings that a script has.
    ///
    /// # Errors
    ///
    /// A setting that does not exist, or a value that is not a number.
    pub(super) fn of_script(script: &str) -> Result<Settings, String> {
        let mut settings = Settings::default();
        for line in script.lines().filter_map(|line| line.trim().strip_prefix(MARK)) {
            line.split(',').try_for_each(|setting| settings.set(setting.trim()))?;
        }
        Ok(settings)
    }

    fn set(&mut self, setting: &str) -> Result<(), String> {
        let (name, value) = setting.split_once('=').unwrap_or((setting, ""));
        let value = value.trim();
        match (name.trim(), value) {
            ("tolerance", value) => self.tolerance = Some(number(value)?),
            ("absolute", value) => self.absolute = Some(number(value)?),
            ("report", "") => self.report = true,
            ("skip", "") => self.skip = true,
            _ => {
                return Err(format!(
                    "`{MARK} {setting}` is not a setting; write `tolerance = NUMBER`, `absolute = \
                     NUMBER`, `report` or `skip`, with commas between them"
                ));
            }
        }
        Ok(())
    }

    /// These settings, and the others where there are none.
    pub(super) fn or(self, other: Settings) -> Settings {
        Settings {
            tolerance: self.tolerance.or(other.tolerance),
            absolute: self.absolute.or(other.absolute),
            report: self.report || other.report,
            skip: self.skip || other.skip,
        }
    }

    /// The tolerance, the usual one where none is set.
    pub(super) fn tolerance_or(&self, usual: Tolerance) -> Tolerance {
        Tolerance {
            absolute: self.absolute.unwrap_or(usual.absolute),
            relative: self.tolerance.unwrap_or(usual.relative),
        }
    }
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| format!("`{text}` is not a tolerance: write a number such as 1e-6"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_of_a_script_give_way_to_those_of_the_command_line() {
        let script = "x = 1\n// gapi test: tolerance = 1e-3, report\n// gapi test:absolute=0\n";
        let own = Settings::of_script(script).expect("settings");
        let expected = Settings {
            tolerance: Some(1e-3),
            absolute: Some(0.0),
            report: true,
            ..Settings::default()
        };
        assert_eq!(own, expected);
        let asked = Settings { tolerance: Some(0.1), ..Settings::default() };
        let tolerance = asked.or(own).tolerance_or(Tolerance::TRANSCRIPT);
        assert_eq!(tolerance, Tolerance { absolute: 0.0, relative: 0.1 });
    }

    #[test]
    fn what_is_no_setting_is_an_error() {
        for wrong in ["tolerence = 1", "tolerance = -1", "tolerance", "skip = 1", ""] {
            let script = format!("// gapi test: {wrong}\n");
            assert!(Settings::of_script(&script).is_err(), "{wrong}");
        }
    }
}
