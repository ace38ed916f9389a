"""One element of a version in normal form: equal elements mean the same, however they are written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from archgen.frozen import dataclass

SOME_PORTS = "some"
"""Value of the keys "inputs" and "outputs" of a component that has ports: these are elements of their own."""
MAPPED_KEY = "mapped"
"""Key of a component that says whether somebody wrote a node for it."""
ElementKey = tuple[str, str]
"""A kind of element and a common id."""


@dataclass(frozen=True, slots=True)
class ComparedElement:
    """One element. `id` is the common id, `own_id` the one in its version; `parent_key` is the element that it is added
    and removed with.

    `owner` is a partner; `is_declared` is False for what exists without a declaration (a type that is only used).
    """

    kind: str
    id: str
    own_id: str
    values: Mapping[str, object]
    parent_key: ElementKey | None = None
    owner: str | None = None
    is_declared: bool = True
    component_refs: tuple[str, ...] = ()
    """Common ids of the components behind it; for a port of a node, the id of the component's port."""
    file: str = field(default="", compare=False)
    """Where it is declared: an element that moves between files has not changed."""
