"""Which callbacks of a generated program exclude one another: its callback groups."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from archgen.plugin.generating import make_snake_name
from archgen.plugin.model import Node

CALLED_SECTIONS = ("subscriptions", "services", "clients", "action_servers", "action_clients")
"""What has callbacks beside timers."""


def add_callback_groups(
    node: Node, sections: Mapping[str, Sequence[dict[str, object]]], timers: Iterable[dict[str, object]]
) -> list[dict[str, object]]:
    """Tell each port and timer its `callback_group`, and return the groups: `key`, and the components in it.

    A key is a name that something is written behind, in any language: `fast` of `fast_lock`. What is in none is in the node's default group. Where all is reentrant, there are none.
    """
    groups = {} if node.reentrant else _name_groups(node)
    key_by_component = {component: key for key, members in groups.items() for component in members}
    used_keys = set[str]()
    for section in CALLED_SECTIONS:
        for port in sections[section]:
            key = key_by_component.get(str(port["port"]).rpartition(".")[0], "")
            port["callback_group"] = key
            used_keys.add(key)
    for timer in timers:
        key = key_by_component.get(str(timer["component"]), "")
        timer["callback_group"] = key
        used_keys.add(key)
    return [{"key": key, "components": list(members)} for key, members in groups.items() if key in used_keys]


def _name_groups(node: Node) -> dict[str, tuple[str, ...]]:
    """Return the components of each group, by a name of its own."""
    named: dict[str, tuple[str, ...]] = {}
    for group, members in node.callback_groups.items():
        stem = make_snake_name(group)
        key, number = stem, 1
        while key in named:
            number += 1
            key = f"{stem}_{number}"
        named[key] = members
    return named
