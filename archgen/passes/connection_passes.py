"""The passes that write out what follows by itself: connections, `from` of instances, instances with all that they have, names of what is
listed by its type.

The linker knows what follows; here its answer becomes source. It is written where what it follows from is written: in a
component type once for all instances, or, where instances differ, at each of them.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compose.expanded_project import Expansion
from archgen.diagnostics import SourceTexts, Span
from archgen.diagnostics.element_origins import TreePath
from archgen.frozen import NamedTuple
from archgen.link import mapping_values
from archgen.link.port_sources import PortKey, PortSource
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import list_paths, rebuild_tree
from archgen.passes.selector_rewriting import list_selected, rewrite_selectors
from archgen.passes.type_probes import link_types
from archgen.passes.written_places import list_holders, path_of_component
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


_SIDES = {"input": "inputs", "output": "outputs"}


class _StatementHolder(NamedTuple):
    """What a statement holds for in a linked project: a group, a composed component or an instance, by complete id."""

    linked: LinkedTree
    id: str
    is_probe: bool


class _FoundSources(NamedTuple):
    """What follows for a port, in the words of the project."""

    references: tuple[str, ...]
    spans: tuple[Span, ...]


def _connect_components(work: PassWork) -> None:
    work.findings += [each for each in work.link().joined_findings if each.rule == "several-sources"]
    _write_connections(work, "from", "")


def _connect_ports(work: PassWork) -> None:
    _write_connections(work, "autoconnect", "ports")


def _connect_types(work: PassWork) -> None:
    _write_connections(work, "autoconnect", "types")


def _write_connections(work: PassWork, key: str, mode: str) -> None:
    """Write what follows from one key of groups and components, and take the key out."""
    tree = work.tree
    places = {
        tree.find_place((*holder.path, key)): holder.path
        for holder in list_holders(tree)
        if _has_statement(holder.entry, key, mode)
    }
    if not places:
        return
    sources_by_place: dict[TreePath, dict[_StatementHolder, dict[TreePath, _FoundSources]]] = {
        path: {} for path in places.values()
    }
    for linked, is_probe in ((work.link(), False), (link_types(work), True)):
        for holder_id, entry in _list_entries(linked):
            statement = mapping_values.get_body(entry).entries.get(key)
            place = places.get(statement.key_span) if statement else None
            if place is not None:
                holder = _StatementHolder(linked, holder_id, is_probe)
                sources_by_place[place][holder] = _find_sources(linked, holder_id, key)
    for place, sources_by_holder in sources_by_place.items():
        # What could follow in several ways stays as it is, and is told.
        if any(_is_ambiguous(holder, key) for holder in sources_by_holder):
            continue
        _write_place(work, place, key, sources_by_holder)
        tree.drop((*place, key))


def _has_statement(entry: MappingEntry, key: str, mode: str) -> bool:
    body = mapping_values.get_body(entry)
    return mapping_values.get_text(body, key) == mode if mode else bool(mapping_values.get_scalars(body, key))


def _list_entries(linked: LinkedTree) -> Iterator[tuple[str, MappingEntry]]:
    """Yield groups, leaves and composed components with what they have of their types, by complete id."""
    yield from linked.outline.groups.items()
    yield from linked.outline.components.items()
    yield from ((shell.id, shell.entry) for shell in linked.outline.shells.values())


def _list_children(linked: LinkedTree, holder_id: str) -> tuple[str, ...]:
    shell = linked.outline.shells.get(holder_id)
    return shell.children if shell else tuple(linked.outline.members.get(holder_id, ()))


def _find_sources(linked: LinkedTree, holder_id: str, key: str) -> dict[TreePath, _FoundSources]:
    """Return what follows from a statement: sources by the path of the port, below what holds the statement."""
    if key == "from":
        inputs = linked.outline.inputs.get(holder_id, ())
        own_ports: dict[TreePath, PortKey] = {("inputs", name): ("input", f"{holder_id}.{name}") for name in inputs}
        return dict(_list_found(linked, own_ports, is_made=False))
    ports: dict[TreePath, PortKey] = {
        ("components", child.rpartition(".")[2], "inputs", name): ("input", f"{child}.{name}")
        for child in _list_children(linked, holder_id)
        for name in linked.outline.inputs.get(child, ())
    }
    if holder_id in linked.outline.shells:
        outputs = linked.outline.outputs.get(holder_id, ())
        ports.update({("outputs", name): ("output", f"{holder_id}.{name}") for name in outputs})
    return dict(_list_found(linked, ports, is_made=True))


def _list_found(
    linked: LinkedTree, ports: dict[TreePath, PortKey], *, is_made: bool
) -> Iterator[tuple[TreePath, _FoundSources]]:
    for path, port in ports.items():
        sources = linked.joined_sources.list_sources(port)
        if is_made:
            sources = tuple(each for each in sources if each.is_made)
        elif _is_written(linked, port):
            sources = ()
        if sources:
            references = tuple(dict.fromkeys(_write_reference(linked, port, each) for each in sources))
            yield path, _FoundSources(references, tuple(each.at for each in sources))


def _is_written(linked: LinkedTree, port: PortKey) -> bool:
    entry = linked.joined_sources.find_entry(port)
    return entry is not None and mapping_values.get_body(entry).get("from") is not None


def _write_reference(linked: LinkedTree, port: PortKey, source: PortSource) -> str:
    """Return how the reader of a port names one of its sources."""
    component_id, _, name = source.target.id.rpartition(".")
    if source.target.kind == "input":
        return f"self.{name}"
    reader_id = port[1].rpartition(".")[0]
    around = reader_id if port[0] == "output" else reader_id.rpartition(".")[0]
    short = f"{component_id.rpartition('.')[2]}.{name}"
    if component_id.rpartition(".")[0] != around:
        return source.target.id
    # In a group two words may be a component of another group.
    is_taken = around not in linked.outline.shells and short in linked.resolver.spans["component"]
    return source.target.id if is_taken else short


def _is_ambiguous(holder: _StatementHolder, key: str) -> bool:
    if key == "from":
        return False
    linked = holder.linked
    sources = linked.joined_sources
    own = {("output", f"{holder.id}.{name}") for name in linked.outline.outputs.get(holder.id, ())}
    inner = {
        ("input", f"{child}.{name}")
        for child in _list_children(linked, holder.id)
        for name in linked.outline.inputs.get(child, ())
    }
    return not sources.ambiguous_ports.isdisjoint(own | inner)


def _write_place(
    work: PassWork,
    place: TreePath,
    key: str,
    sources_by_holder: dict[_StatementHolder, dict[TreePath, _FoundSources]],
) -> None:
    for path in dict.fromkeys(path for sources_by_path in sources_by_holder.values() for path in sources_by_path):
        answers = {
            sources_by_path[path].references if path in sources_by_path else ()
            for sources_by_path in sources_by_holder.values()
        }
        if len(answers) == 1:
            first_sources = next(sources_by_path[path] for sources_by_path in sources_by_holder.values())
            _write_sources(work, (*place, *path), first_sources, (*place, key))
            continue
        for holder, sources_by_path in sources_by_holder.items():
            if path in sources_by_path and not holder.is_probe:
                _write_sources(work, (*path_of_component(holder.id), *path), sources_by_path[path], (*place, key))


def _write_sources(work: PassWork, path: TreePath, sources: _FoundSources, statement: TreePath) -> None:
    items = [
        ScalarNode(reference, reference, sources.spans[min(number, len(sources.spans) - 1)])
        for number, reference in enumerate(sources.references)
    ]
    work.tree.set((*path, "from"), SequenceNode(list(items), items[0].span), statement)


CONNECT_COMPONENTS = Pass(
    "connect_components",
    "Writes what an instance takes `from` other components at each of its inputs of equal type.",
    _connect_components,
    needs=("readers_name_sources",),
    leaves=("no_component_sources",),
)
CONNECT_PORTS = Pass(
    "connect_ports",
    "Writes what `autoconnect: ports` joins, by name and type, at the ports that read it.",
    _connect_ports,
    needs=("no_component_sources",),
    leaves=("no_autoconnect_ports",),
)
CONNECT_TYPES = Pass(
    "connect_types",
    "Writes what `autoconnect: types` joins, by type, at the ports that read it.",
    _connect_types,
    needs=("no_component_sources",),
    leaves=("no_autoconnect_types",),
)
