"""Read one rule of a pass file: its patterns, comparisons and names, each mistake with its place and what to do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.diagnostics import Diagnostic, Label, Span, did_you_mean
from archgen.passes.patterns.expressions import (
    EDIT_KINDS,
    OPERANDS,
    WRONG_PASS,
    ExpressionError,
    LetBinding,
    NegativePattern,
    RewriteRule,
    RuleEdit,
    WrittenCondition,
    diagnose_pass,
    list_operand_variables,
    parse_let_value,
    parse_where_condition,
)
from archgen.passes.patterns.matching import COMPONENTS, SectionEntry, ViewPattern
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
    parse_text_pattern,
)
from archgen.passes.patterns.view_values import VIEW_KEYS, check_view_keys, list_crossed_words, name_element
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlNode,
    find_value,
    list_spans,
)


def _check_rule(rule: RewriteRule) -> Iterator[Diagnostic]:
    """Yield what is wrong with the variables of a rule."""
    bound = dict.fromkeys(_list_view_variables(rule.find))
    yield from _check_kinds(rule.find)
    for let in rule.let:
        yield from _check_names(
            _list_let_variables(let), bound, let.span, "`let` comes behind `find`, from the top down"
        )
        if let.name in bound:
            yield diagnose_pass(
                f"`${let.name}` is bound already: `let` gives it a second meaning", let.span, "choose another name"
            )
        bound[let.name] = None
    for written in rule.where:
        yield from _check_names(_list_comparison_variables(written), bound, written.span, "bind it in `find`")
    for negative in rule.unless:
        inner = {**bound, **dict.fromkeys(_list_view_variables(negative.pattern))}
        for written in negative.where:
            names = _list_comparison_variables(written)
            yield from _check_names(names, inner, written.span, "bind it in `find`, or beside this `where`")
    hidden = {name for each in rule.unless for name in _list_view_variables(each.pattern)} - bound.keys()
    for edit in rule.edits:
        for _, entry in edit.pattern.entries:
            yield from _check_edit(entry, bound, hidden)
    yield from _check_contradictions(rule)


def _check_edit(entry: PatternEntry, bound: Iterable[str], hidden: set[str]) -> Iterator[Diagnostic]:
    for part, span in _list_parts(entry):
        if _holds_anything(part):
            yield diagnose_pass("`$_` stands for anything, and cannot be written", span, "give it a name in `find`")
        for name in list_variables(part):
            if name in hidden:
                message = f"`${name}` is bound in `unless` only: where the rule writes, there is none"
                yield diagnose_pass(message, span, "bind it in `find`")
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


def _check_names(names: Iterable[str], bound: Iterable[str], span: Span, help_line: str) -> Iterator[Diagnostic]:
    for name in dict.fromkeys(names):
        if name == "_":
            yield diagnose_pass("`$_` stands for anything, and has no value", span, "give it a name in `find`")
        elif name not in bound:
            yield _report_unbound(name, bound, span, help_line)


def _check_kinds(find: ViewPattern) -> Iterator[Diagnostic]:
    """Report a variable that is to be in two sections at once."""
    first_places: dict[str, tuple[str, Span]] = {}
    for section, entry in find.entries:
        if not isinstance(entry.key, Variable):
            continue
        first, span = first_places.setdefault(entry.key.name, (section, entry.span))
        if first != section:
            label = Label(span, name_element(first))
            message = f"`${entry.key.name}` is {name_element(first)} and {name_element(section)}: nothing is both"
            yield Diagnostic(WRONG_PASS, message, entry.span, labels=(label,), help="use two variables")


def _check_contradictions(rule: RewriteRule) -> Iterator[Diagnostic]:
    """Report what a rule writes in two ways at the same place."""
    seen: dict[tuple[object, ...], tuple[str, Pattern, Span]] = {}
    for edit in rule.edits:
        for section, entry in edit.pattern.entries:
            for path, value, span in _list_leaves((section,), entry):
                first = seen.setdefault(path, (edit.kind, value, span))
                is_same_edit = first[1] == value and first[0] == edit.kind
                if first[2] != span and {first[0], edit.kind} != {"drop", "add"} and not is_same_edit:
                    label = Label(first[2], f"`{first[0]}`")
                    message = f"`{edit.kind}` contradicts `{first[0]}` at the same place"
                    yield Diagnostic(WRONG_PASS, message, span, labels=(label,), help="`set` alone replaces a value")


def _list_leaves(path: tuple[object, ...], entry: PatternEntry) -> Iterator[tuple[tuple[object, ...], Pattern, Span]]:
    here = (*path, (str(entry.key.text) if isinstance(entry.key, Constant) else entry.key))
    if isinstance(entry.value, MappingPattern):
        for inner in entry.value.entries:
            yield from _list_leaves(here, inner)
    elif not isinstance(entry.value, ListPattern):
        yield here, entry.value, entry.span


def _list_view_variables(pattern: ViewPattern) -> Iterator[str]:
    for _, entry in pattern.entries:
        yield from list_variables(entry.key)
        yield from list_variables(entry.value)


def _list_let_variables(let: LetBinding) -> Iterator[str]:
    if isinstance(let.value, OPERANDS):
        return list_operand_variables(let.value)
    return list_variables(let.value)


def _list_comparison_variables(written: WrittenCondition) -> Iterator[str]:
    yield from list_operand_variables(written.comparison.left)
    yield from list_operand_variables(written.comparison.right)


def _report_unbound(name: str, bound: Iterable[str], span: Span, help_line: str) -> Diagnostic:
    guess = did_you_mean(f"${name}", [f"${each}" for each in bound])
    return diagnose_pass(f"nothing binds `${name}`", span, guess or help_line)


RULE_KEYS = ("title", "find", "unless", "where", "let", "add", "set", "drop")
MAX_PATTERN_DEPTH = 30
MAX_PATTERN_VALUES = 300
"""So many keys and values a pattern of `find` or `unless` may have: each is looked for inside of the one before it."""


class RuleReader:
    """Reads rules; what is wrong with them goes to `diagnostics`."""

    def __init__(self) -> None:
        self.diagnostics: list[Diagnostic] = []

    def read_rule(self, node: YamlNode) -> RewriteRule | None:
        """Return a rule, None where something is wrong with it."""
        count = len(self.diagnostics)
        if not isinstance(node, MappingNode):
            self._report("a rule is a mapping with `find` and what it writes", node.span)
            return None
        self.refuse_unknown_keys(node, RULE_KEYS, "a rule")
        find_entry = node.entries.get("find")
        if find_entry is None:
            help_line = "write what it looks for: `find: {components: {$c: {...}}}`"
            self._report("a rule without `find` finds nothing", _first_place(node), help_line)
            return None
        find = self._read_view(find_entry.value, "find")
        unless = tuple(self._read_unless(node.get("unless")))
        where = tuple(self._read_where(node.get("where")))
        let = tuple(self._read_let(node.entries.get("let")))
        edits = tuple(
            RuleEdit(kind, self._read_view(node.entries[kind].value, kind))
            for kind in EDIT_KINDS
            if kind in node.entries
        )
        if not edits:
            help_line = "write `add`, `set` or `drop`"
            self._report("a rule that changes nothing that it finds comes to no end", find_entry.key_span, help_line)
        rule = RewriteRule(find, unless, where, let, edits, _list_distinct(find), find_entry.key_span)
        if len(self.diagnostics) == count:
            self.diagnostics += _check_rule(rule)
        return rule if len(self.diagnostics) == count else None

    def refuse_unknown_keys(self, node: MappingNode, known_keys: Sequence[str], subject: str) -> None:
        """Report keys that mean nothing."""
        for entry in node:
            if entry.key not in known_keys:
                help_line = (
                    did_you_mean(entry.key, known_keys) or f"{subject} has {', '.join(f'`{k}`' for k in known_keys)}"
                )
                self._report(f"`{entry.key}` is no key of {subject}", entry.key_span, help_line)

    def _read_view(self, node: YamlNode, key: str) -> ViewPattern:
        if not isinstance(node, MappingNode) or not node.entries:
            self._report(f"`{key}` is a mapping with `components`, `types`, `nodes`, ...", node.span)
            return ViewPattern()
        count = 0 if key in EDIT_KINDS else sum(1 for _ in list_spans(node))
        if count > MAX_PATTERN_VALUES:
            message = f"`{key}` has {count:,} keys and values; at most {MAX_PATTERN_VALUES} are looked for"
            self._report(message, _first_place(node), "write several rules")
            return ViewPattern()
        self.refuse_unknown_keys(node, (*VIEW_KEYS, "where") if key == "unless" else VIEW_KEYS, f"`{key}`")
        self.diagnostics += check_view_keys(node, is_edit=key in EDIT_KINDS)
        entries = (
            (section, each) for section in VIEW_KEYS for each in self._read_elements(node.entries.get(section), key)
        )
        return ViewPattern(tuple(SectionEntry(section, each) for section, each in entries))

    def _read_elements(self, section: MappingEntry | None, key: str) -> Iterator[PatternEntry]:
        if section is None:
            return
        if not isinstance(section.value, MappingNode) or not section.value.entries:
            message = f"`{section.key}` is a mapping: a path or a variable, and what is there"
            self._report(message, section.key_span, f"as in `{section.key}: {{$x: {{...}}}}`")
            return
        for entry in section.value:
            pattern_key = parse_text_pattern(entry.key, entry.key, entry.key_span)
            if isinstance(pattern_key, Anything) and key in EDIT_KINDS:
                self._report("`$_` stands for anything: nobody knows where to write", entry.key_span)
            yield PatternEntry(
                pattern_key, self.read_pattern(list_crossed_words(section.key, entry.value)), entry.key_span
            )

    def read_pattern(self, node: YamlNode, depth: int = 0) -> Pattern:
        """Return the pattern that a tree is."""
        if depth > MAX_PATTERN_DEPTH:
            self._report(f"a pattern of more than {MAX_PATTERN_DEPTH} levels", node.span)
            return Anything()
        if isinstance(node, MappingNode):
            entries = (
                PatternEntry(
                    parse_text_pattern(entry.key, entry.key, entry.key_span),
                    self.read_pattern(entry.value, depth + 1),
                    entry.key_span,
                )
                for entry in node
            )
            return MappingPattern(tuple(entries))
        if isinstance(node, SequenceNode):
            return ListPattern(tuple(self.read_pattern(item, depth + 1) for item in node.items))
        if node.value is None:
            return Anything()
        text = str(node.value).lower() if isinstance(node.value, bool) else node.text
        return parse_text_pattern(text, node.value, node.span)

    def _read_unless(self, node: YamlNode | None) -> Iterator[NegativePattern]:
        for item in list_items(node):
            pattern = self._read_view(item, "unless")
            where = find_value(item, "where")
            yield NegativePattern(pattern, tuple(self._read_where(where)), _list_distinct(pattern))

    def _read_where(self, node: YamlNode | None) -> Iterator[WrittenCondition]:
        for item in list_items(node):
            if not isinstance(item, ScalarNode) or item.value is None:
                self._report("`where` is a comparison, or a list of them", item.span, "as in `where: $type != Pose`")
                continue
            try:
                yield WrittenCondition(parse_where_condition(item.text), item.span)
            except ExpressionError as error:
                self._report(str(error), item.span, error.help_line)

    def _read_let(self, section: MappingEntry | None) -> Iterator[LetBinding]:
        if section is None:
            return
        if not isinstance(section.value, MappingNode) or not section.value.entries:
            self._report("`let` is a mapping: variables and what they stand for", section.key_span)
            return
        for entry in section.value:
            key = parse_text_pattern(entry.key, entry.key, entry.key_span)
            if not isinstance(key, Variable):
                self._report(f"`{entry.key}` is no variable", entry.key_span, f"write `${entry.key.strip('$')}`")
                continue
            if not isinstance(entry.value, ScalarNode):
                yield LetBinding(key.name, self.read_pattern(entry.value), is_expression=False, span=entry.key_span)
                continue
            try:
                yield LetBinding(key.name, parse_let_value(entry.value.text), is_expression=True, span=entry.key_span)
            except ExpressionError as error:
                self._report(str(error), entry.value.span, error.help_line)

    def _report(self, message: str, span: Span, help_line: str | None = None) -> None:
        self.diagnostics.append(diagnose_pass(message, span, help_line))


def list_items(node: YamlNode | None) -> list[YamlNode]:
    """Return the items of a list; what is no list is the only one, and nothing none."""
    return node.items if isinstance(node, SequenceNode) else [] if node is None else [node]


def _list_distinct(pattern: ViewPattern) -> frozenset[str]:
    keys = [entry.key for section, entry in pattern.entries if section == COMPONENTS]
    return frozenset(key.name for key in keys if isinstance(key, Variable))


def _first_place(node: MappingNode) -> Span:
    return next((entry.key_span for entry in node), node.span)
