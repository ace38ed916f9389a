"""A checked project as one mapping, with the contents of the files that it names."""

from __future__ import annotations

from collections.abc import Iterable

from archgen.checking.checked_project import CheckedProject
from archgen.checking.linked_project import read_interface_files
from archgen.link import interface_sources
from archgen.link.project_packing import PackedAttachments, PackedProject, has_packed_path, pack_project


def pack_checked_project(checked_project: CheckedProject) -> PackedProject:
    """Return the whole project as one mapping, with the contents of interface files, chapters and pictures."""
    texts, _ = read_interface_files(checked_project.loaded_project)
    judged_variants = tuple(checked_project.variants.values())
    attachments = PackedAttachments(
        _end_lines_alike(
            (name, text) for file, text in texts.items() if (name := interface_sources.interface_name_of(file))
        ),
        _end_lines_alike((path, chapter.text) for path, chapter in checked_project.chapters.texts.items()),
        {
            path: data.replace(b"\r\n", b"\n") if path.endswith(".svg") else data
            for path, data in checked_project.chapters.read_pictures().items()
        },
        _end_lines_alike(
            item for each in (checked_project, *judged_variants) for item in each.packed_parameters.items()
        ),
    )
    ignores = [ignore for file_ignores in checked_project.loaded_project.ignores.values() for ignore in file_ignores]
    silenced_lines = {(each.span.file, each.span.line) for each in checked_project.silenced_findings}
    # In a packed file nobody knows that other projects need the rest.
    ignores += (
        each
        for each in checked_project.loaded_project.library_ignores
        if (each.span.file, each.span.line) in silenced_lines
    )
    silenced_findings = dict.fromkeys(
        finding for each in (checked_project, *judged_variants) for finding in each.silenced_findings
    )
    packed_project = pack_project(
        checked_project.merged_table,
        checked_project.architecture,
        ignores,
        attachments,
        tuple(silenced_findings),
        [each.architecture for each in judged_variants],
    )
    _add_origin_comments(packed_project, checked_project)
    return packed_project


def _end_lines_alike(texts: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return texts of files as every system has them: where git checks them out for Windows, their lines end in two characters."""
    return {name: text.replace("\r\n", "\n") for name, text in texts}


def _add_origin_comments(packed_project: PackedProject, checked_project: CheckedProject) -> None:
    """Say at the elements of a project that passes made, now or before, what each was made from."""
    transformed, architecture = checked_project.transformed, checked_project.architecture
    if transformed is None and not architecture.made_elements:
        return
    from archgen.passes import origin_comments

    comments = (
        origin_comments.list_origin_comments(transformed.root, transformed.provenance, architecture.made_elements)
        if transformed
        else origin_comments.keep_origin_comments(checked_project.merged_table, architecture.made_elements)
    )
    ignores = packed_project.comments
    for path, comment in comments.items():
        if has_packed_path(packed_project.data, path):
            packed_project.comments[path] = f"{comment}  # {ignores[path]}" if path in ignores else comment
