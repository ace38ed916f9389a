"""Source code of Python and C++ alike, as far as it decides what a program says to ROS: expressions, statements, functions, classes.

A reader for each language makes it of a syntax tree; `program_walk` goes through it. It holds no more than texts and places.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

MAX_DEPTH = 80
"""Expressions and blocks that stand in one another; deeper ones are unknown: people do not write them."""
MAX_SOURCE_BYTES = 1_000_000

ExpressionKind = Literal[
    "value", "name", "member", "call", "join", "list", "dict", "index", "choice", "lambda", "unknown"
]


@dataclass(slots=True, eq=False)
class Expression:
    """An expression. `parts` of a call are what is called and then its arguments; of a member whose it is; of a choice the
    condition and both values; of an index the whole and the key; of a dict its keys and then its values.
    """

    kind: ExpressionKind
    text: str
    """As it is written, shortened."""
    line: int
    column: int
    value: Any = None
    """Of a value itself, of a name or member what it is called."""
    parts: tuple[Expression, ...] = ()
    keywords: Mapping[str, Expression] = field(default_factory=dict)
    type_arguments: tuple[str, ...] = ()
    body: Function | None = None
    """What a lambda does."""


@dataclass(slots=True, eq=False)
class Statement:
    """A statement. `loop`: the targets take each item of the value; `branch`: the value is the condition;
    `local`: a variable of a type of C++ is made, of what `value` hands to its constructor; `set` gives a value to targets; `leave` ends a round of a loop.
    """

    kind: Literal["do", "set", "local", "loop", "branch", "return", "leave", "import"]
    value: Expression | None = None
    targets: tuple[Expression, ...] = ()
    body: tuple[Statement, ...] = ()
    otherwise: tuple[Statement, ...] = ()
    type_name: str = ""
    names: tuple[tuple[str, str], ...] = ()
    """Of an import: each local name with what it stands for, by dots; `*` for all names of a module."""


@dataclass(slots=True, eq=False)
class FunctionParameter:
    """A parameter of a function."""

    name: str
    type_name: str = ""
    default: Expression | None = None


@dataclass(slots=True, eq=False)
class Function:
    """A function or method; `file` is where it is defined."""

    name: str
    parameters: tuple[FunctionParameter, ...]
    body: tuple[Statement, ...]
    file: SourceFile
    owner: str = ""
    """The class whose method it is."""
    is_static: bool = False
    type_parameters: tuple[str, ...] = ()


@dataclass(slots=True, eq=False)
class SourceClass:
    """A class; what several files of C++ say of it is one."""

    name: str
    file: SourceFile
    bases: tuple[str, ...] = ()
    functions: dict[str, list[Function]] = field(default_factory=dict)
    fields: dict[str, str] = field(default_factory=dict)
    """The types of its members in C++, by name, in their order."""
    field_values: list[Statement] = field(default_factory=list)
    """What the class itself gives its members."""
    aliases: dict[str, str] = field(default_factory=dict)
    type_parameters: tuple[str, ...] = ()


@dataclass(slots=True, eq=False)
class SourceFile:
    """A file of sources."""

    path: Path
    shown: str
    """How messages name it."""
    language: Literal["python", "cpp"]
    statements: tuple[Statement, ...] = ()
    """What stands outside of functions and classes."""
    functions: dict[str, list[Function]] = field(default_factory=dict)
    classes: dict[str, SourceClass] = field(default_factory=dict)
    """By name, the qualified one: `my_robot::Driver` in C++, `Driver.State` for a class inside of one in Python."""
    aliases: dict[str, str] = field(default_factory=dict)
    """`using` and `typedef` of C++, and constants of the preprocessor as text."""
    includes: tuple[str, ...] = ()
    plugins: tuple[str, ...] = ()
    """Classes that the file registers as components or plug-ins."""
    unread: list[tuple[int, int, str]] = field(default_factory=list)
    """Places that could not be read: line, column and why."""
