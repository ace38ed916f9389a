"""Prove an insertion: the file says what it said plus the new element, and no other element of the project changed.

Whether an element changed is the comparison's answer: its normal form (`compare.compared_elements`) is equal or not.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from archgen import pipeline
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.compared_elements import MAPPED_KEY, ComparedElement
from archgen.compare.element_listing import list_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.edit.new_element import NewElement
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import LoadedProject, load_from_files
from archgen.syntax import yaml_parser
from archgen.syntax.overlaid_files import OverlaidFiles
from archgen.syntax.yaml_tree import node_to_data


@dataclass(frozen=True, slots=True)
class EditConsequences:
    """What an insertion would do besides adding its element: new errors, and other elements that change."""

    errors: tuple[Diagnostic, ...]
    changed_elements: tuple[str, ...]


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
    return _freeze_order(node_to_data(new_document.root)) in (_freeze_order(expected), _freeze_order(expected_inline))


def _with_element(data: object, path: tuple[str, ...], element: NewElement) -> object:
    mapping = data if isinstance(data, dict) else {}
    if not path:
        return {**mapping, element.id: element.parsed_body}
    return {**mapping, path[0]: _with_element(mapping.get(path[0]), path[1:], element)}


def _freeze_order(data: object) -> object:
    """Return data as tuples, so that the order of mappings counts: elements appear in it."""
    if isinstance(data, dict):
        return tuple((key, _freeze_order(value)) for key, value in data.items())
    if isinstance(data, list):
        return [_freeze_order(value) for value in data]
    return (type(data), repr(data))


def find_consequences(checked_project: CheckedProject, file: str, text: str, element_id: str) -> EditConsequences:
    """Judge the project with one file's text replaced, in memory; `element_id` is the id of the new element."""
    judged = pipeline.judge_project(load_with_text(checked_project, file, text))
    # Changes the project that was passed in: errors about the new text are shown with lines of the new text.
    checked_project.sources.add_text(file, text)  # what is quoted of it now
    errors = list_new_errors(checked_project, judged)
    return EditConsequences(
        tuple(errors), tuple(_changed_elements(checked_project.architecture, judged.architecture, element_id))
    )


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


def _changed_elements(old: Architecture, new: Architecture, element_id: str) -> Iterator[str]:
    """Yield the elements that differ from before, whatever their kind; edges show where references lead."""
    # No rename is looked for: what is called otherwise now is another element, and its references are lost.
    matched_ids = MatchedIds()
    for name in old.components:
        if name in new.components:
            # So that a component's second node does not move its timing to the node in one version only.
            matched_ids.add_pair("component", name, name)
    elements_before, elements_after = list_elements(ArchitectureVersion(old), ArchitectureVersion(new), matched_ids)
    sharing_nodes = _find_sharing_nodes(new, element_id)
    for key, element in elements_before.items():
        old_values = _own_values(element, sharing_nodes)
        new_values = _own_values(elements_after[key], sharing_nodes) if key in elements_after else None
        # A port of which a node says nothing but that it carries it is not written.
        if old_values != new_values and (old_values or element.kind != "port"):
            yield element.own_id
    old_edges, new_edges = (
        {(edge.output, edge.input) for edge in old.edges},
        {(edge.output, edge.input) for edge in new.edges},
    )
    yield from sorted(
        f"{output} -> {input_port}"
        for output, input_port in old_edges ^ new_edges
        if element_id not in {output.rpartition(".")[0], input_port.rpartition(".")[0]}
    )


def _find_sharing_nodes(architecture: Architecture, element_id: str) -> frozenset[str]:
    """Return the nodes that share a component with a new node."""
    new_node = architecture.nodes.get(element_id)
    components = set(new_node.implements) if new_node else set()
    return frozenset(node.id for node in architecture.nodes.values() if not components.isdisjoint(node.implements))


def _own_values(element: ComparedElement, sharing_nodes: frozenset[str]) -> Mapping[str, object]:
    """Return an element's values without what a node beside it is there to change.

    That a component is mapped, which ports a node carries without writing them, and what timing a node has from a
    component that no other node implements: whoever adds a second node to a component asks for that.
    """
    is_sharing = element.kind == "node" and element.id in sharing_nodes
    return {
        key: value
        for key, value in element.values.items()
        if key not in {MAPPED_KEY, "carried"} and not (is_sharing and key.startswith("timing."))
    }
