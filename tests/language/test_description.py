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
        (
            lambda d: d.types["flag"].pop("example"),
            "node.reentrant: neither the key nor its type has an `example` or a `snippet`",
        ),
        (lambda d: d.types["hosts"].update(entries="hots"), "hosts: there is no type or kind `hots`"),
        (lambda d: d.types["count"].update(biggest=3), "count: `biggest` is no word of a part"),
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


@pytest.mark.parametrize(
    ("spoil", "fault"),
    [
        (lambda own: own["host"]["order"].append("colour"), "host: there is no key `colour`"),
        (lambda own: own["channel"]["without"].update(none=["colour"]), "channel: there is no key `colour`"),
        (lambda own: own.update(hots={"says": "Twice."}), "nothing names `hots`"),
        (lambda own: own["host"].update(odd=1), "host: `odd` is no word of a part"),
        (lambda own: own["chain"]["keys"]["through"].update(odd=1), "chain.through: `odd` is no word of a part"),
        (
            lambda own: own["chain"]["keys"].update(colour={"says": "Red."}),
            "chain.colour: no key of the language, and nothing says what stands there",
        ),
    ],
)
def test_what_is_wrong_about_the_record_is_told(
    import_tool: Callable[[str], ModuleType], spoil: Callable[[Any], object], fault: str
) -> None:
    tool = import_tool("language_record")
    record = copy.deepcopy(tool.load_record(import_tool("language_description").load_description()))
    spoil(record.own["parts"])
    assert list(tool.find_faults(record)) == [f"record.yaml: {fault}"]


def test_a_key_is_in_the_record_unless_it_says_why_not(import_tool: Callable[[str], ModuleType]) -> None:
    tool = import_tool("language_record")
    description = copy.deepcopy(import_tool("language_description").load_description())
    description.kinds["host"]["keys"]["voltage"] = {"type": "text", "says": "What it runs on."}
    record = tool.load_record(description)
    assert list(record.keys_of("host")) == [
        "title",
        "description",
        "cores",
        "tags",
        "scheduling",
        "properties",
        "hints",
        "voltage",
    ]
    description.kinds["host"]["keys"]["voltage"]["unrecorded"] = "a secret"
    assert "voltage" not in record.keys_of("host")
