"""Launch files in XML and YAML as one tree: elements with attributes and children, each with its place."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

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
