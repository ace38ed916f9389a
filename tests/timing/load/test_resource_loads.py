"""Shares that activities take of a resource, and whether it bears them: a GPU, in sketches."""

from __future__ import annotations

import pytest

from tests.timing.printed import show, show_ms
from tests.timing.sketches import analyse_sketch

HOST = "hosts: {pc: {cores: 4}}\nresources: {gpu: {host: pc}}"


@pytest.mark.parametrize(
    ("use", "rate", "load", "verdict"),
    [
        ("2 ms", "100 Hz", "1/5", "bearable"),
        ("10 ms", "100 Hz", "1", "bearable"),  # full, and not a job more
        ("11 ms", "100 Hz", "11/10", "overload"),
    ],
)
def test_a_resource_bears_what_fills_it_and_no_more(use: str, rate: str, load: str, verdict: str) -> None:
    analysis = analyse_sketch({"a @pc": f"rate: {rate}, wcet: 1 ms, uses: {{gpu: {use}}}"}, "", HOST)
    gpu = analysis.resources["gpu"]
    assert (gpu.host, show(gpu.utilisation), gpu.verdict) == ("pc", load, verdict)
    assert [(name, show(share)) for name, share in gpu.shares] == [("a", load)]


def test_a_user_whose_rate_nobody_knows_leaves_the_load_open() -> None:
    nodes = {"a @pc": "rate: 10 Hz, wcet: 1 ms, uses: {gpu: 2 ms}", "b @pc": "wcet: 1 ms, uses: {gpu: 2 ms}"}
    gpu = analyse_sketch(nodes, "", HOST).resources["gpu"]
    assert gpu.verdict == "unknown"
    assert dict(gpu.shares)["a"].value == pytest.approx(0.02)
    assert dict(gpu.shares)["b"].value is None


def test_a_use_waits_for_one_of_each_other_user() -> None:
    nodes = {
        "a @pc": "rate: 10 Hz, wcet: 1 ms, uses: {gpu: 2 ms}",
        "b @pc": "rate: 10 Hz, wcet: 1 ms, uses: {gpu: 3 ms}",
    }
    gpu = analyse_sketch(nodes, "", HOST).resources["gpu"]
    note = "[gpu serves whoever came first]"
    assert {name: show_ms(wait) for name, wait in gpu.waits.items()} == {"a": f"5 {note}", "b": f"5 {note}"}
