// What the TextMate grammars say of pieces of text.
const assert = require('node:assert');
const fs = require('node:fs');
const path = require('node:path');
const test = require('node:test');
const oniguruma = require('vscode-oniguruma');
const { INITIAL, Registry, parseRawGrammar } = require('vscode-textmate');

const files = {
  'source.modelica': 'modelica.tmLanguage.json',
  'source.modelica-script': 'modelica-script.tmLanguage.json',
};

async function grammar(scope) {
  const wasm = fs.readFileSync(require.resolve('vscode-oniguruma/release/onig.wasm'));
  await oniguruma.loadWASM(wasm).catch(() => {});
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async (name) => {
      const file = path.join(__dirname, '..', 'syntaxes', files[name]);
      return parseRawGrammar(fs.readFileSync(file, 'utf8'), file);
    },
  });
  return registry.loadGrammar(scope);
}

/** The innermost scope of each word that has one. */
function scopes(of, text) {
  const found = {};
  let state = INITIAL;
  for (const line of text.split('\n')) {
    const result = of.tokenizeLine(line, state);
    state = result.ruleStack;
    for (const token of result.tokens) {
      const word = line.slice(token.startIndex, token.endIndex).trim();
      if (word && token.scopes.length > 1) {
        found[word] = token.scopes.at(-1).replace(/\.modelica.*$/, '');
      }
    }
  }
  return found;
}

test('Modelica', async () => {
  const found = scopes(await grammar('source.modelica'), `model Decay "A \\"decay\\""
  parameter Real k(unit = "1/s") = 1.5e-3; // rate
  Real 'x y' /* state
  equation */;
equation
  der('x y') = -k*'x y';
  assert(true, "never");
end Decay;`);
  const expected = {
    model: 'keyword.other', Decay: 'entity.name.type.class', parameter: 'keyword.other',
    Real: 'storage.type', '1.5e-3': 'constant.numeric', '// rate': 'comment.line.double-slash',
    '*/': 'comment.block', equation: 'keyword.other', der: 'support.function',
    "'x y'": 'variable.other.quoted', true: 'constant.language', end: 'keyword.control',
    assert: 'support.function', '\\"': 'constant.character.escape',
  };
  for (const [word, scope] of Object.entries(expected)) {
    assert.strictEqual(found[word], scope, word);
  }
});

test('scripts', async () => {
  const found = scopes(await grammar('source.modelica-script'), `clear
for i in 1:3 loop
  RunScript("a.mos")
end for`);
  const expected = {
    clear: 'support.function.command', for: 'keyword.control', RunScript: 'entity.name.function',
    '3': 'constant.numeric', loop: 'keyword.control',
  };
  for (const [word, scope] of Object.entries(expected)) {
    assert.strictEqual(found[word], scope, word);
  }
});
