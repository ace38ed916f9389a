"""Prove an insertion: the file says what it said plus the new element, and no other element of the project changed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from archgen import pipeline
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.edit.new_element import NewElement
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import load_from_files
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
    judged = _judge_with(checked_project, file, text)
    # Changes the project that was passed in: errors about the new text are shown with lines of the new text.
    checked_project.sources.add_text(file, text)  # what is quoted of it now
    # Compared without their places: the insertion moves the lines below it.
    known_findings = {(diagnostic.rule, diagnostic.message) for diagnostic in checked_project.findings}
    errors = (
        diagnostic
        for diagnostic in judged.findings
        if diagnostic.severity is Severity.ERROR and (diagnostic.rule, diagnostic.message) not in known_findings
    )
    return EditConsequences(
        tuple(errors), tuple(_changed_elements(checked_project.architecture, judged.architecture, element_id))
    )


def _judge_with(checked_project: CheckedProject, file: str, text: str) -> CheckedProject:
    files = checked_project.loaded_project.files
    return pipeline.judge_project(
        load_from_files(OverlaidFiles(files.root, {file: text.encode()}, files), first_file_of(checked_project))
    )


def first_file_of(checked_project: CheckedProject) -> str:
    """Return the file that was read first: archgen.yaml, or the only one."""
    return checked_project.sources.file_names()[0]


def _changed_elements(old: Architecture, new: Architecture, element_id: str) -> Iterator[str]:
    """Yield the elements of the functional level that differ from before; edges show where references lead."""
    for name, component in old.components.items():
        if new.components.get(name) != component:
            yield name
    for name, group in old.groups.items():
        new_group = new.groups.get(name)
        if new_group is None or replace(new_group, components=group.components, at=group.at) != group:
            yield name
    old_edges, new_edges = (
        {(edge.output, edge.input) for edge in old.edges},
        {(edge.output, edge.input) for edge in new.edges},
    )
    yield from sorted(
        f"{output} -> {input_port}"
        for output, input_port in old_edges ^ new_edges
        if element_id not in {output.rpartition(".")[0], input_port.rpartition(".")[0]}
    )
    yield from (name for name, node in old.nodes.items() if node.written and name not in new.nodes)
