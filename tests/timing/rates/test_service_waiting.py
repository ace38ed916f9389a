"""Services with many callers: how long an answer takes, and what becomes of those who wait for it."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from archgen.analyses import answer_times
from archgen.model.architecture import Architecture
from archgen.timing.analysis import ServiceLoad
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.task_sets import MS

Derived = Callable[[str], Architecture]


def _text(callers: dict[str, str], server: str, more: str = "", where: str = "") -> str:
    """Write a server and its callers, each with what stands in its timing."""
    components = "\n".join(f"      {name}: {{inputs: {{help: server.help}}}}" for name in callers)
    nodes = "\n".join(
        f"  {name}: {{implements: {name}, {where}timing: {{{timing}}}}}" for name, timing in callers.items()
    )
    return f"""
groups:
  g:
    components:
      server: {{outputs: {{help: std_srvs/srv/Trigger}}}}
{components}
nodes:
  server: {{implements: server, {server}}}
{nodes}
{more}
"""


def _load(
    derived: Derived, callers: dict[str, str], server: str = "timing: {wcet: 10 ms}", more: str = ""
) -> ServiceLoad:
    return analyse_architecture(derived(_text(callers, server, more))).services["server"]


def _waits(found: ServiceLoad) -> dict[str, Fraction | None]:
    return {name: None if value.value is None else value.value / MS for name, value in found.waits.items()}


def test_k_callers_with_one_call_each_wait_for_k_executions(derived: Derived) -> None:
    found = _load(derived, dict.fromkeys("abcde", "period: 1 s, wcet: 2 ms, bcet: 2 ms"))
    assert found.worst.value == 5 * 10 * MS
    assert set(_waits(found).values()) == {50}
    assert found.synchronous_responses["a"].value == (2 + 50) * MS


def test_each_call_of_an_activation_waits_anew(derived: Derived) -> None:
    """Four calls may come at once, three of them from a: 40 ms for the last; a waits that long three times."""
    found = _load(derived, {"a": "period: 1 s, wcet: 0 ms, calls: {help: 3}", "b": "period: 1 s, wcet: 0 ms"})
    assert found.worst.value == 40 * MS
    assert _waits(found) == {"a": 120, "b": 40}


def test_a_call_now_and_then_waits_as_long_as_any(derived: Derived) -> None:
    found = _load(derived, {"a": "period: 1 s, wcet: 0 ms, calls: {help: 0.25}", "b": "period: 1 s, wcet: 0 ms"})
    assert found.worst.value is not None
    assert found.worst.value >= 20 * MS
    assert _waits(found)["a"] == found.worst.value / MS


def test_what_else_works_on_the_servers_host_counts(derived: Derived) -> None:
    """Two calls of 10 ms, and 30 ms of somebody else's work before them."""
    more = "  other: {host: pc, timing: {period: 1 s, wcet: 30 ms}}\nhosts: {pc: {cores: 1}}"
    callers = {"a": "period: 1 s, wcet: 0 ms", "b": "period: 1 s, wcet: 0 ms"}
    text = _text(callers, "host: pc, timing: {wcet: 10 ms}", more, where="host: pc, ")
    found = analyse_architecture(derived(text)).services["server"]
    assert found.worst.value == 50 * MS


def test_callers_that_wait_cannot_overload_a_server_of_their_own(derived: Derived) -> None:
    """60 ms for each of two callers that ask every 100 ms is more than there is, if nobody waited."""
    found = _load(derived, {"a": "period: 100 ms", "b": "period: 100 ms"}, "timing: {wcet: 60 ms}")
    assert found.worst.value == 120 * MS
    assert "callers call again only when they have been answered" in found.worst.assumptions


def test_a_declared_response_is_the_answer(derived: Derived) -> None:
    found = _load(derived, {"a": "period: 1 s", "b": "period: 1 s"}, "timing: {response: 45 ms}")
    assert (found.worst.value, found.worst.assumptions) == (45 * MS, ("assumed",))


def test_a_server_with_a_clock_of_its_own_answers_when_it_runs(derived: Derived) -> None:
    found = _load(derived, {"a": "period: 1 s"}, "timing: {period: 20 ms, wcet: 10 ms}")
    assert found.worst.value == (20 + 10) * MS


def test_without_an_execution_time_nothing_is_said(derived: Derived) -> None:
    found = _load(derived, {"a": "period: 1 s"}, "timing: {behaviour: on_demand}")
    assert (found.worst.value, found.worst.complete, found.worst.missing) == (None, False, ("server",))


def test_slow_service_adds_all_calls_of_an_activation(derived: Derived) -> None:
    """Three calls with b's before the last: 40 ms each time."""
    callers = {"a": "period: 119 ms, calls: {help: 3}, wcet: 0 ms", "b": "period: 1 s, wcet: 0 ms"}
    architecture = derived(_text(callers, "timing: {wcet: 10 ms}"))
    (finding,) = answer_times.slow_service(architecture, analyse_architecture(architecture), margin=Fraction(0))
    assert finding.message == "`a` runs every 119 ms, but waits up to 120 ms for `server`, with 2 callers"
    callers["a"] = "period: 120 ms, calls: {help: 3}, wcet: 0 ms"
    architecture = derived(_text(callers, "timing: {wcet: 10 ms}"))
    assert not list(answer_times.slow_service(architecture, analyse_architecture(architecture), margin=Fraction(0)))


def test_each_caller_waits_for_its_own_links_both_ways(derived: Derived) -> None:
    """Two calls of 10 ms; to the other host and back another 1 ms each."""
    text = """
groups:
  g:
    components:
      server: {outputs: {help: std_srvs/srv/Trigger}}
      near: {inputs: {help: server.help}}
      far: {inputs: {help: server.help}}
nodes:
  server: {implements: server, host: pc, timing: {wcet: 10 ms}}
  near: {implements: near, host: pc, timing: {period: 1 s, wcet: 0 ms}}
  far: {implements: far, host: other, timing: {period: 1 s, wcet: 0 ms}}
hosts: {pc: {cores: 1}, other: {cores: 1}}
links: {lan: {connects: [pc, other], latency: 1 ms}}
"""
    assert _waits(analyse_architecture(derived(text)).services["server"]) == {"near": 20, "far": 22}
