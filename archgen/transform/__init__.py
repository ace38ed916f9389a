"""Passes that complete a linked architecture before it is judged and shown: architecture in, architecture out."""

from __future__ import annotations

from collections.abc import Callable

from archgen.model.architecture import Architecture
from archgen.transform.low_level import derive_low_level

TransformPass = Callable[[Architecture], Architecture]

TRANSFORM_PASSES: tuple[TransformPass, ...] = (derive_low_level,)
"""All passes, in the order in which they run."""


def transform_architecture(architecture: Architecture) -> Architecture:
    """Run all passes."""
    for run_pass in TRANSFORM_PASSES:
        architecture = run_pass(architecture)
    return architecture


__all__ = ["TRANSFORM_PASSES", "derive_low_level", "transform_architecture"]
