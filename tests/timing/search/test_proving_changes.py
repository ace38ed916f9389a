"""The smallest change that proves a chain: for each kind of change a project that needs it, and what it becomes with it."""

from __future__ import annotations

import pytest

from archgen.timing.search.change_trials import TriedChange, TriesSpentError
from archgen.timing.search.proving_changes import ChainRemedy, find_remedies
from tests.timing.random_systems import architecture
from tests.timing.search.trials import bound_with, start_trials
from tests.timing.sketches import sketch

_CHAIN = "chains: {c: {through: [a, b], deadline: 120 ms}}"
_ONE_CORE = f"hosts: {{p: {{cores: 1}}}}\n{_CHAIN}"
_SLOW = "period: 200 ms, wcet: 60 ms"
_SENSOR = "period: 100 ms, wcet: 1 ms, response: 1 ms"
_TWO_COMPONENTS = f"""
groups:
  g:
    components:
      a: {{outputs: {{out: Data}}}}
      b: {{inputs: {{a: a.out}}, timing: {{wcet: 3 ms}}}}
      slow: {{outputs: {{done: Data}}, timing: {{{_SLOW}}}}}
nodes:
  a: {{implements: g.a, host: p, timing: {{{_SENSOR}}}}}
  both: {{implements: [g.b, g.slow], PLACE}}
types: {{Data: {{message: std_msgs/msg/String}}}}
hosts: {{p: {{cores: 4}}}}
CONTAINERS
{_CHAIN}
"""
PROJECTS = {
    "a priority": (
        sketch({"a @p": _SENSOR, "b @p": "wcet: 3 ms", "slow @p": _SLOW}, "a>b", _ONE_CORE),
        ["b.timing.priority=1"],
    ),
    "a core": (
        sketch(
            {
                "a @p": _SENSOR,
                "b @p": "wcet: 3 ms, priority: 5, core: 0",
                "slow @p": f"{_SLOW}, priority: 99, core: 0",
            },
            "a>b",
            f"hosts: {{p: {{cores: 3}}}}\n{_CHAIN}",
        ),
        ["b.timing.core=1"],
    ),
    "threads": (
        sketch(
            {"a @p": _SENSOR, "b +box": "wcet: 3 ms", "slow +box": _SLOW},
            "a>b",
            f"hosts: {{p: {{cores: 4}}}}\ncontainers: {{box: {{threads: 1, host: p}}}}\n{_CHAIN}",
        ),
        ["box.threads=2"],
    ),
    "a callback group": (
        _TWO_COMPONENTS.replace("PLACE", "container: box").replace(
            "CONTAINERS", "containers: {box: {threads: 2, host: p}}"
        ),
        ["both.callback_groups.b=g.b"],
    ),
    "threads and a callback group": (
        _TWO_COMPONENTS.replace("PLACE", "host: p").replace("CONTAINERS", ""),
        ["both.threads=2", "both.callback_groups.b=g.b"],
    ),
    "an execution time": (
        sketch(
            {"a @p": f"behaviour: event, {_SENSOR}", "b +box": "wcet: 3 ms", "slow +box": _SLOW},
            "x>a a>b",
            f"containers: {{box: {{threads: 1, host: p}}}}\n{_ONE_CORE.replace('120', '20')}",
        ),
        ["slow.timing.wcet=15ms"],
    ),
    "a rate": (
        sketch(
            {"a @p": "period: 100 ms, wcet: 1 ms, bcet: 1 ms", "b @p": "period: 50 ms, wcet: 1 ms, bcet: 1 ms"},
            "a>b",
            "hosts: {p: {cores: 2}}\nchains: {c: {through: [a, b], deadline: 140 ms}}",
        ),
        ["a.timing.period=88ms"],
    ),
}


def _find_remedy(text: str, tries: int = 10_000) -> ChainRemedy:
    (remedy,) = find_remedies(start_trials(architecture(text), tries), bound_with(architecture(text)).values())
    return remedy


@pytest.mark.parametrize("needed", PROJECTS)
def test_the_change_that_is_found_makes_the_chain_met(needed: str) -> None:
    text, changes = PROJECTS[needed]
    assert bound_with(architecture(text))["c"].verdict == "not proven"
    found = [str(change) for change in _find_remedy(text).changes]
    assert found == changes
    assert bound_with(architecture(text), found)["c"].verdict == "met"


@pytest.mark.parametrize(("needed", "more"), [("an execution time", "15.001ms"), ("a rate", "88.001ms")])
def test_a_figure_is_changed_no_further_than_it_has_to_be(needed: str, more: str) -> None:
    text, (change,) = PROJECTS[needed]
    assert bound_with(architecture(text), [f"{change.partition('=')[0]}={more}"])["c"].verdict == "not proven"


def test_what_makes_another_chain_late_is_no_remedy() -> None:
    """With a priority for b the other chain, of o, would wait for it: the slow one is made quicker instead."""
    text = sketch(
        {"a @p": _SENSOR, "b @p": "wcet: 30 ms", "s @p": _SENSOR, "o @p": "wcet: 3 ms, priority: 5", "slow @p": _SLOW},
        "a>b s>o",
        "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 150 ms}, other: {through: [s, o], deadline: 105 ms}}",
    )
    assert {name: chain.verdict for name, chain in bound_with(architecture(text)).items()} == {
        "c": "not proven",
        "other": "met",
    }
    found = [str(change) for change in _find_remedy(text).changes]
    assert not any("priority" in change for change in found)
    assert {chain.verdict for chain in bound_with(architecture(text), found).values()} == {"met"}


def test_where_nothing_proves_it_what_was_tried_is_told() -> None:
    text = sketch(
        {"a @p": "period: 100 ms, wcet: 1 ms", "b @p": "wcet: 3 ms", "slow @p": _SLOW},
        "a>b",
        "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 50 ms}}",
    )
    remedy = _find_remedy(text)
    assert (remedy.changes, remedy.is_cut) == ((), False)
    assert remedy.tried == (
        ("priority", ("a", "b")),
        ("wcet", ("a", "b", "slow")),
        ("period", ("a", "slow")),
    )


def test_tries_are_counted_and_the_same_each_time() -> None:
    text, changes = PROJECTS["an execution time"]
    assert _find_remedy(text, 2).is_cut
    remedies = [_find_remedy(text, tries) for tries in (60, 60)]
    assert remedies[0] == remedies[1]
    assert [str(change) for change in remedies[0].changes] == changes


def test_an_analysis_is_one_try_and_what_was_tried_is_none() -> None:
    trials = start_trials(architecture(PROJECTS["a rate"][0]), tries=10)
    change = (TriedChange("a", "timing.period", "88ms"),)
    tries_left = [trials.tries_left]
    for changes in ((), change, change):
        trials.find_slack("c", changes)
        trials.bound_chain("c", changes)
        tries_left.append(trials.tries_left)
    assert tries_left == [10, 10, 9, 9]


def test_no_more_is_tried_than_is_allowed() -> None:
    trials = start_trials(architecture(PROJECTS["a rate"][0]), tries=1)
    trials.bound_chain("c", (TriedChange("a", "timing.period", "88ms"),))
    with pytest.raises(TriesSpentError):
        trials.bound_chain("c", (TriedChange("a", "timing.period", "87ms"),))


def test_a_chain_that_is_met_or_open_or_too_late_at_best_is_not_looked_at() -> None:
    text = sketch(
        {"s @q": _SENSOR, "a @q": "wcet: 1 ms", "b @q": "wcet: 3 ms, bcet: 3 ms", "far": ""},
        "s>a a>b b>far",
        "hosts: {q: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 2 ms}, d: {through: [s, a], deadline: 1 s}, "
        "e: {through: [a, far], deadline: 1 s}, f: {through: [a, b]}}",
    )
    assert [chain.verdict for chain in bound_with(architecture(text)).values()] == ["missed", "met", "open", "open"]
    assert find_remedies(start_trials(architecture(text)), bound_with(architecture(text)).values()) == []


def test_a_change_that_makes_no_sense_proves_nothing() -> None:
    """No execution time is below the best one."""
    text = sketch(
        {"a @p": "period: 50 ms, wcet: 1 ms", "b @p": "wcet: 3 ms, bcet: 3 ms"},
        "a>b",
        "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 60 ms}}",
    )
    trials = start_trials(architecture(text))
    assert trials.find_slack("c", (TriedChange("b", "timing.wcet", "2ms"),)) is None
    assert trials.find_slack("c", (TriedChange("b", "timing.wcet", "3ms"),)) == 6 * 10**6
