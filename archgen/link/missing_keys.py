"""Find elements that lack what they mean nothing without, in all slices together."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.syntax.yaml_tree import MappingNode, SequenceNode

if TYPE_CHECKING:
    from collections.abc import Iterator

    from archgen.syntax.yaml_tree import YamlNode

_KeyPath = tuple[str, ...]
# By section, the paths without which an element means nothing. The schema cannot ask for them: in a single slice every
# key may be missing, because another file may write it.
_NEEDED_KEYS: dict[_KeyPath, tuple[_KeyPath, ...]] = {
    ("views",): (("show",),),
    ("review", "accepted"): (("reason",),),
}


_STEP_ENDS = ("from", "to")


def find_incomplete(root: MappingNode) -> Iterator[Diagnostic]:
    """Report elements that lack a key without which they mean nothing, in all slices together."""
    for section, needed_paths in _NEEDED_KEYS.items():
        section_node = _node_at(root, section)
        for entry in section_node if isinstance(section_node, MappingNode) else ():
            nodes = entry.value.items if isinstance(entry.value, SequenceNode) else (entry.value,)
            for path in needed_paths:
                if not all(_has_path(node, path) for node in nodes):
                    message = f"`{entry.key}` lacks `{'.'.join(path)}`"
                    yield Diagnostic(
                        "missing-key", message, entry.key_span, help=_MISSING_KEY_HELP[section[-1]], element=entry.key
                    )
    yield from _find_open_policies(root)
    yield from _find_open_steps(root)


def _find_open_policies(root: MappingNode) -> Iterator[Diagnostic]:
    """Report the policies that say neither what they forbid nor what they require, or only half of it."""
    policies = _node_at(root, ("policies",))
    for entry in policies if isinstance(policies, MappingNode) else ():
        requires = _has_path(entry.value, ("require",))
        parts = [("require", ("of", "inputs_from"))] if requires else []
        if not requires or _has_path(entry.value, ("forbid",)):
            parts.append(("forbid", ("from", "to")))
        for part, keys in parts:
            for key in keys:
                if not _has_path(entry.value, (part, key)):
                    message = f"`{entry.key}` lacks `{part}.{key}`"
                    yield Diagnostic(
                        "missing-key", message, entry.key_span, help=_MISSING_KEY_HELP[part], element=entry.key
                    )


def _find_open_steps(root: MappingNode) -> Iterator[Diagnostic]:
    """Report the steps of use cases that do not say where they begin or end."""
    use_cases = _node_at(root, ("use_cases",))
    for entry in use_cases if isinstance(use_cases, MappingNode) else ():
        steps = _node_at(entry.value, ("steps",))
        for number, step in enumerate(steps.items if isinstance(steps, SequenceNode) else (), 1):
            for key in _STEP_ENDS:
                if not _has_path(step, (key,)):
                    message = f"step {number} of `{entry.key}` lacks `{key}`"
                    help_line = "say between whom it happens: `{from: speech, to: dialogue, say: passes on the words}`"
                    yield Diagnostic("missing-key", message, step.span, help=help_line, element=entry.key)


_MISSING_KEY_HELP = {
    "views": 'say what the view shows: `show: "tag:safety"`',
    "require": "say who may take its inputs only from whom: "
    '`require: {of: "property:sil>=2", inputs_from: "property:sil>=2"}`',
    "forbid": "say which flow is forbidden: `forbid: {from: planning, to: motors}`",
    "accepted": "say why the change is right: `camera.image: {key: type, reason: the tracker moved to depth images}`",
}


def _has_path(node: YamlNode, path: _KeyPath) -> bool:
    return _node_at(node, path) is not None


def _node_at(node: YamlNode | None, path: _KeyPath) -> YamlNode | None:
    for key in path:
        node = node.get(key) if isinstance(node, MappingNode) else None
    return node
