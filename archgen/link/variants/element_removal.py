"""Take components and nodes out of a merged project, with all that then serves nobody, and the references to them.

What a component type brings along cannot be taken out of an instance by itself: such an instance is written out.

Selectors in variants: what `without` takes out, and what is left of the selectors that named some of it.

What a variant takes out with the components and nodes that it selects: what then serves nobody goes too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from archgen.compose import ExpandedProject
from archgen.diagnostics import Diagnostic, Severity
from archgen.frozen import NamedTuple, dataclass
from archgen.link import mapping_values
from archgen.link.element_outline import ElementOutline, build_outline
from archgen.link.link_memory import LinkMemory
from archgen.link.project_linking import make_resolver
from archgen.link.reference_resolution import ReferenceResolver, find_inner_component
from archgen.link.source_references import SOURCE_KINDS, SourceReferences
from archgen.model.architecture import Architecture
from archgen.model.path_resolver import ElementRef
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.model.selector_parser import parse_selector, split_selector
from archgen.syntax.yaml_tree import EntryChange, MappingEntry, MappingNode, ScalarNode, SequenceNode, list_entries

_SELECTOR_SECTIONS = ("views", "milestones", "policies")
_SELECTOR_KEYS = frozenset({"show", "needs", "from", "to", "of", "inputs_from", "outputs_to"})


class SelectedElements(NamedTuple):
    """What a selector of a variant selects: leaves and nodes by complete ids; and what is wrong with it."""

    components: frozenset[str]
    nodes: frozenset[str]
    diagnostics: tuple[Diagnostic, ...] = ()


def select_left_out(selector: ScalarNode, evaluator: SelectorEvaluator, variant_id: str) -> SelectedElements:
    """Return what a variant is without, and what is wrong with its selector."""
    selection, problems = evaluator.evaluate(selector.text)
    errors = [problem for problem in problems if problem.severity == "error"]
    if errors:
        return SelectedElements(
            frozenset(),
            frozenset(),
            tuple(
                Diagnostic(
                    "wrong-selector",
                    problem.message,
                    problem.locate(selector.text, selector.span),
                    severity=Severity.ERROR,
                    help=problem.help,
                    element=variant_id,
                )
                for problem in errors
            ),
        )
    idle_words = [
        Diagnostic(
            "empty-variant-selector",
            f"`without` takes nothing out: {problem.message}",
            problem.locate(selector.text, selector.span),
            help=problem.help or "it selects components and nodes of the project that the variant is built on",
            element=variant_id,
        )
        for problem in problems
    ]
    if not selection.components and not selection.nodes and not idle_words:
        idle_words = [
            Diagnostic("empty-variant-selector", "`without` takes nothing out", selector.span, element=variant_id)
        ]
    return SelectedElements(selection.components, selection.nodes, tuple(idle_words))


def prune_selectors(root: MappingNode, removed: RemovedElements, evaluator: SelectorEvaluator) -> MappingNode:
    """Return a merged project whose views, milestones and policies name nothing that is gone; those that named nothing else go too."""

    def prune(section: MappingEntry) -> MappingEntry:
        return section.change_each(lambda holder: _prune_holder(holder, removed, evaluator))

    return root.change_keys(dict.fromkeys(_SELECTOR_SECTIONS, prune))


def _prune_holder(entry: MappingEntry, removed: RemovedElements, evaluator: SelectorEvaluator) -> MappingEntry | None:
    """Return an element with selectors, to any depth, that names nothing that is gone; None where a selector is empty then."""

    def prune(each: MappingEntry) -> MappingEntry | None:
        if isinstance(each.value, MappingNode):
            return _prune_holder(each, removed, evaluator)
        if each.key not in _SELECTOR_KEYS or not isinstance(each.value, ScalarNode):
            return each
        text = _prune_text(each.value.text, removed, evaluator)
        if text == each.value.text:
            return each
        return each.with_value(ScalarNode(text, text, each.value.span, is_plain=False)) if text is not None else None

    kept = entry.change_each(prune)
    return kept if len(list_entries(kept.value)) == len(list_entries(entry.value)) else None


def _prune_text(text: str, removed: RemovedElements, evaluator: SelectorEvaluator) -> str | None:
    """Return a selector without the words that select only what is gone; None where no word is left of some."""
    words = list(split_selector(text))
    gone_words = {word for word in words if _means_removed(word, removed, evaluator)}
    if not gone_words:
        return text
    kept = [word for word in words if word not in gone_words]
    had_wanted = any(not word.startswith("-") for word in words)
    has_wanted = any(not word.startswith("-") for word in kept)
    if had_wanted and not has_wanted:
        return None
    return " ".join(kept) or "*"  # nothing is taken away any more


def _means_removed(word: str, removed: RemovedElements, evaluator: SelectorEvaluator) -> bool:
    """Whether what a word names is gone: one end of a range, or that whose neighbours it wants, is enough."""
    parsed_words = parse_selector(word).words
    atoms = [atom for each in parsed_words for atom in (each.atom, each.range_end) if atom is not None]
    return any(_selects_removed(word[atom.start : atom.end], removed, evaluator) for atom in atoms)


def _selects_removed(text: str, removed: RemovedElements, evaluator: SelectorEvaluator) -> bool:
    selection, problems = evaluator.evaluate(text)
    if any(problem.severity == "error" for problem in problems):
        return False  # told where the selector is judged
    if selection.components:
        return removed.components.issuperset(selection.components)
    return bool(selection.nodes) and removed.nodes.issuperset(selection.nodes)


@dataclass(frozen=True, slots=True)
class RemovedElements:
    """What is not there in a variant: components (composed ones too), nodes and groups by complete ids."""

    components: frozenset[str]
    nodes: frozenset[str]
    groups: frozenset[str]
    words: frozenset[str]
    """Every part of a path that may lead to one of them or to its ports: a reference without any means none of them."""

    def may_be_named(self, path: str) -> bool:
        """Whether a reference may name something that is not there."""
        return not self.words.isdisjoint(path.split("."))


def find_removed(outline: ElementOutline, leaves: frozenset[str], nodes: frozenset[str]) -> RemovedElements:
    """Return what goes with some leaves and nodes: composed components and groups of which nothing is left."""
    components = {leaf for leaf in leaves if leaf in outline.components}
    for shell in reversed(list(outline.shells.values())):  # inner ones first
        if shell.children and components.issuperset(shell.children):
            components.add(shell.id)
    groups = {group_id for group_id, members in outline.members.items() if members and components.issuperset(members)}
    words = {word for component_id in components for word in component_id.split(".")[1:]}
    words.update(name for component_id in sorted(components) for name in outline.outputs[component_id])
    return RemovedElements(frozenset(components), nodes, frozenset(groups), frozenset(words | groups))


def find_idle_places(
    root: MappingNode, kept_nodes: MappingNode, outline: ElementOutline, removed_components: frozenset[str]
) -> tuple[frozenset[str], frozenset[str]]:
    """Return the containers and the hosts in which something ran, and in which nothing runs any more."""
    written_nodes = mapping_values.get_mapping(root, "nodes")
    entries = {**outline.components, **{shell.id: shell.entry for shell in outline.shells.values()}}
    kept_entries = [entry for component_id, entry in entries.items() if component_id not in removed_components]
    containers = mapping_values.get_mapping(root, "containers")
    was_used = set(_list_places("container", written_nodes, entries.values()))
    is_used = set(_list_places("container", kept_nodes, kept_entries))
    idle_containers = frozenset(was_used - is_used) & containers.entries.keys()
    kept_containers = [entry for entry in containers if entry.key not in idle_containers]
    hosts_before = {*_list_places("host", written_nodes, entries.values()), *_list_hosts(containers)}
    hosts_after = {*_list_places("host", kept_nodes, kept_entries), *_list_hosts(kept_containers)}
    known_hosts = mapping_values.get_mapping(root, "hosts").entries.keys()
    return idle_containers, frozenset(hosts_before - hosts_after) & known_hosts


def _list_places(key: str, nodes: MappingNode, components: Iterable[MappingEntry]) -> Iterator[str]:
    """Yield the hosts or containers that nodes name, and the nodes of components."""
    bodies = [mapping_values.get_body(entry) for entry in nodes]
    bodies += [mapping_values.get_mapping(mapping_values.get_body(entry), "node") for entry in components]
    return (text for body in bodies if (text := mapping_values.get_text(body, key)) is not None)


def _list_hosts(containers: Iterable[MappingEntry]) -> Iterator[str]:
    hosts = (mapping_values.get_text(mapping_values.get_body(entry), "host") for entry in containers)
    return (host for host in hosts if host is not None)


_HOLDING_KEYS = frozenset({"from", "node", "components"})
_TYPE_KEYS = frozenset({"is", "same_as"})
_USE_KEYS = ("publishes", "subscribes", "serves", "calls")
_START_REFERENCES = ("after", "by")
_LEAST_ENDS = 2
"""A link between fewer ends joins nothing."""


class ElementRemover:
    """Takes elements out of one merged project; `removed` says afterwards which."""

    def __init__(
        self,
        expansion: ExpandedProject,
        leaves: frozenset[str],
        nodes: frozenset[str],
        memory: LinkMemory | None = None,
        architecture: Architecture | None = None,
    ) -> None:
        """Take the project with all types written out, and the leaves and nodes that go by complete ids.

        `architecture` is its architecture, where that is known.
        """
        self._outline: ElementOutline = build_outline(expansion, memory)
        self._expansion = expansion
        self.removed: RemovedElements = find_removed(self._outline, leaves, nodes)
        self._resolver: ReferenceResolver = make_resolver(expansion.root, self._outline, [], memory=memory)
        self._sources = SourceReferences(self._outline, self._resolver) if self._outline.expansion else None
        self._changed_shells = self._list_changed_shells()
        self._untouched = self._list_untouched(architecture) if architecture and expansion.is_plain else frozenset()
        self._gone_nodes: frozenset[str] = frozenset()

    def _list_untouched(self, architecture: Architecture) -> frozenset[str]:
        """Return the components that read nothing of what goes."""
        if self._outline.undeclared_inputs:  # what they read is in no architecture
            return frozenset()
        touched = {
            each.input.rpartition(".")[0]
            for each in architecture.connections
            if self._is_removed(ElementRef(each.kind, each.target))
        }
        return frozenset(self._outline.components.keys() - touched)

    def _list_changed_shells(self) -> frozenset[str]:
        """Return the composed components that stay, and in which something goes."""
        changed: set[str] = set()
        for component_id in self.removed.components:
            parent = self._expansion.parents.get(component_id)
            while parent is not None and parent not in changed:
                changed.add(parent)
                parent = self._expansion.parents.get(parent)
        return frozenset(changed)

    def remove_from(self, root: MappingNode) -> MappingNode:
        """Return the merged project, as it was before types were written out, without what goes."""
        # First: what components say of the start-up names nodes, too.
        nodes = self._prune_nodes(mapping_values.get_mapping(root, "nodes"))
        containers, hosts = find_idle_places(root, nodes, self._outline, self.removed.components)
        changes: dict[str, EntryChange] = {
            "groups": self._prune_group,
            "nodes": lambda node: nodes.entries.get(node.key),
            "containers": lambda container: None if container.key in containers else container,
            "hosts": lambda host: None if host.key in hosts else host,
            "resources": lambda each: (
                None if mapping_values.get_text(mapping_values.get_body(each), "host") in hosts else each
            ),
            "links": lambda link: self._prune_link(link, hosts),
        }
        return root.change_keys(dict.fromkeys(changes, lambda section: section.change_each(changes[section.key])))

    def _prune_group(self, group: MappingEntry) -> MappingEntry | None:
        if group.key in self.removed.groups:
            return None
        return group.change_keys({"components": lambda parts: self._prune_parts(parts, group.key)})

    def _prune_parts(self, parts: MappingEntry, holder_id: str) -> MappingEntry:
        return parts.change_each(lambda part: self._prune_component(part, f"{holder_id}.{part.key}"))

    def _prune_component(self, part: MappingEntry, component_id: str) -> MappingEntry | None:
        if component_id in self.removed.components:
            return None
        body = mapping_values.get_body(part)
        if component_id in self._untouched and _HOLDING_KEYS.isdisjoint(body.entries):
            return part
        if component_id in self._changed_shells and not _TYPE_KEYS.isdisjoint(body.entries):
            body = self._write_out(component_id, body)

        def prune_sources(entry: MappingEntry) -> MappingEntry | None:
            return self._prune_sources(entry, component_id, self._find_source)

        def prune_given(entry: MappingEntry) -> MappingEntry | None:
            return self._prune_sources(entry, component_id, self._find_given)

        changes: dict[str, EntryChange] = {
            "inputs": lambda ports: ports.change_each(lambda port: port.change_keys({"from": prune_sources})),
            "outputs": lambda ports: ports.change_each(lambda port: port.change_keys({"from": prune_given})),
            "from": prune_sources,
            "node": lambda node: self._prune_start(node, component_id),
        }
        if _TYPE_KEYS.isdisjoint(body.entries):
            changes["components"] = lambda parts: self._prune_parts(parts, component_id)
        return (part if body is part.value else part.with_value(body)).change_keys(changes)

    def _write_out(self, component_id: str, body: MappingNode) -> MappingNode:
        """Return an instance as if all that it has of its type had been written at it; what is inside stays as written."""
        shell = self._expansion.shells[component_id]
        full_body = mapping_values.get_body(shell.entry)
        entries = {entry.key: entry for entry in full_body if entry.key not in _TYPE_KEYS}
        entries["components"] = MappingEntry(
            "components", shell.entry.key_span, MappingNode(dict(shell.parts), full_body.span)
        )
        return body.with_entries(entries)

    def _prune_sources(
        self, entry: MappingEntry, component_id: str, find_target: Callable[[ScalarNode, str], ElementRef | None]
    ) -> MappingEntry | None:
        """Take references to what goes out of `from`; where none is left, nothing is written there."""
        return entry.keep_items(
            lambda item: (
                not isinstance(item, ScalarNode)
                or not self.removed.may_be_named(item.text)
                or not self._is_removed(find_target(item, component_id))
            )
        )

    def _find_source(self, scalar: ScalarNode, component_id: str) -> ElementRef | None:
        if self._sources is not None:
            return self._sources.resolve_source(scalar, component_id)
        return self._resolver.resolve_reference(scalar, SOURCE_KINDS, component_id, component_id)

    def _find_given(self, scalar: ScalarNode, component_id: str) -> ElementRef | None:
        known = self._sources is not None and component_id in self._outline.shells
        return self._sources.resolve_given(scalar, component_id) if self._sources and known else None

    def _is_removed(self, target: ElementRef | None) -> bool:
        if target is None:
            return False
        if target.kind == "group":
            return target.id in self.removed.groups
        if target.kind == "node":
            return target.id in self.removed.nodes
        component_id = target.id if target.kind == "component" else target.id.rpartition(".")[0]
        return component_id in self.removed.components

    def _prune_nodes(self, nodes: MappingNode) -> MappingNode:
        kept: dict[str, MappingEntry] = {}
        for node in nodes:
            body = mapping_values.get_body(node)
            scalars = mapping_values.get_scalars(body, "implements")
            targets = {
                scalar.text: self._resolver.resolve_reference(scalar, ("component",), node.key)
                for scalar in scalars
                if self.removed.may_be_named(scalar.text)
            }
            gone = [scalar for scalar in scalars if self._is_removed(targets.get(scalar.text))]
            if len(gone) < len(scalars) or (not scalars and node.key not in self.removed.nodes):
                gone_ids = [target.id for scalar in gone if (target := targets[scalar.text])]
                kept[node.key] = self._prune_node(node, body, gone, gone_ids) if gone else node
        self._gone_nodes = frozenset(nodes.entries.keys() - kept.keys())
        pruned = {key: self._prune_start(entry, None) for key, entry in kept.items()}
        return nodes.with_entries(pruned)

    def _prune_node(
        self, node: MappingEntry, body: MappingNode, gone: list[ScalarNode], gone_ids: list[str]
    ) -> MappingEntry:
        """Return a node that implements less than before: without topics and services of what is gone."""
        items = [each for each in mapping_values.get_scalars(body, "implements") if each not in gone]
        kept_targets = (self._resolver.resolve_reference(each, ("component",), node.key) for each in items)
        kept_ports = {name for target in kept_targets if target for name in self._list_ports(target.id)}
        gone_ports = {name for component_id in gone_ids for name in self._list_ports(component_id)} - kept_ports
        gone_names = {component_id.rpartition(".")[2] for component_id in gone_ids}

        def prune_use(use: MappingEntry) -> MappingEntry | None:
            is_gone = use.key in gone_ports or ("." in use.key and use.key.split(".")[-2] in gone_names)
            return None if is_gone else use

        changes: dict[str, EntryChange] = dict.fromkeys(_USE_KEYS, lambda uses: uses.change_each(prune_use))
        changes["implements"] = lambda entry: entry.with_value(SequenceNode([*items], entry.value.span))
        return node.change_keys(changes)

    def _list_ports(self, component_id: str) -> Iterator[str]:
        yield from self._outline.inputs.get(component_id, ())
        yield from self._outline.outputs.get(component_id, ())

    def _prune_start(self, holder: MappingEntry, component_id: str | None) -> MappingEntry:
        """Return a node, of a component or by itself, that waits for nothing, and is activated by nothing, that is gone."""

        def prune_targets(entry: MappingEntry) -> MappingEntry | None:
            return entry.keep_items(
                lambda item: not (isinstance(item, ScalarNode) and self._is_gone_target(item.text, component_id))
            )

        def prune_start(start: MappingEntry) -> MappingEntry | None:
            kept = start.change_keys(dict.fromkeys(_START_REFERENCES, prune_targets))
            return kept if kept is start or list_entries(kept.value) else None

        return holder.change_keys({"start": prune_start})

    def _is_gone_target(self, text: str, component_id: str | None) -> bool:
        inner_id = find_inner_component(text, self._resolver, component_id) if component_id else None
        if inner_id is not None or text in self._gone_nodes:
            return inner_id is None or inner_id in self.removed.components
        return self.removed.may_be_named(text) and self._is_removed(
            self._resolver.names.resolve_path(text, ("node", "component")).unique_element
        )

    def _prune_link(self, link: MappingEntry, gone_hosts: frozenset[str]) -> MappingEntry | None:
        hosts = self._resolver.plain_spans["host"]
        ends = mapping_values.get_scalars(mapping_values.get_body(link), "connects")
        staying = [
            end
            for end in ends
            if end.text not in gone_hosts
            and not (
                end.text not in hosts
                and self.removed.may_be_named(end.text)
                and self._is_removed(self._resolver.names.resolve_path(end.text, ("component",)).unique_element)
            )
        ]
        if len(staying) == len(ends):
            return link
        if len(staying) < _LEAST_ENDS:
            return None
        return link.change_keys(
            {"connects": lambda entry: entry.with_value(SequenceNode([*staying], entry.value.span))}
        )
