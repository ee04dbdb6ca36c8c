"""pytest-lsp against the server, as the editors that it has presets for."""

import asyncio
import json
import os
import random
import shutil
import subprocess
from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types as lsp
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

ROOT = Path(__file__).resolve().parents[3]
PLCLINT = os.environ["PLCLINT"]
FILE = "recettes.st"
PATIENCE = 60


@pytest.fixture
def folder(tmp_path):
    shutil.copytree(ROOT / "corpus/programs/recettes", tmp_path / "recettes")
    return tmp_path / "recettes"


def make_client() -> LanguageClient:
    """The client with the requests of the server that it does not know by itself."""
    client = pytest_lsp.make_test_lsp_client()
    for method in (
        lsp.CLIENT_REGISTER_CAPABILITY,
        lsp.WORKSPACE_CODE_LENS_REFRESH,
        lsp.WORKSPACE_INLAY_HINT_REFRESH,
        lsp.WORKSPACE_SEMANTIC_TOKENS_REFRESH,
    ):
        client.feature(method)(lambda *_: None)
    return client


@pytest_lsp.fixture(
    params=["visual_studio_code", "neovim", "emacs"],
    config=ClientServerConfig(server_command=[PLCLINT, "server"], client_factory=make_client),
)
async def client(lsp_client: LanguageClient, request, folder):
    uri = folder.as_uri()
    params = lsp.InitializeParams(
        capabilities=client_capabilities(request.param),
        root_uri=uri,
        workspace_folders=[lsp.WorkspaceFolder(uri=uri, name="recettes")],
    )
    lsp_client.folder = folder
    await lsp_client.initialize_session(params)
    yield
    await lsp_client.shutdown_session()


def checked(folder: Path, name: str = FILE) -> list[tuple[str, int]]:
    output = folder.parent / "findings.json"
    command = [PLCLINT, "check", str(folder), "--format", "json", "-o", str(output)]
    assert subprocess.run(command, capture_output=True).returncode in (0, 1)
    findings = json.loads(output.read_text())["findings"]
    path = str(folder / name)
    return sorted(
        (it["code"], it["start"]["line"])
        for it in findings
        if it["path"] == path and not it["suppressed"]
    )


def lines(diagnostics: list[lsp.Diagnostic]) -> list[tuple[str, int]]:
    # Columns are counted as each client wants it.
    return sorted((it.code, it.range.start.line + 1) for it in diagnostics)


def open_document(client: LanguageClient, name: str = FILE) -> tuple[str, str]:
    path = client.folder / name
    text = path.read_bytes().decode()
    item = lsp.TextDocumentItem(uri=path.as_uri(), language_id="plc", version=1, text=text)
    client.text_document_did_open(lsp.DidOpenTextDocumentParams(text_document=item))
    return path.as_uri(), text


async def findings(client: LanguageClient, uri: str, expected=None) -> list[lsp.Diagnostic]:
    """The findings of a document, once they are as expected: asked for where the client can, else as they are pushed."""
    pulls = client.capabilities.text_document.diagnostic is not None

    async def wait():
        while True:
            if pulls:
                identifier = lsp.TextDocumentIdentifier(uri=uri)
                params = lsp.DocumentDiagnosticParams(text_document=identifier)
                found = list((await client.text_document_diagnostic_async(params)).items)
            else:
                found = client.diagnostics.get(uri)
            if found is not None and (expected is None or lines(found) == expected):
                return list(found)
            await asyncio.sleep(0.02)

    return await asyncio.wait_for(wait(), PATIENCE)


def change(client: LanguageClient, uri: str, version: int, text: str):
    identifier = lsp.VersionedTextDocumentIdentifier(uri=uri, version=version)
    changes = [lsp.TextDocumentContentChangeWholeDocument(text=text)]
    client.text_document_did_change(
        lsp.DidChangeTextDocumentParams(text_document=identifier, content_changes=changes)
    )


def place(text: str, piece: str, within: int = 0) -> lsp.Position:
    before = text[: text.index(piece) + within].split("\n")
    return lsp.Position(line=len(before) - 1, character=len(before[-1]))


@pytest.mark.asyncio
async def test_findings_are_those_of_a_check(client: LanguageClient):
    uri, _ = open_document(client)
    expected = checked(client.folder)
    assert len(expected) > 10
    await findings(client, uri, expected)


@pytest.mark.asyncio
async def test_hover_and_definition(client: LanguageClient):
    uri, text = open_document(client)
    document = lsp.TextDocumentIdentifier(uri=uri)
    position = place(text, "%MB100:8", 2)
    hover = await client.text_document_hover_async(lsp.HoverParams(text_document=document, position=position))
    assert "%MB100:8" in hover.contents.value
    symbols = await client.text_document_document_symbol_async(lsp.DocumentSymbolParams(text_document=document))
    assert symbols
    references = await client.text_document_references_async(
        lsp.ReferenceParams(
            text_document=document, position=position, context=lsp.ReferenceContext(include_declaration=True)
        )
    )
    assert references


@pytest.mark.asyncio
async def test_a_quick_fix_mends_its_finding(client: LanguageClient):
    uri, text = open_document(client)
    before = await findings(client, uri, checked(client.folder))
    at = place(text, "%MW5:=0 THEN", 5)
    actions = await client.text_document_code_action_async(
        lsp.CodeActionParams(
            text_document=lsp.TextDocumentIdentifier(uri=uri),
            range=lsp.Range(start=at, end=at),
            context=lsp.CodeActionContext(diagnostics=before, only=[lsp.CodeActionKind.QuickFix]),
        )
    )
    action = next(it for it in actions if it.title == "Write `=`")
    if action.edit.document_changes:
        [edit] = action.edit.document_changes[0].edits
    else:
        [edit] = action.edit.changes[uri]
    assert edit.new_text == "="
    fixed = text.replace("%MW5:=0 THEN", "%MW5=0 THEN")
    change(client, uri, 2, fixed)
    (client.folder / FILE).write_bytes(fixed.encode())
    await findings(client, uri, checked(client.folder))


@pytest.mark.asyncio
async def test_memory_does_not_grow_with_edits(client: LanguageClient):
    """After as many edits more, the process holds about what it held after the first ones."""
    if client.capabilities.text_document.diagnostic is None:
        pytest.skip("one client is enough")
    uri, text = open_document(client)
    pieces = ["\n", "SET %M1;\n", "%L20: ", "(*", "*)", "IF ", "! "]
    numbers = random.Random(4)

    async def edit(count: int, version: int):
        for n in range(count):
            at = numbers.randrange(len(text))
            change(client, uri, version + n, text[:at] + numbers.choice(pieces) + text[at:])
            if n % 20 == 0:
                document = lsp.TextDocumentIdentifier(uri=uri)
                await client.text_document_folding_range_async(lsp.FoldingRangeParams(text_document=document))
        change(client, uri, version + count, text)
        await findings(client, uri, checked(client.folder))

    def resident() -> int:
        pages = Path(f"/proc/{client._server.pid}/statm").read_text().split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE")

    await edit(300, 2)
    before = resident()
    await edit(300, 2000)
    after = resident()
    assert after < before * 1.25 + (16 << 20), f"{before >> 20} MB, then {after >> 20} MB"
