// The bundle is loaded with a VS Code of a few functions, in which the server is started for real if
// GAPI names a program.
const assert = require('node:assert');
const fs = require('node:fs');
const Module = require('node:module');
const path = require('node:path');
const test = require('node:test');

const root = path.join(__dirname, '..');
const manifest = JSON.parse(fs.readFileSync(path.join(root, 'package.json'), 'utf8'));

/** An object that answers every question with another such object. */
function anything(own = {}) {
  const target = Object.assign(function () {}, own);
  return new Proxy(target, {
    get: (of, name) => (name in of ? of[name] : name === 'then' ? undefined : anything()),
    apply: () => anything(),
    construct: () => anything(),
  });
}

function load(vscode) {
  const original = Module._load;
  Module._load = (name, ...rest) => (name === 'vscode' ? vscode : original(name, ...rest));
  try {
    delete require.cache[require.resolve('../dist/extension.js')];
    return require('../dist/extension.js');
  } finally {
    Module._load = original;
  }
}

test('every command of the manifest is registered, and those files are there', async () => {
  const registered = {};
  const shown = [];
  const vscode = anything({
    version: '1.91.0',
    commands: anything({ registerCommand: (name, work) => (registered[name] = work) }),
    window: anything({ showErrorMessage: async (text) => void shown.push(text) }),
    workspace: anything({
      getConfiguration: () => ({ get: (name) => (name === 'libraries' ? [] : '/nonexistent/gapi') }),
      textDocuments: [],
    }),
  });
  const extension = load(vscode);
  await extension.activate({ subscriptions: [] });
  const promised = manifest.contributes.commands.map((one) => one.command).sort();
  assert.deepStrictEqual(Object.keys(registered).sort(), promised);
  for (const { path: file } of manifest.contributes.grammars) {
    assert.ok(fs.existsSync(path.join(root, file)), file);
  }
  for (const { configuration } of manifest.contributes.languages) {
    JSON.parse(fs.readFileSync(path.join(root, configuration), 'utf8'));
  }
});

test('scripts are run, and problem files identified, with the libraries of the settings', async () => {
  const registered = {};
  const executed = [];
  class ProcessExecution {
    constructor(program, args, options) {
      Object.assign(this, { program, args, options });
    }
  }
  class Task {
    constructor(definition, scope, name, source, execution) {
      Object.assign(this, { name, execution });
    }
  }
  const vscode = anything({
    version: '1.91.0',
    ProcessExecution,
    Task,
    commands: anything({ registerCommand: (name, work) => (registered[name] = work) }),
    tasks: { executeTask: async (task) => void executed.push(task) },
    window: anything({ showErrorMessage: async () => undefined }),
    workspace: anything({
      getConfiguration: () => ({ get: (name) => (name === 'libraries' ? ['/lib'] : '/nonexistent/gapi') }),
      getWorkspaceFolder: () => undefined,
      textDocuments: [],
    }),
  });
  await load(vscode).activate({ subscriptions: [] });
  for (const [file, command] of [['/a/fit.mos', 'run'], ['/a/fit.toml', 'identify']]) {
    await registered['gapilib.run']({ scheme: 'file', fsPath: file, toString: () => file });
    const { execution } = executed.pop();
    assert.deepStrictEqual(execution.args, [command, file, '--library', '/lib']);
    assert.strictEqual(execution.options.cwd, '/a');
  }
});
