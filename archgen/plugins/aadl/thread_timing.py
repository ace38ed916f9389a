"""Properties of a thread become timing; what the library's threads are called tells the role."""

from __future__ import annotations

from typing import Any

from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.archgen_words import find_own_text
from archgen.plugins.aadl.port_mapping import MappedPorts
from archgen.plugins.aadl.property_values import PropertyScope, read_count, read_duration, read_time_range, read_word
from archgen.plugins.aadl.resolved_classifiers import ResolvedClassifier

_ROLES = {"message_source": "source", "filter": "filter", "message_sink": "sink", "reactive": "reactive"}
_BEHAVIOURS = {"periodic": "periodic", "sporadic": "event", "aperiodic": "event"}


def find_role(thread: ResolvedClassifier) -> str:
    """Return the role of what is made from a thread of the component-connector library, or nothing."""
    return next((role for name, role in _ROLES.items() if thread.is_made_from(name)), "")


def fits_role(role: str, ports: MappedPorts) -> bool:
    """Whether a component with these ports can have a role: its thread's need not be that of the whole process."""
    has_input = any(port.is_input and not port.is_call for port in ports.ports)
    has_output = any(not port.is_input and not port.is_call for port in ports.ports)
    has_service = any(not port.is_input and port.is_call for port in ports.ports)
    return {
        "source": has_output and not has_input,
        "filter": has_input and has_output,
        "sink": has_input and not has_output,
        "reactive": has_service,
    }[role]


def map_timing(scope: PropertyScope, path: Path) -> dict[str, Any]:
    """Return what the properties of a thread say: all but its trigger."""
    timing = _map_dispatch(scope, path)
    for name, key in (("deadline", "deadline"), ("dispatch_jitter", "jitter")):
        if text := read_duration(scope.value(path, name)):
            timing[key] = text
    if own_jitter := find_own_text(scope, path, "jitter"):
        timing["jitter"] = own_jitter
    lowest, highest = read_time_range(scope.value(path, "compute_execution_time"))
    timing |= {"wcet": highest} if highest else {}
    # From 0 on says no more than up to.
    timing |= {"bcet": lowest} if lowest and lowest != highest and not lowest.startswith("0 ") else {}
    priority = read_count(scope.inherited_value(path, "priority"))
    return timing if priority is None else {**timing, "priority": priority}


def _map_dispatch(scope: PropertyScope, path: Path) -> dict[str, Any]:
    """Return behaviour and period."""
    timing: dict[str, Any] = {}
    protocol_property = scope.find(path, "dispatch_protocol")
    protocol = read_word(scope.value(path, "dispatch_protocol"))
    if protocol_property is None and scope.hidden:
        # What the component type says need not be said again, but counts.
        own_property = scope.find_hidden(path, "dispatch_protocol")
        protocol = read_word(own_property.value if own_property else None)
    elif protocol in _BEHAVIOURS:
        timing["behaviour"] = _BEHAVIOURS[protocol]
    elif protocol == "background" and scope.resolver.names.is_own:
        timing["behaviour"] = "once"
    elif protocol_property is not None:
        words = f"a thread that is dispatched as `{protocol or 'this'}` has no behaviour here"
        scope.resolver.notes.add_counted(f"Dispatch_Protocol {protocol}", words, protocol_property.span)
    period = read_duration(scope.inherited_value(path, "period"))
    rate = find_own_text(scope, path, "rate")
    if rate:
        timing["rate"] = rate
    elif period and protocol in {"periodic", ""}:
        timing["period"] = period
    elif period:
        found = scope.find_inherited(path, "period")
        words = f"the period of a thread that is dispatched as `{protocol}` is not taken"
        if protocol == "sporadic":
            words = "the smallest distance of a sporadic thread's dispatches is no period here"
        if found:
            scope.resolver.notes.add_counted(f"Period of a {protocol} thread", words, found.span)
    return timing


def add_trigger(timing: dict[str, Any], ports: MappedPorts, triggering_ids: set[str], *, is_own: bool) -> None:
    """Say what fires a thread that an event fires, where not all of its inputs do; `is_own`: archgen wrote the model."""
    if timing.get("behaviour") != "event" and not (is_own and "behaviour" not in timing and triggering_ids):
        return
    inputs = list(dict.fromkeys(port.id for port in ports.ports if port.is_input and not port.is_call))
    if not triggering_ids and any(port.is_call and not port.is_input for port in ports.ports):
        timing["behaviour"] = "on_demand"
    elif triggering_ids and len(triggering_ids) < len(inputs):
        timing["trigger"] = [port_id for port_id in inputs if port_id in triggering_ids]


def add_port_hints(body: dict[str, Any], ports: MappedPorts, timing: dict[str, Any], *, is_own: bool) -> None:
    """Keep the kind of each port where it is not the usual one (docs/aadl.md, Hints)."""
    behaviour, trigger = timing.get("behaviour"), timing.get("trigger")
    for port in ports.ports:
        # Of a model that archgen wrote, what triggers tells the kinds of inputs.
        if port.is_call or (is_own and port.is_input and port.kind != "event port"):
            continue
        triggers = behaviour is None or (behaviour == "event" and (trigger is None or port.id in trigger))
        usual = "event data port" if port.is_input and triggers else "data port"
        if port.kind != usual:
            section = body["inputs" if port.is_input else "outputs"][port.id]
            section.setdefault("hints", {}).setdefault("aadl", {})["port"] = port.kind.removesuffix(" port")
