"""Parse YAML files into trees: values and spans in one walk over PyYAML's events.

PyYAML is used for its events only: its constructors would lose positions, allow duplicate keys and read YAML 1.1.
Speed matters here more than anywhere: the walk is one function with local names, and it compares types by identity.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from sys import intern
from typing import TYPE_CHECKING, Any

import yaml

from archgen.diagnostic import Diagnostic
from archgen.source import Span
from archgen.syntax import comments, mistakes
from archgen.syntax.scalars import STARTS, resolve
from archgen.syntax.tree import Document, Entry, Listing, Scalar, Table

if TYPE_CHECKING:
    from collections.abc import Callable

    from archgen.syntax.tree import Value

MAX_VALUES = 1_000_000
"""How many values a file may hold. 10,000 components have about 400,000."""
MAX_EXPANDED = 100_000
"""How many of them may come from aliases: nested aliases multiply, ten lines can stand for billions of values."""
MAX_DEPTH = 64
"""How deep values may nest, which also bounds every recursion over a tree. The language needs 9, parameters more."""
_LINE_BREAKS = "\x85\u2028\u2029"
"""Line breaks for libyaml but not for YAML 1.2 or editors: hidden from it, else all later line numbers would be off."""

FAST = yaml.__with_libyaml__
"""Whether PyYAML was built with libyaml; without it the same events come from Python, thirty times slower."""


@dataclass(slots=True)
class _Walk:
    """The state and result of parsing one file. `is_broken` means that nothing of the file is used."""

    file: str
    text: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    quoted: list[tuple[int, int]] = field(default_factory=list)
    root: Value | None = None
    broken: bool = False

    def fault(self, message: str, help_line: str | None, at: Span, rule: str = "syntax-error") -> None:
        """Report a mistake after which nothing of the file is used."""
        self.diagnostics.append(Diagnostic(rule, message, at, help=help_line))
        self.broken = True


def parse(file: str, text: str) -> tuple[Document | None, tuple[Diagnostic, ...]]:
    """Parse a file's text. A syntax error leaves no document; a duplicate key or recursive alias costs only itself."""
    # Before the parser runs: its own complaint about a conflict marker would be about something else entirely.
    conflicts = comments.conflicts(file, text)
    if conflicts:
        return None, conflicts
    wrong = mistakes.forbidden_character(file, text)
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
    kind = "a list" if isinstance(root, Listing) else "text"
    help_line = "write sections: `groups:`, `nodes:`, `types:`, ..."
    walk.diagnostics.append(Diagnostic("wrong-type", f"the file is {kind}, not a mapping", root.at, help=help_line))
    return None


def _hide_line_breaks(text: str) -> tuple[str, dict[int, int]]:
    """Replace odd line breaks by private-use characters that the text does not hold; return it and the way back."""
    odd = [character for character in _LINE_BREAKS if character in text]
    if not odd:
        return text, {}
    spare = (chr(code) for code in range(0xE000, 0xF8FF) if chr(code) not in text)
    pairs = dict(zip(odd, spare, strict=False))
    return text.translate({ord(old): new for old, new in pairs.items()}), {
        ord(new): ord(old) for old, new in pairs.items()
    }


def _parser(text: str) -> Any:  # noqa: ANN401 - two classes that share nothing but their methods
    if FAST:
        from yaml.cyaml import CParser  # type: ignore[attr-defined]

        return CParser(text)
    return yaml.Loader(text)


def _run(walk: _Walk, restore: dict[int, int]) -> None:
    """Build the tree, and turn what the parser raises into a diagnostic."""
    try:
        _walk(walk, _parser(walk.text), restore)
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
        walk.fault("a character or an escape that YAML does not know", None, Span.of_file(walk.file))


def _walk(walk: _Walk, parser: Any, restore: dict[int, int]) -> None:  # noqa: ANN401, C901, PLR0911, PLR0912, PLR0915
    """Build the tree, event by event. One long loop on purpose: calls for each event would double its time."""
    # While a mapping is open, `entries` holds its entries and `items` is None; while a sequence is open it is the other
    # way round; at the root both are None. The state of the containers around waits on `stack`.
    get: Callable[[], Any] = parser.get_event
    file, source, fault = walk.file, walk.text, walk.fault
    scalar_event, mapping_start, mapping_end = yaml.ScalarEvent, yaml.MappingStartEvent, yaml.MappingEndEvent
    sequence_start, sequence_end, alias_event = yaml.SequenceStartEvent, yaml.SequenceEndEvent, yaml.AliasEvent
    new, starts, quoted = tuple.__new__, STARTS, walk.quoted
    # What only few files need is decided once here, not asked at every scalar: comments that may have swallowed text,
    # ignore comments, anchors, tags and hidden line breaks.
    hashes = comments.lines_with_hashes(source)
    note = bool(hashes) or comments.may_hold_ignores(source)
    rare = not FAST or bool(restore) or "!" in source or "&" in source
    # Anchor -> value and the number of values in it; None while the value is still open (an alias to it is recursive).
    anchors: dict[str, tuple[Value, int | None]] = {}
    stack: list[tuple[Any, ...]] = []
    entries: dict[str, Entry] | None = None
    items: list[Value] | None = None
    key, key_at, key_end, wants_key = "", Span.of_file(file), None, False
    count = expanded = documents = line = column = 0
    value: Value
    while True:
        event = get()
        kind = type(event)
        if kind is scalar_event:
            start, end, text = event.start_mark, event.end_mark, event.value
            line, column = end.line + 1, end.column + 1
            at = new(Span, (file, start.line + 1, start.column + 1, line, column))  # twice as fast as Span(...)
            style = event.style
            if rare:
                text = _rare(walk, event, at, restore)
            if note:
                if style:
                    quoted.append((start.index, end.index))
                elif end.line in hashes and not wants_key and (not text or type(resolve(text)) is str):
                    walk.diagnostics.extend(comments.swallowed(source, at, end.index, empty=not text))
            if wants_key:
                # The language has few keys, repeated thousands of times: interned, they are compared by identity.
                key, key_at, key_end, wants_key = intern(text), at, end, False
                if not text or (text == "<<" and not style):
                    fault(*_BAD_KEYS[text], at)
                if rare and event.anchor is not None:
                    anchors[event.anchor] = (Scalar(text, text, at), 1)
                continue
            if style:
                value = Scalar(text, text, at, False)  # noqa: FBT003
            elif text:
                value = Scalar(resolve(text) if text[0] in starts else text, text, at)
            else:
                value = Scalar(None, text, at)
                # In braces YAML reads `{a, b}` as two keys without values. `key_end` is the mark of the last key.
                if key_end is not None and items is None and ":" not in source[key_end.index : start.index]:
                    fault(
                        f"the key `{key}` has no `:`", "write `key: value`; a list stands in brackets: [a, b]", key_at
                    )
            count += 1
            if rare and event.anchor is not None:
                anchors[event.anchor] = (value, 1)
        elif kind is mapping_end or kind is sequence_end:
            start, end = event.start_mark, event.end_mark
            if end.index > start.index:  # a closing brace or bracket; without one it ends with what is last in it
                line, column = end.line + 1, end.column + 1
            entries, items, key, key_at, key_end, value, anchor, before = stack.pop()
            # So far the container's span covers its first character only; now its end is known.
            begun, wants_key = value.at, False
            value.at = new(Span, (file, begun.line, begun.column, line, column))
            if anchor is not None:
                anchors[anchor] = (value, count - before + 1)
        elif kind is mapping_start or kind is sequence_start:
            start = event.start_mark
            at = new(Span, (file, start.line + 1, start.column + 1, start.line + 1, start.column + 2))
            if event.tag is not None:
                fault(f"the tag `{event.tag}` is not read", "take it out", at)
            if wants_key:
                fault("a key is a word, not a list or a mapping", "text in braces or brackets must be quoted", at)
                return
            if len(stack) >= MAX_DEPTH:
                fault(f"values are nested deeper than {MAX_DEPTH}", None, at, "too-large")
                return
            count += 1
            anchor = event.anchor
            if kind is mapping_start:
                below: dict[str, Entry] = {}
                value = Table(below, at)
                stack.append((entries, items, key, key_at, key_end, value, anchor, count))
                entries, items, wants_key = below, None, True
            else:
                several: list[Value] = []
                value = Listing(several, at)
                stack.append((entries, items, key, key_at, key_end, value, anchor, count))
                entries, items, wants_key = None, several, False
            if anchor is not None:
                anchors[anchor] = (value, None)
            continue
        elif kind is alias_event:
            start, end = event.start_mark, event.end_mark
            line, column = end.line + 1, end.column + 1
            at = new(Span, (file, start.line + 1, start.column + 1, line, column))
            if wants_key:
                fault("an alias cannot be a key", "write the key out", at)
                return
            held, size = anchors.get(event.anchor, (None, 0))
            if held is None:
                fault(f"no anchor `&{event.anchor}` stands above", f"if it is text, {mistakes.QUOTE}", at)
                return
            if size is None:
                walk.diagnostics.append(mistakes.recursive(event.anchor, at, held.at))
                wants_key = entries is not None
                continue
            # Counted before it is copied: a file that multiplies its aliases is refused before it takes memory.
            count, expanded = count + size, expanded + size
            if expanded > MAX_EXPANDED:
                fault(f"the file's aliases stand for more than {MAX_EXPANDED:,} values", None, at, "too-large")
                return
            value = copy_of(held, at)
        elif kind is yaml.DocumentStartEvent:
            documents += 1
            if documents > 1:
                mark = event.start_mark
                at = Span(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 4)
                fault("a second YAML document begins here", "a file is one document: put the second into its own", at)
                return
            continue
        elif kind is yaml.StreamEndEvent:
            return
        else:
            continue
        if entries is not None:
            entry = Entry(key, key_at, value)
            # The first of two equal keys stays, the second costs only itself.
            if entries.setdefault(key, entry) is not entry:
                walk.diagnostics.append(mistakes.duplicate(key, key_at, entries[key].at))
            wants_key = True
        elif items is not None:
            items.append(value)
        else:
            walk.root = value
        if count > MAX_VALUES:
            fault(f"the file holds more than {MAX_VALUES:,} values", "split it", value.at, "too-large")
            return


_BAD_KEYS = {
    "": ("a key is missing before `:`", "write `key: value`"),
    "<<": ("merge keys (`<<`) are not read", "write the keys out, or share a whole value with `*name`"),
}


def _rare(walk: _Walk, event: Any, at: Span, restore: dict[int, int]) -> str:  # noqa: ANN401
    """Refuse a scalar's tag; return its text as it is in the file, with hidden line breaks put back."""
    if event.tag is not None:
        walk.fault(f"the tag `{event.tag}` is not read", f"take it out; if it is text, {mistakes.QUOTE}", at)
    text: str = event.value
    if not FAST and mistakes.HALF.search(text):
        walk.fault("an escape that names half a character", "write the whole character", at)
    return text.translate(restore) if restore else text


def copy_of(value: Value, at: Span) -> Value:
    """Copy a node for an alias. Later stages change trees in place, so two places must never share a node."""
    if isinstance(value, Scalar):
        return Scalar(value.value, value.text, at, value.plain)
    if isinstance(value, Listing):
        return Listing([copy_of(item, item.at) for item in value.items], at)
    return Table({e.key: Entry(e.key, e.at, copy_of(e.value, e.value.at)) for e in value}, at)
