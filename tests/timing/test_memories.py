"""Several publishers of one topic: a subscription keeps the last message, whoever sent it; bounds and simulation alike."""

from __future__ import annotations

import json
import random
from collections.abc import Mapping

import pytest

from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
from tests.timing.exceeded import exceeded
from tests.timing.random_systems import architecture
from tests.timing.task_sets import MS

PERIODIC = "behaviour: periodic, period: 100 ms"


def _text(reader: str = PERIODIC, subscribes: str = "/obstacles", second: str = "/obstacles", trigger: str = "") -> str:
    """Two sensors publish, the controller reads both at one input."""
    return f"""\
groups:
  g:
    components:
      s1: {{outputs: {{out: T0}}}}
      s2: {{outputs: {{out: T0}}}}
      s3: {{outputs: {{out: T0}}}}
      ctl: {{inputs: {{i: [g.s1.out, g.s2.out], j: g.s3.out}}, outputs: {{out: {{type: T0, external: world}}}}}}
types: {{T0: {{message: my_msgs/msg/T0}}}}
hosts: {{cpu: {{cores: 4}}}}
nodes:
  s1: {{implements: g.s1, host: cpu, publishes: {{out: /obstacles}}, timing: {{period: 100 ms, wcet: 1 ms, bcet: 1 ms}}}}
  s2: {{implements: g.s2, host: cpu, publishes: {{out: {second}}}, timing: {{period: 100 ms, wcet: 1 ms, bcet: 1 ms}}}}
  s3: {{implements: g.s3, host: cpu, timing: {{period: 100 ms, wcet: 1 ms, bcet: 1 ms}}}}
  ctl:
    implements: g.ctl
    host: cpu
    subscribes: {{i: {subscribes}}}
    timing: {{{reader}, wcet: 5 ms, bcet: 5 ms{trigger}}}
chains: {{c: {{through: [g.s1, g.ctl], deadline: 250 ms}}}}
"""


def _judge(text: str) -> tuple[float | None, str, tuple[str, ...]]:
    model = architecture(text)
    result = bound_all_chains(analyse_architecture(model), model)["c"]
    is_bounded = "diverged" not in result.bound.assumptions and result.bound.value is not None
    return float(result.bound.value / MS) if is_bounded else None, result.verdict, result.bound.assumptions[1:]  # type: ignore[operator]


def test_what_is_stored_through_one_of_two_publishers_has_no_sure_use() -> None:
    assert _judge(_text()) == (
        None,
        "not proven",
        ("no sure use: ctl keeps the last message of /obstacles: one of s2 may take the place of that of s1",),
    )


def test_what_helps_is_another_topic_or_memory() -> None:
    model = architecture(_text())
    analysis = analyse_architecture(model)
    advice = advise_on_chain(analysis, bound_all_chains(analysis, model)["c"])
    assert advice is not None
    assert advice.first_step.startswith("Let each source send on a topic of its own, or write `memory: each_source`")


def test_two_topics_of_one_input_have_two_memories() -> None:
    assert _judge(_text(subscribes="[/obstacles, /walls]", second="/walls"))[:2] == (206, "met")


def test_a_memory_for_each_source_is_written() -> None:
    assert _judge(_text(f"{PERIODIC}, inputs: {{i: {{memory: each_source}}}}"))[:2] == (206, "met")


def test_what_was_sent_once_takes_the_place_of_nothing() -> None:
    text = _text().replace("/obstacles}, timing: {period: 100 ms", "/obstacles}, timing: {behaviour: once", 2)
    text = text.replace("behaviour: once", "period: 100 ms", 1)
    assert _judge(text)[:2] == (206, "met")


def test_where_both_fire_the_queue_decides() -> None:
    assert _judge(_text("behaviour: event", trigger=", trigger: [i]"))[:2] == (111, "met")
    deep = "{topic: /obstacles, qos: {depth: 1}}"
    note = "no sure use: ctl keeps 1 of 2 messages of /obstacles that may wait (`depth: 2` keeps all)"
    assert _judge(_text("behaviour: event", deep, trigger=", trigger: [i]"))[2] == (
        f"{note}: one of s2 may take the place of that of s1",
    )
    assert _judge(_text("behaviour: event", deep.replace("1", "2"), trigger=", trigger: [i]"))[:2] == (111, "met")


@pytest.mark.parametrize(
    "trigger", [", trigger: {all: [i, j]}", ", trigger: [i], throttle: 20 ms", ", trigger: [i], every: 2"]
)
def test_what_waits_for_others_or_is_dropped_is_stored_meanwhile(trigger: str) -> None:
    kept, _, notes = _judge(_text("behaviour: event", trigger=trigger))
    assert (kept, [note.split(":")[0] for note in notes]) == (None, ["no sure use"])
    each = _text("behaviour: event, inputs: {i: {memory: each_source}}", trigger=trigger)
    assert _judge(each)[0] is not None


@pytest.mark.parametrize("first", try_some(range(0, 200, 25), 1, 4))
def test_no_simulation_exceeds_a_bound_where_topics_are_shared(first: int) -> None:
    found = {seed: exceeded(_random_text(seed), seconds=2, seeds=4) for seed in range(first, first + 25)}
    assert {seed: wrong for seed, (wrong, _) in found.items() if wrong} == {}
    assert sum(held for _, held in found.values()) > 200


def _random_text(seed: int) -> str:
    """Make sensors that share one topic or two, readers of every kind behind them, and some in one container."""
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    sensors = [f"s{at}" for at in range(dice.randint(2, 4))]
    readers = [f"r{at}" for at in range(dice.randint(1, 3))]
    topics = {name: dice.choice(("/one", "/one", "/two")) for name in sensors}
    components: dict[str, object] = {name: {"outputs": {"out": "T"}} for name in sensors}
    nodes: dict[str, dict[str, object]] = {}
    for name in sensors:
        timing = {"period": f"{dice.choice((10, 20, 25, 50, 100))} ms", "jitter": f"{dice.choice((0, 0, 3, 15))} ms"}
        nodes[name] = {"implements": f"g.{name}", "publishes": {"out": topics[name]}, "timing": _time(dice, timing)}
    for at, name in enumerate(readers):
        sources = dice.sample(sensors, dice.randint(2, len(sensors)))
        others = dice.sample([*sensors, *readers[:at]], 1)
        components[name] = {
            "inputs": {"i": [f"{each}.out" for each in sources], "j": [f"{each}.out" for each in others]},
            "outputs": {"out": "T"},
        }
        kinds: tuple[dict[str, object], ...] = (
            {"period": "30 ms"},
            {"trigger": ["i"]},
            {"trigger": ["i"]},
            {"trigger": "any"},
            {"trigger": {"all": ["i", "j"]}},
        )
        trigger = dice.choice(kinds)
        if "trigger" in trigger and dice.random() < 0.2:
            trigger = {**trigger, "throttle": "12 ms"}
        if dice.random() < 0.2:
            trigger = {**trigger, "inputs": {"i": {"memory": "each_source"}}}
        depth = dice.choice((1, 2, 3, 10))
        subscribes = [
            {"topic": topic, "qos": {"depth": depth}} for topic in dict.fromkeys(topics[each] for each in sources)
        ]
        nodes[name] = {
            "implements": f"g.{name}",
            "publishes": {"out": f"/{name}"},
            "subscribes": {"i": subscribes[0] if len(subscribes) == 1 else [each["topic"] for each in subscribes]},
            "timing": _time(dice, trigger),
        }
    for name, node in nodes.items():
        nodes[name] = {**node, **({"container": "box"} if dice.random() < 0.5 else {"host": "cpu"})}
    chains = {
        f"c{source}{reader}": {"through": [f"g.{source}", f"g.{reader}"], "deadline": "1 s"}
        for source in sensors
        for reader in readers
    }
    return json.dumps(
        {
            "groups": {"g": {"components": components}},
            "types": {"T": {"message": "my_msgs/msg/T"}},
            "hosts": {"cpu": {"cores": dice.choice((1, 2))}},
            "containers": {"box": {"host": "cpu", "threads": 1}},
            "nodes": nodes,
            "chains": chains,
        }
    )


def _time(dice: random.Random, timing: Mapping[str, object]) -> dict[str, object]:
    longest = dice.choice((100, 500, 1000, 2000, 4000))
    return {**timing, "wcet": f"{longest} us", "bcet": f"{dice.randint(0, longest)} us"}
