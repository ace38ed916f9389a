"""What a selector selects in an architecture: components and nodes.

How selectors are written is in `model.selector_words`, what each key names in `model.selector_keys`.
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
"""Among more names nobody is helped by a guess that takes seconds."""


@dataclass(frozen=True, slots=True)
class Selection:
    """What is selected, by complete ids; nodes of selected components are, and components of selected nodes.

    `named` are the elements that paths name, groups and outputs included, in the order of the words.
    """

    components: frozenset[str] = frozenset()
    nodes: frozenset[str] = frozenset()
    named: tuple[Named, ...] = ()


def select(
    text: str, architecture: Architecture, findings: Mapping[str, frozenset[str]] | None = None
) -> tuple[Selection, tuple[Problem, ...]]:
    """Evaluate one selector. `findings` are the ids of the elements that each rule has found, for `finding:`."""
    return Selecting(architecture, findings or {}).select(text)


@dataclass()
class Selecting:
    """The look-ups of an architecture, made when a word first asks for them: keep it to evaluate several selectors."""

    architecture: Architecture
    findings: Mapping[str, frozenset[str]] = field(default_factory=dict)

    def select(self, text: str) -> tuple[Selection, tuple[Problem, ...]]:
        """Evaluate a selector: all words without `-` together, or everything, without those with `-`.

        Where something is wrong (not only a warning) nothing is selected.
        """
        read = parse(text)
        problems = list(read.problems)
        wanted = [self._word(word, problems) for word in read.words if not word.negative]
        refused = [self._word(word, problems) for word in read.words if word.negative]
        if any(problem.severity == "error" for problem in problems):
            return Selection(), tuple(problems)
        if not wanted:
            wanted = [Hit(frozenset(self.architecture.components), frozenset(self.architecture.nodes))]
        return self._without(wanted, refused), tuple(problems)

    def _without(self, wanted: Sequence[Hit], refused: Sequence[Hit]) -> Selection:
        """Take words out. A node goes where it is refused itself, or with the last of its components."""
        gone = frozenset[str]().union(*(hit.components for hit in refused))
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
        """Find elements by their paths."""
        found = self.architecture
        kinds = {"group": found.groups, "component": found.components, "output": found.outputs, "input": found.inputs}
        return Names({**kinds, "node": found.nodes})

    @cached_property
    def components(self) -> graph.Graph:
        """Follow the flow between components."""
        return graph.components(self.architecture)

    @cached_property
    def nodes(self) -> graph.Graph:
        """Follow the flow between nodes."""
        return graph.nodes(self.architecture)

    @cached_property
    def nodes_of(self) -> Mapping[str, list[str]]:
        """Find the nodes that implement a component."""
        found: dict[str, list[str]] = defaultdict(list)
        for node in self.architecture.nodes.values():
            for component in node.implements:
                found[component].append(node.id)
        return found

    @cached_property
    def readers(self) -> Mapping[str, list[str]]:
        """Find the components that read an output."""
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
        if hit.of_nodes:
            reached = graph.reach(self.nodes.before, hit.nodes, before) | graph.reach(
                self.nodes.after, hit.nodes, after
            )
            return Hit(frozenset(), frozenset(reached), hit.named, of_nodes=True)
        whole = self._both_levels(hit)
        behind = graph.reach(self.components.before, whole.components, before)
        return Hit(whole.components.union(behind, self._ahead(whole, after)), whole.nodes, hit.named)

    def _ahead(self, hit: Hit, steps: int | None) -> dict[str, int]:
        """Give what is fed; from an output on, only its own readers are the first step."""
        if not hit.outputs or steps == 0:
            return graph.reach(self.components.after, hit.components, steps)
        starts = (reader for output in hit.outputs for reader in self.readers.get(output, ()))
        return graph.reach(self.components.after, starts, None if steps is None else steps - 1)

    def _between(self, first: Hit, last: Hit) -> Hit:
        """Give all ways from one to the other: what the first feeds of what feeds the last."""
        named = (*first.named, *last.named)
        if first.of_nodes and last.of_nodes:
            ahead = graph.reach(self.nodes.after, first.nodes)
            way = ahead.keys() & graph.reach(self.nodes.before, last.nodes).keys()
            hit = Hit(frozenset(), frozenset(way), named, of_nodes=True)
        else:
            first, last = self._both_levels(first), self._both_levels(last)
            behind = graph.reach(self.components.before, last.components).keys()
            way = self._ahead(first, None).keys() & behind
            if first.outputs and way:
                way |= first.components
            hit = Hit(frozenset(way), frozenset(), named)
        return self._both_levels(hit)

    def _both_levels(self, hit: Hit) -> Hit:
        """Add the nodes of components, and the components of nodes."""
        nodes = {node for component in hit.components for node in self.nodes_of.get(component, ())}
        crossing = hit.nodes if hit.crosses else ()
        implemented = (c for node in crossing for c in self.architecture.nodes[node].implements)
        return Hit(hit.components.union(implemented), hit.nodes | nodes, hit.named, hit.outputs, hit.of_nodes)

    def _atom(self, atom: Atom, problems: list[Problem]) -> Hit:
        if atom.key is not None:
            hit = by_key(self.architecture, atom.key, atom.value, self.findings)
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
        """Follow a path as references do; what no group, component or output is called may be a node or an input."""
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
        length = words.count(".")
        pool = {path for kind in (*_PATHS, "node") for path in self.names.ends(kind) if path.count(".") == length}
        return closest(words, pool) if len(pool) <= _MOST_GUESSED else None

    def _matching(self, pattern: str) -> list[Named]:
        """Find the elements whose paths end in a pattern."""
        parts = pattern.split(".")
        found = self.architecture
        kinds = {"group": found.groups, "component": found.components, "output": found.outputs, "node": found.nodes}
        return [
            Named(kind, path) for kind, paths in kinds.items() for path in paths if _ends_like(path.split("."), parts)
        ]

    def _hit(self, named: Iterable[Named]) -> Hit:
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
        whole = len(outputs) == len(elements)
        return Hit(frozenset(components), nodes, elements, outputs if whole else (), bool(nodes) and not components)


def _limit(steps: int) -> int | None:
    return None if steps == ALL else steps


def _ends_like(path: list[str], parts: list[str]) -> bool:
    return len(path) >= len(parts) and all(map(wild, parts, path[-len(parts) :]))
