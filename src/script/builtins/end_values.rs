//! Values at the end of the last simulation, as a prompt shows them when a variable is named.

use super::{last_results, results};
use crate::Session;
use crate::value::Value;
use crate::value::show::{Style, show};

impl Session {
    /// The value that a variable has at the end of the last simulation, with its unit and the time;
    /// `None` where there is no such variable.
    pub fn shown_end_value(&mut self, name: &str) -> Option<String> {
        let file = last_results::last_results(self).ok()??;
        let table = results::table(self, &file).ok()?;
        let value = *table.column(name).ok()?.last()?;
        let end = *table.time.last()?;
        let unit = table.series.iter().find(|series| series.name == name);
        let unit = unit.map_or("", |series| series.unit.as_str());
        let number = |value: f64| show(&Value::Real(value), Style::Dymola);
        let shown = format!("{} {unit}", number(value));
        Some(format!("{} at time = {}", shown.trim_end(), number(end)))
    }
}
