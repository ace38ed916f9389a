"""A robot that was observed, held against the design: node by node, then what each of them uses."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType

from archgen.conformance.endpoint_comparison import (
    EndpointComparer,
    EndpointPair,
    ModelRemedy,
    rename_node,
    set_parameter,
)
from archgen.conformance.observed_robot import ObservedNode, ObservedRobot
from archgen.conformance.recording_comparison import RecordingComparer
from archgen.conformance.seen_record import EndState, name_end
from archgen.derivation.wire.running_state import RunningStates, has_unknown_name, is_filled_in
from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, first_written_span
from archgen.diagnostics.rule_options import OptionValues
from archgen.frozen import dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Node
from archgen.model.parameter_values import (
    canonical_name,
    describe_parameter_value,
    find_effective_parameters,
    is_ros_parameter,
)
from archgen.model.ros_distro import is_ros_1
from archgen.model.selector_keys import matches_wildcard

IGNORED_NODES = (
    *("/rviz*", "/rqt_*", "/ros2cli_*", "/_*", "*/_*", "/rosout", "/rosbag2_*", "/record_*", "/launch_ros_*"),
    *("*/transform_listener_impl_*", "/archgen_recorder"),
)
"""Nodes that are no part of a robot: tools that look at it, and what libraries make for themselves. `*` stands for any characters."""
_OF_ONE_END = frozenset({"other-name", "other-type", "other-qos"})
_ALIKE_SHARE = 0.8
_FEWEST_USES = 2
"""A node is known by what it uses, if that is the same to this share and it uses so much."""


@dataclass(frozen=True, slots=True)
class ComparedPart:
    """Which part of the design is compared: that of some hosts, all where none is named, and which nodes do not count.

    `other_nodes` are the full names of those that only other variants have.
    """

    hosts: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    other_nodes: frozenset[str] = frozenset()


@dataclass(slots=True)
class RobotComparison:
    """What came out, and what was looked at, in numbers."""

    robot: ObservedRobot
    findings: list[Diagnostic] = field(default_factory=list)
    nodes: int = 0
    seen_nodes: int = 0
    ends: dict[str, EndState] = field(default_factory=dict)
    """By their names in records, the ends of the design that were compared."""
    topics: int = 0
    """How many topics of the design somebody publishes; of a recording."""
    seen_topics: int = 0
    """How many of them have messages in it."""
    unknown: int = 0
    """Ends of the robot whose names only running the program tells."""
    compared_parameters: int = 0
    accepted: int = 0
    """How many differences the project accepts."""
    early_nodes: list[str] = field(default_factory=list)
    """Nodes that are planned, and that the robot has already."""
    remedies: list[ModelRemedy] = field(default_factory=list)
    """What to write into the design so that it says what the robot does."""

    @property
    def endpoints(self) -> int:
        """How many ends of the design were looked for."""
        return len(self.ends)

    @property
    def seen_endpoints(self) -> int:
        """How many of them are there."""
        return sum(state in {"seen", "differs"} for state in self.ends.values())

    @property
    def untold(self) -> int:
        """How many of them nobody can see there."""
        return sum(state == "untold" for state in self.ends.values())


def compare_robot(
    architecture: Architecture,
    robot: ObservedRobot,
    part: ComparedPart,
    options: Mapping[str, OptionValues] = MappingProxyType({}),
) -> RobotComparison:
    """Hold a robot against the design. What may differ by design is no finding, nor is what the robot's side cannot tell.

    `options` are those that the project sets, by rule.
    """
    if robot.kind == "recording":
        recording = RecordingComparer(architecture, robot, options)
        result = RobotComparison(robot, [*recording.compare_topics()], ends=recording.ends)
        result.topics, result.seen_topics = recording.count_expected(), recording.count_recorded()
        return result
    return _Comparer(architecture, robot, part).compare()


class _Comparer:
    """The nodes of both sides by their full names."""

    def __init__(self, architecture: Architecture, robot: ObservedRobot, part: ComparedPart) -> None:
        self._architecture = architecture
        self._robot = robot
        self._part = part
        self._states = RunningStates(architecture)
        self._endpoints = EndpointComparer(architecture, robot)
        self._result = RobotComparison(robot)
        self._pairs: list[EndpointPair] = []
        self._designed: dict[str, list[Node]] = defaultdict(list)
        for node in architecture.nodes.values():
            if not node.is_program:
                self._designed[node.full_name].append(node)
        self._hosts = {
            _fold_host(word): host.id for host in architecture.hosts.values() for word in (host.title, host.id)
        }
        patterns = (*IGNORED_NODES, *part.ignored)
        self._observed = {
            each.full_name: each
            for each in robot.nodes
            if not any(matches_wildcard(pattern, each.full_name) for pattern in patterns)
        }

    def compare(self) -> RobotComparison:
        """Compare all nodes."""
        result = self._result
        missing = [node for name, nodes in self._designed.items() for node in nodes[:1] if name not in self._observed]
        lacking = [node for node in missing if self._is_expected(node)]
        strange = [each for name, each in self._observed.items() if name not in self._designed]
        result.nodes = len(lacking) + sum(name in self._observed for name in self._designed)
        result.seen_nodes = result.nodes - len(lacking)
        result.unknown = sum(each.name is None for each in self._robot.endpoints)
        if lacking and strange and not result.seen_nodes:
            result.findings.append(self._report_other_robot(lacking))
            return result
        for node, observed in self._pair_renamed(lacking, strange):
            lacking.remove(node)
            strange.remove(observed)
            finding = self._report_other_name(node, observed)
            result.findings.append(finding)
            result.remedies.append(rename_node(finding.rule, finding.message, node, observed.full_name))
        result.findings += map(self._report_missing, lacking)
        missing_ids = {node.id for node in lacking}
        result.ends |= {name_end(each): "missing" for each in self._endpoints.list_expected(missing_ids)}
        result.findings += self._report_strange(strange)
        for name, nodes in self._designed.items():
            if name in self._observed:
                self._compare_node(nodes, self._observed[name])
        result.findings += self._endpoints.compare_qos(self._pairs)
        result.ends |= {name: "differs" for name in result.ends if name in self._endpoints.differing}
        result.remedies += self._endpoints.remedies
        result.findings[:] = self._name_other_instances(result.findings)
        return result

    def _name_other_instances(self, findings: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
        """Yield findings; where a line of a component type stands for several nodes, what to write for one goes to its instance."""
        nodes: dict[Span, dict[str, None]] = defaultdict(dict)
        for endpoint in self._architecture.endpoints:
            for place in (endpoint.at, endpoint.message_at):
                if place != NO_SPAN:
                    nodes[place][endpoint.node] = None
        components = {endpoint.port: endpoint.component for endpoint in self._architecture.endpoints}
        for finding in findings:
            shared = nodes.get(finding.span, {})
            component = components.get(finding.element)
            if finding.rule in _OF_ONE_END and len(shared) > 1 and component and finding.help:
                help_line = f"{finding.help}; this line is for {len(shared)} nodes: what is so of one alone goes to its instance `{component}`"
                yield replace(finding, help=help_line)
            else:
                yield finding

    def _is_expected(self, node: Node) -> bool:
        is_elsewhere = bool(self._part.hosts) and node.host not in self._part.hosts
        return not is_elsewhere and self._states.describe_node(node).runs not in {"planned", "off"}

    def _compare_node(self, nodes: Sequence[Node], observed: ObservedNode) -> None:
        result = self._result
        if all(node.status == "planned" for node in nodes):
            result.early_nodes.append(observed.full_name)
        if observed.count > 1 and len(nodes) == 1:
            result.findings.append(self._report_twin(nodes[0], observed))
        if len(nodes) == 1:
            result.findings += self._compare_place(nodes[0], observed)
        comparison = self._endpoints.compare_node(nodes, observed)
        self._pairs += comparison.pairs
        result.findings += comparison.findings
        states: tuple[tuple[EndState, Sequence[Endpoint]], ...] = (
            ("missing", comparison.missing),
            ("untold", comparison.untold),
            ("differs", comparison.renamed),
            ("seen", [pair.designed for pair in comparison.pairs]),
        )
        result.ends |= {name_end(each): state for state, ends in states for each in ends}
        for node in nodes if observed.parameters is not None else ():
            result.findings += self._compare_parameters(node, observed)

    def _pair_renamed(
        self, lacking: Sequence[Node], strange: Sequence[ObservedNode]
    ) -> Iterator[tuple[Node, ObservedNode]]:
        """Yield nodes that are there under another name: known by what they use, as it is called there.

        One that keeps its name in another namespace takes what it calls relative to it along.
        """
        left = list(strange)
        for node in lacking:
            designed = self._endpoints.list_uses(node.id)
            for observed in left:
                namespace, _, name = observed.full_name.rpartition("/")
                used = self._endpoints.list_observed_uses(observed.full_name)
                is_moved = name == node.name
                same = sum(
                    (use, each) in used or (is_moved and (use, _move_name(each, node.namespace, namespace)) in used)
                    for use, each in designed
                )
                if len(designed) < (1 if is_moved else _FEWEST_USES):
                    continue
                if used and same >= _ALIKE_SHARE * (len(designed) + len(used) - same):
                    left.remove(observed)
                    yield node, observed
                    break

    def _report_other_robot(self, lacking: Sequence[Node]) -> Diagnostic:
        message = (
            f"{self._robot.origin} has none of the {len(lacking)} nodes of the design: it is that of another robot"
        )
        help_line = "give what belongs to this project; a graph may be that of another `ROS_DOMAIN_ID`"
        return Diagnostic("not-running", message, Span.of_file(lacking[0].at.file), help=help_line)

    def _report_other_name(self, node: Node, observed: ObservedNode) -> Diagnostic:
        message = f"`{node.full_name}` is called `{observed.full_name}` {self._robot.where}: what it uses is the same"
        namespace, _, name = observed.full_name.rpartition("/")
        help_line = f"write `name: {name}` and `namespace: {namespace or '/'}`, or change the name there"
        place = first_written_span(node.name_at, node.at)
        return Diagnostic("other-name", message, place, None, (Label(observed.at, "seen here"),), help_line, node.id)

    def _report_missing(self, node: Node) -> Diagnostic:
        message, help_line = f"`{node.full_name}` does not run", "start it, or write `status: planned`"
        if self._robot.has_designed_starts:
            message = f"there is no program of `{node.full_name}`"
            help_line = "correct `package` and `executable`, or write `status: planned`"
        elif self._robot.kind == "workspace":
            message = f"no launch file starts `{node.full_name}`"
            help_line = "have one start it, or write `status: planned`"
        elif node.host and not self._part.hosts:
            help_line += f"; where `{node.host}` is down, name the hosts that are up with `--host`"
        message, severity = f"{message} {self._robot.where}", None
        if self._robot.unnamed_nodes:
            message += f", unless it is one of {self._robot.unnamed_nodes} whose names are computed"
            severity = Severity.NOTE
        elif has_unknown_name(node):
            message += ", unless it is called otherwise: its launch file does not say how"
            severity = Severity.NOTE
        return Diagnostic("not-running", message, node.at, severity, help=help_line, element=node.id)

    def _report_strange(self, strange: Sequence[ObservedNode]) -> Iterator[Diagnostic]:
        """Yield the nodes that the design has not; a container and what a program makes besides are known there."""
        known = {each.full_name for each in self._architecture.containers.values()} | self._part.other_nodes
        for node in self._architecture.nodes.values():
            known |= {f"{node.namespace.rstrip('/')}/{name}" for name in node.inner_nodes}
        for observed in strange:
            if observed.full_name in known:
                continue
            message = (
                f"there is a node `{observed.full_name}` {self._robot.where}, and the design has none of this name"
            )
            help_line = (
                f"write it below `nodes`, or `conform: {{ignore: [{observed.full_name}]}}` if it is no part of it"
            )
            severity = Severity.NOTE if observed.is_conditional else None
            yield Diagnostic("not-in-model", message, observed.at, severity, help=help_line, element=observed.full_name)

    def _report_twin(self, node: Node, observed: ObservedNode) -> Diagnostic:
        message = f"{observed.count} nodes are called `{observed.full_name}` {self._robot.where}"
        help_line = "stop one, or give one of them another name: ROS mixes up what they have and are told"
        labels = (Label(observed.at, "seen here"),)
        return Diagnostic("runs-twice", message, node.at, None, labels, help_line, node.id)

    def _compare_place(self, node: Node, observed: ObservedNode) -> Iterator[Diagnostic]:
        """Yield where a node is in another state, or on another computer, as far as both sides say in which and on which."""
        state, labels = self._states.describe_node(node), (Label(observed.at, "seen here"),)
        wanted = "active" if state.runs == "active" else state.lifecycle
        if "lifecycle" in node.kinds and observed.state is not None and wanted and observed.state != wanted:
            message = f"the lifecycle node `{node.full_name}` is {observed.state} {self._robot.where}, and {wanted} in the design"
            help_line = f"find out what keeps it there, or write `start: {{state: {observed.state}}}`"
            place = first_written_span(state.evidence["runs"].at if "runs" in state.evidence else node.at, node.at)
            yield Diagnostic("other-state", message, place, None, labels, help_line, node.id)
        host = self._hosts.get(_fold_host(observed.host)) if observed.host else None
        if host is not None and node.host is not None and host != node.host:
            message = f"`{node.full_name}` runs on `{host}` {self._robot.where}, and on `{node.host}` in the design"
            help_line = f"write `host: {host}`, or start it on `{node.host}`"
            yield Diagnostic("other-host", message, node.at, None, labels, help_line, node.id)

    def _compare_parameters(self, node: Node, observed: ObservedNode) -> Iterator[Diagnostic]:
        """Yield the parameters that have another value than the design gives them, or that the node does not declare."""
        ros_1, where = is_ros_1(self._architecture.distro), self._robot.where
        values = {canonical_name(name, ros_1=ros_1): value for name, value in (observed.parameters or {}).items()}
        # What stands in files of other packages counts for more than what components declare, and is not known.
        has_unknown_files = any(map(is_filled_in, node.parameter_files))
        for name, designed in find_effective_parameters(self._architecture, node).items():
            is_given_at_start = self._robot.has_designed_starts and designed.origin != "component"
            if is_given_at_start or (has_unknown_files and designed.origin in {"ros", "component"}):
                continue
            if not designed.is_known or is_ros_parameter(name, ros_1=ros_1) or _has_substitution(designed.value):
                continue
            is_declared = name in values
            if not is_declared and not (self._robot.has_all_parameters and values):
                continue
            self._result.compared_parameters += 1
            wanted = describe_parameter_value(designed.value)
            if not is_declared:
                message = f"`{node.full_name}` has no parameter `{name}` {where}: {wanted} reaches nobody"
                help_line = "correct the name, or have the program declare it"
            elif not _is_equal(designed.value, values[name]):
                seen = describe_parameter_value(values[name])
                message = f"the parameter `{name}` of `{node.full_name}` is {seen} {where}, and {wanted} in the design"
                help_line = f"write {seen} here, or set it there"
                self._result.remedies.append(set_parameter("other-parameter", message, node, designed, values[name]))
            else:
                continue
            place = first_written_span(designed.at, node.at)
            labels = (Label(observed.at, "seen here"),)
            yield Diagnostic("other-parameter", message, place, None, labels, help_line, node.id)


def _move_name(name: str | None, old_namespace: str, new_namespace: str) -> str | None:
    """Return what a name becomes whose node moves, where it stands in the namespace of that."""
    old = old_namespace.rstrip("/")
    return f"{new_namespace}{name.removeprefix(old)}" if name and name.startswith(f"{old}/") else name


def _fold_host(name: str) -> str:
    """Return what a computer calls itself, or what the design calls it, in one spelling: `arm-pc.local` is `arm_pc`."""
    return name.partition(".")[0].casefold().replace("-", "_").replace(" ", "_")


def _has_substitution(value: object) -> bool:
    return any(map(is_filled_in, value)) if isinstance(value, list | tuple) else is_filled_in(value)


def _is_equal(designed: object, observed: object) -> bool:
    """Whether two values are the same to ROS: a whole number may stand for another one with a point, but true is not 1."""
    if isinstance(designed, list | tuple) and isinstance(observed, list | tuple):
        return len(designed) == len(observed) and all(map(_is_equal, designed, observed))
    if isinstance(designed, bool) or isinstance(observed, bool):
        return designed is observed
    if isinstance(designed, int | float) and isinstance(observed, int | float):
        return abs(designed - observed) <= 1e-9 * max(abs(designed), abs(observed))
    return designed == observed
