"""The JSON Schema itself: valid, explained throughout, and its examples hold."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any
from urllib.parse import quote

import jsonschema_rs
import pytest

from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.schema.language_schema import load_schema

SCHEMA = load_schema()


def parts(part: Any, path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:  # noqa: ANN401
    """Give every subschema that describes a value, with its place."""
    yield path, part
    for name, below in part.get("properties", {}).items():
        yield from parts(below, f"{path}/properties/{name}")
    for key in ("additionalProperties", "items", "propertyNames"):
        if isinstance(part.get(key), dict) and set(part[key]) != {"$ref"}:
            yield from parts(part[key], f"{path}/{key}")
    for name, below in part.get("$defs", {}).items():
        yield from parts(below, f"{path}/$defs/{name}")


def examples_of(part: dict[str, Any]) -> list[Any]:
    """Give the examples of a value: single values, and the bodies of snippets."""
    return [*part.get("examples", ()), *(snippet["body"] for snippet in part.get("defaultSnippets", ()))]


PARTS = dict(parts(SCHEMA))


def test_it_is_a_schema() -> None:
    jsonschema_rs.meta.validate(SCHEMA)


def test_everything_is_explained_and_every_example_holds() -> None:
    registry = jsonschema_rs.Registry([("schema:", SCHEMA)])
    faults = {path: list(_find_faults(path, registry)) for path in PARTS}
    assert {path: found for path, found in faults.items() if found} == {}
    assert len(faults) > 500


def _find_faults(path: str, registry: jsonschema_rs.Registry) -> Iterator[str]:
    part, examples = PARTS[path], examples_of(PARTS[path])
    if not part["title"]:
        yield "no title"
    if not part["description"].rstrip().endswith((".", "`", ")")):
        yield "a description that ends in the midst of a sentence"
    if not examples:
        yield "no example"
    validator = jsonschema_rs.Draft202012Validator({"$ref": f"schema:#{quote(path)}"}, registry=registry)
    yield from (error.message for example in examples for error in validator.iter_errors(example))


@pytest.mark.parametrize(
    ("key", "value", "fault"),
    [
        ("title", "", "no title"),
        ("description", "An id of", "a description that ends in the midst of a sentence"),
        ("examples", [], "no example"),
        ("examples", [{}], "{} is not of type"),
    ],
)
def test_what_is_not_explained_is_found(monkeypatch: pytest.MonkeyPatch, key: str, value: object, fault: str) -> None:
    path = next(path for path, part in PARTS.items() if part.get("examples") and part.get("type") == ["string", "null"])
    monkeypatch.delitem(PARTS[path], "defaultSnippets", raising=False)
    monkeypatch.setitem(PARTS[path], key, value)
    found = list(_find_faults(path, jsonschema_rs.Registry([("schema:", SCHEMA)])))
    assert found[0].startswith(fault)


def test_every_definition_is_used() -> None:
    text = repr(SCHEMA)
    assert [name for name in SCHEMA["$defs"] if f"'#/$defs/{name}'" not in text] == []


def test_nothing_is_required_and_every_value_may_be_left_empty() -> None:
    for path, part in PARTS.items():
        assert "required" not in part, path
        if "/properties/" in path and "$ref" not in part:
            assert "null" in part["type"], path


def test_what_a_pattern_refuses_is_explained() -> None:
    assert [path for path, part in PARTS.items() if "pattern" in part and "patternErrorMessage" not in part] == []


def test_no_example_is_a_list_or_a_mapping_which_editors_would_offer_as_object_object() -> None:
    assert [
        path for path, part in PARTS.items() if any(isinstance(e, list | dict) for e in part.get("examples", ()))
    ] == []


def test_no_example_is_a_name_of_the_case_study() -> None:
    examples = json.dumps([examples_of(part) for part in PARTS.values()]).lower()
    assert [word for word in ("ramcip", "certh", "sssa", "r-12", "rgbd", "grasp") if word in examples] == []


def test_every_distribution_that_init_knows_is_an_example() -> None:
    assert tuple(SCHEMA["$defs"]["ros"]["properties"]["distro"]["examples"]) == KNOWN_DISTROS
