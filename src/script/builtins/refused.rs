//! Commands of other tools that are not carried out, each with its reason.

use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::script::Session;
use crate::script::errors::REFUSED;
use crate::value::Value;

macro_rules! refused {
    ($($name:literal: $reason:literal),* $(,)?) => {
        &[$(Builtin {
            header: concat!(
                "function ", $name, " \"Refused: ", $reason, ".\"\n",
                "  output Boolean ok;\n  annotation(variadic = true);\nend ", $name, ";\n"
            ),
            run: refuse,
        }),*]
    };
}

/// The commands of this file. They take any arguments.
pub(super) const FAMILY: Family = Family {
    packages: &[],
    dialect: None,
    builtins: refused![
        "translateModelFMU": "models cannot be exported as FMUs",
        "translateModelExport": "models cannot be exported as C code",
        "buildModelFMU": "models cannot be exported as FMUs",
        "importFMU": "FMUs cannot be imported",
        "exportDiagram": "diagrams are not supported",
        "exportDocumentation": "documentation export is not supported",
        "exportInitial": "settings cannot be saved to a file: write them in a script",
        "reopenStandardStream": "the standard streams belong to the calling process",
        "alarm": "set the time limit of a script on the command line: --time-limit",
        "decryptModel": "encrypted models are not supported",
        "addAlgorithm": "edit loaded classes with setParameterValue and setElementModifierValue, \
                         or edit the file",
        "addClass": "edit loaded classes with setParameterValue and setElementModifierValue, or \
                     edit the file",
        "addClassAnnotation": "edit loaded classes with setParameterValue and \
                               setElementModifierValue, or edit the file",
        "addComponent": "edit loaded classes with setParameterValue and setElementModifierValue, \
                         or edit the file",
        "addConnection": "edit loaded classes with setParameterValue and \
                          setElementModifierValue, or edit the file",
        "addEquation": "edit loaded classes with setParameterValue and setElementModifierValue, \
                        or edit the file",
        "addInitialState": "edit loaded classes with setParameterValue and \
                            setElementModifierValue, or edit the file",
        "addTransition": "edit loaded classes with setParameterValue and \
                          setElementModifierValue, or edit the file",
        "buildEncryptedPackage": "encryption of libraries is not supported",
        "buildLabel": "models cannot be exported as labelled programs",
        "checkAllModelsRecursive": "check models one by one with checkModel",
        "checkSettings": "there is no C compiler here",
        "checkTaskGraph": "there is no task graph",
        "closePlotWindow": "plots are written to files",
        "compareSimulationResultsHtml": "differences cannot be plotted",
        "convertPackageToLibrary": "convert libraries with conversion scripts",
        "convertUnits": "unit conversion in scripts is not supported",
        "copyClass": "edit loaded classes with setParameterValue and setElementModifierValue, or \
                      edit the file",
        "createModel": "edit loaded classes with setParameterValue and setElementModifierValue, \
                        or edit the file",
        "createSubClass": "edit loaded classes with setParameterValue and \
                           setElementModifierValue, or edit the file",
        "dataReconciliation": "data reconciliation is not supported",
        "deleteAlgorithm": "edit loaded classes with setParameterValue and \
                            setElementModifierValue, or edit the file",
        "deleteComponent": "edit loaded classes with setParameterValue and \
                            setElementModifierValue, or edit the file",
        "deleteConnection": "edit loaded classes with setParameterValue and \
                             setElementModifierValue, or edit the file",
        "deleteEquation": "edit loaded classes with setParameterValue and \
                           setElementModifierValue, or edit the file",
        "deleteInitialEquation": "edit loaded classes with setParameterValue and \
                                  setElementModifierValue, or edit the file",
        "deleteInitialState": "edit loaded classes with setParameterValue and \
                               setElementModifierValue, or edit the file",
        "deleteTransition": "edit loaded classes with setParameterValue and \
                             setElementModifierValue, or edit the file",
        "deltaSimulationResults": "get differences with compareSimulationResults",
        "diffModelicaFileListings": "comparing the source code of models is not supported",
        "diffSimulationResultsHtml": "differences cannot be plotted: use diffSimulationResults",
        "differentiate": "expressions can be differentiated only inside models",
        "dumpXMLDAE": "models cannot be exported as XML",
        "duplicateClass": "edit loaded classes with setParameterValue and \
                           setElementModifierValue, or edit the file",
        "exportFMU": "models cannot be exported as FMUs",
        "exportToFigaro": "models cannot be exported as Figaro",
        "generateCode": "models cannot be translated to C",
        "generateEntryPoint": "models cannot be translated to C",
        "generateHeader": "models cannot be translated to C",
        "generateJuliaHeader": "models cannot be translated to other languages",
        "generateSeparateCode": "models cannot be translated to C",
        "generateSeparateCodeDependencies": "models cannot be translated to C",
        "generateSeparateCodeDependenciesMakefile": "models cannot be translated to C",
        "getAllSubtypeOf": "searching for subtypes is not supported",
        "getAstAsCorbaString": "get the source text with list",
        "getComponentAnnotations": "diagrams and icons are not supported",
        "getComponentsTest": "get components with getComponents",
        "getConnectorCount": "get connectors with getComponents",
        "getConversionsFromVersions": "listing conversions is not supported",
        "getCrefInfo": "positions in files are given in messages",
        "getDefinitions": "get the source text of a class with list",
        "getDerivedUnits": "unit conversion in scripts is not supported",
        "getDiagramAnnotation": "diagrams and icons are not supported",
        "getElementAnnotation": "diagrams and icons are not supported",
        "getElementAnnotations": "diagrams and icons are not supported",
        "getElements": "get elements with getComponents",
        "getElementsInfo": "get elements with getComponents",
        "getIconAnnotation": "diagrams and icons are not supported",
        "getInitialStates": "state machines are not supported",
        "getModelFigures": "diagrams and icons are not supported",
        "getModelInstance": "the instance tree cannot be written as JSON: get the flat model \
                             with instantiateModel",
        "getModelInstanceAnnotation": "the instance tree cannot be written as JSON",
        "getNthComponentAnnotation": "diagrams and icons are not supported",
        "getNthConnectionAnnotation": "diagrams and icons are not supported",
        "getNthConnector": "get connectors with getComponents",
        "getTransitions": "state machines are not supported",
        "getUsedClassNames": "searching for uses of a class is not supported",
        "importFMUModelDescription": "FMUs cannot be imported",
        "installPackage": "there is no network access: name the folder of the library with \
                           --library",
        "listFile": "get the source text of a class with list",
        "loadEncryptedPackage": "encrypted models are not supported",
        "loadOMSimulator": "co-simulation is not supported",
        "modelEquationsUC": "data reconciliation is not supported: use parameter identification",
        "modifierToJSON": "JSON output is not supported",
        "moveClass": "edit loaded classes with setParameterValue and setElementModifierValue, or \
                      edit the file",
        "moveClassToBottom": "edit loaded classes with setParameterValue and \
                              setElementModifierValue, or edit the file",
        "moveClassToTop": "edit loaded classes with setParameterValue and \
                           setElementModifierValue, or edit the file",
        "newModel": "edit loaded classes with setParameterValue and setElementModifierValue, or \
                     edit the file",
        "openPlotWindow": "plots are written to files",
        "optimize": "optimal control is not supported; for parameter identification use Problem \
                     or GAPILib",
        "parseFile": "load files with loadFile",
        "parseString": "load strings with loadString",
        "refactorClass": "diagrams and icons are not supported",
        "reloadClass": "reload classes with loadFile",
        "removeComponentModifiers": "edit loaded classes with setParameterValue and \
                                     setElementModifierValue, or edit the file",
        "removeElementModifiers": "edit loaded classes with setParameterValue and \
                                   setElementModifierValue, or edit the file",
        "removeExtendsModifiers": "edit loaded classes with setParameterValue and \
                                   setElementModifierValue, or edit the file",
        "renameClass": "edit loaded classes with setParameterValue and setElementModifierValue, \
                        or edit the file",
        "renameComponent": "edit loaded classes with setParameterValue and \
                            setElementModifierValue, or edit the file",
        "restoreAST": "saving the state of loaded classes is not supported",
        "reverseLookup": "searching for uses of a class is not supported",
        "save": "model files cannot be overwritten: write to a new file with saveModel",
        "saveTotalSCode": "writing one file with everything that a model uses is not supported",
        "setAnnotationVersion": "edit loaded classes with setParameterValue and \
                                 setElementModifierValue, or edit the file",
        "setClassComment": "edit loaded classes with setParameterValue and \
                            setElementModifierValue, or edit the file",
        "setComponentComment": "edit loaded classes with setParameterValue and \
                                setElementModifierValue, or edit the file",
        "setComponentDimensions": "edit loaded classes with setParameterValue and \
                                   setElementModifierValue, or edit the file",
        "setComponentProperties": "edit loaded classes with setParameterValue and \
                                   setElementModifierValue, or edit the file",
        "setConnectionComment": "edit loaded classes with setParameterValue and \
                                 setElementModifierValue, or edit the file",
        "setDocumentationAnnotation": "edit loaded classes with setParameterValue and \
                                       setElementModifierValue, or edit the file",
        "setElementAnnotation": "edit loaded classes with setParameterValue and \
                                 setElementModifierValue, or edit the file",
        "setElementType": "edit loaded classes with setParameterValue and \
                           setElementModifierValue, or edit the file",
        "setExtendsModifier": "edit loaded classes with setParameterValue and \
                               setElementModifierValue, or edit the file",
        "setExtendsModifierValue": "edit loaded classes with setParameterValue and \
                                    setElementModifierValue, or edit the file",
        "setInstallationDirectoryPath": "there is no installation folder",
        "setSourceFile": "edit loaded classes with setParameterValue and \
                          setElementModifierValue, or edit the file",
        "storeAST": "saving the state of loaded classes is not supported",
        "system_parallel": "a script must not start several programs",
        "threadWorkFailed": "scripts cannot start threads",
        "translateGraphics": "diagrams and icons are not supported",
        "translateModelFMI": "models cannot be exported as FMUs",
        "translateModelXML": "models cannot be exported as XML",
        "unloadOMSimulator": "co-simulation is not supported",
        "updateComponent": "edit loaded classes with setParameterValue and \
                            setElementModifierValue, or edit the file",
        "updateConnection": "edit loaded classes with setParameterValue and \
                             setElementModifierValue, or edit the file",
        "updateConnectionAnnotation": "edit loaded classes with setParameterValue and \
                                       setElementModifierValue, or edit the file",
        "updateConnectionNames": "edit loaded classes with setParameterValue and \
                                  setElementModifierValue, or edit the file",
        "updateEquation": "edit loaded classes with setParameterValue and \
                           setElementModifierValue, or edit the file",
        "updateInitialState": "edit loaded classes with setParameterValue and \
                               setElementModifierValue, or edit the file",
        "updatePackageIndex": "there is no network access",
        "updateTransition": "edit loaded classes with setParameterValue and \
                             setElementModifierValue, or edit the file",
        "upgradeInstalledPackages": "there is no network access",
    ],
};

fn refuse(_: &mut Session, args: Args) -> Result<Value, Failure> {
    let reason = args.description();
    let reason = reason.trim_start_matches("Refused: ").trim_end_matches('.');
    bail!(REFUSED, "`{}` is not supported: {reason}", args.command())
}
