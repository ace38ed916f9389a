"""What is wrong about time, through the whole pipeline: each slip is said at its place, and the rest is still analysed."""

from __future__ import annotations

import pytest

from tests.judged_projects import check_text

PROJECT = """
rules: {missing-detail: off}
groups:
  arm:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      seer: {inputs: {image: camera.image}, outputs: {objects: vision_msgs/msg/Detection3DArray}}
      mover: {inputs: {objects: seer.objects}, outputs: {motion: {medium: physical, external: The arm moves}}}
nodes:
  camera_node: {implements: camera}
  mover_node: {implements: mover}
  seer_node:
    implements: seer
"""
UNITS = "(a duration is a number and one of the units `ns us ms s min h`, such as `80 ms`)"
DIGITS = "(at most 18 are read before and after the point)"
UNKNOWN = "(leave it out where it is not known)"


def found(rest: str) -> list[str]:
    """Judge the project with more text below; lines count from the first that is added."""
    above = PROJECT.count("\n")
    return [
        f"{d.severity} {d.span.line - above}:{d.span.column} {d.rule}: {d.message}"
        + "".join(f" [{label.text} {label.span.line - above}:{label.span.column}]" for label in d.labels[:1])
        + (f" ({d.help})" if d.help else "")
        for d in check_text(f"{PROJECT}{rest}")
    ]


@pytest.mark.parametrize(
    ("timing", "column", "finding"),
    [
        ("period: 0 ms", 22, f"wrong-value: a period cannot be zero {UNKNOWN}"),
        ("period: 0.0 s", 22, f"wrong-value: a period cannot be zero {UNKNOWN}"),
        ("rate: 0 Hz", 20, f"wrong-value: a rate cannot be zero {UNKNOWN}"),
        ("period: -5 ms", 22, f"wrong-value: `period` cannot be negative {UNITS}"),
        ("wcet: -5 ms", 20, f"wrong-value: `wcet` cannot be negative {UNITS}"),
        ("wcet: 3 Hz", 20, f"wrong-value: `wcet` has no unit `Hz` {UNITS}"),
        ("jitter: 200 kB", 22, f"wrong-value: `jitter` has no unit `kB` {UNITS}"),
        ("response: 5", 24, f"wrong-value: `5` has no unit (write `5 s` or `5 ms`, whichever is meant; {UNITS[1:]}"),
        ("bcet: 1e3 ms", 20, f"wrong-value: `bcet` cannot be `1e3 ms` {UNITS}"),
        ("wcet: 12345678901234567890 ms", 20, f"wrong-value: `wcet` has too many digits {DIGITS}"),
        ("throttle: 0.12345678901234567890 s", 24, f"wrong-value: `throttle` has too many digits {DIGITS}"),
        (
            "every: 12345678901234567890",
            21,
            "wrong-value: `every` cannot be `12345678901234567890` (it is at most 1000000)",
        ),
        ("every: 0", 21, "wrong-value: `every` cannot be `0` (it is at least 1)"),
        ("core: -1", 20, "wrong-value: `core` cannot be `-1` (it is at least 0)"),
        (
            "calls: {image: 12345678901234567890}",
            29,
            "wrong-value: `image` cannot be `12345678901234567890` (it is at most 1000000)",
        ),
        (
            "trigger: [objects]",
            24,
            "unknown-reference: no input named `objects` in `arm.seer` [an output -6:55] (`objects` is an output)",
        ),
        (
            "trigger: {all: [imag]}",
            30,
            "unknown-reference: no input named `imag` in `arm.seer` [declared here -6:23] (did you mean `image`?)",
        ),
        ("trigger: []", 23, "wrong-value: `trigger` names no input (name one or more, or leave `trigger` out)"),
        ("trigger: {all: []}", 29, "wrong-value: `all` names no input (name one or more, or leave `all` out)"),
        ("trigger: some", 23, "wrong-value: `trigger` cannot be `some` (write `[some]`)"),
        ("outputs: {objects: {max_gap: 0 s}}", 43, f"wrong-value: `max_gap` cannot be zero {UNKNOWN}"),
        (
            "bcet: 9 ms, wcet: 5 ms",
            20,
            (
                "wrong-value: the best case execution time (`bcet`, 9 ms) is above the worst (`wcet`, 5 ms) "
                "[the worst case 1:32] (exchange them, or leave `bcet` out)"
            ),
        ),
        (
            "period: 5 ms, rate: 3 Hz",
            34,
            (
                "wrong-value: `rate` and `period` are both written [the period 1:22] "
                "(write one of them: each follows from the other)"
            ),
        ),
    ],
)
def test_each_slip_is_one_error_at_its_value(timing: str, column: int, finding: str) -> None:
    assert found(f"    timing: {{{timing}}}\n") == [f"error 1:{column} {finding}"]


LEGAL = "(this is legal: correct it only where a figure or a unit is wrong)"


@pytest.mark.parametrize(
    ("timing", "finding"),
    [
        (
            "period: 5 ms, wcet: 9 ms",
            (
                "1:34 long-execution: the worst case execution time of `seer_node` (`wcet`, 9 ms) is above its period "
                f"[its period 1:22] {LEGAL}"
            ),
        ),
        (
            "rate: 100 Hz, jitter: 11 ms",
            (
                "1:36 large-jitter: the jitter of `seer_node` (`jitter`, 11 ms) is above its period "
                f"[its rate 1:20] {LEGAL}"
            ),
        ),
    ],
)
def test_more_than_a_period_is_legal_and_noted(timing: str, finding: str) -> None:
    assert notes(timing) == [f"note {finding}"]


def test_a_whole_period_is_not_even_noted() -> None:
    assert notes("rate: 100 Hz, jitter: 10 ms, wcet: 10 ms, bcet: 0 ms") == []


def notes(timing: str) -> list[str]:
    """Give the notes on a node of a host with several cores, where an execution may begin before the last one is done."""
    said = found(f"    timing: {{{timing}}}\n    host: pc\nhosts: {{pc: {{cores: 4}}}}\n")
    assert not [line for line in said if line.startswith("error")]
    return [line for line in said if line.startswith("note")]


def test_what_a_node_writes_for_two_components_is_noted_once() -> None:
    text = """
rules: {missing-detail: off}
groups:
  arm:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      seer: {inputs: {image: camera.image}, outputs: {light: {medium: physical, external: A person looks}}}
nodes:
  both: {implements: [camera, seer], host: pc, timing: {period: 5 ms, wcet: 9 ms}}
hosts: {pc: {cores: 8}}
"""
    assert [f"{d.span.line} {d.rule}" for d in check_text(text)] == ["9 long-execution"]


@pytest.mark.parametrize(
    ("rest", "findings"),
    [
        (
            "chains: {c: {through: [mover_node, camera_node], deadline: 0 ms}}",
            [
                # That nothing leads from one to the other waits until the deadline can be read.
                f"error 1:60 wrong-value: `deadline` cannot be zero {UNKNOWN}",
            ],
        ),
        (
            "chains: {c: {through: [camera_node, zebra], deadline: 5 Hz}}",
            [
                "error 1:37 unknown-reference: no node, component or output named `zebra`",
                f"error 1:55 wrong-value: `deadline` has no unit `Hz` {UNITS}",
            ],
        ),
        (
            "chains: {c: {through: []}}",
            ["error 1:23 wrong-value: `through` names no element (name one or more, or leave `through` out)"],
        ),
        (
            "hosts: {h: {cores: 0}, i: {cores: 12345678901234567890}}",
            [
                "error 1:20 wrong-value: `cores` cannot be `0` (it is at least 1)",
                "error 1:35 wrong-value: `cores` cannot be `12345678901234567890` (it is at most 1000000)",
            ],
        ),
        ("containers: {k: {threads: 0}}", ["error 1:27 wrong-value: `threads` cannot be `0` (it is at least 1)"]),
        (
            (
                "hosts: {h: {}, i: {}}\n"
                "links: {l: {connects: [h, i], bandwidth: 0 bit/s, latency: {best: 5 ms, worst: 2 ms}}}"
            ),
            [
                f"error 2:42 wrong-value: `bandwidth` cannot be zero {UNKNOWN}",
                "error 2:67 wrong-value: the best latency (5 ms) is above the worst (2 ms) [the worst 2:80] (exchange them)",
            ],
        ),
        (
            "types: {Cloud: {message: sensor_msgs/msg/Image, size: 12345678901234567890 kB}}",
            [f"error 1:55 wrong-value: `size` has too many digits {DIGITS}"],
        ),
    ],
)
def test_chains_hosts_links_and_types(rest: str, findings: list[str]) -> None:
    assert [line for line in found(f"{rest}\n") if "unused-type" not in line] == findings
