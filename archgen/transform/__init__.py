"""Passes that complete a linked architecture before it is judged and shown: architecture in, architecture out."""

from __future__ import annotations

from collections.abc import Callable

from archgen.model.architecture import Architecture
from archgen.transform.derive import derive

Pass = Callable[[Architecture], Architecture]

PASSES: tuple[Pass, ...] = (derive,)
"""All passes, in the order in which they run."""


def transform(architecture: Architecture) -> Architecture:
    """Run all passes."""
    for one in PASSES:
        architecture = one(architecture)
    return architecture


__all__ = ["PASSES", "derive", "transform"]
