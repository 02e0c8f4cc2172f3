//! Plots: each command draws an SVG file into the output folder.

use super::{Args, Builtin, Failure, Family, last_results};
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::fault;
use crate::plot::{Axis, Figure, Mark, Panel, Picture, Series};
use crate::results::ResultTable;
use crate::value::{RealMatrix, Value};
use crate::{Dialect, Echo, Session};
use std::path::Path;
use std::sync::Arc;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.Plot"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: PLOT, run: plot },
        Builtin { header: CREATE_PLOT, run: create_plot },
        Builtin { header: PLOT_ARRAY, run: plot_array },
        Builtin { header: PLOT_ARRAYS, run: plot_arrays },
        Builtin { header: PLOT_SCATTER, run: plot_scatter },
        Builtin { header: PLOT_PARAMETRIC_CURVE, run: plot_parametric_curve },
        Builtin { header: PLOT_EXPRESSION, run: plot_expression },
        Builtin { header: EXPORT_PLOT_AS_IMAGE, run: export_plot_as_image },
        Builtin { header: CLEAR_PLOT, run: clear_plot },
        Builtin { header: REMOVE_PLOTS, run: remove_plots },
    ],
};

/// OpenModelica's plots.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: PLOT_OPENMODELICA, run: plot_openmodelica },
        Builtin { header: PLOT_ALL, run: plot_all },
        Builtin { header: PLOT_PARAMETRIC, run: plot_parametric },
    ],
};

/// Characters and lines of a plot at a prompt, besides its labels.
const CHART: [usize; 2] = [64, 14];

/// What was plotted so far.
#[derive(Default)]
struct Plots {
    drawn: usize,
    last_drawn: Option<Figure>,
    /// What `plotArray`, `plotArrays` and `plotScatter` draw on: drawn already when it has series.
    vectors: Option<Figure>,
}

/// The results and the variable in them that a path names: a variable of the last results, or
/// `Name[end].variable` of the last ones of a model or a result file.
pub(super) fn curve(
    session: &mut Session,
    path: &str,
) -> Result<(Arc<ResultTable>, String), Fault> {
    let last = results(session, "");
    let named = path.split_once("].").and_then(|(start, variable)| {
        let (name, number) = start.rsplit_once('[')?;
        Some((name, number, variable))
    });
    let is_of_last = last.as_ref().is_ok_and(|last| last.column(path).is_ok());
    let Some((name, number, variable)) = named.filter(|_| !is_of_last) else {
        return Ok((last?, path.to_owned()));
    };
    let Some(file) = last_results::results_of(session, name)? else {
        bail!(
            BAD_ARGUMENT,
            "`{path}`: there is no result of `{name}`";
            help: "name the model or the result file of a simulation of this script"
        )
    };
    if number != "end" {
        bail!(
            BAD_ARGUMENT,
            "`{path}`: of each result file the last content is kept";
            help: "write `{name}[end].{variable}`, and give simulations different result files"
        );
    }
    Ok((super::results::table(session, &file)?, variable.to_owned()))
}

const PLOT: &str = r#"
function plot "Plots trajectories of the last simulation over time."
  input String y[:] "variables";
  input String legend[:] = fill("", 0);
  input Boolean plotInAll = false;
  input Any colors = 0;
  input Any patterns = 0;
  input Any markers = 0;
  input Real thicknesses[:] = fill(0.0, 0);
  input Integer axes[:] = fill(0, 0);
  input Any displayUnits = fill("", 0);
  output Boolean ok;
end plot;
"#;

fn plot(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let names: Vec<String> = args.take("y")?;
    let legends: Vec<String> = args.take("legend")?;
    let drawing = Drawing { x: "time".to_owned(), names, legends, ..Drawing::default() };
    let drawn = draw_trajectories(session, drawing);
    Ok(answer(session, drawn))
}

const CREATE_PLOT: &str = r#"
function createPlot "Plots trajectories of a result file."
  input Integer id = 0;
  input Any position = {0, 0, 0, 0};
  input String x = "time";
  input String y[:] = fill("", 0) "variables";
  input String heading = "";
  input Real range[:] = {0.0, 1.0, 0.0, 1.0};
  input Boolean erase = true;
  input Boolean autoscale = true;
  input Boolean autoerase = true;
  input Boolean autoreplot = true;
  input Boolean description = false;
  input Boolean grid = false;
  input Boolean color = true;
  input Boolean online = false;
  input Boolean legend = true;
  input Real timeWindow = 0.0;
  input String filename = "" "result file; empty: that of the last simulation";
  input Integer legendLocation = 1;
  input Boolean legendHorizontal = true;
  input Boolean legendFrame = false;
  input Boolean suppressMarker = false;
  input Boolean logX = false;
  input Boolean logY = false;
  input String legends[:] = fill("", 0);
  input Integer subPlot = 1;
  input Boolean uniformScaling = false;
  input Integer leftTitleType = 1;
  input String leftTitle = "";
  input Integer bottomTitleType = 1;
  input String bottomTitle = "";
  input Any colors = 0;
  input Any patterns = 0;
  input Any markers = 0;
  input Any thicknesses = 0;
  input Any range2 = 0;
  input Boolean logY2 = false;
  input Integer rightTitleType = 1;
  input String rightTitle = "";
  input Any axes = 0;
  input String timeUnit = "s";
  input Any displayUnits = 0;
  output Integer _window;
end createPlot;
"#;

fn create_plot(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let id: i64 = args.take("id")?;
    let drawing = Drawing {
        title: args.take("heading")?,
        x: args.take("x")?,
        names: args.take("y")?,
        legends: args.take("legends")?,
        file: args.take("filename")?,
        left_title: args.take("leftTitle")?,
        bottom_title: args.take("bottomTitle")?,
        logarithmic: [args.take("logX")?, args.take("logY")?],
    };
    if drawing.names.is_empty() {
        session.extension::<Plots>().vectors = Some(drawing.empty_figure());
    } else {
        let drawn = draw_trajectories(session, drawing);
        if answer(session, drawn) != Value::Boolean(true) {
            return Ok(Value::Integer(0));
        }
    }
    Ok(Value::Integer(id.max(1)))
}

const PLOT_ARRAY: &str = r#"
function plotArray "Plots one vector over another as a line."
  input Real x[:];
  input Real y[:];
  input Integer style = 0;
  input String legend = "";
  input Integer id = 0;
  input Any color = 0;
  input Any pattern = 0;
  input Any marker = 0;
  input Real thickness = 0.25;
  input Boolean erase = true;
  input Integer axis = 1;
  input String unit = "";
  output Boolean ok;
end plotArray;
"#;

const PLOT_ARRAYS: &str = r#"
function plotArrays "Plots the columns of a matrix over a vector as lines."
  input Real x[:];
  input Real y[:, :] "one row for each element of x";
  input Integer style[:] = {0} "has no effect";
  input String legend[:] = fill("", 0) "one for each column, or none";
  input Integer id = 0 "has no effect";
  input String title = "";
  input Any colors = 0 "has no effect";
  input Any patterns = 0 "has no effect";
  input Any markers = 0 "has no effect";
  input Any thicknesses = 0 "has no effect";
  input Any axes = 0 "has no effect";
  input String units[:] = fill("", 0) "one for each column, or none";
  output Boolean ok;
end plotArrays;
"#;

const PLOT_SCATTER: &str = r#"
function plotScatter "Plots one vector over another as points."
  input Real x[:];
  input Real y[:];
  input Any colors = 0;
  input Any marker = 0;
  input String legend = "";
  input Integer axis = 1;
  input String unit = "";
  input Boolean erase = true;
  input Integer id = 0;
  output Boolean ok;
end plotScatter;
"#;

fn plot_array(session: &mut Session, args: Args) -> Result<Value, Failure> {
    draw_vectors(session, args, Mark::Line)
}

fn plot_scatter(session: &mut Session, args: Args) -> Result<Value, Failure> {
    draw_vectors(session, args, Mark::Points)
}

fn plot_arrays(session: &mut Session, args: Args) -> Result<Value, Failure> {
    let drawn = drawn_columns(session, args);
    Ok(answer(session, drawn))
}

fn drawn_columns(session: &mut Session, mut args: Args) -> Result<(), Fault> {
    let (x, y): (Vec<f64>, RealMatrix) = (args.take("x")?, args.take("y")?);
    let (legends, units): (Vec<String>, Vec<String>) = (args.take("legend")?, args.take("units")?);
    if x.len() != y.rows {
        bail!(BAD_ARGUMENT, "`x` has {} values and `y` has {} rows", x.len(), y.rows);
    }
    let of_column = |all: &[String], at: usize| all.get(at).cloned().unwrap_or_default();
    let all_units: Vec<String> = (0..y.columns).map(|at| of_column(&units, at)).collect();
    let have_one_unit = all_units.windows(2).all(|pair| pair[0] == pair[1]);
    let columns = (0..y.columns).map(|at| Series {
        name: labelled(of_column(&legends, at), &all_units[at], have_one_unit),
        x: x.clone(),
        y: (0..y.rows).map(|row| y.row(row)[at]).collect(),
        mark: Mark::Line,
        colour: at + 1,
    });
    let y_unit = all_units.first().filter(|_| have_one_unit).map_or("", String::as_str);
    let axes = [Axis::linear("", ""), Axis::linear("", y_unit)];
    let drawn = figure(args.take("title")?, axes, columns.collect());
    write(session, &drawn)?;
    session.extension::<Plots>().vectors = Some(drawn);
    Ok(())
}

/// The name of a series, with its unit where the axis has none.
fn labelled(name: String, unit: &str, have_one_unit: bool) -> String {
    match unit {
        "" => name,
        _ if have_one_unit => name,
        unit => format!("{name} [{unit}]"),
    }
}

const CLEAR_PLOT: &str = r#"
function clearPlot "Erases the curves of the diagram on which vectors are plotted; files that were written remain."
  input Integer id = 0 "has no effect: the last diagram is cleared";
  output Boolean ok;
end clearPlot;
"#;

fn clear_plot(session: &mut Session, _: Args) -> Result<Value, Failure> {
    if let Some(figure) = &mut session.extension::<Plots>().vectors {
        figure.panels.iter_mut().for_each(|panel| panel.series.clear());
    }
    Ok(true.into())
}

const REMOVE_PLOTS: &str = r#"
function removePlots "Discards the plots; files that were written remain until the next plots overwrite them."
  input Boolean closeResults = true;
  output Boolean ok;
end removePlots;
"#;

fn remove_plots(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let plots = session.extension::<Plots>();
    (plots.drawn, plots.vectors) = (0, None);
    Ok(true.into())
}

/// What `plot` and `createPlot` draw.
#[derive(Default)]
struct Drawing {
    title: String,
    x: String,
    names: Vec<String>,
    legends: Vec<String>,
    file: String,
    left_title: String,
    bottom_title: String,
    logarithmic: [bool; 2],
}

impl Drawing {
    /// The titles and axes, with nothing drawn.
    fn empty_figure(self) -> Figure {
        let axis = |label: &str, logarithmic: bool| {
            if logarithmic { Axis::logarithmic(label, "") } else { Axis::linear(label, "") }
        };
        let [log_x, log_y] = self.logarithmic;
        let axes = [axis(&self.bottom_title, log_x), axis(&self.left_title, log_y)];
        figure(self.title, axes, Vec::new())
    }
}

/// The result file that a plot takes: the one named, else that of the last simulation.
fn results(session: &mut Session, file: &str) -> Result<Arc<ResultTable>, Fault> {
    let file = match file {
        "" | "<default>" => last_results::last_results(session)?.ok_or_else(|| {
            fault!(BAD_ARGUMENT, "there is nothing to plot: no model has been simulated";
                help: "simulate first, or name a result file with `createPlot(filename=…)`")
        })?,
        named => named.to_owned(),
    };
    super::results::table(session, &file)
}

/// An axis with the script's title, or that of a variable. A title stands as it is, unless it is the
/// name.
fn axis((title, name): (&str, &str), variable: Axis, logarithmic: bool) -> Axis {
    let axis = match title {
        "" => variable,
        title if title == name => Axis::linear(title, &variable.unit),
        title => Axis::linear(title, ""),
    };
    if logarithmic { Axis::logarithmic(&axis.label, &axis.unit) } else { axis }
}

fn draw_trajectories(session: &mut Session, drawing: Drawing) -> Result<(), Fault> {
    let table = results(session, &drawing.file)?;
    let x = table.column(&drawing.x)?;
    let variable = |name: &str| {
        let known = table.series.iter().find(|series| series.name == name);
        let (description, unit) = known.map_or(("", ""), |own| (&own.description, &own.unit));
        Axis::of_variable(name, description, unit)
    };
    let units: Vec<String> = drawing.names.iter().map(|name| variable(name).unit).collect();
    let have_one_unit = units.windows(2).all(|pair| pair[0] == pair[1]);
    let mut series = Vec::with_capacity(drawing.names.len());
    for (at, name) in drawing.names.iter().enumerate() {
        let legend = drawing.legends.get(at).filter(|legend| !legend.is_empty());
        let own = || labelled(name.clone(), &units[at], have_one_unit);
        series.push(Series {
            name: legend.cloned().unwrap_or_else(own),
            x: x.clone(),
            y: table.column(name)?,
            mark: Mark::Line,
            colour: at + 1,
        });
    }
    let is_time = drawing.x.eq_ignore_ascii_case("time");
    let x_axis = if is_time { Axis::linear(&drawing.x, "s") } else { variable(&drawing.x) };
    let (y_name, y_axis) = match drawing.names.as_slice() {
        [only] => (only.as_str(), variable(only)),
        _ => {
            let unit = units.first().filter(|_| have_one_unit).map_or("", String::as_str);
            ("", Axis::linear("", unit))
        }
    };
    let [log_x, log_y] = drawing.logarithmic;
    let axes = [
        axis((&drawing.bottom_title, &drawing.x), x_axis, log_x),
        axis((&drawing.left_title, y_name), y_axis, log_y),
    ];
    session.extension::<Plots>().vectors = None;
    write(session, &figure(drawing.title, axes, series))
}

/// Whether a plot was drawn. That it was not is no error of the script: nothing depends on it.
fn answer(session: &mut Session, drawn: Result<(), Fault>) -> Value {
    let warning = |fault: Fault| fault.at(session.call_site()).warning();
    match drawn.map_err(warning) {
        Ok(()) => true.into(),
        Err(warning) => {
            session.report(warning);
            false.into()
        }
    }
}

fn draw_vectors(session: &mut Session, args: Args, mark: Mark) -> Result<Value, Failure> {
    let drawn = drawn_vectors(session, args, mark);
    Ok(answer(session, drawn))
}

fn drawn_vectors(session: &mut Session, mut args: Args, mark: Mark) -> Result<(), Fault> {
    let (x, y): (Vec<f64>, Vec<f64>) = (args.take("x")?, args.take("y")?);
    let (legend, unit): (String, String) = (args.take("legend")?, args.take("unit")?);
    if x.len() != y.len() {
        bail!(BAD_ARGUMENT, "`x` has {} values and `y` has {}", x.len(), y.len());
    }
    let erase: bool = args.take("erase")?;
    let plots = session.extension::<Plots>();
    let begun = plots.vectors.take().filter(|figure| !erase || figure.panels[0].series.is_empty());
    let mut figure = begun.unwrap_or_else(|| Drawing::default().empty_figure());
    let series = &mut figure.panels[0].series;
    if !series.is_empty() {
        plots.drawn -= 1;
    }
    let colour = series.len() + 1;
    series.push(Series { name: legend, x, y, mark, colour });
    if !unit.is_empty() {
        figure.panels[0].y.unit = unit;
    }
    write(session, &figure)?;
    session.extension::<Plots>().vectors = Some(figure);
    Ok(())
}

/// A figure with one panel.
fn figure(title: String, [x, y]: [Axis; 2], series: Vec<Series>) -> Figure {
    Figure { title, panels: vec![Panel { x, y, height: 300.0, zero_line: false, series }] }
}

/// Writes the next `plot_<number>.svg` into the output folder.
fn write(session: &mut Session, figure: &Figure) -> Result<(), Fault> {
    let plots = session.extension::<Plots>();
    plots.drawn += 1;
    let name = format!("plot_{}.svg", plots.drawn);
    let path = session.world.output_dir().join(name);
    session.world.write_file(&path, figure.svg().as_bytes())?;
    if session.options.echo == Echo::Dialogue {
        let [width, height] = CHART;
        session.print(&format!("{}{}\n", figure.text(width, height), path.display()));
    }
    session.extension::<Plots>().last_drawn = Some(figure.clone());
    Ok(())
}

const EXPORT_PLOT_AS_IMAGE: &str = r#"
function ExportPlotAsImage "Writes the last plot to a file."
  input String fileName "with extension .svg, .png or .pdf";
  input Integer id = -1 "has no effect: the last plot is written";
  input Boolean includeInLog = true "has no effect";
  input Boolean onlyActiveSubplot = false "has no effect";
  output Boolean ok;
end ExportPlotAsImage;
"#;

fn export_plot_as_image(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let exported = export(session, Path::new(&file));
    Ok(answer(session, exported))
}

fn export(session: &mut Session, file: &Path) -> Result<(), Fault> {
    let format = Picture::of(file)?;
    let Some(figure) = session.extension::<Plots>().last_drawn.clone() else {
        bail!(BAD_ARGUMENT, "no plot has been drawn")
    };
    session.world.write_file(file, &figure.picture(format)?)
}

const PLOT_EXPRESSION: &str = r#"
function plotExpression "Plots an expression of variables of the last simulation over time."
  input Expression mapFun "the expression";
  input Boolean eraseOld = false;
  input String expressionName = "" "legend";
  input Integer id = 0;
  output Boolean ok;
end plotExpression;
"#;

fn plot_expression(session: &mut Session, args: Args) -> Result<Value, Failure> {
    match drawn_expression(session, args) {
        Ok(()) => Ok(true.into()),
        Err(Failure::Here(fault)) => Ok(answer(session, Err(fault))),
        Err(Failure::Elsewhere(errors)) => {
            errors.into_iter().for_each(|error| session.report(error.warning()));
            Ok(false.into())
        }
    }
}

fn drawn_expression(session: &mut Session, mut args: Args) -> Result<(), Failure> {
    let shown: String = args.take("mapFun")?;
    let legend: String = args.take("expressionName")?;
    let table = results(session, "")?;
    let y = session.along(&shown, &table)?;
    let name = if legend.is_empty() { shown } else { legend };
    let series = vec![Series { name, x: table.time.clone(), y, mark: Mark::Line, colour: 1 }];
    let axes = [Axis::linear("time", "s"), Axis::linear("", "")];
    Ok(write(session, &figure(String::new(), axes, series))?)
}

const PLOT_OPENMODELICA: &str = r#"
function plot "Plots trajectories of a result file over time."
  input VariableName vars[:] "variables, or one";
  input Boolean externalWindow = false "has no effect";
  input String fileName = "<default>" "result file; default: that of the last simulation";
  input String title = "";
  input String grid = "simple" "has no effect";
  input Boolean logX = false;
  input Boolean logY = false;
  input String xLabel = "time";
  input String yLabel = "";
  input Real xRange[2] = {0.0, 0.0} "has no effect";
  input Real yRange[2] = {0.0, 0.0} "has no effect";
  input Real curveWidth = 1.0 "has no effect";
  input Integer curveStyle = 1 "has no effect";
  input String legendPosition = "top" "has no effect";
  input String footer = "" "has no effect";
  input Boolean autoScale = true "has no effect";
  input Boolean forceOMPlot = false "has no effect";
  input String yAxis = "L" "has no effect";
  input String yLabelRight = "" "has no effect";
  input Real yRangeRight[2] = {0.0, 0.0} "has no effect";
  output Boolean success;
end plot;
"#;

fn plot_openmodelica(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let drawing = Drawing {
        title: args.take("title")?,
        x: "time".to_owned(),
        names: super::results::variable_names(&mut args, "vars")?,
        legends: Vec::new(),
        file: args.take("fileName")?,
        left_title: args.take("yLabel")?,
        bottom_title: args.take("xLabel")?,
        logarithmic: [args.take("logX")?, args.take("logY")?],
    };
    let drawn = draw_trajectories(session, drawing);
    Ok(answer(session, drawn))
}

const PLOT_ALL: &str = r#"
function plotAll "Plots all trajectories of a result file over time."
  input Boolean externalWindow = false "has no effect";
  input String fileName = "<default>" "result file; default: that of the last simulation";
  input String title = "";
  input String grid = "simple" "has no effect";
  input Boolean logX = false;
  input Boolean logY = false;
  input String xLabel = "time";
  input String yLabel = "";
  output Boolean success;
end plotAll;
"#;

fn plot_all(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("fileName")?;
    let title: String = args.take("title")?;
    let drawn = results(session, &file).and_then(|table| {
        let varies = |series: &&crate::results::Series| {
            matches!(series.values, crate::results::Values::Trajectory(_))
        };
        let names = table.series.iter().filter(varies).map(|series| series.name.to_string());
        let names = names.collect();
        let x = "time".to_owned();
        draw_trajectories(session, Drawing { title, x, names, file, ..Drawing::default() })
    });
    Ok(answer(session, drawn))
}

const PLOT_PARAMETRIC: &str = r#"
function plotParametric "Plots one variable of a result file over another."
  input VariableName xVariable;
  input VariableName yVariable;
  input Boolean externalWindow = false "has no effect";
  input String fileName = "<default>" "result file; default: that of the last simulation";
  input String title = "";
  input String grid = "simple" "has no effect";
  input Boolean logX = false;
  input Boolean logY = false;
  input String xLabel = "";
  input String yLabel = "";
  input Any xRange = 0 "has no effect";
  input Any yRange = 0 "has no effect";
  input Real curveWidth = 1.0 "has no effect";
  input Integer curveStyle = 1 "has no effect";
  input String legendPosition = "top" "has no effect";
  input String footer = "" "has no effect";
  input Boolean autoScale = true "has no effect";
  input Boolean forceOMPlot = false "has no effect";
  output Boolean success;
end plotParametric;
"#;

fn plot_parametric(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let drawing = Drawing {
        title: args.take("title")?,
        x: args.take("xVariable")?,
        names: vec![args.take("yVariable")?],
        legends: Vec::new(),
        file: args.take("fileName")?,
        left_title: args.take("yLabel")?,
        bottom_title: args.take("xLabel")?,
        logarithmic: [args.take("logX")?, args.take("logY")?],
    };
    let drawn = draw_trajectories(session, drawing);
    Ok(answer(session, drawn))
}

const PLOT_PARAMETRIC_CURVE: &str = r#"
function plotParametricCurve "Plots one vector over another, both functions of a third."
  input Real x[:];
  input Real y[:];
  input Real s[:] = fill(0.0, 0) "has no effect";
  input String xName = "";
  input String yName = "";
  input String sName = "";
  input String legend = "";
  input Integer id = 0;
  input Any color = 0;
  input Any pattern = 0;
  input Any marker = 0;
  input Real thickness = 0.25;
  input Boolean labelWithS = false;
  input Boolean erase = true;
  input Integer axis = 1;
  input String unit = "";
  output Boolean ok;
end plotParametricCurve;
"#;

fn plot_parametric_curve(session: &mut Session, args: Args) -> Result<Value, Failure> {
    draw_vectors(session, args, Mark::Line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::MemoryWorld;

    #[test]
    fn columns_are_series_and_a_cleared_diagram_has_none() {
        let mut session = Session::new(Box::new(MemoryWorld::new()));
        let script = r#"
plotArrays({0, 1, 2}, [1, 2; 4, 3; 9, 4], legend={"squares", "successors"}, title="Columns");
clearPlot();
plotArray({0, 1}, {0, 1}, legend="alone", erase=false);
"#;
        assert_eq!(session.run_text("plots", script).code, 0);
        let folder = session.world.output_dir();
        let drawn = |name: &str| {
            let bytes = session.world.read(&folder.join(name)).expect("a figure");
            String::from_utf8(bytes).expect("SVG")
        };
        let (columns, cleared) = (drawn("plot_1.svg"), drawn("plot_2.svg"));
        assert!(["squares", "successors", "Columns"].iter().all(|name| columns.contains(name)));
        assert!(["alone", "Columns"].iter().all(|name| cleared.contains(name)));
        assert!(!cleared.contains("squares"), "{cleared}");
    }
}
