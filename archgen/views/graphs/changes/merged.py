"""Two versions as one: the change of each component, connection and type, by common ids.

Common ids are those of the second version; what was removed keeps its old one.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import get_args

from archgen.compare import Change, Comparison
from archgen.compare.names import Names
from archgen.model.architecture import Architecture
from archgen.views.changes.telling import textual
from archgen.views.graphs.flows import Style, style_of
from archgen.views.shapes import Changed

_PORTS = frozenset({"input", "output"})
_WHOLE = frozenset(get_args(Changed))


@dataclass(frozen=True, slots=True)
class Edge:
    """A connection from one output to one input. `tail` and `head` are components, in the direction of drawing."""

    output: str
    input: str
    tail: str
    head: str
    style: Style
    label: str
    optional: bool


@dataclass(slots=True)
class Happened:
    """What changed, by common ids: kinds of changes, and the sentences that describe them."""

    components: dict[str, Changed] = field(default_factory=dict)
    said: defaultdict[str, list[str]] = field(default_factory=lambda: defaultdict(list))
    """Sentences by component, and by input for connections."""
    carried: dict[str, str] = field(default_factory=dict)
    """The sentence for each output, input and type with a change of what flows."""
    texts: set[str] = field(default_factory=set)
    """Components with changes of texts only."""


def happened(found: Comparison) -> Happened:
    """Collect the changes by the elements that they happened to."""
    told = Happened()
    for change in found.changes:
        _note(change, found.names, told)
    return told


def _note(change: Change, names: Names, told: Happened, whole: str = "") -> None:
    """Note a change and its parts; parts of an added or removed element are described by the whole."""
    sort = "input" if change.sort == "connection" else change.sort
    name = names.to(sort, change.element) if change.kind == "removed" else change.element
    said = whole or change.text
    if sort == "component":
        _component(change, name, said, told)
    elif sort in _PORTS:
        _port(change, name, said, told)
    elif sort in {"type", "message"} and not textual(change):
        told.carried[name] = said
    for part in change.parts:
        # A group is no box here: what was added with it is described part by part.
        inner = said if change.kind in {"added", "removed"} and change.sort != "group" else ""
        _note(part, names, told, inner)


def _component(change: Change, name: str, said: str, told: Happened) -> None:
    if textual(change):
        told.texts.add(name)
        return
    told.said[name].append(said)
    kind: Changed = "renamed" if change.kind == "moved" else change.kind
    # Added, removed and renamed win over changed, whichever comes first.
    if kind != "changed" or name not in told.components:
        told.components[name] = kind


def _port(change: Change, name: str, said: str, told: Happened) -> None:
    component = name.rpartition(".")[0]
    told.said[name].append(said)
    if change.sort == "connection":
        return
    if textual(change):
        told.texts.add(component)
        return
    if said not in told.said[component]:
        told.said[component].append(said)
    told.components.setdefault(component, "changed")
    if change.kind == "changed":
        told.carried[name] = said


def edges(found: Architecture, names: Names) -> Mapping[tuple[str, str], Edge]:
    """Return all connections of a version by the common ids of their ends."""
    return {(edge.output, edge.input): edge for edge in _edges(found, names)}


def _edges(found: Architecture, names: Names) -> Iterator[Edge]:
    for connection in found.connections:
        port = found.inputs[connection.input]
        reader = names.to("component", port.component)
        for name in connection.outputs:
            output = found.outputs.get(name)
            if output is None:
                continue
            style = style_of(found, name)
            writer = names.to("component", output.component)
            # Services and actions are drawn from client to server, against the direction of the output.
            ends = (reader, writer) if style in {"service", "action"} else (writer, reader)
            label = output.type or output.name
            yield Edge(
                names.to("output", name), names.to("input", port.id), *ends, style, label, optional=port.optional
            )


def flows_changed(found: Architecture, edge: Edge, told: Happened) -> Iterable[str]:
    """Return the sentences about a change of what flows along a connection that is in both versions."""
    output = found.outputs.get(edge.output)
    names = [edge.output, edge.input]
    if output is not None:
        names += [name for name in (output.type, found.message(output)) if name]
    return [told.carried[name] for name in dict.fromkeys(names) if name in told.carried]
