"""Selectors in variants: what `without` takes out, and what is left of the selectors that named some of it.

What a variant takes out with the components and nodes that it selects: what then serves nobody goes too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.diagnostics import Diagnostic, Severity
from archgen.frozen import NamedTuple, dataclass
from archgen.link import mapping_values
from archgen.link.element_outline import ElementOutline
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.model.selector_parser import parse_selector, split_selector
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, list_entries

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
