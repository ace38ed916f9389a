"""What may be changed of how a project is run, and what that is in files."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.proposals import ORDERS, ConfigurationSpace, RunConfiguration, TriggerChoice
from tests.timing.random_systems import architecture
from tests.timing.sketches import sketch

BOX = "containers: {box: {threads: 1, host: p}}"
CHAIN = "chains: {c: {through: [a, b], deadline: 120 ms}}"


def _space(
    nodes: dict[str, str], wires: str = "a>b", rest: str = f"hosts: {{p: {{cores: 2}}}}\n{CHAIN}"
) -> ConfigurationSpace:
    asked = architecture(sketch(nodes, wires, rest))
    analysis = analyse_architecture(asked)
    return ConfigurationSpace(asked, analysis, bound_all_chains(analysis, asked))


def _boxed(host: str = "{cores: 2}") -> str:
    return f"hosts: {{p: {host}}}\n{BOX}\n{CHAIN}"


def test_the_first_node_of_a_container_may_stay_alone() -> None:
    nodes = {"a +box": "period: 100 ms, wcet: 1 ms", "b +box": "wcet: 1 ms", "c @p": "period: 10 ms, wcet: 1 ms"}
    space = _space(nodes, rest=_boxed())
    assert space.separable_nodes == ("b",)
    assert list(space.list_processes("p", ())) == ["container box", "node c"]
    assert list(space.list_processes("p", ("b",))) == ["container box", "node b", "node c"]


def test_what_reads_a_memory_stays_with_what_writes_it() -> None:
    stored = "period: 50 ms, wcet: 1 ms, inputs: {a: {stored: at_once}}"
    nodes = {"a +box": "period: 100 ms, wcet: 1 ms", "b +box": stored, "c +box": "period: 10 ms, wcet: 1 ms"}
    assert _space(nodes, rest=_boxed()).separable_nodes == ("c",)


@pytest.mark.parametrize("host", ["{cores: 1, scheduling: fifo}", "{cores: 2, scheduling: {1: edf}}"])
def test_an_order_that_is_written_stays(host: str) -> None:
    nodes = {"a @p": "period: 100 ms, wcet: 1 ms", "b @p": "wcet: 1 ms"}
    space = _space(nodes, rest=f"hosts: {{p: {host}}}\n{CHAIN}")
    assert space.list_changes(space.rank(RunConfiguration(), "rate")) == ()
    assert list(space.list_moves(RunConfiguration(), ["c"])) == []


def _rank(order: str) -> list[str]:
    """Return the processes of a host, the most urgent first: two chains, and one that is in none."""
    nodes = {
        "a @p": "period: 100 ms, wcet: 1 ms",
        "b @p": "wcet: 1 ms",
        "s @p": "period: 20 ms, wcet: 1 ms",
        "r @p": "period: 200 ms, wcet: 1 ms",
        "fast @p": "period: 10 ms, wcet: 1 ms",
    }
    chains = "chains: {c: {through: [a, b], deadline: 120 ms}, d: {through: [s, r], deadline: 300 ms}}"
    space = _space(nodes, "a>b s>r", f"hosts: {{p: {{cores: 2}}}}\n{chains}")
    ((host, ranking),) = space.rank(RunConfiguration(), order).rankings
    assert host == "p"
    return [name.removeprefix("node ") for name in ranking]


def test_the_orders() -> None:
    assert {order: _rank(order) for order in ORDERS if order} == {
        "rate": ["fast", "s", "a", "b", "r"],
        "deadline": ["a", "b", "s", "r", "fast"],
        "end": ["b", "a", "r", "s", "fast"],
        "chains": ["s", "a", "b", "r", "fast"],
    }


def test_all_of_a_process_has_one_priority_and_no_more_is_written_than_differs() -> None:
    nodes = {
        "a +box": "period: 100 ms, wcet: 1 ms",
        "b +box": "wcet: 1 ms",
        "c @p": "period: 10 ms, wcet: 1 ms, priority: 11",
    }
    space = _space(nodes, rest=_boxed())
    changes = space.list_changes(space.rank(RunConfiguration(), "rate"))
    assert list(map(str, changes)) == ["a.timing.priority=10", "b.timing.priority=10"]
    own = space.rank(RunConfiguration(own_processes=("b",)), "rate")
    assert list(map(str, space.list_changes(own))) == [
        "b.container=none",
        "b.timing.priority=10",
        "a.timing.priority=11",
        "c.timing.priority=12",
    ]
    assert space.describe(own) == "a process for each node, priorities by rate"


def test_hundreds_of_processes_share_the_priorities_of_linux() -> None:
    nodes = {"a @p": "period: 100 ms, wcet: 1 us", "b @p": "wcet: 1 us"}
    nodes |= {f"n{at} @p": f"period: {at + 10} ms, wcet: 1 us" for at in range(200)}
    space = _space(nodes)
    priorities = {
        change.element: int(change.value) for change in space.list_changes(space.rank(RunConfiguration(), "rate"))
    }
    assert (len(priorities), min(priorities.values()), max(priorities.values())) == (202, 10, 98)
    assert priorities["n0"] == 98


def test_each_process_has_one_core_where_none_is_written() -> None:
    """The one with most to do first, where least is to do: 30 % on core 0, and 20 % and 10 % on core 1."""
    nodes = {"a @p": "period: 100 ms, wcet: 30 ms", "b @p": "wcet: 10 ms", "c @p": "period: 10 ms, wcet: 2 ms"}
    space = _space(nodes)
    pinned = space.pin(RunConfiguration())
    assert list(map(str, space.list_changes(pinned))) == ["a.timing.core=0", "c.timing.core=1", "b.timing.core=1"]
    assert space.describe(pinned) == "each process on one core of p"
    assert list(space.list_smaller(pinned)) == [RunConfiguration()]
    assert _space(nodes, rest=f"hosts: {{p: {{cores: 1}}}}\n{CHAIN}").pin(RunConfiguration()) == RunConfiguration()
    written = _space(nodes | {"d @p": "period: 1 s, wcet: 1 ms, cores: [0, 1]"})
    assert written.pin(RunConfiguration()) == RunConfiguration()


def test_what_is_in_one_process_is_on_one_core() -> None:
    nodes = {"a +box": "period: 100 ms, wcet: 1 ms", "b +box": "wcet: 1 ms", "c @p": "period: 10 ms, wcet: 1 ms"}
    space = _space(nodes, rest=_boxed())
    changes = [list(map(str, space.list_changes(space.pin(RunConfiguration(own))))) for own in ((), ("b",))]
    in_box = ["c.timing.core=0", "a.timing.core=1", "b.timing.core=1"]
    assert changes == [in_box, ["b.container=none", *in_box]]


def test_one_process_moves_to_an_end_or_by_one_place() -> None:
    nodes = {"a @p": "period: 100 ms, wcet: 1 ms", "b @p": "wcet: 1 ms", "c @p": "period: 10 ms, wcet: 1 ms"}
    space = _space(nodes)
    start = space.rank(RunConfiguration(), "rate")
    moved = {each.moves: [name[5:] for name in each.rankings[0][1]] for each in space.list_moves(start, ["c"])}
    assert [name[5:] for name in start.rankings[0][1]] == ["c", "a", "b"]
    assert moved == {
        ("a first on p",): ["a", "c", "b"],
        ("a last on p",): ["c", "b", "a"],
        ("b first on p",): ["b", "c", "a"],
        ("b last on p",): ["c", "a", "b"],
        ("c last on p",): ["a", "b", "c"],
        ("c first on p",): ["c", "a", "b"],
        ("a before c on p",): ["a", "c", "b"],
        ("b before a on p",): ["c", "b", "a"],
    }
    # Without an order nothing can be below the others, and nothing is in anybody's place.
    alone = [(each.moves, each.rankings[0][1]) for each in space.list_moves(RunConfiguration(), ["c"])]
    assert alone == [((f"{name} first on p",), (f"node {name}",)) for name in "abc"]


@pytest.mark.parametrize(
    ("source", "reader", "choice"),
    [
        ("period: 100 ms", "period: 200 ms", TriggerChoice("b", "a", 2, Fraction(2))),
        ("period: 100 ms", "period: 290 ms", TriggerChoice("b", "a", 2, Fraction(29, 10))),
        ("period: 100 ms", "rate: 10 Hz", TriggerChoice("b", "a", 1, Fraction(1))),
        ("period: 100 ms", "period: 50 ms", None),  # it would work less often
        (
            "period: 100 ms, outputs: {out: {conditional: true, max_gap: 200 ms}}",
            "period: 400 ms",
            None,
        ),  # not one in n is sure
        ("", "period: 200 ms", None),
    ],
)
def test_a_reader_is_fired_by_what_it_reads_as_often_as_it_works_now(
    source: str, reader: str, choice: TriggerChoice | None
) -> None:
    nodes = {"a @p": f"{source}{', ' if source else ''}wcet: 1 ms", "b @p": f"{reader}, wcet: 1 ms"}
    found = _space(nodes).list_triggers(["c"])
    assert found == ([choice] if choice else [])
    assert _space(nodes).list_triggers(["other"]) == []


def test_a_trigger_in_words_and_in_files() -> None:
    assert [str(each) for each in TriggerChoice("b", "a", 2, Fraction(2)).list_changes()] == [
        "b.timing.trigger=[a]",
        "b.timing.every=2",
    ]
    assert [str(each) for each in TriggerChoice("b", "a", 1, Fraction(1)).list_changes()] == ["b.timing.trigger=[a]"]
    assert TriggerChoice("b", "a", 2, Fraction(2)).describe() == "b fired by one message in 2 of its input a"
    assert TriggerChoice("b", "a", 1, Fraction(1)).describe() == "b fired by each message of its input a"


def test_smaller_configurations_leave_out_a_host_the_tail_a_container_or_a_trigger() -> None:
    nodes = {
        "a +box": "period: 100 ms, wcet: 1 ms",
        "b +box": "period: 100 ms, wcet: 1 ms",
        "slow @p": "period: 1 s, wcet: 1 ms",
    }
    space = _space(nodes, rest=_boxed())
    choice = TriggerChoice("b", "a", 1, Fraction(1))
    full = space.rank(RunConfiguration(own_processes=("b",), triggers=(choice,)), "rate")
    words = [space.describe(each) for each in space.list_smaller(full)]
    fired = "b fired by each message of its input a"
    assert words == [
        f"a process for each node, {fired}",
        f"a process for each node, priorities by rate, none below the chains, {fired}",
        f"priorities by rate, {fired}",
        "a process for each node, priorities by rate",
    ]
