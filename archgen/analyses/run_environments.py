"""Are the two ends of a connection in one domain, and do they live by one clock?"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping

from archgen.derivation.wire.running_state import (
    DOMAIN_VARIABLE,
    domain_of,
    find_environment,
    is_filled_in,
    read_domain,
)
from archgen.diagnostics import Diagnostic, Label, Severity, Span, join_words
from archgen.model.architecture import Architecture
from archgen.model.deployment import Container
from archgen.model.node import Endpoint, Node
from archgen.model.ros_distro import is_ros_1

NodePair = tuple[str, str]
_BRIDGE_PACKAGE = "domain_bridge"
_GREATEST_SAFE_DOMAIN = 101
"""Above it, ports of domains overlap with those that systems give to whoever asks."""
_GREATEST_DOMAIN = 232
_MAX_SHOWN = 3
"""Topics that one finding names."""
_STAMP_TYPES = frozenset(
    {"std_msgs/Header", "std_msgs/msg/Header", "builtin_interfaces/Time", "builtin_interfaces/msg/Time"}
)


def two_domains(architecture: Architecture) -> Iterator[Diagnostic]:
    """Two ends of a connection are in two domains of ROS."""
    if any(node.package == _BRIDGE_PACKAGE for node in architecture.nodes.values()):
        return  # what it carries from one to the other stands in files of its own
    for (writer, reader), ends in _gather_ends(architecture, _are_apart).items():
        first_writer, first_reader = ends[0]
        evidences = [each.evidence["domain"] for each in (first_reader, first_writer) if "domain" in each.evidence]
        yield Diagnostic(
            "two-domains",
            f"`{reader}` and `{writer}` never hear of each other, on {_list_names(ends)}: "
            f"`{writer}` is in {_describe_domain(first_writer)}, `{reader}` in {_describe_domain(first_reader)}",
            evidences[0].at,
            labels=tuple(Label(each.at, "the other domain") for each in evidences[1:]),
            help=f"give both the same `{DOMAIN_VARIABLE}`, or put a `{_BRIDGE_PACKAGE}` between them",
            element=reader if "domain" in first_reader.evidence else writer,
        )


def _are_apart(writer: Endpoint, reader: Endpoint) -> bool:
    domains = (domain_of(writer), domain_of(reader))
    return None not in domains and domains[0] != domains[1]


def _describe_domain(endpoint: Endpoint) -> str:
    return "the usual one" if endpoint.domain is None else f"the domain {endpoint.domain}"


def _gather_ends(
    architecture: Architecture, is_odd: Callable[[Endpoint, Endpoint], bool]
) -> Mapping[NodePair, list[tuple[Endpoint, Endpoint]]]:
    """Return the pairs of ends that belong together and are at odds, by their nodes: writer, then reader.

    On a topic that all nodes share only connections count; elsewhere whoever reads it waits for all that write it.
    """
    # What archgen adds for components without nodes is not decided yet.
    written = {node.id for node in architecture.nodes.values() if node.written}
    pairs: dict[NodePair, list[tuple[Endpoint, Endpoint]]] = defaultdict(list)
    for topic in architecture.topics.values():
        # Most topics have one state at all ends.
        if len({(domain_of(end), end.clock) for end in (*topic.writers, *topic.readers)}) < 2:  # noqa: PLR2004 - two ends
            continue
        for reader in topic.readers:
            sources = frozenset(reader.sources)
            for writer in topic.writers:
                is_joined = writer.port in sources if sources else not topic.shared
                if (
                    is_joined
                    and writer.node != reader.node
                    and written >= {writer.node, reader.node}
                    and is_odd(writer, reader)
                ):
                    pairs[writer.node, reader.node].append((writer, reader))
    return pairs


def _list_names(ends: list[tuple[Endpoint, Endpoint]]) -> str:
    names = list(dict.fromkeys(f"`{reader.label}`" for _, reader in ends))
    more = [f"{len(names) - _MAX_SHOWN} more"] if len(names) > _MAX_SHOWN else []
    return join_words([*names[:_MAX_SHOWN], *more])


def invalid_domain(architecture: Architecture) -> Iterator[Diagnostic]:
    """A domain of ROS is no number, or another one than it looks like, or one with which processes may not start."""
    if is_ros_1(architecture.distro):
        return
    seen_places = set[Span]()
    started: list[Node | Container] = [*architecture.nodes.values(), *architecture.containers.values()]
    for each in started:
        text, place = find_environment(architecture, each).get(DOMAIN_VARIABLE, ("", each.at))
        fault = None if is_filled_in(text) or place in seen_places else _find_domain_fault(text)
        seen_places.add(place)  # what a host or the project says is one slip
        if fault:
            reason, proposal, severity = fault
            yield Diagnostic(
                "invalid-domain",
                f"`{DOMAIN_VARIABLE}` is `{text}`, {reason}",
                place,
                severity,
                help=f"write {proposal}",
                element=each.id,
            )


def _find_domain_fault(text: str) -> tuple[str, str, Severity] | None:
    """Return what is wrong with a domain, what to write in its place, and how serious it is; None where all is well."""
    domain, usable = read_domain(text), f'a number from 0 to {_GREATEST_SAFE_DOMAIN}, such as `"42"`'
    if domain is None:
        return "no number: what is started with it ends at once", usable, Severity.ERROR
    if domain > _GREATEST_DOMAIN:
        return f"but there are domains only up to {_GREATEST_DOMAIN}", usable, Severity.ERROR
    if text and text != str(domain):
        return f"which is read as {domain}", f'`"{domain}"`', Severity.WARNING
    if domain > _GREATEST_SAFE_DOMAIN:
        return "and ports of domains that great may be taken by any other program", usable, Severity.WARNING
    return None


_HANDING_ON = frozenset({"ros_gz_bridge", "ros_gz_image"})
"""Packages of bridges to a simulator: the times in what they hand on are the simulator's, whatever clock they have."""


def two_clocks(architecture: Architecture) -> Iterator[Diagnostic]:
    """One end of a connection lives by simulated time, and the other one by the system's."""
    clock_writers = {end.node for end in architecture.endpoints if end.name == "/clock" and end.use == "publishes"}
    shared_places = {each.at for each in architecture.ros_parameters}
    for (writer, reader), ends in _gather_ends(architecture, _differ_in_time).items():
        simulated, other = sorted(ends[0], key=lambda end: end.clock != "simulated")
        if other.node in clock_writers or architecture.nodes[other.node].package in _HANDING_ON:
            continue
        # What one of the two says by itself is what is odd, not what holds for all.
        evidences = [end.evidence["clock"] for end in (simulated, other) if "clock" in end.evidence]
        evidence = min(evidences, key=lambda each: each.at in shared_places)
        nodes = [architecture.nodes[each] for each in (writer, reader)]
        has_timer = any(timing.period or timing.rate for node in nodes for timing in node.timing.values())
        is_telling = has_timer or any(_carries_time(architecture, end) for end, _ in ends)
        yield Diagnostic(
            "two-clocks",
            f"`{simulated.node}` lives by simulated time, and `{other.node}` by the system's: "
            f"what they say of times on {_list_names(ends)} does not fit",
            evidence.at,
            severity=None if is_telling else Severity.NOTE,
            help="write `use_sim_time` into `parameters` of `ros`, for all nodes, or say the same at both",
            element=simulated.node,
        )


def _differ_in_time(writer: Endpoint, reader: Endpoint) -> bool:
    has_both = writer.clock is not None and reader.clock is not None and "off" not in {writer.runs, reader.runs}
    return has_both and writer.clock != reader.clock and writer.flow == "topic"


def _carries_time(architecture: Architecture, endpoint: Endpoint) -> bool:
    """Whether a message has a time stamp; one that is not known may have one."""
    definition = architecture.interfaces.definitions.get(endpoint.message or "")
    return definition is None or any(each.type in _STAMP_TYPES for part in definition.parts for each in part)


RULES = (
    (two_domains, Severity.ERROR),
    (invalid_domain, Severity.ERROR),
    (two_clocks, Severity.WARNING),
)
