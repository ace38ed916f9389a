"""A host of several cores, taken as one: what goes to and fro between its cores is done as soon as one would do it all."""

from __future__ import annotations

import pytest

from tests.timing.sketches import analyse_sketch, list_responses

WAYS = {"s": "core: 0", "a": "core: 1", "b": "core: 0", "c": "core: 1", "d": "core: 0", "e": "core: 1"}


@pytest.mark.parametrize(
    ("cost", "responses"),
    [
        # 6 x 15 ms: `d` ends 90 ms after the event at the latest, less the 4 x 15 before it. On its core `s` meets two
        # of `b`, which may be up to 90 - 30 ms late, and one of `d`.
        (
            15,
            [
                "s 15..60 host",
                "a 15..45 host",
                "b 15..60 host",
                "c 15..45 host",
                "d 15..30 whole host",
                "e 15..15 whole host",
            ],
        ),
        # 6 x 17 ms are more than one core does in 100 ms.
        (17, [f"{name} 17..none [diverged] host" for name in WAYS]),
    ],
)
def test_a_chain_between_two_cores_to_and_fro(cost: int, responses: list[str]) -> None:
    timings = f"wcet: {cost} ms, bcet: {cost} ms"
    nodes = {f"{name} @pc": f"{pin}, {timings}" for name, pin in WAYS.items()}
    nodes["s @pc"] = f"period: 100 ms, {nodes['s @pc']}"
    analysis = analyse_sketch(nodes, "s>a a>b b>c c>d d>e", "hosts: {pc: {cores: 2}}")
    assert list_responses(analysis) == responses
