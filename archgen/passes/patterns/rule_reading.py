"""Read one rule of a pass file: its patterns, comparisons and names, each mistake with its place and what to do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.passes.patterns.expressions import ExpressionError, parse_let_value, parse_where_condition
from archgen.passes.patterns.matching import ViewPattern
from archgen.passes.patterns.pass_shapes import (
    EDIT_KINDS,
    WRONG_PASS,
    LetBinding,
    NegativePattern,
    RewriteRule,
    RuleEdit,
    WrittenCondition,
)
from archgen.passes.patterns.pattern_shapes import (
    Anything,
    ListPattern,
    MappingPattern,
    Pattern,
    PatternEntry,
    Variable,
    parse_text_pattern,
)
from archgen.passes.patterns.rule_checks import check_rule
from archgen.passes.patterns.view_words import check_view_keys
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode, list_spans

RULE_KEYS = ("title", "find", "unless", "where", "let", "add", "set", "drop")
VIEW_KEYS = ("components", "types")
MAX_PATTERN_DEPTH = 30
MAX_PATTERN_VALUES = 300
"""So many keys and values a pattern of `find` or `unless` may have: each is looked for inside of the one before it."""


class RuleReader:
    """Reads rules; what is wrong with them goes to `diagnostics`."""

    def __init__(self) -> None:
        """Start with nothing wrong."""
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
            self.diagnostics += check_rule(rule)
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
            self._report(f"`{key}` is a mapping with `components` or `types`", node.span)
            return ViewPattern()
        count = 0 if key in EDIT_KINDS else sum(1 for _ in list_spans(node))
        if count > MAX_PATTERN_VALUES:
            message = f"`{key}` has {count:,} keys and values; at most {MAX_PATTERN_VALUES} are looked for"
            self._report(message, _first_place(node), "write several rules")
            return ViewPattern()
        self.refuse_unknown_keys(node, (*VIEW_KEYS, "where") if key == "unless" else VIEW_KEYS, f"`{key}`")
        self.diagnostics += check_view_keys(node, is_edit=key in EDIT_KINDS)
        return ViewPattern(*(tuple(self._read_elements(node.entries.get(section), key)) for section in VIEW_KEYS))

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
            yield PatternEntry(pattern_key, self.read_pattern(entry.value), entry.key_span)

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
        items = node.items if isinstance(node, SequenceNode) else [] if node is None else [node]
        for item in items:
            pattern = self._read_view(item, "unless")
            where = item.get("where") if isinstance(item, MappingNode) else None
            yield NegativePattern(pattern, tuple(self._read_where(where)), _list_distinct(pattern))

    def _read_where(self, node: YamlNode | None) -> Iterator[WrittenCondition]:
        items = node.items if isinstance(node, SequenceNode) else [] if node is None else [node]
        for item in items:
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
        self.diagnostics.append(Diagnostic(WRONG_PASS, message, span, help=help_line))


def _list_distinct(pattern: ViewPattern) -> frozenset[str]:
    return frozenset(entry.key.name for entry in pattern.components if isinstance(entry.key, Variable))


def _first_place(node: MappingNode) -> Span:
    return next((entry.key_span for entry in node), node.span)
