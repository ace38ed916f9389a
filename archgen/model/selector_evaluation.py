"""Evaluate selectors: which components and nodes of an architecture they select.

`model.selector_parser` parses selectors, `model.selector_keys` finds what a key such as `tag:` names.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from functools import cached_property

from archgen.diagnostics import NAMES_HELP, find_closest
from archgen.frozen import dataclass, field, replace
from archgen.grouping import group_pairs
from archgen.model import flow_graph
from archgen.model.architecture import Architecture, Milestone
from archgen.model.graph_search import find_reachable
from archgen.model.latest_result import remember_latest
from archgen.model.path_resolver import ElementRef, PathResolver
from archgen.model.selector_keys import SelectorHit, find_by_key, list_key_values, matches_wildcard
from archgen.model.selector_parser import ALL_STEPS, SelectorAtom, SelectorProblem, SelectorWord, parse_selector

__all__ = ["Selection", "SelectorEvaluator", "SelectorProblem", "evaluate_selector", "parse_selector"]

_ALL_BELOW = ".**"
"""Behind a path: everything below it, to any depth."""
_PATH_KINDS = ("group", "component", "output")
_NAMING_KEYS = ("owner", "host", "requirement", "use_case", "variant", "tag", "package", "library")
"""Keys whose values are names that somebody may write alone."""
_MAX_GUESS_POOL = 100_000
"""No guess is made among more names than these: it would take seconds."""


@dataclass(frozen=True, slots=True)
class Selection:
    """The selected components and nodes by complete id: with a component its nodes, with a node its components."""

    components: frozenset[str] = frozenset()
    nodes: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class MilestoneNeeds:
    """A milestone with the leaves that it needs, by complete ids in the order of the architecture."""

    milestone: Milestone
    components: tuple[str, ...]


@remember_latest
def list_needs(architecture: Architecture) -> tuple[MilestoneNeeds, ...]:
    """Return what the milestones need, by their days; those without one come last."""
    evaluator = SelectorEvaluator(architecture)
    found = []
    for milestone in architecture.milestones.values():
        selection = evaluator.evaluate(milestone.needs)[0] if milestone.needs else Selection()
        implemented = (name for node in selection.nodes for name in architecture.nodes[node].implements)
        needed = selection.components.union(implemented)
        found.append(MilestoneNeeds(milestone, tuple(name for name in architecture.components if name in needed)))
    return tuple(sorted(found, key=lambda each: (each.milestone.date is None, each.milestone.date or "")))


def evaluate_selector(
    text: str, architecture: Architecture, findings: Mapping[str, frozenset[str]] | None = None
) -> tuple[Selection, tuple[SelectorProblem, ...]]:
    """Evaluate one selector. `findings` are the ids of the elements with findings of each rule, for `finding:`."""
    return SelectorEvaluator(architecture, findings or {}).evaluate(text)


@dataclass()
class SelectorEvaluator:
    """Evaluates selectors on one architecture. Its look-ups are made on first use: keep it for several selectors."""

    architecture: Architecture
    findings: Mapping[str, frozenset[str]] = field(default_factory=dict)
    _known: dict[str, tuple[Selection, tuple[SelectorProblem, ...]]] = field(default_factory=dict)

    def evaluate(self, text: str) -> tuple[Selection, tuple[SelectorProblem, ...]]:
        """Evaluate a selector: the union of the words without `-` (everything if there are none), minus those with `-`.

        With an error (not only warnings) nothing is selected.
        """
        if text not in self._known:
            self._known[text] = self._find_selected(text)
        return self._known[text]

    def _find_selected(self, text: str) -> tuple[Selection, tuple[SelectorProblem, ...]]:
        selector = parse_selector(text)
        problems = list(selector.problems)
        wanted_hits = [self._evaluate_word(word, problems) for word in selector.words if not word.is_negative]
        refused_hits = [self._evaluate_word(word, problems) for word in selector.words if word.is_negative]
        if any(problem.severity == "error" for problem in problems):
            return Selection(), tuple(problems)
        if not wanted_hits:
            wanted_hits = [SelectorHit(frozenset(self.architecture.components), frozenset(self.architecture.nodes))]
        # The order of words does not matter: `-` is applied last, to all of them.
        return self._subtract_hits(wanted_hits, refused_hits), tuple(problems)

    def _subtract_hits(self, wanted_hits: Sequence[SelectorHit], refused_hits: Sequence[SelectorHit]) -> Selection:
        """Subtract hits from others. A node goes if it is refused itself, or if the last of its components is."""
        refused_components = frozenset[str]().union(*(hit.components for hit in refused_hits))
        # Nodes that refused words bring only by their components stay as long as another of their components does.
        refused_nodes = frozenset[str]().union(*(hit.nodes for hit in refused_hits if hit.only_nodes))
        components = frozenset[str]().union(*(hit.components for hit in wanted_hits)) - refused_components
        nodes = frozenset[str]().union(*(hit.nodes for hit in wanted_hits)) - refused_nodes
        implements = {node: self.architecture.nodes[node].implements for node in sorted(nodes)}
        orphaned_nodes = {
            node
            for node in nodes
            if not refused_components.isdisjoint(implements[node]) and components.isdisjoint(implements[node])
        }
        return Selection(components, nodes - orphaned_nodes)

    @cached_property
    def resolver(self) -> PathResolver:
        """Resolves paths to elements."""
        architecture = self.architecture
        shells = architecture.shells.values()
        ids_by_kind = {
            "group": architecture.groups,
            "component": {**architecture.components, **architecture.shells},
            "output": {**architecture.outputs, **{port.id: port for each in shells for port in each.outputs.values()}},
            "input": {**architecture.inputs, **{port.id: port for each in shells for port in each.inputs.values()}},
        }
        return PathResolver({**ids_by_kind, "node": architecture.nodes})

    @cached_property
    def component_graph(self) -> flow_graph.FlowGraph:
        """The flow between components."""
        return flow_graph.build_component_graph(self.architecture)

    @cached_property
    def node_graph(self) -> flow_graph.FlowGraph:
        """The flow between nodes."""
        return flow_graph.build_node_graph(self.architecture)

    @cached_property
    def nodes_by_component(self) -> Mapping[str, list[str]]:
        """The ids of the nodes that implement each component."""
        return group_pairs(
            (component, node.id) for node in self.architecture.nodes.values() for component in node.implements
        )

    @cached_property
    def readers_by_output(self) -> Mapping[str, list[str]]:
        """The ids of the components that read each output."""
        readers: dict[str, list[str]] = defaultdict(list)
        for edge in self.architecture.edges:
            readers[edge.output].append(self.architecture.inputs[edge.input].component)
        return readers

    def _evaluate_word(self, word: SelectorWord, problems: list[SelectorProblem]) -> SelectorHit:
        hit = self._evaluate_atom(word.atom, problems)
        if word.range_end:
            return self._find_ways(hit, self._evaluate_atom(word.range_end, problems))
        if word.steps_before or word.steps_after:
            hit = self._add_neighbours(hit, _step_limit(word.steps_before), _step_limit(word.steps_after))
        return self._add_other_level(hit)

    def _add_neighbours(self, hit: SelectorHit, steps_before: int | None, steps_after: int | None) -> SelectorHit:
        """Add what feeds a hit and what it feeds, up to some steps each; None is any number of steps."""
        # Steps are steps between nodes only if the word names nodes and nothing else.
        if hit.only_nodes:
            reached = find_reachable(self.node_graph.predecessors, hit.nodes, steps_before) | find_reachable(
                self.node_graph.successors, hit.nodes, steps_after
            )
            return SelectorHit(frozenset(), frozenset(reached), only_nodes=True)
        full_hit = self._add_other_level(hit)
        upstream = find_reachable(self.component_graph.predecessors, full_hit.components, steps_before)
        return SelectorHit(
            full_hit.components.union(upstream, self._reach_downstream(full_hit, steps_after)),
            full_hit.nodes,
        )

    def _reach_downstream(self, hit: SelectorHit, max_steps: int | None) -> dict[str, int]:
        """Return the components that a hit feeds, with their steps; the first step of outputs is their own readers."""
        if not hit.outputs or max_steps == 0:
            return find_reachable(self.component_graph.successors, hit.components, max_steps)
        starts = (reader for output in hit.outputs for reader in self.readers_by_output.get(output, ()))
        return find_reachable(self.component_graph.successors, starts, None if max_steps is None else max_steps - 1)

    def _find_ways(self, first_hit: SelectorHit, last_hit: SelectorHit) -> SelectorHit:
        """Return all ways from one hit to another: what is both downstream of the first and upstream of the last."""
        if first_hit.only_nodes and last_hit.only_nodes:
            downstream = find_reachable(self.node_graph.successors, first_hit.nodes)
            way_elements = downstream.keys() & find_reachable(self.node_graph.predecessors, last_hit.nodes).keys()
            hit = SelectorHit(frozenset(), frozenset(way_elements), only_nodes=True)
        else:
            first_hit, last_hit = self._add_other_level(first_hit), self._add_other_level(last_hit)
            upstream = find_reachable(self.component_graph.predecessors, last_hit.components).keys()
            way_elements = self._reach_downstream(first_hit, None).keys() & upstream
            # The components of outputs are no part of what the outputs feed, but where the way begins.
            if first_hit.outputs and way_elements:
                way_elements |= first_hit.components
            hit = SelectorHit(frozenset(way_elements), frozenset())
        return self._add_other_level(hit)

    def _add_other_level(self, hit: SelectorHit) -> SelectorHit:
        """Add the nodes of the components, and the components of the nodes."""
        nodes = {node for component in hit.components for node in self.nodes_by_component.get(component, ())}
        crossing_nodes = hit.nodes if hit.includes_components else ()
        implemented_components = (c for node in crossing_nodes for c in self.architecture.nodes[node].implements)
        return SelectorHit(hit.components.union(implemented_components), hit.nodes | nodes, hit.outputs, hit.only_nodes)

    def _evaluate_atom(self, atom: SelectorAtom, problems: list[SelectorProblem]) -> SelectorHit:
        if atom.key is not None:
            hit = (
                self.find_by_variant(atom.value)
                if atom.key == "variant"
                else find_by_key(self.architecture, atom.key, atom.value, self.findings)
            )
            # Only a warning, unlike a path that names nothing: a tag may be selected before anything has it.
            if not hit.components and not hit.nodes:
                message = f"nothing has `{atom.key}:{atom.value}`"
                guess = find_closest(atom.value, list_key_values(self.architecture, atom.key))
                help_line = f"did you mean `{atom.key}:{guess}`?" if guess and guess != atom.value else None
                problems.append(SelectorProblem(message, atom.start, atom.end, "warning", help_line))
            return hit
        if atom.value.endswith(_ALL_BELOW) and "*" not in atom.value.removesuffix(_ALL_BELOW):
            path = atom.value.removesuffix(_ALL_BELOW)
            return self._evaluate_path(replace(atom, value=path, end=atom.end - len(_ALL_BELOW)), problems)
        if "*" in atom.value:
            matched = self._match_pattern(atom.value)
            if not matched:
                problems.append(SelectorProblem(f"nothing fits `{atom.value}`", atom.start, atom.end, "warning"))
            return self._hit_of_elements(matched)
        return self._evaluate_path(atom, problems)

    def find_by_variant(self, pattern: str) -> SelectorHit:
        """Return what is different in some variants: what they take out, drop keys of, or write to."""
        variants = [each for name, each in self.architecture.variants.items() if matches_wildcard(pattern, name)]
        components, nodes = set[str](), set[str]()
        for variant in variants:
            for path in (*variant.drop, *(change.path for change in variant.changes)):
                component_id, node_id = _find_written_element(path)
                components.update(each for each in self.architecture.leaves_of(component_id) if each)
                nodes.add(node_id)
            # A `without` that names variants itself would go in a circle.
            if variant.without and "variant:" not in variant.without:
                selection, _ = self.evaluate(variant.without)
                components |= selection.components
                nodes |= selection.nodes
        return SelectorHit(
            frozenset(components & self.architecture.components.keys()),
            frozenset(nodes & self.architecture.nodes.keys()),
        )

    def _evaluate_path(self, atom: SelectorAtom, problems: list[SelectorProblem]) -> SelectorHit:
        """Resolve a path by the rules of references. If no group, component or output fits, try nodes, then inputs."""
        # Kinds are tried in this order, so that an input or a node never makes the path of a component ambiguous.
        match = self.resolver.resolve_path(atom.value, _PATH_KINDS)
        if not match.count:
            match = self.resolver.resolve_path(atom.value, ("node",))
        if not match.count:
            match = self.resolver.resolve_path(atom.value, ("input",))
        if match.count > 1:
            quoted_ids = [f"`{name.id}`" for name in match.elements]
            last_phrase = f"{match.count - len(quoted_ids)} more" if match.count > len(quoted_ids) else quoted_ids.pop()
            message = f"`{atom.value}` can mean {', '.join(quoted_ids)} or {last_phrase}"
            remedy = f"write more of the path, such as `{match.elements[0].id}`"
            problems.append(SelectorProblem(message, atom.start, atom.end, help=remedy))
        elif not match.count:
            key = next((key for key in _NAMING_KEYS if atom.value in list_key_values(self.architecture, key)), None)
            guess = f"{key}:{atom.value}" if key else self._guess_path(atom.value)
            help_line = f"did you mean `{guess}`?" if guess else NAMES_HELP
            problems.append(SelectorProblem(f"nothing is called `{atom.value}`", atom.start, atom.end, help=help_line))
        return self._hit_of_elements(match.elements if match.count == 1 else ())

    def _guess_path(self, path_text: str) -> str | None:
        """Return the path with as many parts that is most similar, or None."""
        # Only among paths with as many parts: `camera` is no slip for `sensing.camera`, which it would have found.
        dots = path_text.count(".")
        pool = {
            path
            for kind in (*_PATH_KINDS, "node")
            for path in self.resolver.path_endings(kind)
            if path.count(".") == dots
        }
        return find_closest(path_text, pool) if len(pool) <= _MAX_GUESS_POOL else None

    def _match_pattern(self, pattern: str) -> list[ElementRef]:
        """Return the elements whose ids end in a pattern, part by part."""
        pattern_parts = pattern.split(".")
        architecture = self.architecture
        ids_by_kind = {
            "group": architecture.groups,
            "component": {**architecture.components, **architecture.shells},
            "output": architecture.outputs,
            "node": architecture.nodes,
        }
        return [
            ElementRef(kind, path)
            for kind, paths in ids_by_kind.items()
            for path in paths
            if _matches_ending(path.split("."), pattern_parts)
        ]

    def _hit_of_elements(self, elements: Sequence[ElementRef]) -> SelectorHit:
        """Return the components and nodes of some elements; a group stands for all of its components."""
        components = set[str]()
        for element in elements:
            if element.kind == "group":
                components.update(c.id for c in self.architecture.groups[element.id].components.values())
            elif element.kind == "component":
                components.update(self.architecture.leaves_of(element.id))
            elif element.kind in {"output", "input"}:
                ports = self.architecture.leaf_ports_of(element.kind, element.id)
                components.update(port.rpartition(".")[0] for port in ports)
        nodes = frozenset(element.id for element in elements if element.kind == "node")
        output_elements = [element.id for element in elements if element.kind == "output"]
        outputs = tuple(leaf for each in output_elements for leaf in self.architecture.leaf_ports_of("output", each))
        # `outputs` is set only if the word names nothing else, see `SelectorHit.outputs`.
        only_outputs = len(output_elements) == len(elements)
        return SelectorHit(
            frozenset(components), nodes, outputs if only_outputs else (), bool(nodes) and not components
        )


def _step_limit(steps: int) -> int | None:
    return None if steps == ALL_STEPS else steps


def _matches_ending(path_parts: list[str], pattern_parts: list[str]) -> bool:
    return len(path_parts) >= len(pattern_parts) and all(
        map(matches_wildcard, pattern_parts, path_parts[-len(pattern_parts) :])
    )


def _find_written_element(path: str) -> tuple[str, str]:
    """Return the component and the node that a path of keys leads into, by id; empty for none."""
    keys = path.split(".")
    if keys[0] == "nodes" and len(keys) > 1:
        return "", keys[1]
    if keys[0] != "groups":
        return "", ""
    ids, rest = keys[1:2], keys[2:]
    while len(rest) > 1 and rest[0] == "components":
        ids.append(rest[1])
        rest = rest[2:]
    return (".".join(ids), "") if len(ids) > 1 else ("", "")
