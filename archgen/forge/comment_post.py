"""One comment for each key: found by a mark in its first line, updated if it exists, created if not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, Literal

from archgen.forge.forge_api import ForgeApi, ForgeError
from archgen.frozen import dataclass

CommentOutcome = Literal["created", "updated", "unchanged"]
_KEY_PATTERN = re.compile(r"[A-Za-z0-9_./-]+")


@dataclass(frozen=True, slots=True)
class CommentTarget:
    """A pull request as its API sees it: where its comments are listed, where one is changed, and who writes ours.

    `author_path` is two keys that lead to a comment's author, and the value found there if the comment is ours.
    """

    api: ForgeApi
    list_path: str
    comment_path: str
    change_method: Literal["PATCH", "PUT"]
    author_path: tuple[str, str, object]
    max_length: int


def put_comment(target: CommentTarget, text: str, key: str, *, creates: bool = True) -> CommentOutcome:
    """Update our comment of this key, or create it unless `creates` is False. Raise ForgeError."""
    if not _KEY_PATTERN.fullmatch(key):
        msg = f"the key {key!r} may hold letters, digits, `_`, `.`, `/` and `-` only"
        raise ForgeError(msg)
    marker = f"<!-- archgen: {key} -->"
    body = f"{marker}\n{text.strip()}\n"
    if len(body) > target.max_length:
        msg = f"the text has {len(body):,} characters, a comment takes {target.max_length:,}"
        raise ForgeError(msg)
    for comment in _own_comments(target):
        old_body = comment.get("body")
        if not isinstance(old_body, str) or old_body.split("\n", 1)[0].rstrip("\r") != marker:
            continue
        # Forges may change line ends and blanks; an unchanged comment is not written again.
        if old_body.replace("\r\n", "\n").strip() == body.strip():
            return "unchanged"
        target.api.send_request(target.change_method, f"{target.comment_path}/{comment['id']}", {"body": body})
        return "updated"
    if not creates:
        return "unchanged"
    target.api.send_request("POST", target.list_path, {"body": body})
    return "created"


def _own_comments(target: CommentTarget) -> Iterator[dict[str, Any]]:
    """Yield the comments that we wrote; the comment of a stranger who copies the mark is never changed."""
    user_key, id_key, our_id = target.author_path
    for comment in target.api.list_items(target.list_path, "comments, and ours is not among them"):
        author = comment.get(user_key) if isinstance(comment, dict) else None
        # The number becomes part of an address.
        if isinstance(author, dict) and author.get(id_key) == our_id and isinstance(comment.get("id"), int):
            yield comment
