"""What a process does as it runs: answers are taken, callbacks wait, Python computes in one thread at once. Bounds and simulation."""

from __future__ import annotations

import json
import random
from fractions import Fraction

import pytest

from archgen.simulation import simulate_system
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
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


def _python(
    language: str = "python", more: str = "", cores: int = 2, node: str = "callback_groups: {a: [t1], b: [t2]}"
) -> str:
    """Make a node of two threads, each of which computes 30 ms."""
    time = "period: 100 ms, wcet: 30 ms, bcet: 30 ms"
    return f"""\
groups:
  g:
    components:
      t1: {{outputs: {{out: T}}, timing: {{{time}{more}}}}}
      t2: {{outputs: {{out: T}}, timing: {{{time}}}}}
      o: {{outputs: {{out: T}}}}
types: {TYPES}
hosts: {{cpu: {{cores: {cores}}}}}
nodes:
  two: {{implements: [t1, t2], {f"language: {language}, " if language else ""}host: cpu, threads: 2, {node}}}
  o: {{implements: o, host: cpu, timing: {{period: 100 ms, wcet: 10 ms, bcet: 10 ms}}}}
"""


def test_threads_of_python_compute_one_at_a_time() -> None:
    """rclpy: both together took at least 60.4 ms in 78 of 78 pairs of jobs that overlapped."""
    assert _responses(_python()) == {"two.t1": 60, "two.t2": 60, "o": 10}
    assert _responses(_python("cpp", cores=4)) == {"two.t1": 30, "two.t2": 30, "o": 10}
    assert _responses(_python(node="reentrant: true"))["two.t1"] == 60
    assert _seen(_python())["two.t1"] == 60
    assert _seen(_python("cpp", cores=4))["two.t1"] == 30


def test_threads_of_python_wait_beside_one_another() -> None:
    """One computes 30 ms and waits for 35 more: the other one is held up for what it computes, now and the time before, and not while it waits."""
    text = _python(more=", response: 65 ms")
    assert _responses(text)["two.t2"] == 90
    assert _responses(text.replace("threads: 2", "threads: 1"))["two.t2"] == 95


def test_that_all_threads_compute_at_once_is_taken_for_granted_where_no_language_is_written() -> None:
    notes = [note.text for note in analyse_architecture(architecture(_python(""))).notes]
    assert notes == ["no `language` is written for two: all threads compute at once, as in C++ and not in Python"]
    assert analyse_architecture(architecture(_python("cpp"))).notes == ()


@pytest.mark.parametrize("first", try_some(range(0, 320, 20), 1, 8))
def test_no_simulation_exceeds_a_bound_of_processes_that_wait(first: int) -> None:
    found = {seed: exceeded(_random_text(seed), seconds=2, seeds=8) for seed in range(first, first + 20)}
    assert {seed: wrong for seed, (wrong, _) in found.items() if wrong} == {}
    assert sum(held for _, held in found.values()) > 120


def _random_text(seed: int) -> str:
    """Make nodes in Python and C++ of one thread or several, in which callbacks wait, use a GPU, and take answers."""
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    components: dict[str, dict[str, object]] = {}
    nodes: dict[str, dict[str, object]] = {}
    has_ranks = dice.random() < 0.3
    for at in range(dice.randint(2, 4)):
        members = [f"c{at}{name}" for name in "abc"[: dice.randint(1, 3)]]
        for name in members:
            components[name] = _random_component(dice, list(components), has_ranks=has_ranks)
        node: dict[str, object] = {"implements": [f"g.{name}" for name in members], "host": "cpu"}
        node["language"] = dice.choice(("python", "python", "cpp"))
        node["threads"] = dice.choice((1, 2, 2, 3))
        if len(members) > 1 and dice.random() < 0.6:
            node["callback_groups"] = {f"g{name}": [name] for name in members}
        elif dice.random() < 0.3:
            node["reentrant"] = True
        nodes[f"n{at}"] = node
    return json.dumps(
        {
            "groups": {"g": {"components": components}},
            "types": {"T": {"message": "my_msgs/msg/T"}, "S": {"message": "my_msgs/srv/S"}},
            "hosts": {"cpu": {"cores": dice.choice((1, 2, 3, 8))}},
            "resources": {"gpu": {"host": "cpu", **dice.choice(({}, {"scheduling": "fifo"}))}},
            "nodes": nodes,
        }
    )


def _random_component(dice: random.Random, others: list[str], *, has_ranks: bool) -> dict[str, object]:
    period, share = dice.choice((20, 40, 50, 100)), dice.choice((0.03, 0.1, 0.2))
    longest = round(period * share * 1000)
    timing: dict[str, object] = {"wcet": f"{longest} us", "bcet": f"{dice.choice((0, longest // 2, longest))} us"}
    inputs: dict[str, object] = {}
    if others and dice.random() < 0.4:
        inputs["i"] = f"{dice.choice(others)}.out"
    else:
        timing["period"] = f"{period} ms"
    if others and dice.random() < 0.3:
        inputs["ask"] = f"{dice.choice(others)}.serve"
        timing["inputs"] = {"ask": {"wcet": f"{dice.choice((200, 1000, 3000))} us"}}
    if dice.random() < 0.3:
        timing["response"] = f"{longest // 1000 + dice.randint(1, period)} ms"
    if dice.random() < 0.2:
        timing["uses"] = {"gpu": f"{max(1, period // 10)} ms"}
    if has_ranks:
        timing["priority"] = dice.randint(1, 5)
    return {"inputs": inputs, "outputs": {"out": "T", "serve": "S"}, "timing": timing}
