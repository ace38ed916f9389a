"""The JSON Schema itself: valid, explained throughout, and its examples hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import jsonschema_rs
import pytest

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


PARTS = dict(parts(SCHEMA))


def test_it_is_a_schema() -> None:
    jsonschema_rs.meta.validate(SCHEMA)


@pytest.mark.parametrize("path", PARTS)
def test_everything_is_explained_and_every_example_holds(path: str) -> None:
    part = PARTS[path]
    assert part["title"]
    assert part["description"].rstrip().endswith((".", "`", ")"))
    assert part["examples"]
    validator = jsonschema_rs.Draft202012Validator({**part, "$defs": SCHEMA["$defs"]})
    for example in part["examples"]:
        validator.validate(example)


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
