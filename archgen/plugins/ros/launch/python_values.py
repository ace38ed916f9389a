"""What names stand for while a launch file in Python is read: modules, functions, and names that are looked up outward."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field

from archgen.plugin import dataclass as frozen_dataclass
from archgen.plugins.ros.launch.launch_values import LaunchValue


@frozen_dataclass(frozen=True, slots=True)
class ImportedName:
    """A module, or something of one, by its dotted name."""

    name: str

    @property
    def last(self) -> str:
        """Its own name."""
        return self.name.rpartition(".")[2]


@dataclass(slots=True, eq=False)
class NameScope:
    """The names of a function or of the file."""

    outer: NameScope | None = None
    values: dict[str, LaunchValue] = field(default_factory=dict)
    returned: list[LaunchValue] = field(default_factory=list)
    """What may be returned, where a condition is not known."""

    def find(self, name: str) -> tuple[bool, LaunchValue]:
        """Return whether a name is known, and what it stands for."""
        scope: NameScope | None = self
        while scope is not None:
            if name in scope.values:
                return True, scope.values[name]
            scope = scope.outer
        return False, None


@dataclass(slots=True, eq=False)
class FunctionValue:
    """A function of the file, or of a module beside it: then `reader` knows that one's lines."""

    definition: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    scope: NameScope
    reader: object


@dataclass(slots=True, eq=False)
class ModuleValue:
    """A module that lies beside the launch file."""

    name: str
    scope: NameScope


@dataclass(slots=True, eq=False)
class RecordValue:
    """An object that holds values by its attributes' names; what its methods, without arguments, give stands there, too."""

    values: dict[str, LaunchValue]
    methods: frozenset[str]


@dataclass(slots=True, eq=False)
class BoundMethod:
    """A method of a value."""

    owner: LaunchValue
    name: str


@dataclass(slots=True, eq=False)
class CallArguments:
    """The arguments of a call."""

    positional: list[LaunchValue]
    named: dict[str, LaunchValue]

    def get(self, position: int | None, *names: str) -> LaunchValue:
        """Return an argument by its place or by one of its names; None where it is absent."""
        if position is not None and position < len(self.positional):
            return self.positional[position]
        return next((self.named[name] for name in names if name in self.named), None)
