"""What a parameter file says to which node: files of ROS 2 by node names with wildcards, files of ROS 1 by nesting.

Nested parameters in YAML as values by their dotted names, each with its place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from archgen.diagnostics import Span
from archgen.frozen import dataclass, field, replace
from archgen.model.node import Node
from archgen.model.parameter import MAX_NAME_LENGTH, FileRemark, ParameterValue
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import IgnoreComment, MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

_VALUE_KEY = "ros__parameters"
_TRUE_WORDS = frozenset({"yes", "Yes", "YES", "on", "On", "ON"})
_FALSE_WORDS = frozenset({"no", "No", "NO", "off", "Off", "OFF"})
"""What ROS reads as booleans besides `true` and `false`, where it is not quoted (rcl's parser, and YAML 1.1 in ROS 1)."""
_MAX_NAME_LENGTH = 255
"""The longest name that ROS 2 gives a node, in characters: longer keys are no node's."""
_MAX_SHOWN = 3
_NESTED_HELP = "its first keys are the names of other nodes"
_ANY_PARTS = "**"
_ANY_PART = "*"


@dataclass(frozen=True, slots=True)
class ParameterSection:
    """The values below one pattern of node names, such as `/**` or `/front/camera`."""

    pattern: tuple[str, ...]
    values: tuple[ParameterValue, ...]

    @property
    def name(self) -> str:
        """The pattern as ROS writes it."""
        return "/" + "/".join(self.pattern)


@dataclass(frozen=True, slots=True)
class ParameterText:
    """A parameter file. `sections` are those of ROS 2; `root` is the whole file where it has none.

    `problem` says why the file cannot be read. The comments in `ignores` silence what is found in the file. Where a packed
    file holds the text, all that is in it stands at `packed_span`.
    """

    packed_span: Span | None = None
    sections: tuple[ParameterSection, ...] = ()
    root: MappingNode | None = None
    problem: str = ""
    ignores: tuple[IgnoreComment, ...] = ()
    value_count: int = 0
    """How many values it holds for all nodes."""
    positions: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    """The positions of the sections by the last part of their patterns; of those that end in a wildcard by ""."""

    def list_candidates(self, name: str) -> list[ParameterSection]:
        """Return the sections that may be for a node of a name, in the order of the file."""
        positions = sorted((*self.positions.get(name, ()), *self.positions.get("", ())))
        return [self.sections[position] for position in positions]


def read_parameter_text(path: str, text: str, packed_span: Span | None = None) -> ParameterText:
    """Read a parameter file. Where a packed file holds its text, all that is in it stands at `packed_span`."""
    document, diagnostics = parse_yaml(path, text)
    if document is None:
        problem = next((diagnostic for diagnostic in diagnostics), None)
        line = f" (line {problem.span.line})" if problem and problem.span.line else ""
        return ParameterText(packed_span, problem=f"{problem.message}{line}" if problem else "it is no mapping")
    sections = tuple(_list_sections(document.root, packed_span))
    positions: dict[str, list[int]] = {}
    for position, section in enumerate(sections):
        last_part = section.pattern[-1] if section.pattern else _ANY_PART
        positions.setdefault("" if last_part in {_ANY_PART, _ANY_PARTS} else last_part, []).append(position)
    return ParameterText(
        packed_span,
        sections,
        document.root,
        ignores=_place_ignores(document.ignores, packed_span),
        value_count=sum(len(each.values) for each in sections) or sum(1 for _ in flatten_parameters(document.root)),
        positions={name: tuple(numbers) for name, numbers in positions.items()},
    )


def _place_ignores(ignores: tuple[IgnoreComment, ...], packed_span: Span | None) -> tuple[IgnoreComment, ...]:
    if packed_span is None or not ignores:
        return ignores
    rules = tuple(dict.fromkeys(rule for ignore in ignores for rule in ignore.rules))
    return (IgnoreComment(rules, "; ".join(ignore.why for ignore in ignores), packed_span),)


def _list_sections(root: MappingNode, packed_span: Span | None) -> Iterator[ParameterSection]:
    """Yield the sections of a file of ROS 2 in its order: mappings by namespaces and names, down to `ros__parameters`."""
    # The keys wait with the pattern above them, which they share: a file may hold a million of them.
    pending: list[tuple[tuple[str, ...], str, YamlNode]] = [((), "", root)]
    while pending:
        outer_pattern, key, mapping = pending.pop()
        pattern = (*outer_pattern, *_split_name(key))
        if not isinstance(mapping, MappingNode) or sum(map(len, pattern)) > _MAX_NAME_LENGTH:
            continue
        values = mapping.get(_VALUE_KEY)
        if isinstance(values, MappingNode):
            yield ParameterSection(_fold_pattern(pattern), tuple(_read_values(values, packed_span)))
        else:
            pending += [(pattern, entry.key, entry.value) for entry in reversed(list(mapping))]


def _read_values(mapping: MappingNode, packed_span: Span | None) -> Iterator[ParameterValue]:
    for value in flatten_parameters(mapping, _read_file_scalar):
        yield value if packed_span is None else replace(value, at=packed_span, name_at=packed_span)


def _read_file_scalar(scalar: ScalarNode) -> object:
    if scalar.is_plain and isinstance(scalar.value, str):
        return True if scalar.text in _TRUE_WORDS else False if scalar.text in _FALSE_WORDS else scalar.value
    return scalar.value


def _split_name(name: str) -> tuple[str, ...]:
    return tuple(part for part in name.split("/") if part)


def _fold_pattern(pattern: Sequence[str]) -> tuple[str, ...]:
    """Return a pattern without `**` that follows another one: they mean the same, and would multiply the work."""
    return tuple(
        part
        for number, part in enumerate(pattern)
        if part != _ANY_PARTS or number == 0 or pattern[number - 1] != _ANY_PARTS
    )


def matches_node_name(pattern: tuple[str, ...], name: tuple[str, ...]) -> bool:
    """Whether a pattern of names covers a node's full name: `*` is any one name, `**` any number of them, none too."""
    if sum(part != _ANY_PARTS for part in pattern) > len(name):
        return False
    # The ends in `name` that the pattern read so far may have: a regular expression would backtrack.
    ends = {0}
    for part in pattern:
        if part == _ANY_PARTS:
            ends = set(range(min(ends), len(name) + 1)) if ends else ends
        else:
            ends = {end + 1 for end in ends if end < len(name) and part in (_ANY_PART, name[end])}
        if not ends:
            return False
    return len(name) in ends


def find_node_values(
    parameter_text: ParameterText, scalar: ScalarNode, node: Node, node_names: frozenset[str], *, ros_1: bool
) -> tuple[tuple[ParameterValue, ...], FileRemark | None]:
    """Return what a file says to a node that names it in `scalar`, and what is odd where that is nothing.

    `node_names` are the names and the namespaces of all nodes: they tell a file of ROS 1 that is nested by nodes from one
    that holds the parameters of one node.
    """
    if parameter_text.problem:
        return (), FileRemark(f"`{scalar.text}` cannot be read: {parameter_text.problem}", scalar.span)
    name = _split_name(node.full_name)
    if parameter_text.sections:
        candidates = parameter_text.list_candidates(name[-1] if name else "")
        sections = [each for each in candidates if matches_node_name(each.pattern, name)]
        values = tuple(value for section in sections for value in section.values)
        return values, None if sections else _remark_other_names(parameter_text, scalar, node)
    root = parameter_text.root
    if root is None or not root.entries:
        return (), None
    if not ros_1:
        return (), FileRemark(
            f"`{scalar.text}` has no `{_VALUE_KEY}`, so ROS 2 reads no parameter from it",
            scalar.span,
            f"write `{node.name}: {{{_VALUE_KEY}: {{...}}}}`",
        )
    mappings = _find_mappings(root, name) or ([] if _names_other_nodes(root, node_names) else [root])
    if not mappings:
        return (), FileRemark(f"`{scalar.text}` sets nothing for `{node.full_name}`", scalar.span, _NESTED_HELP)
    return tuple(value for mapping in mappings for value in _read_values(mapping, parameter_text.packed_span)), None


def _remark_other_names(parameter_text: ParameterText, scalar: ScalarNode, node: Node) -> FileRemark:
    names = [f"`{section.name}`" for section in parameter_text.sections[:_MAX_SHOWN]]
    shown_names = ", ".join([*names, *(["..."] if len(parameter_text.sections) > _MAX_SHOWN else [])])
    return FileRemark(
        f"`{scalar.text}` sets nothing for `{node.full_name}`",
        scalar.span,
        f"it is for {shown_names}; `/**` is for every node",
    )


def _names_other_nodes(root: MappingNode, node_names: frozenset[str]) -> bool:
    """Whether a file of ROS 1 is nested by nodes; else all of it is for the node that names it."""
    return any(
        isinstance(entry.value, MappingNode) and not node_names.isdisjoint(_split_name(entry.key)[:1]) for entry in root
    )


def _find_mappings(root: MappingNode, name: tuple[str, ...]) -> list[MappingNode]:
    """Return the mappings below a node's full name, whose parts are keys in one another or joined by `/`."""
    mappings: list[MappingNode] = []
    pending = [(root, name)]
    while pending:
        mapping, parts = pending.pop()
        if not parts:
            mappings.append(mapping)
            continue
        pending += [
            (entry.value, parts[len(key_parts) :])
            for entry in reversed(list(mapping))
            if isinstance(entry.value, MappingNode)
            and (key_parts := _split_name(entry.key))
            and key_parts == parts[: len(key_parts)]
        ]
    return mappings


ScalarReader = Callable[[ScalarNode], object]


def _read_plain(scalar: ScalarNode) -> object:
    return scalar.value


def flatten_parameters(mapping: MappingNode, read_scalar: ScalarReader = _read_plain) -> Iterator[ParameterValue]:
    """Yield the values of nested parameters by their dotted names, as `ros2 param list` shows them.

    A set without anything in it has no value. Where names become too long, all that is below is one value.
    """
    # A stack taken from its end, filled in reverse, so that values come in the order of the file.
    pending: list[tuple[str, MappingEntry]] = [(entry.key, entry) for entry in mapping][::-1]
    while pending:
        name, entry = pending.pop()
        node = entry.value
        if isinstance(node, MappingNode) and len(name) <= MAX_NAME_LENGTH:
            pending += [(f"{name}.{inner.key}", inner) for inner in reversed(list(node))]
        else:
            short_name = name[: MAX_NAME_LENGTH + 1]
            yield ParameterValue(short_name, _read_value(node, read_scalar), node.span, entry.key_span)


def _read_value(node: YamlNode, read_scalar: ScalarReader) -> object:
    if isinstance(node, ScalarNode):
        return read_scalar(node)
    if isinstance(node, SequenceNode):
        return [_read_value(item, read_scalar) for item in node.items]
    return {entry.key: _read_value(entry.value, read_scalar) for entry in node}
