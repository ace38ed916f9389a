"""Each group of hosts has a budget of its own: no figure depends on a computer that is not connected."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.load.busy_windows import GroupBudgets
from archgen.timing.load.link_queueing import settle_links
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.system_builder import build_system
from tests.quiet_seconds import measure_quiet_seconds
from tests.timing.sketches import analyse_sketch, read_sketch

Derived = Callable[[str], Architecture]


def _rising_chains(**steps_and_costs: tuple[int, int]) -> str:
    """Write a chain for each host: one core, 10 Hz, so many steps of so many ms, each more urgent than the one before.

    Each may start 1 us late: so it begins a run of its own, and the jitter of one step makes the next one wait.
    """
    components, nodes = [], []
    for host, (steps, cost) in steps_and_costs.items():
        for step in range(steps):
            name = f"{host}{step}"
            inputs = f"inputs: {{before{step}: {host}{step - 1}.out}}, " if step else ""
            clock = "behaviour: event, jitter: 1 us" if step else "period: 100 ms"
            components.append(f"      {name}: {{{inputs}outputs: {{out: std_msgs/msg/Empty}}}}")
            figures = f"{clock}, wcet: {cost} ms, bcet: {cost} ms, priority: {step + 1}"
            nodes.append(f"  {name}: {{implements: {name}, host: {host}, timing: {{{figures}}}}}")
    hosts = ", ".join(f"{host}: {{cores: 1}}" for host in steps_and_costs)
    return "\n".join(["groups:\n  g:\n    components:", *components, "nodes:", *nodes, f"hosts: {{{hosts}}}\n"])


@pytest.mark.slow
def test_hosts_without_a_bound_take_none_from_a_host_that_is_not_connected(derived: Derived) -> None:
    alone = analyse_architecture(derived(_rising_chains(good=(15, 1)))).responses
    crowd = {f"bad{letter}": (8, 4) for letter in "abcdef"}
    together = analyse_architecture(derived(_rising_chains(**crowd, good=(15, 1)))).responses
    assert all(response.worst.value for response in alone.values())
    assert {name: together[name].worst for name in alone} == {name: found.worst for name, found in alone.items()}


@pytest.mark.parametrize(("steps", "cost"), [(5, 10), (8, 4)])
def test_a_loop_that_grows_for_ever_is_given_up_at_once(derived: Derived, steps: int, cost: int) -> None:
    architecture = derived(_rising_chains(pc=(steps, cost)))
    given_up: list[int] = []
    assert measure_quiet_seconds(lambda: given_up.append(len(analyse_architecture(architecture).diverged))) < 1
    assert given_up == [steps]


@pytest.mark.parametrize(
    ("wires", "fired", "link", "groups"),
    [
        ("", "", "latency: 1 ms", "a b c d"),
        ("a>b c>d", "bd", "latency: 1 ms", "ab cd"),
        ("a>b b>c", "b", "latency: 1 ms", "ab c d"),  # `c` only reads it: that changes no response
        ("a>b b>c", "b", "bandwidth: 8 Mbit/s", "abc d"),
        ("a>c b>d", "", "bandwidth: 8 Mbit/s", "abcd"),  # one message waits for the other
    ],
)
def test_a_group_is_what_depends_on_one_another(wires: str, fired: str, link: str, groups: str) -> None:
    nodes = {
        f"{name} @{host}": "wcet: 1 ms" if name in fired else "period: 10 ms, wcet: 1 ms"
        for name, host in zip("abcd", "ppqq", strict=True)
    }
    rest = f"hosts: {{p: {{cores: 1}}, q: {{cores: 1}}}}\nlinks: {{lan: {{connects: [p, q], {link}}}}}"
    system, _, _ = settle_links(build_system(read_sketch(nodes, wires, rest))[0])
    successors = {name: [wire[2] for wire in wires.split() if wire[0] == name and wire[2] in fired] for name in "abcd"}
    members: dict[int, str] = {}
    for name, budget in GroupBudgets().assign_budgets(system, successors).items():
        members[id(budget)] = members.get(id(budget), "") + name
    assert sorted("".join(sorted(names)) for names in members.values()) == groups.split()


@pytest.mark.parametrize(
    "figures", ["wcet: 1 ms, bcet: 1 ms, response: 30 s", "wcet: 50 ms, bcet: 50 ms, jitter: 60 s"]
)
def test_what_is_written_to_take_long_or_come_in_bursts_has_not_run_away(figures: str) -> None:
    nodes = {"a @p": "period: 100 ms, wcet: 1 ms, bcet: 1 ms", "b @q": figures, "c @p": "wcet: 100 us"}
    rest = "hosts: {p: {cores: 2}, q: {cores: 2}}\nlinks: {lan: {connects: [p, q], latency: 1 ms}}"
    assert analyse_sketch(nodes, "a>b b>c", rest).diverged == ()


def test_a_group_keeps_its_budget_in_the_next_turn() -> None:
    system, _ = build_system(
        read_sketch({"a @p": "period: 10 ms", "b @p": "period: 10 ms"}, "", "hosts: {p: {cores: 1}}")
    )
    group_budgets = GroupBudgets()
    first, second = (group_budgets.assign_budgets(system, {"a": [], "b": []}) for _ in range(2))
    assert first["a"] is second["a"] is not first["b"]
