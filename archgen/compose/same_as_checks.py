"""What a reference (`same_as`) may say: it is its type exactly, and has only a place and a name of its own."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

_OWN_KEYS = frozenset({"same_as", "is", "title", "owner", "layout", "from", "inputs", "node"})
_OWN_INPUT_KEYS = frozenset({"from", "external"})
_OWN_NODE_KEYS = frozenset({"host", "namespace", "start"})


def find_same_as_changes(body: MappingNode, component_id: str, type_name: str) -> list[Diagnostic]:
    """Return what a reference says that its type decides."""
    changed = [entry for entry in body if entry.key not in _OWN_KEYS]
    inputs, node = body.get("inputs"), body.get("node")
    for port in inputs if isinstance(inputs, MappingNode) else ():
        changed += (
            [e for e in port.value if e.key not in _OWN_INPUT_KEYS] if isinstance(port.value, MappingNode) else []
        )
    changed += [e for e in node if e.key not in _OWN_NODE_KEYS] if isinstance(node, MappingNode) else []
    return [_diagnose_change(entry, component_id, type_name) for entry in changed]


def _diagnose_change(entry: MappingEntry, component_id: str, type_name: str) -> Diagnostic:
    return Diagnostic(
        "changed-reference",
        f"`{component_id}` is the same as `{type_name}`, which decides its `{entry.key}`",
        entry.key_span,
        help=f"write `is: {type_name}` instead of `same_as` if this one differs, or change the type",
        element=component_id,
    )
