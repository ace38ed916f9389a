"""The JSON Schema of the language."""

from __future__ import annotations

import functools
import json
from typing import Any

from archgen import resources


@functools.cache
def load_schema() -> dict[str, Any]:
    """Return the JSON Schema of the language. Cached and shared: nobody may change it."""
    text = resources.resource_path("schemas", "archgen.schema.json").read_text(encoding="utf-8")
    return json.loads(text)  # type: ignore[no-any-return]


def resolve_part(schema_part: dict[str, Any]) -> dict[str, Any]:
    """Return a part of the schema, or the definition that it refers to."""
    if "$ref" not in schema_part:
        return schema_part
    return load_schema()["$defs"][schema_part["$ref"].rpartition("/")[2]]  # type: ignore[no-any-return]
