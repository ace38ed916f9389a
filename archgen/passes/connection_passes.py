"""The passes that write connections out that follow by themselves: `from` of instances, and `autoconnect`.

The linker knows what follows; here its answer becomes source. It is written where what it follows from is written: in a
component type once for all instances, or, where instances differ, at each of them.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import Span
from archgen.diagnostics.element_origins import TreePath
from archgen.frozen import NamedTuple
from archgen.link import mapping_values
from archgen.link.port_sources import PortKey, PortSource
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.type_probes import link_types
from archgen.passes.written_places import list_holders, path_of_component
from archgen.syntax.yaml_tree import MappingEntry, ScalarNode, SequenceNode

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
