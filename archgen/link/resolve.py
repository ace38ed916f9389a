"""Wire inputs: turn each reference in `from` into the outputs that it stands for, as connections and edges."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from archgen.diagnostic import Diagnostic
from archgen.link import reading
from archgen.link.outline import Outline
from archgen.link.references import References
from archgen.model.architecture import Edge
from archgen.model.component import Connection, Input, Output
from archgen.model.mapping import Type, flow_of
from archgen.model.names import Named
from archgen.syntax.tree import Entry, Scalar

_SOURCES = ("group", "component", "output")
MAX_PAIRS = 500_000
"""How many pairs of output and input references may make. 10,000 components with 23,000 connections make 30,000; only
many references to large groups make more, and then their number grows with the square of the groups' size.
"""


@dataclass(slots=True)
class Wiring:
    """Wires inputs one after the other; the results are in `connections` and `edges`."""

    outline: Outline
    references: References
    types: Mapping[str, Type]
    connections: list[Connection] = field(default_factory=list)
    edges: list[Edge] = field(default_factory=list)
    _full: bool = False
    _brought: dict[str, tuple[Output, ...]] = field(default_factory=dict)

    def input(self, component: str, entry: Entry) -> Input:
        """Return an input, connected to what its `from` names."""
        below = reading.body(entry)
        complete = f"{component}.{entry.key}"
        made = tuple(self._connect(component, complete, written) for written in reading.scalars(below, "from"))
        connections = tuple(connection for connection in made if connection)
        self.connections += connections
        # Two references may bring the same output: one edge, in the order of first mention and with its position. The
        # reversal makes the first mention win in the dict.
        pairs = {output: connection.at for connection in reversed(connections) for output in connection.outputs}
        order = dict.fromkeys(output for connection in connections for output in connection.outputs)
        self.edges += [Edge(output, complete, pairs[output]) for output in order]
        written_type = reading.text(below, "type")
        return Input(
            id=complete,
            name=entry.key,
            component=component,
            connections=connections,
            external=reading.text(below, "external"),
            physical=reading.text(below, "medium") == "physical",
            type=reading.type_name(written_type) if written_type else None,
            optional=reading.flag(below, "optional"),
            description=reading.text(below, "description"),
            from_written=below.get("from") is not None,
            at=entry.at,
            type_at=reading.place(below, "type"),
        )

    def _connect(self, component: str, complete: str, written: Scalar) -> Connection | None:
        target = self.references.follow(written, _SOURCES, component, component)
        if target is None:
            return None
        # A connection without outputs is kept: it is what was written, even if it brings nothing.
        outputs = () if self._full else tuple(self._outputs(target, component))
        if len(self.edges) + len(outputs) > MAX_PAIRS:
            self._too_many(written, component)
            outputs = ()
        return Connection(complete, written.text, target.kind, target.id, outputs, written.at)  # type: ignore[arg-type]

    def _too_many(self, written: Scalar, component: str) -> None:
        """Report the limit on pairs once; all later references bring nothing, so that the cut is at one clear place."""
        if not self._full:
            self._full = True
            message = (
                f"up to here references make more than {MAX_PAIRS:,} pairs of output and input; the rest is left out"
            )
            help_line = "name single outputs or components where whole groups are named"
            self.references.found.append(
                Diagnostic("too-large", message, written.at, help=help_line, element=component)
            )

    def _outputs(self, target: Named, reader: str) -> Iterator[str]:
        """Yield the outputs that a reference stands for: one, or all that carry messages except the reader's own."""
        if target.kind == "output":
            yield target.id
            return
        # Cached by id alone: a group and a component never share a complete id, since one has a dot and one has none.
        if target.id not in self._brought:
            self._brought[target.id] = tuple(self._carrying_messages(target))
        yield from (output.id for output in self._brought[target.id] if output.component != reader)

    def _carrying_messages(self, target: Named) -> Iterator[Output]:
        members = (
            reading.table(reading.body(self.outline.groups[target.id]), "components")
            if target.kind == "group"
            else None
        )
        components = [target.id] if members is None else [f"{target.id}.{name}" for name in members.entries]
        for component in components:
            for output in self.outline.outputs[component].values():
                mapped = self.types.get(output.type or "")
                # A component or group as a whole stands for its data: a service is called by name, light is no message.
                if not output.physical and flow_of(mapped.message if mapped else None) == "topic":
                    yield output
