"""Nobody wrote how many cores a host has: no figure is made up, and where the number does not matter there is one."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.judged_projects import judge_ramcip
from tests.timing.printed import show_ms
from tests.timing.sketches import analyse_sketch

_BOX = "containers: {box: {threads: 1, host: pc}}"


def _ten(cost: int, more: str = "") -> str:
    return f"period: 10 ms, wcet: {cost} ms{more and ', '}{more}"


@pytest.mark.parametrize(
    ("nodes", "rest", "responses", "verdict"),
    [
        # With one core 2 + 3; with two 2, and 3; with 12 as well.
        ({"a @pc": _ten(2), "b @pc": _ten(3)}, "", ">= 2 ?cores of pc, >= 3 ?cores of pc", "unknown"),
        ({"a @pc": _ten(8), "b @pc": _ten(8)}, "", ">= 8 ?cores of pc, >= 8 ?cores of pc", "unknown"),
        # One thread uses one core: alone, beside what takes no time, in a container.
        ({"a @pc": _ten(2)}, "", "2", "schedulable"),
        ({"a @pc": _ten(2), "b @pc": _ten(0)}, "", "2, 2", "schedulable"),
        ({"a +box": _ten(2), "b +box": _ten(3)}, _BOX, "5, 5", "schedulable"),
        ({"a +box": _ten(2), "b @pc": _ten(3)}, _BOX, ">= 2 ?cores of pc, >= 3 ?cores of pc", "unknown"),
        # What is pinned says where it runs; of core 1 follows that there is a core 0 for the rest, of core 0 nothing.
        ({"a @pc": _ten(2, "core: 0"), "b @pc": _ten(3, "core: 0")}, "", "5, 5", "schedulable"),
        ({"a @pc": _ten(2, "core: 0"), "b @pc": _ten(3, "core: 5")}, "", "2, 3", "schedulable"),
        ({"a @pc": _ten(2, "core: 1"), "b @pc": _ten(3)}, "", "2, >= 3 ?cores of pc", "unknown"),
        (
            {"a @pc": _ten(2, "core: 0"), "b @pc": _ten(3)},
            "",
            ">= 2 ?cores of pc, >= 3 ?cores of pc",
            "unknown",
        ),
        # Too much for any core, and what is declared.
        ({"a @pc": _ten(11), "b @pc": _ten(3)}, "", "none [overload], >= 3 ?cores of pc", "unknown"),
        (
            {"a @pc": _ten(2, "response: 4 ms"), "b @pc": _ten(3)},
            "",
            "4 [assumed], >= 3 ?cores of pc",
            "unknown",
        ),
    ],
)
def test_only_where_the_number_of_cores_does_not_matter_there_is_a_bound(
    nodes: dict[str, str], rest: str, responses: str, verdict: str
) -> None:
    found = analyse_sketch(nodes, "", f"hosts: {{pc: {{}}}}\n{rest}")
    assert ", ".join(show_ms(response.worst) for response in found.responses.values()) == responses
    assert found.hosts["pc"].verdict == verdict


def test_no_chain_of_ramcip_is_missed_for_a_number_of_cores_that_nobody_wrote() -> None:
    architecture = judge_ramcip().architecture
    written = bound_all_chains(analyse_architecture(architecture), architecture)
    for host in architecture.hosts.values():
        changed = replace(architecture, hosts={**architecture.hosts, host.id: replace(host, cores=None)})
        for name, result in bound_all_chains(analyse_architecture(changed), changed).items():
            if result.bound.value != written[name].bound.value or not result.bound.complete:
                assert result.verdict == "open", (host.id, name)
                assert f"cores of {host.id}" in result.bound.missing or name == "missed_dose_to_mark"
                assert result.bound.value is None or result.bound.value <= (written[name].bound.value or 0)
            else:
                assert result.verdict == written[name].verdict
