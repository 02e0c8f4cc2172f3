//! Commands about windows of graphical tools: accepted, said once each, without effect.

use super::{Args, Builtin, Failure, Family};
use crate::script::Session;
use crate::value::Value;

macro_rules! windowless {
    ($($name:literal),* $(,)?) => {
        &[$(Builtin {
            header: concat!(
                "function ", $name, " \"Concerns a window; has no effect here.\"\n",
                "  output Boolean ok;\n  annotation(variadic = true);\nend ", $name, ";\n"
            ),
            run: no_effect,
        }),*]
    };
}

/// The commands of this file. They take any arguments.
pub(super) const FAMILY: Family = Family {
    packages: &[],
    dialect: None,
    builtins: windowless![
        "animationSetup",
        "animationPosition",
        "animationColor",
        "visualize3dModel",
        "RunAnimation",
        "AnimateRunning",
        "loadAnimation",
        "exportAnimation",
        "plotHeading",
        "plotText",
        "plotWindowSetup",
        "plotSetup",
        "trace",
        "beep",
        "closeModel",
        "saveSettings",
        "SetDymolaCompiler",
        "ShowMessageWindow",
        "showMessageWindow",
        "switchToSimulationMode",
        "switchToModelingMode",
        "switchToDocumentationMode",
        "LibraryInfoMenuCommand",
        "showComponent",
        "showDiagramWindow",
        "plotSetFilesToKeep",
        "plotMoveToTab",
        "plotDocumentation",
        "plotWindowRefresh",
        "plotRowColumnLabels",
        "plotSignalDifference",
        "plotSignalOperator",
        "plotSignalOperatorHarmonic",
        "setPlotColor",
        "variablesSetup",
        "logCommand",
        "setDymolaCompiler",
    ],
};

fn no_effect(session: &mut Session, args: Args) -> Result<Value, Failure> {
    session.no_effect(args.command());
    Ok(true.into())
}
