"""Servers with a project open, one for all places that are asked for in it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.lsp.client import Client
from tests.running import ROOT

ASKED_FILES = (
    "archgen.yaml",
    "groups/robot_action_planner.yaml",
    "groups/robot_state.yaml",
    "hardware.yaml",
    "nodes/action.yaml",
    "nodes/devices.yaml",
    "ros_types.yaml",
    "timing.yaml",
    "use_cases.yaml",
    "variants.yaml",
)


class Workspace:
    """A copy of a project, open in an editor; a mark `|` in a snippet of a file is the cursor."""

    def __init__(self, client: Client) -> None:
        """Open nothing yet."""
        self.client = client
        self.texts: dict[str, str] = {}

    def read(self, file: str) -> str:
        """Return the text of a file, which is open from now on."""
        if file not in self.texts:
            self.texts[file] = self.client.open(file)
        return self.texts[file]

    def find(self, file: str, snippet: str) -> tuple[str, int, int]:
        """Return file, line and column of the mark in a snippet, which stands in the file once."""
        text, plain = self.read(file), snippet.replace("|", "", 1)
        assert text.count(plain) == 1, (file, plain, text.count(plain))
        before = text[: text.index(plain) + snippet.index("|")]
        return file, before.count("\n") + 1, len(before) - before.rfind("\n")

    def ask(self, method: str, file: str, snippet: str, **more: Any) -> Any:  # noqa: ANN401 - whatever is answered
        """Ask something of a place."""
        return self.client.at(method, *self.find(file, snippet), **more)

    def line_at(self, location: dict[str, object]) -> str:
        """Return the file and the text of the line where something is, from its word on."""
        path = Path(str(location["uri"]).removeprefix("file://"))
        start = location["range"]["start"]  # type: ignore[index]
        line = path.read_text(encoding="utf-8").split("\n")[start["line"]]
        return f"{path.relative_to(self.client.folder)}: {line[start['character'] :]}"


def open_workspace(name: str, folder: Path) -> Iterator[Workspace]:
    """Start a server for a copy of a project, and end it."""
    shutil.copytree(ROOT / name, folder / "p", ignore=shutil.ignore_patterns("archgen-out"))
    with Client((folder / "p").resolve()) as client:
        yield Workspace(client)
        assert client.log == []


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workspace]:
    """Open the case study, with the files that are asked about: one after the other would be checked as often."""
    for workspace in open_workspace("example_ramcip", tmp_path_factory.mktemp("robot")):
        for file in ASKED_FILES:
            workspace.read(file)
        yield workspace


@pytest.fixture(scope="module")
def arms(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workspace]:
    """Open an example of component types and their instances."""
    yield from open_workspace("examples/arm", tmp_path_factory.mktemp("arms"))
