"""What the resolvers tell somebody who listens: where a reference is written, and which element it means.

Editors and `archgen rename` listen; nobody else pays for it.
"""

from __future__ import annotations

from archgen.diagnostics import Span
from archgen.frozen import NamedTuple


class HeardReference(NamedTuple):
    """A reference that was resolved: `text` as it is written at `span`, `kind` and complete `id` of what it means.

    `writer` is the element that writes it. A reference inside of a component type is heard once for each instance.
    """

    span: Span
    kind: str
    id: str
    text: str
    writer: str


HeardReferences = list[HeardReference]
