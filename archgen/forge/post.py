"""One comment for each key: found by a mark in its first line, updated if it exists, created if not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

from archgen.forge.http import Api, ForgeError

Posted = Literal["created", "updated", "unchanged"]
_PAGE = 100
_KEY = re.compile(r"[A-Za-z0-9_./-]+")


@dataclass(frozen=True, slots=True)
class Request:
    """A pull request as its API sees it: where its comments are listed, where one is changed, and who writes ours.

    `author_path` is two keys that lead to a comment's author, and the value found there if the comment is ours.
    """

    api: Api
    comments: str
    one: str
    change: Literal["PATCH", "PUT"]
    author: tuple[str, str, object]
    most: int


def put(request: Request, text: str, key: str) -> Posted:
    """Update our comment of this key, or create it. Raise ForgeError."""
    if not _KEY.fullmatch(key):
        msg = f"the key {key!r} may hold letters, digits, `_`, `.`, `/` and `-` only"
        raise ForgeError(msg)
    mark = f"<!-- archgen: {key} -->"
    body = f"{mark}\n{text.strip()}\n"
    if len(body) > request.most:
        msg = f"the text has {len(body):,} characters, a comment takes {request.most:,}"
        raise ForgeError(msg)
    for comment in _ours(request):
        written = comment.get("body")
        if not isinstance(written, str) or written.split("\n", 1)[0].rstrip("\r") != mark:
            continue
        # Forges may change line ends and blanks; an unchanged comment is not written again.
        if written.replace("\r\n", "\n").strip() == body.strip():
            return "unchanged"
        request.api.ask(request.change, f"{request.one}/{int(comment['id'])}", {"body": body})
        return "updated"
    request.api.ask("POST", request.comments, {"body": body})
    return "created"


def _ours(request: Request) -> Iterator[dict[str, Any]]:
    """Yield the comments that we wrote; the comment of a stranger who copies the mark is never changed."""
    outer, inner, wanted = request.author
    page = 1
    while True:
        found = request.api.ask("GET", f"{request.comments}?per_page={_PAGE}&page={page}")
        if not isinstance(found, list):
            msg = "the list of comments is no list"
            raise ForgeError(msg)
        for comment in found:
            if isinstance(comment, dict) and (comment.get(outer) or {}).get(inner) == wanted:
                yield comment
        # A short page is the last one; the Link header is not needed.
        if len(found) < _PAGE:
            return
        page += 1
