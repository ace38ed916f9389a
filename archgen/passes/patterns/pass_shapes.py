"""A pass that is written as rules: what each finds, compares, names and writes."""

from __future__ import annotations

from typing import Literal, NamedTuple

from archgen.diagnostics.diagnostic import Rule, Severity
from archgen.diagnostics.source_span import Span
from archgen.passes.patterns.expressions import Comparison, Operand
from archgen.passes.patterns.matching import ViewPattern
from archgen.passes.patterns.pattern_shapes import Pattern

PASS_ERROR_RULE = Rule(
    "pass-error",
    Severity.ERROR,
    "A pass that is written as rules cannot be read, or comes to no end.\n\n"
    "Why: a pass of a project is a file in `passes/` with rules: what each finds, and what it writes there. Where a rule "
    "names a variable that nothing binds, asks for what there is not, changes nothing that it finds, or finds something "
    "again and again, nothing is made of the project.",
    fixed=True,
)
EditKind = Literal["add", "set", "drop"]
EDIT_KINDS: tuple[EditKind, ...] = ("drop", "set", "add")
"""What a rule does with what it found, in this order: what is dropped makes room."""


class WrittenComparison(NamedTuple):
    """A comparison behind `where`, and its place."""

    comparison: Comparison
    span: Span


class NegativePattern(NamedTuple):
    """What must not be there, with comparisons of its own."""

    pattern: ViewPattern
    where: tuple[WrittenComparison, ...]
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
    where: tuple[WrittenComparison, ...]
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
