"""Read the text of a slice as a whole: as it is written, or in normal form, without short forms; as plain data; and its line ends."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from archgen import schema
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode
from archgen.syntax.yaml_writer import PlainText

TreeReader = Callable[[str], MappingNode | None]
"""Reads a text as a whole; None where that cannot be done."""


# As many as are compared at a time in `merge-check`; nobody changes a tree that is read here.
@lru_cache(maxsize=32)
def read_tree(text: str) -> MappingNode | None:
    """Return what a text says as it is written, None where it cannot be read as a whole."""
    document, diagnostics = yaml_parser.parse_yaml("slice", text)
    # A duplicate key costs only itself, so that a document alone does not mean that everything was read.
    if document is None or any(diagnostic.rule != "swallowed-text" for diagnostic in diagnostics):
        return None
    return document.root


def read_normal_tree(text: str) -> MappingNode | None:
    """Return what a text says in normal form, None where it cannot be read as a whole or breaks the schema."""
    document, diagnostics = yaml_parser.parse_yaml("slice", text)
    if document is None or any(diagnostic.rule != "swallowed-text" for diagnostic in diagnostics):
        return None
    if schema.validate_document(document) or schema.normalise_document(document):
        return None
    return document.root


def convert_lines(text: str, line_end: str) -> str:
    """Return a text with other line ends."""
    return text.replace("\r\n", "\n").replace("\n", line_end)


def find_line_end(text: str) -> str:
    """Return how the lines of a text end."""
    return "\r\n" if "\r\n" in text else "\n"


def to_texts(node: YamlNode) -> Any:  # noqa: ANN401 - any value of the language
    """Return a value as it is written: `1.10` is not 1.1."""
    if isinstance(node, MappingNode):
        return {entry.key: to_texts(entry.value) for entry in node}
    if isinstance(node, SequenceNode):
        return [to_texts(item) for item in node.items]
    if not isinstance(node, ScalarNode) or node.value is None:
        return None
    return node.text if isinstance(node.value, str) else PlainText(node.text)
