"""Prove an insertion: the file says what it said plus the new element, and no other element of the project changed.

Whether an element changed is the comparison's answer: its normal form (`compare.version_pair`) is equal or not.

The element to be written, as the lines of a block or in braces.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen import pipeline
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.change_listing import list_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.version_pair import MAPPED_KEY, ComparedElement
from archgen.diagnostics import Diagnostic, Severity
from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import LoadedProject, load_from_files
from archgen.syntax import yaml_parser
from archgen.syntax.project_files import OverlaidFiles
from archgen.syntax.yaml_tree import MappingNode, node_to_data
from archgen.syntax.yaml_writer import format_flow, format_scalar


@dataclass(frozen=True, slots=True)
class EditConsequences:
    """What an insertion would do besides adding its element: new errors, and other elements that change."""

    errors: tuple[Diagnostic, ...]
    changed_elements: tuple[str, ...]
    renamed_nodes: tuple[tuple[str, str], ...] = ()
    """Nodes that components bring along, by old and new id: the old one is no longer unique."""


def adds_only_element(old_text: str, new_text: str, path: tuple[str, ...], element: NewElement) -> bool:
    """Return whether a text says exactly what it said before, plus the element."""
    old_document, _ = yaml_parser.parse_yaml("before", old_text)
    new_document, diagnostics = yaml_parser.parse_yaml("after", new_text)
    # Notes and `swallowed-text` do not count here: the data themselves are compared below.
    if (
        old_document is None
        or new_document is None
        or any(
            diagnostic.severity is not Severity.NOTE
            for diagnostic in diagnostics
            if diagnostic.rule != "swallowed-text"
        )
    ):
        return False
    expected = _with_element(node_to_data(old_document.root), path, element)
    # An element in braces has no empty keys, so either form may be read back.
    expected_inline = _with_element(node_to_data(old_document.root), path, element.without_empty_keys())
    return freeze_order(node_to_data(new_document.root)) in (freeze_order(expected), freeze_order(expected_inline))


def _with_element(data: object, path: tuple[str, ...], element: NewElement) -> object:
    mapping = data if isinstance(data, dict) else {}
    if not path:
        return {**mapping, element.id: element.parsed_body}
    return {**mapping, path[0]: _with_element(mapping.get(path[0]), path[1:], element)}


def freeze_order(data: object) -> object:
    """Return data as tuples, so that the order of mappings counts: elements appear in it."""
    if isinstance(data, dict):
        return tuple((key, freeze_order(value)) for key, value in data.items())
    if isinstance(data, list):
        return [freeze_order(value) for value in data]
    return (type(data), repr(data))


def find_consequences(checked_project: CheckedProject, file: str, text: str, element_id: str) -> EditConsequences:
    """Judge the project with one file's text replaced, in memory; `element_id` is the id of the new element."""
    judged = pipeline.judge_project(load_with_text(checked_project, file, text))
    # Changes the project that was passed in: errors about the new text are shown with lines of the new text.
    checked_project.sources.add_text(file, text)  # what is quoted of it now
    errors = list_new_errors(checked_project, judged)
    renamed_nodes = dict(_list_renamed_nodes(checked_project, judged))
    changed_elements = _changed_elements(checked_project, judged, element_id, renamed_nodes)
    return EditConsequences(tuple(errors), tuple(changed_elements), tuple(renamed_nodes.items()))


def list_new_errors(old: CheckedProject, new: CheckedProject) -> Iterator[Diagnostic]:
    """Yield the errors that only the new version of a project has."""
    # Compared without their places: an insertion moves the lines below it.
    known_findings = {(diagnostic.rule, diagnostic.message) for diagnostic in old.findings}
    for diagnostic in new.findings:
        if diagnostic.severity is Severity.ERROR and (diagnostic.rule, diagnostic.message) not in known_findings:
            yield diagnostic


def load_with_text(checked_project: CheckedProject, file: str, text: str) -> LoadedProject:
    """Load a project with one file's text replaced, in memory."""
    files = checked_project.loaded_project.files
    return load_from_files(OverlaidFiles(files.root, {file: text.encode()}, files), first_file_of(checked_project))


def first_file_of(checked_project: CheckedProject) -> str:
    """Return the file that was read first: archgen.yaml, or the only one."""
    return checked_project.sources.file_names()[0]


def list_written_nodes(checked_project: CheckedProject) -> list[Node]:
    """Return the nodes that stand below `nodes`: others follow from what components say of theirs, and have no file."""
    section = checked_project.merged_table.get("nodes")
    written_ids = section.entries.keys() if isinstance(section, MappingNode) else frozenset()
    return [node for node in checked_project.architecture.nodes.values() if node.id in written_ids]


def _list_renamed_nodes(old: CheckedProject, new: CheckedProject) -> Iterator[tuple[str, str]]:
    """Yield nodes that components bring along and that have another id now: a second instance needs longer ones."""
    kept_ids = {node.id for node in (*list_written_nodes(old), *list_written_nodes(new))}
    new_ids = {node.implements: node.id for node in new.architecture.nodes.values() if node.id not in kept_ids}
    for node in old.architecture.nodes.values():
        if node.written and node.id not in kept_ids and new_ids.get(node.implements, node.id) != node.id:
            yield node.id, new_ids[node.implements]


def _changed_elements(
    old_project: CheckedProject, new_project: CheckedProject, element_id: str, renamed_nodes: Mapping[str, str]
) -> Iterator[str]:
    """Yield the elements that differ from before, whatever their kind; edges show where references lead."""
    old, new = old_project.architecture, new_project.architecture
    # No rename is looked for: what is called otherwise now is another element, and its references are lost.
    matched_ids = MatchedIds()
    for name in old.components:
        if name in new.components:
            # So that a component's second node does not move its timing to the node in one version only.
            matched_ids.add_pair("component", name, name)
    for old_id, new_id in renamed_nodes.items():
        matched_ids.add_pair("node", old_id, new_id)
    elements_before, elements_after = list_elements(ArchitectureVersion(old), ArchitectureVersion(new), matched_ids)
    new_nodes = {node.id: node for node in list_written_nodes(new_project)}
    new_node = (
        None if element_id in {node.id for node in list_written_nodes(old_project)} else new_nodes.get(element_id)
    )
    sharing_nodes = _find_sharing_nodes(new, new_node)
    expected_changes = {*_list_replaced_nodes(old, new, new_node), *_list_made_elements(old, new, element_id)}
    for key, element in elements_before.items():
        if (element.kind, element.own_id) in expected_changes:
            continue
        old_values = _own_values(element, sharing_nodes, renamed_nodes)
        new_values = _own_values(elements_after[key], sharing_nodes, renamed_nodes) if key in elements_after else None
        # A port of which a node says nothing but that it carries it is not written.
        if old_values != new_values and (old_values or element.kind != "port"):
            yield element.own_id
    old_edges, new_edges = (
        {(edge.output, edge.input) for edge in old.edges},
        {(edge.output, edge.input) for edge in new.edges},
    )
    is_component = element_id in new.components or element_id in new.shells
    yield from sorted(
        f"{output} -> {input_port}"
        for output, input_port in old_edges ^ new_edges
        if not (is_component and any(port.startswith(f"{element_id}.") for port in (output, input_port)))
    )


def _find_sharing_nodes(architecture: Architecture, new_node: Node | None) -> frozenset[str]:
    components = set(new_node.implements) if new_node else set()
    return frozenset(node.id for node in architecture.nodes.values() if not components.isdisjoint(node.implements))


def _list_replaced_nodes(old: Architecture, new: Architecture, new_node: Node | None) -> Iterator[tuple[str, str]]:
    """Yield the nodes that components brought along which a new node implements: it stands in their place."""
    if new_node is None:
        return
    components = set(new_node.implements)
    for node in old.nodes.values():
        is_gone = node.id not in new.nodes or node.id == new_node.id
        if is_gone and node.implements and components.issuperset(node.implements):
            yield "node", node.id


def _list_made_elements(old: Architecture, new: Architecture, element_id: str) -> Iterator[tuple[str, str]]:
    """Yield what was written as made from a new component type before there was one."""
    if element_id not in new.component_types or element_id in old.component_types:
        return
    for component in (*new.components.values(), *new.shells.values()):
        if element_id in new.list_types_of(component):
            yield "composed" if component.id in new.shells else "component", component.id


def _own_values(
    element: ComparedElement, sharing_nodes: frozenset[str], renamed_nodes: Mapping[str, str]
) -> Mapping[str, object]:
    """Return an element's values without what a node beside it is there to change.

    That a component is mapped, which ports a node carries without writing them, and what timing a node has from a
    component that no other node implements: whoever adds a second node to a component asks for that. Nor the name and
    title that a node has of its id where that has to be longer now.
    """
    is_renamed = element.kind == "node" and element.id in renamed_nodes.values()
    is_sharing = element.kind == "node" and element.id in sharing_nodes
    return {
        key: value
        for key, value in element.values.items()
        if key not in {MAPPED_KEY, "carried"}
        and not (is_sharing and key.startswith("timing."))
        and not (is_renamed and key in {"name", "title"})
    }


ElementValue = str | tuple[str, ...] | Mapping[str, "ElementValue"] | None


@dataclass(frozen=True, slots=True)
class NewElement:
    """An id and its body. `hints` are comments behind keys that are still empty: what belongs there."""

    id: str
    body: ElementValue
    hints: Mapping[str, str] = field(default_factory=dict)

    def nested_below(self, keys: tuple[str, ...]) -> NewElement:
        """Return the element nested in mappings that are not written yet."""
        element = self
        for key in reversed(keys):
            element = NewElement(key, {element.id: element.body}, element.hints)
        return element

    @property
    def parsed_body(self) -> object:
        """The body as a parser reads it back."""
        return _parsed_value(self.body)

    def without_empty_keys(self) -> NewElement:
        """Return the element as it is written in braces, where a key cannot be left empty."""
        return NewElement(self.id, _drop_empty_keys(self.body)) if isinstance(self.body, Mapping) else self

    def to_block(self, indent: str, unit: int) -> list[str]:
        """Write the element as the lines of a block."""
        return list(_block_lines(self.id, self.body, indent, " " * unit, self.hints))

    def to_flow(self) -> str:
        """Write the element in braces, on one line."""
        return f"{format_scalar(self.id)}: {format_flow(self.body)}"


def _drop_empty_keys(body: Mapping[str, ElementValue]) -> dict[str, ElementValue]:
    """Return a body without keys that are empty, and without mappings in which all are."""
    compact_body = {
        key: _drop_empty_keys(value) if isinstance(value, Mapping) else value for key, value in body.items()
    }
    return {key: value for key, value in compact_body.items() if value is not None and value != {}}


def _parsed_value(value: ElementValue) -> object:
    if isinstance(value, Mapping):
        return {key: _parsed_value(inner) for key, inner in value.items()}
    return list(value) if isinstance(value, tuple) else value


def _block_lines(key: str, value: ElementValue, indent: str, unit: str, hints: Mapping[str, str]) -> Iterator[str]:
    if isinstance(value, Mapping) and value:
        yield f"{indent}{format_scalar(key)}:"
        for inner_key, inner_value in value.items():
            yield from _block_lines(inner_key, inner_value, indent + unit, unit, hints)
    elif value is None:
        hint = f"  # {hints[key]}" if key in hints else ""
        yield f"{indent}{format_scalar(key)}:{hint}"
    else:
        yield f"{indent}{format_scalar(key)}: {format_flow(value)}"
