"""Do rules for names (`remaps`, and those in `arguments`) do what they are there for, and does nobody lose what he reads?"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from archgen.derivation.ros_names import SHARED_TOPICS
from archgen.derivation.wire.wire_names import (
    ACTION_PARTS,
    NodeNames,
    RemapRule,
    find_rule_fault,
    has_several_rules,
    may_have_rules,
    moves_whole_actions,
    read_arguments,
    read_remaps,
)
from archgen.diagnostics import Diagnostic, Label, Severity, find_closest, join_words
from archgen.model.architecture import Architecture
from archgen.model.common_callbacks import is_common_callback
from archgen.model.node import Endpoint, Node
from archgen.model.ros_distro import is_ros_1

_SHOWN_NAMES = 3
_WRITING = frozenset({"publishes", "serves"})


class _RuledNodes:
    """Nodes that have rules, with their names and what they use; reading rules takes time, so that only those wanted are read."""

    def __init__(self, architecture: Architecture, is_wanted: Callable[[Node], bool] = may_have_rules) -> None:
        nodes = [each for each in architecture.nodes.values() if may_have_rules(each) and is_wanted(each)]
        self.names = {each.id: names for each in nodes if (names := NodeNames(each, architecture.distro)).rules}
        self.endpoints: dict[str, list[Endpoint]] = {each: [] for each in self.names}
        for endpoint in architecture.endpoints if self.names else ():
            if endpoint.node in self.endpoints and endpoint.medium == "ros":
                self.endpoints[endpoint.node].append(endpoint)


def invalid_remap(architecture: Architecture) -> Iterator[Diagnostic]:
    """A rule for names is none that ROS takes."""
    ros_1 = is_ros_1(architecture.distro)
    for node in filter(may_have_rules, architecture.nodes.values()):
        for text, at, rule in (*read_arguments(node, ros_1=ros_1), *read_remaps(node, ros_1=ros_1)):
            if rule is None:
                fault = find_rule_fault(text, ros_1=ros_1)
                message = f"`{text or '-r'}` is no rule that ROS takes: {fault}"
                yield Diagnostic("invalid-remap", message, at, element=node.id)


def repeated_remap(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node has two rules for one name."""
    ros_1 = is_ros_1(architecture.distro)
    own_named = {each.node for each in architecture.endpoints if each.own_name is not None}
    ruled = _RuledNodes(architecture, lambda node: has_several_rules(node) or node.id in own_named)
    for node_id, names in ruled.names.items():
        first_rules: dict[tuple[str | None, str], RemapRule] = {}
        for rule in names.rules:
            own_name = names.expand(rule.own_name)
            flows = (rule.flow,) if rule.flow else ("topic", "service")
            earlier = next((each for flow in flows if (each := first_rules.get((own_name, flow)))), None)
            for flow in flows:
                first_rules.setdefault((own_name, flow), rule)
            if earlier is not None and names.expand(earlier.name or "") != names.expand(rule.name or ""):
                yield _report_repetition(node_id, rule, earlier, names, ros_1=ros_1)
        for endpoint in ruled.endpoints[node_id]:
            yield from _find_rules_beside_port(endpoint, names, ros_1=ros_1)


def _report_repetition(
    node_id: str, rule: RemapRule, earlier: RemapRule, names: NodeNames, *, ros_1: bool
) -> Diagnostic:
    """Report two rules for one name; `earlier` is the one that counts."""
    is_unclear = ros_1 and rule.own_name != earlier.own_name
    is_shield = names.expand(earlier.own_name) == names.expand(earlier.name or "")
    if is_unclear:
        ending = "rospy and roscpp take different ones"
    elif is_shield:
        ending = "the first one keeps the name as it is, so that the second says nothing"
    else:
        ending = f"only `{earlier.text}` counts"
    return Diagnostic(
        "repeated-remap",
        f"`{node_id}` has two rules for `{names.expand(rule.own_name)}`, `{earlier.text}` and `{rule.text}`: {ending}",
        rule.at,
        Severity.ERROR
        if is_unclear or not (rule.is_argument or earlier.is_argument)
        else Severity.NOTE
        if is_shield
        else None,
        labels=(Label(earlier.at, "the other one"),),
        help="take one of them out",
        element=node_id,
    )


def _find_rules_beside_port(endpoint: Endpoint, names: NodeNames, *, ros_1: bool) -> Iterator[Diagnostic]:
    """Yield the `remaps` of what a port has as its `own_name`: the port itself says what becomes of it."""
    if endpoint.own_name is None or endpoint.program_name is None:
        return
    for rule in names.list_matched_rules(endpoint.program_name, endpoint.flow):
        # In ROS 2 an argument comes first, and says it to everybody who reads the name.
        is_overruled = ros_1 or not rule.is_argument
        if is_overruled and names.expand(rule.name or "") != endpoint.name:
            yield Diagnostic(
                "repeated-remap",
                f"`{rule.text}` says nothing: the port `{endpoint.port}` of `{endpoint.node}` has the own name "
                f"`{endpoint.own_name}`, and is on `{endpoint.label}`",
                rule.at,
                None if rule.is_argument else Severity.ERROR,
                labels=(Label(endpoint.at, "the port"),),
                help="write the new name as the port's topic, or leave `own_name` out",
                element=endpoint.node,
            )


def action_remap(architecture: Architecture) -> Iterator[Diagnostic]:
    """A rule for an action does not move it, or not all of it."""
    if moves_whole_actions(architecture.distro):
        return
    distro, parts = architecture.distro or "jazzy", ACTION_PARTS[1 if is_ros_1(architecture.distro) else 2]
    with_actions = {each.node for each in architecture.endpoints if each.flow == "action"}
    ruled = _RuledNodes(architecture, lambda node: node.id in with_actions)
    for node_id, names in ruled.names.items():
        for endpoint in ruled.endpoints[node_id]:
            program_name = endpoint.program_name
            if endpoint.flow != "action" or program_name is None or endpoint.name != program_name:
                continue
            rules = [each for each in names.list_matched_rules(program_name, "action") if not _is_shield(each, names)]
            for rule in [each for each in rules if names.expand(each.own_name) == program_name] or rules[:1]:
                is_whole = names.expand(rule.own_name) == program_name
                what = "none of its five parts" if is_whole else f"{len(rules)} of its {len(parts)} parts"
                yield Diagnostic(
                    "action-remap",
                    f"`{rule.text}` does not move the action `{program_name}` of `{node_id}`: in {distro} it reaches {what}",
                    rule.at,
                    help=f"write `own_name` and the new name at its port, from which archgen makes five rules; or rules "
                    f"for the parts: `{rule.own_name if is_whole else program_name}{parts[0]}` and so on",
                    element=node_id,
                )


def _is_shield(rule: RemapRule, names: NodeNames) -> bool:
    return rule.name is not None and names.expand(rule.own_name) == names.expand(rule.name)


def unused_remap(architecture: Architecture) -> Iterator[Diagnostic]:
    """A rule for names fits nothing that its node uses."""
    ruled = _RuledNodes(architecture)
    told = {node_id: _list_told_names(architecture, ruled.endpoints[node_id]) for node_id in ruled.names}
    fitting = {
        rule.text
        for node_id, names in ruled.names.items()
        for rule in names.rules
        if names.expand(rule.own_name) in told[node_id]
    }
    for node_id, names in ruled.names.items():
        endpoints, node = ruled.endpoints[node_id], architecture.nodes[node_id]
        if not _has_known_ends(architecture, node, endpoints):
            continue
        own_names = told[node_id]
        wire_names = {each.name for each in endpoints}
        for rule in names.rules:
            own_name, name = names.expand(rule.own_name), names.expand(rule.name or "")
            if own_name is None or own_name in own_names or name in wire_names or _is_of_ros(own_name, name):
                continue
            guess = _find_meant(own_name, own_names, node)
            # Of a program that exists the ports may be some of many: there only what looks like one of them is told. What a
            # group of a launch file gives to all of its nodes is meant for the one that it fits.
            if (guess is None or rule.text in fitting) and node.status in {"existing", "adapted"}:
                continue
            yield Diagnostic(
                "unused-remap",
                f"`{rule.text}` fits nothing that `{node_id}` uses: ROS says nothing then, and no name changes",
                rule.at,
                help=f"did you mean `{guess}`?" if guess else f"it uses {_list_some(own_names)}",
                element=node_id,
            )


def _list_told_names(architecture: Architecture, endpoints: list[Endpoint]) -> list[str]:
    """Return what a program calls the ends of its node, before rules for names."""
    own_names = [each.program_name for each in endpoints if each.program_name]
    parts = ACTION_PARTS[1 if is_ros_1(architecture.distro) else 2]
    return own_names + [
        f"{each.program_name}{part}"
        for each in endpoints
        if each.flow == "action" and each.program_name
        for part in parts
    ]


def _has_known_ends(architecture: Architecture, node: Node, endpoints: list[Endpoint]) -> bool:
    """Whether the model says all that the program of a node calls by a name."""
    components = [architecture.components[each] for each in node.implements]
    return (
        not node.observed
        and bool(endpoints)
        and all(each.name is not None for each in endpoints)
        and not any(each.open for each in components)
    )


def _find_meant(own_name: str, own_names: list[str], node: Node) -> str | None:
    """Return the name that looks like another one, beside what all names of a node begin with."""
    beginnings = (f"{node.full_name}/", f"{node.full_name.rpartition('/')[0]}/")

    def shorten(name: str) -> str:
        return name.removeprefix(next(filter(name.startswith, beginnings), ""))

    shorter = {shorten(each): each for each in own_names}
    return shorter.get(find_closest(shorten(own_name), shorter) or "")


def _is_of_ros(own_name: str, name: str | None) -> bool:
    """Whether it is a name that ROS itself brings, or a rule that keeps a name as it is."""
    return own_name == name or own_name in SHARED_TOPICS or is_common_callback("service", own_name)


def _list_some(names: list[str]) -> str:
    shown = list(dict.fromkeys(names))
    more = len(shown) - _SHOWN_NAMES
    return ", ".join(f"`{each}`" for each in shown[:_SHOWN_NAMES]) + (f" and {more} more" if more > 0 else "")


def remapped_away(architecture: Architecture) -> Iterator[Diagnostic]:
    """A rule takes what a node writes away from a name that others read, or what it reads to where nobody writes."""
    moved = [each for each in architecture.endpoints if each.evidence and each.is_moved and each.name]
    if not moved:
        return
    writers: dict[tuple[str | None, str], list[Endpoint]] = {}
    readers: dict[tuple[str | None, str], list[Endpoint]] = {}
    for endpoint in architecture.endpoints:
        side = writers if endpoint.use in _WRITING else readers
        side.setdefault((endpoint.name, endpoint.flow), []).append(endpoint)
    has_strangers = _has_strangers(architecture)
    for endpoint in moved:
        left = (endpoint.program_name, endpoint.flow)
        is_writer = endpoint.use in _WRITING
        if not is_writer and (endpoint.name_written or writers.get((endpoint.name, endpoint.flow))):
            continue  # where a topic is written at a reader and no source is on it, that is an `unaccounted-topic`
        if is_writer and writers.get(left) and readers.get((endpoint.name, endpoint.flow)):
            continue  # both names are written and read: one of them is there on purpose
        lost = [each for each in (readers if is_writer else writers).get(left, ()) if each.node != endpoint.node]
        if not lost:
            continue
        is_needed = any(_is_required(architecture, each) for each in (lost if is_writer else [endpoint]))
        is_left_alone = is_writer and not writers.get(left)
        nodes = list(dict.fromkeys(f"`{each.node}`" for each in lost))
        verb = ("read" if is_writer else "write") + "s" * (len(nodes) == 1)
        ending = f"{join_words(nodes)} {verb} `{endpoint.program_name}`"
        rule = endpoint.evidence["name"]
        yield Diagnostic(
            "remapped-away",
            f"`{endpoint.node}` is on `{endpoint.name}` by `{rule.rule}`, and {ending}"
            + ", which nobody writes any more" * is_left_alone,
            rule.at,
            Severity.NOTE
            if has_strangers
            else Severity.ERROR
            if is_needed and (is_left_alone or not is_writer)
            else None,
            labels=tuple(Label(each.at, f"`{each.node}`") for each in lost[:_SHOWN_NAMES] if each.at.line),
            help="take the rule out, or let the others follow: `remaps` there, or the new name as the topic of the ports",
            element=endpoint.node,
        )


def _is_required(architecture: Architecture, reader: Endpoint) -> bool:
    port = architecture.inputs.get(reader.port or "")
    return port is not None and not port.optional and not port.external


def _has_strangers(architecture: Architecture) -> bool:
    """Whether a node may write any name, as a bag player or a relay does: it exists, and the model does not say what."""
    named = {each.node for each in architecture.endpoints if each.name is not None or each.use not in _WRITING}
    return any(
        node.status == "existing" and not node.is_program and node.id not in named
        for node in architecture.nodes.values()
    )


RULES = (
    (unused_remap, Severity.WARNING),
    (invalid_remap, Severity.ERROR),
    (repeated_remap, Severity.WARNING),
    (action_remap, Severity.WARNING),
    (remapped_away, Severity.WARNING),
)
