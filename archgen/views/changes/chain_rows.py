"""The rows of the table of chains in a comparison, as text."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare import ChainChange
from archgen.compare.key_phrases import name_key
from archgen.diagnostics.common_wording import join_words
from archgen.frozen import dataclass
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.figure_wording import format_compared, format_duration, name_unknown_reason

_MAX_CAUSES = 3
MINUS_SIGN = "\u2212"


@dataclass(frozen=True, slots=True)
class ChainRow:
    """A chain whose bound or deadline changed. `growth`, `deadline` and `verdict` are empty where there is none."""

    id: str
    before: str
    after: str
    growth: str
    """Signed: `+40 ms`, or with a true minus."""
    deadline: str
    verdict: str
    reason: str
    """What made the bound another: elements, with what changed of them; names in backticks."""


def make_chain_row(chain_change: ChainChange, *, is_only_edit: bool = False) -> ChainRow:
    """Return the row of a chain. Where there is only one edit, nobody asks for the reason."""
    before, after = _format_bounds(chain_change)
    return ChainRow(
        chain_change.id,
        before,
        after,
        _format_growth(chain_change),
        _format_deadline(chain_change),
        _format_verdict(chain_change),
        "" if is_only_edit else _format_causes(chain_change),
    )


def _format_causes(chain_change: ChainChange) -> str:
    """Name the elements behind another bound, each with what changed of it; the sentences stand with the changes."""
    keys_by_element: dict[str, list[str]] = {}
    for change in chain_change.causes:
        if (change.element_kind, change.element_id) == ("chain", chain_change.id):
            return "where it leads now"  # nothing else is looked for then
        words = name_key(change.element_kind, change.key) if change.key else change.kind
        keys_by_element.setdefault(change.element_id, []).append(words)
    phrases = [f"`{name}` ({join_words(list(dict.fromkeys(words)))})" for name, words in keys_by_element.items()]
    surplus = len(phrases) - _MAX_CAUSES
    return join_words([*phrases[:_MAX_CAUSES], *([f"{surplus} more"] if surplus > 0 else [])])


def _format_bounds(chain_change: ChainChange) -> Iterator[str]:
    """Yield how long a chain takes at most, before and after."""
    results = chain_change.before, chain_change.after
    values = [each.bound.value for each in results if each and each.bound.value is not None]
    deadline = chain_change.deadline.value if chain_change.deadline else None
    texts = iter(format_compared(values, format_duration, limit=deadline))
    for result in results:
        if result is None:
            yield "not there"
        elif result.bound.value is None:
            yield name_unknown_reason(result.bound)
        else:
            yield ("" if result.bound.complete else "at least ") + next(texts)


def _format_growth(chain_change: ChainChange) -> str:
    """Format by how much a bound grew or shrank; empty if that is unknown or nothing."""
    # The difference to an "at least" is no difference.
    old_bound, new_bound = (
        chain_result.bound.value if chain_result and chain_result.bound.complete else None
        for chain_result in (chain_change.before, chain_change.after)
    )
    if old_bound is None or new_bound is None or old_bound == new_bound:
        return ""
    return f"{'+' if new_bound > old_bound else MINUS_SIGN}{format_compared([abs(new_bound - old_bound)], format_duration)[0]}"


def _format_deadline(chain_change: ChainChange) -> str:
    """Format the deadline of the second version; if it changed, with the old one."""
    old_deadline, new_deadline = (
        _format_result_deadline(chain_result) for chain_result in (chain_change.before, chain_change.after)
    )
    if chain_change.before and chain_change.after and old_deadline != new_deadline:
        return f"{old_deadline or 'none'} → {new_deadline or 'none'}"
    return new_deadline or old_deadline


def _format_result_deadline(result: ChainResult | None) -> str:
    return format_duration(result.deadline.value) if result and result.deadline and result.deadline.value else ""


def _format_verdict(chain_change: ChainChange) -> str:
    """Format whether the deadline is met, and whether it was before if that differs."""
    old_verdict, new_verdict = (
        chain_result.verdict if chain_result and chain_result.deadline and chain_result.deadline.value else ""
        for chain_result in (chain_change.before, chain_change.after)
    )
    if not new_verdict:
        return ""
    return f"{new_verdict} (was {old_verdict})" if old_verdict and old_verdict != new_verdict else new_verdict
