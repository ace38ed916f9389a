"""The project that a table describes, as far as it has been read: elements are found by id and by name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.model import ids
from archgen.source import Span
from archgen.suggest import closest

UNSORTED = "unsorted"
"""The group of components for which no row names one."""
_GUESSES = 20
_PARTS = re.compile(r"\s*(?:::|->|[./:>\\|])\s*")


@dataclass(slots=True)
class Input:
    """An input: its sources (paths), its expected type, its description."""

    sources: list[tuple[str, ...]] = field(default_factory=list)
    type: str | None = None
    description: str | None = None


@dataclass(slots=True)
class Component:
    """A component; `name` is what people call it."""

    group: str
    id: str
    name: str
    at: Span
    keys: dict[str, object] = field(default_factory=dict)
    requirements: list[str] = field(default_factory=list)
    inputs: dict[str, Input] = field(default_factory=dict)
    outputs: dict[str, str | None] = field(default_factory=dict)
    none: set[str] = field(default_factory=set)
    """`inputs` or `outputs`, where the table says that there are none."""


@dataclass(slots=True)
class Group:
    """A group; `name` is what people call it."""

    id: str
    name: str
    at: Span
    keys: dict[str, object] = field(default_factory=dict)
    components: dict[str, Component] = field(default_factory=dict)


@dataclass(slots=True)
class Draft:
    """Everything read so far, and the diagnostics about it."""

    groups: dict[str, Group] = field(default_factory=dict)
    nodes: dict[str, dict[str, object]] = field(default_factory=dict)
    types: dict[str, str | None] = field(default_factory=dict)
    requirements: dict[str, str | None] = field(default_factory=dict)
    partners: dict[str, str] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    places: dict[str, Span] = field(default_factory=dict)
    """Where a type or message was first written."""
    wrong: set[str] = field(default_factory=set)
    """Messages that do not exist."""
    complete: bool = False
    """Whether all rows that declare components were read: an unknown name is then a slip."""
    node_of: dict[str, str] = field(default_factory=dict)
    """The first node of each component, by the component's path."""
    _guesses: int = 0
    _givers: dict[str, dict[tuple[str, str, str], None]] = field(default_factory=dict)
    _ids: dict[str, str] = field(default_factory=dict)
    _names: dict[str, list[Component]] = field(default_factory=dict)
    _by_id: dict[str, list[Component]] = field(default_factory=dict)

    def say(self, rule: str, message: str, at: Span, help_line: str, *labels: Label) -> None:
        """Add a warning about something that was not imported, or imported otherwise than written."""
        self.diagnostics.append(Diagnostic(rule, message, at, Severity.WARNING, labels, help_line))

    def note(self, message: str, at: Span, help_line: str, *labels: Label) -> None:
        """Add a note about a decision."""
        self.diagnostics.append(Diagnostic("wrong-value", message, at, Severity.NOTE, labels, help_line))

    def group(self, name: str, at: Span) -> Group:
        """Return the group of a name, a new one where there is none."""
        found = next((self.groups[i] for i in (self._ids.get(f"group {fold(name)}"), name) if i in self.groups), None)
        if found is None:
            found = Group(self._id("group", name, at, set(self.groups)), name, at)
            self.groups[found.id] = found
            self._ids[f"group {fold(name)}"] = found.id
        return found

    def component(self, group: Group, name: str, at: Span, wanted: str = "") -> Component:
        """Return a group's component of a name, a new one where there is none. `wanted_id` is the id that a row gives
        it.
        """
        found = next((c for c in self.named(name) if c.group == group.id), None) or group.components.get(wanted or name)
        if found is None:
            made = self._id("component", wanted or name, at, set(group.components))
            found = group.components[made] = Component(group.id, made, name, at)
            self._names.setdefault(fold(name), []).append(found)
            self._by_id.setdefault(made, []).append(found)
        return found

    def named(self, name: str) -> list[Component]:
        """Return all components of a name, or else of an id."""
        return self._names.get(fold(name)) or self._by_id.get(name, [])

    def partner(self, name: str) -> str:
        """Return the id of a partner, a new one where there is none."""
        made = self._ids.setdefault(f"partner {fold(name)}", ids.made(name.casefold(), "partner"))
        self.partners.setdefault(made, name)
        return made

    def components(self) -> Iterator[Component]:
        """Yield all components."""
        for group in self.groups.values():
            yield from group.components.values()

    def give(self, component: Component, name: str, told: str | None) -> None:
        """Add an output with a type (None: not known yet) to a component, or set the type of one that it has."""
        component.outputs[name] = told
        path = (component.group, component.id, name)
        # Found by its name and by its type: tables list inputs by either.
        for word in {fold(name), fold(told or name)}:
            self._givers.setdefault(word, {})[path] = None

    def givers(self, wanted: str) -> list[tuple[str, str, str]]:
        """Return the paths of the outputs that have this name, or carry a type of this name."""
        return list(self._givers.get(fold(wanted), ()))

    def parts(self, text: str) -> tuple[Component, str] | None:
        """Resolve `group.component`, `Group / Component` or `component.output` to a component and a port's name."""
        words = [word for word in _PARTS.split(text) if word]
        for first in range(len(words)):
            group = self.groups.get(self._ids.get(f"group {fold(words[first])}", words[first]))
            inner = words[first + 1 :]
            if group and inner:
                found = next((c for c in self.named(inner[0]) if c.group == group.id), None)
                if found:
                    return found, " ".join(inner[1:])
            named = self.named(words[first])
            # Only the first word may stand for a component without its group: `robot.arm` is not the component `arm`.
            if len(named) == 1 and first == 0:
                return named[0], " ".join(inner)
        return None

    def guess(self, name: str) -> str:
        """Suggest the component that an unknown name may mean, as the beginning of a help line; empty where there is
        none.
        """
        # Each suggestion compares with all names. Where nearly every name is new, guesses are useless and slow.
        self._guesses += 1
        if self._guesses > _GUESSES:
            return ""
        known = {fold(component.name): component.name for component in self.components()}
        near = closest(fold(name), known)
        return f"did you mean `{known[near]}`? " if near and near != fold(name) else ""

    def _id(self, sort: str, name: str, at: Span, taken: set[str]) -> str:
        """Return a free id for a name; a note says where it differs from what the name would give."""
        made = ids.made(name, sort)
        free = ids.free(made, taken)
        if free != made:
            self.note(
                f"`{name}` would be `{made}` like another {sort}, and became `{free}`",
                at,
                "rename one of them if you like",
            )
        return free


def fold(name: str) -> str:
    """Fold the spellings of one name: case, blanks, hyphens and underscores do not tell names apart."""
    return re.sub(r"[\s_\-]+", "", name.casefold())
