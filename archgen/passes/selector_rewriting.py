"""Rewrite the selectors of views and policies where what they name is called otherwise now."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import evaluate_selector
from archgen.model.selector_keys import matches_wildcard
from archgen.model.selector_parser import parse_selector, split_selector
from archgen.passes.project_tree import ProjectTree, list_paths
from archgen.syntax.yaml_tree import MappingEntry, ScalarNode, YamlNode, change_at

_SELECTOR_PATHS = {
    "views": (("show",),),
    "policies": (("forbid", "from"), ("forbid", "to"), ("require", "of"), ("require", "inputs_from")),
}
"""Where views and policies have selectors."""
RenameWord = Callable[[str], Sequence[str] | None]
"""Returns what stands in the place of a path, or of a key with its value, in a selector; None where it stays."""


def rewrite_selectors(section: MappingEntry, rename_word: RenameWord) -> MappingEntry:
    """Return a section of views or policies with the words of its selectors renamed."""
    value = section.value
    for path in _SELECTOR_PATHS[section.key]:
        value = change_at(value, ("*", *path), lambda node: _rewrite_selector(node, rename_word))
    return section.with_value(value)


def rename_in_selectors(tree: ProjectTree, rename_word: RenameWord) -> None:
    """Rename words in all selectors of a tree."""
    for name in _SELECTOR_PATHS:
        section = tree.root.entries.get(name)
        rewritten = rewrite_selectors(section, rename_word) if section else None
        for path, node in list_paths(rewritten.value, (name,)) if rewritten else ():
            if isinstance(node, ScalarNode) and node is not tree.get(path):
                tree.set(path, node.text, path)


def rename_by_key(key: str, new_names: Collection[tuple[str, str]], known_names: Collection[str]) -> RenameWord:
    """Return what renames the values of a key: old names to new ones, `*` in them included.

    `known_names` are all that there are now: a word that still selects some of these stays beside the new ones.
    """
    prefix = f"{key}:"

    def rename(word: str) -> list[str] | None:
        if not word.startswith(prefix):
            return None
        value = " ".join(word.removeprefix(prefix).strip('"').split())
        names = dict.fromkeys(new for old, new in new_names if matches_wildcard(value, old))
        kept = [word] if any(matches_wildcard(value, each) for each in known_names) else []
        return [
            *kept,
            *(
                f'{prefix}"{name}"' if " " in name else f"{prefix}{name}"
                for name in names
                if not matches_wildcard(value, name)
            ),
        ]

    return rename


def list_selected(architecture: Architecture, word: str) -> list[str]:
    """Return the components that a word selects, in the order of the project."""
    selection, _ = evaluate_selector(word, architecture)
    return [each for each in architecture.components if each in selection.components]


def _rewrite_selector(node: YamlNode, rename_word: RenameWord) -> YamlNode:
    if not isinstance(node, ScalarNode) or node.value is None:
        return node
    words = list(split_selector(node.text))
    renamed_words = [_rewrite_word(word, rename_word) for word in words]
    text = " ".join(renamed_words)
    return node if renamed_words == words else ScalarNode(text, text, node.span)


def _rewrite_word(word: str, rename_word: RenameWord) -> str:
    parsed_words = parse_selector(word).words
    if len(parsed_words) != 1:
        return word
    first, last = parsed_words[0].atom, parsed_words[0].range_end
    before, after = word[: first.start], word[(last or first).end :]
    names = _rename_atom(word[first.start : first.end], rename_word)
    if last is not None:
        ends = _rename_atom(word[last.start : last.end], rename_word)
        names = [f"{name}..{end}" for name in names for end in ends]
    return " ".join(f"{before}{name}{after}" for name in names)


def _rename_atom(atom: str, rename_word: RenameWord) -> list[str]:
    return list(rename_word(atom) or (atom,))
