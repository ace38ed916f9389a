"""Firefox for tests: started without a window, and driven by its own protocol (Marionette), which needs no driver."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.outside_tools import find_tool

PATIENCE = 180
"""Seconds to wait for what must happen: many other tests may run at the same time."""
_SETTINGS = {
    "marionette.port": 0,  # any that is free; Firefox writes down which
    "devtools.console.stdout.content": True,
    "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "network.proxy.type": 0,
}


class Firefox:
    """A running Firefox with one page."""

    def __init__(self, connection: socket.socket, log: Path) -> None:
        self._connection, self._answers = connection, connection.makefile("rb")
        self._log = log
        self._number = 0
        self._receive()  # its greeting
        self.send("WebDriver:NewSession", capabilities={})
        self.send("WebDriver:SetTimeouts", pageLoad=PATIENCE * 1000, script=PATIENCE * 1000)

    def send(self, command: str, **parameters: object) -> Any:  # noqa: ANN401 - whatever Firefox answers
        """Send a command, and return what it answers."""
        self._number += 1
        message = json.dumps([0, self._number, command, parameters]).encode()
        self._connection.sendall(b"%d:%s" % (len(message), message))
        _, _, error, answer = self._receive()
        assert error is None, f"{command}: {error['message']}"
        return answer

    def _receive(self) -> Any:  # noqa: ANN401 - whatever Firefox answers
        length = b""
        while (digit := self._answers.read(1)) != b":":
            assert digit, "Firefox has ended"
            length += digit
        return json.loads(self._answers.read(int(length)))

    def open_page(self, address: str) -> None:
        """Open a page, and wait until it is loaded."""
        self.send("WebDriver:Navigate", url=address)

    def ask(self, expression: str) -> Any:  # noqa: ANN401 - any value of JavaScript
        """Return the value of an expression of JavaScript in the page."""
        return self.send("WebDriver:ExecuteScript", script=f"return {expression}", args=[])["value"]

    def wait_until(self, expression: str) -> None:
        """Wait until an expression is true in the page; after a link, in the next one."""
        end = time.monotonic() + PATIENCE
        while not self.ask(expression):
            assert time.monotonic() < end, f"never true: {expression}"
            time.sleep(0.05)

    def type_text(self, selector: str, text: str) -> None:
        """Type into the first element that a selector of CSS finds."""
        found = self.send("WebDriver:FindElement", using="css selector", value=selector)["value"]
        self.send("WebDriver:ElementSendKeys", id=next(iter(found.values())), text=text)

    def list_mistakes(self) -> list[str]:
        """Return the errors of the pages' scripts."""
        return [
            line for line in self._log.read_text(errors="replace").splitlines() if "JavaScript error: file:" in line
        ]


@contextmanager
def run_firefox(profile: Path) -> Iterator[Firefox]:
    """Start Firefox with a profile of its own, and stop it at the end."""
    profile.mkdir()
    lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in _SETTINGS.items()]
    (profile / "user.js").write_text("\n".join(lines))
    log = profile / "log.txt"
    words = [
        find_tool("firefox", "firefox-esr"),
        "--headless",
        "--marionette",
        "--no-remote",
        "--profile",
        str(profile),
    ]
    with log.open("wb") as output:
        process = subprocess.Popen(words, stdout=output, stderr=output, env={**os.environ, "HOME": str(profile)})  # noqa: S603
        try:
            port = _wait_for(lambda: _read_port(profile), process)
            with socket.create_connection(("127.0.0.1", port), PATIENCE) as connection:
                yield Firefox(connection, log)
        finally:
            process.kill()
            process.wait()


def _read_port(profile: Path) -> int | None:
    file = profile / "MarionetteActivePort"
    text = file.read_text() if file.exists() else ""
    return int(text) if text else None


def _wait_for(find: Callable[[], int | None], process: subprocess.Popen[bytes]) -> int:
    end = time.monotonic() + PATIENCE
    while (found := find()) is None:
        assert process.poll() is None, "Firefox has ended"
        assert time.monotonic() < end, "Firefox does not start"
        time.sleep(0.05)
    return found
