//! What a figure shows; data only.

/// A picture: panels one below the other, which share the range of their horizontal axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Above the picture; may be empty.
    pub title: String,
    /// From top to bottom.
    pub panels: Vec<Panel>,
}

impl Figure {
    /// One panel whose axes have the same scale, for curves in a plane.
    pub fn plane(x: Axis, y: Axis, mut series: Vec<Series>) -> Figure {
        /// The width of the area for data, about.
        const WIDTH: f64 = 520.0;
        const HEIGHTS: [f64; 2] = [140.0, 420.0];
        let range = |values: fn(&Series) -> &[f64]| {
            let all = series.iter().flat_map(values).filter(|value| value.is_finite());
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) = all.fold(ends, |(a, b), v| (a.min(*v), b.max(*v)));
            if low < high { [low, high] } else { [low - 0.5, low + 0.5] }
        };
        let (of_x, of_y) = (range(|own| &own.x), range(|own| &own.y));
        let [width, height] = [of_x, of_y].map(|[low, high]| high - low);
        let drawn = (WIDTH * height / width).clamp(HEIGHTS[0], HEIGHTS[1]);
        // Corners that nothing is drawn at make the ranges as long as the lengths.
        let extended = |[low, high]: [f64; 2], length: f64| {
            let more = (0.5 * (length - (high - low))).max(0.0);
            vec![low - more, high + more]
        };
        let x_corners = extended(of_x, height * WIDTH / drawn);
        let y_corners = extended(of_y, width * drawn / WIDTH);
        let name = String::new();
        series.insert(0, Series { name, x: x_corners, y: y_corners, mark: Mark::Area, colour: 0 });
        let panel = Panel { x, y, height: drawn, zero_line: true, series };
        Figure { title: String::new(), panels: vec![panel] }
    }
}

/// A pair of axes with data.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Horizontal axis; its label is shown below the last panel.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Height of the area for data, in pixels of the 640 that a figure is wide.
    pub height: f64,
    /// Whether a line marks y = 0.
    pub zero_line: bool,
    /// What is drawn, the last on top.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub label: String,
    /// Its unit as in Modelica (`A/cm2`, `m.s-2`), empty if none; exponents are raised.
    pub unit: String,
    /// How values become lengths.
    pub scale: Scale,
}

/// How values become lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    Linear,
    /// By their logarithm; values that are not positive are left out.
    Logarithmic,
}

/// Data of one kind. Points with a coordinate that is not finite are left out and interrupt a
/// line.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty to omit it there.
    pub name: String,
    /// Horizontal coordinates.
    pub x: Vec<f64>,
    /// Vertical coordinates, as many.
    pub y: Vec<f64>,
    /// How it is drawn.
    pub mark: Mark,
    /// Place in the palette, 0 is black.
    pub colour: usize,
}

/// How data are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line from point to point.
    Line,
    /// A thin, faint line from point to point, for what scatters.
    Thin,
    /// An open circle at each point.
    Points,
    /// A vertical line from zero to each point, with a dot at its end.
    Stems,
    /// A dashed line from point to point, for limits.
    Dashed,
    /// A small filled dot at each point, for clouds of thousands.
    Dots,
    /// A cross at each point.
    Crosses,
    /// The area that the points enclose, faint: a band is its lower edge and then its upper edge
    /// backwards.
    Area,
}

/// What a variable is called beside an axis: its description, up to a bracket or the end of a clause, if
/// that is short; else its name.
fn quantity<'t>(name: &'t str, description: &'t str) -> &'t str {
    /// Letters that fit beside an axis of a small figure.
    const LONGEST: usize = 28;
    let clause = description.split(['(', '[', '{', '=', ';', ':', ',']).next().unwrap_or_default();
    let clause = clause.split(". ").next().unwrap_or_default().trim().trim_end_matches('.');
    let is_short = (1..=LONGEST).contains(&clause.chars().count());
    if is_short && clause.contains(char::is_alphabetic) { clause } else { name }
}

impl Axis {
    /// The linear axis of a variable: `voltage (V)` for `v`, described as "voltage", in V.
    pub fn of_variable(name: &str, description: &str, unit: &str) -> Axis {
        Axis::linear(quantity(name, description), unit)
    }

    /// A linear axis.
    pub fn linear(label: &str, unit: &str) -> Axis {
        Axis { label: label.to_owned(), unit: unit.to_owned(), scale: Scale::Linear }
    }

    /// A logarithmic axis.
    pub fn logarithmic(label: &str, unit: &str) -> Axis {
        Axis { scale: Scale::Logarithmic, ..Axis::linear(label, unit) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_variable_is_called_by_its_description_where_that_is_short() {
        let title = |description: &str| Axis::of_variable("r.v", description, "V").title();
        assert_eq!(title("voltage"), "voltage (V)");
        assert_eq!(
            title("Voltage drop of the two pins (= p.v - n.v)"),
            "Voltage drop of the two pins (V)"
        );
        assert_eq!(title("Voltage. Measured at the terminals"), "Voltage (V)");
        assert_eq!(title(""), "r.v (V)");
        assert_eq!(title("what a voltmeter between both terminals would show"), "r.v (V)");
        assert_eq!(Axis::of_variable("i", "", "A/cm2").title(), "i (A/cm²)");
    }
}
