"""The view `middleware`: components with ports, methods, commands, parameters and periods, for any robotic middleware.

The rules are R1 to R5 of "A novel model-based approach to support development cycle of robotic arm applications".

Which components of a middleware run where, how often, with which values, and what joins them: rules R2 and R5.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from archgen.plugin.findings import Diagnostic
from archgen.plugin.generating import GeneratedView, GenerationContext, tell_left_out, write_place
from archgen.plugin.model import Architecture, Component, Qos
from archgen.plugins.middlewares.component_parameters import record_middleware_parameters
from archgen.plugins.middlewares.middleware_classes import (
    ComponentClass,
    collect_component_classes,
    list_classes,
    name_classes,
    name_port_type,
    record_inputs,
    record_outputs,
)
from archgen.plugins.middlewares.middleware_names import drop_clashes, name_member, name_space, shorten_wire_name
from archgen.plugins.middlewares.middleware_types import OPAQUE, MiddlewareTypes
from archgen.plugins.middlewares.simulated_timing import find_period, find_timing


def make_view(context: GenerationContext) -> GeneratedView:
    """Return the classes with what they exchange, and what runs on which host.

    Names and connections are those of the whole architecture, also where only a part of it is asked for.
    """
    architecture = context.architecture
    types = MiddlewareTypes(architecture, name_space(architecture.project.id), context.backend)
    classes = collect_component_classes(context)
    unnamed, findings = name_classes(architecture, list_classes(classes))
    classes = {key: own for key, own in classes.items() if own.first.id not in unnamed}
    made = list_classes(classes)
    told: dict[str, list[Diagnostic]] = {}
    for own in made:
        told[own.words] = record_outputs(architecture, types, own)
        parameters, faults = record_middleware_parameters(context, own.components)
        own.record["parameters"] = parameters
        told[own.words] += faults
    for own in made:
        told[own.words] += record_inputs(architecture, types, own, classes)
    instances = {key: record_instance(context, architecture.components[key], own) for key, own in classes.items()}
    unplaced, clashes = drop_clashes(
        [(str(each["name"]), key, architecture.components[key].at) for key, each in instances.items()], "component"
    )
    instances = {key: each for key, each in instances.items() if key not in unplaced}
    for own in made:
        rates = [float(instances[each.id]["rate_hz"]) for each in own.components if each.id in instances]
        own.record["is_periodic"] = bool(rates) and all(rates)
        own.record["rate_hz"] = rates[0] if rates else 0.0
    number_interfaces(classes, instances.values())
    connections, unjoined = connect_instances(architecture, classes, instances)
    require_interfaces(context, instances, connections)
    hosts, host_clashes = record_hosts(context, instances.values(), connections)
    wanted = {key for key in context.wanted_components if key in instances}
    wanted_classes = [own for own in made if any(each.id in wanted for each in own.components)]
    wanted_hosts = [
        {**host, "instances": [each for each in host["instances"] if each["id"] in wanted]}
        for host in hosts
        if any(each["id"] in wanted for each in host["instances"])
    ]
    unjoined = [each for each in unjoined if architecture.inputs[str(each.element)].component in wanted]
    findings += clashes + unjoined + host_clashes + [each for own in wanted_classes for each in told[own.words]]
    data = {
        "title": architecture.project.title,
        "name": types.space,
        "records": types.records,
        "lists": types.lists,
        "timed": types.timed,
        "components": [own.record for own in wanted_classes],
        "instances": [each for key, each in instances.items() if key in wanted],
        "connections": [each for each in connections if {each["source_id"], each["target_id"]} & wanted],
        "hosts": wanted_hosts,
    }
    return GeneratedView(data, (*findings, *types.findings))


_NANOSECONDS = 10**9
NO_HOST = "no_host"
_ADDRESS = re.compile(r"[A-Za-z0-9][A-Za-z0-9.-]{0,49}\Z", re.ASCII)
_JOINT_NAME = ("source_name", "source_port", "target_name", "target_port")
_ALL_KEPT = 1000
"""How many values a connection holds that is to keep them all: no middleware of the three has lists without end."""


def record_instance(context: GenerationContext, component: Component, own: ComponentClass) -> dict[str, Any]:
    """Return a component as an instance of its class: where it runs, how often, and with which values."""
    timing = find_timing(context, component)
    period = find_period(timing) if timing.behaviour in {None, "periodic"} else None
    node = context.nodes_by_component.get(component.id)
    values = [
        {**each, "value": each["values"][component.id]}
        for each in own.record["parameters"]
        if component.id in each["values"]
    ]
    return {
        "id": component.id,
        "name": name_member(component.id),
        "class": own.record["name"],
        "module": own.record["module"],
        "title": component.title,
        "host": (node.host if node else None) or "",
        "period_s": float(period / _NANOSECONDS) if period else 0.0,
        "rate_hz": float(Fraction(_NANOSECONDS) / period) if period else 0.0,
        "values": values,
        "data_ports": [each["name"] for each in (*own.record["inputs"], *own.record["outputs"])],
        "calls": [each["name"] for each in own.record["calls"]],
        "has_operations": bool(own.record["operations"]),
        "place": write_place(component.at),
    }


def connect_instances(
    architecture: Architecture, classes: Mapping[str, ComponentClass], instances: Mapping[str, Mapping[str, Any]]
) -> tuple[list[dict[str, Any]], list[Diagnostic]]:
    """Return what joins instances: an output and the input that reads it, or an operation and who calls it."""
    findings: list[Diagnostic] = []
    qos = {each.port: each.qos for each in architecture.list_endpoints() if each.port and each.use == "subscribes"}
    connections: list[dict[str, Any]] = []
    called = set[str]()
    for edge in dict.fromkeys((each.output, each.input) for each in architecture.edges):
        output, reader = architecture.outputs[edge[0]], architecture.inputs[edge[1]]
        if output.component not in instances or reader.component not in instances:
            continue
        source, target = classes[output.component].record, classes[reader.component].record
        sent = _find_port(source["outputs"], output.name)
        same = [
            each for each in target["inputs"] if sent and name_port_type(each["type"]) == name_port_type(sent["type"])
        ]
        read = _find_port(same, reader.name)
        served = _find_port(source["operations"], output.name, "port")
        call = _find_port(target["calls"], reader.name)
        ends: dict[str, Any] = {
            **_record_end("source", instances[output.component], sent or served),
            **_record_end("target", instances[reader.component], read or call),
            "id": f"{output.id} -> {reader.id}",
            "place": write_place(reader.at),
        }
        ends["name"] = ".".join(str(ends.get(each)) for each in _JOINT_NAME)
        if sent and read:
            connections.append(
                {**ends, "is_call": False, "rtm": sent["type"]["rtm"], **_choose_buffer(qos.get(reader.id))}
            )
        elif served and call and (call["server"] != source["name"] or reader.id in called):
            findings.append(
                tell_left_out(
                    f"`{reader.id}` does not call `{output.id}`: "
                    + (
                        "it calls another one already"
                        if reader.id in called
                        else f"all instances of its type call one of the class `{call['server']}`"
                    ),
                    reader.at,
                    element=reader.id,
                    help_line="give it an input for each that it calls",
                )
            )
        elif served and call:
            called.add(reader.id)
            connections.append({**ends, "is_call": True, "server": source["name"]})
    return connections, findings


def _record_end(end: str, instance: Mapping[str, Any], port: Mapping[str, Any] | None) -> dict[str, Any]:
    words = {"id": instance["id"], "name": instance["name"], "class": instance["class"], "host": instance["host"]}
    if port:
        words.update(port=port["name"], wire=port["wire"])
    return {f"{end}_{key}": value for key, value in words.items()}


def _find_port(ports: Iterable[dict[str, Any]], name: str, key: str = "title") -> dict[str, Any] | None:
    return next((each for each in ports if each[key] == name), None)


def _choose_buffer(qos: Qos | None) -> dict[str, Any]:
    """Return whether values are shared or buffered: nobody wrote that there are several at once, so the newest counts."""
    if qos is None or not qos.written:
        return {"buffer": "data", "size": 1, "keeps_last": False}
    keeps_last = qos.durability == "transient_local"
    if qos.history == "keep_all":
        return {"buffer": "buffer", "size": _ALL_KEPT, "keeps_last": keeps_last}
    size = qos.depth or 1
    return {"buffer": "circular" if size > 1 else "data", "size": size, "keeps_last": keeps_last}


def number_interfaces(classes: Mapping[str, ComponentClass], instances: Iterable[dict[str, Any]]) -> None:
    """Give each instance the interfaces of Player that it provides, with numbers that differ on a host."""
    numbers: dict[tuple[str, str], int] = {}
    for instance in instances:
        record = classes[instance["id"]].record
        unfed = [each for each in record["inputs"] if not each["is_fed"]]
        provided = []
        for port in (*record["outputs"], *unfed, *record["operations"]):
            found = port["type"]["interface"] if "type" in port else None
            name = found["name"] if found else OPAQUE
            place = (instance["host"], name)
            numbers[place] = numbers.get(place, -1) + 1
            provided.append({"port": port["name"], "wire": port["wire"], "interface": name, "index": numbers[place]})
        instance["provides"] = provided


def require_interfaces(
    context: GenerationContext, instances: Mapping[str, dict[str, Any]], connections: Iterable[Mapping[str, Any]]
) -> None:
    """Give each instance the interfaces of Player that it reads or calls, with the keys that its driver knows them by."""
    for instance in instances.values():
        instance["requires"] = []
    counts: dict[tuple[str, str], int] = {}
    for each in connections:
        wire = each["target_wire"]
        place = (each["target_id"], wire)
        number = counts[place] = counts.get(place, -1) + 1
        provides = instances[each["source_id"]]["provides"]
        (provided,) = (found for found in provides if found["port"] == each["source_port"])
        key = wire if each["is_call"] else f"{wire}_{number}"
        host = each["source_host"]
        instances[each["target_id"]]["requires"].append(
            {**provided, "key": key, "wire": wire, "host": host, "address": _find_address(context, host)}
        )
    for instance in instances.values():
        sources = Counter(each["wire"] for each in instance["requires"])
        instance["source_counts"] = [{"wire": wire, "count": count} for wire, count in sources.items()]


def _find_address(context: GenerationContext, host: str) -> str:
    """Return the name under which other computers find a host: what it says, if Player can read that, else its id."""
    known = context.architecture.hosts.get(host)
    written = (known.address or "") if known else ""
    return written if _ADDRESS.match(written) else shorten_wire_name(name_member(host)) if host else "localhost"


def _list_joined_ports(connections: Iterable[Mapping[str, Any]]) -> dict[str, list[dict[str, str]]]:
    """Return the ports of each instance, by its name, with the connections that they have."""
    ports: dict[str, list[dict[str, str]]] = {}
    for each in connections:
        for end in ("source", "target") if not each["is_call"] else ():
            ports.setdefault(each[f"{end}_name"], []).append({"port": each[f"{end}_port"], "connection": each["name"]})
    return ports


def record_hosts(
    context: GenerationContext, instances: Iterable[Mapping[str, Any]], connections: Iterable[Mapping[str, Any]]
) -> tuple[list[dict[str, Any]], list[Diagnostic]]:
    """Return what runs on each host, with what joins it to others; instances without a host stand at the end."""
    by_host: dict[str, list[Mapping[str, Any]]] = {}
    places: dict[object, int] = {}
    for place, instance in enumerate(instances):
        places[instance["id"]] = place
        by_host.setdefault(str(instance["host"]), []).append(instance)
    known = context.architecture.hosts
    order = [*(each for each in known if each in by_host), *(each for each in by_host if each not in known)]
    spans = {each: known[each].at if each in known else context.architecture.project.at for each in order}
    clashing, findings = drop_clashes([(name_member(each or NO_HOST), each, spans[each]) for each in order], "host")
    by_end: dict[str, list[Mapping[str, Any]]] = {}
    for each in connections:
        for host in dict.fromkeys((str(each["source_host"]), str(each["target_host"]))):
            by_end.setdefault(host, []).append(each)
    hosts: list[dict[str, Any]] = []
    for host in order:
        if host in clashing:
            continue
        ends = by_end.get(host, [])
        others = {
            each[f"{end}_id"]: {"id": each[f"{end}_id"], "name": each[f"{end}_name"], "host": each[f"{end}_host"]}
            for end in ("source", "target")
            for each in ends
            if each[f"{end}_host"] != host
        }
        remote = sorted(others.values(), key=lambda each: places[each["id"]])
        sources = {each["source_id"] for each in ends}
        hosts.append(
            {
                "id": host,
                "name": name_member(host or NO_HOST),
                "title": known[host].title if host in known else "",
                "instances": by_host[host],
                "connections": ends,
                "remote": remote,
                "remote_sources": [each for each in remote if each["id"] in sources],
                "ports": _list_joined_ports(each for each in ends if each["target_host"] == host),
                "place": write_place(spans[host]) if host in known else "",
            }
        )
    return hosts, findings
