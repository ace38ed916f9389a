"""Load the type mapper that ships with archgen (ros_type_mapper.yaml), for one distribution."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from archgen import resources
from archgen.model import quantity
from archgen.model.message_types import ConceptualType


@cache
def load_shipped_types(distro: str | None) -> Mapping[str, ConceptualType]:
    """Return the shipped types by name, with the messages of a distribution; read once, and read-only.

    Without a distribution, and for one that an entry does not name, the entry's plain message counts.
    """
    types = dict[str, ConceptualType]()
    for name, entry in _read_entries().items():
        if distro in entry.get("without", ()):
            continue
        message = entry.get("distros", {}).get(distro, entry)["message"]
        size = quantity.parse_quantity(entry["size"], "size") if "size" in entry else None
        types[name] = ConceptualType(name, message, entry.get("comment"), size, origin="shipped")
    return MappingProxyType(types)


def _read_entries() -> dict[str, dict[str, Any]]:
    import yaml

    # Not archgen's own parser: the file ships with archgen, and no position in it is ever reported.
    loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
    text = resources.resource_path("ros_type_mapper.yaml").read_text(encoding="utf-8")
    types: dict[str, dict[str, Any]] = yaml.load(text, loader)["types"]  # noqa: S506  # the base loader makes only text
    return types
