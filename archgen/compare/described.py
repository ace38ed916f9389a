"""An architecture with the reverse look-ups that describing its elements for matching needs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output


def own_messages(found: Architecture) -> list[str]:
    """Return the sorted names of the interfaces that the project defines itself."""
    own = found.interfaces.project_packages
    return sorted(name for name in found.interfaces.names if name.partition("/")[0] in own) if own else []


IDS: Mapping[str, Callable[[Architecture], Iterable[str]]] = {
    "partner": lambda found: found.partners,
    "group": lambda found: found.groups,
    "component": lambda found: found.components,
    "output": lambda found: found.outputs,
    "input": lambda found: found.inputs,
    "type": lambda found: [t.name for t in found.types.values() if t.origin == "project" and t.at.file],
    "message": own_messages,
    "node": lambda found: [node.id for node in found.nodes.values() if node.written],
    "container": lambda found: found.containers,
    "host": lambda found: found.hosts,
    "link": lambda found: found.links,
    "chain": lambda found: found.chains,
    "requirement": lambda found: found.requirements,
    "use_case": lambda found: found.use_cases,
    "view": lambda found: found.views,
    "policy": lambda found: found.policies,
}
"""For each kind of element, the ids of all that somebody wrote."""


@dataclass
class Described:
    """An architecture with reverse look-ups; `find_common_id` returns the id after the comparison's matching, None if
    unmatched.
    """

    found: Architecture
    name: Callable[[str, str], str | None]

    def refs(self, sort: str, ids: Iterable[str | None]) -> frozenset[str]:
        """Return the common ids of those elements that are matched already."""
        return frozenset(name for one in ids if one is not None and (name := self.name(sort, one)) is not None)

    @cached_property
    def readers(self) -> Mapping[str, list[str]]:
        """Return for each output the inputs that read it."""
        found: dict[str, list[str]] = defaultdict(list)
        for edge in self.found.edges:
            found[edge.output].append(edge.input)
        # A defaultdict is returned on purpose: what nobody uses has an empty list.
        return found

    @cached_property
    def sources(self) -> Mapping[str, list[str]]:
        """Return for each input the outputs that it reads."""
        found: dict[str, list[str]] = defaultdict(list)
        for edge in self.found.edges:
            found[edge.input].append(edge.output)
        return found

    @cached_property
    def nodes_of(self) -> Mapping[str, list[str]]:
        """Return the written nodes of components (`component:ID`), hosts (`host:ID`) and containers."""
        found: dict[str, list[str]] = defaultdict(list)
        for node in self.found.nodes.values():
            if node.written:
                for place in (
                    *(f"component:{c}" for c in node.implements),
                    f"host:{node.host}",
                    f"container:{node.container}",
                ):
                    found[place].append(node.id)
        return found

    @cached_property
    def topics(self) -> Mapping[str, list[str]]:
        """Return for each port the topics on which nodes carry it, as written."""
        found: dict[str, list[str]] = defaultdict(list)
        for node in self.found.nodes.values():
            for use in node.uses:
                if use.port:
                    found[use.port] += use.topics
        return found

    @cached_property
    def users(self) -> Mapping[str, list[str]]:
        """Return the users of types (`type:ID`: ports), requirements (components) and use cases (requirements)."""
        found: dict[str, list[str]] = defaultdict(list)
        for component in self.found.components.values():
            for port in ports_of(component):
                if port.type:
                    found[f"type:{port.type}"].append(port.id)
            for use in component.requirements:
                found[f"requirement:{use.text}"].append(component.id)
        for requirement in self.found.requirements.values():
            for case in requirement.use_cases:
                found[f"use_case:{case}"].append(requirement.id)
        return found

    @cached_property
    def owned(self) -> Mapping[str, list[str]]:
        """Return for each partner the groups and components that it owns."""
        found: dict[str, list[str]] = defaultdict(list)
        for group in self.found.groups.values():
            if group.owner:
                found[group.owner].append(group.id)
        for component in self.found.components.values():
            if component.owner:
                found[component.owner].append(component.id)
        return found


def ports_of(component: Component) -> Iterator[Input | Output]:
    """Yield all ports of a component, inputs first."""
    yield from component.inputs.values()
    yield from component.outputs.values()
