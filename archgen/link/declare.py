"""Turn the merged project into the architecture: declare every element, resolve every reference."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.diagnostic import Diagnostic
from archgen.link import declare_rest, reading
from archgen.link.activities import Activities, shared_components
from archgen.link.declare_groups import HighLevel
from archgen.link.declare_nodes import Surroundings, declare_nodes, implemented
from archgen.link.declare_types import declare_types
from archgen.link.outline import Outline, outline
from archgen.link.references import References
from archgen.link.resolve import Wiring
from archgen.model.architecture import Architecture
from archgen.model.interfaces import Interfaces
from archgen.model.mapping import Type
from archgen.source import Span
from archgen.syntax.tree import Table


def link(  # noqa: PLR0913 - all by name
    table: Table,
    *,
    default_id: str,
    default_title: str,
    shipped: Mapping[str, Type],
    interfaces: Interfaces,
    lost: frozenset[str] = frozenset(),
    partial: bool = False,
) -> tuple[Architecture, tuple[Diagnostic, ...]]:
    """Return the architecture of a project's merged slices. What cannot be resolved is left out and reported.

    `default_id` and `default_title` are used where the project states none. `lost_keys` are the keys of what could not
    be read: what they may declare is not reported as unknown. `is_partial` is whether a whole file or section was lost.
    """
    # The order matters. Ids come first (the outline), then types, because which outputs carry messages decides what a
    # reference to a whole component brings. Containers and the components of the nodes must be known before the nodes,
    # which inherit hosts, owners and timing from them. Every step appends to the same list of diagnostics.
    found: list[Diagnostic] = []
    parts = outline(table)
    types = declare_types(table, parts.types_used(), shipped, found)
    references = _references(table, parts, found, lost)
    wiring = Wiring(parts, references, types)
    high = HighLevel(parts, references, wiring)
    high.declare()
    containers = declare_rest.containers(table, references)
    references.implements = implements = implemented(table, references)
    timings = Activities(high.components, shared_components(implements.values()), found)
    nodes = declare_nodes(table, Surroundings(parts, references, high.components, containers, timings), implements)
    ros = reading.table(table, "ros")
    architecture = Architecture(
        project=declare_rest.project(table, default_id, default_title),
        distro=reading.text(ros, "distro"),
        distro_at=reading.place(ros, "distro"),
        shared_topics=reading.texts(ros, "shared_topics"),
        layout=reading.layout(table),
        partners=declare_rest.partners(table),
        use_cases=declare_rest.use_cases(table),
        requirements=declare_rest.requirements(table, references),
        groups=high.groups,
        components=high.components,
        inputs={port.id: port for component in high.components.values() for port in component.inputs.values()},
        outputs={output.id: output for output in parts.all_outputs()},
        connections=tuple(wiring.connections),
        edges=tuple(wiring.edges),
        types=types,
        nodes=nodes,
        hosts=declare_rest.hosts(table),
        containers=containers,
        links=declare_rest.links(table, references),
        chains=declare_rest.chains(table, references),
        views=declare_rest.views(table),
        policies=declare_rest.policies(table),
        review=declare_rest.review(table),
        interfaces=interfaces,
        partial=partial,
        lost=lost,
        suspects=frozenset(references.suspects),  # last: the arguments above still resolve references
    )
    return architecture, tuple(found)


def _references(root: Table, parts: Outline, found: list[Diagnostic], lost: frozenset[str]) -> References:
    places: dict[str, dict[str, Span]] = {
        "group": {name: entry.at for name, entry in parts.groups.items()},
        "component": {name: entry.at for name, entry in parts.components.items()},
        "output": {output.id: output.at for output in parts.all_outputs()},
        "input": {f"{c}.{name}": e.at for c, inputs in parts.inputs.items() for name, e in inputs.items()},
        "node": {entry.key: entry.at for entry in reading.table(root, "nodes")},
    }
    sections = {"partner": "partners", "host": "hosts", "container": "containers", "use case": "use_cases"}
    plain_places = {
        kind: {entry.key: entry.at for entry in reading.table(root, section)} for kind, section in sections.items()
    }
    return References(places, plain_places, found, lost)
