"""Hosts and links that are asked for more than they have."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.compare.losses.both import Both, Loss
from archgen.compare.losses.causes import Causes
from archgen.compare.names import Names
from archgen.compare.timed import full
from archgen.timing.analysis import Analysis
from archgen.timing.placement import Resource, resources
from archgen.timing.value import Value
from archgen.timing.wording import share


def overloaded(both: Both, causes: Causes) -> Iterator[Loss]:
    """Find cores that are overloaded now and were not before, and whose activities run there in both versions."""
    before, after = causes.timed.before, causes.timed.after
    if not any(map(full, after.hosts.values())):
        return
    had = {place: load >= resource.cores for place, resource, load in _places(before, both.names)}
    ran = {name: place[0] for place, resource, _ in _places(before, both.names) for name in resource.members}
    for place, resource, load in _places(after, Names()):
        host = place[0]
        if load < resource.cores or had.get(place):
            continue
        stayed = [name for name in resource.members if ran.get(causes.was(name) or "") == host]
        heavier = causes.heavier(resource.members)
        places = dict.fromkeys([*both.about("host", host, "cores"), *causes.of(heavier)] or causes.any())
        whole = "its core" if resource.cores == 1 else f"its {resource.cores} cores"
        name = f"`{resource.id}`" if place[1] else f"the host `{host}`"
        why = f"overloads {name} ({share(load / resource.cores)} of {whole}), where {{}}"
        yield from both.shared(places, causes.owned(stayed), why, "runs")


def _places(found: Analysis, names: Names) -> Iterator[tuple[tuple[str, str], Resource, Fraction]]:
    """Yield the cores that some activities share, by host and rest of their id, with their load in cores."""
    for resource in resources(found.system):
        if resource.host is None:  # threads of a container, each with a core that nobody named
            continue
        parts = dict(found.hosts[resource.host].parts)
        load = sum((parts[name].value or Fraction(0) for name in resource.members), Fraction(0))
        yield (names.to("host", resource.host), resource.id.removeprefix(resource.host)), resource, load


def saturated(both: Both, causes: Causes) -> Iterator[Loss]:
    """Find links that are saturated now and were not before, and who sent or received something over them."""
    for name, load in causes.timed.after.links.items():
        was = causes.timed.before.links.get(both.names.back.get("link", {}).get(name, name))
        if was is None or full(was) or not full(load):
            continue
        before = dict(was.parts)
        grown = [topic for topic, value in load.parts if topic not in before or _grew(before[topic], value)]
        crossing = [arc for arc in causes.timed.after.system.arcs if arc.link == name and arc.role == "data"]
        ends = [end for arc in crossing if arc.topic in grown for end in (arc.source, arc.target)]
        places = dict.fromkeys([*of_link(both, name, grown, causes)] or causes.of(ends) or causes.any())
        users = {end for arc in crossing if arc.topic in before for end in (arc.source, arc.target)}
        used = share(load.share.value) if load.share.value is not None else ""
        why = f"asks the link `{name}` for {used} of its bandwidth; {{}} it"
        yield from both.shared(places, causes.owned(users), why, "uses")


def _grew(one: Value, other: Value) -> bool:
    return other.value is not None and (one.value is None or other.value > one.value)


def of_link(both: Both, link: str, topics: Iterable[str], causes: Causes) -> Iterator[int]:
    """Yield the indices of changes of a link, and of the types and messages that are sent over it."""
    names = [("link", link)]
    for found in filter(None, map(both.after.topics.get, topics)):
        names += [("type", name) for name in found.types]
        names += [("message", name) for name in found.messages]
    for sort, name in names:
        yield from (place for place, change in both.found(sort, name) if causes.worse(change))
