"""Build the arcs: along which data passes between activities, over which link, and how long that takes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.deployment import Link
from archgen.model.node import Endpoint, Topic
from archgen.model.qos import PROFILES
from archgen.source import NOWHERE, Span
from archgen.timing import sizes
from archgen.timing.activities import Names, key, owner
from archgen.timing.system import Activity, Arc
from archgen.timing.ticks import Ticks

Route = tuple[str | None, int | None, int | None]
"""A link (None on one host), with its best and worst latency in ticks (None where unknown)."""
_HERE: Route = (None, 0, 0)
_NO_WAY: Route = (None, None, None)


def arcs(architecture: Architecture, named: Names, made: Mapping[str, Activity], unit: Ticks) -> tuple[Arc, ...]:
    """Join writers with readers, topic by topic; services and actions in both directions."""
    joining = _Joining(
        architecture,
        named,
        made,
        # Cached by pair of hosts: there are far more arcs than pairs.
        cache(_Routes(architecture, unit)),
        {(edge.output, edge.input): edge.at for edge in architecture.edges},
        sizes.carried(architecture),
    )
    return tuple(arc for topic in architecture.topics.values() for arc in joining.of_topic(topic))


@dataclass(frozen=True, slots=True)
class _Joining:
    """The look-ups that each pair of a writer and a reader needs."""

    architecture: Architecture
    named: Names
    made: Mapping[str, Activity]
    route: Callable[[str | None, str | None], Route]
    places: Mapping[tuple[str, str], Span]
    size: Callable[[Endpoint, sizes.Role], int | None]

    def of_topic(self, topic: Topic) -> Iterator[Arc]:
        """Yield the arcs of one topic, service or action."""
        for reader in topic.readers:
            for writer in topic.writers:
                # A shared topic would join all nodes with all others: only what an input names counts.
                if topic.shared and writer.port not in reader.sources:
                    continue
                if topic.flow == "topic":
                    yield self._data(topic, writer, reader, self.size(writer, "data"))
                else:
                    # The server is the writer of a service, so that the arc from writer to reader is the answer.
                    data = self._data(topic, writer, reader, None)
                    yield replace(self._request(data), size=self.size(writer, "request"))
                    yield replace(data, role="answer", size=self.size(writer, "answer"))

    def _data(self, topic: Topic, writer: Endpoint, reader: Endpoint, size: int | None) -> Arc:
        """Return the arc from a writer to a reader."""
        source, target = (owner(self.architecture, self.named, end) for end in (writer, reader))
        link, best, worst = self.route(self.made[source].host, self.made[target].host)
        port = self.architecture.inputs.get(reader.port or "")
        qos = reader.qos
        return Arc(
            source=source,
            output=key(writer),
            target=target,
            input=key(reader),
            topic=topic.name,
            flow=topic.flow,
            link=link,
            best=best,
            worst=worst,
            depth=None if qos.history == "keep_all" else qos.depth,
            size=size,
            optional=bool(port and port.optional),
            depth_written=qos.written and qos.depth != PROFILES[qos.profile].depth,
            at=self._place(writer, reader),
            queue_at=qos.at,
        )

    def _request(self, answer: Arc) -> Arc:
        """Return the arc from client to server that belongs to an answer."""
        link, best, worst = self.route(self.made[answer.target].host, self.made[answer.source].host)
        return replace(
            answer,
            source=answer.target,
            output=answer.input,
            target=answer.source,
            input=answer.output,
            role="request",
            link=link,
            best=best,
            worst=worst,
        )

    def _place(self, writer: Endpoint, reader: Endpoint) -> Span:
        """Return the reference that joins the two; where they only meet on a topic, the place of the reader."""
        found = self.places.get((writer.port or "", reader.port or ""))
        if found is not None:
            return found
        port = self.architecture.inputs.get(reader.port or "")
        return reader.at if reader.at != NOWHERE or port is None else port.at


class _Routes:
    """Finds the link between two hosts: of several the one with the least worst latency."""

    def __init__(self, architecture: Architecture, unit: Ticks) -> None:
        self._unit = unit
        self._joining: dict[str, dict[str, Link]] = defaultdict(dict)
        for link in architecture.links.values():
            for host in link.connects:
                self._joining[host][link.id] = link

    def __call__(self, here: str | None, there: str | None) -> Route:
        """Return the link between two hosts and its latency.

        Where neither end has a host, both are taken to be on one; where only one has, the latency is unknown.
        """
        if here == there:
            return _HERE
        if here is None or there is None:
            return _NO_WAY
        reached = self._joining[there]
        joining = [link for name, link in self._joining[here].items() if name in reached]
        if not joining:
            return _NO_WAY
        link = min(joining, key=_slowness)
        return link.id, self._unit.of(link.best), self._unit.of(link.worst)


def _slowness(link: Link) -> tuple[bool, object]:
    """Sort key for links: by worst latency, those without one last."""
    return (link.worst is None, link.worst.value if link.worst else 0)
