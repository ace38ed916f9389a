"""How many examples a property test tries: a quarter in `make test`, all of them where slow tests are selected.

A property test writes `@settings(max_examples=count_examples(400))`; tests/conftest.py chooses the profile by pytest's
own `-m`, before any test is imported. With fewer examples the test is the same, so it needs no mark of its own.
"""

from __future__ import annotations

import os

import pytest
from hypothesis import settings

FULL_PROFILE = "full"
QUICK_PROFILE = "quick"
_QUICK_SHARE = 4
"""The quick profile tries one example of so many."""

# The same draws in each run: a pull request must not turn red over a fault that was there before it. New draws are for those
# who look for such faults: `make properties`.
_DRAWS_ANEW = bool(os.environ.get("ARCHGEN_DRAW_ANEW"))
settings.register_profile(FULL_PROFILE, derandomize=not _DRAWS_ANEW)
settings.register_profile(QUICK_PROFILE, derandomize=not _DRAWS_ANEW)


def choose_profile(config: pytest.Config) -> str:
    """Choose the number of examples: all of them unless the markers that were asked for leave slow tests out."""
    name = QUICK_PROFILE if "not slow" in config.getoption("markexpr", "") else FULL_PROFILE
    settings.load_profile(name)
    return name


def count_examples(full_count: int) -> int:
    """Return the number of examples for a property that tries `full_count` in `make test-all`."""
    return full_count if settings.get_current_profile_name() == FULL_PROFILE else max(1, full_count // _QUICK_SHARE)
