"""Declare groups and components as model objects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.link import reading
from archgen.link.declare_timing import declare_timing
from archgen.link.outline import Outline
from archgen.link.references import Ports, References
from archgen.link.resolve import Wiring
from archgen.model.component import Component, Group, Indicator, RequirementUse, Role
from archgen.syntax.tree import Entry, Table

_ROLES = frozenset({"source", "filter", "sink", "reactive"})


@dataclass(slots=True)
class HighLevel:
    """Declares the groups with their components, one after the other; the results are in `groups` and `components`."""

    outline: Outline
    references: References
    wiring: Wiring
    groups: dict[str, Group] = field(default_factory=dict)
    components: dict[str, Component] = field(default_factory=dict)

    def declare(self) -> None:
        """Declare every group with its components, and wire their inputs."""
        for name, entry in self.outline.groups.items():
            self.groups[name] = self._group(name, entry)

    def _group(self, name: str, entry: Entry) -> Group:
        below = reading.body(entry)
        # Owners are inherited: a component without owners has those of its group, a node those of its components.
        owners = self.references.owners(below, name, ())
        components = {part.key: self._component(name, part, owners) for part in reading.table(below, "components")}
        self.components.update((component.id, component) for component in components.values())
        return Group(
            id=name,
            title=reading.title(below, name),
            description=reading.text(below, "description"),
            owner=next(iter(owners), None),
            co_owners=owners[1:],
            tags=reading.texts(below, "tags"),
            urls=reading.words(below, "urls"),
            layout=reading.layout(below),
            components=components,
            at=entry.at,
        )

    def _component(self, group: str, entry: Entry, inherited: tuple[str, ...]) -> Component:
        below, complete = reading.body(entry), f"{group}.{entry.key}"
        owners = self.references.owners(below, complete, inherited)
        inputs = self.outline.inputs[complete]
        return Component(
            id=complete,
            name=entry.key,
            group=group,
            title=reading.title(below, entry.key),
            functionality=reading.text(below, "functionality"),
            description=reading.text(below, "description"),
            owner=next(iter(owners), None),
            co_owners=owners[1:],
            role=_role(below),
            requirements=tuple(_requirements(below)),
            requirements_known=below.get("requirements") is not None,
            performance=tuple(_performance(below)),
            inputs={name: self.wiring.input(complete, port) for name, port in inputs.items()},
            # Absent means not known yet, `{}` means known to be none: three of these flags keep the difference.
            inputs_known=below.get("inputs") is not None,
            outputs=self.outline.outputs[complete],
            outputs_known=below.get("outputs") is not None,
            timing=declare_timing(
                entry, Ports(self.references, complete, (complete,), self.outline.ports), self.references.found
            ),
            tags=reading.texts(below, "tags"),
            urls=reading.words(below, "urls"),
            layout=reading.layout(below),
            title_written=reading.text(below, "title") is not None,
            at=entry.at,
            role_at=reading.place(below, "role"),
        )


def _role(below: Table) -> Role | None:
    written = reading.text(below, "role")
    return written if written in _ROLES else None  # type: ignore[return-value]


def _requirements(below: Table) -> Iterator[RequirementUse]:
    """Yield the entries of `requirements`: one that contains a blank is free text, any other is an id."""
    for written in reading.scalars(below, "requirements"):
        text = written.text.strip()
        yield RequirementUse(text, not any(letter.isspace() for letter in text), written.at)


def _performance(below: Table) -> Iterator[Indicator]:
    for name, entry, parts in reading.elements(below, "performance"):
        yield Indicator(
            id=name,
            title=reading.title(parts, name),
            accuracy=reading.text(parts, "accuracy"),
            execution_time=reading.measure(parts, "execution_time", "duration"),
            at=entry.at,
        )
