"""A client of yaml-language-server, which is what VS Code, Neovim and Helix ask about YAML: real answers over stdio."""

from __future__ import annotations

import json
import queue
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.outside_tools import find_judge, find_tool

_TIMEOUT_SECONDS = 300


class LanguageServer:
    """A running server. Texts are opened under the addresses of files, which need not exist."""

    def __init__(self, process: subprocess.Popen[bytes], folder: Path) -> None:
        self._process = process
        self._folder = folder
        self._messages: queue.Queue[dict[str, Any]] = queue.Queue()
        self._problems: dict[str, list[str]] = {}
        self._number = 0
        self.settings: dict[str, Any] = {}
        self._reader = threading.Thread(target=self._read_messages, daemon=True)
        self._reader.start()

    def start(self, schemas: dict[str, Any]) -> None:
        """Tell it which schema is for which files, as an editor's settings do."""
        self.settings = {
            "yaml": {
                "schemas": schemas,
                "validate": True,
                "hover": True,
                "completion": True,
                "schemaStore": {"enable": False},
            },
            "http": {},
            "[yaml]": {},
            "editor": {},
            "files": {},
        }
        markdown = {"contentFormat": ["markdown"]}
        self.ask(
            "initialize",
            {
                "processId": None,
                "rootUri": self._folder.as_uri(),
                "workspaceFolders": [{"uri": self._folder.as_uri(), "name": "project"}],
                "capabilities": {
                    "workspace": {"configuration": True, "workspaceFolders": True},
                    "textDocument": {
                        "completion": {"completionItem": {"documentationFormat": ["markdown"], "snippetSupport": True}},
                        "hover": markdown,
                    },
                },
            },
        )
        self._send({"method": "initialized", "params": {}})
        self._send({"method": "workspace/didChangeConfiguration", "params": {"settings": self.settings}})
        # It reads its settings some time after it has answered.
        last_try = time.monotonic() + _TIMEOUT_SECONDS
        while schemas and not self.complete("wait.yaml", "|"):
            assert time.monotonic() < last_try, "the server offers nothing: it cannot read the schema"

    def open_text(self, name: str, text: str) -> str:
        """Open a text as a file of the project; give its address, which is a new one each time.

        Else what the server says late of a text that was closed would be taken for what it says of the next.
        """
        self._number += 1
        path = self._folder / name
        uri = path.with_stem(f"{path.stem}_{self._number}").as_uri()
        document = {"uri": uri, "languageId": "yaml", "version": 1, "text": text}
        self._send({"method": "textDocument/didOpen", "params": {"textDocument": document}})
        return uri

    def close_text(self, uri: str) -> None:
        """Close a text."""
        self._send({"method": "textDocument/didClose", "params": {"textDocument": {"uri": uri}}})

    def find_problems(self, name: str, text: str) -> list[str]:
        """Give what it says of a text: `line:column message`."""
        uri = self.open_text(name, text)
        while uri not in self._problems:
            self._take_message()
        self.close_text(uri)
        return self._problems.pop(uri)

    def complete(self, name: str, text: str) -> dict[str, dict[str, Any]]:
        """Give what it offers at `|` in a text, by label."""
        uri, position = self._open_at_cursor(name, text)
        answer = self.ask("textDocument/completion", {"textDocument": {"uri": uri}, "position": position})
        self.close_text(uri)
        return {item["label"]: item for item in (answer["items"] if isinstance(answer, dict) else answer or [])}

    def hover(self, name: str, text: str) -> str:
        """Give what it explains at `|` in a text."""
        uri, position = self._open_at_cursor(name, text)
        answer = self.ask("textDocument/hover", {"textDocument": {"uri": uri}, "position": position})
        self.close_text(uri)
        return str(answer["contents"]["value"]) if answer else ""

    def _open_at_cursor(self, name: str, text: str) -> tuple[str, dict[str, int]]:
        before, _, after = text.partition("|")
        position = {"line": before.count("\n"), "character": len(before.rpartition("\n")[2])}
        return self.open_text(name, before + after), position

    def ask(self, method: str, params: dict[str, Any]) -> Any:  # noqa: ANN401 - whatever it answers
        """Ask, and wait for the answer; what it asks meanwhile is answered."""
        self._number += 1
        number = self._number
        self._send({"id": number, "method": method, "params": params})
        while True:
            message = self._take_message()
            if message.get("id") == number and "method" not in message:
                assert "error" not in message, message
                return message["result"]

    def _take_message(self) -> dict[str, Any]:
        message = self._messages.get(timeout=_TIMEOUT_SECONDS)
        if message.get("method") == "textDocument/publishDiagnostics":
            self._problems[message["params"]["uri"]] = [
                f"{d['range']['start']['line'] + 1}:{d['range']['start']['character'] + 1} {d['message']}"
                for d in message["params"]["diagnostics"]
            ]
        elif "method" in message and "id" in message:
            is_configuration = message["method"] == "workspace/configuration"
            result = (
                [self.settings.get(item["section"]) for item in message["params"]["items"]]
                if is_configuration
                else None
            )
            self._send({"id": message["id"], "result": result})
        return message

    def _send(self, message: dict[str, Any]) -> None:
        assert self._process.stdin
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self._process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self._process.stdin.flush()

    def wait_for_end(self) -> None:
        """Wait until nothing is read any more: the stream is closed next, under the reader's hands otherwise."""
        self._reader.join()

    def _read_messages(self) -> None:
        stream = self._process.stdout
        assert stream
        while header := stream.readline():
            length = int(header.split(b":")[1])
            stream.readline()
            body = stream.read(length)
            if len(body) == length:  # less of it, where the server was ended
                self._messages.put(json.loads(body))


@contextmanager
def run_language_server(folder: Path, schemas: dict[str, Any]) -> Iterator[LanguageServer]:
    """Run the server with these schemas, by their path in the folder."""
    program = find_judge("yaml-language-server/bin/yaml-language-server")
    command = [find_tool("node"), str(program), "--stdio"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:  # noqa: S603 - a judge
        server = LanguageServer(process, folder)
        try:
            server.start(schemas)
            yield server
        finally:
            process.kill()
            server.wait_for_end()
