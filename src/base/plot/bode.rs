//! Responses over the frequency (Bode plots).

use super::figure::{Axis, Figure, Mark, Panel, Series};

/// A response: its name, and magnitude (dB) and phase (degrees) at each frequency.
#[derive(Debug, Clone)]
pub struct Responding {
    /// In the legend; may be empty.
    pub name: String,
    /// Magnitudes in dB.
    pub magnitudes: Vec<f64>,
    /// Phases in degrees.
    pub phases: Vec<f64>,
}

/// Magnitudes above, phases below, over frequencies in Hz.
pub fn bode(frequencies: &[f64], responses: &[Responding]) -> Figure {
    let panel = |y: Axis, values: fn(&Responding) -> &Vec<f64>, has_names: bool| Panel {
        x: Axis::logarithmic("frequency", "Hz"),
        y,
        height: 180.0,
        zero_line: false,
        series: responses
            .iter()
            .enumerate()
            .map(|(place, own)| Series {
                name: if has_names { own.name.clone() } else { String::new() },
                x: frequencies.to_vec(),
                y: values(own).clone(),
                mark: Mark::Line,
                colour: place + 1,
            })
            .collect(),
    };
    Figure {
        title: String::new(),
        panels: vec![
            panel(Axis::linear("magnitude", "dB"), |own| &own.magnitudes, true),
            panel(Axis::linear("phase", "deg"), |own| &own.phases, false),
        ],
    }
}
