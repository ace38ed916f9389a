"""Who reads what in each version, under common ids, and which inputs have other sources."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from archgen.compare.names import Names
from archgen.model.architecture import Architecture

Ends = Mapping[str, frozenset[str]]


@dataclass(frozen=True, slots=True)
class Wires:
    """One version: the sources of each input, and the readers of each output."""

    sources: Ends
    readers: Ends


@dataclass(frozen=True, slots=True)
class Rewired:
    """An input whose sources changed."""

    input: str
    before: frozenset[str]
    after: frozenset[str]

    @property
    def lost(self) -> frozenset[str]:
        """Return the sources that it no longer has."""
        return self.before - self.after

    @property
    def gained(self) -> frozenset[str]:
        """Return the sources that are new."""
        return self.after - self.before


def wires(found: Architecture, names: Names) -> Wires:
    """Return the connections of a version. A reference to something without an output yet is kept under its own id."""
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
    """Yield the inputs whose sources changed, sorted by id."""
    nothing = frozenset[str]()
    for name in sorted(before.sources.keys() | after.sources.keys()):
        old, new = before.sources.get(name, nothing), after.sources.get(name, nothing)
        if old != new:
            yield Rewired(name, old, new)
