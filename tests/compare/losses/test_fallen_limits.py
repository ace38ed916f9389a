"""Promises and freshness that are kept no more: at which changes that is laid, and whom it breaks."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.compare.losses.test_losses import broken

BASE = """\
project: {id: p, title: P}
partners: {a: A, b: B, c: C}
types: {Rows: std_msgs/msg/Int32}
hosts: {pc: {cores: 1}}
groups:
  sense:
    owner: a
    components:
      eye: {outputs: {rows: {type: Rows, promise: {rate: 10 Hz, max_gap: 130 ms, max_age: 150 ms}}}}
      other: Other
  act: {owner: b, components: {base: {inputs: {rows: eye.rows}}}}
  logging: {owner: c, components: {log: Log}}
nodes:
  eye: {implements: eye, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  other: {implements: other, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  base: {implements: base, host: pc, timing: {rate: 20 Hz, wcet: 5 ms}}
  log: {implements: log, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
"""


def load(other: str, log: str) -> list[tuple[str, str]]:
    """Give `other` and `log` other execution times than 5 ms."""
    return [
        (
            f"  {name}: {{implements: {name}, host: pc, timing: {{rate: 10 Hz, wcet: 5 ms",
            f"  {name}: {{implements: {name}, host: pc, timing: {{rate: 10 Hz, wcet: {time}",
        )
        for name, time in (("other", other), ("log", log))
        if time != "5 ms"
    ]


def test_show(compared: Compared) -> None:
    for times in (
        ("60 ms", "5 ms"),
        ("10 ms", "5 ms"),
        ("10 ms", "10 ms"),
        ("20 ms", "20 ms"),
        ("60 ms", "4 ms"),
        ("16 ms", "0.1 ms"),
        ("14 ms", "5 ms"),
    ):
        print(times, *broken(compared, BASE, load(*times)), sep="\n    ")
