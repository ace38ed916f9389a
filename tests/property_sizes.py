"""What a property test tries: an eighth of its examples in `make test`, all where slow tests are selected; the same each time.

Of samples that are tests of their own, `make test` tries the first, `make test-all` some, and `make properties` the others.

A property test writes `@settings(max_examples=count_examples(400))`; tests/conftest.py chooses the profile by pytest's
own `-m`, before any test is imported. With fewer examples the test is the same, so it needs no mark of its own.
"""

from __future__ import annotations

import os
from collections.abc import Iterable

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

FULL_PROFILE = "full"
QUICK_PROFILE = "quick"
_QUICK_SHARE = 8
"""The quick profile tries one example of so many."""
_QUICK_SEED_SHARE = 8
"""`make test` tries one seed of so many: the others are tests of their own."""
_SEED_SHARE = 3
"""`make test-all` tries one seed of so many, `make properties` the others."""

# The same draws in each run: a pull request must not turn red over a fault that was there before it. New draws are for those
# who look for such faults: `make properties`.
DRAWS_ANEW = bool(os.environ.get("ARCHGEN_DRAW_ANEW"))
# Of each twenty texts and numbers, Hypothesis takes one from the source code of the modules that are imported by then: a test
# would draw something else after other tests, and after any change of archgen. Each worker reads 900 files for it, too.
if not DRAWS_ANEW:
    providers._get_local_constants = lambda: providers._local_constants  # noqa: SLF001 - there is no setting for it
# How long an example takes says nothing about it where other tests run at the same time.
_SHARED = settings(derandomize=not DRAWS_ANEW, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile(FULL_PROFILE, _SHARED)
settings.register_profile(QUICK_PROFILE, _SHARED, max_examples=_SHARED.max_examples // _QUICK_SHARE)


def choose_profile(config: pytest.Config) -> str:
    """Choose the number of examples: all of them unless the markers that were asked for leave slow tests out."""
    name = QUICK_PROFILE if "not slow" in config.getoption("markexpr", "") else FULL_PROFILE
    settings.load_profile(name)
    return name


def count_examples(full_count: int) -> int:
    """Return the number of examples for a property that tries `full_count` in `make test-all`."""
    return full_count if settings.get_current_profile_name() == FULL_PROFILE else max(1, full_count // _QUICK_SHARE)


def list_seeds(full_count: int) -> list[pytest.ParameterSet]:
    """Return the numbers below `full_count` for a test that draws by one: an eighth for `make test`, a third for `make test-all`."""
    quick_count = max(1, full_count // _QUICK_SEED_SHARE)
    return try_some(range(full_count), quick_count, max(quick_count, full_count // _SEED_SHARE))


def try_some(
    samples: Iterable[object], quick_count: int = 1, shown_count: int | None = None
) -> list[pytest.ParameterSet]:
    """Return samples of which `make test-all` tries the first `shown_count`, and `make test` so many from all over these.

    All that are beyond those are for `make properties`. A sample of several parameters is a tuple.
    """
    values = list(samples)
    shown = values[:shown_count]
    quick = {index * len(shown) // quick_count for index in range(quick_count)}
    marked = [_mark_sample(each, *(() if index in quick else (pytest.mark.slow,))) for index, each in enumerate(shown)]
    further = [_mark_sample(each, pytest.mark.hypothesis) for each in values[len(shown) :]]
    return [*marked, *(further if DRAWS_ANEW else ())]


def _mark_sample(sample: object, *marks: pytest.MarkDecorator) -> pytest.ParameterSet:
    if isinstance(sample, pytest.ParameterSet):
        return pytest.param(*sample.values, marks=[*sample.marks, *marks], id=sample.id)
    return pytest.param(*(sample if isinstance(sample, tuple) else (sample,)), marks=marks)
