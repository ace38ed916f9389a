"""Budgets: what is printed keeps the deadline, and a tick more does not, where the deadline is the limit."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.figures.figure_wording import write_exact_duration
from archgen.timing.search.chain_budgets import ChainBudget, UnknownBudgetError, find_chain_budget, share_chain_budget
from tests.property_sizes import try_some
from tests.timing.random_systems import architecture
from tests.timing.search.trials import bound_with, start_trials
from tests.timing.sketches import sketch

NODES = {
    "scan @p": "rate: 10 Hz, wcet: 1 ms",
    "plan @p": "wcet: 20 ms, bcet: 10 ms",
    "beside @p": "period: 200 ms, wcet: 30 ms",
    "drive @q": "period: 20 ms, wcet: 500 us",
    "idle @q": "period: 1 s, wcet: 5 ms, priority: 1",
    "last @q": "wcet: 2 ms, response: 4 ms",
}
REST = """
hosts: {p: {cores: 1}, q: {cores: 2}}
links: {lan: {connects: [p, q], latency: {best: 1 ms, worst: 2 ms}}}
chains: {c: {through: [scan, last], deadline: DEADLINE}}
"""
DEADLINES = ["300 ms", "181500001 ns", "170 ms"]


def _read(deadline: str) -> str:
    return sketch(NODES, "scan>plan plan>drive drive>last", REST.replace("DEADLINE", deadline))


def _find_budget(deadline: str) -> ChainBudget:
    trials = start_trials(architecture(_read(deadline)))
    return find_chain_budget(trials, bound_with(trials.architecture)["c"])


def _set(figure: str, key: str, duration: Fraction) -> str:
    return f"{figure}.timing.{key}={write_exact_duration(duration).replace(' ', '')}"


def test_what_is_as_written_is_not_late_and_the_bound_is_what_the_test_is_about() -> None:
    bound = bound_with(architecture(_read("300 ms")))["c"].bound.value
    assert bound == Fraction("181.5") * 10**6


@pytest.mark.parametrize("deadline", try_some(DEADLINES, 1))
def test_each_figure_that_is_printed_keeps_the_deadline_and_a_tick_more_does_not(deadline: str) -> None:
    model, budget = architecture(_read(deadline)), _find_budget(deadline)
    assert {(figure.activity, figure.key) for figure in budget.figures} >= {
        ("plan", "wcet"),
        ("drive", "period"),
        ("last", "response"),
        ("beside", "wcet"),
    }
    for figure in budget.figures:
        assert not figure.is_free
        if figure.largest is not None:
            assert bound_with(model, [_set(figure.activity, figure.key, figure.largest)])["c"].verdict == "met"
        at_least = figure.largest if figure.largest is not None else Fraction(1_000)
        least_text = [_set(figure.activity, figure.key, at_least + 1_000)]
        if figure.largest is not None or (figure.activity, figure.key) != ("plan", "wcet"):
            assert bound_with(model, least_text)["c"].verdict != "met", least_text


@pytest.mark.parametrize("deadline", try_some(DEADLINES, 1))
def test_all_that_share_a_factor_keep_the_deadline_and_a_thousandth_more_does_not(deadline: str) -> None:
    model, shared = architecture(_read(deadline)), _find_budget(deadline).shared
    assert shared.factor is not None
    assert (shared.factor >= 1) == (deadline != "170 ms")
    texts = [_set(share.activity, share.key, share.may_take) for share in shared.shares]
    assert bound_with(model, texts)["c"].verdict == "met"
    grown = shared.factor + Fraction(1, 1000)
    least = {"plan": Fraction(10 * 10**6)}
    more = [
        _set(share.activity, share.key, max(share.written * grown, least.get(share.activity, Fraction(0))))
        for share in shared.shares
    ]
    assert bound_with(model, more)["c"].verdict != "met"
    trials = start_trials(model)
    assert share_chain_budget(trials, bound_with(trials.architecture)["c"]) == shared


def test_each_host_has_a_factor_of_its_own() -> None:
    model, budget = architecture(_read("300 ms")), _find_budget("300 ms")
    factors = dict(budget.hosts)
    written_times: dict[str, dict[str, int | None]] = {
        "p": {"scan": 1_000, "plan": 20_000, "beside": 30_000},
        "q": {"drive": 500, "idle": 5_000, "last": None},
    }
    for host, times in written_times.items():
        factor = factors[host].factor
        assert factor is not None
        for step, verdict in ((Fraction(0), "met"), (Fraction(1, 1000), "not proven")):
            texts = [
                _set(name, "wcet", wcet * 1_000 * (factor + step)) for name, wcet in times.items() if wcet is not None
            ]
            texts += [_set("last", "response", Fraction(4 * 10**6) * (factor + step))] if host == "q" else []
            assert bound_with(model, texts)["c"].verdict in (
                {verdict} if verdict == "met" else {"not proven", "missed"}
            )


def test_a_share_is_that_of_the_owner_of_the_node_and_else_of_its_component() -> None:
    text = """
partners: {vega: Vega, kite: Kite}
groups:
  g:
    owner: vega
    components:
      a: {outputs: {out: Data}, timing: {period: 100 ms, wcet: 1 ms}}
      b: {inputs: {a: a.out}, timing: {behaviour: event, wcet: 2 ms}}
nodes:
  a: {implements: a, host: p}
  b: {implements: b, host: p, owner: kite}
types: {Data: {message: std_msgs/msg/String}}
hosts: {p: {cores: 1}}
chains: {c: {through: [a, b], deadline: 200 ms}}
"""
    trials = start_trials(architecture(text))
    shares = share_chain_budget(trials, bound_with(trials.architecture)["c"]).shares
    assert [(share.activity, share.owners) for share in shares] == [("a", ("vega",)), ("b", ("kite",))]


@pytest.mark.parametrize(("deadline", "factor"), [("100060 us", Fraction(1, 1000)), ("100040 us", None)])
def test_a_factor_is_at_least_a_thousandth(deadline: str, factor: Fraction | None) -> None:
    """100 ms, and so many thousandths of 10 + 40 ms."""
    nodes = {"a": "period: 100 ms, wcet: 10 ms", "b": "behaviour: event, wcet: 40 ms"}
    trials = start_trials(
        architecture(sketch(nodes, "a>b", f"chains: {{c: {{through: [a, b], deadline: {deadline}}}}}"))
    )
    assert share_chain_budget(trials, bound_with(trials.architecture)["c"]).factor == factor


def test_a_neighbour_that_cannot_make_the_chain_late_is_left_out() -> None:
    assert "idle" not in {figure.activity for figure in _find_budget("300 ms").figures}


@pytest.mark.parametrize(
    ("rest", "reason"),
    [
        (REST.replace(", deadline: DEADLINE", ""), "it has no deadline"),
        (REST.replace("DEADLINE", "1 s").replace("[scan, last]", "[last, scan]"), "figures are missing"),
    ],
)
def test_a_chain_without_a_deadline_or_a_bound_has_no_budget(rest: str, reason: str) -> None:
    trials = start_trials(architecture(sketch(NODES, "scan>plan plan>drive drive>last", rest)))
    with pytest.raises(UnknownBudgetError, match=reason):
        find_chain_budget(trials, bound_with(trials.architecture)["c"])


def test_what_there_was_no_try_left_for_is_named() -> None:
    trials = start_trials(architecture(_read("300 ms")), 12)
    budget = find_chain_budget(trials, bound_with(trials.architecture)["c"])
    assert "drive.timing.period" in budget.untried


def _write_budget(budget: ChainBudget) -> list[str]:
    """Return all of a budget: figures, hosts, and what each may take."""
    return [
        *(
            f"{each.activity}.{each.key} {_in_ms(each.written)} may be {_in_ms(each.largest)}{' free' if each.is_free else ''}"
            for each in budget.figures
        ),
        *(f"{host}: {each.factor}{' free' if each.is_free else ''}" for host, each in budget.hosts),
        f"all: {budget.shared.factor}",
        *(
            f"{' '.join(each.owners)} {each.activity}.{each.key} {_in_ms(each.written)} may take {_in_ms(each.may_take)}"
            f"{' on the chain' if each.on_chain else ''}"
            for each in budget.shared.shares
        ),
    ]


def _in_ms(duration: Fraction | None) -> str:
    return "nothing" if duration is None else str(duration / 10**6)


def test_all_of_a_budget() -> None:
    nodes = {
        "a @p": "period: 50 ms, wcet: 2 ms, bcet: 1 ms, priority: 3",
        "b @p": "wcet: 5 ms, priority: 2",
        "n @p": "period: 40 ms, wcet: 4 ms, priority: 5",
        "m @p": "period: 100 ms, wcet: 4 ms, priority: 1",
        "f @q": "period: 100 ms, wcet: 4 ms",
    }
    rest = "hosts: {p: {cores: 1}, q: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 80 ms}}"
    trials = start_trials(architecture(sketch(nodes, "a>b", rest)))
    assert _write_budget(find_chain_budget(trials, bound_with(trials.architecture)["c"])) == [
        "a.wcet 2 may be 21",
        "b.wcet 5 may be 24",
        "a.period 50 may be 69",
        "n.wcet 4 may be 23",
        "p: 2727/1000",
        "all: 2727/1000",
        " a.wcet 2 may take 2727/500 on the chain",
        " b.wcet 5 may take 2727/200 on the chain",
        " n.wcet 4 may take 2727/250",
        " m.wcet 4 may take 2727/250",
    ]
