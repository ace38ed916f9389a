"""YAML files become trees: data and places in one walk over the parser's events.

Speed matters here more than anywhere: the walk is one function with local names, and it compares types by identity.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from sys import intern
from typing import TYPE_CHECKING, Any

import yaml

from archgen.diagnostic import Diagnostic, Label
from archgen.source import Span
from archgen.syntax import comments, mistakes
from archgen.syntax.scalars import STARTS, resolve
from archgen.syntax.tree import Document, Entry, Listing, Scalar, Table

if TYPE_CHECKING:
    from collections.abc import Callable

    from archgen.syntax.tree import Value

MAX_VALUES = 1_000_000
"""How many values a file may hold, anchors expanded. 10,000 components have about 400,000."""
MAX_DEPTH = 64
"""How deep values may nest. The language itself needs 9; the rest is for parameters."""
_LINE_BREAKS = "\x85\u2028\u2029"
"""Line breaks for libyaml, but not for YAML 1.2, editors or us: they are hidden from it."""

try:
    from yaml._yaml import CParser as _Parser

    FAST = True
except ImportError:  # PyYAML was built without libyaml
    _Parser = yaml.Loader
    FAST = False


@dataclass(slots=True)
class _Walk:
    """What one walk found. `open` are the anchors of values that are not complete yet."""

    file: str
    text: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    quoted: list[tuple[int, int]] = field(default_factory=list)
    root: Value | None = None
    broken: bool = False

    def fault(self, message: str, at: Span, help_line: str | None = None, rule: str = "syntax-error") -> None:
        """Note a mistake after which nothing of the file is used."""
        self.diagnostics.append(Diagnostic(rule, message, at, help=help_line))
        self.broken = True


def parse(file: str, text: str) -> tuple[Document | None, tuple[Diagnostic, ...]]:
    """Read a file's text. Where it has a syntax error there is no document; a wrong key or alias costs only itself."""
    conflicts = comments.conflicts(file, text)
    if conflicts:
        return None, conflicts
    wrong = None if text.isascii() and text.isprintable() else mistakes.forbidden_character(file, text)
    if wrong is not None:
        return None, (wrong,)
    hidden = _hide_line_breaks(text)
    walk = _Walk(file, hidden[0])
    _run(walk, hidden[1])
    if walk.broken:
        return None, tuple(walk.diagnostics)
    root = _root(walk)
    ignores = tuple(comments.ignores(file, text, walk.quoted)) if comments.may_hold_ignores(text) else ()
    return (Document(file, root, ignores) if root is not None else None), tuple(walk.diagnostics)


def _root(walk: _Walk) -> Table | None:
    root = walk.root
    if isinstance(root, Table):
        return root
    if root is None or (isinstance(root, Scalar) and root.value is None):
        return Table({}, Span.of_file(walk.file))
    kind = "a list" if isinstance(root, Listing) else "a text"
    help_line = "write sections: `groups:`, `nodes:`, `types:`, ..."
    walk.diagnostics.append(Diagnostic("wrong-type", f"the file is {kind}, not a mapping", root.at, help=help_line))
    return None


def _hide_line_breaks(text: str) -> tuple[str, dict[int, int]]:
    """Put characters that the text does not hold in the place of odd line breaks; give the way back."""
    odd = [character for character in _LINE_BREAKS if character in text]
    if not odd:
        return text, {}
    spare = (chr(code) for code in range(0xE000, 0xF8FF) if chr(code) not in text)
    pairs = dict(zip(odd, spare, strict=False))
    return text.translate(str.maketrans(pairs)), {ord(new): ord(old) for old, new in pairs.items()}


def _run(walk: _Walk, restore: dict[int, int]) -> None:
    """Walk, and turn what the parser raises into a diagnostic."""
    try:
        _walk(walk, _Parser(walk.text), restore)
    except yaml.MarkedYAMLError as error:
        mark, begun = error.problem_mark or error.context_mark, error.context_mark
        problem = mistakes.Problem(
            error.problem or "",
            mark.line if mark else 0,
            mark.column if mark else 0,
            error.context or "",
            (begun.line, begun.column) if begun else None,
        )
        walk.diagnostics.append(mistakes.explain(walk.file, walk.text, problem))
        walk.broken = True
    except (yaml.YAMLError, ValueError, OverflowError):  # the slow parser's, for escapes that name no character
        walk.fault("a character or an escape that YAML does not know", Span.of_file(walk.file))


def _walk(walk: _Walk, parser: Any, restore: dict[int, int]) -> None:  # noqa: ANN401, C901, PLR0912, PLR0915
    get: Callable[[], Any] = parser.get_event
    file, source, fault = walk.file, walk.text, walk.fault
    scalar_event, mapping_start, mapping_end = yaml.ScalarEvent, yaml.MappingStartEvent, yaml.MappingEndEvent
    sequence_start, sequence_end, alias_event = yaml.SequenceStartEvent, yaml.SequenceEndEvent, yaml.AliasEvent
    new, starts, note = tuple.__new__, STARTS, walk.quoted if comments.may_hold_ignores(source) else None
    hashes = comments.lines_with_hashes(source)
    anchors: dict[str, tuple[Value, int | None]] = {}
    stack: list[tuple[Any, ...]] = []
    entries: dict[str, Entry] | None = None
    items: list[Value] | None = None
    key: str | None = None
    key_at = Span.of_file(file)
    key_end = count = documents = line = column = 0
    value: Value
    while True:
        event = get()
        kind = type(event)
        if kind is scalar_event:
            text, start, end = event.value, event.start_mark, event.end_mark
            line, column = end.line + 1, end.column + 1
            at = new(Span, (file, start.line + 1, start.column + 1, line, column))  # twice as fast as Span(...)
            style = event.style
            if restore:
                text = text.translate(restore)
            if style:
                if note is not None:
                    note.append((start.index, end.index))
            elif hashes and end.line in hashes:
                stop = comments.swallowed(source, end.index, empty=not text)
                if stop is not None and (not text or not (entries is not None and key is None)):
                    walk.diagnostics.append(_swallowed(at, stop - end.index, source[end.index : stop]))
            if event.tag is not None:
                fault(f"the tag `{event.tag}` is not read", at, f"take it out; if it is text, {mistakes.QUOTE}")
            if entries is not None and key is None:
                key, key_at, key_end = intern(text), at, end.index
                if not style:
                    if not text:
                        fault("a key is missing before this `:`", at)
                    elif text == "<<":
                        fault("merge keys (`<<`) are not read", at, "write the keys out, or share whole values with `*name`")
                if event.anchor is not None:
                    anchors[event.anchor] = (Scalar(text, text, at), 1)
                continue
            if style:
                value = Scalar(text, text, at, False)  # noqa: FBT003
            elif not text:
                if entries is not None and ":" not in source[key_end : start.index]:
                    fault(f"the key `{key}` has no `:`", key_at, "write `key: value`; a list stands in brackets: [a, b]")
                value = Scalar(None, text, at)
            else:
                value = Scalar(resolve(text) if text[0] in starts else text, text, at)
            count += 1
            if event.anchor is not None:
                anchors[event.anchor] = (value, 1)
        elif kind is mapping_end or kind is sequence_end:
            if kind is mapping_end and event.end_mark.index > event.start_mark.index:  # a closing brace
                line, column = event.end_mark.line + 1, event.end_mark.column + 1
            elif kind is sequence_end and event.end_mark.index > event.start_mark.index:
                line, column = event.end_mark.line + 1, event.end_mark.column + 1
            entries, items, key, key_at, key_end, value, anchor, before = stack.pop()
            value.at = new(Span, (file, value.at.line, value.at.column, line, column))
            if anchor is not None:
                anchors[anchor] = (value, count - before + 1)
        elif kind is mapping_start or kind is sequence_start:
            start = event.start_mark
            at = new(Span, (file, start.line + 1, start.column + 1, start.line + 1, start.column + 1))
            if event.tag is not None:
                fault(f"the tag `{event.tag}` is not read", at, "take it out")
            if entries is not None and key is None:
                fault("a key is a word, not a list or a mapping", at, "text in braces or brackets must be quoted")
                return
            if len(stack) >= MAX_DEPTH:
                fault(f"values are nested deeper than {MAX_DEPTH}", at, None, "too-large")
                return
            count += 1
            value = Table({}, at) if kind is mapping_start else Listing([], at)
            stack.append((entries, items, key, key_at, key_end, value, event.anchor, count))
            if event.anchor is not None:
                anchors[event.anchor] = (value, None)
            if isinstance(value, Table):
                entries, items, key = value.entries, None, None
            else:
                entries, items = None, value.items
            continue
        elif kind is alias_event:
            start, end = event.start_mark, event.end_mark
            line, column = end.line + 1, end.column + 1
            at = new(Span, (file, start.line + 1, start.column + 1, line, column))
            if entries is not None and key is None:
                fault("an alias cannot be a key", at, "write the key out")
                return
            held, size = anchors.get(event.anchor, (None, 0))
            if held is None:
                fault(f"no anchor `&{event.anchor}` stands above", at, f"if it is text, {mistakes.QUOTE}")
                return
            if size is None:
                label = Label(Span(file, held.at.line, held.at.column, held.at.line, held.at.column + 1), "begins here")
                message = f"`*{event.anchor}` stands inside of what it stands for"
                walk.diagnostics.append(Diagnostic("recursive-alias", message, at, labels=(label,)))
                if entries is not None:
                    key = None
                continue
            if count + size > MAX_VALUES:
                fault(f"with its aliases expanded the file holds more than {MAX_VALUES:,} values", at, None, "too-large")
                return
            count += size
            value = copy_of(held, at)
        elif kind is yaml.DocumentStartEvent:
            documents += 1
            if documents > 1:
                mark = event.start_mark
                at = Span(file, mark.line + 1, mark.column + 1, event.end_mark.line + 1, event.end_mark.column + 1)
                fault("a second YAML document begins here", at, "a file is one document: put the second into a file of its own")
                return
            continue
        elif kind is yaml.StreamEndEvent:
            return
        else:
            continue
        if count > MAX_VALUES:
            fault(f"the file holds more than {MAX_VALUES:,} values", value.at, "split it", "too-large")
            return
        if entries is not None:
            if key in entries:
                label = Label(entries[key].at, "first written here")
                message = f"the key `{key}` is written twice"
                walk.diagnostics.append(Diagnostic("duplicate-key", message, key_at, labels=(label,)))
            elif key is not None:
                entries[key] = Entry(key, key_at, value)
            key = None
        elif items is not None:
            items.append(value)
        else:
            walk.root = value


def copy_of(value: Value, at: Span) -> Value:
    """Copy a value for one more place, so that nobody who changes one of them changes the other."""
    if isinstance(value, Scalar):
        return Scalar(value.value, value.text, at, value.plain)
    if isinstance(value, Listing):
        return Listing([copy_of(item, item.at) for item in value.items], at)
    return Table({e.key: Entry(e.key, e.at, copy_of(e.value, e.value.at)) for e in value}, at)


def _swallowed(at: Span, length: int, comment: str) -> Diagnostic:
    blanks = len(comment) - len(comment.lstrip())
    span = Span(at.file, at.end_line, at.end_column + blanks, at.end_line, at.end_column + length)
    message = f"`{comment.strip()}` is a comment, not part of the text"
    help_line = "quote the whole text if it belongs to it; write `# ` with a blank if it is a comment"
    return Diagnostic("swallowed-text", message, span, help=help_line)
