"""The elements of a UML model as plain data, and ids that no two of them share."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from archgen.plugin.generating import make_id

UmlTree = dict[str, Any]
"""An element: `tag`, `attributes` as pairs, `text`, `children`."""
OWN_PREFIX = "archgen."
TYPE_PREFIX = "type_."
"""What paths in component types begin with. No id ends so: a group may be called `type`."""
_USABLE_ID = re.compile(r"[^\s#<>&\"']{1,200}\Z")


def make_tree(tag: str, kind: str = "", element_id: str = "", name: str = "", **attributes: str | None) -> UmlTree:
    """Return an element. Attributes that are None are left out."""
    written = {"xmi:type": f"uml:{kind}" if kind else None, "xmi:id": element_id or None, "name": name or None}
    pairs = [[key, value] for key, value in {**written, **attributes}.items() if value is not None]
    return {"tag": tag, "attributes": pairs, "text": "", "children": []}


def make_text(tag: str, text: str) -> UmlTree:
    """Return an element that holds text alone."""
    return make_tree(tag) | {"text": text}


class IdRegistry:
    """Gives out ids. What came from a UML tool keeps the id that it has there."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def claim(self, wanted_id: str, hints: object = None) -> str:
        """Return a free id: that of the hints, else the wanted one behind archgen's own prefix."""
        kept = read_hints(hints).get("id")
        element_id = kept if isinstance(kept, str) and _USABLE_ID.match(kept) else f"{OWN_PREFIX}{wanted_id}"
        if element_id in self._taken and element_id == kept:
            element_id = f"{OWN_PREFIX}{wanted_id}"
        number = 2
        free_id = element_id
        while free_id in self._taken:
            free_id = f"{element_id}.{number}"
            number += 1
        self._taken.add(free_id)
        return free_id


def read_hints(hints: object) -> Mapping[str, Any]:
    """Return what the hints of an element say for UML."""
    own = hints.get("uml") if isinstance(hints, Mapping) else None
    return own if isinstance(own, Mapping) else {}


def list_names(hints: Mapping[str, Any], key: str) -> list[str]:
    """Return the names that an import kept below a key: a single one, or a list."""
    kept = hints.get(key)
    return [kept] if isinstance(kept, str) else [str(each) for each in kept] if isinstance(kept, list) else []


def read_mapping(value: object) -> Mapping[str, Any]:
    """Return a mapping of the packed project; an empty one for what is none."""
    return value if isinstance(value, Mapping) else {}


def make_id_word(name: str) -> str:
    """Return a word for an id made of any text."""
    return make_id(name, "x")


def make_comments(element_id: str, body: Mapping[str, Any]) -> list[UmlTree]:
    """Return the texts of an element as comments; the id says which is which."""
    comments = []
    for key in ("functionality", "description", "comment"):
        if text := body.get(key):
            comment = make_tree("ownedComment", "Comment", f"{element_id}.{key}", annotatedElement=element_id)
            comment["children"].append(make_text("body", str(text)))
            comments.append(comment)
    return comments
