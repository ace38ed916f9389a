"""Names on the wire: those that a program writes, made absolute, and rules that give it others (`remaps`, `-r x:=y`,
`__ns:=/a`).

Both as ROS 2 (rcl) and ROS 1 (rospy, roscpp) do it. Both sides of a rule are made absolute with the final namespace and
name of the node; then whole names are compared, once: no chains. The first rule that fits counts in ROS 2, the last one in
ROS 1. ROS 1 has one exception: of two spellings of one name rospy and roscpp take different ones, so that the name is not
known.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.model.node import Evidence, FlowKind, Node, PortUse
from archgen.model.parameter import ParameterValue
from archgen.model.ros_distro import PAST_DISTROS, is_ros_1

_JOINT = ":="
_RULE_OPTIONS = frozenset({"-r", "--remap"})
_WHOLE_NUMBER = re.compile("[-+]?[0-9]{1,20}")
_PARAMETER_OPTIONS = frozenset({"-p", "--param"})
_FLAGS = {**dict.fromkeys(("y", "yes", "true", "on"), True), **dict.fromkeys(("n", "no", "false", "off"), False)}
"""What ROS takes for booleans, in lower case."""
_OTHER_OPTIONS = frozenset(
    {"-p", "--param", "--params-file", "--log-level", "--log-config-file", "--log-file-name", "-e", "--enclave"}
)


@dataclass(frozen=True, slots=True)
class RuleWord:
    """A word that is a rule, and where it stands. `is_optional`: where it is no rule, the program gets it for itself."""

    text: str
    at: Span
    is_optional: bool = False
    is_refused: bool = False
    """Behind `--ros-args`, but not behind `-r`: ROS 2 does not start then."""


class _PlacedWord(NamedTuple):
    text: str
    at: Span


def list_rule_words(node: Node, *, ros_1: bool) -> Iterator[RuleWord]:
    """Yield the rules among a node's arguments, in their order."""
    places: Sequence[Span] = node.argument_places or (NO_SPAN,) * len(node.arguments)
    words = map(_PlacedWord, node.arguments, places)
    if ros_1:
        # Where `--ros-args` stands before them they are rules all the same; `_rate:=5` sets a parameter.
        yield from (
            RuleWord(text, at)
            for text, at in words
            if _JOINT in text and not (text.startswith("_") and not text.startswith("__"))
        )
    # What a container of ROS 2 loads has no command line of its own.
    elif node.container is None:
        yield from _list_in_ros_2(words)


def _list_in_ros_2(words: Iterator[_PlacedWord]) -> Iterator[RuleWord]:
    is_for_ros = False
    for text, at in words:
        if text == "--ros-args":
            is_for_ros = True
        elif text == "--" and is_for_ros:
            is_for_ros = False
        elif not is_for_ros:
            if _JOINT in text:
                yield RuleWord(text, at, is_optional=True)
        elif text in _RULE_OPTIONS:
            rule = next(words, None)
            yield RuleWord(rule.text, rule.at) if rule else RuleWord("", at)
        elif text in _OTHER_OPTIONS:
            next(words, None)
        elif _JOINT in text:
            yield RuleWord(text, at, is_refused=True)


def list_parameter_words(node: Node) -> Iterator[ParameterValue]:
    """Yield the parameters that the words `-p NAME:=VALUE` give a node of ROS 2, in their order: later ones win.

    The name of a node may stand before them. With one that has slashes no process starts: there is no value then.
    """
    words, places = node.arguments, node.argument_places or (NO_SPAN,) * len(node.arguments)
    is_for_ros = False
    if node.container is not None:
        return  # as above
    for flag, (word, at) in zip(words, list(zip(words, places, strict=True))[1:], strict=False):
        is_for_ros = flag == "--ros-args" or (is_for_ros and flag != "--")
        parameter, joint, text = word.partition(_JOINT)
        whose, _, name = parameter.rpartition(":")
        if is_for_ros and joint and flag in _PARAMETER_OPTIONS and (whose in {"", node.full_name[1:]} or "/" in whose):
            number = int(text) if _WHOLE_NUMBER.fullmatch(text) else text
            yield ParameterValue(name, None if "/" in whose else _FLAGS.get(text.lower(), number), at, at)


_FORBIDDEN_CHARACTER = re.compile(r"[^A-Za-z0-9_]")
_SUBSTITUTION = re.compile(r"\{(?:node|ns|namespace)\}")
_INNER_NAMESPACE = re.compile(r"/\{(?:ns|namespace)\}")
_INNER_NAMESPACE_FAULT = "the namespace begins with a `/` of its own, so that two `/` follow one another"
_FULL_NAME_IN_ROS_2 = re.compile(r"(?:/[A-Za-z_][A-Za-z0-9_]*)+", re.ASCII)


def expand_name(written_name: str, namespace: str, node_name: str, *, ros_1: bool) -> str | None:
    """Return the absolute name that a node gets for what its program writes, None where ROS refuses it."""
    place = "" if namespace == "/" else namespace.rstrip("/")
    if ros_1:
        return _expand_in_ros_1(written_name, place, node_name)
    if written_name.startswith("/") and "{" not in written_name:
        full_name = written_name
    else:
        # The namespace stands there with its `/`: `{ns}/x` is absolute already, and `x/{ns}` no name.
        own = place or "/"
        name = written_name.replace("{node}", node_name).replace("{ns}", own).replace("{namespace}", own)
        if name.startswith("~"):
            # rcl takes `~x`, too, and makes no `/` of it: what nobody means is told as a fault of the name.
            name = f"{place}/{node_name}{name[1:]}"
        full_name = name if name.startswith("/") else f"{place}/{name}"
    return full_name if _FULL_NAME_IN_ROS_2.fullmatch(full_name) else None


def _expand_in_ros_1(written_name: str, place: str, node_name: str) -> str | None:
    is_private = written_name.startswith("~")
    parts = [part for part in written_name.removeprefix("~").split("/") if part]
    if is_private:
        return "/".join((place, node_name, *parts))
    if not parts:
        return None
    return "/".join(("" if written_name.startswith("/") else place, *parts))


def find_name_fault(text: str, *, ros_1: bool = False) -> str | None:
    """Return what is wrong with the name of a topic, service or namespace, or None.

    The rules are those of https://design.ros2.org/articles/topic_and_service_names.html as far as ROS 2 enforces them, and
    of http://wiki.ros.org/Names for ROS 1, where only the first letter of the whole name must not be a digit.
    """
    if not text:
        return "it is empty"
    remaining_name = text
    if text.startswith("~"):
        remaining_name = text[1:]
        # In ROS 1 `~scan` is the private name that launch files and nodes write.
        if remaining_name and not remaining_name.startswith("/") and not ros_1:
            return "`~` is followed by `/`"
    if ros_1:
        # A `/` too many does no harm there.
        remaining_name = re.sub("/+", "/", remaining_name.rstrip("/"))
    if remaining_name in {"", "/"}:
        return None
    if remaining_name.endswith("/"):
        return "it ends with `/`"
    # In ROS 2 substitutions such as `{node}` are replaced by a valid name; other braces remain and are reported.
    tokens = (remaining_name if ros_1 else _SUBSTITUTION.sub("x", remaining_name)).removeprefix("/").split("/")
    may_be_digits = ros_1 and remaining_name.startswith("/")
    faults = (
        _find_token_fault(token, may_start_with_digit=may_be_digits or (ros_1 and position > 0))
        for position, token in enumerate(tokens)
    )
    has_inner_namespace = not ros_1 and _INNER_NAMESPACE.search(remaining_name) is not None
    return next(filter(None, faults), _INNER_NAMESPACE_FAULT if has_inner_namespace else None)


def find_node_name_fault(name: str) -> str | None:
    """Return what is wrong with a node's name, or None."""
    if "/" in name:
        return "it holds `/`: what stands before the name belongs into `namespace`"
    return _find_token_fault(name, may_start_with_digit=False) if name else "it is empty"


def _find_token_fault(token: str, *, may_start_with_digit: bool) -> str | None:
    if not token:
        return "two `/` follow one another"
    forbidden = _FORBIDDEN_CHARACTER.search(token)
    if forbidden:
        character = "a blank" if forbidden[0].isspace() else f"`{forbidden[0]}`"
        return f"it holds {character}, and only letters (a to z), digits and `_` are allowed"
    if token[0].isdigit() and not may_start_with_digit:
        return f"`{token}` begins with a digit"
    return None


ACTION_PARTS = {
    1: ("/goal", "/cancel", "/status", "/feedback", "/result"),
    2: ("/_action/send_goal", "/_action/cancel_goal", "/_action/get_result", "/_action/feedback", "/_action/status"),
}
"""What an action consists of, as ends of its name, by generation of ROS: up to Jazzy, a new name for the action alone reaches none."""
_TOPICS_OF_ACTIONS = frozenset({*ACTION_PARTS[1], "/_action/feedback", "/_action/status"})
_DISTROS_OF_PARTS = PAST_DISTROS | {None, "humble", "jazzy"}
"""Where a new name for an action moves none of its parts: up to Jazzy, and so where no distribution is written."""
_WORD = r"(?:[A-Za-z]|_(?!_))(?:[A-Za-z0-9]|_(?!_))*"
_NAME = rf"(?:~?/)?{_WORD}(?:/{_WORD})*"
_RULE_IN_ROS_2 = re.compile(
    rf"(?:(?P<node>{_WORD}):)?(?:ros(?P<flow>service|topic)://)?(?P<own>{_NAME}):=(?P<new>{_NAME})"
)
_NODE_RULE_IN_ROS_2 = re.compile(rf"(?:(?P<node>{_WORD}):)?(?P<own>__(?:node|name|ns)):=(?P<new>.*)", re.DOTALL)
_OWN_NAMES = frozenset({"__node", "__name"})
_REFUSED_SIGNS = {
    "*": "ROS has no wildcards there yet",
    "{": "a rule takes no `{...}`",
    "__": "in a rule, no two `_` follow one another",
}
_LAUNCH_SUBSTITUTION = "$("
_NO_EVIDENCE: Mapping[str, Evidence] = MappingProxyType({})
_OBSERVED_NAME: Mapping[str, Evidence] = MappingProxyType({"name": Evidence("observed")})
_UNKNOWN_NAME: Mapping[str, Evidence] = MappingProxyType({"name": Evidence("unknown")})
RuleFlow = Literal["", "topic", "service"]


@dataclass(frozen=True, slots=True)
class RemapRule:
    """A rule: what the program says becomes `name`, None where that is known at the launch only."""

    text: str
    own_name: str
    name: str | None
    at: Span
    is_argument: bool
    """Whether it stands in `arguments`, else in `remaps`."""
    node_name: str = ""
    """The node that it is for: one process may run several."""
    flow: RuleFlow = ""

    @property
    def is_for_node(self) -> bool:
        """Whether it gives the node itself another name or namespace."""
        return self.own_name in {*_OWN_NAMES, "__ns"}


class WireName(NamedTuple):
    """What an end is called in its program, on the wire, and why it is so."""

    program_name: str | None
    name: str | None
    evidence: Mapping[str, Evidence]


def may_have_rules(node: Node) -> bool:
    """Whether anything that a node is started with may be a rule for names: a program that is no node takes none."""
    return bool(node.remaps or node.arguments) and not node.is_program


def has_several_rules(node: Node) -> bool:
    """Whether a node may have more than one rule."""
    return len(node.remaps) + len(node.arguments) > 1


def list_written_remaps(node: Node) -> dict[str, str]:
    """Return a node's `remaps` for who writes them down again; what comes of them, endpoints say."""
    return dict(node.remaps)


def list_rules(node: Node, *, ros_1: bool) -> Iterator[RemapRule]:
    """Yield the rules of a node that ROS takes, the one that counts first in front."""
    arguments = [rule for _, _, rule in read_arguments(node, ros_1=ros_1) if rule]
    remaps = [rule for _, _, rule in read_remaps(node, ros_1=ros_1) if rule]
    yield from (*remaps, *reversed(arguments)) if ros_1 else (*arguments, *remaps)


def read_arguments(node: Node, *, ros_1: bool) -> Iterator[tuple[str, Span, RemapRule | None]]:
    """Yield each rule in a node's arguments as it is written: None for what ROS refuses."""
    for word in list_rule_words(node, ros_1=ros_1):
        rule = None if word.is_refused else read_rule(word.text, word.at, is_argument=True, ros_1=ros_1)
        if rule or not word.is_optional:
            yield word.text, word.at, rule


def read_remaps(node: Node, *, ros_1: bool) -> Iterator[tuple[str, Span, RemapRule | None]]:
    """Yield each of a node's `remaps` as the rule that a launch file makes of it: None for what ROS refuses."""
    for own_name, name in node.remaps.items():
        text, at = f"{own_name}{_JOINT}{name}", node.remap_places.get(own_name, node.at)
        yield text, at, read_rule(text, at, is_argument=False, ros_1=ros_1)


def read_rule(text: str, at: Span, *, is_argument: bool, ros_1: bool) -> RemapRule | None:
    """Read a rule, None where ROS does not start with it."""
    own_name, joint, name = text.partition(_JOINT)
    if _LAUNCH_SUBSTITUTION in name:
        known = read_rule(f"{own_name}{_JOINT}x", at, is_argument=is_argument, ros_1=ros_1)
        return replace(known, text=text, name=None) if known else None
    if ros_1:
        is_rule = joint and not _find_fault_in_ros_1(own_name, name)
        return RemapRule(text, own_name, name, at, is_argument) if is_rule else None
    found = _NODE_RULE_IN_ROS_2.fullmatch(text)
    if found:
        is_rule = not find_value_fault(found["own"], found["new"])
        return RemapRule(text, found["own"], found["new"], at, is_argument, found["node"] or "") if is_rule else None
    found = _RULE_IN_ROS_2.fullmatch(text)
    if found is None:
        return None
    flow: RuleFlow = "" if not found["flow"] else "topic" if found["flow"] == "topic" else "service"
    return RemapRule(text, found["own"], found["new"], at, is_argument, found["node"] or "", flow)


def find_value_fault(own_name: str, value: str) -> str | None:
    """Return what is wrong with the name or namespace that a rule gives a node, or None."""
    if own_name in _OWN_NAMES:
        return find_node_name_fault(value)
    if not value.startswith("/"):
        return "a namespace begins with `/`" if value else "it is empty"
    return find_name_fault(value)


def _find_fault_in_ros_1(own_name: str, name: str) -> str | None:
    if own_name.startswith("__"):
        return None
    return find_name_fault(own_name, ros_1=True) or find_name_fault(name, ros_1=True)


def find_rule_fault(text: str, *, ros_1: bool) -> str:
    """Return what is wrong with a rule that ROS refuses."""
    own_name, joint, name = text.partition(_JOINT)
    if read_rule(text, NO_SPAN, is_argument=True, ros_1=ros_1):
        return "behind `--ros-args` a rule stands after `-r`"
    if not joint:
        return f"a rule has the form `from{_JOINT}to`"
    if ros_1:
        return _find_fault_in_ros_1(own_name, name) or "it is no rule"
    if found := _NODE_RULE_IN_ROS_2.fullmatch(text):
        return find_value_fault(found["own"], found["new"]) or "it is no rule"
    fault = next((words for sign, words in _REFUSED_SIGNS.items() if sign in text), None)
    return fault or find_name_fault(own_name) or find_name_fault(name) or "it is only a `/` or a `~`"


def apply_launch_names(node: Node, distro: str | None) -> Node:
    """Return a node with the name and the namespace that its arguments give it: they outrank what is written beside them."""
    ros_1 = is_ros_1(distro)
    rules = [rule for _, _, rule in read_arguments(node, ros_1=ros_1) if rule and rule.is_for_node]
    # A node-specific rule for the name meets the one in the code; the launch's own `__name` stands last, and so wins in ROS 1.
    named = next((each for each in rules if each.own_name in _OWN_NAMES and each.node_name in {"", node.name}), None)
    if named and named.name is not None and not ros_1:
        node = replace(node, name=named.name, name_at=named.at)
    placed = next((each for each in rules if each.own_name == "__ns" and each.node_name in {"", node.name}), None)
    if placed and placed.name is not None:
        node = replace(node, namespace="/" + "/".join(part for part in placed.name.split("/") if part))
    return node


def moves_whole_actions(distro: str | None) -> bool:
    """Whether a rule for an action alone moves all of its parts."""
    return distro not in _DISTROS_OF_PARTS


class NodeNames:
    """Knows what the names of one node's program are on the wire. Its name and namespace are those after all rules."""

    __slots__ = (
        *("_any_rules", "_is_observed", "_moves_actions", "_name", "_namespace", "_ros_1", "_rules_by_name"),
        *("_services", "_topics", "rules"),
    )

    def __init__(self, node: Node, distro: str | None) -> None:
        self._name, self._ros_1 = node.name, is_ros_1(distro)
        self._namespace = "/" + "/".join(part for part in node.namespace.split("/") if part)
        self._moves_actions = moves_whole_actions(distro)
        self._is_observed = node.observed
        self.rules: tuple[RemapRule, ...] = ()
        self._topics: dict[str, RemapRule | None] = {}
        self._services: dict[str, RemapRule | None] = {}
        self._rules_by_name: dict[str, list[RemapRule]] = {}
        if may_have_rules(node):
            rules = list_rules(node, ros_1=self._ros_1)
            self.rules = tuple(each for each in rules if not each.is_for_node and each.node_name in {"", node.name})
            self._index_rules()

    def _index_rules(self) -> None:
        for rule in self.rules:
            own_name = self.expand(rule.own_name)
            if own_name is None:
                continue
            self._rules_by_name.setdefault(own_name, []).append(rule)
            for flow, table in (("topic", self._topics), ("service", self._services)):
                if rule.flow not in {"", flow}:
                    continue
                earlier = table.setdefault(own_name, rule)
                if self._ros_1 and earlier and earlier.own_name != rule.own_name and self._differ(earlier, rule):
                    table[own_name] = None

    def _differ(self, rule: RemapRule, other: RemapRule) -> bool:
        return self.expand(rule.name or "") != self.expand(other.name or "")

    def expand(self, written_name: str) -> str | None:
        """Return the absolute name of what the program writes, before all rules; None where ROS refuses it."""
        return expand_name(written_name, self._namespace, self._name, ros_1=self._ros_1)

    def resolve(self, written_name: str, flow: FlowKind) -> str | None:
        """Return the name on the wire of what the program writes, None where it is not known."""
        return self.name_end(self.expand(written_name), None, flow).name

    def name_use(self, use: PortUse, flow: FlowKind, default_name: str | None) -> Iterator[WireName]:
        """Yield the names of an entry's ends, one for each topic; `default_name` is that of one without a topic."""
        for target in map(self.expand, use.topics) if use.topics else (default_name,):
            yield self.name_end(target, use.own_name, flow, use.at)

    def name_end(self, target: str | None, own_name: str | None, flow: FlowKind, own_at: Span = NO_SPAN) -> WireName:
        """Return the names of an end that the model puts on `target`, where its program calls it `own_name`.

        Without an own name the program says the target itself. Without a target the own name counts alone.
        """
        if self._is_observed or not (self.rules or own_name):
            evidence = _UNKNOWN_NAME if target is None else _OBSERVED_NAME if self._is_observed else _NO_EVIDENCE
            return WireName(None if self._is_observed else target, target, evidence)
        program_name = self.expand(own_name) if own_name else target
        if program_name is None:
            return WireName(None, target, _NO_EVIDENCE if target else _UNKNOWN_NAME)
        has_rule_of_port = own_name is not None and target is not None
        found = self._find_rule(program_name, flow)
        if found is not None and not (has_rule_of_port and (self._ros_1 or not found[1].is_argument)):
            name, rule = found
            if name == program_name:
                return WireName(program_name, name, _NO_EVIDENCE)
            reason = Evidence("written" if name else "unknown", rule.text, rule.at)
            return WireName(program_name, name, {"name": reason})
        if has_rule_of_port and target != program_name:
            return WireName(program_name, target, {"name": Evidence("written", f"{own_name}{_JOINT}{target}", own_at)})
        return WireName(program_name, program_name, _NO_EVIDENCE)

    def list_matched_rules(self, program_name: str, flow: FlowKind) -> Iterator[RemapRule]:
        """Yield the rules that say something of an end, also those that another one keeps from it."""
        for ending in ("", *(ACTION_PARTS[1 if self._ros_1 else 2] if flow == "action" else ())):
            yield from self._rules_by_name.get(f"{program_name}{ending}", ())

    def _find_rule(self, program_name: str, flow: FlowKind) -> tuple[str | None, RemapRule] | None:
        """Return the new name of an end and the rule that gives it, None where no rule moves all of it."""
        if flow != "action":
            return self._look_up(program_name, self._services if flow == "service" else self._topics)
        if self._moves_actions and (found := self._look_up(program_name, self._topics)):
            return found
        names: list[str | None] = []
        first_rule: RemapRule | None = None
        for part in ACTION_PARTS[1 if self._ros_1 else 2]:
            found = self._look_up(
                f"{program_name}{part}", self._topics if part in _TOPICS_OF_ACTIONS else self._services
            )
            if found is None or (found[0] is not None and not found[0].endswith(part)):
                return None
            names.append(found[0] and found[0].removesuffix(part))
            first_rule = first_rule or found[1]
        # An action whose parts have gone different ways is none any more, and stays where it was.
        return (names[0], first_rule) if first_rule and len(set(names)) == 1 else None

    def _look_up(self, program_name: str, table: Mapping[str, RemapRule | None]) -> tuple[str | None, RemapRule] | None:
        if program_name not in table:
            return None
        rule = table[program_name]
        if rule is None:
            # Two spellings of one name in ROS 1.
            return None, self._rules_by_name[program_name][0]
        return (None if rule.name is None else self.expand(rule.name)), rule
