"""Which figure decides a chain: each improved by a tenth in turn; and which unknown one hides most."""

from __future__ import annotations

import pytest

from archgen.timing.chains import chain_sensitivity
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.chain_sensitivity import ChainSensitivity, find_sensitivity
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import MS
from tests.timing.sketches import read_sketch

HOSTS = """
hosts: {p: {cores: 1}, q: {cores: 1}}
links:
  lan: {connects: [p, q], latency: {best: 2900 us, worst: 3 ms}}
  wan: {connects: [q, p], latency: {best: 1 ms, worst: 10 ms}}
chains: {see: {through: [cam, act]}, other: {through: [cam, act]}}
"""
NODES = {
    "cam @p": "period: 40 ms, jitter: 5 ms, wcet: 3 ms, bcet: 3 ms",
    "act @q": "wcet: 8 ms, bcet: 1 ms",
    "side @q": "rate: 10 Hz, wcet: 2 ms",
    "idle @p": "rate: 10 Hz, wcet: 0 ms",
    "far": "period: 10 ms, wcet: 4 ms",
}


def _sensitivity(nodes: dict[str, str], wires: str, rest: str, chain: str = "see") -> ChainSensitivity:
    model = read_sketch(nodes, wires, rest)
    results = bound_all_chains(analyse_architecture(model), model)
    return find_sensitivity(model, model.chains[chain], analyse_architecture, results)


def _gains(found: ChainSensitivity) -> list[str]:
    return [
        f"{gain.figure} ({gain.written}) {float(gain.gain / MS):g} @{gain.at.line}:{gain.at.column}"
        for gain in found.gains
    ]


def test_a_tenth_of_each_figure_that_bears_on_the_chain() -> None:
    """40 + 5 + 3 + 3 + (8 + 2): a tenth of 40 is 4, of 8 0.8 and so on; the link cannot be quicker than 2.9 ms."""
    found = _sensitivity(NODES, "cam>act", HOSTS)
    assert _gains(found) == [
        "cam.timing.period (40 ms) 4 @10:52",
        "act.timing.wcet (8 ms) 0.8 @11:50",
        "cam.timing.jitter (5 ms) 0.5 @10:67",
        "cam.timing.wcet (3 ms) 0.3 @10:79",
        "side.timing.wcet (2 ms) 0.2 @12:65",
        "lan.latency.worst (3 ms) 0.1 @19:3",
    ]
    assert (found.gaps, found.untried) == ((), 0)


def test_what_fires_a_chain_bears_on_it_wherever_it_runs() -> None:
    """`thin` waits for one more gap of its source, 30 and its R of 4; what only is read does not count."""
    nodes = {
        "src": "period: 30 ms, wcet: 4 ms",
        "read": "period: 7 ms, wcet: 1 ms",
        "thin": "trigger: [src], every: 2, throttle: 20 ms, wcet: 1 ms, response: 5 ms",
        "end": "wcet: 1 ms",
    }
    found = _sensitivity(nodes, "src>thin read>thin thin>end", "chains: {see: {through: [thin, end]}}")
    assert [gain.figure for gain in found.gains] == [
        "src.timing.period",
        "thin.timing.throttle",
        "src.timing.wcet",
        "thin.timing.response",
        "end.timing.wcet",
    ]


def test_a_faster_rate_is_a_shorter_period() -> None:
    found = _sensitivity(
        {"cam": "rate: 10 Hz, wcet: 1 ms", "act": "wcet: 1 ms"}, "cam>act", "chains: {see: {through: [cam]}}"
    )
    # 10 / 0.9 Hz: 90 instead of 100 ms.
    assert _gains(found) == ["cam.timing.rate (10 Hz) 10 @7:41", "cam.timing.wcet (1 ms) 0.1 @7:54"]


def test_figures_beyond_the_most_that_are_tried_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    assert chain_sensitivity.MAX_TRIED_FIGURES == 200
    monkeypatch.setattr(chain_sensitivity, "MAX_TRIED_FIGURES", 2)
    found = _sensitivity(NODES, "cam>act", HOSTS)
    # Of period, jitter and wcet of cam, wcet of act, rate and wcet of side, rate of idle, and the link.
    assert (len(found.gains), found.untried) == (2, 8 - 2)


def test_unknown_figures_are_ranked_by_the_terms_that_lack_them() -> None:
    nodes = {
        "dark": "period: 30 ms",
        "slow": "period: 50 ms",
        "mute": "wcet: 1 ms",
        "poll @p": "period: 20 ms, wcet: 1 ms",
        "far @q": "period: 20 ms, wcet: 1 ms",
    }
    rest = (
        "hosts: {p: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q]}}\n"
        "chains: {see: {through: [dark, slow, mute]}, less: {through: [dark, slow]}, hop: {through: [poll, far]}}"
    )
    found = _sensitivity(nodes, "dark>slow slow>mute poll>far", rest)
    assert [(gap.element, gap.what, gap.terms, gap.chains, gap.plausible) for gap in found.gaps] == [
        ("slow", "execution time", 2, 2, 50 * MS),
        ("dark", "execution time", 1, 2, 30 * MS),
    ]
    hop = _sensitivity(nodes, "dark>slow slow>mute poll>far", rest, "hop")
    assert [(gap.element, gap.what, gap.terms, gap.chains, gap.plausible) for gap in hop.gaps] == [
        ("lan", "latency", 1, 1, None)
    ]


def test_a_bound_that_nobody_knows_gains_nothing() -> None:
    found = _sensitivity(
        {"hot @p": "period: 10 ms, wcet: 10 ms"}, "", "hosts: {p: {cores: 1}}\nchains: {see: {through: [hot]}}"
    )
    assert found.gains == ()


def test_a_best_case_goes_down_with_the_worst() -> None:
    found = _sensitivity(
        {"cam": "period: 10 ms, wcet: 2 ms, bcet: 2 ms", "act": "wcet: 1 ms"},
        "cam>act",
        "chains: {see: {through: [cam, act]}}",
    )
    assert _gains(found) == [
        "cam.timing.period (10 ms) 1 @7:43",
        "cam.timing.wcet (2 ms) 0.2 @7:56",
        "act.timing.wcet (1 ms) 0.1 @8:41",
    ]


def test_what_nobody_says_of_a_stimulus_is_a_gap() -> None:
    """When `mute` works nobody wrote, so that neither its own term nor the response of what it fires is known."""
    nodes = {"mute": "wcet: 1 ms", "end": "wcet: 1 ms"}
    found = _sensitivity(nodes, "mute>end", "chains: {see: {through: [mute, end]}}")
    assert ("mute", "period or rate", 3, 1) in [(gap.element, gap.what, gap.terms, gap.chains) for gap in found.gaps]
