"""Who reads what, before and after, with one set of names; and what it means that this changed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from archgen.compare.names import Names
from archgen.model.architecture import Architecture

Ends = Mapping[str, frozenset[str]]


@dataclass(frozen=True, slots=True)
class Wires:
    """One version: what each input reads, and who reads each output."""

    sources: Ends
    readers: Ends


@dataclass(frozen=True, slots=True)
class Rewired:
    """An input of which the sources changed."""

    input: str
    before: frozenset[str]
    after: frozenset[str]

    @property
    def lost(self) -> frozenset[str]:
        """Give the sources that it had."""
        return self.before - self.after

    @property
    def gained(self) -> frozenset[str]:
        """Give the sources that it has now."""
        return self.after - self.before


def wires(found: Architecture, names: Names) -> Wires:
    """Give the connections of a version. A reference to what has no output yet stands for itself."""
    sources: dict[str, set[str]] = defaultdict(set)
    readers: dict[str, set[str]] = defaultdict(set)
    for connection in found.connections:
        reader = names.to("input", connection.input)
        for output in connection.outputs:
            name = names.to("output", output)
            sources[reader].add(name)
            readers[name].add(reader)
        if not connection.outputs:
            sources[reader].add(names.to(connection.kind, connection.target))
    return Wires(_frozen(sources), _frozen(readers))


def _frozen(ends: Mapping[str, set[str]]) -> Ends:
    return {name: frozenset(others) for name, others in ends.items()}


def rewired(before: Wires, after: Wires) -> Iterator[Rewired]:
    """Give the inputs of which the sources changed, by name."""
    nothing = frozenset[str]()
    for name in sorted(before.sources.keys() | after.sources.keys()):
        old, new = before.sources.get(name, nothing), after.sources.get(name, nothing)
        if old != new:
            yield Rewired(name, old, new)
