"""The slice of requirements that another tool hands over: new ones are added, known ones are brought up to date.

What the other tool does not say stays as it is written, in the slice and in all other files.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen import pipeline
from archgen.diagnostics import Diagnostic, Severity
from archgen.edit import earlier_import
from archgen.edit.edit_proof import list_new_errors, load_with_text
from archgen.frozen import dataclass, field
from archgen.link import mapping_values
from archgen.merge.change_transfer import to_texts
from archgen.pipeline import CheckedProject
from archgen.project.slice_parsing import parse_slice
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_tree import MappingNode
from archgen.syntax.yaml_writer import write_yaml

_HEADER = "# Requirements from another tool: `archgen import` brings them up to date, and keeps what that tool does not say.\n"
_SECTIONS = ("use_cases", "requirements")


@dataclass(slots=True)
class RequirementSlice:
    """The text of the slice, what changes in it, and what would be wrong with it."""

    file: str
    text: str = ""
    added: list[str] = field(default_factory=list)
    changed: list[str] = field(default_factory=list)
    unchanged: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    """Requirements of the slice that the other tool does not name any more: they stay."""
    written_elsewhere: list[str] = field(default_factory=list)
    """Keys that another file of the project says otherwise: these stay, and the slice leaves them out."""
    is_rewritten: bool = False
    """Whether the text is a new one, with the comments of the old one at its beginning: elsewhere they stay in place."""
    errors: tuple[Diagnostic, ...] = ()
    is_read: bool = True
    """Whether the project reads the file, by its `sources`."""


def make_requirement_slice(
    checked_project: CheckedProject, imported: Mapping[str, Mapping[str, Mapping[str, Any]]], file: str
) -> RequirementSlice:
    """Return the slice that holds imported sections (`requirements`, `use_cases`); `file` is its path in the project."""
    result = RequirementSlice(file)
    files = checked_project.loaded_project.files
    old_file = read_text_file(files, file) if files.has_path(file) else None
    old_text = old_file.text if old_file else ""
    data, diagnostics = _read_slice(file, old_text)
    problems = (*diagnostics, *([old_file.problem] if old_file and old_file.problem else []))
    if problems:
        # What cannot be read cannot be kept either.
        result.errors = problems
        return result
    others = _read_others(checked_project, file, old_text)
    base = write_yaml(data)
    for section in _SECTIONS:
        _merge_section(section, data, imported.get(section, {}), others, result)
    result.text = _update_text(old_text, base, write_yaml(data), result)
    loaded_project = load_with_text(checked_project, file, result.text)
    result.is_read = file in loaded_project.sources.file_names()
    if result.is_read:
        result.errors = tuple(list_new_errors(checked_project, pipeline.judge_project(loaded_project)))
    else:
        parsed_slice = parse_slice(file, result.text)
        result.errors = (*parsed_slice.diagnostics, *parsed_slice.validate_once().diagnostics)
    return result


def _update_text(old_text: str, base: str, new: str, result: RequirementSlice) -> str:
    """Return the slice with what is new in it."""
    if not old_text.strip():
        return _HEADER + new
    updated = earlier_import.update_slice_text(old_text, base, new)
    result.is_rewritten = updated.is_rewritten
    return updated.text


def _read_slice(file: str, text: str) -> tuple[dict[str, Any], tuple[Diagnostic, ...]]:
    """Return what the slice holds in normal form, and why it cannot be read."""
    content = earlier_import.read_slice_content(file, text)
    if content.diagnostics:
        return {}, content.diagnostics
    foreign = next((entry for entry in content.entries if entry.key not in _SECTIONS), None)
    if foreign:
        message = (
            f"`{foreign.key}` stands in this file, and only requirements and use cases can be brought up to date here"
        )
        refusal = Diagnostic(
            "wrong-value", message, foreign.key_span, Severity.ERROR, help="name a file of its own behind `--into`"
        )
        return {}, (refusal,)
    return content.data, ()


def _read_others(checked_project: CheckedProject, file: str, old_text: str) -> MappingNode:
    """Return what all other files of the project say together."""
    if not old_text:
        return checked_project.merged_table
    return pipeline.judge_project(load_with_text(checked_project, file, "{}\n")).merged_table


def _merge_section(
    section: str,
    data: dict[str, Any],
    imported: Mapping[str, Mapping[str, Any]],
    others: MappingNode,
    result: RequirementSlice,
) -> None:
    elements = data.get(section)
    elements = elements if isinstance(elements, dict) else {}
    if section == "requirements":
        result.missing = [name for name in elements if name not in imported]
    other_elements = mapping_values.get_mapping(others, section)
    for name, body in imported.items():
        written = elements.get(name)
        new_body = dict(written) if isinstance(written, dict) else {}
        other_body = mapping_values.get_mapping(other_elements, name)
        for key, value in body.items():
            if key == "hints":
                _lay_hints(new_body, value, mapping_values.get_mapping(other_body, key))
            elif key in other_body.entries and key not in new_body:
                if to_texts(other_body.entries[key].value) != value:
                    result.written_elsewhere.append(f"{key} of {name}")
            else:
                new_body[key] = value
        is_known = name in elements or name in other_elements.entries
        if section == "requirements":
            kept = result.unchanged if new_body == written or (not new_body and is_known) else result.changed
            (kept if is_known else result.added).append(name)
        if new_body or not is_known:
            elements[name] = new_body or None
    if elements:
        data[section] = elements


def _lay_hints(body: dict[str, Any], hints: Mapping[str, object], other_hints: MappingNode) -> None:
    """Put hints into a requirement beside those for other programs, and those that another file has already."""
    written = body.get("hints")
    all_hints = dict(written) if isinstance(written, dict) else {}
    for program, value in hints.items():
        if program in all_hints or program not in other_hints.entries:
            all_hints[program] = value
    if all_hints:
        body["hints"] = all_hints
