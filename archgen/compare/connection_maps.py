"""Who reads what in each version, under common ids, and which inputs have other sources."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping

from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture

OppositeEnds = Mapping[str, frozenset[str]]


@dataclass(frozen=True, slots=True)
class ConnectionMap:
    """One version: the sources of each input, and the readers of each output."""

    sources_by_input: OppositeEnds
    readers_by_output: OppositeEnds
    made_pairs: frozenset[tuple[str, str]] = frozenset()
    """The outputs and inputs that nobody joined: `autoconnect` did."""
    group_pairs: frozenset[tuple[str, str]] = frozenset()
    """The outputs and inputs of which the input names the group alone: it reads whatever is in that."""

    def is_made(self, input_id: str, outputs: Collection[str]) -> bool:
        """Whether an input and all of these outputs are joined by themselves."""
        return bool(outputs) and all((output, input_id) in self.made_pairs for output in outputs)


@dataclass(frozen=True, slots=True)
class RewiredInput:
    """An input whose sources changed."""

    input_id: str
    sources_before: frozenset[str]
    sources_after: frozenset[str]

    @property
    def lost_sources(self) -> frozenset[str]:
        """Return the sources that it no longer has."""
        return self.sources_before - self.sources_after

    @property
    def gained_sources(self) -> frozenset[str]:
        """Return the sources that are new."""
        return self.sources_after - self.sources_before


def map_connections(architecture: Architecture, matched_ids: MatchedIds) -> ConnectionMap:
    """Return the connections of a version. A reference to something without an output yet is kept under its own id."""
    sources: dict[str, set[str]] = defaultdict(set)
    readers: dict[str, set[str]] = defaultdict(set)
    made_pairs, group_pairs = set[tuple[str, str]](), set[tuple[str, str]]()
    for connection in architecture.connections:
        reader = matched_ids.common_id("input", connection.input)
        for output in connection.outputs:
            output_id = matched_ids.common_id("output", output)
            sources[reader].add(output_id)
            readers[output_id].add(reader)
            if connection.is_made:
                made_pairs.add((output_id, reader))
            elif connection.kind == "group":
                group_pairs.add((output_id, reader))
        if not connection.outputs:
            sources[reader].add(matched_ids.common_id(connection.kind, connection.target))
    return ConnectionMap(_freeze_ends(sources), _freeze_ends(readers), frozenset(made_pairs), frozenset(group_pairs))


def _freeze_ends(ends: Mapping[str, set[str]]) -> OppositeEnds:
    return {name: frozenset(opposite_ids) for name, opposite_ids in ends.items()}


def find_rewired_inputs(old_map: ConnectionMap, new_map: ConnectionMap) -> Iterator[RewiredInput]:
    """Yield the inputs whose sources changed, sorted by id."""
    no_sources = frozenset[str]()
    for input_id in sorted(old_map.sources_by_input.keys() | new_map.sources_by_input.keys()):
        old_sources = old_map.sources_by_input.get(input_id, no_sources)
        new_sources = new_map.sources_by_input.get(input_id, no_sources)
        if old_sources != new_sources:
            yield RewiredInput(input_id, old_sources, new_sources)
