"""Publishers that offer less than another partner's subscriber requests.

If the subscriber alone requests more, its own partner cuts it off: nobody else loses anything.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.analyses.qos import Clash, clashes
from archgen.compare.losses.both import Both, Loss, tick
from archgen.compare.names import Names
from archgen.model.architecture import Architecture
from archgen.model.distro import is_ros_1
from archgen.model.node import Endpoint, Topic

End = tuple[str, str, str]
"""A written node, its port (a topic's name for internal ones) and its use, by common ids."""


def weaker(both: Both) -> Iterator[Loss]:
    """Find pairs of publisher and subscriber that no longer match because of what is offered."""
    if is_ros_1(both.after.distro):
        return
    old: Mapping[End, list[Endpoint]] | None = None
    for topic in both.after.topics.values():
        for writer, reader in _unmet(both.after, topic):
            # Built only when the first unmatched pair appears; most comparisons have none.
            old = _all(both.before, both.names) if old is None else old
            yield from _lost(both, topic.name, (writer, reader), old)


def _unmet(found: Architecture, topic: Topic) -> Iterator[tuple[Endpoint, Endpoint]]:
    if topic.flow != "topic":
        return
    for writer in topic.writers:
        for reader in topic.readers:
            if next(clashes(writer.qos, reader.qos), None) is None:
                continue
            if found.nodes[writer.node].written and found.nodes[reader.node].written:
                yield writer, reader


def _all(found: Architecture, names: Names) -> Mapping[End, list[Endpoint]]:
    ends: dict[End, list[Endpoint]] = defaultdict(list)
    for end in found.endpoints:
        ends[_end(end, names)].append(end)
    return ends


def _end(end: Endpoint, names: Names) -> End:
    sort = "output" if end.use in {"publishes", "serves"} else "input"
    return names.to("node", end.node), names.to(sort, end.port) if end.port else end.name, end.use


def _lost(both: Both, topic: str, pair: tuple[Endpoint, Endpoint], old: Mapping[End, list[Endpoint]]) -> Iterator[Loss]:
    writer, reader = pair
    writers, readers = (old.get(_end(end, Names()), []) for end in pair)
    met = [w for w in writers for r in readers if w.name == r.name and not _short(w, r)]
    if not met or (reader.port and not both.needs(reader.port)):
        return
    # The new offer against the old request: what clashes here is the publisher's doing.
    fallen = next((found for r in readers if (found := _short(writer, r))), ())
    if not fallen:
        return
    component = both.after.components.get(reader.component or "")
    partner = both.after.nodes[reader.node].owner or (component.owner if component else None)
    places = both.port(writer.node, writer.port or "", "qos") or both.about("node", writer.node)
    offered = " and ".join(clash.offered for clash in fallen)
    wanted = " and ".join(clash.requested for clash in fallen)
    if partner:
        asks = f"where `{reader.node}` of {partner} asks for {wanted}: it receives nothing any more"
        yield from both.losses(places, partner, f"offers {offered} on {tick(topic)}, {asks}")


def _short(writer: Endpoint, reader: Endpoint) -> tuple[Clash, ...]:
    return tuple(clashes(writer.qos, reader.qos))
