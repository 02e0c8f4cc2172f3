"""The language server with a client that checks every message against the protocol (pytest-lsp):

GAPI=target/debug/gapi pytest tests/editors/test_pytest_lsp.py
"""

import os
from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

GAPI = os.environ.get("GAPI", "gapi")
DECAY = """\
model Decay "😀"
  parameter Real k(unit = "1/s") = 1;
  Real x(start = 1, fixed = true);
equation
  der(x) = -k*x;
end Decay;
"""


@pytest_lsp.fixture(
    params=["visual_studio_code", "neovim", "emacs"],
    config=ClientServerConfig(server_command=[GAPI, "lsp"]),
)
async def client(request, lsp_client: LanguageClient):
    """A server as an editor initializes it."""
    capabilities = client_capabilities(request.param)
    response = await lsp_client.initialize_session(
        types.InitializeParams(capabilities=capabilities, root_uri=None)
    )
    assert response.server_info.name == "gapi"
    yield
    await lsp_client.shutdown_session()


def open_document(client: LanguageClient, path: Path, text: str, language: str = "modelica") -> str:
    path.write_text(text, encoding="utf-8")
    uri = path.as_uri()
    document = types.TextDocumentItem(uri=uri, language_id=language, version=1, text=text)
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=document))
    return uri


def at(text: str, marked: str) -> types.Position:
    """The position of the mark `^`."""
    before, after = marked.split("^")
    offset = text.index(before + after) + len(before)
    line = text[:offset].rsplit("\n", 1)[-1]
    return types.Position(text[:offset].count("\n"), len(line.encode("utf-16-le")) // 2)


@pytest.mark.asyncio
async def test_diagnostics_and_actions(client: LanguageClient, tmp_path: Path):
    text = DECAY.replace("-k*x", "-kk*x")
    uri = open_document(client, tmp_path / "Decay.mo", text)
    await client.wait_for_notification("textDocument/publishDiagnostics")
    [found] = client.diagnostics[uri]
    assert (found.code, found.severity) == ("unknown-name", types.DiagnosticSeverity.Error)
    assert found.range == types.Range(at(text, "-^kk"), at(text, "-kk^*"))
    identifier = types.TextDocumentIdentifier(uri)
    context = types.CodeActionContext(diagnostics=[found])
    actions = await client.text_document_code_action_async(
        types.CodeActionParams(identifier, found.range, context)
    )
    assert "Declare `kk` as a Real parameter" in [action.title for action in actions]
    change = types.TextDocumentContentChangeWholeDocument(DECAY)
    client.text_document_did_change(
        types.DidChangeTextDocumentParams(types.VersionedTextDocumentIdentifier(version=2, uri=uri), [change])
    )
    await client.wait_for_notification("textDocument/publishDiagnostics")
    assert list(client.diagnostics[uri]) == []


@pytest.mark.asyncio
async def test_everything_about_a_name(client: LanguageClient, tmp_path: Path):
    uri = open_document(client, tmp_path / "Decay.mo", DECAY)
    identifier = types.TextDocumentIdentifier(uri)
    place = at(DECAY, "-^k*x")
    hover = await client.text_document_hover_async(types.HoverParams(identifier, place))
    assert "unit `1/s`" in hover.contents.value
    definition = await client.text_document_definition_async(types.DefinitionParams(identifier, place))
    assert definition.range.start == at(DECAY, "Real ^k(")
    context = types.ReferenceContext(include_declaration=False)
    references = await client.text_document_references_async(
        types.ReferenceParams(context, identifier, place)
    )
    assert [one.range.start for one in references] == [place]
    renamed = await client.text_document_rename_async(types.RenameParams(identifier, place, "rate"))
    changes = renamed.document_changes[0].edits if renamed.document_changes else renamed.changes[uri]
    assert [edit.new_text for edit in changes] == ["rate", "rate"]
    highlights = await client.text_document_document_highlight_async(
        types.DocumentHighlightParams(identifier, place)
    )
    assert len(highlights) == 2


@pytest.mark.asyncio
async def test_the_whole_document(client: LanguageClient, tmp_path: Path):
    text = DECAY.replace("  Real x", "Real   x")
    uri = open_document(client, tmp_path / "Decay.mo", text)
    identifier = types.TextDocumentIdentifier(uri)
    [symbol] = await client.text_document_document_symbol_async(types.DocumentSymbolParams(identifier))
    assert [child.name for child in symbol.children] == ["k", "x"]
    options = types.FormattingOptions(tab_size=2, insert_spaces=True)
    [edit] = await client.text_document_formatting_async(
        types.DocumentFormattingParams(identifier, options)
    )
    assert edit.new_text == "  Real x(start = 1, fixed = true);\n"
    tokens = await client.text_document_semantic_tokens_full_async(
        types.SemanticTokensParams(identifier)
    )
    assert len(tokens.data) % 5 == 0 and len(tokens.data) > 50
    whole = types.Range(types.Position(0, 0), types.Position(9, 0))
    [hint] = await client.text_document_inlay_hint_async(types.InlayHintParams(identifier, whole))
    assert (hint.label, hint.position) == ("1/s", at(text, "= 1^;"))
    items = await client.text_document_completion_async(
        types.CompletionParams(identifier, at(text, "  der^(x)"))
    )
    assert {"der", "k", "x"} <= {item.label for item in items}


@pytest.mark.asyncio
async def test_scripts(client: LanguageClient, tmp_path: Path):
    uri = open_document(client, tmp_path / "run.mos", 'simulateModl("Decay")\n', "modelica-script")
    await client.wait_for_notification("textDocument/publishDiagnostics")
    [found] = client.diagnostics[uri]
    assert found.code == "unknown-function"
    assert "did you mean `simulateModel`?" in found.message
