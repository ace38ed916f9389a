"""What an element is recognised by when its id changed: its text, ports, partners, neighbours, and the nodes behind it.

References count by what they refer to, as far as that is the same element in both versions. What is new or gone itself
says nothing.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from archgen.compare.likeness import Feature, Features, letters, words
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.names import made_title


def own_messages(found: Architecture) -> list[str]:
    """Name the interfaces that the project defines itself."""
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
"""The ids of all elements of a sort that somebody wrote."""


@dataclass
class Described:
    """An architecture with the look-ups that descriptions need; `name` gives the common name of a referred element."""

    found: Architecture
    name: Callable[[str, str], str | None]

    def refs(self, sort: str, ids: Iterable[str | None]) -> frozenset[str]:
        """Give the common names of what is referred to."""
        return frozenset(name for one in ids if one is not None and (name := self.name(sort, one)) is not None)

    @cached_property
    def readers(self) -> Mapping[str, list[str]]:
        """Find the inputs that read an output."""
        found: dict[str, list[str]] = defaultdict(list)
        for edge in self.found.edges:
            found[edge.output].append(edge.input)
        return found

    @cached_property
    def sources(self) -> Mapping[str, list[str]]:
        """Find the outputs that an input reads."""
        found: dict[str, list[str]] = defaultdict(list)
        for edge in self.found.edges:
            found[edge.input].append(edge.output)
        return found

    @cached_property
    def nodes_of(self) -> Mapping[str, list[str]]:
        """Find the nodes of components (`component:ID`), hosts and containers."""
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
        """Find the topics on which nodes carry a port, as they are written."""
        found: dict[str, list[str]] = defaultdict(list)
        for node in self.found.nodes.values():
            for use in node.uses:
                if use.port:
                    found[use.port] += use.topics
        return found

    @cached_property
    def users(self) -> Mapping[str, list[str]]:
        """Find the components with ports of a type, or that serve a requirement."""
        found: dict[str, list[str]] = defaultdict(list)
        for component in self.found.components.values():
            for port in _ports(component):
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
        """Find the groups and components of a partner."""
        found: dict[str, list[str]] = defaultdict(list)
        for group in self.found.groups.values():
            if group.owner:
                found[group.owner].append(group.id)
        for component in self.found.components.values():
            if component.owner:
                found[component.owner].append(component.id)
        return found


def _ports(component: Component) -> Iterator[Input | Output]:
    yield from component.inputs.values()
    yield from component.outputs.values()


def _own(*values: object) -> frozenset[str]:
    return frozenset(str(value) for value in values if value not in {None, ""})


def _named(name: str, title: str) -> Features:
    written = "" if title in {made_title(name), name} else title
    return {"name": Feature(2, letters(name)), "title": Feature(2, words(written))}


def partner(of: Described, name: str) -> Features:
    """Describe a partner."""
    found = of.found.partners[name]
    return {**_named(name, found.title), "owns": Feature(4, frozenset(of.owned[name]))}


def group(of: Described, name: str) -> Features:
    """Describe a group."""
    found = of.found.groups[name]
    return {
        **_named(name, found.title),
        "components": Feature(5, frozenset(found.components)),
        "text": Feature(2, words(found.description)),
        "owner": Feature(0.5, of.refs("partner", [found.owner])),
    }


def component(of: Described, name: str) -> Features:
    """Describe a component."""
    found = of.found.components[name]
    ports = [f"> {port.name}" for port in found.inputs.values()]
    ports += [f"{port.name} >" for port in found.outputs.values()]
    types = [port.type for port in _ports(found)]
    near = [source.rpartition(".")[0] for port in found.inputs.values() for source in of.sources.get(port.id, ())]
    near += [reader.rpartition(".")[0] for port in found.outputs.values() for reader in of.readers.get(port.id, ())]
    timing = found.timing
    return {
        **_named(found.name, found.title),
        "ports": Feature(4, _own(*ports, *types)),
        "text": Feature(3, words(found.functionality) | words(found.description)),
        "near": Feature(3, of.refs("component", near)),
        "nodes": Feature(3, of.refs("node", of.nodes_of.get(f"component:{name}", ()))),
        "group": Feature(0.5, of.refs("group", [found.group])),
        "owner": Feature(0.5, of.refs("partner", [found.owner])),
        "requirements": Feature(1, _own(*(use.text for use in found.requirements))),
        "performance": Feature(1, _own(*(f"{i.id} {i.accuracy} {i.execution_time}" for i in found.performance))),
        "timing": Feature(1, _own(timing.behaviour, timing.rate, timing.wcet) if timing else frozenset()),
        "tags": Feature(0.5, frozenset(found.tags)),
    }


def output(of: Described, name: str) -> Features:
    """Describe an output."""
    found = of.found.outputs[name]
    readers = [reader.rpartition(".")[0] for reader in of.readers.get(name, ())]
    return {
        "name": Feature(2, letters(found.name)),
        "type": Feature(4, _own(found.type)),
        "topics": Feature(3, frozenset(of.topics[name])),
        "readers": Feature(5, of.refs("component", readers)),
        "text": Feature(1, words(found.description) | words(found.external)),
    }


def input(of: Described, name: str) -> Features:  # noqa: A001 - what it describes
    """Describe an input."""
    found = of.found.inputs[name]
    return {
        "name": Feature(2, letters(found.name)),
        "type": Feature(4, _own(found.type)),
        "topics": Feature(3, frozenset(of.topics[name])),
        "sources": Feature(5, of.refs("output", of.sources.get(name, ()))),
        "text": Feature(1, words(found.description) | words(found.external)),
    }


def type(of: Described, name: str) -> Features:  # noqa: A001 - what it describes
    """Describe a type."""
    found = of.found.types[name]
    ports = of.users.get(f"type:{name}", ())
    return {
        "name": Feature(2, letters(name)),
        "message": Feature(3, _own(found.message)),
        "users": Feature(5, of.refs("output", ports) | of.refs("input", ports)),
        "text": Feature(1, words(found.comment)),
        "size": Feature(1, _own(found.size)),
        "inside": Feature(2, _own(found.request, found.response, found.feedback)),
    }


def message(of: Described, name: str) -> Features:
    """Describe an interface of the project's own."""
    definition = of.found.interfaces.definitions.get(name)
    fields = [f"{field.name} {field.type}" for part in definition.parts for field in part] if definition else []
    users = [t.name for t in of.found.types.values() if t.message == name]
    return {
        "name": Feature(2, letters(name.rpartition("/")[2])),
        "package": Feature(1, _own(name.rpartition("/")[0])),
        "fields": Feature(5, _own(*fields)),
        "users": Feature(4, of.refs("type", users)),
    }


def node(of: Described, name: str) -> Features:
    """Describe a node."""
    found = of.found.nodes[name]
    return {
        **_named(name, found.title),
        "implements": Feature(4, of.refs("component", found.implements)),
        "package": Feature(2, _own(found.package)),
        "program": Feature(2, _own(found.executable, found.plugin)),
        "ports": Feature(2, _own(*(f"{use.use} {use.key}" for use in found.uses))),
        "topics": Feature(1, _own(*(topic for use in found.uses for topic in use.topics))),
        "place": Feature(1, _own(found.host, found.container)),
        "parameters": Feature(1, frozenset(found.parameters)),
        "text": Feature(1, words(found.description)),
    }


def container(of: Described, name: str) -> Features:
    """Describe a container."""
    found = of.found.containers[name]
    return {
        **_named(name, found.title),
        "nodes": Feature(5, of.refs("node", of.nodes_of.get(f"container:{name}", ()))),
        "host": Feature(1, _own(found.host)),
        "threads": Feature(1, _own(found.threads)),
    }


def host(of: Described, name: str) -> Features:
    """Describe a host."""
    found = of.found.hosts[name]
    held = [one.id for one in of.found.containers.values() if one.host == name]
    return {
        **_named(name, found.title),
        "nodes": Feature(5, of.refs("node", of.nodes_of.get(f"host:{name}", ()))),
        "containers": Feature(2, of.refs("container", held)),
        "cores": Feature(1, _own(found.cores)),
        "text": Feature(1, words(found.description)),
    }


def link(of: Described, name: str) -> Features:
    """Describe a link."""
    found = of.found.links[name]
    return {
        **_named(name, found.title),
        "connects": Feature(4, of.refs("host", found.connects)),
        "figures": Feature(2, _own(found.bandwidth, f"best {found.best}", f"worst {found.worst}")),
    }


def chain(of: Described, name: str) -> Features:
    """Describe a chain."""
    found = of.found.chains[name]
    through = (of.refs(point.kind, [point.id]) for point in found.through)
    return {
        **_named(name, found.title),
        "through": Feature(6, frozenset[str]().union(*through)),
        "deadline": Feature(1, _own(found.deadline)),
    }


def requirement(of: Described, name: str) -> Features:
    """Describe a requirement."""
    found = of.found.requirements[name]
    return {
        "name": Feature(1, letters(name)),
        "title": Feature(4, words(found.title if found.title != name else None)),
        "users": Feature(3, of.refs("component", of.users.get(f"requirement:{name}", ()))),
        "text": Feature(2, words(found.description)),
    }


def use_case(of: Described, name: str) -> Features:
    """Describe a use case."""
    found = of.found.use_cases[name]
    return {
        "name": Feature(1, letters(name)),
        "title": Feature(4, words(found.title if found.title != name else None)),
        "users": Feature(3, of.refs("requirement", of.users.get(f"use_case:{name}", ()))),
        "text": Feature(2, words(found.description)),
    }


def view(of: Described, name: str) -> Features:
    """Describe a view."""
    found = of.found.views[name]
    return {**_named(name, found.title), "show": Feature(5, words(found.show))}


def policy(of: Described, name: str) -> Features:
    """Describe a policy."""
    found = of.found.policies[name]
    return {**_named(name, found.title), "forbids": Feature(5, _own(f"{found.forbid_from} > {found.forbid_to}"))}
