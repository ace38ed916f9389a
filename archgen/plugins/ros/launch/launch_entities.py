"""Launch files in XML and YAML as one tree, elements with attributes and children, each with its place; and the actions
that launch files of all kinds are turned into before anything is filled in, in the order of the file.

What a launch file starts: nodes, containers and programs, with everything filled in.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

from archgen.plugin.importing import (
    ForeignFileError,
    MappingNode,
    ScalarNode,
    SequenceNode,
    Span,
    XmlElement,
    YamlNode,
    node_to_data,
    parse_xml,
    parse_yaml,
)
from archgen.plugin.model import NO_SCHEDULING, ProcessScheduling
from archgen.plugins.ros.launch.launch_values import LaunchValue
from archgen.plugins.ros.launch.substitution_texts import read_substituted_text

ActionKind = str
"""`argument` `configure` `node` `container` `load` `process` `include` `group` `namespace` `parameter` `parameter_file`
`remap` `environment` `host` `server_parameter` `later` `call` `ignored` `unread`."""


@dataclass(slots=True, eq=False)
class LaunchCondition:
    """When an action counts: if a value is true, or (`is_negated`) if it is not."""

    value: LaunchValue
    is_negated: bool = False


@dataclass(slots=True, eq=False)
class ConditionalValue:
    """A remap, parameter, variable or argument of an action that counts only under conditions."""

    value: LaunchValue
    conditions: list[LaunchCondition]


@dataclass(slots=True, eq=False)
class LaunchAction:
    """One action. `word` is what the file calls it, `values` its arguments by archgen's names for them."""

    kind: ActionKind
    word: str
    span: Span
    values: dict[str, LaunchValue] = field(default_factory=dict)
    children: list[LaunchAction] = field(default_factory=list)
    conditions: list[LaunchCondition] = field(default_factory=list)

    def get(self, name: str, default: LaunchValue = None) -> LaunchValue:
        """Return an argument."""
        return self.values.get(name, default)


@dataclass(slots=True, eq=False)
class LaunchedNode:
    """One node, container (`container`), node in a container (`loaded`), or program that is no node (`program`)."""

    form: str
    word: str
    """What the launch file calls it."""
    span: Span
    file: str
    """The launch file that starts it."""
    action: LaunchAction | None = None
    """The action that starts it."""
    package: str = ""
    executable: str = ""
    plugin: str = ""
    name: str = ""
    program_name: str = ""
    """What its program calls itself where nothing else names it, as far as the library that ships knows."""
    namespace: str = ""
    is_lifecycle: bool = False
    is_nodelet: bool = False
    command: list[str] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    remaps: dict[str, str] = field(default_factory=dict)
    unclear_remaps: set[str] = field(default_factory=set)
    """What a program says and a computed remap gives another name; `*` where that is computed, too."""
    parameters: dict[str, LaunchValue] = field(default_factory=dict)
    unclear_parameters: dict[str, str] = field(default_factory=dict)
    """Why the value of a parameter is not known, by its name; by `*` why those are not that nothing else gives: a file is not read."""
    file_parameters: set[str] = field(default_factory=set)
    """The names of the parameters that a file gives, and nothing behind it."""
    parameter_files: list[str] = field(default_factory=list)
    parameter_commands: dict[str, list[str]] = field(default_factory=dict)
    host: str = ""
    respawn: bool = False
    respawn_delay: str = ""
    environment: dict[str, str] = field(default_factory=dict)
    directory: str = ""
    user: str = ""
    scheduling: ProcessScheduling = NO_SCHEDULING
    container: LaunchedNode | None = None
    container_name: str = ""
    """The full name of the container that loads it, where another action starts that."""
    conditions: list[str] = field(default_factory=list)
    is_on: bool = True
    """Whether its conditions hold by the defaults, as far as that can be told."""
    launch_arguments: dict[str, str] = field(default_factory=dict)
    """The launch arguments that were filled in, with their values."""
    written: dict[str, str] = field(default_factory=dict)
    """What stood where an argument was filled in, by the key: `$(var use_sim_time)`."""
    other_ways: list[dict[str, Any]] = field(default_factory=list)
    """What else may start it, by other conditions."""

    @property
    def full_name(self) -> str:
        """Its name with the namespace; empty where the program names itself."""
        return f"{self.namespace.rstrip('/')}/{self.name}" if self.name else ""

    @property
    def known_name(self) -> str:
        """Its name with the namespace, or what is known of how its program calls it; empty where nothing is."""
        name = self.name or self.program_name
        return f"{self.namespace.rstrip('/')}/{name}" if name else ""


def join_names(outer: str, inner: str) -> str:
    """Return a name in a namespace, from the root; one that begins with `/` stays as it is. Empty stands for the root."""
    if inner.startswith("/"):
        return inner
    return f"{outer.rstrip('/')}/{inner}" if inner else outer.rstrip("/")


def clean_name(name: str) -> str:
    """Return a name as ROS 1 cleans it: without empty parts."""
    return ("/" if name.startswith("/") else "") + "/".join(part for part in name.split("/") if part)


_LIST_ATTRIBUTES = frozenset({"value"})


@dataclass(slots=True, eq=False)
class LaunchEntity:
    """One element of a launch file. Attributes of YAML may be other than text."""

    tag: str
    span: Span
    attributes: dict[str, Any] = field(default_factory=dict)
    children: list[LaunchEntity] = field(default_factory=list)
    text: str = ""

    def find_all(self, *tags: str) -> list[LaunchEntity]:
        """Return the children with one of these tags."""
        return [child for child in self.children if child.tag in tags]


def read_xml_entities(file: str, data: bytes) -> LaunchEntity:
    """Return the outermost element of a launch file in XML. Raise ForeignFileError."""
    root = parse_xml(file, data)
    if root.tag != "launch":
        words = f"its outermost element is `{root.tag}`, and not `launch`"
        raise ForeignFileError(words, root.span(file), "give a launch file")
    return _read_element(file, root)


def _read_element(file: str, element: XmlElement) -> LaunchEntity:
    # The tree is no deeper than parse_xml lets it be.
    children = [_read_element(file, child) for child in element.children]
    return LaunchEntity(element.tag, element.span(file), dict(element.attributes), children, element.text)


def read_yaml_entities(file: str, text: str) -> LaunchEntity:
    """Return the list below `launch` of a launch file in YAML. Raise ForeignFileError."""
    document, problems = parse_yaml(file, text)
    if document is None:
        problem = problems[0] if problems else None
        words = problem.message if problem else "it is no mapping"
        raise ForeignFileError(words, problem.span if problem else Span.of_file(file), "correct the YAML")
    launch = document.root.get("launch")
    if not isinstance(launch, SequenceNode):
        words = "it has no list `launch`"
        raise ForeignFileError(words, document.root.span, "give a launch file: `launch: [{node: {...}}]`")
    return LaunchEntity("launch", launch.span, {}, _read_items(launch))


def _read_items(sequence: SequenceNode) -> list[LaunchEntity]:
    entities: list[LaunchEntity] = []
    for item in sequence.items:
        if isinstance(item, MappingNode):
            entities += [_read_node(entry.key, entry.value, entry.key_span) for entry in item]
        else:
            # It is no action, and noted as such.
            entities.append(LaunchEntity(item.text if isinstance(item, ScalarNode) else "list", item.span))
    return entities


def _read_node(tag: str, node: YamlNode, span: Span) -> LaunchEntity:
    if isinstance(node, ScalarNode):
        return LaunchEntity(tag, span, {"value": node.value}, text=node.text)
    if isinstance(node, SequenceNode):
        return LaunchEntity(tag, span, {}, _read_items(node))
    entity = LaunchEntity(tag, span)
    for entry in node:
        value = entry.value
        if isinstance(value, ScalarNode):
            entity.attributes[entry.key] = value.value if value.value is not None else ""
        elif entry.key in _LIST_ATTRIBUTES:
            entity.attributes[entry.key] = node_to_data(value)
        elif entry.key in {"children", "actions"} and isinstance(value, SequenceNode):
            entity.children += _read_items(value)
        elif isinstance(value, SequenceNode):
            entity.children += [_read_node(entry.key, item, item.span) for item in value.items]
        else:
            entity.children.append(_read_node(entry.key, value, entry.key_span))
    return entity


class EntityReader:
    """Turns elements into actions. `folder` is what `$(dirname)` stands for."""

    is_ros_1: ClassVar[bool]
    plain_actions: ClassVar[Mapping[str, tuple[ActionKind, Mapping[str, str]]]]
    """By their tags, elements whose attributes are what an action takes: its kind, and attributes by archgen's names."""
    unread_reasons: ClassVar[Mapping[str, str]]
    node_keys: ClassVar[Mapping[str, tuple[str, ...]]]
    """The attributes of a node by archgen's names for them; of several the first that is written counts."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._readers: dict[str, Callable[[LaunchEntity], LaunchAction]] = {}

    def read_launch(self, root: LaunchEntity) -> list[LaunchAction]:
        """Return the actions of a launch file."""
        return [self._read_entity(child) for child in root.children]

    def _value(self, value: Any) -> LaunchValue:  # noqa: ANN401 - XML gives text, YAML more
        if isinstance(value, str):
            return read_substituted_text(value, self._folder, is_ros_1=self.is_ros_1)
        return [self._value(item) for item in value] if isinstance(value, list) else value

    def _attribute(self, entity: LaunchEntity, *names: str) -> LaunchValue:
        return next((self._value(entity.attributes[name]) for name in names if name in entity.attributes), None)

    def _read_entity(self, entity: LaunchEntity) -> LaunchAction:
        tag = entity.tag.replace("-", "_")
        if tag in self._readers:
            action = self._readers[tag](entity)
        elif tag in self.plain_actions:
            kind, names = self.plain_actions[tag]
            values = {key: self._attribute(entity, name) for key, name in names.items()}
            action = LaunchAction(kind, entity.tag, entity.span, values)
        else:
            reason = self.unread_reasons.get(tag, "archgen does not know it")
            action = LaunchAction("unread", entity.tag, entity.span, {"reason": reason})
        action.conditions += self._read_conditions(entity)
        return action

    def _read_conditions(self, entity: LaunchEntity) -> list[LaunchCondition]:
        return [
            LaunchCondition(self._attribute(entity, word), is_negated)
            for word, is_negated in (("if", False), ("unless", True))
            if word in entity.attributes
        ]

    def _condition(self, _entity: LaunchEntity, value: LaunchValue) -> LaunchValue:
        """Return what an element inside of another one gives, with its own conditions if such elements have any."""
        return value

    def _read_pairs(self, entity: LaunchEntity, tag: str, first: str, second: str) -> list[LaunchValue]:
        """Return two attributes of each child with a tag."""
        return [
            self._condition(each, (self._attribute(each, first), self._attribute(each, second)))
            for each in entity.find_all(tag)
        ]

    def _read_node_values(self, entity: LaunchEntity) -> dict[str, LaunchValue]:
        values = {
            key: value
            for key, names in self.node_keys.items()
            if (value := self._attribute(entity, *names)) is not None
        }
        values["arguments"] = [value] if (value := self._attribute(entity, "args")) is not None else []
        values["splits_words"] = True
        values["remaps"] = self._read_pairs(entity, "remap", "from", "to")
        values["environment"] = self._read_pairs(entity, "env", "name", "value")
        return values
