"""The property set `archgen`, in which an export says what AADL has no word for: its texts are taken back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import unquote

from archgen.plugin.model import DIGITAL, MEDIUM_NAMES
from archgen.plugins.aadl.aadl_tree import AadlName, Path
from archgen.plugins.aadl.property_values import PropertyScope, read_count, read_first_text, read_texts

_COMPONENT_KEYS = ("title", "description", "functionality", "owner", "role")
_NODE_KEYS = {"package": "package_name", "executable": "executable_name"}
_PORT_KEYS = {"medium": "medium", "external": "external_end", "description": "description", "frame": "frame"}


def find_own_text(scope: PropertyScope, path: Path, key: str) -> str:
    """Return the text of a property of archgen's, or nothing."""
    return unquote(read_first_text(scope.value(path, f"archgen::{key}")))


def read_own_words(scope: PropertyScope, path: Path, words: Mapping[str, str]) -> dict[str, Any]:
    """Return the texts that are there, by the keys of these properties in the language."""
    return {key: text for key, word in words.items() if (text := find_own_text(scope, path, word))}


def find_own_texts(scope: PropertyScope, path: Path, key: str) -> dict[str, str]:
    """Return texts by the names that they begin with: `("drive: a.b, c.d")`."""
    texts = (unquote(text) for text in read_texts(scope.value(path, f"archgen::{key}")))
    return {name: text for name, separator, text in (text.partition(": ") for text in texts) if separator}


def find_own_count(scope: PropertyScope, path: Path, key: str) -> int | None:
    """Return a count, or None."""
    return read_count(scope.value(path, f"archgen::{key}"))


def is_marked(scope: PropertyScope, path: Path, key: str) -> bool:
    """Whether a boolean is true."""
    value = scope.value(path, f"archgen::{key}")
    return isinstance(value, AadlName) and value.name.lower() == "true"


def read_component_words(scope: PropertyScope) -> dict[str, Any]:
    """Return what archgen says of a component or group."""
    words = read_own_words(scope, (), {key: key for key in _COMPONENT_KEYS})
    tags = [unquote(text) for text in read_texts(scope.value((), "archgen::tags"))]
    return {**words, "tags": tags} if tags else words


def read_node_words(scope: PropertyScope) -> dict[str, Any]:
    """Return what archgen says of a node."""
    words = read_own_words(scope, (), {"title": "node_title"})
    kinds = [word for word in find_own_text(scope, (), "node_kind").split(", ") if word]
    if kinds:
        words["kind"] = kinds[0] if len(kinds) == 1 else kinds
    return words | read_own_words(scope, (), _NODE_KEYS)


def read_port_words(scope: PropertyScope, path: Path) -> dict[str, Any]:
    """Return what archgen says of a port."""
    words, said = read_own_words(scope, path, _PORT_KEYS), scope.find(path, "archgen::medium")
    if said and words.get("medium", DIGITAL) not in {*MEDIUM_NAMES, DIGITAL}:
        del words["medium"]
        scope.resolver.notes.add_contradiction("Medium", "this is no medium", said.span)
    return words
