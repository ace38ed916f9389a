"""Verdicts in colours where they fill a cell, and the short summary of timing for a screen."""

from __future__ import annotations

from pathlib import Path

from archgen.emit.terminal.state_paint import paint_progress, paint_states
from archgen.emit.terminal.timing_text import format_timing
from archgen.pipeline import check_project
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.run_analysis import analyse_architecture


def test_verdicts_have_the_colours_of_the_site_and_other_words_none() -> None:
    lines = [
        "Chains: open",
        *(f"  c  9 ms  {word}  open door" for word in VERDICT_WORDS.values()),
        "  open_gripper  1 ms",
        "",
    ]
    painted = list(paint_states(lines))
    assert painted[0] == "\x1b[1mChains: open\x1b[0m"
    assert painted[1:5] == [
        f"  c  9 ms  \x1b[{code}m{word}\x1b[0m  open door"
        for word, code in (("met", "32"), ("MISSED", "1;31"), ("not proven", "33"), ("open", "33"))
    ]
    assert painted[5:] == lines[5:]
    assert list(paint_states(["  host  in time", "  host  not proven in time  why"])) == [
        "  host  \x1b[32min time\x1b[0m",
        "  host  \x1b[33mnot proven in time\x1b[0m  why",
    ]


def test_shares_have_the_colours_of_their_bars() -> None:
    lines = ["Robot", "", "  Components  total   typed", "  Eyes 7 (100%)     2  2 (100%)  1 (50%)"]
    assert list(paint_progress(lines)) == [
        "\x1b[1mRobot\x1b[0m",
        *lines[1:3],
        "  Eyes 7 (100%)     2  \x1b[32m2 (100%)\x1b[0m  \x1b[33m1 (50%)\x1b[0m",
    ]


def test_a_history_has_the_same_colours() -> None:
    lines = ["when     typed  findings", "2026-01  50 %   -", "", "from 2026-01 to 2026-02", "of         typed"]
    row = "group Eyes  95 % → 100 %  -"
    assert list(paint_progress([*lines, row])) == [
        f"\x1b[1m{lines[0]}\x1b[0m",
        "2026-01  \x1b[33m50 %\x1b[0m   -",
        "",
        *(f"\x1b[1m{line}\x1b[0m" for line in lines[3:]),
        "group Eyes  \x1b[32m95 % → 100 %\x1b[0m  -",
    ]


def test_a_screen_shows_chains_hosts_and_links_and_counts_the_rest(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {o: T}, timing: {rate: 10 Hz, wcet: 1 ms}}, b: {inputs: {i: a.o}, timing: {rate: 10 Hz, wcet: 1 ms}}}}}\n"
        "types: {T: std_msgs/msg/Bool}\nnodes: {a: {implements: g.a, host: h}, b: {implements: g.b, host: h}}\nhosts: {h: {cores: 1}}\n"
    )
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    analysis = analyse_architecture(check_project(tmp_path).architecture)
    whole, short = (list(format_timing(analysis, {}, (), 80, is_short=each)) for each in (False, True))
    titles = [line.partition(":")[0] for line in short if line and not line.startswith(" ")]
    assert titles == ["Hosts", "Not shown, for a screen to have room"]
    assert "Elements (2)" in " ".join(short)
    assert "archgen timing --all" in " ".join(short)
    assert len(whole) > len(short)
    assert any("response" in line for line in whole)
