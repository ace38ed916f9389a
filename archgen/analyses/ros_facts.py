"""Does the ROS of the project have what is written for it: its distribution, keys of nodes, messages, one message a topic?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Severity, Span, find_closest, first_written_span, join_words
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component import Input, Output
from archgen.model.known_interfaces import KNOWN_DISTROS, Interfaces, InterfaceStatus, guess_distro
from archgen.model.message_types import flow_of
from archgen.model.node import Endpoint, Node, Qos
from archgen.model.ros_distro import PAST_DISTROS, is_ros_1

_FLOW_NOUNS = {"topic": "message", "service": "service", "action": "action"}


class MessageMention(NamedTuple):
    """A message as the project writes it, where, and the id of the element that it belongs to."""

    message: str
    span: Span
    element: str


def _find_message_mentions(architecture: Architecture) -> Iterator[MessageMention]:
    """Yield every mention of a message written in the project, once for each span, without planned messages.

    A message is planned wherever it is mentioned if one type with `status: planned` maps to it.
    """
    planned_messages = {type_.message for type_ in architecture.types.values() if type_.status == "planned"}
    seen_spans = set[Span]()
    for mention in _find_written_messages(architecture):
        if mention.span != NO_SPAN and mention.span not in seen_spans and mention.message not in planned_messages:
            seen_spans.add(mention.span)
            yield mention


def _find_written_messages(architecture: Architecture) -> Iterator[MessageMention]:
    ports: tuple[Output | Input, ...] = (*architecture.outputs.values(), *architecture.inputs.values())
    # Reversed, so that the first port of each type wins, and outputs win over inputs.
    port_spans = {port.type: port.type_at for port in reversed(ports)}
    for type_ in architecture.types.values():
        if type_.message is not None and type_.origin != "shipped":
            # A type that is itself a message (`type: std_msgs/msg/String`) has no declaration: the port is its place.
            span = first_written_span(type_.message_at, type_.at, port_spans.get(type_.name, NO_SPAN))
            yield MessageMention(type_.message, span, type_.name)
    for node in architecture.nodes.values():
        for use in node.uses:
            if use.message is not None:
                yield MessageMention(use.message, use.message_at, node.id)


def _mentions_with_status(architecture: Architecture, status: InterfaceStatus) -> Iterator[MessageMention]:
    return (
        mention
        for mention in _find_message_mentions(architecture)
        if architecture.interfaces.status_of(mention.message) == status
    )


def unknown_message(architecture: Architecture) -> Iterator[Diagnostic]:
    """No message, service or action of this name exists."""
    interfaces = architecture.interfaces
    for message, span, element in _mentions_with_status(architecture, "wrong"):
        yield Diagnostic(
            "unknown-message",
            f"no {_FLOW_NOUNS[flow_of(message)]} `{message}`{_name_package(message, interfaces)}",
            span,
            help=_suggest_interface(message, interfaces) or _suggest_definition(message, interfaces),
            element=element,
        )


def _name_package(message: str, interfaces: Interfaces) -> str:
    """Return where a message that does not exist was looked for, to follow its name."""
    package = message.partition("/")[0]
    if package in interfaces.project_packages:
        return f" in `{package}`, which the project defines"
    if package in interfaces.known_packages():
        return f" in `{package}`, as {interfaces.distro} has it"
    return f": archgen holds no package `{package}` for {interfaces.distro}"


def unchecked_message(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nobody can tell whether this message, service or action exists."""
    interfaces = architecture.interfaces
    if interfaces.distro is not None and not interfaces.has_names:
        return  # `unknown-distro` reports that nothing is checked, once instead of for each message
    for message, span, element in _mentions_with_status(architecture, "not held"):
        yield Diagnostic(
            "unchecked-message",
            f"cannot tell whether the {_FLOW_NOUNS[flow_of(message)]} `{message}` exists: {_explain_unchecked(message, interfaces)}",
            span,
            help=_suggest_near_package(message, interfaces) or _suggest_source(message, interfaces),
            element=element,
        )


def _explain_unchecked(message: str, interfaces: Interfaces) -> str:
    """Explain why it is not known whether a message exists."""
    package = message.partition("/")[0]
    if interfaces.distro is None:
        return "the project names no distribution (`ros: {distro: jazzy}`)"
    holding_distros = _name_other_distros(message, interfaces)
    if holding_distros:
        return f"it is in {holding_distros}, but not among the names held for {interfaces.distro}"
    if package in interfaces.known_packages():
        return f"it is not among the names held of `{package}`, and newer ones may be missing there"
    return f"archgen holds no names of `{package}` for {interfaces.distro}"


def _name_other_distros(message: str, interfaces: Interfaces) -> str:
    """Return the distributions that have a message which the project's one lacks, as a list of words."""
    return join_words(interfaces.holding_distros.get(message, ()))


def _suggest_interface(message: str, interfaces: Interfaces) -> str | None:
    other_kind = interfaces.find_other_kind(message)
    if other_kind is not None:
        article = "an" if flow_of(other_kind) == "action" else "a"
        return (
            f"`{other_kind.rpartition('/')[2]}` is {article} {_FLOW_NOUNS[flow_of(other_kind)]}: write `{other_kind}`"
        )
    holding_distros = _name_other_distros(message, interfaces)
    if holding_distros:
        return f"it is in {holding_distros}, not in {interfaces.distro}"
    guess = interfaces.find_nearest(message)
    return f"did you mean `{guess}`?" if guess else None


def _suggest_near_package(message: str, interfaces: Interfaces) -> str | None:
    """Suggest an interface of the same name that a package of the distribution has, or of a package with nearly the same
    name; else nothing: the name may well be right.
    """
    guess = interfaces.find_nearest(message)
    package, _, name = message.partition("/")
    is_elsewhere = guess is not None and package in interfaces.known_packages() and guess.endswith(f"/{name}")
    is_near = guess and (is_elsewhere or find_closest(package, [guess.partition("/")[0]]))
    return f"did you mean `{guess}`?" if is_near else None


def _suggest_definition(message: str, interfaces: Interfaces) -> str:
    """Suggest how to declare a message that is named correctly, but does not exist yet."""
    package, kind, name = message.split("/")
    planned_hint = "if it is still to be defined, write `status: planned` at its type"
    if package in interfaces.project_packages:
        keys = "`fields`" if kind == "msg" else "`request` and `response`"
        return f"add its definition, `{package}/{kind}/{name}.{kind}`, to the others, or say its {keys} at its type; {planned_hint}"
    return planned_hint


def _suggest_source(message: str, interfaces: Interfaces) -> str:
    """Suggest where to look a message up; nobody defines one anew in a package of the distribution."""
    if message.partition("/")[0] in interfaces.known_packages() and not interfaces.holding_distros.get(message):
        return f"look it up on a machine that has it: `ros2 interface show {message}`"
    return _suggest_definition_file(message)


def _suggest_definition_file(message: str) -> str:
    """Suggest a file that defines a message, and the setting that makes archgen read it."""
    package, kind, name = message.split("/")
    file = f"msgs/{package}/{kind}/{name}.{kind}"
    return f'add its definition, for instance as `{file}` with `ros: {{interfaces: ["msgs/**/*.{kind}"]}}`'


def action_as_message(architecture: Architecture) -> Iterator[Diagnostic]:
    """The message that describes an action is used as if it were sent on a topic."""
    interfaces = architecture.interfaces
    for message, span, element in _mentions_with_status(architecture, "known"):
        action = interfaces.find_other_kind(message) if message.endswith("Action") else None
        if action is not None and flow_of(action) == "action":
            yield Diagnostic(
                "action-as-message",
                f"`{message}` describes an action, and no topic carries it",
                span,
                help=f"write `{action}`; its output belongs to the component that serves it",
                element=element,
            )


def unknown_distro(architecture: Architecture) -> Iterator[Diagnostic]:
    """The project is for a ROS distribution of which archgen holds no interfaces."""
    distro = architecture.distro
    if distro is None or distro in KNOWN_DISTROS:
        return
    meant_distro = guess_distro(distro)
    if meant_distro != distro:
        message = f"no ROS distribution is called `{distro}`: messages are checked as of `{meant_distro}`"
        help_line = f"did you mean `{meant_distro}`?"
    else:
        message = f"archgen holds no interfaces of `{distro}`: no message is checked"
        help_line = f"archgen holds the interfaces of {', '.join(sorted(KNOWN_DISTROS))}"
    severity = Severity.WARNING if distro in PAST_DISTROS else None
    yield Diagnostic("unknown-distro", message, architecture.distro_at, help=help_line, severity=severity)


_KIND_REMEDIES = {
    "lifecycle": "leave it out: a node of ROS 1 has no managed states",
    "composable": "write `nodelet`, which is what ROS 1 loads into one process",
    "nodelet": "write `composable`, which is what ROS 2 loads into one process",
}
_ROS_1_KINDS = frozenset({"nodelet"})
_ROS_2_KINDS = frozenset({"lifecycle", "composable"})
_ROS_2_QOS_KEYS = ("reliability", "history", "deadline", "lifespan", "liveliness", "lease_duration")
"""`depth` is the queue size of ROS 1, and `durability: transient_local` its latched topic: both may stand there."""


def other_ros_generation(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node uses what only the other generation of ROS has."""
    distro = guess_distro(architecture.distro)
    if distro not in KNOWN_DISTROS and distro not in PAST_DISTROS:
        return
    foreign_kinds, generation = (_ROS_2_KINDS, "ROS 1") if is_ros_1(distro) else (_ROS_1_KINDS, "ROS 2")
    for node in architecture.nodes.values():
        for kind in node.kinds:
            if kind in foreign_kinds:
                yield Diagnostic(
                    "other-ros-generation",
                    f"the node `{node.id}` is of the kind `{kind}`, which {generation} ({distro}) does not have",
                    node.kind_at,
                    help=_KIND_REMEDIES[kind],
                    element=node.id,
                )
        if is_ros_1(distro):
            yield from _report_foreign_qos(node, distro)


def _report_foreign_qos(node: Node, distro: str | None) -> Iterator[Diagnostic]:
    """Report the quality of service of a node of ROS 1: all of its entries in one finding, at the first."""
    foreign_uses = [use for use in node.uses if use.qos is not None and _needs_ros_2(use.qos)]
    first_qos = foreign_uses[0].qos if foreign_uses else None
    if first_qos is not None:
        keys = join_words([f"`{use.key}`" for use in foreign_uses])
        yield Diagnostic(
            "other-ros-generation",
            f"the node `{node.id}` sets the quality of service of {keys}, which ROS 1 ({distro}) does not have",
            first_qos.at,
            help="leave it out; of `qos`, ROS 1 has `depth` (its queue size) and `durability: transient_local` (latched)",
            element=node.id,
        )


def _needs_ros_2(qos: Qos) -> bool:
    """Whether settings ask for more than what every topic of ROS 1 has."""
    return any(getattr(qos, key) != getattr(Qos(), key) for key in _ROS_2_QOS_KEYS)


def topic_type_conflict(architecture: Architecture) -> Iterator[Diagnostic]:
    """Several messages are named for one topic, service or action."""
    for topic in architecture.topics.values():
        users = _first_user_by_message((*topic.writers, *topic.readers))
        if len(users) > 1:
            # The finding is placed at the second user: the first one set the message, the second one deviates from it.
            first, second = list(users.values())[:2]
            labels = (
                Label(_message_span(user, architecture), f"`{user.message}` here, by the node `{user.node}`")
                for user in users.values()
                if user is not second
            )
            names = " and ".join(f"`{message}`" for message in users)
            yield Diagnostic(
                "topic-type-conflict",
                f"the {topic.flow} `{topic.name}` carries {names}",
                _message_span(second, architecture),
                labels=tuple(label for label in labels if label.span != NO_SPAN),
                help=f"give both nodes the same message, or one of them another {topic.flow}: `{first.node}` has "
                f"`{first.message}`, `{second.node}` `{second.message}`",
                element=second.node,
            )


def _first_user_by_message(endpoints: tuple[Endpoint, ...]) -> dict[str, Endpoint]:
    """Return the first endpoint that uses each message, by message, in the order of the endpoints."""
    users = dict[str, Endpoint]()
    for endpoint in endpoints:
        if endpoint.message is not None:
            users.setdefault(endpoint.message, endpoint)
    return users


def _message_span(endpoint: Endpoint, architecture: Architecture) -> Span:
    """Return the span where an endpoint's message was written, else its endpoint's, its port's or its node's."""
    port = architecture.outputs.get(endpoint.port or "") or architecture.inputs.get(endpoint.port or "")
    node = architecture.nodes.get(endpoint.node)
    return first_written_span(
        endpoint.message_at,
        endpoint.at,
        port.type_at if port else NO_SPAN,
        port.at if port else NO_SPAN,
        node.at if node else NO_SPAN,
    )


RULES = (
    (unknown_distro, Severity.ERROR),
    (other_ros_generation, Severity.WARNING),
    (unknown_message, Severity.ERROR),
    (unchecked_message, Severity.NOTE),
    (action_as_message, Severity.WARNING),
    (topic_type_conflict, Severity.ERROR),
)
