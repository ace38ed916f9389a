"""The component types that a project may name: its own, those of its libraries, and those that ship with archgen."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import click

from archgen import pipeline, project
from archgen.compose import list_type_entries
from archgen.compose.expanded_project import TypeExpression
from archgen.compose.type_table import TypeTable, list_generic_names
from archgen.diagnostics import did_you_mean
from archgen.link import mapping_values, slice_merging
from archgen.pipeline import CheckedProject
from archgen.project.library_reading import SHIPPED_ID, SHIPPED_PATH, choose_distro, load_shipped_component_types
from archgen.project.project_loading import load_from_files
from archgen.project.project_search import PROJECT_FILE, ProjectNotFoundError, find_project
from archgen.syntax.project_files import OverlaidFiles
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

SHIPPED_LIBRARY = "builtin"
"""What `--library` calls the types that ship, whether the project has them as a library or not."""
_COLUMNS = ("type", "title", "functionality", "inputs", "outputs", "package")


def check_no_project(project: Path | None) -> CheckedProject | None:
    """Return an empty project where none is named and none is around the current folder; None where there is one."""
    try:
        find_project(project)
    except ProjectNotFoundError:
        if project is None:
            return pipeline.judge_project(
                load_from_files(OverlaidFiles(Path(), {PROJECT_FILE: b"archgen: 1\n"}), PROJECT_FILE)
            )
    return None


def list_component_types(
    checked_project: CheckedProject, asked_library: str | None
) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return the columns and rows of the component types, of one library only if that is asked for.

    Raises `click.UsageError` for a library that the project has not.
    """
    entries = list_type_entries(checked_project.merged_table)
    libraries = {each.id: each.is_shipped for each in checked_project.loaded_project.libraries}
    library = asked_library
    if library == SHIPPED_LIBRARY and library not in libraries:
        # What the project calls it, if it has it.
        library = next((library_id for library_id, is_shipped in libraries.items() if is_shipped), None)
    if library is None and asked_library == SHIPPED_LIBRARY:
        entries = _list_shipped_entries(checked_project)
    elif library is not None:
        _require_library(library, {*libraries, *(name.partition(".")[0] for name in entries if "." in name)})
        entries = {name: entry for name, entry in entries.items() if name.startswith(f"{library}.")}
    elif not any(libraries.values()):
        hint = "Types for well-known ROS packages ship with archgen: `archgen list --of component_types --library builtin`."
        click.echo(hint, err=True)
    return _COLUMNS, list(_list_rows(entries))


def list_type_names(project_path: Path | None) -> tuple[str, ...]:
    """Return the names of the component types that a project may name; none where there is no project."""
    try:
        loaded_project = project.load_project(project_path)
    except project.ProjectNotFoundError:
        return ()
    merged_table, _ = slice_merging.merge_documents(loaded_project.documents)
    merged_table, _ = slice_merging.merge_libraries(merged_table, loaded_project.libraries)
    return tuple(list_type_entries(merged_table))


def _list_shipped_entries(checked_project: CheckedProject) -> dict[str, MappingEntry]:
    """Return what ships for the project's distribution, as one calls it that writes `libraries: {ros: builtin}`."""
    types = load_shipped_component_types(choose_distro(checked_project.loaded_project.distro))
    hint = f"With `libraries: {{{SHIPPED_ID}: {SHIPPED_PATH}}}` in archgen.yaml the project may name these."
    click.echo(hint, err=True)
    return {f"{SHIPPED_ID}.{name}": entry for name, entry in types.items()}


def _require_library(library: str, library_ids: set[str]) -> None:
    if library not in library_ids:
        names = (*sorted(library_ids), SHIPPED_LIBRARY)
        guess = did_you_mean(library, names) or f"there are {', '.join(f'`{name}`' for name in names)}"
        raise click.UsageError(f"the project has no library `{library}`; {guess}")


def _list_rows(entries: Mapping[str, MappingEntry]) -> Iterator[tuple[str, ...]]:
    table = TypeTable(entries, [])
    for name, entry in entries.items():
        body = table.get_body(TypeExpression(name, list_generic_names(entry))) or MappingNode({}, entry.key_span)
        node = body.get("node")
        yield (
            name,
            mapping_values.get_title(mapping_values.get_body(entry), name.rpartition(".")[2]),
            mapping_values.get_text(body, "functionality") or "",
            ", ".join(key for key, _, _ in mapping_values.iterate_elements(body, "inputs")),
            ", ".join(key for key, _, _ in mapping_values.iterate_elements(body, "outputs")),
            (mapping_values.get_text(node, "package") or "") if isinstance(node, MappingNode) else "",
        )
