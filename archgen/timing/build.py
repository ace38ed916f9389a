"""Build a timing system from an architecture: activities and the arcs between them, all durations in one unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.architecture import Architecture
from archgen.timing import sizes
from archgen.timing.activities import activities, key, names, owner
from archgen.timing.analysis import Reason
from archgen.timing.arcs import arcs
from archgen.timing.system import Activity, System, grouped
from archgen.timing.ticks import ticks

_BYTE = 8


def system(architecture: Architecture) -> tuple[System, tuple[Reason, ...]]:
    """Build the system of a linked architecture, with notes on what had to be assumed."""
    unit = ticks(architecture)
    named = names(architecture)
    made = activities(architecture, named, unit)
    joined = arcs(architecture, named, made, unit)
    notes = (
        () if unit.exact else (Reason("the rates have no common measure of reasonable size: periods are rounded up"),)
    )
    built = System(
        tick=unit.tick,
        activities=made,
        arcs=joined,
        into=grouped((arc.target, arc) for arc in joined),
        out_of=grouped((arc.source, arc) for arc in joined),
        external=dict(_external(architecture, made)),
        optional=frozenset(port.id for port in architecture.inputs.values() if port.optional),
        cores={host.id: host.cores for host in architecture.hosts.values()},
        threads={container.id: container.threads for container in architecture.containers.values()},
        bandwidths={
            link.id: link.bandwidth.value / _BYTE if link.bandwidth else None for link in architecture.links.values()
        },
        served=frozenset(
            (owner(architecture, named, end), key(end)) for end in architecture.endpoints if end.use == "serves"
        ),
        writers={
            name: tuple((owner(architecture, named, end), key(end)) for end in topic.writers)
            for name, topic in architecture.topics.items()
            if topic.flow == "topic"
        },
        sizes=sizes.of_topics(architecture),
    )
    return built, notes


def _external(architecture: Architecture, made: Mapping[str, Activity]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the inputs that something feeds from outside of the architecture."""
    for activity in made.values():
        ports = (architecture.inputs.get(port) for port in activity.inputs)
        # An input whose `from` names something that does not exist counts as fed from outside: the wrong name is
        # reported elsewhere, and an input that nothing feeds would keep an all-of reader from ever firing.
        fed = tuple(p.id for p in ports if p and (p.external or p.physical or (p.from_written and not p.connections)))
        if fed:
            yield activity.id, fed
