"""An executor of ROS 2 with one thread has bounds at any load: it works in rounds, skips ticks and keeps so many messages."""

from __future__ import annotations

import random

import pytest

from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
from tests.timing.exceeded import exceeded
from tests.timing.printed import show_ms
from tests.timing.random_systems import architecture
from tests.timing.sketches import analyse_sketch, sketch

REST = "hosts: {pc: {cores: 1}}\ncontainers: {box: {threads: 1, host: pc, scheduling: ros2_executor}}"


def write_published(sensors: float, fusion: float, actuator: float) -> str:
    """Write the case study of H. Teper et al. (RTSS 2022): two sensors, each with a filter, fused, filtered, acted on.

    All is in one executor, with queues of 10; a period of 0 is what the last input fires. Rounds take 180 ms.
    """

    def time(period: float, trigger: str, cost: float, *stored: str) -> str:
        callbacks = f", inputs: {{{', '.join(f'{key}: {{wcet: {cost} ms}}' for key in stored)}}}" if stored else ""
        when = f"period: {period} ms" if period else f"trigger: [{trigger}]"
        return f"{{{when}, wcet: {cost} ms, bcet: {cost} ms{callbacks}}}"

    timings = {
        "sensor1": time(sensors, "", 10),
        "sensor2": time(sensors, "", 20),
        "process1": time(0, "s", 10),
        "process2": time(0, "s", 20),
        "fusion1": time(fusion, "two", 30, *(("one", "two") if fusion else ("one",))),
        "filter3": time(0, "f", 30),
        "act": time(actuator, "r", 30, *(("r",) if actuator else ())),
    }
    nodes = "".join(
        f"  {name}: {{implements: {name}, container: box, timing: {one}}}\n" for name, one in timings.items()
    )
    return (
        "groups:\n  g:\n    components:\n"
        "      sensor1: {outputs: {out: E}}\n      sensor2: {outputs: {out: E}}\n"
        "      process1: {inputs: {s: sensor1.out}, outputs: {out: E}}\n"
        "      process2: {inputs: {s: sensor2.out}, outputs: {out: E}}\n"
        "      fusion1: {inputs: {one: process1.out, two: process2.out}, outputs: {out: E}}\n"
        "      filter3: {inputs: {f: fusion1.out}, outputs: {out: E}}\n"
        "      act: {inputs: {r: filter3.out}, outputs: {done: {type: E, external: motor}}}\n"
        f"nodes:\n{nodes}types: {{E: {{message: std_msgs/msg/Empty}}}}\n{REST}\n"
        "chains:\n  one: {through: [sensor1, process1, fusion1, filter3, act]}\n"
        "  two: {through: [sensor2, process2, fusion1, filter3, act]}\n"
    )


@pytest.mark.parametrize(
    ("periods", "bounds"),
    [
        ((90, 0, 0), ["2810", "1170"]),
        ((105, 0, 52.5), ["7885/2", "4035/2"]),
        ((105, 52.5, 0), ["4035/2", "4035/2"]),
        ((120, 60, 60), ["3060", "3060"]),
    ],
)
def test_published_overload(periods: tuple[float, float, float], bounds: list[str]) -> None:
    """`over_SS`, `ST`, `TS`, `TT`, loads of 2 and more."""
    text = write_published(*periods)
    model = architecture(text)
    found = bound_all_chains(analyse_architecture(model), model)
    assert [show_ms(found[key].bound) for key in ("one", "two")] == bounds
    wrong, held = exceeded(text, seconds=20, seeds=8)
    assert (wrong, held > 20) == ([], True)


def write_executor(seed: int) -> str:
    """Write an executor with a load of 0.6 to 3.5: timers, what they fire, what is stored, depths of 1 to 10."""
    chance = random.Random(seed)  # noqa: S311 - no secret
    count, load = chance.randint(2, 8), chance.uniform(0.6, 3.5)
    components, nodes, ways = [], [], {0: [0]}
    for at in range(count):
        cost = chance.randint(100, 4000)
        behaviour = f"period: {max(round(cost * count / load * chance.uniform(0.7, 1.4)), 50)} us"
        inputs, stored = "", ""
        sources = chance.sample(range(at), min(at, chance.choice((1, 1, 1, 2))))
        if sources:
            inputs = f"inputs: {{{', '.join(f'i{each}: c{each}.out' for each in sources)}}}, "
            fired = [each for each in sources if chance.random() < 0.6]
            if fired:
                behaviour = f"trigger: [{', '.join(f'i{each}' for each in fired)}]"
            callbacks = [f"i{each}: {{wcet: {chance.randint(0, 500)} us}}" for each in sources if each not in fired]
            stored = f", inputs: {{{', '.join(callbacks)}}}" if callbacks and chance.random() < 0.5 else ""
            ways[at] = [*ways.get(sources[0], [sources[0]]), at]
        qos = (
            f"publishes: {{out: {{topic: /t{at}, qos: {{depth: {chance.choice((1, 2, 5, 10))}}}}}}}, "
            if chance.random() < 0.7
            else ""
        )
        components.append(f"      c{at}: {{{inputs}outputs: {{out: E}}}}")
        best = f"bcet: {chance.choice((cost, cost // 2))} us"
        nodes.append(
            f"  c{at}: {{implements: c{at}, container: box, {qos}timing: {{{behaviour}, wcet: {cost} us, {best}{stored}}}}}"
        )
    chains = [
        f"  k{at}: {{through: [{', '.join(f'c{each}' for each in way)}]}}" for at, way in ways.items() if len(way) > 1
    ]
    parts = [
        "groups:\n  g:\n    components:",
        *components,
        "nodes:",
        *nodes,
        "types: {E: {message: std_msgs/msg/Empty}}",
        REST,
    ]
    return "\n".join([*parts, "chains:" if chains else "", *chains, ""])


def hold_executors(seeds: range) -> int:
    """Hold the bounds of executors against simulations; return how many were held."""
    held_count = 0
    for seed in seeds:
        wrong, held = exceeded(write_executor(seed))
        assert not wrong, (seed, wrong)
        held_count += held
    return held_count


@pytest.mark.parametrize("first", try_some(range(0, 400, 20), 1, 8))
def test_no_simulation_exceeds_a_bound_of_an_overloaded_executor(first: int) -> None:
    assert hold_executors(range(first, first + 20)) > 150


OVER = {
    "a +box": "period: 10 ms, wcet: 8 ms, bcet: 8 ms",
    "b +box": "behaviour: event, trigger: any, wcet: 6 ms, bcet: 6 ms",
}


def test_a_run_takes_a_round_for_each_step_and_one_more() -> None:
    """S is 14: 28 for the timer, which starts 10 + 28 - 8 after its last start at the latest, and 42 to the end of `b`."""
    analysis = analyse_sketch(OVER, "a>b", f"{REST}\nchains: {{c: {{through: [g.a, g.b]}}}}")
    assert [show_ms(analysis.responses[name].worst) for name in "ab"] == ["28", "28"]
    assert show_ms(analysis.runs["b"].worst) == "42"
    assert [reason.text for reason in analysis.paces["a"].reasons] == [
        "every 10 ms, as written",
        "skips ticks: the rate is not kept",
    ]
    assert (analysis.paces["a"].rate.side, analysis.hosts["pc"].verdict) == ("at most", "overload")


def test_a_queue_of_one_message_has_no_bound() -> None:
    """`a` works again before `b` in the next round, and overwrites what was meant for it."""
    text = sketch(OVER, "a>b", REST).replace("implements: b,", "implements: b, subscribes: {a: {qos: {depth: 1}}},")
    responses = analyse_architecture(architecture(text)).responses
    assert (show_ms(responses["a"].worst), responses["b"].worst.value) == ("28", None)


def test_two_writers_of_a_topic_send_more_than_a_round_takes() -> None:
    """Of two messages in each round one is taken: the queue fills up, whatever its depth."""
    nodes = {**OVER, "c +box": "period: 10 ms, wcet: 2 ms"}
    text = sketch(nodes, "a>b c>b", REST).replace("b: {inputs: {a: a.out, c: c.out}", "b: {inputs: {a: [a.out, c.out]}")
    text = text.replace("implements: a,", "implements: a, publishes: {out: /t},").replace(
        "implements: c,", "implements: c, publishes: {out: /t},"
    )
    assert analyse_architecture(architecture(text)).responses["b"].worst.value is None


def test_several_threads_or_another_order_have_no_rounds() -> None:
    for other in (REST.replace("threads: 1", "threads: 2"), REST.replace("ros2_executor", "fifo")):
        assert analyse_sketch(OVER, "a>b", other).responses["a"].worst.value is None
