"""Names of elements that become one in generated code: refused with both places.

A number behind the second one would change with the order of elements, and code that somebody wrote would mean another one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.source_span import Span
from archgen.views.generation.generation_context import NOT_GENERATED


def find_name_clashes(names: Iterable[tuple[str, str, Span]], meaning: str) -> Iterator[Diagnostic]:
    """Yield a finding for each element whose generated name another one has, also on systems that ignore case.

    `names` are the generated name of each element, its id, and its place; `meaning` says what they name: `class`.
    """
    first_elements = dict[str, tuple[str, Span]]()
    for name, element, span in names:
        first_element, first_span = first_elements.setdefault(name.casefold(), (element, span))
        if first_element != element:
            yield Diagnostic(
                NOT_GENERATED.name,
                f"`{first_element}` and `{element}` give the same {meaning} `{name}`",
                span,
                NOT_GENERATED.severity,
                labels=(Label(first_span, "the first one"),),
                help="give one of them another id",
                element=element,
            )
