"""The features by which an element is recognised after its id changed: text, ports, partners, neighbours, nodes.

References count by the element they refer to if that is matched already; new and removed elements say nothing. The
weights are the first argument of each `Feature`.
"""

from __future__ import annotations

from archgen.compare.described import Described, ports_of
from archgen.compare.likeness import Feature, Features, letters, words
from archgen.model.names import made_title


def _own(*values: object) -> frozenset[str]:
    return frozenset(str(value) for value in values if value not in {None, ""})


def _named(name: str, title: str) -> Features:
    return {"name": Feature(2, letters(name)), "title": Feature(2, words(title), title in {made_title(name), name})}


def partner(of: Described, name: str) -> Features:
    """Return the features of a partner."""
    found = of.found.partners[name]
    return {**_named(name, found.title), "owns": Feature(4, frozenset(of.owned[name]))}


def group(of: Described, name: str) -> Features:
    """Return the features of a group."""
    found = of.found.groups[name]
    return {
        **_named(name, found.title),
        # The names of its components outweigh all else: a group is what it holds.
        "components": Feature(8, frozenset(found.components)),
        "text": Feature(2, words(found.description)),
        "owner": Feature(0.5, of.refs("partner", [found.owner])),
    }


def component(of: Described, name: str) -> Features:
    """Return the features of a component."""
    found = of.found.components[name]
    # The direction is part of the mark, so that an input and an output of one name are not alike.
    ports = [f"> {port.name}" for port in found.inputs.values()]
    ports += [f"{port.name} >" for port in found.outputs.values()]
    types = [port.type for port in ports_of(found)]
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
    """Return the features of an output."""
    found = of.found.outputs[name]
    readers = [reader.rpartition(".")[0] for reader in of.readers.get(name, ())]
    return {
        "name": Feature(2, letters(found.name)),
        "type": Feature(4, _own(found.type)),
        # `topics_by_port` is a defaultdict: a port that no node names has no marks.
        "topics": Feature(3, frozenset(of.topics[name])),
        "readers": Feature(5, of.refs("component", readers)),
        "text": Feature(1, words(found.description) | words(found.external)),
    }


def input(of: Described, name: str) -> Features:  # noqa: A001 - what it describes
    """Return the features of an input."""
    found = of.found.inputs[name]
    return {
        "name": Feature(2, letters(found.name)),
        "type": Feature(4, _own(found.type)),
        "topics": Feature(3, frozenset(of.topics[name])),
        "sources": Feature(5, of.refs("output", of.sources.get(name, ()))),
        "text": Feature(1, words(found.description) | words(found.external)),
    }


def type(of: Described, name: str) -> Features:  # noqa: A001 - what it describes
    """Return the features of a conceptual type."""
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
    """Return the features of an interface that the project defines."""
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
    """Return the features of a node."""
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
    """Return the features of a container."""
    found = of.found.containers[name]
    return {
        **_named(name, found.title),
        "nodes": Feature(5, of.refs("node", of.nodes_of.get(f"container:{name}", ()))),
        "host": Feature(1, _own(found.host)),
        "threads": Feature(1, _own(found.threads)),
    }


def host(of: Described, name: str) -> Features:
    """Return the features of a host."""
    found = of.found.hosts[name]
    held = [one.id for one in of.found.containers.values() if one.host == name]
    return {
        **_named(name, found.title),
        "nodes": Feature(8, of.refs("node", of.nodes_of.get(f"host:{name}", ()))),
        "containers": Feature(2, of.refs("container", held)),
        "cores": Feature(1, _own(found.cores)),
        "text": Feature(1, words(found.description)),
    }


def link(of: Described, name: str) -> Features:
    """Return the features of a link."""
    found = of.found.links[name]
    return {
        **_named(name, found.title),
        "connects": Feature(4, of.refs("host", found.connects)),
        "figures": Feature(2, _own(found.bandwidth, f"best {found.best}", f"worst {found.worst}")),
    }


def chain(of: Described, name: str) -> Features:
    """Return the features of a chain."""
    found = of.found.chains[name]
    through = (of.refs(point.kind, [point.id]) for point in found.through)
    return {
        **_named(name, found.title),
        "through": Feature(6, frozenset[str]().union(*through)),
        "deadline": Feature(1, _own(found.deadline)),
    }


def requirement(of: Described, name: str) -> Features:
    """Return the features of a requirement."""
    found = of.found.requirements[name]
    return {
        "name": Feature(1, letters(name)),
        # Unlike elsewhere the title weighs more than the id, here and for use cases.
        "title": Feature(4, words(found.title), found.title == name),
        "users": Feature(3, of.refs("component", of.users.get(f"requirement:{name}", ()))),
        "text": Feature(2, words(found.description)),
    }


def use_case(of: Described, name: str) -> Features:
    """Return the features of a use case."""
    found = of.found.use_cases[name]
    return {
        "name": Feature(1, letters(name)),
        "title": Feature(4, words(found.title), found.title == name),
        "users": Feature(3, of.refs("requirement", of.users.get(f"use_case:{name}", ()))),
        "text": Feature(2, words(found.description)),
    }


def view(of: Described, name: str) -> Features:
    """Return the features of a view."""
    found = of.found.views[name]
    return {**_named(name, found.title), "show": Feature(5, words(found.show))}


def policy(of: Described, name: str) -> Features:
    """Return the features of a policy."""
    found = of.found.policies[name]
    return {**_named(name, found.title), "forbids": Feature(5, _own(f"{found.forbid_from} > {found.forbid_to}"))}
