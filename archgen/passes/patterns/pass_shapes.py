"""A pass that is written as rules: what each finds, compares, names and writes."""

from __future__ import annotations

from typing import Literal

from archgen.diagnostics import Diagnostic, Span
from archgen.frozen import NamedTuple
from archgen.passes.patterns.expressions import Condition, Operand
from archgen.passes.patterns.matching import ViewPattern
from archgen.passes.patterns.pattern_shapes import Pattern

WRONG_PASS = "wrong-pass"  # noqa: S105 - not a password
"""The rule of all that is wrong with a pass that is written as rules."""


def diagnose_pass(message: str, span: Span, help_line: str | None = None) -> Diagnostic:
    """Return the finding for what is wrong with a pass at a place."""
    return Diagnostic(WRONG_PASS, message, span, help=help_line)


EditKind = Literal["add", "set", "drop"]
EDIT_KINDS: tuple[EditKind, ...] = ("drop", "set", "add")
"""What a rule does with what it found, in this order: what is dropped makes room."""


class WrittenCondition(NamedTuple):
    """A comparison behind `where`, and its place."""

    comparison: Condition
    span: Span


class NegativePattern(NamedTuple):
    """What must not be there, with comparisons of its own."""

    pattern: ViewPattern
    where: tuple[WrittenCondition, ...]
    distinct: frozenset[str]
    """Its own variables that stand for components."""


class LetBinding(NamedTuple):
    """A variable and what it stands for: an expression, or a mapping or list with variables in it."""

    name: str
    value: Operand | Pattern
    is_expression: bool
    span: Span


class RuleEdit(NamedTuple):
    """What a rule writes: to components and types, by key."""

    kind: EditKind
    pattern: ViewPattern


class RewriteRule(NamedTuple):
    """A rule. `span` is where it begins."""

    find: ViewPattern
    unless: tuple[NegativePattern, ...]
    where: tuple[WrittenCondition, ...]
    let: tuple[LetBinding, ...]
    edits: tuple[RuleEdit, ...]
    distinct: frozenset[str]
    """The variables of `find` that stand for components, each for another one."""
    span: Span


class PatternPass(NamedTuple):
    """A pass file."""

    name: str
    title: str
    description: str
    rules: tuple[RewriteRule, ...]
    file: str
    needs: tuple[str, ...] = ()
    leaves: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()
