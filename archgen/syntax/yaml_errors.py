"""Phrase syntax errors of YAML files: what the parser reports becomes a diagnostic that says what to do.

libyaml and PyYAML's own parser word some problems differently; the texts below match both.
"""

from __future__ import annotations

import re

from archgen.diagnostics import Diagnostic, Label, Span, diagnose_repetition, odd_characters
from archgen.frozen import NamedTuple
from archgen.language.language_tables import KEYS

LONE_SURROGATE = re.compile("[\ud800-\udfff]")
"""Half of a character beyond U+FFFF (a surrogate), which no text may hold alone. libyaml refuses it by itself."""
QUOTE_HELP = 'put the text in quotes: "..."'
_FORBIDDEN_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufeff\ufffe\uffff]")


class ParserProblem(NamedTuple):
    """What the parser reports: its message, and where, counted from 0.

    `context_start` is the line and column at which the construct that it was reading begins.
    """

    message: str
    line: int
    column: int
    context: str = ""
    context_start: tuple[int, int] | None = None


class _ErrorText(NamedTuple):
    """Our text for a problem. `label` is shown where the construct began; with `at_start` the finding itself is."""

    message: str
    help: str | None = None
    label: str | None = None
    at_start: bool = False


def find_forbidden_character(file: str, text: str) -> Diagnostic | None:
    """Report the first character that no YAML file may hold; None if there is none."""
    match = _FORBIDDEN_CHARACTER.search(text)
    if match is None:
        return None
    lines_before = text[: match.start()].replace("\r\n", "\n").replace("\r", "\n").split("\n")
    span = Span(file, len(lines_before), len(lines_before[-1]) + 1, len(lines_before), len(lines_before[-1]) + 2)
    name = "the byte order mark" if match[0] == "\ufeff" else "the control character"
    message = f"{name} U+{ord(match[0]):04X} cannot stand in YAML"
    return Diagnostic("syntax-error", message, span, help="delete it")


def diagnose_problem(file: str, text: str, problem: ParserProblem) -> Diagnostic:
    """Phrase a problem that the parser reports."""
    lines = re.split(r"\r\n|\r|\n", text)
    position = _clamp_position(lines, problem.line, problem.column)
    odd_character = _find_odd_character(file, lines, position[0], problem)
    if odd_character is not None:
        return odd_character
    slip = _find_slip_in_line(file, lines, position, problem)
    if slip is not None:
        return slip
    error_text = _choose_error_text(lines, position, problem)
    context_start = problem.context_start
    if error_text.at_start and context_start is not None:
        return Diagnostic(
            "syntax-error", error_text.message, _span_at(file, lines, context_start), help=error_text.help
        )
    labels = (
        (Label(_span_at(file, lines, context_start), error_text.label),)
        if error_text.label and context_start and context_start != position
        else ()
    )
    if error_text.message == _MISPLACED_MESSAGE:
        outdented_line = _find_outdented_line(lines, *position)
        if outdented_line is not None:
            start = (outdented_line, _measure_indentation(lines[outdented_line]))
            labels = (Label(_span_at(file, lines, start), "or this line is indented too little"),)
        column_help = _find_column_help(lines, position[0])
        if column_help is not None:
            error_text = error_text._replace(help=column_help)
    return Diagnostic(
        "syntax-error", error_text.message, _span_at(file, lines, position), labels=labels, help=error_text.help
    )


_LINE_OF_ENTRY = re.compile(r"( *)(?:- )*+([A-Za-z_][A-Za-z0-9_-]*+)[ \t]*+(?:([:=])[ \t]*+)?(.*)")
_OPEN_QUOTE = re.compile(r" *(?:- )?(?:[A-Za-z0-9_-]+: +)?(\"[^\"\\]*|'[^']*)\Z")
_FEW_LINES = 200
"""So many lines above an error are looked at for what it began with."""


def _find_slip_in_line(
    file: str, lines: list[str], position: tuple[int, int], problem: ParserProblem
) -> Diagnostic | None:
    """Report a quote that nobody closed, or an entry without its colon and blank, where the parser stopped only later."""
    is_key_missing = "could not find expected ':'" in problem.message
    is_misplaced = "mapping values are not allowed" in problem.message and ": " not in lines[position[0]][: position[1]]
    if "expected" in problem.message:
        for number in range(max(0, position[0] - _FEW_LINES), position[0] + 1):
            quote = _OPEN_QUOTE.match(lines[number])
            if quote is not None and not _is_closed(lines[number + 1 : position[0]], quote[1][0]):
                span = Span(file, number + 1, quote.start(1) + 1, number + 1, quote.end(1) + 1)
                message = "this quote is never closed"
                return Diagnostic("syntax-error", message, span, help=f"write `{quote[1][0]}` at its end")
    if is_key_missing and problem.context_start is not None:
        return _diagnose_entry(file, lines, problem.context_start[0])
    return _diagnose_entry(file, lines, position[0] - 1) if is_misplaced and position[0] else None


def _is_closed(lines: list[str], quote: str) -> bool:
    """Whether a text in quotes that goes on below ends there: behind the next quote nothing else stands."""
    line = next((line for line in lines if quote in line), None)
    return line is not None and not line.rpartition(quote)[2].partition("#")[0].strip(" ,]}")


def _diagnose_entry(file: str, lines: list[str], number: int) -> Diagnostic | None:
    """Report a line such as `owner:wur`, `owner = wur`, `owner wur` or `timing`; None where it may be text."""
    match = _LINE_OF_ENTRY.match(lines[number].rstrip())
    if match is None:
        return None
    key, sign, value = match[2], match[3], match[4]
    is_entry = sign == "=" or (sign == ":" and value and lines[number][match.end(3)] not in " \t")
    if not (is_entry or (not sign and (not value or key in _LANGUAGE_KEYS))) or {*value} & {*"\"'[]{}#"}:
        return None
    message = f"the `:` after `{key}` has no blank behind it" if sign == ":" else f"a `:` is missing after `{key}`"
    span = Span(file, number + 1, match.start(2) + 1, number + 1, match.end() + 1)
    return Diagnostic("syntax-error", message, span, help=f"write `{f'{key}: {value}'.rstrip()}`")


_LANGUAGE_KEYS = frozenset(key for keys in KEYS.values() for key in keys)


def _find_column_help(lines: list[str], number: int) -> str | None:
    """Return the key in whose column a line was most likely meant to begin, one blank from where it does; None if unclear."""
    own_column, own_key = _measure_indentation(lines[number]), _LINE_OF_ENTRY.match(lines[number])
    levels: dict[int, str] = {}
    lowest = len(lines[number]) + 2
    for line in reversed(lines[max(0, number - _FEW_LINES) : number]):
        column, entry = _measure_indentation(line), _LINE_OF_ENTRY.match(line)
        if line.strip() and entry and entry[3] == ":" and "- " not in line[: entry.start(2)]:
            if column < lowest and column >= own_column - 1:
                levels.setdefault(column, entry[2])
            lowest = min(lowest, column)
    near = [key for column, key in levels.items() if abs(column - own_column) == 1]
    if own_key and len(near) > 1:
        near = [key for key in near if (key in _LANGUAGE_KEYS) == (own_key[2] in _LANGUAGE_KEYS)]
    return f"begin it in the column of `{near[0]}`" if len(near) == 1 else None


def _find_outdented_line(lines: list[str], number: int, column: int) -> int | None:
    """Return the line above that ends the block to which a line seems to belong; None if there is no such block.

    That is the nearest one that is indented less, if a line above that one begins in the same column.
    """
    for above in range(number - 1, -1, -1):
        if lines[above].strip() and not lines[above].lstrip().startswith("#"):
            indentation = _measure_indentation(lines[above])
            if indentation < column:
                has_sibling = any(_measure_indentation(line) == column for line in lines[:above] if line.strip())
                return above if has_sibling and indentation else None
    return None


def _measure_indentation(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


_MISPLACED_MESSAGE = "this line does not belong to anything above it"


def _find_odd_character(file: str, lines: list[str], last_line: int, problem: ParserProblem) -> Diagnostic | None:
    """Report a blank, a quote or a dash that is not YAML's, where the parser stopped or in the two lines above."""
    # The parser stops behind what misled it: at the next line, or where it meets what the odd quote does not enclose.
    first_line = problem.context_start[0] if problem.context_start else last_line
    for number in sorted({first_line, *range(max(0, last_line - 2), last_line + 1)}):
        column = odd_characters.find_misplaced_character(lines[number]) if number < len(lines) else None
        if column is not None:
            character = lines[number][column]
            message = f"{odd_characters.name_character(character)} stands here, which is no sign of YAML"
            replacement = odd_characters.replace_odd_characters(character)
            help_line = f"write {_PLAIN_WORDS.get(replacement, f'`{replacement}`')} in its place"
            return Diagnostic("syntax-error", message, _span_at(file, lines, (number, column)), help=help_line)
    return None


_PLAIN_WORDS = {" ": "a plain blank", "": "nothing", '"': 'a plain quote, `"`,', "'": "a plain quote, `'`,"}


def describe_missing_colon(key: str) -> tuple[str, str]:
    """Return what is wrong with a key in braces that has no value, and what to write."""
    position = odd_characters.find_odd_character(key)
    if position is not None and ":" in key[:position]:
        character = odd_characters.name_character(key[position])
        return f"{character} stands in `{key}`", f"write `{odd_characters.replace_odd_characters(key)}`"
    if key.endswith(">"):
        return (
            f"the key `{key}` has no `:`",
            'within braces a generic type of two stands in quotes, since its comma ends the value: "Pair<A, B>"',
        )
    return f"the key `{key}` has no `:`", "write `key: value`; a list stands in brackets: [a, b]"


def diagnose_duplicate_key(key: str, span: Span, first_span: Span) -> Diagnostic:
    """Report a key that one mapping has twice."""
    message = f"the key `{key}` is written twice"
    return diagnose_repetition("duplicate-key", message, span, first_span, help_line="keep one of them")


def diagnose_recursive_alias(anchor: str, span: Span, anchor_span: Span) -> Diagnostic:
    """Report an alias inside the value that it stands for."""
    label = Label(
        Span(anchor_span.file, anchor_span.line, anchor_span.column, anchor_span.line, anchor_span.column + 1),
        "begins here",
    )
    message = f"`*{anchor}` stands inside of what it stands for"
    return Diagnostic("recursive-alias", message, span, labels=(label,), help="write out what is meant")


def _clamp_position(lines: list[str], line: int, column: int) -> tuple[int, int]:
    """Move a position behind the end of the text to the end of its last line that is not blank."""
    # The parser notices an unclosed bracket at the end of the file, which may be many blank lines below.
    last_line = len(lines) - 1
    while last_line > 0 and not lines[last_line].strip():
        last_line -= 1
    if line > last_line:
        return last_line, len(lines[last_line])
    return line, min(column, len(lines[line]))


def _span_at(file: str, lines: list[str], position: tuple[int, int]) -> Span:
    line, column = _clamp_position(lines, *position)
    return Span(file, line + 1, column + 1, line + 1, column + 1 + (column < len(lines[line])))


def _choose_error_text(lines: list[str], position: tuple[int, int], problem: ParserProblem) -> _ErrorText:
    message, (number, column) = problem.message, position
    line, line_above = lines[number], lines[number - 1] if number else ""
    if "mapping values are not allowed" in message:
        return _explain_second_colon(line, column, line_above)
    if "cannot start any token" in message:
        return _explain_bad_start(line[column : column + 1])
    if "node content" in message:
        return _explain_bad_node(line[column : column + 1])
    if "expected key" in message or "expected <block end>" in message or "'-' indicator" in message:
        return _explain_misplaced_line(line, column)
    if "',' or ']'" in message or "',' or '}'" in message:
        return _explain_unclosed(message, problem)
    matching_texts = (
        error_text for needle, error_text in _FIXED_TEXTS if needle in message or needle in problem.context
    )
    return next(
        matching_texts, _ErrorText("this is not YAML", "compare it with the lines around it, or put text in quotes")
    )


_TAB_TEXT = _ErrorText("a tab cannot stand in the indentation", "indent with blanks")
_ESCAPE_TEXT = _ErrorText("an unknown escape in double quotes", "write `\\\\` for a backslash, or use single quotes")


def _explain_second_colon(line: str, column: int, line_above: str) -> _ErrorText:
    if re.search(r":\s", line[:column]):
        return _ErrorText("a second `: ` in one line: text that holds `: ` must be quoted", QUOTE_HELP)
    above = _LINE_OF_ENTRY.match(line_above)
    if above is not None and above[3] == ":" and above[4] and above.start(2) < _measure_indentation(line):
        help_line = f"begin it in the column of `{above[2]}`"
        return _ErrorText(f"a key cannot stand here: it is part of the text `{above[2]}`", help_line)
    help_line = "check the indentation, and that the key above ends in `:`"
    return _ErrorText("a key cannot stand here: what is above is text", help_line)


def _explain_bad_start(character: str) -> _ErrorText:
    if character == "\t":
        return _TAB_TEXT
    return _ErrorText(
        f"text cannot begin with `{character}`" if character != "`" else "text cannot begin with a backtick", QUOTE_HELP
    )


def _explain_bad_node(character: str) -> _ErrorText:
    if character == ":":
        return _ErrorText("a key is missing before `:`", "write `key: value`")
    if not character:
        return _ErrorText(
            "the text ends where a value should stand", "close what is open: `]` ends a list, `}` a mapping"
        )
    return _ErrorText(f"a value cannot begin with `{character}`", QUOTE_HELP)


def _explain_misplaced_line(line: str, column: int) -> _ErrorText:
    if line[:column].strip(" -"):
        return _ErrorText("the value ends before this", "put the whole text in one pair of quotes")
    if line[column : column + 1] == "-":
        return _ErrorText("a list entry stands where a key is expected", "indent the list below its key")
    help_line = "keys of one mapping begin in the same column, and so do the entries of one list"
    return _ErrorText(_MISPLACED_MESSAGE, help_line, "what is open begins here")


def _explain_unclosed(message: str, problem: ParserProblem) -> _ErrorText:
    opening, closing = ("[", "]") if "]" in message else ("{", "}")
    if problem.context_start is not None and problem.context_start[0] != problem.line:
        return _ErrorText(f"this `{opening}` is not closed", f"write `{closing}` at its end", at_start=True)
    help_line = f"separate entries with `,`, end with `{closing}`, and quote text that holds `: `, brackets or braces"
    return _ErrorText(f"`,` or `{closing}` is missing before this", help_line, f"this `{opening}` is open")


# Parts of the parser's message or context, and our text; the first match wins. "hexdecimal" is libyaml's spelling.
_FIXED_TEXTS: tuple[tuple[str, _ErrorText], ...] = (
    ("tab character", _TAB_TEXT),
    (
        "sequence entries are not allowed",
        _ErrorText("a list cannot begin on the line of its key", "begin it on the next line"),
    ),
    ("mapping keys are not allowed", _ErrorText("text cannot begin with `? `", QUOTE_HELP)),
    (
        "could not find expected ':'",
        _ErrorText("a key without `:`", "write `key: value`, or indent the text below its key", at_start=True),
    ),
    ("unexpected end of stream", _ErrorText("this quote is never closed", "close it, or take it out", at_start=True)),
    ("unexpected document", _ErrorText("this quote is never closed", "close it, or take it out", at_start=True)),
    ("escape c", _ESCAPE_TEXT),
    ("hexdecimal", _ESCAPE_TEXT),
    ("hexadecimal", _ESCAPE_TEXT),
    (
        "scanning a block scalar",
        _ErrorText("text cannot begin with `>` or `|`: these open a block of lines", QUOTE_HELP, at_start=True),
    ),
    ("scanning an anchor", _ErrorText("text cannot begin with `&`", QUOTE_HELP, at_start=True)),
    ("scanning an alias", _ErrorText("text cannot begin with `*`", QUOTE_HELP, at_start=True)),
    (" tag", _ErrorText("text cannot begin with `!`", QUOTE_HELP, at_start=True)),
    (" directive", _ErrorText("a line cannot begin with `%`", "put the text in quotes", at_start=True)),
    ("incompatible YAML", _ErrorText("this version of YAML is not read", "take the line out: archgen reads YAML 1.2")),
    ("found unexpected ':'", _ErrorText("the `:` has no blank after it", "write `key: value`")),
    (
        "<document start>",
        _ErrorText("this does not belong to what is above it", "keys of one mapping begin in the same column"),
    ),
    ("did not find expected ':'", _ErrorText("a key without `:`", "write `key: value`", at_start=True)),
)
