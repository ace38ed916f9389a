"""Hold an agreement against what was signed: which interfaces and terms are others now.

New titles and ids alone bind nobody to anything else, and are left out: the document still shows them.
"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.views.agreement.term_changes import AgreementChanges, TermChange


def list_departures(changes: AgreementChanges) -> Iterator[str]:
    """Yield a sentence for each interface or term that is not as it was signed."""
    for name, _ in sorted(changes.added_keys):
        yield f"`{name}` was not signed"
    for record in changes.removed_records:
        yield f"`{record.key[0]}` was signed, and is gone"
    for (name, _), change in sorted(changes.changes_by_key.items()):
        for term in change.terms:
            if term.kind not in {"renamed", "moved"} and term.term_kind != "title":
                yield f"`{name}`: {_describe_term(term)}"


def _describe_term(term: TermChange) -> str:
    if term.before is None:
        return f"{term.name} was not signed: {term.after}" if term.after else f"{term.name} was not signed"
    if term.after is None:
        return f"{term.name} was signed, and is gone: {term.before}"
    return f"{term.name} was signed as {term.before or 'nothing'}, and is {term.after or 'nothing'}"
