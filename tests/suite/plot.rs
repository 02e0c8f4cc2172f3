//! Figures.

use gapilib::plot::{self, Axis, Comparison, Figure, Mark, Panel, Series};
use proptest::prelude::*;

fn polarization() -> Figure {
    let x: Vec<f64> = (0..18).map(|i| 0.002 + 0.085 * f64::from(i)).collect();
    let voltage = |i: &f64| 0.86 - 0.02 * (i / 0.002).ln() - 0.12 * i + 0.05 * (1.0 - i / 1.6).ln();
    let simulated: Vec<f64> = x.iter().map(voltage).collect();
    let fine_x: Vec<f64> = (0..200).map(|k| 0.002 + 1.445 * f64::from(k) / 199.0).collect();
    let fine_y: Vec<f64> = fine_x.iter().map(voltage).collect();
    let noise = |(k, v): (usize, &f64)| v + 0.003 * ((7 * k) as f64).sin();
    let measured: Vec<f64> = simulated.iter().enumerate().map(noise).collect();
    plot::fit(&Comparison {
        title: "Polarization curve, 20 °C & 50 % humidity",
        x_label: ("current density", "A/cm2"),
        y_label: ("cell voltage", "V"),
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
        let svg = make().svg();
        assert_eq!(svg, make().svg());
        if let Ok(folder) = std::env::var("GAPI_FIGURES") {
            std::fs::write(format!("{folder}/{name}.svg"), &svg).unwrap();
        }
    }
}

#[test]
fn fit_has_a_circle_per_measurement_and_a_stem_per_residual() {
    let svg = polarization().svg();
    assert_eq!(svg.matches("fill=\"#ffffff\" stroke=\"#000000\"").count(), 18 + 1);
    assert_eq!(svg.matches("r=\"2.6\"").count(), 18);
    assert!(svg.contains("cell voltage [V]") && svg.contains("current density [A/cm²]"));
    assert!(svg.contains("20 °C &amp; 50 % humidity"));
}

#[test]
fn residuals_are_measured_less_simulated_in_the_order_of_x() {
    let figure = plot::fit(&Comparison {
        title: "",
        x_label: ("x", ""),
        y_label: ("y", ""),
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
        let series = [Mark::Line, Mark::Thin, Mark::Points, Mark::Stems].map(|mark| Series {
            name: title.clone(), x: x.clone(), y: y[..x.len()].to_vec(), mark, colour: 9,
        });
        let panel = Panel { x: axis(log_x), y: axis(log_y), height: 100.0, zero_line: true, series: series.to_vec() };
        let svg = Figure { title, panels: vec![panel] }.svg();
        prop_assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", svg);
        prop_assert!(svg.len() < 60_000);
    }
}
