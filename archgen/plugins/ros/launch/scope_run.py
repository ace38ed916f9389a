"""What actions of launch files set for those behind them: arguments, namespaces, remaps, parameters, the environment.

Values of launch arguments that are given on the command line, and what files declare: a name that none declares is refused.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from archgen.plugin.importing import ForeignFileError, ImportNote, Span, WorkBudget, find_closest, read_bounded
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_entities import (
    ActionKind,
    ConditionalValue,
    LaunchAction,
    LaunchedNode,
    clean_name,
    join_names,
)
from archgen.plugins.ros.launch.launch_files import MAX_LAUNCH_BYTES, LaunchFiles
from archgen.plugins.ros.launch.launch_parameter_values import FILE_KIND, ParameterFileReader, hand_on_file
from archgen.plugins.ros.launch.launch_values import (
    OPEN,
    LaunchValue,
    Substitution,
    UnknownValue,
    describe_launch_value,
)

_MAX_SHOWN = 12
_VARIABLE_WITHOUT_VALUE = re.compile(r"\$\(env (\w+)\)")
_MAX_NAME = 255
"""No name of something that is remapped is longer."""


@dataclass(slots=True)
class DeclaredArgument:
    """An argument as a file declares it. `is_fixed` is one of ROS 1 with a `value`, which nobody can set from outside."""

    span: Span
    choices: tuple[str, ...] = ()
    is_fixed: bool = False


@dataclass(slots=True)
class LaunchArguments:
    """What is given for launch arguments, and what the files that were read say of them."""

    given: Mapping[str, str] = field(default_factory=dict)
    _declared: dict[str, DeclaredArgument] = field(default_factory=dict)

    def declare(self, name: str, argument: DeclaredArgument) -> None:
        """Remember an argument. Of several declarations one that can be set counts, then the first."""
        known = self._declared.get(name)
        if known is None or (known.is_fixed and not argument.is_fixed):
            self._declared[name] = argument

    def refuse_unknown(self, asked_names: Iterable[str], file: str) -> None:
        """Raise ForeignFileError for what is given and no file declares or asks for, or what it cannot be."""
        asked_names = frozenset(asked_names)
        for name, value in self.given.items():
            argument = self._declared.get(name)
            if argument is None and name in asked_names:
                continue
            if argument is None:
                words = f"no launch file that is read declares an argument `{name}`"
                raise ForeignFileError(words, Span.of_file(file), self._suggest(name))
            if argument.is_fixed:
                words = f"the argument `{name}` has a fixed value here, and cannot be set"
                raise ForeignFileError(words, argument.span, f"leave out `{name}:={value}`, or declare a `default`")
            if argument.choices and value not in argument.choices:
                words = f"`{value}` is none of the choices of the argument `{name}`"
                raise ForeignFileError(words, argument.span, f"it is one of {', '.join(argument.choices)}")

    def _suggest(self, name: str) -> str:
        names = sorted(each for each, argument in self._declared.items() if not argument.is_fixed)
        closest = find_closest(name, names)
        if closest is not None:
            return f"did you mean `{closest}`?"
        if not names:
            return "they declare none"
        more = f" and {len(names) - _MAX_SHOWN} more" if len(names) > _MAX_SHOWN else ""
        return f"they declare {', '.join(names[:_MAX_SHOWN])}{more}"


_MAX_STEPS = 6_000_000
"""Of one import, whatever is read: 50,000 nodes that a loop makes are fewer."""
_STEPS_ADDED_FOR_A_BYTE = 2
"""What is written out has more, of which reading it once takes a half: 50,000 nodes in XML, each with a few parameters and names, are 9 MB."""
_STEPS_OF_A_FILE = 400


class ScopeRun:
    """Walks through what sets something. Notes are kept here, each one once for a place."""

    def __init__(self, files: LaunchFiles, arguments: LaunchArguments) -> None:
        self.files, self.arguments = files, arguments
        self.parameter_reader = ParameterFileReader()
        self.budget = WorkBudget(_MAX_STEPS)
        self.context = LaunchContext(self.budget)
        self.notes: list[ImportNote] = []
        self.hosts: dict[str, str] = {}
        """The machines of ROS 1, with their addresses."""
        self.open_files: list[Path] = []
        """The files that are read just now, each included by the one before."""
        self._read_files: set[Path] = set()
        self._seen_notes: set[tuple[str, str, int, str]] = set()
        self._asked_variables: set[str] = set()
        self._handlers: dict[ActionKind, Callable[[LaunchAction], None]] = {
            "argument": self._run_argument,
            "configure": self._run_configure,
            "namespace": lambda action: self.push_namespace(action, action.get("namespace")),
            "parameter": self._run_parameter,
            "parameter_file": self._run_parameter_file,
            "remap": self._run_remap,
            "environment": self._run_environment,
            "host": self._run_host,
        }
        """Who walks through which kind of action; any other kind is not read."""

    def _run_argument(self, action: LaunchAction) -> None:
        name = self.resolve_told(action, "its name", action.get("name"))
        if name is None:
            return
        if self._can_be_set():
            self.arguments.declare(name, DeclaredArgument(action.span, self._read_choices(action)))
        default = action.get("default")
        if name not in self.context.scope.configurations and default is not None:
            value = self.context.resolve(default)
            if isinstance(value, UnknownValue):
                self.add_note(
                    action.word, f"the default of `{name}` is computed: `{value.reason}`", action.span, fate="noted"
                )
            self.context.scope.configurations[name] = value
        if default is None and name not in self.context.scope.configurations:
            message = f"the argument `{name}` has no default: what it gives stays `{describe_launch_value(Substitution('var', (name,)))}`"
            self.add_note(action.word, message, action.span, fate="noted")

    def _can_be_set(self) -> bool:
        """Whether arguments of this file can be set on the command line: in ROS 1 only those of the file that is launched."""
        return not self.context.is_ros_1 or len(self.open_files) == 1

    def _read_choices(self, action: LaunchAction) -> tuple[str, ...]:
        choices = action.get("choices")
        texts = [self.context.resolve(each) for each in choices] if isinstance(choices, list | tuple) else []
        plain_texts = tuple(text for text in texts if isinstance(text, str) and OPEN not in text)
        return plain_texts if len(plain_texts) == len(texts) else ()

    def _run_configure(self, action: LaunchAction) -> None:
        name = self.resolve_told(action, "its name", action.get("name"))
        if name is None:
            return
        if action.get("is_fixed") and self._can_be_set():
            self.arguments.declare(name, DeclaredArgument(action.span, is_fixed=True))
        value = self.context.resolve(action.get("value"))
        verdicts = [self.context.judge_condition(condition) for condition in action.conditions]
        unsure = next((words for words, verdict in verdicts if verdict is None), None)
        if unsure is not None and self.context.scope.configurations.get(name) != value:
            value = UnknownValue(f"either way of `{unsure}`", action.span.line, action.span.file)
        self.context.scope.configurations[name] = value

    def push_namespace(self, action: LaunchAction, value: LaunchValue) -> None:
        """Go into a namespace."""
        text = self.context.resolve(value)
        scope = self.context.scope
        if isinstance(text, UnknownValue):
            self.tell_computed(action, "the namespace", text)
            scope.namespace = text
        elif isinstance(scope.namespace, str):
            scope.namespace = join_names(scope.namespace, text)

    def _run_parameter(self, action: LaunchAction) -> None:
        name = self.resolve_told(action, "its name", action.get("name"))
        if name is not None:
            self.context.scope.parameters = (*self.context.scope.parameters, {name: action.get("value")})

    def _run_parameter_file(self, action: LaunchAction) -> None:
        file = Substitution(FILE_KIND, (action.get("file"), "", None))
        self.context.scope.parameters = (*self.context.scope.parameters, file)

    def _run_remap(self, action: LaunchAction) -> None:
        pair = self.resolve_remap(action, "the name", (action.get("from"), action.get("to")))
        if pair is not None:
            scope = self.context.scope
            # In ROS 1 a later rule for a name takes the place of an earlier one, in ROS 2 the first one counts.
            kept = [each for each in scope.remaps if not (self.context.is_ros_1 and each[0] == pair[0])]
            scope.remaps = (*kept, pair)

    def resolve_remap(self, action: LaunchAction, what: str, pair: Sequence[LaunchValue]) -> tuple[str, str] | None:
        """Return the two names of a remap; None, with a note, for what only running the file would tell, or names nothing."""
        own_name, name = (self.context.resolve(part) for part in pair)
        if isinstance(own_name, UnknownValue) or isinstance(name, UnknownValue):
            self.tell_computed(action, what, next(each for each in (own_name, name) if isinstance(each, UnknownValue)))
        elif not 0 < len(own_name) <= _MAX_NAME:
            said = "is of a longer name than any" if own_name else "does not say of what"
            self.add_note(action.word, f"a remap to `{name}` {said}", action.span)
        else:
            return (clean_name(own_name), clean_name(name)) if self.context.is_ros_1 else (own_name, name)
        return None

    def _run_environment(self, action: LaunchAction) -> None:
        name, value = self.context.resolve(action.get("name")), self.context.resolve(action.get("value"))
        if isinstance(name, str) and isinstance(value, str):
            self.context.scope.environment = {**self.context.scope.environment, name: value}
        else:
            unknown = value if isinstance(value, UnknownValue) else UnknownValue(str(name))
            self.tell_computed(action, "the value", unknown)

    def _run_host(self, action: LaunchAction) -> None:
        name = self.context.resolve(action.get("name"))
        address = self.context.resolve(action.get("address", ""))
        if isinstance(name, str):
            self.hosts[name] = address if isinstance(address, str) else ""

    def resolve_pairs(self, pairs: LaunchValue) -> list[tuple[str, LaunchValue]]:
        """Return pairs of a name and a value, filled in."""
        items = pairs.items() if isinstance(pairs, Mapping) else pairs if isinstance(pairs, list | tuple) else ()
        resolved = []
        for pair in items:
            if isinstance(pair, list | tuple) and len(pair) == 2:  # noqa: PLR2004 - a name and a value
                name, value = self.context.resolve(pair[0]), pair[1]
                is_file = isinstance(value, Substitution) and value.kind == FILE_KIND
                value = hand_on_file(value, self.context) if is_file else self.context.resolve(value)
                if isinstance(name, str):
                    resolved.append((name, value))
        return resolved

    def choose_values(self, action: LaunchAction, values: LaunchValue) -> list[LaunchValue]:
        """Return what is given, as a list, without what does not count by its own conditions."""
        items = list(values) if isinstance(values, list | tuple) else [] if values is None else [values]
        chosen: list[LaunchValue] = []
        for item in items:
            verdicts = (
                [self.context.judge_condition(each) for each in item.conditions]
                if isinstance(item, ConditionalValue)
                else []
            )
            unsure = next((words for words, verdict in verdicts if verdict is None), None)
            if any(verdict is False for _, verdict in verdicts):
                continue
            if unsure is not None:
                self.add_note(action.word, f"what counts only {unsure} is left out", action.span)
                continue
            chosen.append(item.value if isinstance(item, ConditionalValue) else item)
        return chosen

    def read_file(self, path: Path) -> bytes | None:
        """Return what a launch file holds, or a module beside it; None where that is more than is followed."""
        data = read_bounded(path, MAX_LAUNCH_BYTES)
        if path not in self._read_files:
            self._read_files.add(path)
            self.budget.add(_STEPS_ADDED_FOR_A_BYTE * len(data))
        steps = _STEPS_OF_A_FILE + len(data)
        return data if self.pay(steps, "launch file", Span.of_file(self.files.show_path(path))) else None

    def pay(self, steps: int, word: str, span: Span) -> bool:
        """Whether the budget has so many steps more; the first time that it has not is noted."""
        return self.budget.pay(steps) or self.tell_excess(word, span)

    def tell_excess(self, word: str, span: Span) -> bool:
        """Note, once, that there is more than is followed; False, for what is not done."""
        if words := self.budget.tell_excess():
            self.add_note(word, words, span, "give launch files that start less, one after the other")
        return False

    def add_note(self, kind: str, message: str, span: Span, help_line: str = "", fate: str = "not taken") -> None:
        """Add a note, once for each place. The first one about a variable of the environment says who gives it a value."""
        key = (span.file, kind, span.line, message)
        if key not in self._seen_notes:
            self._seen_notes.add(key)
            missing = [name for name in _VARIABLE_WITHOUT_VALUE.findall(message) if name not in self._asked_variables]
            if missing and not help_line:
                self._asked_variables.update(missing)
                help_line = "say what it is: " + " ".join(f"`--env {name}=VALUE`" for name in dict.fromkeys(missing))
            self.notes.append(ImportNote(kind, message, span, help_line, fate))

    def take_notes(self) -> list[ImportNote]:
        """Return the notes up to here, and forget them."""
        notes, self.notes = self.notes, []
        self._seen_notes.clear()
        return notes

    def tell_computed(self, action: LaunchAction | LaunchedNode, what: str, value: UnknownValue) -> None:
        """Note what only running the file would tell of an action, or of what it starts."""
        place = Span(value.file or action.span.file, value.line, 1, value.line, 2) if value.line else action.span
        self.add_note(action.word, f"{what} is computed: `{value.reason}`", place)

    def resolve_told(self, action: LaunchAction, what: str, value: LaunchValue) -> str | None:
        """Return a value as text; None for what only running the file would tell, which is noted."""
        text = self.context.resolve(value)
        if isinstance(text, str):
            return text
        self.tell_computed(action, what, text)
        return None
