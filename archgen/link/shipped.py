"""The type mapper that ships with archgen (ros_type_mapper.yaml), as one distribution has it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from archgen import resources
from archgen.model import quantity
from archgen.model.mapping import Type


@cache
def shipped_types(distro: str | None) -> Mapping[str, Type]:
    """Give the shipped types by their names, with the messages of a distribution.

    Reading them costs some milliseconds: ask only when the project uses a type that it does not map. Without a
    distribution, and for one that the file does not name, an entry's plain message counts.
    """
    found = dict[str, Type]()
    for name, entry in _entries().items():
        if distro in entry.get("without", ()):
            continue
        message = entry.get("distros", {}).get(distro, entry)["message"]
        size = quantity.parse(entry["size"], "size") if "size" in entry else None
        found[name] = Type(name, message, entry.get("comment"), size, origin="shipped")
    return MappingProxyType(found)


def _entries() -> dict[str, dict[str, Any]]:
    import yaml

    loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
    text = resources.path("ros_type_mapper.yaml").read_text(encoding="utf-8")
    types: dict[str, dict[str, Any]] = yaml.load(text, loader)["types"]  # noqa: S506  # the base loader makes only text
    return types
