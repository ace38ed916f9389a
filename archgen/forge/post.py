"""One comment for each key: found again by a mark in its first line, changed where it is there, made where it is not."""

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

    `author` is a pair of paths into a comment's data, and the value that stands there if it is ours.
    """

    api: Api
    comments: str
    one: str
    change: Literal["PATCH", "PUT"]
    author: tuple[str, str, object]
    most: int


def put(request: Request, text: str, key: str) -> Posted:
    """Change our comment of this key, or make it."""
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
        if written.replace("\r\n", "\n").strip() == body.strip():
            return "unchanged"
        request.api.ask(request.change, f"{request.one}/{int(comment['id'])}", {"body": body})
        return "updated"
    request.api.ask("POST", request.comments, {"body": body})
    return "created"


def _ours(request: Request) -> Iterator[dict[str, Any]]:
    """Give the comments that we wrote; a stranger who copies the mark does not get his own comment changed."""
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
        if len(found) < _PAGE:
            return
        page += 1
