"""The rules about generating, which no project breaks by itself: `archgen generate` reports them."""

from __future__ import annotations

from archgen.views.generation.architecture_needs import UNMET_NEED
from archgen.views.generation.generation_context import NOT_GENERATED

GENERATION_RULES = (NOT_GENERATED, UNMET_NEED)
