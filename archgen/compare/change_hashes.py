"""The short hash of what was agreed: an acceptance that carries it excuses this change and no other.

Only what is written goes into it. With figures that are derived, a merge elsewhere would make agreements stale.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Sequence

from archgen.compare.comparison import Change
from archgen.compare.normal_values import to_plain_data
from archgen.compare.version_pair import VersionPair

_HASH_DIGITS = 6


def hash_values(values: Sequence[object]) -> str:
    """Return the first digits of the SHA-256 of values as canonical JSON."""
    text = json.dumps(values, sort_keys=True, separators=(",", ":"), default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:_HASH_DIGITS]


def agreement_key(change: Change) -> str:
    """Return what an entry has to name as the `key` of a change: `removed`, `renamed` and so on where no key changed."""
    return change.key or change.kind


def _summarize_change(change: Change, versions: VersionPair) -> list[object]:
    """Return element, key, and the values before and after: those of a new element, of a removed one what goes with it."""
    before, after = change.before, change.after
    match change.kind:
        case "added":
            after = [_list_values(each, versions) for each in _walk_written(change)]
        case "removed":
            before = [[each.element_kind, each.element_id] for each in _walk_written(change)]
        case "renamed" | "moved":
            before, after = change.old_id, change.element_id
    return [change.element_id, agreement_key(change), before, after]


def hash_change(change: Change, versions: VersionPair) -> str:
    """Return the hash of a change."""
    return hash_values(_summarize_change(change, versions))


def hash_fallen_limit(port: str, key: str, limit: str, causes: Iterable[Change], versions: VersionPair) -> str:
    """Return the hash of a promise or freshness that is kept no more: which one, its limit, and what caused that."""
    return hash_values([port, key, limit, *(_summarize_change(cause, versions) for cause in causes)])


def _walk_written(change: Change) -> Iterator[Change]:
    """Yield a change with what came or went with it, without the connections that follow from that."""
    if change.element_kind != "connection":
        yield change
    for part in change.parts:
        yield from _walk_written(part)


def _list_values(change: Change, versions: VersionPair) -> list[object]:
    element = versions.elements_after.get((change.element_kind, change.element_id))
    values = {key: to_plain_data(value) for key, value in element.values.items()} if element else {}
    return [change.element_kind, change.element_id, values]
