"""The passes that write out: instances with all that they have, names of what is listed by its type, connections at their source."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compose.expanded_project import Expansion
from archgen.diagnostics import SourceTexts, Span
from archgen.diagnostics.element_origins import TreePath
from archgen.link import mapping_values
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import list_paths
from archgen.passes.selector_rewriting import list_selected, rewrite_selectors
from archgen.passes.tree_rebuilding import rebuild_tree
from archgen.schema.component_sugar import move_targets, name_listed_elements
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, change_at

_TYPE_KEYS = frozenset({"is", "same_as"})
_TYPE_SELECTORS = ("is:", "library:", "deprecated:")
"""How words of selectors begin that ask for the types of components."""


def _resolve_instances(work: PassWork) -> None:
    expansion = work.link().expansion
    if not expansion.instances and not expansion.type_entries:
        return
    sections = {key: entry for key, entry in work.tree.root.entries.items() if key != "component_types"}
    written_groups = mapping_values.get_mapping(work.tree.root, "groups")
    groups = {group.key: _write_group(group, expansion.parts.get(group.key, [])) for group in written_groups}
    if groups:
        sections["groups"] = sections["groups"].with_entries(groups)
    for name in ("views", "policies"):
        if name in sections:
            sections[name] = rewrite_selectors(sections[name], lambda word: _name_instances(work, word))
    if "libraries" in sections:
        libraries = sections["libraries"]
        # Nothing but data types stays in them.
        sections["libraries"] = libraries.with_value(change_at(libraries.value, ("*",), _drop_types))
    rebuild_tree(work.tree, MappingNode(sections, work.tree.root.span))


def _name_instances(work: PassWork, word: str) -> list[str] | None:
    """Return the components that a word about types selects: nothing says any more what they are made from."""
    return list_selected(work.link().architecture, word) if word.startswith(_TYPE_SELECTORS) else None


def _write_group(group: MappingEntry, parts: list[tuple[MappingEntry, Expansion]]) -> MappingEntry:
    parts_by_name = {part.key: (part, expansion) for part, expansion in parts}
    return group.change_keys({"components": lambda written: _write_components(written, parts_by_name)})


def _write_components(written: MappingEntry, parts: dict[str, tuple[MappingEntry, Expansion]]) -> MappingEntry:
    """Return `components` with everything in them written out."""
    return written.with_entries({name: _write_component(part, expansion) for name, (part, expansion) in parts.items()})


def _write_component(part: MappingEntry, expansion: Expansion) -> MappingEntry:
    body = expansion.body
    entries = {key: entry for key, entry in body.entries.items() if key not in _TYPE_KEYS}
    if expansion.parts:
        inner = MappingEntry("components", part.key_span, MappingNode({}, part.key_span))
        entries["components"] = _write_components(inner, expansion.parts)
    if not entries and not isinstance(part.value, MappingNode):
        return part
    return part.with_value(MappingNode(entries, body.span))


def _drop_types(library: YamlNode) -> YamlNode:
    return library.without("component_types") if isinstance(library, MappingNode) else library


RESOLVE_INSTANCES = Pass(
    "resolve_instances",
    "Writes out all that components have of their types; no component type is left.",
    _resolve_instances,
    needs=("no_component_sources",),
    leaves=("no_instances",),
)


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
