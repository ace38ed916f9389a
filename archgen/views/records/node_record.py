"""Nodes in the resolved record."""

from __future__ import annotations

from archgen.model.node import Node
from archgen.views.lookup import Lookup
from archgen.views.records.carrier_record import record_endpoints
from archgen.views.records.parameter_record import record_effective
from archgen.views.records.record_values import drop_unknown, record_annotations, to_plain
from archgen.views.records.start_record import record_start
from archgen.views.records.timing_record import record_timing


def record_node(lookup: Lookup, node: Node) -> dict[str, object]:
    """Return what is known of a node; `derived` marks one that no file declares."""
    field_names = (
        "title",
        "description",
        "owner",
        "name",
        "namespace",
        "package",
        "executable",
        "plugin",
        "language",
        "container",
        "host",
        "threads",
        "scheduling",
        "status",
    )
    return drop_unknown(
        {
            **{key: getattr(node, key) for key in field_names},
            "full_name": node.full_name,
            "kind": list(node.kinds),
            "command": list(node.command),
            "arguments": list(node.arguments),
            "remaps": dict(node.remaps),
            "start": record_start(node.start),
            "co_owners": list(node.co_owners),
            "implements": list(node.implements),
            "callback_groups": {name: list(members) for name, members in node.callback_groups.items()},
            "reentrant": node.reentrant or None,
            "derived": None if node.written else True,
            "endpoints": record_endpoints(lookup, node.id),
            # The key is "" for a node that implements no component; the record calls it "node".
            "timing": drop_unknown(
                {component or "node": record_timing(timing) for component, timing in node.timing.items()}
            ),
            "parameters": to_plain(node.parameters),
            "parameter_files": list(node.parameter_files),
            "parameter_commands": {name: list(words) for name, words in node.parameter_commands.items()},
            "effective_parameters": record_effective(lookup.architecture, node),
            "tags": list(node.tags),
            "urls": dict(node.urls),
            **record_annotations(node),
        }
    )
