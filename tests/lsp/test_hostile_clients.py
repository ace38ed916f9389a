"""Nonsense is answered or left alone, and the next request works."""

from __future__ import annotations

import random
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.lsp.client import Client
from tests.running import ROOT

SMALL = "archgen: 1\ngroups: {g: {title: G, components: {a: {outputs: {o: std_msgs/msg/Bool}}}}}\n"
REQUESTS = (
    *("definition", "references", "hover", "completion", "documentHighlight", "prepareRename", "prepareCallHierarchy"),
    "rename",
)
CONTEXTS: dict[str, dict[str, Any]] = {"references": {"context": {"includeDeclaration": True}}}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Write a small project."""
    (tmp_path / "archgen.yaml").write_text(SMALL, encoding="utf-8")
    return tmp_path.resolve()


def still_works(client: Client) -> bool:
    """Whether a request is answered as it should be."""
    client.write("archgen.yaml", SMALL)
    return "**group** `g`" in client.at("hover", "archgen.yaml", 2, 10)["contents"]["value"]


@pytest.mark.slow
def test_positions_beyond_the_text_are_answered(folder: Path) -> None:
    with Client(folder) as client:
        client.open("archgen.yaml")
        for method in REQUESTS:
            for line, character in ((0, 10_000), (10_000, 0), (2**31 - 1, 2**31 - 1)):
                place = {
                    "textDocument": {"uri": client.uri("archgen.yaml")},
                    "position": {"line": line, "character": character},
                    "newName": "b",
                } | CONTEXTS.get(method, {})
                assert "id" in client.ask(f"textDocument/{method}", place)
        assert still_works(client)


@pytest.mark.slow
def test_messages_that_are_none_are_answered_or_left_alone(folder: Path) -> None:
    with Client(folder) as client:
        client.open("archgen.yaml")
        for body in (b"{", b"[]", b"null", b'"a"', b"\xff\xfe", b"{}", b'{"jsonrpc": "1.0", "method": "x"}'):
            client.send_bytes(body)
        client.notify("textDocument/didChange", {"no": "sense"})
        client.notify("no/such/thing", [1, 2])
        client.notify("$/cancelRequest", {"id": 12345})
        client.send({"jsonrpc": "2.0", "id": 99, "result": {}})
        assert "error" in client.ask("no/such/request", {})
        assert "error" in client.ask("textDocument/hover", {"textDocument": 3, "position": "here"})
        assert "error" in client.ask("workspace/executeCommand", {"command": "rm"})
        assert still_works(client)


def test_files_that_are_none_of_a_project_are_left_alone(
    folder: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    outside = tmp_path_factory.mktemp("outside") / "other.yaml"
    outside.write_text("a: {", encoding="utf-8")
    with Client(folder) as client:
        client.open("archgen.yaml")
        for uri in (
            outside.as_uri(),
            "untitled:Untitled-1",
            "http://example.org/a.yaml",
            "file:///",
            "nonsense",
            "file:///a%00b",
        ):
            document = {"uri": uri, "languageId": "yaml", "version": 1, "text": "groups: ["}
            client.notify("textDocument/didOpen", {"textDocument": document})
            position = {"line": 0, "character": 3}
            answer = client.ask("textDocument/hover", {"textDocument": {"uri": uri}, "position": position})
            assert answer.get("result") is None
            client.notify("textDocument/didClose", {"textDocument": {"uri": uri}})
        assert still_works(client)


def test_a_project_that_vanishes_is_said_to(folder: Path) -> None:
    with Client(folder) as client:
        client.open("archgen.yaml")
        client.wait_for("archgen.yaml")
        (folder / "archgen.yaml").unlink()
        client.write("archgen.yaml", f"{SMALL}# more\n")
        (told,) = client.wait_until("archgen.yaml", lambda found: len(found) == 1)
        assert "archgen.yaml" in told["message"]
        (folder / "archgen.yaml").write_text(SMALL, encoding="utf-8")
        assert still_works(client)


def test_a_file_that_turns_into_a_folder_or_a_link_is_read_as_it_is(folder: Path) -> None:
    other = folder / "other.yaml"
    other.write_text("nodes: {n: {implements: a}}\n", encoding="utf-8")
    with Client(folder) as client:
        client.open("archgen.yaml")
        client.open("other.yaml")
        client.wait_for("other.yaml")
        other.unlink()
        other.mkdir()
        client.write("other.yaml", "nodes: {n: {implements: b}}\n")
        client.rest(1)
        client.close("other.yaml")
        other.rmdir()
        other.symlink_to("/etc/passwd")
        client.open("archgen.yaml")
        client.rest(1)
        assert still_works(client)


@pytest.mark.slow
def test_large_and_odd_texts_are_answered(folder: Path) -> None:
    texts = [
        "a" * 5_000_000,
        "x: &a [1]\n" + "".join(f"y{number}: *a\n" for number in range(1000)),
        f"views: {{v: {{show: '{'a ' * 50_000}'}}}}\n",
        "groups: {g: {title: 🤖🤖}}\r\n# \u2028 \x85\r\n\ufeff",
        "[" * 10_000,
        "\ud800\n",
        "groups:\r  g:\r    title: G\r",
    ]
    with Client(folder) as client:
        client.open("archgen.yaml")
        for text in texts:
            client.write("odd.yaml", text)
            client.wait_for("odd.yaml")
            for method in ("documentSymbol", "foldingRange", "codeLens"):
                assert "result" in client.ask(
                    f"textDocument/{method}", {"textDocument": {"uri": client.uri("odd.yaml")}}
                )
            client.at("completion", "odd.yaml", 1, 2)
        client.close("odd.yaml")
        assert still_works(client)


def test_a_client_that_goes_away_leaves_no_server(folder: Path) -> None:
    client = Client(folder)
    client.open("archgen.yaml")
    assert client.process.stdin is not None
    client.process.stdin.close()
    assert client.process.wait(30) == 0
    for reader in client._readers:  # noqa: SLF001 - what `with` would do
        reader.join()
    for pipe in (client.process.stdout, client.process.stderr):
        assert pipe is not None
        pipe.close()


@pytest.mark.parametrize("name", [pytest.param("example_ramcip", marks=pytest.mark.slow), "examples/cleaning_robot"])
def test_random_requests_during_random_edits_are_answered(tmp_path: Path, name: str) -> None:
    folder = (tmp_path / "p").resolve()
    shutil.copytree(ROOT / name, folder, ignore=shutil.ignore_patterns("archgen-out"))
    chance = random.Random(name)  # noqa: S311 - the same each time
    files = [str(path.relative_to(folder)) for path in sorted(folder.rglob("*.yaml"))][:6]
    with Client(folder) as client:
        texts = {file: client.open(file) for file in files}
        for _ in range(25):
            file = chance.choice(files)
            text = texts[file]
            at, length = chance.randrange(len(text) + 1), chance.choice((0, 1, 5, 80))
            text = text[:at] + chance.choice(("", " ", ":", "{", "\n", "- a: ", "🤖", "#")) + text[at + length :]
            texts[file] = text
            client.write(file, text)
            method = chance.choice((*REQUESTS, "documentSymbol", "foldingRange", "codeLens", "semanticTokens/full"))
            line = chance.randrange(text.count("\n") + 2)
            answer = client.ask(
                f"textDocument/{method}",
                {
                    "textDocument": {"uri": client.uri(file)},
                    "position": {"line": line, "character": chance.randrange(90)},
                    "newName": chance.choice(("robot", "x_1", "A b")),
                }
                | CONTEXTS.get(method, {}),
            )
            # A rename may be refused; nothing fails.
            assert "result" in answer or answer["error"]["code"] == -32803, (method, answer, client.log)
        assert [line for line in client.log if "failed" in line or "Exception" in line] == []
