"""Parse YAML files into trees: values and spans in one walk over PyYAML's events.

PyYAML is used for its events only: its constructors would lose positions, allow duplicate keys and read YAML 1.1.
Speed matters here more than anywhere: the walk is one function with local names, and it compares types by identity.
"""

from __future__ import annotations

from sys import intern
from typing import TYPE_CHECKING, Any

import yaml

from archgen.diagnostics import Diagnostic, Span
from archgen.frozen import dataclass, field
from archgen.syntax import yaml_comments, yaml_errors
from archgen.syntax.yaml_tree import (
    NON_TEXT_STARTS,
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlDocument,
    copy_node,
    resolve_scalar,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from archgen.syntax.yaml_tree import YamlNode

MAX_VALUES = 1_000_000
"""How many values a file may hold. 10,000 components have about 400,000."""
MAX_EXPANDED = 100_000
"""How many of them may come from aliases: nested aliases multiply, ten lines can stand for billions of values."""
MAX_DEPTH = 64
"""How deep values may nest, which also bounds every recursion over a tree. The language needs 9, parameters more."""
_TOO_DEEP = f"values are nested deeper than {MAX_DEPTH}"
_LINE_BREAKS = "\x85\u2028\u2029"
"""Line breaks for libyaml but not for YAML 1.2 or editors: hidden from it, else all later line numbers would be off."""

HAS_LIBYAML = yaml.__with_libyaml__
"""Whether PyYAML was built with libyaml; without it the same events come from Python, thirty times slower."""


@dataclass(slots=True)
class _TreeWalk:
    """The state and result of parsing one file. `is_broken` means that nothing of the file is used."""

    file: str
    text: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    quoted_ranges: list[tuple[int, int]] = field(default_factory=list)
    root: YamlNode | None = None
    is_broken: bool = False

    def report_error(self, message: str, help_line: str | None, span: Span, rule: str = "syntax-error") -> None:
        """Report a mistake after which nothing of the file is used."""
        self.diagnostics.append(Diagnostic(rule, message, span, help=help_line))
        self.is_broken = True


def parse_yaml(file: str, text: str) -> tuple[YamlDocument | None, tuple[Diagnostic, ...]]:
    """Parse a file's text. A syntax error leaves no document; a duplicate key or recursive alias costs only itself."""
    # Before the parser runs: its own complaint about a conflict marker would be about something else entirely.
    conflicts = yaml_comments.find_merge_conflicts(file, text)
    if conflicts:
        return None, conflicts
    forbidden = yaml_errors.find_forbidden_character(file, text)
    if forbidden is not None:
        return None, (forbidden,)
    hidden_breaks = _hide_line_breaks(text)
    walk = _TreeWalk(file, hidden_breaks[0])
    _run_walk(walk, hidden_breaks[1])
    if walk.is_broken:
        return None, tuple(walk.diagnostics)
    root = _check_root(walk)
    ignores = (
        tuple(yaml_comments.read_ignore_comments(file, text, walk.quoted_ranges))
        if yaml_comments.may_hold_ignore_comments(text)
        else ()
    )
    return (YamlDocument(file, root, ignores) if root is not None else None), tuple(walk.diagnostics)


def list_comments(text: str) -> tuple[str, ...]:
    """Return the comments of a text, each from its `#` to the end of the line, in order."""
    hidden_breaks = _hide_line_breaks(text)
    walk = _TreeWalk("", hidden_breaks[0])
    # A broken text has the quoted ranges up to where it breaks.
    _run_walk(walk, hidden_breaks[1])
    return tuple(comment for _, comment in yaml_comments.find_comments(text, walk.quoted_ranges))


def _check_root(walk: _TreeWalk) -> MappingNode | None:
    root = walk.root
    if isinstance(root, MappingNode):
        return root
    if root is None or (isinstance(root, ScalarNode) and root.value is None):
        return MappingNode({}, Span.of_file(walk.file))
    kind = "a list" if isinstance(root, SequenceNode) else "text"
    help_line = "write sections: `groups:`, `nodes:`, `types:`, ..."
    walk.diagnostics.append(Diagnostic("wrong-type", f"the file is {kind}, not a mapping", root.span, help=help_line))
    return None


def _hide_line_breaks(text: str) -> tuple[str, dict[int, int]]:
    """Replace odd line breaks by private-use characters that the text does not hold; return it and the way back."""
    odd_breaks = [character for character in _LINE_BREAKS if character in text]
    if not odd_breaks:
        return text, {}
    spare_characters = (chr(code) for code in range(0xE000, 0xF8FF) if chr(code) not in text)
    replacements = dict(zip(odd_breaks, spare_characters, strict=False))
    return text.translate({ord(old): new for old, new in replacements.items()}), {
        ord(new): ord(old) for old, new in replacements.items()
    }


def _make_parser(text: str) -> Any:  # noqa: ANN401 - two classes that share nothing but their methods
    if HAS_LIBYAML:
        from yaml.cyaml import CParser  # type: ignore[attr-defined]

        return CParser(text)
    return yaml.Loader(text)


def list_events(text: str) -> Iterator[tuple[Any, int, int]]:
    """Yield PyYAML's events of a text that can be read, each with the offsets at which it begins and ends."""
    parser = _make_parser(_hide_line_breaks(text)[0])
    while not isinstance(event := parser.get_event(), yaml.StreamEndEvent):
        start, end = event.start_mark, event.end_mark
        yield event, start.index, end.index


def _run_walk(walk: _TreeWalk, restore: dict[int, int]) -> None:
    """Build the tree, and turn what the parser raises into a diagnostic."""
    try:
        _build_tree(walk, _make_parser(walk.text), restore)
    except yaml.MarkedYAMLError as error:
        # libyaml looks ahead: of very many brackets it refuses the thousandth before it tells of the first.
        if "nesting depth" in (error.problem or "") and error.problem_mark:
            line, column = error.problem_mark.line + 1, error.problem_mark.column + 1
            walk.report_error(_TOO_DEEP, None, Span(walk.file, line, column, line, column + 1), "too-large")
            return
        problem_mark, context_mark = error.problem_mark or error.context_mark, error.context_mark
        problem = yaml_errors.ParserProblem(
            error.problem or "",
            problem_mark.line if problem_mark else 0,
            problem_mark.column if problem_mark else 0,
            error.context or "",
            (context_mark.line, context_mark.column) if context_mark else None,
        )
        walk.diagnostics.append(yaml_errors.diagnose_problem(walk.file, walk.text, problem))
        walk.is_broken = True
    except (yaml.YAMLError, ValueError, OverflowError):  # the slow parser's, for escapes that name no character
        walk.report_error("a character or an escape that YAML does not know", None, Span.of_file(walk.file))


def _build_tree(walk: _TreeWalk, parser: Any, restore: dict[int, int]) -> None:  # noqa: ANN401, C901, PLR0911, PLR0912, PLR0915
    """Build the tree, event by event. One long loop on purpose: calls for each event would double its time."""
    # While a mapping is open, `entries` holds its entries and `items` is None; while a sequence is open it is the other
    # way round; at the root both are None. The state of the containers around waits on `stack`.
    next_event: Callable[[], Any] = parser.get_event
    file, source, report_error = walk.file, walk.text, walk.report_error
    scalar_event, mapping_start, mapping_end = yaml.ScalarEvent, yaml.MappingStartEvent, yaml.MappingEndEvent
    sequence_start, sequence_end, alias_event = yaml.SequenceStartEvent, yaml.SequenceEndEvent, yaml.AliasEvent
    new_tuple, non_text_starts, quoted_ranges = tuple.__new__, NON_TEXT_STARTS, walk.quoted_ranges
    # What only few files need is decided once here, not asked at every scalar: comments that may have swallowed text,
    # ignore comments, anchors, tags and hidden line breaks.
    hash_lines = yaml_comments.find_lines_with_hashes(source)
    notes_quoted = bool(hash_lines) or yaml_comments.may_hold_ignore_comments(source)
    has_rare = not HAS_LIBYAML or bool(restore) or "!" in source or "&" in source
    # Anchor -> value and the number of values in it; None while the value is still open (an alias to it is recursive).
    anchors: dict[str, tuple[YamlNode, int | None]] = {}
    stack: list[tuple[Any, ...]] = []
    entries: dict[str, MappingEntry] | None = None
    items: list[YamlNode] | None = None
    key, key_span, key_end, wants_key = "", Span.of_file(file), None, False
    value_count = expanded_count = document_count = line = column = 0
    value: YamlNode
    while True:
        event = next_event()
        kind = type(event)
        if kind is scalar_event:
            start, end, text = event.start_mark, event.end_mark, event.value
            line, column = end.line + 1, end.column + 1
            span = new_tuple(Span, (file, start.line + 1, start.column + 1, line, column))  # twice as fast as Span(...)
            style = event.style
            if has_rare:
                text = _read_rare_scalar(walk, event, span, restore)
            if notes_quoted:
                if style:
                    quoted_ranges.append((start.index, end.index))
                elif end.line in hash_lines and not wants_key and (not text or type(resolve_scalar(text)) is str):
                    walk.diagnostics.extend(
                        yaml_comments.find_swallowed_text(source, span, end.index, is_empty=not text)
                    )
            if wants_key:
                # The language has few keys, repeated thousands of times: interned, they are compared by identity.
                key, key_span, key_end, wants_key = intern(text), span, end, False
                if not text or (text == "<<" and not style):
                    report_error(*_BAD_KEYS[text], span)
                if has_rare and event.anchor is not None:
                    anchors[event.anchor] = (ScalarNode(text, text, span), 1)
                continue
            if style:
                value = ScalarNode(text, text, span, False)  # noqa: FBT003
            elif text:
                text = intern(text)  # types, units, names: most are written more than once
                value = ScalarNode(resolve_scalar(text) if text[0] in non_text_starts else text, text, span)
            else:
                value = ScalarNode(None, text, span)
                # In braces YAML reads `{a, b}` as two keys without values. `key_end` is the mark of the last key.
                if key_end is not None and items is None and ":" not in source[key_end.index : start.index]:
                    report_error(*yaml_errors.describe_missing_colon(key), key_span)
            value_count += 1
            if has_rare and event.anchor is not None:
                anchors[event.anchor] = (value, 1)
        elif kind is mapping_end or kind is sequence_end:
            start, end = event.start_mark, event.end_mark
            if end.index > start.index:  # a closing brace or bracket; without one it ends with what is last in it
                line, column = end.line + 1, end.column + 1
            entries, items, key, key_span, key_end, value, anchor, count_before = stack.pop()
            # So far the container's span covers its first character only; now its end is known.
            start_span, wants_key = value.span, False
            value.span = new_tuple(Span, (file, start_span.line, start_span.column, line, column))
            if anchor is not None:
                anchors[anchor] = (value, value_count - count_before + 1)
        elif kind is mapping_start or kind is sequence_start:
            start = event.start_mark
            span = new_tuple(Span, (file, start.line + 1, start.column + 1, start.line + 1, start.column + 2))
            if event.tag is not None:
                report_error(f"the tag `{event.tag}` is not read", "take it out", span)
            if wants_key:
                report_error(
                    "a key is a word, not a list or a mapping", "text in braces or brackets must be quoted", span
                )
                return
            if len(stack) >= MAX_DEPTH:
                report_error(_TOO_DEEP, None, span, "too-large")
                return
            value_count += 1
            anchor = event.anchor
            if kind is mapping_start:
                new_entries: dict[str, MappingEntry] = {}
                value = MappingNode(new_entries, span)
                stack.append((entries, items, key, key_span, key_end, value, anchor, value_count))
                entries, items, wants_key = new_entries, None, True
            else:
                new_items: list[YamlNode] = []
                value = SequenceNode(new_items, span)
                stack.append((entries, items, key, key_span, key_end, value, anchor, value_count))
                entries, items, wants_key = None, new_items, False
            if anchor is not None:
                anchors[anchor] = (value, None)
            continue
        elif kind is alias_event:
            start, end = event.start_mark, event.end_mark
            line, column = end.line + 1, end.column + 1
            span = new_tuple(Span, (file, start.line + 1, start.column + 1, line, column))
            if wants_key:
                report_error("an alias cannot be a key", "write the key out", span)
                return
            anchored, size = anchors.get(event.anchor, (None, 0))
            if anchored is None:
                report_error(
                    f"no anchor `&{event.anchor}` stands above", f"if it is text, {yaml_errors.QUOTE_HELP}", span
                )
                return
            if size is None:
                walk.diagnostics.append(yaml_errors.diagnose_recursive_alias(event.anchor, span, anchored.span))
                wants_key = entries is not None
                continue
            # Counted before it is copied: a file that multiplies its aliases is refused before it takes memory.
            value_count, expanded_count = value_count + size, expanded_count + size
            if expanded_count > MAX_EXPANDED:
                report_error(f"the file's aliases stand for more than {MAX_EXPANDED:,} values", None, span, "too-large")
                return
            value = copy_node(anchored, span)
        elif kind is yaml.DocumentStartEvent:
            document_count += 1
            if document_count > 1:
                mark = event.start_mark
                span = Span(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 4)
                report_error(
                    "a second YAML document begins here", "a file is one document: put the second into its own", span
                )
                return
            continue
        elif kind is yaml.StreamEndEvent:
            return
        else:
            continue
        if entries is not None:
            entry = MappingEntry(key, key_span, value)
            # The first of two equal keys stays, the second costs only itself.
            if entries.setdefault(key, entry) is not entry:
                walk.diagnostics.append(yaml_errors.diagnose_duplicate_key(key, key_span, entries[key].key_span))
            wants_key = True
        elif items is not None:
            items.append(value)
        else:
            walk.root = value
        if value_count > MAX_VALUES:
            report_error(f"the file holds more than {MAX_VALUES:,} values", "split it", value.span, "too-large")
            return


_BAD_KEYS = {
    "": ("a key is missing before `:`", "write `key: value`"),
    "<<": ("merge keys (`<<`) are not read", "write the keys out, or share a whole value with `*name`"),
}


def _read_rare_scalar(walk: _TreeWalk, event: Any, span: Span, restore: dict[int, int]) -> str:  # noqa: ANN401
    """Refuse a scalar's tag; return its text as it is in the file, with hidden line breaks put back."""
    if event.tag is not None:
        walk.report_error(
            f"the tag `{event.tag}` is not read", f"take it out; if it is text, {yaml_errors.QUOTE_HELP}", span
        )
    text: str = event.value
    if not HAS_LIBYAML and yaml_errors.LONE_SURROGATE.search(text):
        walk.report_error("an escape that names half a character", "write the whole character", span)
    return text.translate(restore) if restore else text
