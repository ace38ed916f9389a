"""Phrase what is wrong with a value or a key, in our own words, with help for the commonest slips.

The validator's own messages quote the schema's patterns and Python values, which say nothing to people who write YAML.

Word what is wrong with text that stands where a list is asked, and with several ids in one entry of a list.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from typing import Any

from archgen.diagnostics import AskedName, Diagnostic, Span, did_you_mean, did_you_shorten, join_words, odd_characters
from archgen.frozen import NamedTuple
from archgen.language.key_paths import find_part
from archgen.language.language_tables import OFFERS, OTHER_WORDS, SECTION_KINDS
from archgen.schema.language_schema import load_schema, resolve_part
from archgen.schema.quantity_wording import clip_text, describe_wrong_quantity, find_dimension
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, SequenceNode, YamlNode

_ID = re.compile(r"[A-Za-z/~][A-Za-z0-9._/~-]*\Z", re.ASCII)
"""An id or the name of a topic."""
_LOWER_PATH = re.compile(r"[a-z][a-z0-9_.]*\Z")
_ENTRY_SEPARATOR = re.compile(r"(?:(?<!\s)\s++)?+(?:[,;]|->)\s*+|(?<!\s)\s++(?:and|&)\s++")
_UNQUOTED_TEXT = re.compile(r"[A-Za-z0-9_/][\w ./@+-]*\Z", re.ASCII)
_RANGE = re.compile(r"(\d{1,4})\s*(?:-|\.\.\.?)\s*(\d{1,4})\Z", re.ASCII)
_ENDS = re.compile(r"([+-]?\d+(?:\.\d+)?)\s*(?:-|\.\.\.?|,|;|to)\s*([+-]?\d+(?:\.\d+)?)\Z", re.ASCII)
_NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?\Z", re.ASCII)
_SHELL_SIGN = re.compile(r"[$&|;<>`*?~]")
_MAX_RANGE = 16
"""A longer list of numbers is not written out."""
_MAX_LIST_LENGTH = 1000
"""Longer text is no list of ids that somebody wrote by hand."""


def split_ids(text: str, schema_part: dict[str, Any]) -> list[str]:
    """Return the entries of a list that is written as one text, such as `R-1, R-4`; empty where it is no such list.

    `schema_part` is that of the list. Where its entries may be sentences, every part must be one word; words without
    a comma between them are ids only if each of them is in lower case, or holds a digit where sentences are allowed.
    """
    if len(text) > _MAX_LIST_LENGTH:
        return []
    pattern = resolve_part(schema_part.get("items", {})).get("pattern")
    parts = [part for part in _ENTRY_SEPARATOR.split(text.strip().strip("[]")) if part]
    if len(parts) == 1:
        parts = text.split()
        # `Head Camera` is a title, `head camera` perhaps two ids.
        is_id = re.compile(r"\d").search if pattern is None else _LOWER_PATH.match
        if not all(map(is_id, parts)):
            return []
    is_entry = re.compile(pattern).search if pattern else _ID.match
    return parts if len(parts) > 1 and all(map(is_entry, parts)) else []


def suggest_list(text: str, schema_part: dict[str, Any]) -> str:
    """Return a text as the list in brackets that was most likely meant."""
    entries = _list_range(text, schema_part) or split_ids(text, schema_part) or [text]
    return f"[{', '.join(map(_quote_entry, entries))}]"


def describe_list(text: str, schema_part: dict[str, Any]) -> str:
    """Return a line that says how a text is written as the list that is asked for."""
    is_range = schema_part.get("title") == "Range"
    return _describe_range(text) if is_range else f"write `{suggest_list(text, schema_part)}`"


def _describe_range(text: str) -> str:
    """Return a line that says how a range is written; both ends, where the text names them (`1-9`, `0..30`)."""
    start = "write its least and its greatest value:"
    if ends := _ENDS.match(text.strip()):
        least, greatest = sorted((ends[1], ends[2]), key=float)
        return f"{start} `[{least}, {greatest}]`"
    if not _NUMBER.match(text.strip()):
        return f"{start} `[0, 10]`, or `[0, .inf]` for no upper end"
    end = text.strip()
    least, greatest = (end, "0") if end.startswith("-") else ("0", end)
    return f"{start} `[{least}, {greatest}]`, or `[{end}, .inf]` for no upper end"


def suggest_words(text: str) -> str:
    """Return a line for a shell as the list of words that was most likely meant, with what no shell will do."""
    try:
        words = shlex.split(text[:_MAX_LIST_LENGTH])
    except ValueError:  # a quote that is not closed
        words = text[:_MAX_LIST_LENGTH].split()
    note = "; no shell reads it" if _SHELL_SIGN.search(text) else ""
    return f"write its words as a list: `[{', '.join(map(_quote_entry, words))}]`{note}"


def _list_range(text: str, schema_part: dict[str, Any]) -> list[str]:
    """Return the numbers from the first to the last that a text such as `0-3` names; empty where it names none."""
    ends = _RANGE.match(text.strip())
    if ends is None or "integer" not in resolve_part(schema_part.get("items", {})).get("type", ()):
        return []
    first, last = int(ends[1]), int(ends[2])
    return [str(number) for number in range(first, last + 1)] if last - first < _MAX_RANGE else []


def _quote_entry(text: str) -> str:
    """Return a text as an entry of a list in brackets: quoted where YAML would read it as something else."""
    return text if _UNQUOTED_TEXT.match(text) else f'"{text}"'


_BOOLEAN_WORDS = {
    "yes": "true",
    "on": "true",
    "y": "true",
    "1": "true",
    "no": "false",
    "off": "false",
    "n": "false",
    "0": "false",
}
SECTIONS_BY_ID = frozenset(SECTION_KINDS)
"""The top-level sections that hold elements by id."""
_UNQUOTED_VALUE = re.compile(r"-?[0-9]+|true|false", re.IGNORECASE)
_TYPE_PHRASES = {"array": "a list", "object": "a mapping", "integer": "a whole number", "boolean": "`true` or `false`"}


class ErrorPlace(NamedTuple):
    """Where an error is: its path, the node there, what holds the node, and its entry if that is a mapping."""

    path: tuple[str | int, ...]
    node: YamlNode
    parent: MappingNode | SequenceNode | None = None
    entry: MappingEntry | None = None


def diagnose_odd_character(text: str, span: Span, rule: str, element: str | None) -> Diagnostic | None:
    """Report the first odd character of a key or a value that no odd character may stand in; None without one."""
    position = odd_characters.find_odd_character(text)
    if position is None:
        return None
    message = f"{odd_characters.name_character(text[position])} stands in `{clip_text(text)}`"
    plain_text = odd_characters.replace_odd_characters(text).strip()
    # In quotes, or over several lines, the place in the text is not that in the file.
    if span.line == span.end_line and span.end_column - span.column == len(text):
        span = span._replace(column=span.column + position, end_column=span.column + position + 1)
    return Diagnostic(rule, message, span, help=f"write `{clip_text(plain_text)}`", element=element)


def suggest_ids(key: str) -> tuple[str, str]:
    """Return what a malformed id may have been meant to be: as the id of a requirement, and as any other id."""
    snake = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", key).lower()
    return re.sub(r"[^A-Za-z0-9._-]+", "-", key).strip("-"), re.sub(r"[^a-z0-9]+", "_", snake).strip("_")


def diagnose_wrong_value(kind: str, place: ErrorPlace, schema_part: dict[str, Any]) -> Diagnostic:
    """Report a value of the wrong type, or one that is not allowed; `kind` is the validator's name for the error."""
    name, node = _describe_place(place), place.node
    if kind in {"pattern", "type", "enum"} and isinstance(node, ScalarNode):
        odd_character = diagnose_odd_character(node.text, node.span, "wrong-value", element_of_path(place.path))
        if odd_character is not None:
            return odd_character
    if kind == "type":
        rule, message, help_line = _describe_wrong_type(name, node, schema_part)
    else:
        rule, (message, help_line) = "wrong-value", _describe_wrong_value(kind, name, node, schema_part)
    if schema_part.get("title") == "Input" and place.path[-1] in schema_part["properties"]:
        help_line = f"a key of an input stands below that input: `INPUT: {{from: ..., {place.path[-1]}: ...}}`"
    # A container's own span can cover a whole section: its key is shown instead. An entry of a list has no key.
    span = node.span
    if isinstance(node, MappingNode | SequenceNode) and place.entry is not None and node is place.entry.value:
        span = place.entry.key_span
    if schema_part.get("title") == "Performance indicator" and isinstance(node, ScalarNode) and place.entry is not None:
        meant = OTHER_WORDS["indicator"].get(str(place.path[-1]))
        help_line, span = (f"did you mean `{meant}`?", place.entry.key_span) if meant else (help_line, span)
    is_guessed = help_line is not None and help_line.startswith("did you mean")
    asked_name = _find_asked_name(place, schema_part) if rule == "wrong-value" and not is_guessed else None
    return Diagnostic(rule, message, span, help=help_line, element=element_of_path(place.path), asked_name=asked_name)


def _find_asked_name(place: ErrorPlace, schema_part: dict[str, Any]) -> AskedName | None:
    """Return what a text that is no id, or no dotted path, should name; None where it names nothing."""
    if not isinstance(place.node, ScalarNode):
        return None
    definitions = load_schema()["$defs"]
    is_list = "items" in schema_part and bool(split_ids(place.node.text, schema_part))
    if schema_part.get("pattern") == definitions["reference_item"]["pattern"]:
        return AskedName("part", is_list)
    if schema_part.get("pattern") != definitions["id"]["pattern"]:
        return None
    path = place.path[:-1] if place.path and isinstance(place.path[-1], int) else place.path
    kind = next((SECTION_KINDS[name] for name in OFFERS.get(find_part(path), ()) if name in SECTION_KINDS), None)
    return AskedName(kind, is_list) if kind else None


def _describe_wrong_type(name: str, node: YamlNode, schema_part: dict[str, Any]) -> tuple[str, str, str | None]:
    expected = _describe_expected(schema_part)
    dimension = find_dimension(schema_part)
    if isinstance(node, ScalarNode):
        if dimension:
            return "wrong-value", *describe_wrong_quantity(name, node.text, dimension, schema_part)
        if node.value is None:
            return "wrong-type", f"{name} is empty, but must be {expected}", None
        help_line = _find_scalar_help(node, schema_part)
        # Without this note `8` would read as if nothing were wrong with it.
        is_quoted = not node.is_plain and _UNQUOTED_VALUE.fullmatch(node.text)
        quotes_note = " in quotes, which is a text," if is_quoted else ""
        return "wrong-type", f"{name} is `{clip_text(node.text)}`{quotes_note or ','} but must be {expected}", help_line
    actual = "a list" if isinstance(node, SequenceNode) else "a mapping"
    is_quantity = dimension and "object" not in schema_part["type"]
    help_line = _find_lone_entry_help(node, schema_part) or (
        schema_part["patternErrorMessage"] if is_quantity else _find_container_help(name, node, schema_part)
    )
    return "wrong-type", f"{name} is {actual}, but must be {expected}", help_line


def _find_scalar_help(node: ScalarNode, schema_part: dict[str, Any]) -> str | None:
    text = node.text
    types = schema_part.get("type", ())
    if "boolean" in types:
        return _find_boolean_help(text.lower())
    if "integer" in types:
        digits = re.match(r"\s*([0-9]+)", text)
        return f"write `{digits[1]}`, without quotes, point or unit" if digits else "write a number without unit"
    if "propertyNames" in schema_part:
        return "write one `id: ...` line for each below it, or `{}` for none"
    if "array" in types:
        return describe_list(clip_text(text), schema_part)
    if "patternErrorMessage" in schema_part:
        return str(schema_part["patternErrorMessage"])
    return _describe_keys((node,), schema_part["properties"]) if schema_part.get("properties") else None


def _find_boolean_help(word: str) -> str | None:
    if word in _BOOLEAN_WORDS:
        return f"write `{_BOOLEAN_WORDS[word]}`"
    return f"write `{word}`, without quotes" if word in {"true", "false"} else None


def _find_lone_entry_help(node: YamlNode, schema_part: dict[str, Any]) -> str | None:
    """Return what helps where a value stands in a list of one that takes no list."""
    if not isinstance(node, SequenceNode) or len(node.items) != 1 or {"object", "array"} & {*_list_types(schema_part)}:
        return None
    entry = node.items[0]
    return f"write `{clip_text(entry.text)}`, without brackets" if isinstance(entry, ScalarNode) else None


def _find_container_help(name: str, node: YamlNode, schema_part: dict[str, Any]) -> str | None:
    if isinstance(node, MappingNode) and name in _LISTS_OF_ELEMENTS:
        return _find_element_help(name.removeprefix("an entry of "), node)
    if isinstance(node, SequenceNode) and "object" in schema_part.get("type", ()):
        if not node.items:
            return "write `{}` for none"
        if "propertyNames" in schema_part or isinstance(schema_part.get("additionalProperties"), dict):
            entries = _write_as_keys(node.items)
            return f"{name} is keyed by id: write {f'`{entries}`' if entries else '`id: ...` lines'} instead of a list"
        return _describe_keys(node.items, schema_part["properties"]) if schema_part.get("properties") else None
    is_braces = isinstance(node, MappingNode) and node.span.line == node.span.end_line
    if isinstance(node, MappingNode) and ("array" in schema_part.get("type", ()) or is_braces):
        is_list_asked = "array" in schema_part.get("type", ())
        return (
            "write a list: [a, b], or one entry a line, each after `- `"
            if is_list_asked
            else "text with braces must be quoted"
        )
    return str(schema_part["patternErrorMessage"]) if "patternErrorMessage" in schema_part else None


def _describe_keys(entries: Sequence[YamlNode], keys: dict[str, Any]) -> str:
    """Return which keys are asked, with what stands in their place below the one that holds things by id, if just one does."""
    open_keys = [key for key, part in keys.items() if isinstance(part.get("additionalProperties"), dict)]
    example = _write_as_keys(entries) if len(open_keys) == 1 else ""
    return f"its keys are {join_quoted(tuple(keys))}{f': write `{{{open_keys[0]}: {example}}}`' if example else ''}"


def _write_as_keys(entries: Sequence[YamlNode]) -> str:
    """Return a few ids, alone or each before a colon, as keys in braces; nothing where there are many, or others."""
    bodies: dict[str, str] = {}
    for each in entries:
        bodies |= {each.text: ""} if isinstance(each, ScalarNode) else {}
        bodies |= dict.fromkeys(each.entries, "...") if isinstance(each, MappingNode) else {}
    is_short = len(bodies) == len(entries) <= _SHORT_LIST and all(map(re.compile(r"[A-Za-z_][\w-]*\Z").match, bodies))
    return f"{{{', '.join(f'{key}: {{{body}}}' for key, body in bodies.items())}}}" if is_short else ""


_SHORT_LIST = 6
"""So many ids are written out."""
_LISTS_OF_ELEMENTS = frozenset({"an entry of `inputs`", "an entry of `outputs`", "an entry of `components`"})


def _find_element_help(name: str, element: MappingNode) -> str:
    """Return how an entry of a list is written where elements are keyed by id."""
    first = next(iter(element.entries.values()), None)
    if first is not None and first.key in {"name", "id"} and isinstance(first.value, ScalarNode):
        return f"{name} is keyed by id: write `{suggest_ids(first.value.text)[1]}:` instead of `- {first.key}: {clip_text(first.value.text)}`"
    return f"take the `- ` away: {name} is keyed by id"


def _describe_wrong_value(kind: str, name: str, node: YamlNode, schema_part: dict[str, Any]) -> tuple[str, str | None]:
    text = node.text if isinstance(node, ScalarNode) else ""
    dimension = find_dimension(schema_part)
    if kind == "pattern" and dimension:
        return describe_wrong_quantity(name, text, dimension, schema_part)
    if kind == "const":
        return (
            f"this archgen reads version {schema_part[kind]} of the language, not `{clip_text(text)}`",
            f"write `{schema_part[kind]}`",
        )
    if kind in {"maxLength", "minLength"}:
        return (
            f"{name} is too {'long' if kind == 'maxLength' else 'short'}",
            f"the limit is {schema_part[kind]} characters",
        )
    if text != text.strip() and re.search(schema_part.get("pattern", ""), text.strip()):
        return f"{name} has a blank at its beginning or end", f"write `{text.strip()}`"
    is_entry = name.startswith("an entry")
    return f"{name} cannot be `{clip_text(text)}`", _find_value_help(kind, text, schema_part, is_entry=is_entry)


_WORD_PATTERN = re.compile(r"\^\(\?:([a-z0-9_|]+)\)\$\Z")
"""A pattern that is a list of words."""


def _find_pattern_help(text: str, schema_part: dict[str, Any], *, is_entry: bool) -> str | None:
    """Return what was most likely meant by a text that does not match its pattern; None where nobody knows."""
    list_help = _find_list_help(text, schema_part) if "items" in schema_part else None
    if list_help:
        return list_help
    if is_entry and split_ids(text, {"items": schema_part}):
        return "write each as an entry of its own, with a comma between them"
    words = _WORD_PATTERN.match(schema_part["pattern"])
    if words:
        return did_you_mean(text, words[1].split("|")) or did_you_shorten(text, words[1].split("|"))
    if schema_part.get("title") in {"Message", "Type"}:
        return _suggest_message(text, schema_part["pattern"])
    return None


def _find_list_help(text: str, schema_part: dict[str, Any]) -> str | None:
    if text in schema_part.get("properties", ()):
        return None  # a key where what it holds is asked: `trigger: match`
    if re.search(resolve_part(schema_part["items"]).get("pattern", r"\Z."), text):
        return f"write `[{clip_text(text)}]`"  # the name of an input as trigger: a list of one
    if split_ids(text, schema_part):
        return f"write `{suggest_list(text, schema_part)}`"
    return None


def _suggest_message(text: str, pattern: str) -> str | None:
    """Return a message as ROS writes it: `nav_msgs::msg::Odometry` and `nav_msgs/msg/odometry` are others' spellings."""
    package, slash, name = re.sub(r"::|\.|/", "/", text).rpartition("/")
    package = re.sub(r"/(msg|srv|action)s\Z", r"/\1", package)
    message = f"{package}{slash}{''.join(word[:1].upper() + word[1:] for word in name.split('_'))}"
    return f"did you mean `{message}`?" if re.search(pattern, message) else None


def _find_value_help(kind: str, text: str, schema_part: dict[str, Any], *, is_entry: bool) -> str | None:
    if kind == "pattern" and schema_part.get("title") == "Command":
        return suggest_words(clip_text(text))
    if kind == "pattern":
        help_line = _find_pattern_help(text, schema_part, is_entry=is_entry)
        if help_line:
            return help_line
        lowered = text.lower()
        if lowered != text and re.search(schema_part["pattern"], lowered) and schema_part["pattern"] == "^[a-z]+$":
            return f"did you mean `{lowered}`?"
    if kind == "enum":
        options = [option for option in schema_part["enum"] if option is not None]
        return did_you_mean(text, options) or f"it is one of {join_quoted(options)}"
    if kind in {"minimum", "maximum"}:
        return f"it is at {'least' if kind == 'minimum' else 'most'} {schema_part[kind]}"
    return schema_part.get("patternErrorMessage")


def _describe_expected(schema_part: dict[str, Any]) -> str:
    types = [kind for kind in _list_types(schema_part) if kind != "null"]
    phrases = ["text"] if "string" in types else []
    if "enum" in schema_part:
        phrases = [f"one of {join_quoted([option for option in schema_part['enum'] if option is not None])}"]
    phrases += [
        _TYPE_PHRASES[kind] for kind in types if kind in _TYPE_PHRASES and not ("string" in types and kind == "boolean")
    ]
    if "number" in types and "boolean" not in types:
        phrases = ["a number", *(word for word in phrases if word != "text")]
    return join_words(phrases, "or")


def _list_types(schema_part: dict[str, Any]) -> list[str]:
    types = schema_part.get("type", [])
    return [types] if isinstance(types, str) else types


def _describe_place(place: ErrorPlace) -> str:
    keys = [step for step in place.path if isinstance(step, str)]
    if not keys:
        return "the file"
    return f"an entry of `{keys[-1]}`" if isinstance(place.path[-1], int) else f"`{keys[-1]}`"


def element_of_path(path: tuple[str | int, ...]) -> str | None:
    """Return the id of the element that a path leads into, or None outside of all elements."""
    match path:
        case ("variants", variant, "changes", *rest):
            return element_of_path(tuple(rest)) or str(variant)
        case ("groups" | "component_types", element, *rest):
            ids = [str(element)]
            # A component inside another has an id of as many parts as it lies deep.
            while rest[:1] == ["components"] and rest[1:]:
                ids.append(str(rest[1]))
                rest = rest[2:]
            return ".".join(ids)
        case (section, element, *_) if section in SECTIONS_BY_ID:
            return str(element)
    return None


def add_article(title: str) -> str:
    """Return the title of an element as a sentence uses it: `a component`."""
    word = title if title[:3].isupper() else title[0].lower() + title[1:]
    return f"{'an' if word[0] in 'aeioAEIO' else 'a'} {word}"


def join_quoted(words: tuple[str, ...] | list[str]) -> str:
    """Return words in backticks, with commas."""
    return ", ".join(f"`{word}`" for word in words)
