"""Parameters as launch files give them: values with their types, commands whose output is the value, and files.

Read the parameter files that launch files name, where they lie beside: what they say to a node.

What launch files write over parameter files: `RewrittenYaml` and `ReplaceString` of Nav2.

Read what stands behind `--ros-args` (names, remaps, parameters and files), and in front of a program: `sudo`, `env`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from archgen.plugin.importing import (
    ForeignFileError,
    MappingNode,
    ScalarNode,
    Span,
    YamlNode,
    node_to_data,
    parse_yaml,
    read_bounded,
    resolve_scalar,
)
from archgen.plugin.model import is_parameter_name, read_scheduling
from archgen.plugin.ros import ParameterText, matches_node_name, read_parameter_text
from archgen.plugins.ros.launch.launch_context import LaunchContext
from archgen.plugins.ros.launch.launch_entities import LaunchCondition, LaunchedNode, join_names
from archgen.plugins.ros.launch.launch_values import (
    OPEN,
    LaunchValue,
    Substitution,
    UnknownValue,
    describe_launch_value,
    name_object,
)
from archgen.plugins.ros.launch.substitution_texts import split_words

_MAX_DEPTH = 20
_STEPS_OF_A_VALUE = 3
_PARAMETER_TYPES = {
    "str": "text",
    "string": "text",
    "yaml": "yaml",
    "int": "plain",
    "integer": "plain",
    "double": "float",
}


class CommandWords(list[str]):
    """The words of a command whose output is the value."""


def evaluate_parameter(value: LaunchValue, context: LaunchContext, depth: int = 0) -> Any:  # noqa: ANN401
    """Return the value of a parameter as data; CommandWords or an UnknownValue, in mappings too, where it is no plain value."""
    if depth > _MAX_DEPTH or not context.budget.pay(_STEPS_OF_A_VALUE):
        return UnknownValue("values nested very deep")
    if isinstance(value, UnknownValue) or value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Mapping):
        return _evaluate_mapping(value, context, depth)
    if isinstance(value, list | tuple):
        if any(isinstance(item, Substitution) for item in value) and not any(
            isinstance(item, bool | int | float) for item in value
        ):
            # As launch_ros has it: texts and substitutions in one list are one text.
            return evaluate_parameter(Substitution("join", tuple(value)), context, depth + 1)
        items = [
            context.resolve(item) if isinstance(item, list | tuple) else evaluate_parameter(item, context, depth + 1)
            for item in value
        ]
        return next((item for item in items if isinstance(item, UnknownValue)), items)
    return _evaluate_substitution(value, context) if isinstance(value, Substitution) else name_object(value)


def _evaluate_mapping(value: Mapping[Any, LaunchValue], context: LaunchContext, depth: int) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for raw_key, raw_value in value.items():
        key = context.resolve(raw_key)
        if isinstance(key, str):
            found[key] = evaluate_parameter(raw_value, context, depth + 1)
        else:
            found[describe_launch_value(key)] = key
    return found


def split_parameter(value: Any, name: str) -> tuple[Any, list[tuple[str, UnknownValue | CommandWords]]]:  # noqa: ANN401
    """Return what is plain of a parameter's value, None for nothing, and what is not, by the dotted names."""
    if not name.rpartition(".")[2].strip("/"):
        return None, [(name, UnknownValue("what has no name"))]
    if isinstance(value, CommandWords) and not is_parameter_name(name):
        return None, [(name, UnknownValue("what has a name that no parameter can have"))]
    if isinstance(value, UnknownValue | CommandWords):
        return None, [(name, value)]
    if not isinstance(value, dict) or not value:
        return value, []
    kept: dict[str, Any] = {}
    others: list[tuple[str, UnknownValue | CommandWords]] = []
    for key, inner in value.items():
        plain, rest = split_parameter(inner, f"{name}.{key}")
        others += rest
        if plain is not None:
            kept[key] = plain
    return kept or None, others


def _evaluate_substitution(value: Substitution, context: LaunchContext) -> Any:  # noqa: ANN401
    if value.kind == "command":
        return _split_command(value, context)
    if value.kind == "typed":
        inner, kind = value.parts[0], _PARAMETER_TYPES.get(str(value.parts[1]), "yaml")
        command = inner[0] if isinstance(inner, list | tuple) and len(inner) == 1 else inner
        if isinstance(command, Substitution) and command.kind == "command":
            return _split_command(command, context)
        text = context.resolve(inner)
        return text if isinstance(text, UnknownValue) or kind == "text" else _convert_text(text, kind)
    text = context.resolve(value)
    return text if isinstance(text, UnknownValue) else read_value_text(text)


def _convert_text(text: str, kind: str) -> Any:  # noqa: ANN401
    found = read_value_text(text)
    return float(found) if kind == "float" and isinstance(found, int) and not isinstance(found, bool) else found


def read_value_text(text: str) -> Any:  # noqa: ANN401
    """Return what a text is as YAML: `true`, `0.5` and `[1, 2]` are no texts."""
    stripped = text.strip()
    if not stripped or OPEN in stripped:
        return text
    if stripped[0] in "[{" and "\n" not in stripped:
        document, problems = parse_yaml("value", f"value: {stripped}")
        node = document.root.get("value") if document and not problems else None
        return text if node is None else node_to_data(node)
    found = resolve_scalar(stripped)
    return text if isinstance(found, str) or found is None else found


def _split_command(value: Substitution, context: LaunchContext) -> Any:  # noqa: ANN401
    """Return the words of a command, with `$(...)` in one piece."""
    text = context.resolve(value.parts[0])
    return text if isinstance(text, UnknownValue) else CommandWords(split_words(text))


_YAML_1_1_WORDS = {"yes": True, "on": True, "no": False, "off": False}
"""What ROS 1 reads as booleans besides `true` and `false`."""
_MAX_BYTES = 4_000_000
MAX_OPENED_BYTES = 32_000_000
"""How much YAML launch files in Python may open altogether."""
FILE_KIND = "parameter file"
"""The substitution for a file among parameters: its path, the namespace of its values, and its FileRewrites."""


class ParameterFileReader:
    """Reads each file once. `show` gives its name in messages."""

    def __init__(self) -> None:
        self._texts: dict[Path, ParameterText | None] = {}
        self._sizes: dict[Path, int] = {}
        self._opened = 0

    def read_for_node(self, path: Path, full_name: str) -> dict[str, Any] | None:
        """Return the values that a file of ROS 2 gives to a node, by their dotted names; None where it cannot be read."""
        text = self._read(path)
        if text is None or (not text.sections and text.root is None):
            return None
        parts = tuple(part for part in full_name.split("/") if part)
        candidates = text.list_candidates(parts[-1] if parts else "")
        return {
            value.name: value.value
            for section in candidates
            if matches_node_name(section.pattern, parts)
            for value in section.values
        }

    def list_addressed(self, path: Path) -> list[str]:
        """Return the names of nodes to which a file of ROS 2 says something, as it writes them."""
        text = self._read(path)
        return [section.name for section in text.sections] if text is not None else []

    def read_whole(self, path: Path) -> dict[str, Any] | None:
        """Return all values of a file of ROS 1, nested as it has them; None where it cannot be read."""
        text = self._read(path)
        return _read_tree(text.root) if text is not None and text.root is not None else None

    def read_mapping(self, path: Path) -> dict[str, Any] | None:
        """Return what a file in YAML says, with its keys as they are; None where it cannot be read."""
        text = self._read(path)
        # A launch file may open the same file in a loop.
        self._opened += self._sizes.get(path, 0)
        if text is None or text.root is None or self._opened > MAX_OPENED_BYTES:
            return None
        return _read_tree(text.root, "")

    def _read(self, path: Path) -> ParameterText | None:
        if path not in self._texts:
            try:
                data = read_bounded(path, _MAX_BYTES).decode("utf-8", "replace").removeprefix("\ufeff")
            except ForeignFileError:
                self._texts[path] = None
            else:
                self._sizes[path] = len(data)
                text = read_parameter_text(path.name, data)
                self._texts[path] = None if text.problem else text
        return self._texts[path]


def _read_tree(node: MappingNode, ends: str = "/") -> dict[str, Any]:
    """Return a mapping as data, its keys without some characters at their ends."""
    return {entry.key.strip(ends): _read_value(entry.value, ends) for entry in node}


def _read_value(node: YamlNode, ends: str) -> Any:  # noqa: ANN401
    if isinstance(node, MappingNode):
        return _read_tree(node, ends)
    if isinstance(node, ScalarNode) and node.is_plain and node.text.lower() in _YAML_1_1_WORDS:
        return _YAML_1_1_WORDS[node.text.lower()]
    return node.text if isinstance(node, ScalarNode) and not node.is_plain else node_to_data(node)


def read_inline_values(text: str, span: Span) -> dict[str, Any] | None:
    """Return the values of YAML that stands in a launch file; None where it is no mapping."""
    source = read_parameter_text(span.file, text)
    return None if source.problem or source.root is None else _read_tree(source.root)


def read_inline_value(text: str) -> Any:  # noqa: ANN401
    """Return one value of YAML that stands in a launch file."""
    return read_value_text(text)


def nest_values(values: Any, parts: Sequence[str]) -> dict[str, Any]:  # noqa: ANN401 - data of any form
    """Return values below the parts of a name, the outermost first; of a name of very many parts only the first ones."""
    for part in reversed(parts[:_MAX_DEPTH]):
        values = {part: values}
    nested: dict[str, Any] = values
    return nested


def count_leaves(values: Any) -> int:  # noqa: ANN401 - data of any form
    """Return how many values a mapping holds."""
    return sum(map(count_leaves, values.values())) if isinstance(values, dict) else 1


def overlay_parameters(values: dict[str, Any], more: Mapping[str, Any]) -> None:
    """Put values over others, leaf by leaf."""
    for name, value in more.items():
        old = values.get(name)
        if isinstance(old, dict) and isinstance(value, dict):
            overlay_parameters(old, value)
        else:
            values[name] = value


@dataclass(slots=True, eq=False)
class FileRewrites:
    """Values by the names of parameters, and texts that are put in the place of others, under a condition."""

    values: Mapping[LaunchValue, LaunchValue] = field(default_factory=dict)
    texts: Mapping[LaunchValue, LaunchValue] = field(default_factory=dict)
    condition: LaunchCondition | None = None

    def change_values(self, values: Mapping[str, Any], context: LaunchContext) -> dict[str, Any]:
        """Return what a file says with the changes in it; an UnknownValue where only the launch tells."""
        changed = evaluate_parameter(self.values, context)
        is_replaced = True if self.condition is None else context.judge_condition(self.condition)[1]
        texts = {} if is_replaced is False else evaluate_parameter(self.texts, context)
        found: dict[str, Any] = {}
        for name, value in values.items():
            # What is written over a file by its last name, as Nav2's RewrittenYaml has it.
            new_value = changed.get(name, changed.get(name.rpartition(".")[2]))
            if isinstance(new_value, CommandWords):
                new_value = UnknownValue("the output of a command")
            if isinstance(new_value, str):
                new_value = read_value_text(new_value)
            if new_value is None:
                new_value = _replace_texts(value, texts, is_sure=is_replaced is True)
            found[name] = new_value
        return found


class RewrittenFile(str):
    """The name of a parameter file as an argument hands it to another launch file, with what is written over it there already."""

    __slots__ = ("changes", "root_name")
    root_name: str
    changes: tuple[FileRewrites, ...]


def hand_on_file(entry: Substitution, context: LaunchContext) -> str | UnknownValue:
    """Return the name of a file among parameters, with what is written over it as it is at this place."""
    value, namespace, changes = entry.parts
    text = context.resolve(value)
    if isinstance(text, UnknownValue) or not isinstance(changes, FileRewrites):
        return text
    root = context.resolve(namespace)
    handed = RewrittenFile(text)
    handed.root_name = root if isinstance(root, str) else ""
    here = FileRewrites(
        evaluate_parameter(changes.values, context), evaluate_parameter(changes.texts, context), changes.condition
    )
    handed.changes = (here,)
    if isinstance(text, RewrittenFile):
        handed.root_name = "/".join(filter(None, (handed.root_name, text.root_name)))
        handed.changes = (*text.changes, here)
    return handed


def _replace_texts(value: Any, texts: Mapping[str, Any], *, is_sure: bool) -> Any:  # noqa: ANN401 - a value of a file
    if isinstance(value, list):
        items = [_replace_texts(item, texts, is_sure=is_sure) for item in value]
        return next((item for item in items if isinstance(item, UnknownValue)), items)
    for old, new in texts.items():
        if isinstance(value, str) and old in value:
            if not is_sure or not isinstance(new, str):
                return UnknownValue(value)
            value = value.replace(old, new)
    return value


_WITH_VALUE = frozenset(
    {"-r", "--remap", "-p", "--param", "--params-file", "--log-level", "--log-file-name", "-e", "--enclave"}
)


def read_ros_arguments(node: LaunchedNode, add_file: Callable[[str], None]) -> None:
    """Take the arguments of ROS out of a node's arguments, and set what they say."""
    kept: list[str] = []
    rules: dict[str, str] = {}
    words = iter(node.arguments)
    is_for_ros = False
    for word in words:
        if word == "--ros-args":
            is_for_ros = True
        elif word == "--" and is_for_ros:
            is_for_ros = False
        elif is_for_ros and word in _WITH_VALUE:
            _read_rule(node, word, next(words, ""), rules, add_file)
        elif not is_for_ros:
            kept.append(word)
    node.arguments = kept
    # On the command line they stand before those of groups and of the node itself, and the first rule for a name counts.
    if "__ns" in rules:
        node.namespace = join_names("", rules.pop("__ns"))
    names = [rules.pop(key) for key in ("__node", "__name") if key in rules]
    node.name = names[0] if names else node.name
    node.remaps = rules | {name: value for name, value in node.remaps.items() if name not in rules}


def _read_rule(
    node: LaunchedNode, word: str, rule: str, rules: dict[str, str], add_file: Callable[[str], None]
) -> None:
    name, joint, value = rule.partition(":=")
    if word == "--params-file":
        add_file(rule)
    elif not joint:
        return
    elif word in {"-p", "--param"}:
        node.parameters[name] = read_value_text(value)
    elif word in {"-r", "--remap"}:
        rules.setdefault(name, value)


def read_nodelet(node: LaunchedNode) -> None:
    """Read what `nodelet` of ROS 1 is told: to load a plug-in, or to be a manager."""
    if node.package != "nodelet" or node.executable != "nodelet" or not node.arguments:
        return
    verb, *rest = node.arguments
    if verb == "manager":
        node.form, node.package, node.executable, node.arguments = "container", "", "", rest
        return
    if verb not in {"load", "standalone"} or not rest:
        return
    node.is_nodelet, node.form, node.plugin = True, "loaded", rest[0]
    node.package, node.executable = rest[0].partition("/")[0] if "/" in rest[0] else "", ""
    is_loaded = verb == "load" and len(rest) > 1
    if is_loaded:
        node.container_name = join_names(node.namespace, rest[1])
    node.arguments = rest[2:] if is_loaded else rest[1:]


def read_prefix(node: LaunchedNode, prefix: str) -> str:
    """Set what a prefix such as `sudo -u robot -- chrt -f 40 env -C /opt` says: the user, priority and cores of a node, the folder.

    Return what is left of it.
    """
    words = split_words(prefix)
    if words[:1] == ["sudo"] and "-u" in words[1:-1] and OPEN not in prefix:
        place = words.index("-u")
        node.user = words[place + 1]
        words = words[place + 2 :]
        words = words[1:] if words[:1] == ["--"] else words
    if node.form != "container":
        node.scheduling, left = read_scheduling(words)
        words = [*left]
    if words[:2] == ["env", "-C"] and len(words) == 3:  # noqa: PLR2004 - `env -C FOLDER`
        node.directory, words = words[2], []
    return " ".join(words)
