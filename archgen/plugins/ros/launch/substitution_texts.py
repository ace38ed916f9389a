"""Read the texts of launch files in XML and YAML: what stands between `$(` and `)` becomes a substitution."""

from __future__ import annotations

import re

from archgen.plugins.ros.launch.launch_values import OPEN, LaunchValue, Substitution, UnknownValue, join_values

_MAX_DEPTH = 20
_KINDS = {
    "find-pkg-share": "share",
    "find": "share",
    "find-pkg-prefix": "prefix",
    "var": "var",
    "arg": "var",
    "env": "env",
    "optenv": "env",
    "not": "not",
    "and": "and",
    "or": "or",
    "equals": "equals",
    "not-equals": "differs",
}
_COMPARISONS = frozenset({"equals", "differs"})
_LEAST_WORDS = {word: 2 if kind in _COMPARISONS else 1 for word, kind in _KINDS.items()}
"""How many words each substitution needs, by its own word."""
_OWN_KINDS = frozenset({"join", "path", "share", "prefix", "differs", "text_of", "typed", "context"})
"""Kinds of substitutions that no launch file spells out."""
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_MANY_WORDS = frozenset({"eval", "command"})


def read_substituted_text(text: str, folder: str, *, is_ros_1: bool, depth: int = 0) -> LaunchValue:
    """Return a text with its substitutions. `folder` is what `$(dirname)` stands for."""
    if "$(" not in text or depth > _MAX_DEPTH:
        return text if is_ros_1 else _take_escapes(text)
    if is_ros_1 and text.strip().startswith("$(eval "):
        # In ROS 1 it takes the whole text, with all brackets in it.
        return Substitution("eval", (text.strip().removeprefix("$(eval ").removesuffix(")"),))
    parts: list[LaunchValue] = []
    position = 0
    while (start := _find_start(text, position, is_ros_1=is_ros_1)) >= 0:
        end = _find_end(text, start + 2)
        if end < 0:
            break
        if start > position:
            parts.append(text[position:start] if is_ros_1 else _take_escapes(text[position:start]))
        parts.append(_read_substitution(text[start + 2 : end], folder, is_ros_1=is_ros_1, depth=depth + 1))
        position = end + 1
    if position < len(text):
        parts.append(text[position:] if is_ros_1 else _take_escapes(text[position:]))
    return join_values(parts)


def fill_in_values(values: LaunchValue, folder: str, depth: int = 0) -> LaunchValue:
    """Return values of ROS 1 in YAML, nested as they are, with their substitutions."""
    if depth > _MAX_DEPTH:
        return UnknownValue("values nested very deep")
    if isinstance(values, dict):
        return {key: fill_in_values(value, folder, depth + 1) for key, value in values.items()}
    if isinstance(values, list):
        return [fill_in_values(value, folder, depth + 1) for value in values]
    if isinstance(values, str) and "$(" in values:
        return Substitution("typed", (read_substituted_text(values, folder, is_ros_1=True), "yaml"))
    return values


def _take_escapes(text: str) -> str:
    """Return a text of ROS 2 without the backslashes that keep a character as it is."""
    return _ESCAPE.sub(r"\1", text) if "\\" in text else text


def _find_start(text: str, position: int, *, is_ros_1: bool) -> int:
    """Return where the next substitution begins; -1 if there is none. In ROS 2 a backslash takes its meaning away."""
    start = text.find("$(", position)
    while start > 0 and not is_ros_1:
        backslashes = start - len(text[:start].rstrip("\\"))
        if start - backslashes < position:
            backslashes = start - position
        if backslashes % 2 == 0:
            return start
        start = text.find("$(", start + 2)
    return start


def _find_end(text: str, position: int) -> int:
    """Return where a substitution that begins before a position ends; -1 if it does not."""
    depth, quote = 1, ""
    while position < len(text):
        character = text[position]
        if character == "\\":
            position += 1
        elif quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        elif character == "(":
            depth += 1
        elif character == ")":
            depth -= 1
            if depth == 0:
                return position
        position += 1
    return -1


def _read_substitution(text: str, folder: str, *, is_ros_1: bool, depth: int) -> LaunchValue:
    word, _, rest = text.strip().partition(" ")
    rest = rest.strip()
    if word == "dirname":
        return folder
    kind = _KINDS.get(word)
    if word in _MANY_WORDS:
        # ROS 2 takes one word in quotes.
        return Substitution(word, (read_substituted_text(_strip_quotes(rest), folder, is_ros_1=is_ros_1, depth=depth),))
    words = [
        read_substituted_text(_strip_quotes(each), folder, is_ros_1=is_ros_1, depth=depth)
        for each in _split_words(rest)
    ]
    if word in _OWN_KINDS or len(words) < _LEAST_WORDS.get(word, 0) or (kind in _COMPARISONS and len(words) > 2):  # noqa: PLR2004 - it compares two
        # Not what any launch file of ROS says: nobody knows what would be filled in.
        return UnknownValue(f"$({text.strip()})")
    if word == "optenv":
        return Substitution("env", (words[0] if words else "", join_values(words[1:]) if words[1:] else ""))
    if word == "find-exec" and len(words) == 1:
        return words[0]
    return Substitution(kind or word or "$", tuple(words))


def _split_words(text: str) -> list[str]:
    """Split at blanks that stand in no quotes and no brackets."""
    words: list[str] = []
    word, depth, quote = "", 0, ""
    is_escaped = False
    for character in text:
        if is_escaped or character == "\\":
            is_escaped = not is_escaped
        elif quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        elif character in "()":
            depth += 1 if character == "(" else -1
        if character.isspace() and not quote and not depth:
            words += [word] if word else []
            word = ""
        else:
            word += character
    return [*words, word] if word else words


def _strip_quotes(text: str) -> str:
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "'\""
    return text[1:-1] if is_quoted and text[0] not in _ESCAPE.sub("", text[1:-1]) else text


def split_words(text: str) -> list[str]:
    """Return the words of a command line; quotes and backslashes keep blanks together."""
    words: list[str] = []
    word: list[str] = []
    is_word, quote, position = False, "", 0
    while position < len(text):
        character = text[position]
        if quote != "'" and text.startswith(OPEN, position) and (end := text.find(")", position)) > 0:
            word.append(text[position : end + 1])
            is_word, position = True, end
        elif character == "\\" and quote != "'" and position + 1 < len(text):
            position += 1
            keeps_backslash = quote == '"' and text[position] not in '"\\$`'
            word.append(f"\\{text[position]}" if keeps_backslash else text[position])
            is_word = True
        elif character == quote:
            quote = ""
        elif character in "'\"" and not quote:
            quote, is_word = character, True
        elif character.isspace() and not quote:
            words += ["".join(word)] if is_word else []
            word, is_word = [], False
        else:
            word.append(character)
            is_word = True
        position += 1
    return [*words, "".join(word)] if is_word else words
