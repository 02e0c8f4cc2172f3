//! Commands about windows of graphical tools and what they show: accepted, said once each, without
//! effect.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
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
        "animationRemove",
        "animationGrid",
        "animationView",
        "animationFollow",
        "animationViewing",
        "animationSelected",
        "animationFrames",
        "animationVectorScaling",
        "animationOnline",
        "animationSubdivisions",
        "animationPerspective",
        "animationSpeed",
        "animationRedraw",
        "setCompiler",
        "setCXXCompiler",
        "setCFlags",
        "setLinker",
        "setLinkerFlags",
        "setDefaultOpenCLDevice",
        "clearDebugFlags",
        "clearCommandLineOptions",
        "setPreOptModules",
        "setPostOptModules",
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
        "removeResults",
        "plotMoveToTab",
        "plotDocumentation",
        "plotWindowRefresh",
        "plotRowColumnLabels",
        "plotSignalDifference",
        "setPlotColor",
        "variablesSetup",
        "logCommand",
        "defineUnitConversion",
        "defineDefaultDisplayUnit",
        "setDymolaCompiler",
    ],
};

fn no_effect(session: &mut Session, args: Args) -> Result<Value, Failure> {
    session.no_effect(args.command());
    Ok(true.into())
}
