"""The passes that write short forms out: names of what is listed by its type, and connections that stand at their source.

A file is rid of its short forms when it is read. So these two change nothing but what another pass wrote in a short form;
they say of every name and connection that nobody wrote where it follows from.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.element_origins import TreePath
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import list_paths
from archgen.schema.component_sugar import move_targets, name_listed_elements
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode

_NAMING_KEYS = {"components": "is", "inputs": "type", "outputs": "type"}
"""What elements of these mappings are listed by: the key whose value gives them their name."""
_HOLDERS = ("component_types", "groups")


def _complete_names(work: PassWork) -> None:
    work.findings += name_listed_elements(work.tree.root)
    work.tree.edit_count += 1
    for path in _list_elements(work, _NAMING_KEYS):
        naming_value = work.tree.get((*path, _NAMING_KEYS[str(path[-2])]))
        if naming_value is not None and naming_value.span == work.tree.find_place(path):
            work.tree.mark(path)


def _normalise_connections(work: PassWork) -> None:
    work.findings += move_targets(work.tree.root)
    work.tree.edit_count += 1
    sources = work.loaded_project.sources
    for path in _list_elements(work, ("inputs",)):
        written = work.tree.get((*path, "from"))
        for number, item in enumerate(written.items if isinstance(written, SequenceNode) else ()):
            if isinstance(item, ScalarNode) and _is_written_otherwise(sources, item.span, item.text):
                work.tree.mark((*path, "from", number))


def _list_elements(work: PassWork, sections: dict[str, str] | tuple[str, ...]) -> Iterator[TreePath]:
    """Yield the paths of what stands directly in these mappings of components, groups and component types."""
    for holder in _HOLDERS:
        section = work.tree.get((holder,))
        for path, node in list_paths(section, (holder,)) if isinstance(section, MappingNode) else ():
            if isinstance(node, MappingNode) and path[-1] in sections and len(path) > 2:  # noqa: PLR2004 - an id is before it
                yield from ((*path, key) for key in tuple(node.entries))


def _is_written_otherwise(sources: SourceTexts, span: Span, text: str) -> bool:
    """Whether something else is written where a scalar has its place: the other end of a connection."""
    line = sources.line_of(span.file, span.line)
    return line is not None and span.line == span.end_line and text not in line[span.column - 1 : span.end_column - 1]


COMPLETE_NAMES = Pass(
    "complete_names",
    "Gives components and ports that are listed by their type the name that follows from it.",
    _complete_names,
    leaves=("named",),
    keeps_variants=True,
)
NORMALISE_CONNECTIONS = Pass(
    "normalise_connections",
    "Writes connections that stand at their source (`to`) at the input that reads them.",
    _normalise_connections,
    needs=("named",),
    leaves=("readers_name_sources",),
    keeps_variants=True,
)
