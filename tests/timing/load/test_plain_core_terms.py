"""What a response on one core is made of: the thread's own work, and that of all that may hold it up."""

from __future__ import annotations

import pytest

from tests.timing.sketches import analyse_sketch, explain, read_sketch


@pytest.mark.parametrize(
    ("name", "works"),
    [
        ("a", ["1 x 1 ms a = 1 ms, its own"]),
        ("b", ["1 x 2 ms b = 2 ms, its own", "1 x 1 ms a = 1 ms, since ceil(3 ms / 10 ms) = 1"]),
        (
            "c",
            [
                "1 x 8 ms c = 8 ms, its own",
                "2 x 1 ms a = 2 ms, since ceil(12 ms / 10 ms) = 2",
                "1 x 2 ms b = 2 ms, since ceil(12 ms / 20 ms) = 1",
            ],
        ),
    ],
)
def test_only_what_is_as_urgent_holds_a_thread_up(name: str, works: list[str]) -> None:
    sketch = (
        {
            "a @pc": "period: 10 ms, wcet: 1 ms, priority: 3",
            "b @pc": "period: 20 ms, wcet: 2 ms, priority: 2",
            "c @pc": "period: 40 ms, wcet: 8 ms, priority: 1",
        },
        "",
        "hosts: {pc: {cores: 1}}",
    )
    lines = [line.strip().partition(" @")[0] for line in explain(analyse_sketch(*sketch), read_sketch(*sketch), name)]
    assert [line for line in lines if line.split(" ")[1:2] == ["x"]] == works
