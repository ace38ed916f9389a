"""The edits that follow from the help of a finding, for tools: what a person would do who takes its words literally.

A help says what to write in backticks; this reads it back and finds the place, so that words and edits never differ.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from archgen.diagnostics.odd_characters import replace_odd_characters
from archgen.diagnostics.source_span import Span
from archgen.frozen import NamedTuple

if TYPE_CHECKING:
    from archgen.diagnostics.diagnostic import Diagnostic
    from archgen.diagnostics.source_span import SourceTexts


class TextEdit(NamedTuple):
    """A stretch of a file, and what to write in its place."""

    span: Span
    text: str


class SuggestedFix(NamedTuple):
    """Edits of one file that do what a help says. `is_certain`: nothing else can have been meant."""

    edits: tuple[TextEdit, ...]
    is_certain: bool


def suggest_fix(finding: Diagnostic, sources: SourceTexts) -> SuggestedFix | None:
    """Return the edits that a finding's help asks for; None where it leaves something to people."""
    if finding.help is None or not finding.span.file or sources.line_of(finding.span.file, finding.span.line) is None:
        return None
    for pattern, make_fix in _FORMS.items():
        match = pattern.match(finding.help)
        if match:
            return make_fix(finding, sources, match)
    return None


def apply_edits(text: str, edits: Sequence[TextEdit]) -> str:
    """Return a text with edits made in it; they do not overlap."""
    lines = re.split(r"(?<=\n)|(?<=\r)(?!\n)", text)
    for edit in sorted(edits, key=lambda edit: edit.span, reverse=True):
        _, line, column, end_line, end_column = edit.span
        tail = lines[end_line - 1][end_column - 1 :] if end_line <= len(lines) else ""
        lines[line - 1 : end_line] = [lines[line - 1][: column - 1] + edit.text + tail]
    return "".join(lines)


_COMMENT = re.compile(r"(?<![ \t])[ \t]++#.*\Z")


def _read_span(span: Span, sources: SourceTexts) -> str:
    if span.line != span.end_line:
        return ""
    return (sources.line_of(span.file, span.line) or "")[span.column - 1 : span.end_column - 1]


def _replace_word(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix | None:
    """Write what is meant in place of the word that the message quotes."""
    written = _read_span(finding.span, sources)
    quote = written[:1] if written[:1] in {'"', "'"} else ""
    word, meant = written.strip("\"'"), match["meant"].removesuffix(":")
    if not word or f"`{word}`" not in finding.message:
        return None
    is_certain = _fold(word) == _fold(meant)
    return SuggestedFix((TextEdit(finding.span, f"{quote}{meant}{quote}"),), is_certain)


def _fold(word: str) -> str:
    """Return a word without what people write otherwise without meaning anything by it: case, separators and signs."""
    return re.sub(r"[\W_]+", "", word.casefold())


def _write_value(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix | None:
    """Write a value in place of the one that is wrong, or with another key in place of both."""
    line, span, meant = sources.line_of(finding.span.file, finding.span.line) or "", finding.span, match["meant"]
    if not _read_span(span, sources) or "..." in meant:
        return None
    odd_text = re.search(r" stands in `([^`]+)`\Z", finding.message)
    if odd_text is not None:
        start = line.find(odd_text[1])
        if start < 0:  # the message has it on one line, with plain blanks
            return SuggestedFix((TextEdit(span, replace_odd_characters(_read_span(span, sources))),), is_certain=True)
        span = span._replace(column=start + 1, end_column=start + len(odd_text[1]) + 1)
    other_key = re.match(r"[a-z_]+(?=: )", meant)
    if other_key and not _read_span(span, sources).startswith(other_key[0]):
        key = re.search(r"(?<![A-Za-z0-9_-])[A-Za-z0-9_-]++:[ \t]*+\Z", line[: span.column - 1])
        if key is None:
            return None
        span = span._replace(column=key.start() + 1)
    # Of data, bits and bytes are told apart by case alone.
    is_certain = _fold(_read_span(span, sources)) == _fold(meant) and "KiB" not in str(finding.help)
    return SuggestedFix((TextEdit(span, meant),), is_certain)


def _rename_key(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix | None:
    if _read_span(finding.span, sources) != match["old"]:
        return None
    return SuggestedFix((TextEdit(finding.span, match["meant"]),), is_certain=False)


def _exchange(finding: Diagnostic, sources: SourceTexts, _: re.Match[str]) -> SuggestedFix:
    spans = finding.span, finding.labels[0].span
    texts = [_read_span(span, sources) for span in spans]
    return SuggestedFix(tuple(map(TextEdit, spans, reversed(texts))), is_certain=False)


def _quote_text(finding: Diagnostic, sources: SourceTexts, _: re.Match[str]) -> SuggestedFix | None:
    """Put the text that begins in a place in quotes; in braces nobody can tell where it ends."""
    line, start = sources.line_of(finding.span.file, finding.span.line) or "", finding.span.column - 1
    if re.search(r"[\[{]", line[:start]):
        return None
    key = re.match(r" *+(?:- *+)?[^ :#\"'][^:#\"']*+:[ \t]+", line)
    if key is not None and key.end() < start:  # within a text
        start = key.end()
    text = _COMMENT.sub("", line[start:]).rstrip()
    if not text or "\\" in text or '"' in text:
        return None
    span = Span(finding.span.file, finding.span.line, start + 1, finding.span.line, start + 1 + len(text))
    return SuggestedFix((TextEdit(span, f'"{text}"'),), is_certain=True)


def _replace_character(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix:
    meant = {"a plain blank": " ", "nothing": "", None: ""}.get(match["meant"])
    if meant is None:
        meant = match["meant"].partition("`")[2].partition("`")[0]
    line, span = sources.line_of(finding.span.file, finding.span.line) or "", finding.span
    columns = [span.column]
    if meant in {'"', "'"}:  # the quote at the other end, too
        columns = [
            number for number, sign in enumerate(line, 1) if sign != meant and replace_odd_characters(sign) == meant
        ]
    edits = (TextEdit(span._replace(column=number, end_column=number + 1), meant) for number in columns)
    return SuggestedFix(tuple(edits), is_certain=True)


def _close(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix:
    """Write what closes a quote or bracket at the end of its line."""
    line = _COMMENT.sub("", sources.line_of(finding.span.file, finding.span.line) or "").rstrip()
    end = Span(finding.span.file, finding.span.line, len(line) + 1, finding.span.line, len(line) + 1)
    return SuggestedFix((TextEdit(end, match["meant"]),), is_certain=False)


def _take_out_of_list(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix | None:
    line = sources.line_of(finding.span.file, finding.span.line) or ""
    start = line.find("[", finding.span.column - 1)
    end = line.find("]", start) + 1
    if start < 0 or line[start + 1 : end - 1].strip(" \"'") != match["meant"]:
        return None
    span = finding.span._replace(column=start + 1, end_line=finding.span.line, end_column=end + 1)
    return SuggestedFix((TextEdit(span, match["meant"]),), is_certain=True)


def _key_list_by_id(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix | None:
    """Write a mapping where ids stand in a list of one line, behind their key."""
    line = sources.line_of(finding.span.file, finding.span.line) or ""
    start = line.find("[", finding.span.column - 1)
    end = line.find("]", start) + 1
    ids = [each.strip(" \"'") for each in line[start + 1 : end - 1].split(",")]
    if start < 0 or "{" + ", ".join(f"{each}: {{}}" for each in ids) + "}" != match["meant"]:
        return None
    span = finding.span._replace(column=start + 1, end_line=finding.span.line, end_column=end + 1)
    return SuggestedFix((TextEdit(span, match["meant"]),), is_certain=False)


def _take_dash_away(finding: Diagnostic, sources: SourceTexts, _: re.Match[str]) -> SuggestedFix | None:
    line, end = sources.line_of(finding.span.file, finding.span.line) or "", finding.span.column - 1
    if not re.search(r"\A *- +\Z", line[:end]):
        return None
    dash = finding.span._replace(column=line.index("-") + 1, end_line=finding.span.line, end_column=end + 1)
    return SuggestedFix((TextEdit(dash, ""),), is_certain=False)


def _write_below(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix | None:
    """Write a key of one line below another one, which its element does not have yet."""
    span, lines = finding.span, _list_near_lines(finding.span, sources)
    line = lines[span.line]
    entry = re.match(r"[a-z_]+: [^#{\[]+", line[span.column - 1 :])
    if entry is None or line[: span.column - 1].strip():
        return None
    for step in (-1, 1):
        number = span.line
        while number in lines and (not lines[number].strip() or _indent(lines[number]) >= span.column - 1):
            if lines[number][span.column - 1 :].startswith(f"{match['parent']}:"):
                return None
            number += step
    text = entry[0].rstrip()
    span = span._replace(end_line=span.line, end_column=span.column + len(text))
    return SuggestedFix((TextEdit(span, f"{match['parent']}: {{{text}}}"),), is_certain=False)


def _move_block(finding: Diagnostic, sources: SourceTexts, match: re.Match[str]) -> SuggestedFix | None:
    """Indent a key, with all that stands below it, so that it begins in the column of another one or below it."""
    span, is_below = finding.span, match["way"] != "begin it in the column of"
    lines = _list_near_lines(span, sources)
    if not re.match(r" *[\"']?[\w.-]+[\"']?:", lines[span.line]):  # not at the beginning of its line
        return None
    target = match["target"].removesuffix(":")
    keys = (f"{target}:", f'"{target}":', f"'{target}':")
    targets = [line for number, line in lines.items() if number < span.line and line.lstrip(" ").startswith(keys)]
    if not targets:
        return None
    column = _indent(targets[-1]) + (2 if is_below else 0)
    shift = column - _indent(lines[span.line])
    end = span.line + 1
    while end in lines and (not lines[end].strip() or _indent(lines[end]) > _indent(lines[span.line])):
        if shift == 1 and _indent(lines[end]) == column and lines[end].strip():  # it stands beside the key then
            break
        end += 1
    if end not in lines and sources.line_of(span.file, end) is not None:  # too long to be seen whole
        return None
    edits = [
        TextEdit(
            Span(span.file, number, 1, number, _indent(lines[number]) + 1),
            " " * (_indent(lines[number]) + shift),
        )
        for number in range(span.line, end)
        if lines[number].strip()
    ]
    return SuggestedFix(tuple(edits), is_certain=False)


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


_NEAR = 2000
"""So many lines above and below are looked at: a group of a hundred components has as many."""


def _list_near_lines(span: Span, sources: SourceTexts) -> dict[int, str]:
    """Return the lines around a place by their numbers."""
    numbers = range(max(1, span.line - _NEAR), span.line + _NEAR)
    return {number: line for number in numbers if (line := sources.line_of(span.file, number)) is not None}


_FORMS: Mapping[re.Pattern[str], Callable[[Diagnostic, SourceTexts, re.Match[str]], SuggestedFix | None]] = {
    re.compile(r"did you mean `(?P<meant>[^`]+)`\?\Z"): _replace_word,
    re.compile(r"write `(?P<meant>[^`]+):` instead of `(?P<old>[^`]+):`\Z"): _rename_key,
    re.compile(r"write `(?P<meant>[]}\"'])` at its end\Z"): _close,
    re.compile(r"write `(?P<meant>[^`]+)`, without brackets\Z"): _take_out_of_list,
    re.compile(r"(?:.*; )?write `(?P<meant>[^`]+)`(?:, without .*|;.*)?\Z"): _write_value,
    re.compile(r"`[^`]+` is keyed by id: write `(?P<meant>\{[^`]+)` instead of a list"): _key_list_by_id,
    re.compile(r"take the `- ` away"): _take_dash_away,
    re.compile(r"write it below `(?P<parent>[^`]+)`: `"): _write_below,
    re.compile(r"write (?P<meant>a plain blank|nothing|[^`]*`[^`]+`,?) in its place\Z|delete it\Z"): _replace_character,
    re.compile(r"exchange the two keys"): _exchange,
    re.compile(r"put the text in quotes"): _quote_text,
    re.compile(
        r"(?:it looks like [A-Za-z ]+: |if this is an element of its own, )?(?P<way>indent it below|put it below|begin it in the column of) `(?P<target>[^`]+)`"
    ): _move_block,
}
"""How the help of a finding begins that says all of an edit, and what makes the edit of it."""
