"""What one node uses on the robot, held against the design: names, types, quality of service; and what to write to make
them agree.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from archgen.analyses.qos_compatibility import find_qos_conflicts
from archgen.conformance.observed_robot import ObservedEndpoint, ObservedNode, ObservedRobot
from archgen.conformance.seen_record import name_end
from archgen.derivation.ros_names import shared_topic_names
from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, first_written_span, join_words
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.common_callbacks import is_common_callback
from archgen.model.node import Endpoint, Node
from archgen.model.parameter_values import EffectiveParameter
from archgen.model.port_media import ROS


class ModelRemedy(NamedTuple):
    """Values below a key of a node's description, or one that stands where it is written (`at`).

    `rule` and `message` are those of the finding that it ends; where the design says nothing there is none, and the message says what it
    will say. `path` begins behind the node. An entry in short form holds what its `short_key` does.
    """

    rule: str
    message: str
    element: str
    node: str
    path: tuple[str, ...]
    values: Mapping[str, Any]
    short_key: str = ""
    at: Span = NO_SPAN
    is_gap: bool = False
    """Whether the design says nothing of it yet, so that nothing of it is taken back."""


def _name_endpoint(rule: str, message: str, node: Node, endpoint: Endpoint, seen: ObservedEndpoint) -> ModelRemedy:
    """Give an end of the design the name that it has on the robot."""
    path, short_key = _find_entry(node, endpoint)
    element = endpoint.port or node.id
    is_gap = endpoint.name is None
    return ModelRemedy(
        rule, message, element, node.id, path, {short_key: seen.name}, short_key=short_key, is_gap=is_gap
    )


def _type_endpoint(rule: str, message: str, node: Node, endpoint: Endpoint, seen: ObservedEndpoint) -> ModelRemedy:
    """Give an end of the design the type that it has on the robot: where its type is written, else at the node."""
    path, short_key = _find_entry(node, endpoint)
    return ModelRemedy(
        *(rule, message, endpoint.port or node.id, node.id, path, {"message": seen.message}, short_key),
        at=endpoint.message_at if endpoint.message is not None else NO_SPAN,
        is_gap=endpoint.message is None,
    )


def _qualify_endpoint(
    rule: str, message: str, node: Node, endpoint: Endpoint, policies: Mapping[str, Any]
) -> ModelRemedy:
    """Give an end of the design policies of its quality of service."""
    path, short_key = _find_entry(node, endpoint)
    # A policy without a limit is one that is not written.
    values = {policy: _show_policy(value) for policy, value in policies.items() if value is not None}
    is_gap = not endpoint.qos.written
    return ModelRemedy(
        rule, message, endpoint.port or node.id, node.id, path, {"qos": values}, short_key, is_gap=is_gap
    )


def _add_internal(rule: str, message: str, node: Node, key: str, seen: ObservedEndpoint) -> ModelRemedy:
    """Give a node an end that no component of it knows."""
    values = {_name_key(seen.use): seen.name, **({"message": seen.message} if seen.message else {})}
    return ModelRemedy(rule, message, node.id, node.id, ("internal", seen.use, key), values)


def set_parameter(rule: str, message: str, node: Node, designed: EffectiveParameter, value: object) -> ModelRemedy:
    """Give a parameter the value that it has on the robot: at the node, whose values count most."""
    at = designed.at if designed.origin == "node" else NO_SPAN
    return ModelRemedy(rule, message, node.id, node.id, ("parameters",), {designed.name: value}, at=at)


def rename_node(rule: str, message: str, node: Node, full_name: str) -> ModelRemedy:
    """Give a node the name and the namespace that it has on the robot."""
    namespace, _, name = full_name.rpartition("/")
    old_namespace, _, old_name = node.full_name.rpartition("/")
    values = {"name": name} if name != old_name else {}
    values |= {"namespace": namespace or "/"} if namespace != old_namespace else {}
    return ModelRemedy(rule, message, node.id, node.id, (), values)


def _find_entry(node: Node, endpoint: Endpoint) -> tuple[tuple[str, ...], str]:
    """Return where a node says what an end is, and what its short form holds."""
    used = [
        each.key
        for each in node.uses
        if each.use == endpoint.use and (each.port == endpoint.port if endpoint.port else each.at == endpoint.at)
    ]
    port = endpoint.port or ""
    component, _, name = port.rpartition(".")
    key = used[0] if used else name if len(node.implements) == 1 else f"{component.rpartition('.')[2]}.{name}"
    return (*(("internal",) if endpoint.internal else ()), endpoint.use, key), _name_key(endpoint.use)


def _name_key(use: str) -> str:
    return "topic" if use in {"publishes", "subscribes"} else "name"


def _show_policy(value: object) -> object:
    """Return the value of a policy as the language writes it."""
    return "unlimited" if value is None else value if isinstance(value, int) else str(value)


VERBS = {"publishes": "publish", "subscribes": "subscribe to", "serves": "serve", "calls": "call"}
"""What a sentence calls each use behind `does not`."""
_VERBS_OF_ONE = {"publishes": "publishes", "subscribes": "subscribes to", "serves": "serves", "calls": "calls"}
_GRAPH_POLICIES = ("reliability", "durability", "deadline", "liveliness", "lease_duration", "lifespan")
"""What the graph of a running robot tells of the quality of service: queues are not on the wire."""
_TRANSPORT_ENDINGS = ("/compressed", "/compressedDepth", "/theora", "/zstd", "/ffmpeg")
"""What plug-ins of image_transport add to a topic."""
_COMMON_ENDINGS = ("/transition_event", "/get_loggers", "/set_logger_level", "/get_type_description", "/bond")
_TRANSFORMS = frozenset({"/tf", "/tf_static"})


class EndpointPair(NamedTuple):
    """An endpoint of the design and what it is on the robot."""

    designed: Endpoint
    observed: ObservedEndpoint


@dataclass(slots=True)
class NodeComparison:
    """What came out for one node. `untold` are ends of the design of which nobody can tell whether they are there."""

    pairs: list[EndpointPair] = field(default_factory=list)
    missing: list[Endpoint] = field(default_factory=list)
    untold: list[Endpoint] = field(default_factory=list)
    renamed: list[Endpoint] = field(default_factory=list)
    findings: list[Diagnostic] = field(default_factory=list)


class EndpointComparer:
    """Compares nodes of one robot; what concerns all of them is looked up once. `remedies`, and the names of ends that differ,
    are collected on the way.
    """

    def __init__(self, architecture: Architecture, robot: ObservedRobot) -> None:
        """Index the ends of the design and of the robot by node."""
        self._architecture = architecture
        self._robot = robot
        self.remedies: list[ModelRemedy] = []
        self.differing: set[str] = set()
        self._shared = shared_topic_names(architecture.shared_topics)
        self._designed: dict[str, list[Endpoint]] = defaultdict(list)
        for endpoint in architecture.endpoints:
            if endpoint.medium == ROS:
                self._designed[endpoint.node].append(endpoint)
        self._observed: dict[str, list[ObservedEndpoint]] = defaultdict(list)
        for seen in robot.endpoints:
            self._observed[seen.node].append(seen)

    def list_uses(self, node_id: str) -> set[tuple[str, str | None]]:
        """Return what a node of the design uses: use and name."""
        return {(each.use, each.name) for each in self._designed[node_id] if not each.internal}

    def list_expected(self, node_ids: Collection[str]) -> Iterator[Endpoint]:
        """Yield what some nodes of the design have to use."""
        yield from (each for node_id in node_ids for each in self._designed[node_id] if self._is_expected(each))

    def list_observed_uses(self, full_name: str) -> set[tuple[str, str | None]]:
        """Return what a node of the robot uses, without what ROS gives each node."""
        return {(each.use, each.name) for each in self._list_told(full_name)}

    def compare_node(self, nodes: Sequence[Node], observed_node: ObservedNode) -> NodeComparison:
        """Compare the nodes of the design that have one full name with what was observed of it."""
        comparison = NodeComparison()
        designed = [endpoint for node in nodes for endpoint in self._designed[node.id]]
        if not observed_node.has_known_uses:
            comparison.untold += [each for each in designed if self._is_expected(each)]
            return comparison
        observed = self._list_told(observed_node.full_name, {(each.use, each.name) for each in designed})
        missing, strange = self._match(designed, observed, comparison.pairs)
        for endpoint, seen in _pair_renamed(missing, strange, are_all=observed_node.has_all_uses):
            missing.remove(endpoint)
            strange.remove(seen)
            if self._is_expected(endpoint):
                comparison.renamed.append(endpoint)
                finding = _report_other_name(nodes[0], endpoint, seen, self._robot.where)
                comparison.findings.append(finding)
                self.remedies.append(_name_endpoint(finding.rule, finding.message, nodes[0], endpoint, seen))
        unknown = [each for each in observed if each.name is None]
        for endpoint in filter(self._is_expected, missing):
            if not observed_node.has_all_uses or any(_may_be(endpoint, each) for each in unknown):
                comparison.untold.append(endpoint)
            else:
                comparison.missing.append(endpoint)
                comparison.findings.append(self._report_missing(nodes[0], endpoint, observed_node))
        unnamed = [each for each in designed if each.name is None]
        comparison.findings += (self._report_strange(nodes[0], seen, unnamed) for seen in strange)
        for pair in comparison.pairs:
            comparison.findings += self._compare_types(nodes[0], pair)
        return comparison

    def _match(
        self, designed: Sequence[Endpoint], observed: Sequence[ObservedEndpoint], pairs: list[EndpointPair]
    ) -> tuple[list[Endpoint], list[ObservedEndpoint]]:
        """Add the pairs of one name, and return what is left on both sides, as far as its names are known."""
        by_name: dict[tuple[str, str, str | None], ObservedEndpoint] = {
            (each.use, each.flow, each.name): each for each in observed if each.name is not None
        }
        missing = []
        met: set[tuple[str, str, str | None]] = set()
        for endpoint in designed:
            key = (endpoint.use, endpoint.flow, endpoint.name)
            seen = by_name.get(key)
            if seen is None and endpoint.flow == "action":
                # Of one without a type nobody can tell whether it is a service or an action.
                key = (endpoint.use, "service", endpoint.name)
                untyped = by_name.get(key)
                seen = untyped if untyped is not None and untyped.message is None else None
            if seen is not None:
                met.add(key)
                pairs.append(EndpointPair(endpoint, seen))
            elif endpoint.name is not None and endpoint.use not in self._robot.unseen_uses:
                missing.append(endpoint)
        return missing, [each for key, each in by_name.items() if key not in met]

    def _compare_types(self, node: Node, pair: EndpointPair) -> Iterator[Diagnostic]:
        for finding in compare_types(node, pair, self._robot.where):
            self.remedies.append(_type_endpoint(finding.rule, finding.message, node, *pair))
            self.differing.add(name_end(pair.designed))
            yield finding
        if pair.designed.message is None and pair.observed.message is not None:
            message = f"`{pair.designed.name}` has the type `{pair.observed.message}`"
            self.remedies.append(_type_endpoint("", message, node, *pair))

    def compare_qos(self, pairs: Iterable[EndpointPair]) -> Iterator[Diagnostic]:
        """Yield where the quality of service is another one than is written, or where nothing is written, no longer fits."""
        pairs = [pair for pair in pairs if pair.designed.flow == "topic"]
        by_topic = group_pairs((pair.designed.name, pair) for pair in pairs)
        for pair in pairs:
            if not pair.observed.qos:
                continue
            differing = self._list_differing(pair)
            if differing and pair.designed.qos.written:
                for policy in differing:
                    finding = self._report_policy(pair, policy)
                    self._add_qos_remedy(finding.rule, finding.message, pair, [policy])
                    self.differing.add(name_end(pair.designed))
                    yield finding
            elif differing:
                misfits = list(self._report_misfits(pair, by_topic[pair.designed.name]))
                yield from misfits
                self.differing |= {name_end(pair.designed)} if misfits else set()
                if not misfits:
                    words = join_words([f"`{_show_policy(pair.observed.qos[each])}`" for each in differing])
                    message = f"`{pair.designed.name}` is {words} at `{pair.designed.node}`"
                    self._add_qos_remedy("", message, pair, differing)

    def _add_qos_remedy(self, rule: str, message: str, pair: EndpointPair, policies: Iterable[str]) -> None:
        node = self._architecture.nodes[pair.designed.node]
        values = {policy: pair.observed.qos[policy] for policy in policies}
        self.remedies.append(_qualify_endpoint(rule, message, node, pair.designed, values))

    def _list_told(self, full_name: str, designed: Collection[tuple[str, str | None]] = ()) -> list[ObservedEndpoint]:
        """Return what a node uses, without what ROS and its libraries give each node, unless the design has it there."""
        endpoints = self._observed[full_name]
        names = {each.name for each in endpoints}
        return [
            each
            for each in endpoints
            if each.name is None or (each.use, each.name) in designed or not _is_common(each, names)
        ]

    def _is_expected(self, endpoint: Endpoint) -> bool:
        """Whether the robot has to have an end of the design."""
        is_optional = endpoint.use in {"subscribes", "calls"} and self._is_optional(endpoint)
        is_heard_elsewhere = endpoint.use == "subscribes" and endpoint.name in _TRANSFORMS
        may_lack = endpoint.internal or is_optional or is_heard_elsewhere or endpoint.runs != "active"
        return endpoint.name is not None and endpoint.use not in self._robot.unseen_uses and not may_lack

    def _is_optional(self, endpoint: Endpoint) -> bool:
        port = self._architecture.inputs.get(endpoint.port or "")
        return port is not None and port.optional

    def _report_missing(self, node: Node, endpoint: Endpoint, observed_node: ObservedNode) -> Diagnostic:
        message = f"`{node.full_name}` does not {VERBS[endpoint.use]} `{endpoint.name}`"
        severity = Severity.WARNING if endpoint.use == "calls" else None
        help_line = (
            "bring it back on the robot, or take it out here"
            if self._robot.kind == "workspace"
            else "start what is missing, or write `status: planned` while it is to come"
        )
        return Diagnostic(
            "not-running",
            f"{message} {self._robot.where}",
            first_written_span(endpoint.at, node.at),
            severity,
            (Label(observed_node.at, "this is the node"),),
            help_line,
            endpoint.port or node.id,
        )

    def _report_strange(self, node: Node, seen: ObservedEndpoint, unnamed: Sequence[Endpoint]) -> Diagnostic:
        what = f"`{node.full_name}` {_VERBS_OF_ONE[seen.use]} `{seen.name}`"
        labels = (Label(seen.at, "seen here"),)
        candidates = [each for each in unnamed if _may_be(each, seen)]
        if candidates:
            known = f"may be `{candidates[0].port}`, whose name" if len(candidates) == 1 else "may be one whose name"
            message, help_line = f"{what}, which {known} the design does not say", f"write `{_write_name(seen)}` there"
            place = first_written_span(candidates[0].at, node.at)
            if len(candidates) == 1:
                self.remedies.append(_name_endpoint("not-in-model", message, node, candidates[0], seen))
            return Diagnostic("not-in-model", message, place, Severity.NOTE, labels, help_line, node.id)
        entry = f"{_write_name(seen)}{f', message: {seen.message}' if seen.message else ''}"
        key = (seen.name or "").rpartition("/")[2] or "port"
        help_line = (
            f"write `internal: {{{seen.use}: {{{key}: {{{entry}}}}}}}` at the node, or give its component a port"
        )
        is_minor = seen.is_conditional or (seen.flow == "topic" and seen.name in self._shared)
        severity = Severity.NOTE if is_minor else None
        message = f"{what}, and the design does not say so"
        self.remedies.append(_add_internal("not-in-model", message, node, key, seen))
        return Diagnostic("not-in-model", message, node.at, severity, labels, help_line, node.id)

    def _list_differing(self, pair: EndpointPair) -> list[str]:
        """Return the policies in which both ends differ, as far as this kind of observation knows them."""
        qos, seen = pair.designed.qos, pair.observed.qos
        policies = _GRAPH_POLICIES if self._robot.kind == "graph" else tuple(seen)
        if self._robot.kind in {"graph", "trace"} and qos.profile == "system_default":
            return []  # the middleware's own choice
        return [policy for policy in policies if policy in seen and getattr(qos, policy) != seen[policy]]

    def _report_policy(self, pair: EndpointPair, policy: str) -> Diagnostic:
        endpoint, seen = pair
        designed, observed = (f"`{_show_policy(each)}`" for each in (getattr(endpoint.qos, policy), seen.qos[policy]))
        key = policy.replace("_", " ")
        message = f"the {key} of `{endpoint.name}` is {observed} {self._robot.where}, and {designed} in the design"
        new_text = f"write `qos: {{{policy}: {observed.strip('`')}}}`"
        help_line = f"{new_text if seen.qos[policy] is not None else f'take `{policy}` out'}, or change the program"
        labels = (Label(seen.at, f"it {_VERBS_OF_ONE[endpoint.use]} it like this"),)
        place = first_written_span(endpoint.qos.at, endpoint.at, self._architecture.nodes[endpoint.node].at)
        is_latched = (policy, endpoint.use, endpoint.qos.durability) == ("durability", "publishes", "transient_local")
        rule = "not-latched" if is_latched else "other-qos"
        return Diagnostic(rule, message, place, None, labels, help_line, endpoint.port or endpoint.node)

    def _report_misfits(self, pair: EndpointPair, others: Iterable[EndpointPair]) -> Iterator[Diagnostic]:
        """Yield where an end of which the design writes nothing no longer fits another one of its topic."""
        endpoint, seen = pair
        for other in others:
            if other.designed.use == endpoint.use:
                continue
            own, opposite = (replace(each.designed.qos, **each.observed.qos) for each in (pair, other))
            offered, requested = (own, opposite) if endpoint.use == "publishes" else (opposite, own)
            for conflict in find_qos_conflicts(offered, requested):
                message = (
                    f"`{endpoint.name}` does not arrive {self._robot.where}: a reader asks for {conflict.requested}, "
                    f"and {conflict.offered} is offered"
                )
                labels = (Label(seen.at, "seen here"), Label(other.observed.at, "the other end"))
                help_line = f"{conflict.remedy}; the design writes no `qos` here"
                place = first_written_span(endpoint.at, self._architecture.nodes[endpoint.node].at)
                element = endpoint.port or endpoint.node
                yield Diagnostic("other-qos", message, place, None, labels, help_line, element)
                return


def _is_common(seen: ObservedEndpoint, names: set[str | None]) -> bool:
    """Whether ROS or one of its libraries gives it to each node."""
    name = seen.name or ""
    if "/_" in name or name.endswith(_COMMON_ENDINGS):
        return True
    if seen.flow == "topic":
        is_transported = any(name.endswith(each) and name.removesuffix(each) in names for each in _TRANSPORT_ENDINGS)
        return is_transported or name == "/rosout_agg" or is_common_callback("subscription", name)
    return seen.flow == "service" and is_common_callback("service", name)


def _may_be(endpoint: Endpoint, seen: ObservedEndpoint) -> bool:
    """Whether both may be the same, if it were not for a name that is not known."""
    is_alike = (endpoint.use, endpoint.flow) == (seen.use, seen.flow)
    return is_alike and (None in {endpoint.message, seen.message} or endpoint.message == seen.message)


def _pair_renamed(
    missing: Sequence[Endpoint], strange: Sequence[ObservedEndpoint], *, are_all: bool
) -> Iterator[tuple[Endpoint, ObservedEndpoint]]:
    """Yield what is there under another name: what the program itself calls it, else one that ends alike, else, where `are_all` that
    it uses, the only one of its type.
    """
    lacking, left = list(missing), list(strange)
    ways: tuple[Callable[[Endpoint, ObservedEndpoint], bool], ...] = (
        lambda endpoint, seen: endpoint.program_name in {seen.name, seen.program_name} - {None},
        lambda endpoint, seen: _last_word(endpoint.name) == _last_word(seen.name),
        lambda endpoint, seen: endpoint.message is not None and endpoint.message == seen.message,
    )
    for fits in ways if are_all else ways[:2]:
        for endpoint in tuple(lacking):
            fitting = [each for each in left if _may_be(endpoint, each) and fits(endpoint, each)]
            rivals = [each for each in lacking if fitting and _may_be(each, fitting[0]) and fits(each, fitting[0])]
            if len(fitting) == len(rivals) == 1:
                lacking.remove(endpoint)
                left.remove(fitting[0])
                yield endpoint, fitting[0]


def _last_word(name: str | None) -> str:
    return (name or "").rpartition("/")[2]


def _report_other_name(node: Node, endpoint: Endpoint, seen: ObservedEndpoint, where: str) -> Diagnostic:
    is_own = seen.name == endpoint.program_name and endpoint.program_name != endpoint.name
    message = f"`{node.full_name}` {_VERBS_OF_ONE[seen.use]} `{seen.name}` {where}, and `{endpoint.name}` in the design"
    message += ": its remap does not count there" if is_own else ""
    help_line = f"write `{_write_name(seen)}` here, or change the name there"
    labels = (Label(seen.at, "seen here"),)
    place = first_written_span(endpoint.at, node.at)
    return Diagnostic("other-name", message, place, None, labels, help_line, endpoint.port or node.id)


def _write_name(seen: ObservedEndpoint) -> str:
    return f"{'topic' if seen.flow == 'topic' else 'name'}: {seen.name}"


def compare_types(node: Node, pair: EndpointPair, where: str) -> Iterator[Diagnostic]:
    """Yield where both sides know a type and have not the same."""
    endpoint, seen = pair
    if None in {endpoint.message, seen.message} or endpoint.message == seen.message:
        return
    message = (
        f"`{endpoint.name}`, which `{node.full_name}` {_VERBS_OF_ONE[endpoint.use]}, has the type `{seen.message}` {where}, "
        f"and `{endpoint.message}` in the design"
    )
    place = first_written_span(endpoint.message_at, endpoint.at, node.at)
    labels = (Label(seen.at, "seen here"),)
    help_line = f"write `{seen.message}` as the type, or change the program"
    yield Diagnostic("other-type", message, place, None, labels, help_line, endpoint.port or node.id)
