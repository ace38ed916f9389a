"""What a host makes of a comment: its tokens, and the text in which it looks for mentions, references and links."""

from __future__ import annotations

import re
from collections.abc import Iterator

from markdown_it import MarkdownIt
from markdown_it.token import Token

CALLS = re.compile(
    r"""
      (?<!\w)@[\w]            # a mention of a user or a team
    | (?<!\w)[\#!$%~&^][\w"]  # an issue, a merge request, a snippet, a milestone, a label, an epic, an alert
    | \w[\#!@][\w]            # the same in another repository; an e-mail address
    | \b[A-Za-z]+-\d          # GH-1, and prefixes that a repository defines
    | (?<![A-Za-z0-9])[0-9a-fA-F]{7,40}(?![A-Za-z0-9])   # a commit
    | :[\w+-]+:                   # an emoji
    | \w://|\bwww\.           # an address
    """,
    re.VERBOSE,
)
"""What GitHub and GitLab make something of, wherever it stands in rendered text but in code."""


def tokens(text: str) -> list[Token]:
    """Parse as the hosts do: HTML, tables, struck text, addresses that are no marked links."""
    parser = MarkdownIt("commonmark", {"html": True, "linkify": True}).enable(["table", "strikethrough", "linkify"])
    return parser.parse(text)


def inner(found: list[Token]) -> Iterator[Token]:
    """Give the tokens inside lines."""
    for token in found:
        yield from token.children or ()


def shape(found: list[Token]) -> list[str]:
    """Name the blocks, with the HTML that stands there and the fences' languages."""
    html = {"html_block"}
    return [f"{token.type} {token.content if token.type in html else token.info}" for token in found]


def words(found: list[Token]) -> str:
    """Give the text that stands outside of code."""
    return "\n".join(token.content if token.type == "text" else "`" for token in inner(found))
