"""A comment on each open request: what it does only together with the others. Made by one job, put there by another one."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from archgen.diagnostics import format_json, join_words
from archgen.emit.markdown.comment_sentences import write_code, write_sentence, write_title
from archgen.emit.markdown.comparison_markdown import MAX_COMMENT_SIZE, LimitedComment
from archgen.forge.forge_api import ForgeError, run_within
from archgen.forge.pull_request import CommentOutcome, OpenRequest, find_request, put_comment
from archgen.frozen import NamedTuple
from archgen.merge.branch_results import BranchMerge
from archgen.merge.merge_sentences import describe_conflict

_VERSION = 1
_POSTING_SECONDS = 120.0


class RequestComment(NamedTuple):
    """What is said on a request. One that has nothing to tell only takes the place of an earlier one."""

    number: int
    text: str
    has_news: bool


def write_request_comments(
    main_line: str, requests: Sequence[OpenRequest], merges: Sequence[BranchMerge]
) -> tuple[RequestComment, ...]:
    """Write the comment of each request. The branches of `merges` are the refs of requests."""
    requests_by_ref = {request.ref: request for request in requests}
    return tuple(_write_comment(request, main_line, requests_by_ref, merges) for request in requests)


def _write_comment(
    request: OpenRequest, main_line: str, requests_by_ref: Mapping[str, OpenRequest], merges: Sequence[BranchMerge]
) -> RequestComment:
    told_merges = [merge for merge in merges if request.ref in merge.branches and merge.has_news]
    comment = LimitedComment(MAX_COMMENT_SIZE, write_code("archgen merge-check MAIN BRANCHES"))
    comment.add_block("### With the other open requests")
    if not told_merges:
        count = len(requests_by_ref) - 1
        with_others = f" and with {count} other open request{'s' * (count != 1)}" if count else ""
        comment.add_block(f"This goes with {write_code(main_line)}{with_others}.")
    for merge in told_merges:
        others = [requests_by_ref[ref] for ref in merge.branches if ref != request.ref]
        comment.add_items(_write_lead(request, others, main_line, merge), [f"- {line}" for line in _list_items(merge)])
    if comment.is_cut:
        comment.blocks.append(f"More does not fit here: {comment.command}")
    return RequestComment(request.number, "\n\n".join(comment.blocks), bool(told_merges))


def _write_lead(request: OpenRequest, others: Sequence[OpenRequest], main_line: str, merge: BranchMerge) -> str:
    """Say with which other requests there is something, whom it breaks, and who comes first."""
    if others:
        names = join_words([f"#{each.number} ({write_title(each.title)})" for each in others])
    else:
        names = f"what came to {write_code(main_line)} since it left"
    if merge.is_blocked:
        return f"**Together with {names} this conflicts.**"
    if not merge.joint_breaks.findings:
        outcome = "has new findings" if merge.new_findings else "conflicts in lines only"
        return f"**Together with {names} this {outcome}.**"
    broken = join_words([write_title(partner) for partner in merge.joint_breaks.partners])
    return f"**Together with {names} this breaks {broken}.** {_write_order(request, merge)}".rstrip()


def _write_order(request: OpenRequest, merge: BranchMerge) -> str:
    if not all(merge.sides):
        return ""
    if merge.order is None:
        return "Whichever is merged second does: they have to come together."
    first, second = (
        ["this one" if ref == request.ref else f"#{ref.rpartition('/')[2]}" for ref in side] for side in merge.order
    )
    return f"First {join_words(first)}, then {join_words(second)}, whose author has to look."


def _list_items(merge: BranchMerge) -> Iterator[str]:
    for conflict in merge.conflicts:
        yield write_sentence(describe_conflict(conflict))
    for finding in merge.findings:
        place = f" ({write_code(str(finding.span))})" if finding.span.file else ""
        yield f"{finding.severity} {write_code(finding.rule)}: {write_sentence(finding.message)}{place}"


def format_request_comments(comments: Sequence[RequestComment]) -> str:
    """Return comments as one JSON document, for the job that may write them."""
    return format_json({"version": _VERSION, "requests": [comment._asdict() for comment in comments]})


def read_request_comments(text: str) -> tuple[RequestComment, ...]:
    """Read what `format_request_comments` returned. Raise ForgeError for anything else."""
    try:
        document: Any = json.loads(text)
        comments = tuple(
            RequestComment(*(entry[key] for key in RequestComment._fields)) for entry in document["requests"]
        )
    except (ValueError, TypeError, KeyError, RecursionError):
        comments = None
    # A number becomes a part of an address.
    if comments is None or any([*map(type, comment)] != [int, str, bool] for comment in comments):
        raise ForgeError("these are no comments that `archgen check-requests -o` wrote")
    return comments


def post_request_comments(
    comments: Sequence[RequestComment], key: str, environment: Mapping[str, str] = os.environ
) -> Iterator[tuple[RequestComment, CommentOutcome | ForgeError]]:
    """Put each comment on its request, and yield what became of it: a request that was closed meanwhile stops no other."""

    def post(comment: RequestComment) -> CommentOutcome:
        return put_comment(find_request(environment, comment.number), comment.text, key, creates=comment.has_news)

    for comment in comments:
        try:
            yield comment, run_within(_POSTING_SECONDS, lambda comment=comment: post(comment))  # type: ignore[misc]
        except ForgeError as error:
            yield comment, error
