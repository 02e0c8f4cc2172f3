//! Commands of other tools that are not supported, each with its reason.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::bail;
use crate::errors::REFUSED;
use crate::value::Value;

macro_rules! refused {
    ($($reason:literal: $($name:ident)*;)*) => {
        &[$($(Builtin {
            header: concat!(
                "function ", stringify!($name), " \"Refused: ", $reason, ".\"\n",
                "  output Boolean ok;\n  annotation(variadic = true);\nend ",
                stringify!($name), ";\n"
            ),
            run: refuse,
        },)*)*]
    };
}

/// The commands of this file. They take any arguments.
pub(super) const FAMILY: Family = Family {
    packages: &[],
    dialect: None,
    builtins: refused! {
        "write FMUs with translateModelFMU or buildModelFMU":
            exportFMU translateModelFMI;
        "models cannot be exported as C code":
            translateModelExport;
        "`gapi check x.fmu` shows what an FMU is; importFMU makes one usable":
            importFMUModelDescription;
        "diagrams are not supported":
            exportDiagram;
        "documentation export is not supported":
            exportDocumentation;
        "settings cannot be saved to a file: write them in a script":
            exportInitial;
        "the standard streams belong to the calling process":
            reopenStandardStream;
        "set the time limit of a script on the command line: --time-limit":
            alarm;
        "encrypted models are not supported":
            decryptModel loadEncryptedPackage;
        "edit loaded classes with setParameterValue and setElementModifierValue, or edit the \
         file":
            addAlgorithm addClass addClassAnnotation addComponent addConnection addEquation
            addInitialState addTransition copyClass createModel createSubClass deleteAlgorithm
            deleteComponent deleteConnection deleteEquation deleteInitialEquation
            deleteInitialState deleteTransition duplicateClass moveClass moveClassToBottom
            moveClassToTop newModel removeComponentModifiers removeElementModifiers
            removeExtendsModifiers renameClass renameComponent setAnnotationVersion
            setClassComment setComponentComment setComponentDimensions setComponentProperties
            setConnectionComment setDocumentationAnnotation setElementAnnotation setElementType
            setExtendsModifier setExtendsModifierValue setSourceFile updateComponent
            updateConnection updateConnectionAnnotation updateConnectionNames updateEquation
            updateInitialState updateTransition;
        "encryption of libraries is not supported":
            buildEncryptedPackage;
        "models cannot be exported as labelled programs":
            buildLabel;
        "check models one by one with checkModel":
            checkAllModelsRecursive;
        "models are compiled to machine code without a C compiler":
            checkSettings;
        "there is no task graph":
            checkTaskGraph;
        "plots are written to files":
            closePlotWindow openPlotWindow;
        "differences cannot be plotted":
            compareSimulationResultsHtml;
        "convert libraries with conversion scripts":
            convertPackageToLibrary;
        "unit conversion in scripts is not supported":
            convertUnits getDerivedUnits;
        "data reconciliation is not supported":
            dataReconciliation;
        "get differences with compareSimulationResults":
            deltaSimulationResults;
        "comparing the source code of models is not supported":
            diffModelicaFileListings;
        "differences cannot be plotted: use diffSimulationResults":
            diffSimulationResultsHtml;
        "expressions can be differentiated only inside models":
            differentiate;
        "models cannot be exported as XML":
            dumpXMLDAE translateModelXML;
        "models cannot be exported as Figaro":
            exportToFigaro;
        "models cannot be translated to C":
            generateCode generateEntryPoint generateHeader generateSeparateCode
            generateSeparateCodeDependencies generateSeparateCodeDependenciesMakefile;
        "models cannot be translated to other languages":
            generateJuliaHeader;
        "searching for subtypes is not supported":
            getAllSubtypeOf;
        "get the source text with list":
            getAstAsCorbaString;
        "diagrams and icons are not supported":
            getComponentAnnotations getDiagramAnnotation getElementAnnotation
            getElementAnnotations getIconAnnotation getModelFigures getNthComponentAnnotation
            getNthConnectionAnnotation refactorClass translateGraphics;
        "get components with getComponents":
            getComponentsTest;
        "get connectors with getComponents":
            getConnectorCount getNthConnector;
        "listing conversions is not supported":
            getConversionsFromVersions;
        "positions in files are given in messages":
            getCrefInfo;
        "get the source text of a class with list":
            getDefinitions listFile;
        "get elements with getComponents":
            getElements getElementsInfo;
        "listing the transitions of state machines is not supported":
            getInitialStates getTransitions;
        "the instance tree cannot be written as JSON: get the flat model with instantiateModel":
            getModelInstance;
        "the instance tree cannot be written as JSON":
            getModelInstanceAnnotation;
        "searching for uses of a class is not supported":
            getUsedClassNames reverseLookup;
        "libraries are not downloaded: name the folder of the library with --library":
            installPackage;
        "co-simulation is not supported":
            loadOMSimulator unloadOMSimulator;
        "data reconciliation is not supported: use parameter identification":
            modelEquationsUC;
        "JSON output is not supported":
            modifierToJSON;
        "optimal control is not supported; for parameter identification use Problem or GAPILib":
            optimize;
        "load files with loadFile":
            parseFile;
        "load strings with loadString":
            parseString;
        "reload classes with loadFile":
            reloadClass;
        "saving the state of loaded classes is not supported":
            restoreAST storeAST;
        "model files cannot be overwritten: write to a new file with saveModel":
            save;
        "writing one file with everything that a model uses is not supported":
            saveTotalSCode;
        "there is no installation folder":
            setInstallationDirectoryPath;
        "a script must not start several programs":
            system_parallel;
        "scripts cannot start threads":
            threadWorkFailed;
        "libraries are not downloaded":
            updatePackageIndex upgradeInstalledPackages;
    },
};

fn refuse(_: &mut Session, args: Args) -> Result<Value, Failure> {
    let reason = args.description();
    let reason = reason.trim_start_matches("Refused: ").trim_end_matches('.');
    bail!(REFUSED, "`{}` is not supported: {reason}", args.command())
}
