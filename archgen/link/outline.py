"""List the groups, components and ports of the merged project, before any reference is resolved."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

from archgen.link import reading
from archgen.model.component import Output
from archgen.syntax.tree import Entry, Table


@dataclass(slots=True)
class Outline:
    """What the project declares on its high level. Inputs stay as written: what feeds them is not known yet."""

    groups: dict[str, Entry] = field(default_factory=dict)
    components: dict[str, Entry] = field(default_factory=dict)
    outputs: dict[str, dict[str, Output]] = field(default_factory=dict)
    """By component id and name."""
    inputs: dict[str, dict[str, Entry]] = field(default_factory=dict)
    """By component id and name."""

    @property
    def ports(self) -> Mapping[str, Mapping[str, Collection[str]]]:
        """The names of the ports by kind (`input`, `output`) and component id."""
        return {"input": self.inputs, "output": self.outputs}

    def all_outputs(self) -> Iterator[Output]:
        """Iterate over every output."""
        for outputs in self.outputs.values():
            yield from outputs.values()

    def types_used(self) -> Iterator[str]:
        """Yield the types that ports mention, with repetitions."""
        for component, outputs in self.outputs.items():
            for entry in self.inputs[component].values():
                written = reading.text(reading.body(entry), "type")
                if written:
                    yield reading.type_name(written)
            yield from (output.type for output in outputs.values() if output.type)


def outline(root: Table) -> Outline:
    """Return the outline of a merged project, by complete ids."""
    found = Outline()
    for group, entry, below in reading.elements(root, "groups"):
        found.groups[group] = entry
        for name, component, parts in reading.elements(below, "components"):
            complete = f"{group}.{name}"
            found.components[complete] = component
            found.inputs[complete] = {e.key: e for e in reading.table(parts, "inputs")}
            found.outputs[complete] = {e.key: _output(complete, e) for e in reading.table(parts, "outputs")}
    return found


def _output(component: str, entry: Entry) -> Output:
    below = reading.body(entry)
    written = reading.text(below, "type")
    return Output(
        id=f"{component}.{entry.key}",
        name=entry.key,
        component=component,
        type=reading.type_name(written) if written else None,
        external=reading.text(below, "external"),
        physical=reading.text(below, "medium") == "physical",
        description=reading.text(below, "description"),
        at=entry.at,
        type_at=reading.place(below, "type"),
    )
