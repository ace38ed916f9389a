"""Interface agreements: what flows between two partners, as a document that both can sign."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from archgen.timing import activities
from archgen.views.agreement.changes import Changes, Held, compare
from archgen.views.agreement.document import Agreement, document
from archgen.views.agreement.interfaces import between
from archgen.views.agreement.picture import picture
from archgen.views.agreement.terms import plain, terms
from archgen.views.index import Index
from archgen.views.shapes import Graph, Outline, Paragraph

__all__ = ["Made", "agreement", "between"]


@dataclass(frozen=True, slots=True)
class Made:
    """An agreement: its outline, its picture, the number of interfaces, and the changes (None: not asked for)."""

    outline: Outline
    graph: Graph
    interfaces: int
    changes: Changes | None


def agreement(  # noqa: PLR0913 - what a document is made of
    view: Index,
    first: str,
    second: str,
    *,
    revision: str = "",
    since: tuple[str, Index] | None = None,
    notices: Sequence[Paragraph] = (),
) -> Made:
    """Make the agreement of two partners. `since` is the name of an earlier revision with its look-ups."""
    held = _held(view, first, second)
    changes = compare(since[0], _held(since[1], first, second), held) if since else None
    graph = picture(view, f"interfaces/{first}-{second}", (first, second), [each.terms.interface for each in held])
    before = since[1] if since else None
    made = Agreement(view, (first, second), held, graph, revision, changes, tuple(notices), before)
    return Made(document(made), graph, len(held), changes)


def _held(view: Index, first: str, second: str) -> tuple[Held, ...]:
    named = activities.names(view.architecture)
    found = [terms(view, named, each) for each in between(view, first, second)]
    return tuple(Held(each, plain(view, each)) for each in found)
