"""Rewrite the selectors of views and policies where what they name is called otherwise now."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence

from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import evaluate_selector
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, YamlNode

_SELECTOR_KEYS = {"views": frozenset({"show"}), "policies": frozenset({"forbid", "require"})}
_WORD = re.compile(r"(-?(?:[0-9]*\+)?)([^+\s\"]+?)(\+[0-9]*)?\Z")
RenameWord = Callable[[str], Sequence[str] | None]
"""Returns what stands in the place of a word without its steps; None where it stays."""


def rewrite_selectors(section: MappingEntry, rename_word: RenameWord) -> MappingEntry:
    """Return a section of views or policies with the words of its selectors renamed."""
    value = _rewrite_node(section.value, rename_word, _SELECTOR_KEYS[section.key], is_selector=False)
    return MappingEntry(section.key, section.key_span, value)


def list_selected(architecture: Architecture, word: str) -> list[str]:
    """Return the components that a word selects, in the order of the project."""
    selection, _ = evaluate_selector(word, architecture)
    return [each for each in architecture.components if each in selection.components]


def _rewrite_node(node: YamlNode, rename_word: RenameWord, keys: Collection[str], *, is_selector: bool) -> YamlNode:
    if isinstance(node, MappingNode):
        entries = {
            e.key: MappingEntry(
                e.key,
                e.key_span,
                _rewrite_node(e.value, rename_word, keys, is_selector=is_selector or e.key in keys),
            )
            for e in node
        }
        return MappingNode(entries, node.span)
    if not is_selector or not isinstance(node, ScalarNode) or node.value is None:
        return node
    text = " ".join(_rewrite_word(word, rename_word) for word in node.text.split(" "))
    return node if text == node.text else ScalarNode(text, text, node.span)


def _rewrite_word(word: str, rename_word: RenameWord) -> str:
    match = _WORD.match(word)
    names = rename_word(match[2]) if match else None
    if match is None or not names:
        return word
    return " ".join(f"{match[1]}{name}{match[3] or ''}" for name in names)
