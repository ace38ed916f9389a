"""Every help is true when it is followed: slips are planted, the help is done literally, and the model is looked at."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from tests.planted_slips import SEED, Outcome, Slip, follow_help, judge_text, list_slips
from tests.property_sizes import mark_further_samples
from tests.running import ROOT

SLIPS = tuple(list_slips())
_PARTS = 8
"""The fast tests try one part of the slips, the slow ones the others."""


def list_bad(slips: tuple[Slip, ...]) -> tuple[list[Outcome], Counter[str]]:
    """Follow the help of slips; return what is wrong, and how often each verdict came."""
    seed = judge_text(SEED)
    outcomes = [follow_help(slip, seed) for slip in slips]
    bad = [o for o in outcomes if not o.is_found or o.verdict in {"misleads", "fails"}]
    return bad, Counter(o.verdict for o in outcomes)


@pytest.mark.parametrize("part", mark_further_samples(range(_PARTS)))
def test_no_help_misleads_and_none_fails(part: int) -> None:
    bad, verdicts = list_bad(SLIPS[part::_PARTS])
    assert [(o.slip.kind, o.slip.name, o.help, o.verdict) for o in bad] == []
    assert verdicts["mended"] >= 0.8 * verdicts.total()


@pytest.mark.slow
def test_the_share_of_helps_that_mend_stands_in_the_manual() -> None:
    _, verdicts = list_bad(SLIPS)
    text = (ROOT / "docs/quality.md").read_text(encoding="utf-8")
    figures = re.search(r"Of ([0-9]+) planted slips ([0-9]+) are mended", text)
    assert figures is not None
    assert (int(figures[1]), int(figures[2])) == (verdicts.total(), verdicts["mended"])


def test_the_seed_is_sound() -> None:
    assert [finding.message for finding in judge_text(SEED).findings if finding.severity == "error"] == []
    assert len({slip.text for slip in SLIPS}) > 0.95 * len(SLIPS)
