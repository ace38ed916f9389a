"""The version of an interface: a short hash of what passes over the wire, and of what is promised of it.

Titles, ids, order, hosts, nodes and what is only expected are no part of it. The comments of fields are: units stand there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.derivation.ros_names import default_port_name
from archgen.diagnostics import Span
from archgen.model.agreed_terms import RULES, hash_text
from archgen.model.declared_timing import OutputTiming
from archgen.model.known_interfaces import Interface, InterfaceField, Interfaces
from archgen.model.node import Endpoint, Evidence, Qos
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.model.quantity import Quantity
from archgen.model.ros_distro import is_ros_1
from archgen.timing.figures.tick_unit import written_period
from archgen.views.agreement.interface_timing import find_giver_timing
from archgen.views.agreement.output_promises import identify_words, list_counted_ports
from archgen.views.agreement.promise_rows import identify_qos
from archgen.views.inline_text import format_qos
from archgen.views.lookup import Lookup

_NO_EVIDENCE = Evidence("unknown")


def hash_interface(lookup: Lookup, interface: PartnerInterface, rules: int = RULES) -> str:
    """Return the version of an interface, six hexadecimal digits. By the first rules the launch has no say in it."""
    architecture = lookup.architecture
    with_qos = interface.flow == "topic" and not is_ros_1(architecture.distro)
    givers = list_givers(lookup.architecture, interface)
    message_type = architecture.types.get(interface.type or "")
    content: dict[str, object] = {
        "flow": interface.flow,
        "names": sorted({_find_first_name(endpoint) for endpoint in interface.giver_endpoints}),
        # The type is a name of the project's own; without a message it is all that says what flows.
        "carried": interface.message or f"type {interface.type}",
        "definitions": list(_list_definitions(architecture.interfaces, interface.message)),
        "meaning": _collapse_blanks((interface.output.description if interface.output else None) or ""),
        # To write down what counted before promises it.
        "promises qos": any(_find_first_qos(lookup, each).written for each in interface.giver_endpoints) and with_qos,
        "offered": _list_qos(lookup, interface.giver_endpoints) if with_qos else [],
        "asked": _list_qos(lookup, interface.taker_endpoints) if with_qos else [],
        "promised": sorted(_list_promises(lookup, endpoint) for endpoint in givers),
        "size": _write_quantity(message_type.size if message_type else None),
    }
    freshness = {_write_quantity(port.freshness) for port in interface.inputs if port.freshness}
    # Nothing where nobody asks for it: versions that were signed stay what they are.
    content |= {"freshness": sorted(freshness)} if freshness else {}
    frame_name = architecture.frame_of(interface.output) if interface.output else None
    content |= {"frame": frame_name} if frame_name else {}
    words = identify_words(list_counted_ports(lookup, interface))
    content |= {"words": words} if words else {}
    content |= _describe_launch(interface) if rules > 1 else {}
    return hash_text(content)


def _describe_launch(interface: PartnerInterface) -> dict[str, object]:
    """Return what the launch makes of both sides, where that is not what the programs say: nothing for most interfaces."""
    parts: dict[str, set[str]] = {}
    for side, endpoints in (("gives", interface.giver_endpoints), ("takes", interface.taker_endpoints)):
        for endpoint in endpoints:
            for name, value, _ in _list_launch_parts(endpoint):
                parts.setdefault(name, set()).add(f"{side} {value}")
    return {name: sorted(values) for name, values in parts.items()}


def list_launch_words(interface: PartnerInterface) -> Iterator[tuple[str, Span]]:
    """Yield sentences on what the launch makes of an interface, each with where that is written."""
    for endpoint in (*interface.giver_endpoints, *interface.taker_endpoints):
        for name, _, sentence in _list_launch_parts(endpoint):
            reasons = (each for key, each in endpoint.evidence.items() if key.partition(".")[0] == name)
            yield sentence, next(reasons, _NO_EVIDENCE).at


def _list_launch_parts(endpoint: Endpoint) -> Iterator[tuple[str, str, str]]:
    """Yield the fields of an end that the launch has a say in, with the value and a sentence on it."""
    node, said = f"`{endpoint.node}`", endpoint.program_name or endpoint.label
    if endpoint.is_moved:
        yield "name", str(endpoint.name), f"`{said}` of {node} runs on `{endpoint.label}`"
    elif endpoint.name is None and endpoint.evidence.get("name", _NO_EVIDENCE).rule:
        yield "name", "unknown", f"nobody knows on what `{said}` of {node} runs"
    if endpoint.qos_override in {"obeyed", "unknown"}:
        doubt = ", if its program allows that" if endpoint.qos_override == "unknown" else ""
        words = f"the QoS of {node} is overridden{doubt}: {format_qos(endpoint.qos)}"
        yield "qos", f"{endpoint.qos_override} {identify_qos(endpoint.qos)}", words
    if endpoint.domain is not None:
        yield "domain", str(endpoint.domain), f"{node} runs in the domain {endpoint.domain}"
    # One that is not known is no other one: a parameter file that is not at hand is no word of the launch.
    if endpoint.clock == "simulated":
        yield "clock", "simulated", f"{node} follows simulated time"
    if endpoint.runs in {"inactive", "off"}:
        yield "runs", str(endpoint.runs), f"{node} is {endpoint.runs}"


def _find_first_qos(lookup: Lookup, endpoint: Endpoint) -> Qos:
    """Return the quality of service of an end by the first rules: what is written at it, whatever parameters make of that."""
    if endpoint.qos_override != "obeyed":
        return endpoint.qos_if_ignored or endpoint.qos
    uses = lookup.architecture.nodes[endpoint.node].uses
    named = (each for each in uses if (each.use, each.port) == (endpoint.use, endpoint.port) and each.qos)
    return next((each.qos for each in named if each.qos), Qos())


def _find_first_name(endpoint: Endpoint) -> str:
    """Return the name of an end by the first rules: a launch moved nothing, and one that nobody says was made of the port."""
    if endpoint.is_moved and endpoint.program_name:
        return endpoint.program_name
    return endpoint.name or default_port_name(endpoint.port or endpoint.label)


def _list_definitions(interfaces: Interfaces, message: str | None) -> Iterator[object]:
    """Yield the definition of a message and of all that it holds: each once, in the order of their fields."""
    waiting, seen = [message] if message else [], set[str]()
    while waiting:
        name = waiting.pop(0)
        definition = interfaces.definitions.get(name)
        if name in seen or definition is None:
            continue
        seen.add(name)
        yield [name, *_write_definition(definition)]
        waiting += [field.type for part in definition.parts for field in part if "/" in field.type]


def _write_definition(definition: Interface) -> Iterator[object]:
    for part in definition.parts:
        yield [
            [field.name, field.type + field.array, field.default, _read_comment(definition, field)] for field in part
        ]
    # Constants have no place on the wire: their order says nothing.
    for constants in definition.constants:
        yield sorted([item.name, item.type, item.value, _collapse_blanks(item.comment)] for item in constants)


def _read_comment(definition: Interface, field: InterfaceField) -> str:
    """Return what is said of a field. An introduction counted as said of the header: signed versions stay what they are."""
    introduction = definition.introduction if field.name == "header" else ""
    return _collapse_blanks(f"{introduction} {field.comment}")


def _list_qos(lookup: Lookup, endpoints: Iterable[Endpoint]) -> list[str]:
    """Return the distinct qualities of service of written nodes, sorted."""
    nodes = lookup.architecture.nodes
    return sorted({identify_qos(_find_first_qos(lookup, each)) for each in endpoints if nodes[each.node].written})


def _list_promises(lookup: Lookup, endpoint: Endpoint) -> list[str]:
    timing = find_giver_timing(lookup, endpoint)
    output_timing = timing.outputs.get(endpoint.port or "", OutputTiming())
    behaviour = timing.behaviour if timing.behaviour in {"once", "on_demand"} else ""
    return [
        str(behaviour),
        str(written_period(timing)),
        str(output_timing.conditional),
        # Of what is sent at each activation `max_gap` says nothing.
        *map(
            _write_quantity,
            (output_timing.max_gap if output_timing.conditional else None, timing.jitter, timing.response),
        ),
    ]


def _write_quantity(quantity: Quantity | None) -> str:
    return str(quantity.value) if quantity else ""


def _collapse_blanks(text: str) -> str:
    """Return a text with single spaces: line breaks say nothing."""
    return " ".join(text.split())
