"""A client of the language server over pipes: plain JSON, so that it may also send nonsense."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from tests.running import ROOT

_PATIENCE = 120.0


class Client:
    """A server in a process of its own; `with` ends it."""

    def __init__(self, folder: Path, encodings: tuple[str, ...] = ("utf-32", "utf-16")) -> None:
        """Start the server in a folder, and greet it."""
        self.folder = folder
        self.process = subprocess.Popen(
            [sys.executable, "-m", "archgen", "lsp"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
        )
        self.diagnostics: dict[str, dict[str, Any]] = {}
        """The last publication of each file, by its path from the folder."""
        self.log: list[str] = []
        self._messages: queue.Queue[dict[str, Any] | None] = queue.Queue()
        self._answers: dict[int, dict[str, Any]] = {}
        self._number = 0
        self._versions: dict[str, int] = {}
        self._texts: dict[str, str] = {}
        self._readers = [threading.Thread(target=each, daemon=True) for each in (self._read, self._read_log)]
        for reader in self._readers:
            reader.start()
        capabilities = {"general": {"positionEncodings": list(encodings)}}
        self.capabilities = self.request(
            "initialize", {"processId": None, "rootUri": folder.as_uri(), "capabilities": capabilities}
        )["capabilities"]
        self.notify("initialized", {})

    def __enter__(self) -> Self:
        """Return the client."""
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        """End the server."""
        try:
            if self.process.poll() is None and error is None:
                self.request("shutdown", None)
                self.notify("exit", None)
                assert self.process.wait(_PATIENCE) == 0
        finally:
            self.process.kill()
            for reader in self._readers:
                reader.join()
            self.process.wait()
            for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
                assert pipe is not None
                with contextlib.suppress(BrokenPipeError):
                    pipe.close()

    def uri(self, file: str) -> str:
        """Return the address of a file."""
        return (self.folder / file).as_uri()

    def send(self, message: object) -> None:
        """Send a message, whatever it is."""
        self.send_bytes(json.dumps(message).encode())

    def send_bytes(self, body: bytes) -> None:
        """Send the bytes of a message."""
        assert self.process.stdin is not None
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self.process.stdin.flush()

    def notify(self, method: str, params: object) -> None:
        """Send what asks for no answer."""
        self.send({"jsonrpc": "2.0", "method": method, "params": params})

    def ask(self, method: str, params: object) -> dict[str, Any]:
        """Send a request, and return the whole answer."""
        self._number += 1
        self.send({"jsonrpc": "2.0", "id": self._number, "method": method, "params": params})
        self.receive(lambda: self._number in self._answers)
        return self._answers.pop(self._number)

    def request(self, method: str, params: object) -> Any:  # noqa: ANN401 - whatever is answered
        """Send a request, and return its result."""
        answer = self.ask(method, params)
        assert "error" not in answer, answer
        return answer.get("result")

    def at(self, method: str, file: str, line: int, column: int, **more: object) -> Any:  # noqa: ANN401 - the same
        """Ask something of a place in a file; line and column count from 1, as archgen's do."""
        position = {"line": line - 1, "character": column - 1}
        return self.request(
            f"textDocument/{method}", {"textDocument": {"uri": self.uri(file)}, "position": position, **more}
        )

    def of(self, method: str, file: str, **more: object) -> Any:  # noqa: ANN401 - the same
        """Ask something of a file."""
        return self.request(f"textDocument/{method}", {"textDocument": {"uri": self.uri(file)}, **more})

    def write(self, file: str, text: str) -> None:
        """Open a file with a text, or change its text."""
        version = self._versions[file] = self._versions.get(file, 0) + 1
        is_open = file in self._texts
        self._texts[file] = text
        document = {"uri": self.uri(file), "version": version}
        if is_open:
            self.notify("textDocument/didChange", {"textDocument": document, "contentChanges": [{"text": text}]})
        else:
            self.notify("textDocument/didOpen", {"textDocument": {**document, "languageId": "yaml", "text": text}})

    def open(self, file: str) -> str:
        """Open a file as it is on the disk, and return its text."""
        text = (self.folder / file).read_text(encoding="utf-8")
        self.write(file, text)
        return text

    def close(self, file: str) -> None:
        """Close a file without saving."""
        del self._texts[file]
        self.notify("textDocument/didClose", {"textDocument": {"uri": self.uri(file)}})

    def wait_for(self, file: str) -> list[dict[str, Any]]:
        """Wait until something was published of the text of a file as it is, and return its findings."""
        self.receive(lambda: self.diagnostics.get(file, {}).get("version") == self._versions[file])
        return list(self.diagnostics[file]["diagnostics"])

    def wait_until(self, file: str, is_right: Callable[[list[dict[str, Any]]], bool]) -> list[dict[str, Any]]:
        """Wait until what is published of a file, of its text as it is where it is open, is right, and return it."""

        def is_done() -> bool:
            told = self.diagnostics.get(file, {})
            return (
                "diagnostics" in told
                and (file not in self._texts or told.get("version") == self._versions[file])
                and is_right(told["diagnostics"])
            )

        self.receive(is_done)
        return list(self.diagnostics[file]["diagnostics"])

    def rest(self, seconds: float = 2.3) -> None:
        """Take in what comes for a while: until then all phases of a check are over, if the machine is not slow."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                self._take(self._messages.get(timeout=left))
            except queue.Empty:
                return

    def receive(self, is_done: Callable[[], bool]) -> None:
        """Take in what comes until something is so."""
        end = time.monotonic() + _PATIENCE
        while not is_done():
            left = end - time.monotonic()
            assert left > 0, f"the server is silent: {self.log}"
            message = self._messages.get(timeout=left)
            assert message is not None, f"the server is gone: {self.log}"
            self._take(message)

    def _take(self, message: dict[str, Any] | None) -> None:
        if message is None:
            return
        if message.get("method") == "textDocument/publishDiagnostics":
            path = Path(message["params"]["uri"].removeprefix("file://"))
            self.diagnostics[os.path.relpath(path, self.folder)] = message["params"]
        elif "method" in message and "id" in message:
            self.send({"jsonrpc": "2.0", "id": message["id"], "result": None})
        elif message.get("id") is not None:
            self._answers[message["id"]] = message

    def _read(self) -> None:
        assert self.process.stdout is not None
        pipe = self.process.stdout
        while True:
            length = 0
            while (header := pipe.readline()) not in {b"\r\n", b""}:
                if header.lower().startswith(b"content-length:"):
                    length = int(header.split(b":")[1])
            if not length:
                self._messages.put(None)
                return
            self._messages.put(json.loads(pipe.read(length)))

    def _read_log(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.log.append(line.decode().rstrip())
