"""The resolved model as plain data, for other programs and code generators (`schemas/resolved.schema.json`).

Elements are keyed by their full ids, and what is not known is left out. A quantity has the text as written (`text`),
the number (`value`) and its unit (`unit`): ns, Hz, B or bit/s.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from fractions import Fraction

from archgen.model.architecture import Chain, Requirement
from archgen.model.component import Component, Group, Input, Output
from archgen.model.deployment import Link
from archgen.model.mapping import Type
from archgen.model.node import Endpoint, Node, Qos
from archgen.model.quantity import Quantity
from archgen.model.timing import Timing
from archgen.views.index import Index
from archgen.views.shapes import Record

VERSION = 1
"""Version of the format, written as `archgen_resolved`."""


def record(view: Index) -> Record:
    """Return the architecture, or the part in scope, as dicts, lists and scalars."""
    found, inside = view.architecture, view.scope.component
    return {
        "archgen_resolved": VERSION,
        "project": _picked(found.project, "id", "title", "version", "description") | _known({"distro": found.distro}),
        # Groups, components, connections, edges, nodes and topics are cut to the scope; all else is given in full.
        "partners": {p.id: _picked(p, "title", "description", "contact", "reviewers") for p in found.partners.values()},
        "use_cases": {u.id: _picked(u, "title", "description") for u in found.use_cases.values()},
        "requirements": {r.id: _requirement(view, r) for r in found.requirements.values()},
        "groups": {name: _group(view, found.groups[name]) for name in view.groups()},
        "components": {c.id: _component(view, c) for c in found.components.values() if inside(c.id)},
        "connections": [
            _picked(c, "input", "kind", "target", "outputs")
            for c in found.connections
            if inside(found.inputs[c.input].component)
        ],
        "edges": [
            _known({"from": e.output, "to": e.input, **_carried(view, e.output)})
            for e in found.edges
            if inside(found.inputs[e.input].component) or inside(found.outputs[e.output].component)
        ],
        "nodes": {node.id: _node(view, node) for node in view.nodes()},
        "topics": _topics(view),
        "types": {t.name: _type(t) for t in found.types.values()},
        "hosts": {h.id: _picked(h, "title", "cores", "tags") for h in found.hosts.values()},
        "containers": {c.id: _picked(c, "title", "host", "threads") for c in found.containers.values()},
        "links": {link.id: _link(link) for link in found.links.values()},
        "chains": {chain.id: _chain(chain) for chain in found.chains.values()},
    }


def _picked(element: object, *keys: str) -> dict[str, object]:
    """Return the named fields of an element that are known; tuples become lists."""
    values = {key: getattr(element, key) for key in keys}
    return _known({key: list(value) if isinstance(value, tuple) else value for key, value in values.items()})


def _requirement(view: Index, requirement: Requirement) -> dict[str, object]:
    served = {"served_by": [component.id for component in view.components_for.get(requirement.id, ())]}
    return _picked(requirement, "title", "description", "use_cases", "tags") | _known(dict(served))


def _group(view: Index, group: Group) -> dict[str, object]:
    components = {"components": [component.id for component in view.components(group.id)]}
    return _picked(group, "title", "description", "owner", "co_owners", "tags") | _known(dict(components))


def _type(mapped: Type) -> dict[str, object]:
    keys = ("message", "comment", "status", "request", "response", "feedback")
    return _picked(mapped, *keys) | _known({"size": _quantity(mapped.size, "B")})


def _link(link: Link) -> dict[str, object]:
    figures = {"bandwidth": _quantity(link.bandwidth, "bit/s")}
    latency = {"best": _quantity(link.best, "ns"), "worst": _quantity(link.worst, "ns")}
    return _picked(link, "title", "connects") | _known({**figures, **latency})


def _chain(chain: Chain) -> dict[str, object]:
    through = [{"kind": point.kind, "id": point.id} for point in chain.through]
    figures = {"through": through, "deadline": _quantity(chain.deadline, "ns")}
    return _picked(chain, "title", "requirements") | _known(dict(figures))


def _known(data: dict[str, object]) -> dict[str, object]:
    """Drop what is not known: None, empty lists and empty mappings."""
    # 0, False and "" stay: they are values that somebody wrote. Flags that are rarely true are given as `flag or None`.
    return {key: value for key, value in data.items() if value is not None and value not in ([], {})}


def _quantity(quantity: Quantity | None, unit: str) -> dict[str, object] | None:
    """Return a quantity as text, number and unit; `value` is in that unit."""
    return None if quantity is None else {"text": quantity.text, "value": _number(quantity.value), "unit": unit}


def _number(value: Fraction) -> int | float:
    """Return an int where that is exact, else the nearest float (JSON and YAML have no fractions)."""
    return int(value) if value.denominator == 1 else float(value)


def _component(view: Index, component: Component) -> dict[str, object]:
    return _known(
        {
            "title": component.title,
            "group": component.group,
            "owner": component.owner,
            "co_owners": list(component.co_owners),
            "role": component.role,
            "functionality": component.functionality,
            "description": component.description,
            "requirements": [use.text for use in component.requirements],
            "performance": {
                i.id: _known(
                    {"title": i.title, "accuracy": i.accuracy, "execution_time": _quantity(i.execution_time, "ns")}
                )
                for i in component.performance
            },
            "inputs": {port.name: _input(port) for port in component.inputs.values()},
            "outputs": {port.name: _output(view, port) for port in component.outputs.values()},
            "nodes": [node.id for node in view.nodes_of.get(component.id, ())],
            "timing": _timing(component.timing),
            "tags": list(component.tags),
            "urls": dict(component.urls),
        }
    )


def _port(port: Input | Output) -> dict[str, object]:
    return {
        "id": port.id,
        "type": port.type,
        "medium": "physical" if port.physical else "digital",
        "external": port.external,
        "description": port.description,
    }


def _input(port: Input) -> dict[str, object]:
    sources = dict.fromkeys(output for connection in port.connections for output in connection.outputs)
    return _known(_port(port) | {"optional": port.optional or None, "sources": list(sources)})


def _output(view: Index, port: Output) -> dict[str, object]:
    readers = dict.fromkeys(connection.input for connection in view.readers.get(port.id, ()))
    return _known(_port(port) | {"message": view.architecture.message(port), "readers": list(readers)})


def _carried(view: Index, output: str) -> dict[str, object]:
    """Return what flows along an edge: type and message of the output, and whether it is physical."""
    port = view.architecture.outputs[output]
    return {"type": port.type, "message": view.architecture.message(port), "physical": port.physical or None}


def _node(view: Index, node: Node) -> dict[str, object]:
    plain = (
        "title",
        "description",
        "owner",
        "name",
        "namespace",
        "package",
        "executable",
        "plugin",
        "container",
        "host",
        "status",
    )
    return _known(
        {
            **{key: getattr(node, key) for key in plain},
            "full_name": node.full_name,
            "kind": list(node.kinds),
            "co_owners": list(node.co_owners),
            "implements": list(node.implements),
            "derived": None if node.written else True,
            "endpoints": [_endpoint(endpoint) for endpoint in view.endpoints_of.get(node.id, ())],
            # The key is "" for a node that implements no component; the record calls it "node".
            "timing": _known({component or "node": _timing(timing) for component, timing in node.timing.items()}),
            "parameters": _plain(node.parameters),
            "parameter_files": list(node.parameter_files),
            "tags": list(node.tags),
            "urls": dict(node.urls),
        }
    )


def _plain(value: object) -> object:
    """Copy nested parameters into dicts and lists."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, (list, tuple)) else value


def _endpoint(endpoint: Endpoint) -> dict[str, object]:
    return _known(
        {
            "use": endpoint.use,
            "name": endpoint.name,
            "flow": endpoint.flow,
            "message": endpoint.message,
            "type": endpoint.type,
            "port": endpoint.port,
            "internal": endpoint.internal or None,
            "sources": list(endpoint.sources),
            "qos": _qos(endpoint.qos) if endpoint.flow == "topic" else None,
        }
    )


def _qos(qos: Qos) -> dict[str, object]:
    durations = {key: _quantity(getattr(qos, key), "ns") for key in ("deadline", "lifespan", "lease_duration")}
    # All other fields, so a new field of Qos gets into the record without a line here.
    plain = {k: v for k, v in asdict(qos).items() if k not in {*durations, "at", "written"}}
    return _known(plain | durations)


def _timing(timing: Timing | None) -> dict[str, object] | None:
    if timing is None:
        return None
    durations = ("period", "jitter", "wcet", "bcet", "throttle", "response")
    trigger = timing.trigger
    return _known(
        {
            "behaviour": timing.behaviour,
            "rate": _quantity(timing.rate, "Hz"),
            **{key: _quantity(getattr(timing, key), "ns") for key in durations},
            "trigger": _known({"mode": trigger.mode, "inputs": list(trigger.inputs or ())}) if trigger else None,
            "every": timing.every,
            "outputs": {
                name: _known({"conditional": o.conditional or None, "max_gap": _quantity(o.max_gap, "ns")})
                for name, o in timing.outputs.items()
            },
            "calls": {name: _number(count) for name, count in timing.calls.items()},
            "priority": timing.priority,
            "core": timing.core,
        }
    )


def _topics(view: Index) -> list[dict[str, object]]:
    return [
        _known(
            {
                "name": topic.name,
                "flow": topic.flow,
                "messages": list(topic.messages),
                "types": list(topic.types),
                "writers": list(dict.fromkeys(end.node for end in topic.writers)),
                "readers": list(dict.fromkeys(end.node for end in topic.readers)),
                "size": _quantity(topic.size, "B"),
            }
        )
        for topic in view.architecture.topics.values()
        if any(view.scope.node(end.node) for end in (*topic.writers, *topic.readers))
    ]
