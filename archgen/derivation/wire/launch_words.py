"""Words of a command line that are rules for names (`-r x:=y` behind `--ros-args`, and `x:=y` alone), or parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import NamedTuple, dataclass
from archgen.model.node import Node
from archgen.model.parameter import ParameterValue

JOINT = ":="
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
            if JOINT in text and not (text.startswith("_") and not text.startswith("__"))
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
            if JOINT in text:
                yield RuleWord(text, at, is_optional=True)
        elif text in _RULE_OPTIONS:
            rule = next(words, None)
            yield RuleWord(rule.text, rule.at) if rule else RuleWord("", at)
        elif text in _OTHER_OPTIONS:
            next(words, None)
        elif JOINT in text:
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
        parameter, joint, text = word.partition(JOINT)
        whose, _, name = parameter.rpartition(":")
        if is_for_ros and joint and flag in _PARAMETER_OPTIONS and (whose in {"", node.full_name[1:]} or "/" in whose):
            number = int(text) if _WHOLE_NUMBER.fullmatch(text) else text
            yield ParameterValue(name, None if "/" in whose else _FLAGS.get(text.lower(), number), at, at)
