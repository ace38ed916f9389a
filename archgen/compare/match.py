"""Find the elements that both versions have, even under another id or in another group.

From the outside in, so that each match helps with the next: groups, components, ports, nodes, and all that refers to
them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from archgen.compare import features
from archgen.compare.described import IDS, Described
from archgen.compare.likeness import Features, pairs
from archgen.compare.names import Names
from archgen.model.architecture import Architecture

Describe = Callable[[Described, str], Features]


def match(before: Architecture, after: Architecture) -> Names:
    """Pair the elements of both versions."""
    names = Names()
    # Both look up `matched_ids` while it fills: features of later kinds see the matches of earlier ones. The order of
    # the calls below is therefore part of the algorithm.
    left, right = Described(before, names.known), Described(after, _itself(names))
    names.pair("project", before.project.id, after.project.id)
    for sort, ids in _FIRST.items():
        _same(names, sort, ids(before), ids(after))
    _match(names, "partner", left, right, features.partner)
    _match(names, "group", left, right, features.group)
    _below(names, "component", before.components, after.components, "group")
    _match(names, "component", left, right, features.component)
    _ports(names, "output", left, right, features.output)
    _ports(names, "input", left, right, features.input)
    for sort, describe in _LATER.items():
        _match(names, sort, left, right, describe)
    return names


def _itself(names: Names) -> Callable[[str, str], str | None]:
    return lambda sort, name: name if names.has(sort, name) else None


def _same(names: Names, sort: str, before: Iterable[str], after: Iterable[str]) -> None:
    """Pair elements that have the same id in both versions."""
    there = set(after)
    for name in before:
        if name in there:
            names.pair(sort, name, name)


def _below(names: Names, sort: str, before: Iterable[str], after: Iterable[str], above: str) -> None:
    """Pair elements that have the same name below a matched parent."""
    there = set(after)
    for name in before:
        parent, _, own = name.rpartition(".")
        here = names.known(above, parent)
        if here is not None and f"{here}.{own}" in there:
            names.pair(sort, name, f"{here}.{own}")


def _match(names: Names, sort: str, left: Described, right: Described, describe: Describe) -> None:
    """Pair the remaining elements by likeness."""
    ids = IDS[sort]
    gone = {name: describe(left, name) for name in ids(left.found) if names.known(sort, name) is None}
    if not gone:
        return
    # Described only if something is left to pair.
    come = {name: describe(right, name) for name in ids(right.found) if not names.has(sort, name)}
    for one, other, confidence in pairs(gone, come):
        names.pair(sort, one, other, confidence)


def _ports(names: Names, sort: str, left: Described, right: Described, describe: Describe) -> None:
    """Pair ports, first by name, then by likeness within each pair of components."""
    ids = IDS[sort]
    _below(names, sort, ids(left.found), ids(right.found), "component")
    gone: dict[str, dict[str, Features]] = {}
    for port in ids(left.found):
        component = names.known("component", port.rpartition(".")[0])
        if component is not None and names.known(sort, port) is None:
            gone.setdefault(component, {})[port] = describe(left, port)
    for component, ports in gone.items():
        owner = right.found.components[component]
        there: Mapping[str, object] = owner.outputs if sort == "output" else owner.inputs
        come = [f"{component}.{name}" for name in there if not names.has(sort, f"{component}.{name}")]
        for one, other, confidence in pairs(ports, {port: describe(right, port) for port in come}):
            names.pair(sort, one, other, confidence)


# Components and ports are matched below their group or component instead: their ids change when a parent is renamed.
_FIRST = {sort: ids for sort, ids in IDS.items() if sort not in {"component", "input", "output"}}
_LATER: Mapping[str, Describe] = {
    # In an order in which an element comes after those its features refer to: hosts after nodes, links after hosts.
    "type": features.type,
    "message": features.message,
    "node": features.node,
    "container": features.container,
    "host": features.host,
    "link": features.link,
    "chain": features.chain,
    "requirement": features.requirement,
    "use_case": features.use_case,
    "view": features.view,
    "policy": features.policy,
}
