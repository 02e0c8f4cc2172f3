//! The enumerations of graphical annotations, which no library declares (MLS §18.6).

/// Their names and literals.
const ENUMERATIONS: [(&str, &[&str]); 8] = [
    ("LinePattern", &["None", "Solid", "Dash", "Dot", "DashDot", "DashDotDot"]),
    (
        "FillPattern",
        &[
            "None",
            "Solid",
            "Horizontal",
            "Vertical",
            "Cross",
            "Forward",
            "Backward",
            "CrossDiag",
            "HorizontalCylinder",
            "VerticalCylinder",
            "Sphere",
        ],
    ),
    ("BorderPattern", &["None", "Raised", "Sunken", "Engraved"]),
    ("Smooth", &["None", "Bezier"]),
    ("EllipseClosure", &["None", "Chord", "Radial", "Automatic"]),
    ("Arrow", &["None", "Open", "Filled", "Half"]),
    ("TextStyle", &["Bold", "Italic", "UnderLine"]),
    ("TextAlignment", &["Left", "Center", "Right"]),
];

/// The literals of an enumeration; none of another name.
pub fn literals(name: &str) -> &'static [&'static str] {
    ENUMERATIONS.iter().find(|(own, _)| *own == name).map_or(&[], |(_, literals)| literals)
}
