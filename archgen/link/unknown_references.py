"""Say that a reference names nothing, and what it may have meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import AskedName, Diagnostic, Label
from archgen.diagnostics.source_span import NO_SPAN, Span

if TYPE_CHECKING:
    from collections.abc import Sequence

    from archgen.syntax.yaml_tree import ScalarNode

_MAX_LISTED = 6
"""So many names are listed where no name resembles an unknown one."""


def diagnose_unknown_reference(  # noqa: PLR0913 - what it says
    reference: ScalarNode,
    kind_phrase: str,
    guess: str | None,
    declared_span: Span,
    element_id: str,
    *,
    known_names: Sequence[str] = (),
    asked_name: AskedName | None = None,
) -> Diagnostic:
    """Report that there is no such element, with what may have been meant, or all that there are if they are few."""
    return Diagnostic(
        "unknown-reference",
        f"no {kind_phrase} named `{reference.text}`",
        reference.span,
        labels=(Label(declared_span, "declared here"),) if guess and declared_span != NO_SPAN else (),
        help=f"did you mean `{guess}`?" if guess else list_known_names(known_names),
        element=element_id,
        asked_name=None if guess else asked_name,
    )


def list_known_names(names: Sequence[str]) -> str | None:
    """Return a help line with all names that could be meant, if there are few; else None."""
    if not 0 < len(names) <= _MAX_LISTED:
        return None
    return f"there {'are' if len(names) > 1 else 'is'} {join_words([f'`{name}`' for name in names], 'and')}"
