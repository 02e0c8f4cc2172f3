//! Figures.

use gapilib::internals::plot::{self, Axis, Comparison, Figure, Mark, Panel, Picture, Series};
use proptest::prelude::*;
use resvg::tiny_skia::Pixmap;
use std::path::Path;

fn polarization() -> Figure {
    let x: Vec<f64> = (0..18).map(|i| 0.002 + 0.085 * f64::from(i)).collect();
    let voltage = |i: &f64| 0.86 - 0.02 * (i / 0.002).ln() - 0.12 * i + 0.05 * (1.0 - i / 1.6).ln();
    let simulated: Vec<f64> = x.iter().map(voltage).collect();
    let fine_x: Vec<f64> = (0..200).map(|k| 0.002 + 1.445 * f64::from(k) / 199.0).collect();
    let fine_y: Vec<f64> = fine_x.iter().map(voltage).collect();
    let noise = |(k, v): (usize, &f64)| v + 0.003 * ((7 * k) as f64).sin();
    let measured: Vec<f64> = simulated.iter().enumerate().map(noise).collect();
    plot::fit(Comparison {
        title: "Polarization curve, 20 °C & 50 % humidity",
        x_axis: Axis::linear("current density", "A/cm2"),
        y_axis: Axis::linear("cell voltage", "V"),
        x: &x,
        measured: &measured,
        simulated: &simulated,
        curve: (&fine_x, &fine_y),
    })
}

fn convergence() -> Figure {
    let best: Vec<f64> = (0..5000).map(|g| 2.5e-5 + 0.02 / f64::from(1 + g / 40)).collect();
    let mean: Vec<f64> = (0..5000)
        .map(|g| {
            if g % 97 == 0 {
                1e58
            } else {
                0.01 + 0.3 / f64::from(1 + g) + 0.004 * f64::from(g % 7)
            }
        })
        .collect();
    plot::convergence("Convergence", &best, &mean)
}

/// Set GAPI_FIGURES to a folder to look at the figures.
#[test]
fn ready_figures_are_drawn_the_same_each_time() {
    for (name, make) in [("fit", polarization as fn() -> Figure), ("convergence", convergence)] {
        for (ending, format) in
            [("svg", Picture::Svg), ("png", Picture::Png), ("pdf", Picture::Pdf)]
        {
            let bytes = make().picture(format).unwrap();
            assert!(bytes == make().picture(format).unwrap(), "{name}.{ending}");
            if let Ok(folder) = std::env::var("GAPI_FIGURES") {
                std::fs::write(format!("{folder}/{name}.{ending}"), &bytes).unwrap();
            }
        }
    }
}

#[test]
fn the_ending_of_the_name_says_the_format() {
    let of = |name: &str| Picture::of(Path::new(name));
    assert_eq!(of("a.b/q.SVG").unwrap(), Picture::Svg);
    assert_eq!(of("q.png").unwrap(), Picture::Png);
    assert_eq!(of("q.pdf").unwrap(), Picture::Pdf);
    for name in ["q.jpg", "q", "svg", ".png"] {
        let message = of(name).unwrap_err().message;
        assert!(message.contains("`.svg`, `.png` or `.pdf`"), "{message}");
    }
}

/// Darkness between two places, in pixels of the figure.
fn dark(picture: &Pixmap, [x1, y1, x2, y2]: [u32; 4]) -> usize {
    let all = (2 * y1..2 * y2).flat_map(|y| (2 * x1..2 * x2).map(move |x| (x, y)));
    all.filter(|(x, y)| picture.pixel(*x, *y).unwrap().red() < 128).count()
}

#[test]
fn a_png_shows_lines_and_letters() {
    let figure = polarization();
    let picture = Pixmap::decode_png(&figure.picture(Picture::Png).unwrap()).unwrap();
    let svg = figure.svg();
    let height = svg.split("height=\"").nth(1).and_then(|rest| rest.split('"').next());
    let height: u32 = height.unwrap().parse().unwrap();
    assert_eq!((picture.width(), picture.height()), (1280, 2 * height));
    // The title, and the label of the vertical axis, which stands upright.
    assert!(dark(&picture, [100, 12, 600, 32]) > 500);
    assert!(dark(&picture, [8, 100, 22, 300]) > 300);
    assert_eq!(dark(&picture, [0, 0, 6, height]), 0, "a margin is empty");
    let mut untitled = polarization();
    untitled.title = String::new();
    let picture = Pixmap::decode_png(&untitled.picture(Picture::Png).unwrap()).unwrap();
    assert_eq!(dark(&picture, [0, 0, 640, 8]), 0);
}

#[test]
fn a_pdf_is_drawn_without_a_font_of_the_machine() {
    let bytes = polarization().picture(Picture::Pdf).unwrap();
    assert!(bytes.starts_with(b"%PDF-") && bytes.trim_ascii_end().ends_with(b"%%EOF"));
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("/MediaBox") && !text.contains("/FontFile"), "{} bytes", bytes.len());
}

#[test]
fn fit_has_a_circle_per_measurement_and_a_stem_per_residual() {
    let svg = polarization().svg();
    assert_eq!(svg.matches("fill=\"#ffffff\" stroke=\"#000000\"").count(), 18 + 1);
    assert_eq!(svg.matches("r=\"2.6\"").count(), 18);
    assert!(svg.contains("cell voltage (V)") && svg.contains("current density (A/cm²)"));
    assert!(svg.contains("20 °C &amp; 50 % humidity"));
}

#[test]
fn residuals_are_measured_less_simulated_in_the_order_of_x() {
    let figure = plot::fit(Comparison {
        title: "",
        x_axis: Axis::linear("x", ""),
        y_axis: Axis::linear("y", ""),
        x: &[2.0, 1.0],
        measured: &[5.0, 3.0],
        simulated: &[4.0, 3.5],
        curve: (&[], &[]),
    });
    assert_eq!(figure.panels[1].series[0].x, [1.0, 2.0]);
    assert_eq!(figure.panels[1].series[0].y, [-0.5, 1.0]);
}

#[test]
fn failed_generations_are_left_out() {
    let figure = plot::convergence("", &[1.0, 0.5], &[1e58, 2.0]);
    let mean = &figure.panels[0].series[0];
    assert!(mean.y[0].is_nan());
    assert_eq!(mean.y[1], 2.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_data_give_finite_coordinates(
        x in proptest::collection::vec(any::<f64>(), 0..6),
        y in proptest::collection::vec(any::<f64>(), 6),
        log_x in any::<bool>(),
        log_y in any::<bool>(),
        title in "[ -M<>&\"é]{0,12}",
    ) {
        let axis = |log| if log { Axis::logarithmic("a", "b") } else { Axis::linear("a", "b") };
        let marks = [
            Mark::Line, Mark::Thin, Mark::Points, Mark::Stems, Mark::Dashed, Mark::Dots,
            Mark::Crosses, Mark::Area,
        ];
        let series = marks.map(|mark| Series {
            name: title.clone(), x: x.clone(), y: y[..x.len()].to_vec(), mark, colour: 9,
        });
        let panel = Panel { x: axis(log_x), y: axis(log_y), height: 100.0, zero_line: true, series: series.to_vec() };
        let figure = Figure { title, panels: vec![panel] };
        for svg in [figure.svg(), figure.inline("what it shows"), figure.small("the same")] {
            prop_assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", svg);
            prop_assert!(svg.len() < 60_000);
        }
        prop_assert!(figure.picture(Picture::Pdf).is_ok());
    }
}
