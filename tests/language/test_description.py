"""What is generated from the description of the language is fresh, and a description that forgets something is refused."""

from __future__ import annotations

import copy
import importlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tests.running import ROOT

_WRONG_ATTRIBUTE = (
    "host.cores: `attribute` is the field that holds it where that is called otherwise, or a list of fields"
)


@pytest.fixture(scope="module")
def import_tool() -> Iterator[Callable[[str], ModuleType]]:
    """Give a function that imports a module of `tools/`."""
    folder = str(ROOT / "tools")
    sys.path.insert(0, folder)
    yield importlib.import_module
    sys.path.remove(folder)


def test_generated_files_are_fresh(import_tool: Callable[[str], ModuleType]) -> None:
    for path, text in import_tool("make_language").make_files().items():
        assert path.read_text(encoding="utf-8") == text, "run `make language`"


@pytest.mark.parametrize(
    ("forget", "fault"),
    [
        (
            lambda d: d.types["tags"].pop("order"),
            "tags: it takes a list, and `order` does not say what its order means",
        ),
        (lambda d: d.types["tags"].update(order="any"), "tags: `order` is one of counts, free, gathered, headed"),
        (
            lambda d: d.kinds["component"]["keys"]["role"].pop("declares"),
            "component.role: `declares` says whether a file that says only this declares a component",
        ),
        (lambda d: d.kinds["host"]["keys"]["cores"].pop("says"), "host.cores: `says` is missing"),
        (
            lambda d: d.kinds["host"]["keys"]["cores"].update(type="cuont"),
            "host.cores: there is no type or kind `cuont`",
        ),
        (lambda d: d.types["hosts"].update(entries="hots"), "hosts: there is no type or kind `hots`"),
        (lambda d: d.types["count"].update(biggest=3), "count: `biggest` is no word of a part"),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute="cores"), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute=["core", "core"]), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute=[]), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute="Number of cores"), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(place=False), "host.cores: `place` is `true`, or left out"),
        (lambda d: d.types["count"].update(place=True), "count: `place` is a word of keys"),
        (lambda d: d.kinds["host"].update(attribute="computer"), "host: `attribute` is a word of keys"),
    ],
)
def test_what_is_forgotten_is_told(
    import_tool: Callable[[str], ModuleType], forget: Callable[[Any], object], fault: str
) -> None:
    tool = import_tool("language_description")
    description = copy.deepcopy(tool.load_description())
    assert list(tool.find_faults(description)) == []
    forget(description)
    assert fault in list(tool.find_faults(description))


def test_a_kind_in_two_files_is_refused(import_tool: Callable[[str], ModuleType], tmp_path: Path) -> None:
    tool = import_tool("language_description")
    for file in (ROOT / "language").glob("*.yaml"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    with (tmp_path / "ros.yaml").open("a", encoding="utf-8") as ros:
        ros.write("host: {title: Host, says: Twice., keys: {}}\n")
    with pytest.raises(tool.DescriptionError, match="the kind `host` stands in another file, too"):
        tool.load_description(tmp_path)
