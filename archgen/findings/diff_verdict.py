"""The verdict on breaking changes: how many, what the project's policy says, which accepted entries are idle."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare import Comparison
from archgen.diagnostic import Severity
from archgen.findings.escape import visible
from archgen.model.review import Accepted
from archgen.suggest import did_you_mean


def lines(found: Comparison) -> Iterator[str]:
    """Yield the verdict as plain text, one sentence a line."""
    yield visible(verdict(found))
    yield from map(visible, _cure(found))
    for entry in found.idle:
        yield visible(_idle(found, entry))


def verdict(found: Comparison) -> str:
    """Describe how many changes break whom, and whether the project refuses them."""
    if found.breaking is Severity.OFF:
        return "`review.breaking` is off: this project does not ask what breaks another partner"
    broken = [change for change in found.changes if change.breaks]
    if not broken:
        return "no change breaks another partner"
    partners = sorted({partner for change in broken for partner in change.broken})
    count = f"{len(broken)} breaking change{'' if len(broken) == 1 else 's'} for {', '.join(partners)}"
    accepted = sum(change.accepted is not None for change in broken)
    if accepted == len(broken):
        return f"{count}, accepted"
    some = f", {accepted} of them accepted" if accepted else ""
    if found.failing:
        return f"error: {count}{some}; `review.breaking: error` refuses what is not accepted"
    return f"{found.breaking}: {count}{some}"


def _cure(found: Comparison) -> Iterator[str]:
    """Describe what to write to accept the first change that is refused."""
    refused = [change for change in found.changes if change.breaks and change.accepted is None]
    if found.failing and refused:
        element = refused[0].element
        yield f"  = help: mend it, or agree on it and say why: `review: {{accepted: {{{element}: THE REASON}}}}`"


def _idle(found: Comparison, entry: Accepted) -> str:
    place = f" ({entry.at})" if entry.at.file else ""
    key = f" with the key `{entry.key}`" if entry.key else ""
    said = f"note: accepted entry `{entry.element}`{key}{place} names no breaking change here"
    # Ids of both versions: an entry may name an element that was removed.
    known = {e.own for listed in (found.told.before, found.told.after) for e in listed.values()}
    if entry.element in known:
        return said
    guess = did_you_mean(entry.element, known)
    return f"{said}, and nothing in either version has this id" + (f"; {guess}" if guess else "")
