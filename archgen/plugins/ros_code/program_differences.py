"""Where nodes of one program ask for more than one program can be: each is told, and the first node's way is generated.

The timers of a generated program: what runs by the clock.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction

from archgen.plugin.findings import Diagnostic
from archgen.plugin.generating import PORT_SECTIONS, make_snake_name, name_endpoints, record_qos, tell_left_out
from archgen.plugin.model import Endpoint, Node

_NODE_FACTS: Mapping[str, Callable[[Node], object]] = {
    "kinds": lambda node: node.kinds,
    "threads": lambda node: node.threads,
    "reentrant callbacks": lambda node: node.reentrant,
    "callback groups": lambda node: [
        sorted(each.rpartition(".")[2] for each in members) for members in node.callback_groups.values()
    ],
    "periods": lambda node: [timer["period_ns"] for timer in list_timers(node)],
}
"""What a program has once, and how each of its nodes says it."""


def find_program_differences(
    program_name: str, nodes: Sequence[Node], endpoints: Mapping[str, Sequence[Endpoint]]
) -> Iterator[Diagnostic]:
    """Yield what the nodes of one program say differently from the first of them, one finding a node and a fact."""
    first, *others = nodes
    if not others:
        return
    ports_by_node = _list_ports(nodes, endpoints)
    first_ports = ports_by_node[first.id]
    for node in others:
        differences = [fact for fact, read in _NODE_FACTS.items() if read(node) != read(first)]
        ports = ports_by_node[node.id]
        differences += [
            f"QoS of `{key}`"
            for section, key in sorted(ports.keys() & first_ports.keys())
            if record_qos(ports[section, key].qos) != record_qos(first_ports[section, key].qos)
        ]
        if differences:
            yield _tell_difference(program_name, first, node, f"other {', '.join(differences)} than")
        foreign_keys = sorted({key for _, key in ports.keys() ^ first_ports.keys()})
        if foreign_keys:
            named = ", ".join(f"`{key}`" for key in foreign_keys)
            yield _tell_difference(program_name, first, node, f"not the same ports ({named}) as")


def _list_ports(
    nodes: Sequence[Node], endpoints: Mapping[str, Sequence[Endpoint]]
) -> Mapping[str, Mapping[tuple[str, str], Endpoint]]:
    ports: dict[str, dict[tuple[str, str], Endpoint]] = {node.id: {} for node in nodes}
    for endpoint, key in name_endpoints(nodes, endpoints):
        ports[endpoint.node][PORT_SECTIONS[endpoint.use, endpoint.flow], key] = endpoint
    return ports


def _tell_difference(program_name: str, first: Node, node: Node, words: str) -> Diagnostic:
    return tell_left_out(
        f"the program `{program_name}` is generated as `{first.id}` needs it: `{node.id}` has {words} `{first.id}`",
        node.at,
        element=node.id,
        help_line="give one of the nodes an `executable` of its own, or let them say the same",
    )


_NANOSECONDS = 10**9


def list_timers(node: Node) -> Iterator[dict[str, object]]:
    """Yield what runs by the clock: a timer for each component of the node that is periodic."""
    for component, timing in sorted(node.timing.items()):
        period = timing.period.value if timing.period else None
        if period is None and timing.rate and timing.rate.value:
            period = Fraction(_NANOSECONDS) / timing.rate.value
        if period and timing.behaviour in {None, "periodic"}:
            name = "" if len(node.timing) == 1 else make_snake_name(component.rpartition(".")[2])
            yield {"key": name, "component": component, "period_ns": round(period), "period_s": _format_seconds(period)}


def _format_seconds(duration_ns: Fraction) -> str:
    """Return a duration in seconds as code has it: `0.1`."""
    return f"{float(duration_ns) / _NANOSECONDS:.9f}".rstrip("0").removesuffix(".") + (
        "" if duration_ns % _NANOSECONDS else ".0"
    )
