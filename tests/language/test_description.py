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
import yaml

from tests.running import ROOT

Description = Any
"""A class of `tools/`, which are no package."""
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


@pytest.fixture(scope="module")
def shipped_description(import_tool: Callable[[str], ModuleType]) -> Description:
    return import_tool("language_description").load_description()


@pytest.fixture
def description(shipped_description: Description) -> Description:
    """Give a description to spoil."""
    return copy.deepcopy(shipped_description)


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
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute="cores"), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute=["core", "core"]), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute=[]), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(attribute="Number of cores"), _WRONG_ATTRIBUTE),
        (lambda d: d.kinds["host"]["keys"]["cores"].update(place=False), "host.cores: `place` is `true`, or left out"),
        (lambda d: d.types["count"].update(place=True), "count: `place` is a word of keys"),
        (lambda d: d.kinds["host"].update(attribute="computer"), "host: `attribute` is a word of keys"),
        (
            lambda d: d.other_words["host"].update(cpus="core"),
            "other_words.yaml: there is no key `host.core`",
        ),
        (
            lambda d: d.other_words["host"].update(title="cores"),
            "other_words.yaml: `title` is a key of host itself",
        ),
    ],
)
def test_what_is_forgotten_is_told(
    import_tool: Callable[[str], ModuleType], description: Description, forget: Callable[[Any], object], fault: str
) -> None:
    tool = import_tool("language_description")
    assert list(tool.find_faults(description)) == []
    forget(description)
    assert fault in list(tool.find_faults(description))


@pytest.mark.parametrize(
    ("forget", "fault"),
    [
        (
            lambda d: d.kinds["host"].pop("effect"),
            "host: `effect` says how far a change of such an element reaches",
        ),
        (
            lambda d: d.kinds["start"].pop("effect"),
            "node.start: `effect` says how far a change reaches, or `told` where it is told",
        ),
        (lambda d: d.types["tags"].update(effect="little"), "tags: `effect` is one of system, text, timing"),
        (lambda d: d.common["host"].update(worse="other"), "node.host: `worse` is one of always, less, more"),
        (
            lambda d: d.kinds["host"]["keys"]["cores"].update(names="hots"),
            "host.cores: `names` is a kind, and there is no `hots`",
        ),
        (
            lambda d: d.types["tags"].update(verbs=["now has"]),
            "tags: `verbs` are two, for what is added and for what is removed",
        ),
    ],
)
def test_what_a_comparison_cannot_do_without_is_told(
    import_tool: Callable[[str], ModuleType], description: Description, forget: Callable[[Any], object], fault: str
) -> None:
    find_faults = import_tool("language_comparison").find_comparison_faults
    assert list(find_faults(description)) == []
    forget(description)
    assert fault in list(find_faults(description))


@pytest.mark.parametrize(
    ("said", "facts"),
    [
        ("{type: count, says: S}", {"cells": {}}),
        ("{type: text, says: S}", {"cells": {"effect": "system"}}),
        ("{type: prose, says: S}", {"cells": {"form": "prose", "effect": "text"}}),
        ("{type: flag, says: S, effect: text}", {"cells": {"form": "flag", "effect": "text"}}),
        ("{type: id, says: S, offers: hosts}", {"cells": {"names": "host"}}),
        ("{type: tags, says: S, noun: n}", {"cells": {"form": "set", "noun": "n", "effect": "text"}}),
        ("{type: urls, says: S}", {"cells.": {"form": "mapping", "effect": "text"}}),
        ("{type: start, says: S}", {"cells.": {"inner": "start", "effect": "system"}}),
        ("{type: operations, says: S}", {"cells.": {"form": "entries", "effect": "system"}}),
        (
            "{type: performance, says: S, effect: system}",
            {"cells.": {"form": "entries", "inner": "indicator", "effect": "system"}},
        ),
        ("{type: count, says: S, told: elsewhere}", {}),
    ],
)
def test_a_new_key_says_nothing_that_its_type_says(
    import_tool: Callable[[str], ModuleType], description: Description, said: str, facts: dict[str, dict[str, str]]
) -> None:
    comparison = import_tool("language_comparison")
    before = comparison.list_key_facts(description, "host")
    description.kinds["host"]["keys"]["cells"] = yaml.safe_load(said)
    rows = comparison.list_key_facts(description, "host")
    new_rows = {name: row for name, row in rows.items() if name not in before}
    assert {name: {word: row[word] for word in row if word != "verbs"} for name, row in new_rows.items()} == facts


def test_a_kind_in_two_files_is_refused(import_tool: Callable[[str], ModuleType], tmp_path: Path) -> None:
    tool = import_tool("language_description")
    for file in (ROOT / "language").glob("*.yaml"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    with (tmp_path / "ros.yaml").open("a", encoding="utf-8") as ros:
        ros.write("host: {title: Host, says: Twice., keys: {}}\n")
    with pytest.raises(tool.DescriptionError, match="the kind `host` stands in another file, too"):
        tool.load_description(tmp_path)


def test_a_word_of_elsewhere_means_one_key(import_tool: Callable[[str], ModuleType], tmp_path: Path) -> None:
    tool = import_tool("language_description")
    for file in (ROOT / "language").glob("*.yaml"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / "other_words.yaml").write_text("host: {cores: cpus, address: ip cpus}\n", encoding="utf-8")
    with pytest.raises(tool.DescriptionError, match="host: a word stands at two keys"):
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
    import_tool: Callable[[str], ModuleType], description: Description, spoil: Callable[[Any], object], fault: str
) -> None:
    tool = import_tool("language_record")
    record = tool.load_record(description)
    spoil(record.own["parts"])
    assert list(tool.find_faults(record)) == [f"record.yaml: {fault}"]


def test_a_key_is_in_the_record_unless_it_says_why_not(
    import_tool: Callable[[str], ModuleType], description: Description
) -> None:
    tool = import_tool("language_record")
    description.kinds["host"]["keys"]["voltage"] = {"type": "text", "says": "What it runs on."}
    record = tool.load_record(description)
    assert list(record.keys_of("host")) == [
        "title",
        "description",
        "cores",
        "tags",
        "scheduling",
        "address",
        "discovery_server",
        "environment",
        "properties",
        "hints",
        "voltage",
    ]
    description.kinds["host"]["keys"]["voltage"]["unrecorded"] = "a secret"
    assert "voltage" not in record.keys_of("host")
