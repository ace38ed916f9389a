"""What a process does as it runs: answers are taken, callbacks wait, Python computes in one thread at once. Bounds and simulation."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.simulation import simulate_system
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.exceeded import exceeded
from tests.timing.random_systems import architecture
from tests.timing.task_sets import MS

TYPES = "{T: {message: my_msgs/msg/T}, S: {message: my_msgs/srv/S}}"


def _responses(text: str) -> dict[str, float | None]:
    """Return the bounds of responses in ms; nothing that is seen is above one."""
    assert exceeded(text, 5, 16)[0] == []
    analysis = analyse_architecture(architecture(text))
    values = {name: response.worst.value for name, response in analysis.responses.items()}
    return {name: None if value is None else float(value / MS) for name, value in values.items()}


def _seen(text: str) -> dict[str, float]:
    system = analyse_architecture(architecture(text)).system
    seen = simulate_system(system, 5, 16, {}).activities
    return {name: float((each.worst_response or 0) / MS) for name, each in seen.items()}


def _client(server: str, place: str = "host: cpu", calls: str = "", answer: int = 20) -> str:
    """Put a client and a neighbour into one thread; what the client does with an answer takes a while."""
    return f"""\
groups: {{g: {{components: {{a: {{inputs: {{ask: s.serve}}}}, b: {{outputs: {{out: T}}}}, s: {{outputs: {{serve: S}}}}}}}}}}
types: {TYPES}
hosts: {{cpu: {{cores: 4}}}}
containers: {{box: {{threads: 1, host: cpu}}}}
nodes:
  a: {{implements: a, container: box, timing: {{period: 100 ms, wcet: 1 ms, bcet: 1 ms, inputs: {{ask: {{wcet: {answer} ms}}}}{calls}}}}}
  b: {{implements: b, container: box, timing: {{period: 100 ms, wcet: 2 ms, bcet: 2 ms}}}}
  s: {{implements: s, {place}, timing: {{{server}, wcet: 3 ms, bcet: 3 ms}}}}
"""


@pytest.mark.parametrize("server", ["behaviour: on_demand", "period: 50 ms"])
def test_the_callback_of_an_answer_runs_in_the_thread_of_the_caller(server: str) -> None:
    text = _client(server)
    assert _responses(text)["b"] == 23  # 1 + 20 + 2
    assert 19 < _seen(text)["b"] <= 23
    load = analyse_architecture(architecture(text)).hosts["cpu"].utilisation.value
    assert load == Fraction(26 if "on_demand" in server else 29, 100)


def test_answers_come_as_often_as_there_are_calls() -> None:
    text = _client("behaviour: on_demand", calls=", calls: {ask: 3}", answer=5)
    assert _responses(text)["b"] == 18
    assert _seen(text)["b"] > 6
    assert _responses(_client("period: 50 ms", "container: box", ", calls: {ask: 2}", 5))["b"] is not None


def _waiting(threads: int, cores: int = 4, more: str = "") -> str:
    """Let a message fire two members of a container; one of them computes 5 ms and waits for up to 55 ms."""
    return f"""\
groups: {{g: {{components: {{src: {{outputs: {{out: T}}}}, a: {{inputs: {{i: src.out}}}}, b: {{inputs: {{i: src.out}}}}}}}}}}
types: {TYPES}
hosts: {{cpu: {{cores: {cores}}}}}
containers: {{box: {{threads: {threads}, host: cpu}}}}
nodes:
  src: {{implements: src, host: cpu, timing: {{period: 100 ms, wcet: 1 ms, bcet: 1 ms}}}}
  a: {{implements: a, container: box, timing: {{wcet: 5 ms, bcet: 5 ms, response: 60 ms{more}}}}}
  b: {{implements: b, container: box, timing: {{wcet: 5 ms, bcet: 5 ms}}}}
"""


def test_a_callback_that_waits_keeps_its_thread() -> None:
    """rclpy: b ended at least 66.5 ms after the message in 119 of 120 rounds."""
    assert _responses(_waiting(1)) == {"src": 1, "a": 60, "b": 65}
    assert _seen(_waiting(1))["b"] == 65


def test_who_waits_leaves_the_core_and_others_their_threads() -> None:
    assert _responses(_waiting(2)) == {"src": 1, "a": 60, "b": 5}
    assert _responses(_waiting(2, cores=1))["b"] == 10
    # Where it waited before, its work comes late: 1 ms of its own, 10 of both, which is not put off.
    assert _responses(_waiting(1, cores=1))["src"] == 11


def test_what_is_used_meanwhile_is_no_further_wait() -> None:
    text = _waiting(1, more=", uses: {gpu: 25 ms}") + "resources: {gpu: {host: cpu}}\n"
    assert _responses(text)["b"] == 65
