"""Names for what is derived from components: a node's id from the path of what it implements."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable
from itertools import count

_PLAIN_DEPTH = 2
"""How many parts the path of a component has that stands directly in its group."""


def derive_node_ids(component_ids: Iterable[str], all_ids: Iterable[str], used_ids: Collection[str]) -> dict[str, str]:
    """Return an unused id for the node of each component, by the component's complete id.

    A component that stands directly in its group gives its own name, else `group_component`. One inside of others gives
    the shortest end of its path that is unique among `all_ids`, joined by `_`: `left_arm_motor`.
    """
    node_ids: dict[str, str] = {}
    taken_ids = set(used_ids)
    pending_ids = list(component_ids)
    ends = _count_ends(all_ids) if any(each.count(".") >= _PLAIN_DEPTH for each in pending_ids) else Counter[str]()
    # Those at the depth of their group first: a deeper one must never take the name that they have had all along.
    for component_id in sorted(pending_ids, key=lambda each: each.count(".") >= _PLAIN_DEPTH):
        parts = component_id.split(".")
        is_plain = len(parts) == _PLAIN_DEPTH
        names = [parts[-1]] if is_plain else _list_unique_ends(parts, ends)
        node_id = _find_free_id([*names, "_".join(parts)], taken_ids)
        taken_ids.add(node_id)
        node_ids[component_id] = node_id
    return node_ids


def _count_ends(component_ids: Iterable[str]) -> Counter[str]:
    ends = Counter[str]()
    for component_id in component_ids:
        parts = component_id.split(".")
        ends.update(".".join(parts[start:]) for start in range(len(parts)))
    return ends


def _list_unique_ends(parts: list[str], ends: Counter[str]) -> list[str]:
    """Return the ends of a path that no other path has, the shortest first."""
    starts = range(len(parts) - 1, -1, -1)
    return ["_".join(parts[start:]) for start in starts if ends[".".join(parts[start:])] == 1]


def _find_free_id(names: list[str], taken_ids: Collection[str]) -> str:
    for name in names:
        if name not in taken_ids:
            return name
    return next(name for number in count(2) if (name := f"{names[-1]}_{number}") not in taken_ids)
