"""In which domain and by which clock a node runs, and whether it runs at all; and the ends of all nodes with what follows.

What is not known stays unknown: a domain that a launch argument fills in is equal to nothing, and differs from nothing.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, partial
from itertools import groupby
from operator import attrgetter

from archgen.derivation.derived_parts import DerivedParts
from archgen.derivation.wire.qos_overrides import QosOverride, list_overrides, override_qos
from archgen.derivation.wire.wire_names import list_parameter_words
from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.deployment import Container, Host
from archgen.model.node import NO_START, Clock, Endpoint, Evidence, LifecycleState, Node, RunState, UseKind
from archgen.model.parameter import format_parameter
from archgen.model.parameter_values import EffectiveParameter, find_effective_parameters
from archgen.model.ros_distro import can_name_peers, is_ros_1, knows_super_clients

DOMAIN_VARIABLE = "ROS_DOMAIN_ID"
SUPER_CLIENT_VARIABLE = "ROS_SUPER_CLIENT"
"""What looks at all nodes is told of all by a discovery server; the nodes themselves only of those that they meet."""
FAST_DDS = "rmw_fastrtps"
CLOCK_PARAMETER = "use_sim_time"
_MANAGER_PROGRAM = "lifecycle_manager"
"""What the package, the program or the class of a lifecycle manager has in its name."""
ANY_NODE = "*"
"""What stands for the name of a node where it is not known."""
_LAUNCH_HINT = "launch"
_NUMBER = re.compile(r"\s*([+-]?)(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
_MAX_DIGITS = 40
_NO_DOMAIN = 2**64 - 1
"""What rcl takes for "none is set"; `-1` is read as this number."""


def find_environment(architecture: Architecture, node: Node | Container) -> Mapping[str, tuple[str, Span]]:
    """Return the variables with which the process of a node or container is started, each with its place.

    Later ones win: what `ros.discovery` comes to, the project's, the host's, its own. What a container loads has that of the container's process, of
    which only imported hints tell more.
    """
    variables = {name: (text, architecture.distro_at) for name, text in list_discovery(architecture, node.host).items()}
    variables |= {each.name: (str(each.value), each.at) for each in architecture.ros_environment}
    if host := architecture.hosts.get(node.host or ""):
        variables |= {name: (text, host.environment_places[name]) for name, text in host.environment.items()}
    container = node if isinstance(node, Container) else architecture.containers.get(node.container or "")
    if container is not None:
        hinted = _read_hint(container, "environment")
        given = hinted.items() if isinstance(hinted, Mapping) else ()
        hint_places = container.annotations.hint_places
        variables |= {
            name: (str(text), hint_places.get((_LAUNCH_HINT, "environment", name), container.at))
            for name, text in given
        }
    elif isinstance(node, Node) and node.start is not None:
        places = node.start.places
        variables |= {
            name: (text, places.get(f"environment.{name}", node.at)) for name, text in node.start.environment.items()
        }
    return variables


def list_discovery(architecture: Architecture, host_id: str | None) -> dict[str, str]:
    """Return the variables by which nodes of a host find those of others: nothing where multicast does it."""
    if servers := list_discovery_servers(architecture):
        addresses = ";".join(f"{each.network_name}:{each.discovery_server}" for each in servers)
        return {"ROS_DISCOVERY_SERVER": addresses, SUPER_CLIENT_VARIABLE: "FALSE"}
    if architecture.ros_discovery != "peers" or not can_name_peers(architecture.distro):
        return {}
    names = list_peers(architecture, host_id)
    return {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", **({"ROS_STATIC_PEERS": ";".join(names)} if names else {})}


def list_discovery_servers(architecture: Architecture) -> tuple[Host, ...]:
    """Return the hosts whose discovery servers the nodes of all hosts ask; none where they read no addresses of servers."""
    if architecture.ros_discovery != "server" or not knows_super_clients(architecture.distro):
        return ()
    written = (str(each.value) for each in architecture.ros_environment if each.name == "RMW_IMPLEMENTATION")
    is_fast_dds = next(written, FAST_DDS).startswith(FAST_DDS)
    return tuple(host for host in architecture.hosts.values() if is_fast_dds and host.discovery_server)


def list_peers(architecture: Architecture, host_id: str | None) -> tuple[str, ...]:
    """Return the addresses of the hosts with which one shares a link; where nobody says which network there is, of all others.

    Without those that have no address and run nothing, such as a controller: a name that cannot be resolved keeps nodes from starting.
    """
    running_hosts = {node.host for node in architecture.nodes.values()}
    hosts = {name: host for name, host in architecture.hosts.items() if host.address or name in running_hosts}
    peers = [other for link in architecture.links.values() if host_id in link.connects for other in link.connects]
    found = peers if any(len(link.connects) > 1 for link in architecture.links.values()) else list(hosts)
    return tuple(dict.fromkeys(hosts[each].network_name for each in found if each in hosts and each != host_id))


def has_unknown_name(node: Node) -> bool:
    """Whether an import found nobody who says what a node is called."""
    return _read_hint(node, "name") == "unknown"


def _read_hint(element: Node | Container, key: str) -> object:
    """Return what an import of launch files says of a node or container beside the model."""
    hint = element.annotations.hints.get(_LAUNCH_HINT)
    return hint.get(key) if isinstance(hint, Mapping) else None


def read_domain(text: str) -> int | None:
    """Return the domain that ROS 2 reads from a text, as C reads a number. None where it reads none and ends."""
    match = _NUMBER.match(text)
    if match is None:
        return None if text else 0
    sign, digits = match.groups()
    if len(digits) > _MAX_DIGITS:
        return None
    # In C a leading 0 makes a number octal.
    number = int(digits, 16 if digits[:2].lower() == "0x" else 8 if digits[0] == "0" else 10)
    if number > _NO_DOMAIN or (number == 0 and match.end() < len(text)):
        return None
    number = -number % (_NO_DOMAIN + 1) if sign == "-" else number
    return 0 if number == _NO_DOMAIN else number


def is_filled_in(value: object) -> bool:
    """Whether a launch file fills a value in: then nobody knows it."""
    return isinstance(value, str) and "$(" in value


def domain_of(endpoint: Endpoint) -> int | None:
    """Return the domain of an end for comparing it with others: 0 where nothing sets one, None where it is unknown."""
    if endpoint.domain is None:
        return None if "domain" in endpoint.evidence else 0
    return endpoint.domain


@dataclass(frozen=True, slots=True)
class NodeState:
    """What holds for all ends of a node: domain, clock, overrides, and what its program does until it is active."""

    domain: int | None
    clock: Clock | None
    runs: RunState | None
    lifecycle: LifecycleState | None
    """The state in which it stays, where that is not `active`."""
    overrides: Mapping[tuple[str, UseKind | None], list[QosOverride]]
    """By the name on the wire and the use of the ends that they name."""
    evidence: Mapping[str, Evidence]
    active_evidence: Mapping[str, Evidence]
    """What is evidence of an end that runs, too: all but why others do not."""
    places: tuple[Span, ...]
    """Those of the evidence, which does not compare them."""


class RunningStates:
    """Finds the states of nodes: what concerns several is looked up once."""

    def __init__(self, architecture: Architecture) -> None:
        """Take the architecture; what is asked for is looked up then."""
        self._architecture = architecture
        self._is_ros_1 = is_ros_1(architecture.distro)

    def describe_node(self, node: Node) -> NodeState:
        """Return the state of a node."""
        evidence: dict[str, Evidence] = {}
        domain = None if self._is_ros_1 else self._find_domain(node, evidence)
        clock = "system" if node.is_program else self._find_clock(node, evidence)
        runs, lifecycle = self._find_run_state(node, evidence)
        overrides: dict[tuple[str, UseKind | None], list[QosOverride]] = {}
        for override in () if self._is_ros_1 or node.is_program else list_overrides(self._architecture, node):
            overrides.setdefault(override.wire_end, []).append(override)
        places = tuple(each.at for each in evidence.values())
        active_evidence = {name: each for name, each in evidence.items() if name != "runs"}
        return NodeState(domain, clock, runs, lifecycle, overrides, evidence, active_evidence, places)

    def _find_domain(self, node: Node, evidence: dict[str, Evidence]) -> int | None:
        text, place = find_environment(self._architecture, node).get(DOMAIN_VARIABLE, (None, NO_SPAN))
        if text is None:
            return None
        domain = None if is_filled_in(text) else read_domain(text)
        rule = f"{DOMAIN_VARIABLE}={text}"
        evidence["domain"] = Evidence("unknown" if domain is None else "written", rule, place)
        return domain

    def _find_clock(self, node: Node, evidence: dict[str, Evidence]) -> Clock | None:
        value, rule, place = self._shared_time if self._is_ros_1 else self._find_time(node)
        if value is None and not rule:
            return "system"
        clock: Clock | None = "simulated" if value is True else "system" if value is False else None
        evidence["clock"] = Evidence("unknown" if clock is None else "written", rule, place)
        return clock

    @cached_property
    def _shared_time(self) -> tuple[object, str, Span]:
        """What counts in ROS 1, where the clock is one parameter of all nodes."""
        found = (self._find_time(node) for node in self._architecture.nodes.values() if not node.is_program)
        return max(found, key=lambda time: time[0] is True, default=(None, "", NO_SPAN))

    def _find_time(self, node: Node) -> tuple[object, str, Span]:
        """Return the value of `use_sim_time`, with what says it and where; nothing where nobody says anything."""
        given = find_parameters(self._architecture, node, CLOCK_PARAMETER).get(CLOCK_PARAMETER)
        if given is not None and given.origin != "none" and given.value is not None:
            return given.value, f"{CLOCK_PARAMETER}: {str(given.value).lower()}", given.at
        if given is not None and given.origin == "command":
            return None, CLOCK_PARAMETER, given.at
        if node.unread_files:
            return None, f"{node.unread_files[0]} is not at hand", node.at
        words = [] if self._is_ros_1 else [w for w in list_parameter_words(node) if w.name == CLOCK_PARAMETER]
        if words:
            rule = f"-p {CLOCK_PARAMETER}:={format_parameter(words[-1].value)}"
            return words[-1].value, rule, words[-1].at
        return None, "", NO_SPAN

    def _find_run_state(
        self, node: Node, evidence: dict[str, Evidence]
    ) -> tuple[RunState | None, LifecycleState | None]:
        """Return whether a node runs, and the state in which a lifecycle node stays short of `active`."""
        if node.status == "planned":
            evidence["runs"] = Evidence("written" if node.written else "generated", "status: planned", node.at)
            return "planned", None
        container = self._architecture.containers.get(node.container or "")
        for element in (node, container) if container else (node,):
            if _read_hint(element, "by_default") == "off":
                place = element.annotations.hint_places.get((_LAUNCH_HINT, "by_default"), element.at)
                evidence["runs"] = Evidence("written", "by_default: off", place)
                return "off", None
        if "lifecycle" not in node.kinds or self._is_ros_1:
            return "active", None
        start = node.start or NO_START
        if start.state is not None and start.state != "active":
            evidence["runs"] = Evidence("written", f"state: {start.state}", start.places.get("state", node.at))
            return "inactive", start.state
        if not start.wanted_state and self.managers.get(node.full_name) is not True:
            evidence["runs"] = Evidence("unknown", "nobody activates it", node.kind_at)
            return None, None
        return "active", None

    @cached_property
    def managers(self) -> Mapping[str, bool]:
        """The full names of nodes that a lifecycle manager lists, each with whether it activates them by itself.

        A manager whose list is unknown may manage `ANY_NODE`.
        """
        managed: dict[str, bool] = {}
        # What lists nothing itself is told, in launch files that archgen writes, who names it in `by`.
        named = {node.start.by.id for node in self._architecture.nodes.values() if node.start and node.start.by}
        for node in self._architecture.nodes.values():
            if node.status == "planned" or _MANAGER_PROGRAM not in f"{node.package} {node.executable} {node.plugin}":
                continue
            parameters = find_parameters(self._architecture, node, "node_names", "autostart")
            names = parameters["node_names"].value if "node_names" in parameters else None
            autostart = parameters["autostart"].value if "autostart" in parameters else None
            if not isinstance(names, Sequence) or isinstance(names, str) or any(map(is_filled_in, names)):
                if names is not None or named.isdisjoint((node.id, *node.implements)):
                    managed[ANY_NODE] = False
                continue
            for name in map(str, names):
                full_name = name if name.startswith("/") else f"{node.namespace.rstrip('/')}/{name}"
                managed[full_name] = managed.get(full_name, False) or autostart is True
        return managed


def find_parameters(architecture: Architecture, node: Node, *names: str) -> Mapping[str, EffectiveParameter]:
    """Return the parameters of a node, unless it has none of some names."""
    wanted = frozenset(names)
    components = (architecture.components[name].parameters for name in node.implements)
    given = (
        each.name.strip("~/")
        for part in (architecture.ros_parameters, node.file_values, node.own_values)
        for each in part
    )
    if wanted.isdisjoint(given) and all(wanted.isdisjoint(each) for each in components):
        return {}  # of nearly all nodes
    return find_effective_parameters(architecture, node)


def complete_states(
    architecture: Architecture, endpoints: Iterable[Endpoint], memory: DerivedParts
) -> tuple[Endpoint, ...]:
    """Return the ends of all nodes with their domain, clock and quality of service, and whether they run.

    Their names are known before: overrides of quality of service name the wire.
    """
    states = RunningStates(architecture)
    completed: list[Endpoint] = []
    for node_id, node_endpoints in groupby(endpoints, attrgetter("node")):
        own_endpoints = tuple(node_endpoints)
        node = architecture.nodes[node_id]
        state = states.describe_node(node)
        if not state.evidence and not state.overrides:
            completed += own_endpoints
            continue
        complete = partial(_complete_endpoint, node, state)
        completed += memory.complete_endpoints(node, own_endpoints, state, complete)
    return tuple(completed)


def _complete_endpoint(node: Node, state: NodeState, endpoint: Endpoint) -> Endpoint:
    runs = _find_end_state(node, state, endpoint)
    evidence = state.active_evidence if runs == "active" else state.evidence
    completed = replace(
        endpoint,
        domain=state.domain,
        clock=state.clock,
        runs=runs,
        evidence={**endpoint.evidence, **evidence} if endpoint.evidence else evidence,
    )
    overrides = state.overrides.get((endpoint.name or "", endpoint.use)) if endpoint.flow == "topic" else None
    return override_qos(completed, overrides) if overrides else completed


def _find_end_state(node: Node, state: NodeState, endpoint: Endpoint) -> RunState | None:
    """Return whether an end of a node runs. Publishers of lifecycle nodes are managed, but for plain ones in rclpy.

    What a generated one uses is made as it is configured; when programs of others do that is not known.
    """
    if state.lifecycle is None:
        return state.runs
    if node.is_generated:
        is_made = state.lifecycle == "inactive"
        return "active" if is_made and endpoint.use != "publishes" else "inactive"
    if endpoint.use == "publishes":
        return None if node.language == "python" else "inactive"
    return "active" if state.lifecycle == "inactive" else None
