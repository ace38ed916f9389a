"""How gaps follow from one another, as formulas that a reader can compute again."""

from __future__ import annotations

import pytest

from tests.timing.sketches import analyse_sketch, explain, read_sketch


@pytest.mark.parametrize(
    ("timing", "lines"),
    [
        ("trigger: [a]", []),
        ("trigger: [a], every: 2", ["gap 2 x 12 ms = 24 ms: one in 2 fires it"]),
        ("trigger: [a], jitter: 4 ms", ["gap 12 ms + 4 ms = 16 ms: jitter 4 ms"]),
        ("trigger: [a], throttle: 25 ms", ["gap 12 ms + 25 ms = 37 ms: throttle 25 ms"]),
        (
            "trigger: [a], throttle: 25 ms, jitter: 4 ms, every: 2",
            ["gap 2 x 12 ms + 25 ms + 4 ms = 53 ms: one in 2 fires it; throttle 25 ms; jitter 4 ms"],
        ),
    ],
)
def test_what_thins_a_trigger_is_in_the_formula_of_its_gap(timing: str, lines: list[str]) -> None:
    sketch = {"a": "period: 10 ms, jitter: 2 ms, wcet: 1 ms, bcet: 1 ms", "slow": f"{timing}, wcet: 1 ms"}, "a>slow"
    explained = explain(analyse_sketch(*sketch), read_sketch(*sketch), "slow")
    formulas = [line.strip().partition(" @")[0] for line in explained if line.startswith("  gap ")]
    assert formulas == lines
