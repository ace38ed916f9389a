"""Tests of what makes a finding the same one."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.finding_identity import identify_finding, match_findings, number_findings
from archgen.diagnostics.source_span import Span

_FINDING = Diagnostic(
    "late-chain", "the chain `k2` may take 612 ms, 1.5 times", Span("a.yaml", 3, 1, 3, 5), element="k2"
)


def _same(message: str) -> bool:
    return identify_finding(replace(_FINDING, message=message)) == identify_finding(_FINDING)


def test_places_labels_and_help_are_nothing() -> None:
    moved = replace(_FINDING, span=Span("b.yaml", 9, 1, 9, 5), help="x")
    assert identify_finding(moved) == identify_finding(_FINDING)


def test_names_are_everything_and_other_words_nothing() -> None:
    assert _same("`k2` is late by 9,000 ms")
    assert not _same("the chain `k3` may take 612 ms, 1.5 times")
    assert not _same("the chain `k2` may take `612` ms, 1.5 times")


def test_a_message_that_names_nothing_is_its_words_without_figures() -> None:
    said = [
        identify_finding(replace(_FINDING, message=f"{words} is  late by {n} ms"))
        for n, words in enumerate(["it", "it", "R-80"])
    ]
    assert [finding.subject for finding in said] == ["it is late by 0 ms", "it is late by 0 ms", "R-80 is late by 0 ms"]


def test_numbers_in_names_outside_of_backticks_stay() -> None:
    said = [replace(_FINDING, message=f"{name} is late") for name in ("R-80", "arm_2", "mp3", "2d", "v1.2")]
    assert [identify_finding(finding).subject for finding in said] == [finding.message for finding in said]


def test_findings_that_are_alike_are_numbered() -> None:
    found = list(number_findings([_FINDING, replace(_FINDING, element="k3"), _FINDING]))
    assert [number for _, _, number in found] == [1, 1, 2]
    prints = {same.fingerprint(number) for _, same, number in found}
    assert len(prints) == 3
    assert all(len(text) == 32 for text in prints)


class _Renames:
    """`eyes` is called `sensing` now."""

    def rename_in_text(self, text: str) -> str:
        """Put the new name in."""
        return text.replace("eyes", "sensing")

    def rename_in_backticks(self, text: str) -> str:
        """Put the new name in between backticks."""
        return text.replace("`eyes", "`sensing")


def test_renames_are_followed() -> None:
    old = replace(_FINDING, message="`eyes.camera` eyes", element="eyes.camera")
    new = replace(_FINDING, message="`sensing.camera` eyes", element="sensing.camera")
    assert identify_finding(old, _Renames()) == identify_finding(new) != identify_finding(old)


def test_what_agrees_more_is_matched_first() -> None:
    now = [("line 1", "x"), ("line 2", "x"), ("line 9", "y"), ("line 3", "x")]
    before = [("line 8", "z"), ("line 2", "x"), ("line 7", "x")]
    assert match_findings(now, before) == (2, 1, None, None)


_PAIRS = st.lists(st.tuples(st.integers(0, 2), st.integers(0, 2)))


@given(_PAIRS, _PAIRS)
def test_as_many_are_matched_as_agree_at_all(now: list[tuple[int, int]], before: list[tuple[int, int]]) -> None:
    found = match_findings([((a, b), b) for a, b in now], [((a, b), b) for a, b in before])
    matched = [(now[place][1], before[was][1]) for place, was in enumerate(found) if was is not None]
    loose = [b for _, b in now], [b for _, b in before]
    assert all(one == other for one, other in matched)
    assert len(matched) == sum(min(loose[0].count(b), loose[1].count(b)) for b in range(3))
    assert len(set(found) - {None}) == len(matched)
