"""Every help is true when it is followed: slips are planted, the help is done literally, and the model is looked at."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from tests.planted_slips import SEED, Slip, follow_help, judge_text, list_slips
from tests.running import ROOT

SLIPS = tuple(list_slips())
_QUICK_SHARE = 8
"""The fast tests try one slip of so many."""


def list_bad(slips: tuple[Slip, ...]) -> tuple[list[tuple[str, str, str, str]], Counter[str]]:
    """Follow the help of slips; return where one misleads or fails, and how often each verdict came."""
    seed = judge_text(SEED)
    outcomes = [follow_help(slip, seed) for slip in slips]
    bad = [
        (o.slip.kind, o.slip.name, o.help, o.verdict)
        for o in outcomes
        if not o.is_found or o.verdict in {"misleads", "fails"}
    ]
    return bad, Counter(o.verdict for o in outcomes)


def test_no_help_misleads_and_none_fails() -> None:
    bad, verdicts = list_bad(SLIPS[::_QUICK_SHARE])
    assert bad == []
    assert verdicts["mended"] >= 0.8 * verdicts.total()


@pytest.mark.slow
def test_the_share_of_helps_that_mend_stands_in_the_manual() -> None:
    """Of all slips, of which none has a help that misleads or fails."""
    bad, verdicts = list_bad(SLIPS)
    assert bad == []
    text = (ROOT / "docs/quality.md").read_text(encoding="utf-8")
    figures = re.search(r"Of ([0-9]+) planted slips ([0-9]+) are mended", text)
    assert figures is not None
    assert (int(figures[1]), int(figures[2])) == (verdicts.total(), verdicts["mended"])


def test_the_seed_is_sound() -> None:
    assert [finding.message for finding in judge_text(SEED).findings if finding.severity == "error"] == []
    assert len({slip.text for slip in SLIPS}) > 0.95 * len(SLIPS)
