"""What is wrong with a rule whatever the project: variables that nothing binds, and names that contradict one another."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.passes.patterns.expressions import Operand, list_operand_variables
from archgen.passes.patterns.matching import ViewPattern
from archgen.passes.patterns.pass_shapes import WRONG_PASS, LetBinding, RewriteRule
from archgen.passes.patterns.pattern_shapes import (
    Anything,
    Constant,
    ListPattern,
    MappingPattern,
    Pattern,
    PatternEntry,
    TextPattern,
    Variable,
    list_variables,
)


def check_rule(rule: RewriteRule) -> Iterator[Diagnostic]:
    """Yield what is wrong with the variables of a rule."""
    bound = dict.fromkeys(_list_view_variables(rule.find))
    yield from _check_kinds(rule.find)
    for let in rule.let:
        yield from _check_names(
            _list_let_variables(let), bound, let.span, "`let` comes behind `find`, from the top down"
        )
        if let.name in bound:
            yield _diagnose_rule(
                f"`${let.name}` is bound already: `let` gives it a second meaning", let.span, "choose another name"
            )
        bound[let.name] = None
    for written in rule.where:
        names = _list_comparison_variables(written.comparison.left, written.comparison.right)
        yield from _check_names(names, bound, written.span, "bind it in `find`")
    for negative in rule.unless:
        inner = {**bound, **dict.fromkeys(_list_view_variables(negative.pattern))}
        for written in negative.where:
            names = _list_comparison_variables(written.comparison.left, written.comparison.right)
            yield from _check_names(names, inner, written.span, "bind it in `find`, or beside this `where`")
    hidden = {name for each in rule.unless for name in _list_view_variables(each.pattern)} - bound.keys()
    for edit in rule.edits:
        for entry in (*edit.pattern.components, *edit.pattern.types):
            yield from _check_edit(entry, bound, hidden)
    yield from _check_contradictions(rule)


def _check_edit(entry: PatternEntry, bound: Iterable[str], hidden: set[str]) -> Iterator[Diagnostic]:
    for part, span in _list_parts(entry):
        if _holds_anything(part):
            yield _diagnose_rule("`$_` stands for anything, and cannot be written", span, "give it a name in `find`")
        for name in _list_own_variables(part):
            if name in hidden:
                message = f"`${name}` is bound in `unless` only: where the rule writes, there is none"
                yield _diagnose_rule(message, span, "bind it in `find`")
            elif name not in bound:
                yield _report_unbound(name, bound, span, "bind it in `find`, or with `let`")


def _list_parts(entry: PatternEntry) -> Iterator[tuple[Pattern, Span]]:
    yield entry.key, entry.span
    yield from _list_value_parts(entry.value, entry.span)


def _list_value_parts(value: Pattern, span: Span) -> Iterator[tuple[Pattern, Span]]:
    if isinstance(value, MappingPattern):
        for inner in value.entries:
            yield from _list_parts(inner)
    elif isinstance(value, ListPattern):
        for item in value.items:
            yield from _list_value_parts(item, span)
    else:
        yield value, span


def _holds_anything(part: Pattern) -> bool:
    if isinstance(part, Anything):
        return part.is_named
    return isinstance(part, TextPattern) and any(isinstance(each, Variable) and each.name == "_" for each in part.parts)


def _list_own_variables(part: Pattern) -> Iterator[str]:
    return list_variables(part)


def _check_names(names: Iterable[str], bound: Iterable[str], span: Span, help_line: str) -> Iterator[Diagnostic]:
    for name in dict.fromkeys(names):
        if name == "_":
            yield _diagnose_rule("`$_` stands for anything, and has no value", span, "give it a name in `find`")
        elif name not in bound:
            yield _report_unbound(name, bound, span, help_line)


def _check_kinds(find: ViewPattern) -> Iterator[Diagnostic]:
    """Report a variable that is to be a component and a conceptual type at once."""
    components = {e.key.name: e.span for e in find.components if isinstance(e.key, Variable)}
    for entry in find.types:
        if isinstance(entry.key, Variable) and entry.key.name in components:
            label = Label(components[entry.key.name], "a component")
            message = f"`${entry.key.name}` is a component and a conceptual type: nothing is both"
            yield Diagnostic(WRONG_PASS, message, entry.span, labels=(label,), help="use two variables")


def _check_contradictions(rule: RewriteRule) -> Iterator[Diagnostic]:
    """Report what a rule writes in two ways at the same place."""
    seen: dict[tuple[object, ...], tuple[str, Pattern, Span]] = {}
    for edit in rule.edits:
        for section, entries in (("components", edit.pattern.components), ("types", edit.pattern.types)):
            for entry in entries:
                for path, value, span in _list_leaves((section,), entry):
                    first = seen.setdefault(path, (edit.kind, value, span))
                    is_same_text = first[1] == value
                    if (
                        first[2] != span
                        and {first[0], edit.kind} != {"drop", "add"}
                        and not (is_same_text and first[0] == edit.kind)
                    ):
                        label = Label(first[2], f"`{first[0]}`")
                        message = f"`{edit.kind}` contradicts `{first[0]}` at the same place"
                        yield Diagnostic(
                            WRONG_PASS, message, span, labels=(label,), help="`set` alone replaces a value"
                        )


def _list_leaves(path: tuple[object, ...], entry: PatternEntry) -> Iterator[tuple[tuple[object, ...], Pattern, Span]]:
    here = (*path, _name_key(entry.key))
    if isinstance(entry.value, MappingPattern):
        for inner in entry.value.entries:
            yield from _list_leaves(here, inner)
    elif not isinstance(entry.value, ListPattern):
        yield here, entry.value, entry.span


def _name_key(key: Pattern) -> object:
    return str(key.text) if isinstance(key, Constant) else key


def _list_view_variables(pattern: ViewPattern) -> Iterator[str]:
    for entry in (*pattern.components, *pattern.types):
        yield from list_variables(entry.key)
        yield from list_variables(entry.value)


def _list_let_variables(let: LetBinding) -> Iterator[str]:
    if isinstance(let.value, (Anything, Variable, Constant, TextPattern, ListPattern, MappingPattern)):
        return list_variables(let.value)
    return list_operand_variables(let.value)


def _list_comparison_variables(left: Operand, right: Operand | None) -> Iterator[str]:
    yield from list_operand_variables(left)
    yield from list_operand_variables(right)


def _report_unbound(name: str, bound: Iterable[str], span: Span, help_line: str) -> Diagnostic:
    guess = did_you_mean(f"${name}", [f"${each}" for each in bound])
    return _diagnose_rule(f"nothing binds `${name}`", span, guess or help_line)


def _diagnose_rule(message: str, span: Span, help_line: str | None = None) -> Diagnostic:
    return Diagnostic(WRONG_PASS, message, span, help=help_line)
