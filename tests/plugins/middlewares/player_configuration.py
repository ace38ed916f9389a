"""Reads a configuration of Player as its server does: words, texts in quotes, lists in brackets, sections in parentheses."""

from __future__ import annotations

import re

_TOKEN = re.compile(
    r'[ \t\n]+|#(?P<comment>[^\n]*)|"(?P<text>[^"\n]*)"|(?P<word>[A-Za-z_]\w*)|(?P<number>[+-]?[0-9][\w.+-]*)|(?P<sign>[()\[\]])'
)
_COMMENT_SIZE = 250
_WORD_SIZE = 1000
_ADDRESS_SIZE = 127


def read_configuration(text: str) -> list[dict[str, str | list[str]]]:
    """Return the sections `driver`, each with its options; what the server cannot read is an AssertionError."""
    tokens: list[tuple[str, str]] = []
    position = 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        assert match, text[position : position + 60]
        position = match.end()
        if match.lastgroup == "comment":
            assert len(match[0].encode()) < _COMMENT_SIZE, match[0]
        elif match.lastgroup:
            assert len(match[0].encode()) < _WORD_SIZE
            tokens.append((match.lastgroup, match[match.lastgroup]))
    sections: list[dict[str, str | list[str]]] = []
    while tokens:
        assert tokens.pop(0) == ("word", "driver")
        assert tokens.pop(0) == ("sign", "(")
        options: dict[str, str | list[str]] = {}
        while tokens[0] != ("sign", ")"):
            kind, key = tokens.pop(0)
            assert kind == "word"
            assert key not in options, key
            kind, value = tokens.pop(0)
            if (kind, value) == ("sign", "["):
                listed: list[str] = []
                while tokens[0] != ("sign", "]"):
                    kind, item = tokens.pop(0)
                    assert kind in {"text", "number"}
                    listed.append(item)
                tokens.pop(0)
                options[key] = listed
            else:
                assert kind in {"text", "number"}
                options[key] = value
        tokens.pop(0)
        addresses = [*options.get("provides", ()), *options.get("requires", ())]
        assert all(len(each) < _ADDRESS_SIZE and each.count(":") == 4 for each in addresses), addresses
        sections.append(options)
    return sections
