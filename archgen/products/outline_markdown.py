"""A document as GitHub-flavoured Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.emit import file_tree
from archgen.frozen import replace
from archgen.views.picture_shapes import Graph
from archgen.views.shapes import Outline, Section


def render_outline_markdown(outline: Outline, graphs: tuple[Graph, ...] = ()) -> str:
    """Write a document as GitHub-flavoured Markdown, with its pictures as Mermaid."""
    from archgen.emit import backend_manifests, text

    files = (backend_manifests.BackendFile("outline.md.j2", "document.md"),)
    backend = replace(
        backend_manifests.read_shipped_backend("wiki"), files=files, views=("outline", "graphs", "places")
    )
    # Markdown has no page for an element; the template may link only to sections of this document.
    section_anchors = dict.fromkeys((section.anchor for section in _walk_sections(outline.sections)), True)
    written_files, problems = text.render_backend(
        backend, {"outline": outline, "graphs": graphs, "places": section_anchors}
    )
    if written_files is None:
        raise file_tree.OutputError(problems[0].message, problems[0].help)
    return written_files.files["document.md"].decode()


def _walk_sections(sections: tuple[Section, ...]) -> Iterator[Section]:
    """Yield all sections, each before those below it."""
    for section in sections:
        yield section
        yield from _walk_sections(section.sections)
