"""The project that a table describes, as far as it has been read: elements are found by id and by name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any

from archgen.plugin.findings import Diagnostic, Label, Severity
from archgen.plugin.importing import Span, WorkBudget, find_closest, make_id, make_unique_id
from archgen.plugins.tables.table_cells import CellLedger, ElementPath, TableCell

UNSORTED = "unsorted"
"""The group of components for which no row names one."""
_MAX_GUESSES = 20
MAX_LISTED = 10_000
"""How many inputs and outputs cells may list, all tables together."""
_PATH_SEPARATOR = re.compile(r"(?:(?<!\s)\s++)?+(?:::|->|[./:>\\|])\s*+")


@dataclass(slots=True)
class ImportedInput:
    """An input: its sources (paths), its expected type, its description."""

    sources: list[tuple[str, ...]] = field(default_factory=list)
    type: str | None = None
    description: str | None = None


@dataclass(slots=True)
class ImportedComponent:
    """A component; `name` is what people call it."""

    group: str
    id: str
    name: str
    span: Span
    wanted_id: str = ""
    """The id that a table gives it, as it is written there."""
    values: dict[str, object] = field(default_factory=dict)
    requirements: list[str] = field(default_factory=list)
    inputs: dict[str, ImportedInput] = field(default_factory=dict)
    outputs: dict[str, str | None] = field(default_factory=dict)
    declared_empty: set[str] = field(default_factory=set)
    """`inputs` or `outputs`, where the table says that there are none."""
    untyped_outputs: set[str] = field(default_factory=set)
    """The outputs that are listed without a type: their names stand for it until another row gives one."""

    @property
    def path(self) -> ElementPath:
        """Where the component stands in the data."""
        return ("groups", self.group, "components", self.id)


@dataclass(slots=True)
class ImportedGroup:
    """A group; `name` is what people call it."""

    id: str
    name: str
    span: Span
    values: dict[str, object] = field(default_factory=dict)
    components: dict[str, ImportedComponent] = field(default_factory=dict)

    @property
    def path(self) -> ElementPath:
        """Where the group stands in the data."""
        return ("groups", self.id)


@dataclass(slots=True)
class ImportedProject:
    """Everything read so far, and the diagnostics about it."""

    groups: dict[str, ImportedGroup] = field(default_factory=dict)
    nodes: dict[str, dict[str, object]] = field(default_factory=dict)
    types: dict[str, str | None] = field(default_factory=dict)
    requirements: dict[str, str | None] = field(default_factory=dict)
    partners: dict[str, str] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    ledger: CellLedger = field(default_factory=CellLedger)
    message_cells: dict[str, list[TableCell]] = field(default_factory=dict)
    """Where each type or message is written."""
    wrong_messages: set[str] = field(default_factory=set)
    """Messages that do not exist."""
    is_complete: bool = False
    """Whether all rows that declare components were read: an unknown name is then a slip."""
    first_node: dict[str, str] = field(default_factory=dict)
    """The first node of each component, by the component's path."""
    budget: WorkBudget = field(default_factory=lambda: WorkBudget(MAX_LISTED))
    _guess_count: int = 0
    _producers: dict[str, dict[tuple[str, str, str], None]] = field(default_factory=dict)
    _id_by_name: dict[str, str] = field(default_factory=dict)
    _components_by_name: dict[str, list[ImportedComponent]] = field(default_factory=dict)
    _components_by_id: dict[str, list[ImportedComponent]] = field(default_factory=dict)

    def reject_cell(self, rule: str, message: str, cell: TableCell, help_line: str) -> None:
        """Add a warning about a cell, or a part of it, that was not taken."""
        self.ledger.reject_cell(cell, message)
        self.add_warning(rule, message, cell.span, help_line)

    def set_once(  # noqa: PLR0913, PLR0917 - what is set, from where, and what is said of another value
        self,
        values: dict[str, Any],
        key: str,
        value: object,
        cell: TableCell,
        message: str,
        help_line: str = "say it once",
    ) -> bool:
        """Set a key and return True; where an earlier row gave another value, that stays, and the cell is not taken."""
        if values.setdefault(key, value) == value:
            return True
        self.reject_cell("conflicting-values", message, cell, help_line)
        return False

    def take_cell(self, cell: TableCell, key: str, component: ImportedComponent, words: str = "") -> None:
        """Note that a cell was taken for a key of a component."""
        self.ledger.take_cell(cell, key, component.path, words)

    def add_message_cell(self, name: str, cell: TableCell) -> None:
        """Note that a cell names a type or a message."""
        self.message_cells.setdefault(name, []).append(cell)

    def add_warning(self, rule: str, message: str, span: Span, help_line: str, *labels: Label) -> None:
        """Add a warning about something that was not imported, or imported otherwise than written."""
        self.diagnostics.append(Diagnostic(rule, message, span, Severity.WARNING, labels, help_line))

    def add_note(self, message: str, span: Span, help_line: str, *labels: Label) -> None:
        """Add a note about a decision."""
        self.diagnostics.append(Diagnostic("wrong-value", message, span, Severity.NOTE, labels, help_line))

    def get_group(self, cell: TableCell) -> ImportedGroup:
        """Return the group that a cell names, a new one where there is none."""
        group = self.get_named_group(cell.one_line, cell.span)
        self.ledger.take_cell(cell, "group", group.path, group.id)
        return group

    def get_named_group(self, name: str, span: Span) -> ImportedGroup:
        """Return the group of a name, a new one where there is none."""
        group = self._find_group(name)
        if group is None:
            group = ImportedGroup(self._make_free_id("group", name, span, self.groups.keys()), name, span)
            self.groups[group.id] = group
            self._id_by_name[f"group {fold_name(name)}"] = group.id
        return group

    def get_component(self, group: ImportedGroup, name: str, span: Span, wanted_id: str = "") -> ImportedComponent:
        """Return a group's component of a name, a new one where there is none. `wanted_id` is the id that a row gives
        it.
        """
        component = self._find_in_group(group, name) or group.components.get(name)
        if component is None:
            new_id = self._make_free_id("component", wanted_id or name, span, group.components.keys())
            component = group.components[new_id] = ImportedComponent(group.id, new_id, name, span, wanted_id)
            self._components_by_name.setdefault(fold_name(name), []).append(component)
            self._components_by_id.setdefault(new_id, []).append(component)
        return component

    def _find_group(self, name: str) -> ImportedGroup | None:
        return self.groups.get(self._id_by_name.get(f"group {fold_name(name)}", name))

    def _find_in_group(self, group: ImportedGroup, name: str) -> ImportedComponent | None:
        return next((each for each in self.find_components(name) if each.group == group.id), None)

    def find_components(self, name: str) -> list[ImportedComponent]:
        """Return all components of a name, or else of an id."""
        return self._components_by_name.get(fold_name(name)) or self._components_by_id.get(name, [])

    def get_partner_id(self, name: str) -> str:
        """Return the id of a partner, a new one where there is none."""
        partner_id = self._id_by_name.setdefault(f"partner {fold_name(name)}", make_id(name.casefold(), "partner"))
        self.partners.setdefault(partner_id, name)
        return partner_id

    def all_components(self) -> Iterator[ImportedComponent]:
        """Yield all components."""
        for group in self.groups.values():
            yield from group.components.values()

    def add_output(self, component: ImportedComponent, name: str, type_name: str | None) -> None:
        """Add an output with a type (None: not known yet) to a component, or set the type of one that it has."""
        component.outputs[name] = type_name
        path = (component.group, component.id, name)
        # Found by its name and by its type: tables list inputs by either.
        for word in dict.fromkeys((fold_name(name), fold_name(type_name or name))):
            self._producers.setdefault(word, {})[path] = None

    def find_producers(self, name: str) -> list[tuple[str, str, str]]:
        """Return the paths of the outputs that have this name, or carry a type of this name."""
        return list(self._producers.get(fold_name(name), ()))

    def resolve_path(self, text: str) -> tuple[ImportedComponent, str] | None:
        """Resolve `group.component`, `Group / Component` or `component.output` to a component and a port's name."""
        words = [word for word in _PATH_SEPARATOR.split(text) if word]
        # Only the first word may stand for a component without its group: `robot.arm` is not the component `arm`.
        namesakes = self.find_components(words[0]) if words else []
        for first, (outer, inner) in enumerate(zip_longest(words, words[1:])):
            group = self._find_group(outer)
            if group and inner and (component := self._find_in_group(group, inner)):
                return component, " ".join(words[first + 2 :])
            if len(namesakes) == 1 and first == 0:
                return namesakes[0], " ".join(words[1:])
        return None

    def suggest_component(self, name: str) -> str:
        """Suggest the component that an unknown name may mean, as the beginning of a help line; empty where there is
        none.
        """
        # Each suggestion compares with all names. Where nearly every name is new, guesses are useless and slow.
        self._guess_count += 1
        if self._guess_count > _MAX_GUESSES:
            return ""
        name_by_folded = {fold_name(component.name): component.name for component in self.all_components()}
        near = find_closest(fold_name(name), name_by_folded)
        return f"did you mean `{name_by_folded[near]}`? " if near and near != fold_name(name) else ""

    def _make_free_id(self, kind: str, name: str, span: Span, taken_ids: AbstractSet[str]) -> str:
        """Return a free id for a name; a note says where it differs from what the name would give."""
        wanted_id = make_id(name, kind)
        free_id = make_unique_id(wanted_id, taken_ids)
        if free_id != wanted_id:
            self.add_note(
                f"`{name}` would be `{wanted_id}` like another {kind}, and became `{free_id}`",
                span,
                "rename one of them if you like",
            )
        return free_id


def fold_name(name: str) -> str:
    """Fold the spellings of one name: case, blanks, hyphens and underscores do not tell names apart."""
    return re.sub(r"[\s_\-]+", "", name.casefold())
