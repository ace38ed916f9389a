"""Orders that a run drew: those that ROS 2 does not have show nothing, and the others are named."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from archgen.simulation import find_late_runs
from archgen.simulation.chain_witnesses import find_witnesses
from archgen.simulation.drawn_orders import describe_orders
from archgen.timing.analysis import DrawnOrder
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.simulation.systems import arc, event, process, system, timed, within
from tests.timing.sketches import read_sketch

NODES = {
    "scan @p": "period: 100 ms, wcet: 1 ms, bcet: 1 ms",
    "fast +box": "wcet: 2 ms, bcet: 2 ms",
    "quick +box": "period: 10 ms, wcet: 6 ms, bcet: 6 ms",
    "slow +box": "period: 100 ms, wcet: 13 ms, bcet: 13 ms",
}
REST = """hosts: {{p: {{cores: 2}}}}
project: {{id: p, middleware: {middleware}}}
containers: {{box: {{host: p, threads: 1{order}}}}}
chains: {{c: {{through: [scan, fast], deadline: 132 ms}}}}
"""


def _find_witness(middleware: str, order: str = ""):  # type: ignore[no-untyped-def]  # noqa: ANN202 - what both need
    model = read_sketch(NODES, "scan>fast", REST.format(middleware=middleware, order=order))
    analysis = analyse_architecture(model)
    results = bound_all_chains(analysis, model)
    assert results["c"].verdict == "not proven"
    return find_witnesses(analysis, results.values()).get("c")


def test_a_run_in_an_order_that_ros_2_does_not_have_shows_nothing() -> None:
    """In rounds `fast` waits for each of the others once at most; with others first it waits for `quick` four times."""
    assert _find_witness("ros") is None
    elsewhere = _find_witness("zenoh")
    assert elsewhere is not None
    assert DrawnOrder("box", "with fast after all others") in elsewhere.orders


def test_what_is_written_shows_the_same_as_what_ros_2_does_by_itself() -> None:
    assert _find_witness("ros") == _find_witness("ros", ", scheduling: ros2_executor")


def test_orders_are_named_by_what_waits_there() -> None:
    nodes = [timed("scan", 100, 1, host="h"), *within("box", *(timed(f"n{at}", 100, 5, host="h") for at in range(3)))]
    executors = {key: replace(each, usual_order="ros2_executor") for key, each in process("box").items()}
    made = system(
        [*nodes, event("end", 1, "n2", host="h", priority=3)],
        [arc("n2", "end")],
        {"h": 1},
        executors={f"container {key}": each for key, each in executors.items()},
    )
    late = find_late_runs(made, {"c": (("n2", "end"), Fraction(0))}, seconds=1, seeds=1)["c"]
    # The thread of `box` is one, that of `end` another: on two cores nobody waits.
    assert [order.place for order in late.orders] == ["h"]
    assert late.orders[0].words.startswith("by priority, then ")


def test_places_with_one_order_are_named_together() -> None:
    orders = [DrawnOrder("a", "at random"), DrawnOrder("b", "by ranks"), DrawnOrder("c", "at random")]
    assert describe_orders(orders) == "a, c at random; b by ranks"
    assert not describe_orders([])
