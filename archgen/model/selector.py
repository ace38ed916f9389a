"""Evaluate selectors: which components and nodes of an architecture they select.

`model.selector_parser` parses selectors, `model.selector_keys` finds what a key such as `tag:` names.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from functools import cached_property

from archgen.frozen import dataclass
from archgen.model import graph
from archgen.model.architecture import Architecture
from archgen.model.names import Named, Names
from archgen.model.selector_keys import Hit, by_key, wild
from archgen.model.selector_words import ALL, Atom, Problem, Word, parse
from archgen.suggest import closest

__all__ = ["Problem", "Selecting", "Selection", "parse", "select"]

_PATHS = ("group", "component", "output")
_MOST_GUESSED = 100_000
"""No guess is made among more names than these: it would take seconds."""


@dataclass(frozen=True, slots=True)
class Selection:
    """The selected components and nodes by complete id: with a component its nodes, with a node its components.

    `named_elements` are the elements that paths name, groups and outputs included, in the order of the words.
    """

    components: frozenset[str] = frozenset()
    nodes: frozenset[str] = frozenset()
    named: tuple[Named, ...] = ()


def select(
    text: str, architecture: Architecture, findings: Mapping[str, frozenset[str]] | None = None
) -> tuple[Selection, tuple[Problem, ...]]:
    """Evaluate one selector. `findings` are the ids of the elements with findings of each rule, for `finding:`."""
    return Selecting(architecture, findings or {}).select(text)


@dataclass()
class Selecting:
    """Evaluates selectors on one architecture. Its look-ups are made on first use: keep it for several selectors."""

    architecture: Architecture
    findings: Mapping[str, frozenset[str]] = field(default_factory=dict)

    def select(self, text: str) -> tuple[Selection, tuple[Problem, ...]]:
        """Evaluate a selector: the union of the words without `-` (everything if there are none), minus those with `-`.

        With an error (not only warnings) nothing is selected.
        """
        read = parse(text)
        problems = list(read.problems)
        wanted = [self._word(word, problems) for word in read.words if not word.negative]
        refused = [self._word(word, problems) for word in read.words if word.negative]
        if any(problem.severity == "error" for problem in problems):
            return Selection(), tuple(problems)
        if not wanted:
            wanted = [Hit(frozenset(self.architecture.components), frozenset(self.architecture.nodes))]
        # The order of words does not matter: `-` is applied last, to all of them.
        return self._without(wanted, refused), tuple(problems)

    def _without(self, wanted: Sequence[Hit], refused: Sequence[Hit]) -> Selection:
        """Subtract hits from others. A node goes if it is refused itself, or if the last of its components is."""
        gone = frozenset[str]().union(*(hit.components for hit in refused))
        # Nodes that refused words bring only by their components stay as long as another of their components does.
        gone_nodes = frozenset[str]().union(*(hit.nodes for hit in refused if hit.of_nodes))
        components = frozenset[str]().union(*(hit.components for hit in wanted)) - gone
        nodes = frozenset[str]().union(*(hit.nodes for hit in wanted)) - gone_nodes
        implements = {node: self.architecture.nodes[node].implements for node in nodes}
        lost = {
            node for node in nodes if not gone.isdisjoint(implements[node]) and components.isdisjoint(implements[node])
        }
        named = dict.fromkeys(name for hit in wanted for name in hit.named)
        return Selection(components, nodes - lost, tuple(named))

    @cached_property
    def names(self) -> Names:
        """Resolves paths to elements."""
        found = self.architecture
        kinds = {"group": found.groups, "component": found.components, "output": found.outputs, "input": found.inputs}
        return Names({**kinds, "node": found.nodes})

    @cached_property
    def components(self) -> graph.Graph:
        """The flow between components."""
        return graph.components(self.architecture)

    @cached_property
    def nodes(self) -> graph.Graph:
        """The flow between nodes."""
        return graph.nodes(self.architecture)

    @cached_property
    def nodes_of(self) -> Mapping[str, list[str]]:
        """The ids of the nodes that implement each component."""
        found: dict[str, list[str]] = defaultdict(list)
        for node in self.architecture.nodes.values():
            for component in node.implements:
                found[component].append(node.id)
        return found

    @cached_property
    def readers(self) -> Mapping[str, list[str]]:
        """The ids of the components that read each output."""
        found: dict[str, list[str]] = defaultdict(list)
        for edge in self.architecture.edges:
            found[edge.output].append(self.architecture.inputs[edge.input].component)
        return found

    def _word(self, word: Word, problems: list[Problem]) -> Hit:
        hit = self._atom(word.atom, problems)
        if word.to:
            return self._between(hit, self._atom(word.to, problems))
        if word.before or word.after:
            hit = self._spread(hit, _limit(word.before), _limit(word.after))
        return self._both_levels(hit)

    def _spread(self, hit: Hit, before: int | None, after: int | None) -> Hit:
        """Add what feeds a hit and what it feeds, up to some steps each; None is any number of steps."""
        # Steps are steps between nodes only if the word names nodes and nothing else.
        if hit.of_nodes:
            reached = graph.reach(self.nodes.before, hit.nodes, before) | graph.reach(
                self.nodes.after, hit.nodes, after
            )
            return Hit(frozenset(), frozenset(reached), hit.named, of_nodes=True)
        whole = self._both_levels(hit)
        behind = graph.reach(self.components.before, whole.components, before)
        return Hit(whole.components.union(behind, self._ahead(whole, after)), whole.nodes, hit.named)

    def _ahead(self, hit: Hit, steps: int | None) -> dict[str, int]:
        """Return the components that a hit feeds, with their steps; the first step of outputs is their own readers."""
        if not hit.outputs or steps == 0:
            return graph.reach(self.components.after, hit.components, steps)
        starts = (reader for output in hit.outputs for reader in self.readers.get(output, ()))
        return graph.reach(self.components.after, starts, None if steps is None else steps - 1)

    def _between(self, first: Hit, last: Hit) -> Hit:
        """Return all ways from one hit to another: what is both downstream of the first and upstream of the last."""
        named = (*first.named, *last.named)
        if first.of_nodes and last.of_nodes:
            ahead = graph.reach(self.nodes.after, first.nodes)
            way = ahead.keys() & graph.reach(self.nodes.before, last.nodes).keys()
            hit = Hit(frozenset(), frozenset(way), named, of_nodes=True)
        else:
            first, last = self._both_levels(first), self._both_levels(last)
            behind = graph.reach(self.components.before, last.components).keys()
            way = self._ahead(first, None).keys() & behind
            # The components of outputs are no part of what the outputs feed, but where the way begins.
            if first.outputs and way:
                way |= first.components
            hit = Hit(frozenset(way), frozenset(), named)
        return self._both_levels(hit)

    def _both_levels(self, hit: Hit) -> Hit:
        """Add the nodes of the components, and the components of the nodes."""
        nodes = {node for component in hit.components for node in self.nodes_of.get(component, ())}
        crossing = hit.nodes if hit.crosses else ()
        implemented = (c for node in crossing for c in self.architecture.nodes[node].implements)
        return Hit(hit.components.union(implemented), hit.nodes | nodes, hit.named, hit.outputs, hit.of_nodes)

    def _atom(self, atom: Atom, problems: list[Problem]) -> Hit:
        if atom.key is not None:
            hit = by_key(self.architecture, atom.key, atom.value, self.findings)
            # Only a warning, unlike a path that names nothing: a tag may be selected before anything has it.
            if not hit.components and not hit.nodes:
                message = f"nothing has `{atom.key}:{atom.value}`"
                problems.append(Problem(message, atom.start, atom.end, "warning"))
            return hit
        if "*" in atom.value:
            hit = self._hit(self._matching(atom.value))
            if not hit.named:
                problems.append(Problem(f"nothing fits `{atom.value}`", atom.start, atom.end, "warning"))
            return hit
        return self._path(atom, problems)

    def _path(self, atom: Atom, problems: list[Problem]) -> Hit:
        """Resolve a path by the rules of references. If no group, component or output fits, try nodes, then inputs."""
        # Kinds are tried in this order, so that an input or a node never makes the path of a component ambiguous.
        found = self.names.find(atom.value, _PATHS)
        if not found.count:
            found = self.names.find(atom.value, ("node",))
        if not found.count:
            found = self.names.find(atom.value, ("input",))
        if found.count > 1:
            listed = [f"`{name.id}`" for name in found.elements]
            last = f"{found.count - len(listed)} more" if found.count > len(listed) else listed.pop()
            message = f"`{atom.value}` can mean {', '.join(listed)} or {last}"
            cure = f"write more of the path, such as `{found.elements[0].id}`"
            problems.append(Problem(message, atom.start, atom.end, help=cure))
        elif not found.count:
            guess = self._guess(atom.value)
            help_line = f"did you mean `{guess}`?" if guess else None
            problems.append(Problem(f"nothing is called `{atom.value}`", atom.start, atom.end, help=help_line))
        return self._hit(found.elements if found.count == 1 else ())

    def _guess(self, words: str) -> str | None:
        """Return the path with as many parts that is most similar, or None."""
        # Only among paths with as many parts: `camera` is no slip for `sensing.camera`, which it would have found.
        length = words.count(".")
        pool = {path for kind in (*_PATHS, "node") for path in self.names.ends(kind) if path.count(".") == length}
        return closest(words, pool) if len(pool) <= _MOST_GUESSED else None

    def _matching(self, pattern: str) -> list[Named]:
        """Return the elements whose ids end in a pattern, part by part."""
        parts = pattern.split(".")
        found = self.architecture
        kinds = {"group": found.groups, "component": found.components, "output": found.outputs, "node": found.nodes}
        return [
            Named(kind, path) for kind, paths in kinds.items() for path in paths if _ends_like(path.split("."), parts)
        ]

    def _hit(self, named: Iterable[Named]) -> Hit:
        """Return the components and nodes of some elements; a group stands for all of its components."""
        elements = tuple(named)
        components = set[str]()
        for name in elements:
            if name.kind == "group":
                components.update(c.id for c in self.architecture.groups[name.id].components.values())
            elif name.kind == "component":
                components.add(name.id)
            elif name.kind in {"output", "input"}:
                components.add(name.id.rpartition(".")[0])
        nodes = frozenset(name.id for name in elements if name.kind == "node")
        outputs = tuple(name.id for name in elements if name.kind == "output")
        # `outputs` is set only if the word names nothing else, see `SelectorHit.outputs`.
        whole = len(outputs) == len(elements)
        return Hit(frozenset(components), nodes, elements, outputs if whole else (), bool(nodes) and not components)


def _limit(steps: int) -> int | None:
    return None if steps == ALL else steps


def _ends_like(path: list[str], parts: list[str]) -> bool:
    return len(path) >= len(parts) and all(map(wild, parts, path[-len(parts) :]))
