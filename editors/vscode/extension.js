// Starts `gapi lsp`, and runs gapi in a terminal.
const fs = require('node:fs');
const path = require('node:path');
const vscode = require('vscode');
const { LanguageClient, TransportKind } = require('vscode-languageclient/node');

const LANGUAGES = [
  { language: 'modelica' },
  { language: 'modelica-script' },
  // Problem files: those with experiments; of others the server says nothing.
  { scheme: 'file', pattern: '**/*.toml' },
];

let client;

// Classes, and the data and models that problem files and scripts name.
const WATCHED = '**/{*.mo,package.order,*.csv,*.tsv,*.txt,*.mat,*.fmu,*.xml}';

function setting(name) {
  return vscode.workspace.getConfiguration('gapilib').get(name);
}

async function start() {
  const libraries = setting('libraries');
  const options = libraries.flatMap((folder) => ['--library', folder]);
  const run = { command: setting('path'), args: ['lsp', ...options], transport: TransportKind.stdio };
  client = new LanguageClient('gapilib', 'GAPILib', { run, debug: run }, {
    documentSelector: LANGUAGES,
    synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher(WATCHED) },
  });
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    const chosen = await vscode.window.showErrorMessage(
      `gapi cannot be started (${error.message}). Install it, or say where it is.`,
      'Open Settings',
    );
    if (chosen) {
      await vscode.commands.executeCommand('workbench.action.openSettings', 'gapilib.path');
    }
  }
}

async function stop() {
  const running = client;
  client = undefined;
  await running?.stop();
}

/** The file that a command is about: that of the menu, else that of the active editor, saved. */
async function chosenFile(uri) {
  const editor = vscode.window.activeTextEditor;
  const chosen = uri ?? editor?.document.uri;
  if (chosen?.scheme !== 'file') {
    await vscode.window.showWarningMessage('Open a file first.');
    return undefined;
  }
  const open = vscode.workspace.textDocuments.find((one) => one.uri.toString() === chosen.toString());
  if (open?.isDirty && !(await open.save())) {
    return undefined;
  }
  return chosen.fsPath;
}

/** Where gapi works for a file: the folder of the workspace, or that of the file. */
function workingFolder(file) {
  return vscode.workspace.getWorkspaceFolder(vscode.Uri.file(file))?.uri.fsPath ?? path.dirname(file);
}

/** Runs gapi in a terminal of its own; no shell reads the arguments. */
function inTerminal(title, cwd, args) {
  const shellArgs = [...args, ...setting('libraries').flatMap((folder) => ['--library', folder])];
  const terminal = vscode.window.createTerminal({ name: `gapi ${title}`, shellPath: setting('path'), shellArgs, cwd });
  terminal.show();
  return terminal;
}

/** Milliseconds after which the server has answered what can be folded. */
const FOLDED = 500;
const folded = new Set();

/** Folds the annotations of a file, which are ranges of the kind region, when it is first shown. */
async function foldAnnotations(editor) {
  const document = editor?.document;
  if (document?.languageId !== 'modelica' || !setting('foldAnnotations') || folded.has(document.uri.toString())) {
    return;
  }
  folded.add(document.uri.toString());
  await new Promise((done) => setTimeout(done, FOLDED));
  if (vscode.window.activeTextEditor === editor) {
    await vscode.commands.executeCommand('editor.foldAllMarkerRegions');
  }
}

/** Runs gapi on a file in a task: a terminal closes with its program, a task keeps what it printed. */
async function inTask(title, file, args) {
  const task = new vscode.Task(
    { type: 'process' }, vscode.TaskScope.Workspace, title, 'gapi',
    new vscode.ProcessExecution(setting('path'), [
      ...args, ...setting('libraries').flatMap((folder) => ['--library', folder]),
    ], { cwd: workingFolder(file) }),
  );
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, clear: true, showReuseMessage: false };
  await vscode.tasks.executeTask(task);
}

async function run(uri) {
  const file = await chosenFile(uri);
  if (file) {
    const command = path.extname(file) === '.toml' ? 'identify' : 'run';
    await inTask(`${command} ${path.basename(file)}`, file, [command, file]);
  }
}

/** Simulates a class of a file: the command above a model. */
async function simulate(name, model) {
  const file = await chosenFile(vscode.Uri.file(name));
  if (file) {
    await inTask(`simulate ${model}`, file, ['simulate', file, '--model', model, '--stats']);
  }
}

async function teach(uri) {
  const file = await chosenFile(uri);
  if (file) {
    inTerminal(`teach ${path.basename(file)}`, workingFolder(file), ['teach', file]);
  }
}

/** The folder with the results of the active script, else one that the user chooses. */
async function resultsFolder(uri) {
  if (uri?.scheme === 'file' && fs.statSync(uri.fsPath, { throwIfNoEntry: false })?.isDirectory()) {
    return uri.fsPath;
  }
  const file = vscode.window.activeTextEditor?.document.uri;
  if (file?.scheme === 'file') {
    const own = path.join(workingFolder(file.fsPath), 'results', path.parse(file.fsPath).name);
    if (fs.existsSync(own)) {
      return own;
    }
  }
  const chosen = await vscode.window.showOpenDialog({
    canSelectFiles: false, canSelectFolders: true, title: 'The folder with the results of a run',
  });
  return chosen?.[0]?.fsPath;
}

async function report(uri) {
  const folder = await resultsFolder(uri);
  if (!folder) {
    return;
  }
  const terminal = inTerminal('report', folder, ['report', folder]);
  const closed = vscode.window.onDidCloseTerminal(async (ended) => {
    if (ended === terminal) {
      closed.dispose();
      if (ended.exitStatus?.code === 0) {
        await vscode.env.openExternal(vscode.Uri.file(path.join(folder, 'report.html')));
      }
    }
  });
}

exports.activate = async (context) => {
  const command = (name, work) => {
    context.subscriptions.push(vscode.commands.registerCommand(`gapilib.${name}`, work));
  };
  command('run', run);
  command('simulate', simulate);
  command('identify', (name) => run(vscode.Uri.file(name)));
  command('teach', teach);
  command('report', report);
  command('restart', async () => {
    await stop();
    await start();
  });
  context.subscriptions.push(
    vscode.window.onDidChangeActiveTextEditor(foldAnnotations),
    vscode.workspace.onDidCloseTextDocument((closed) => folded.delete(closed.uri.toString())),
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (change.affectsConfiguration('gapilib')) {
        await stop();
        await start();
      }
    }),
  );
  await start();
  await foldAnnotations(vscode.window.activeTextEditor);
};

exports.deactivate = stop;
