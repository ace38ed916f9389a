"""Topics, services and actions that another partner's node uses under a name that no longer exists."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from archgen.compare.losses.both import Both, Loss, several, tick
from archgen.model.node import Endpoint, Flow

Place = tuple[str, Flow]


def renamed_topics(both: Both) -> Iterator[Loss]:
    """Find names that disappeared while other partners' nodes use them: their programs do not follow the files."""
    old, new = both.ends
    there: dict[str, set[Place]] = defaultdict(set)
    for (_, port), ends in new.items():
        there[port].update((end.name, end.flow) for end in ends)
    readers = _readers(both)
    for node, port in sorted(old):
        if port and ("output", port) not in both.told.after:
            continue  # the connection itself is gone
        was = {(end.name, end.flow) for end in old[node, port]}
        now = there[port]
        places = _because(both, node, port) if was - now else []
        for name, flow in sorted(was - now):
            ours = {(end.name, end.flow) for end in new.get((node, port), ())}
            instead = sorted(other for other, kind in (now if port else ours) - was if kind == flow)
            users = [
                end for end in readers.get((name, flow), ()) if not port or not end.sources or _reads(both, end, port)
            ]
            for partner, nodes in _partners(both, users).items():
                yield from both.losses(places, partner, _why((name, flow), partner, nodes, instead))


def _readers(both: Both) -> Mapping[Place, list[Endpoint]]:
    """Return the readers of each name in the first version that can be broken: real nodes that remain."""
    found: dict[Place, list[Endpoint]] = defaultdict(list)
    for end in both.before.endpoints:
        node = both.before.nodes[end.node]
        if end.use in {"publishes", "serves"} or not node.written or node.status == "planned":
            continue
        stays = ("node", both.names.to("node", end.node)) in both.told.after
        if stays and (end.port is None or both.needs(both.names.to("input", end.port))):
            found[end.name, end.flow].append(end)
    return found


def _reads(both: Both, end: Endpoint, output: str) -> bool:
    return output in {both.names.to("output", source) for source in end.sources}


def _partners(both: Both, users: Iterable[Endpoint]) -> Mapping[str, set[str]]:
    found: dict[str, set[str]] = defaultdict(set)
    for end in users:
        node = both.before.nodes[end.node]
        if node.owner:
            found[both.names.to("partner", node.owner)].add(both.names.to("node", end.node))
    return dict(sorted(found.items()))


def _because(both: Both, node: str, port: str) -> list[int]:
    """Return the indices of the change that renamed a topic: at the port, the node, or the elements its name is made
    of.
    """
    component = port.rpartition(".")[0]
    group = component.partition(".")[0]
    # From the most specific cause to the most general; the first that changed at all is blamed.
    tries = (
        both.port(node, port, "topic"),
        both.about("node", node, "name", "namespace"),
        both.of_kind("node", node, "renamed", "removed"),
        both.of_kind("output", port, "renamed"),
        both.of_kind("component", component, "renamed", "moved"),
        both.of_kind("group", group, "renamed"),
        both.about("node", node),
        both.about("output", port),
    )
    return next((places for places in tries if places), [])


def _why(place: Place, partner: str, nodes: Iterable[str], instead: list[str]) -> str:
    name, flow = place
    verb = "subscribes to" if flow == "topic" else "calls"
    now = f"it is {several(instead)} now" if instead else "nobody offers it under that name any more"
    return f"takes the {flow} {tick(name)} from {partner}, whose {several(nodes)} {verb} it; {now}"
