"""All passes that ship with archgen, in the order in which they run where one needs the other."""

from __future__ import annotations

from archgen.passes.pass_shape import Pass
from archgen.passes.short_forms import COMPLETE_NAMES, NORMALISE_CONNECTIONS

PASSES: dict[str, Pass] = {each.name: each for each in (COMPLETE_NAMES, NORMALISE_CONNECTIONS)}
"""The passes by name."""
