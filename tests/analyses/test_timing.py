"""Tests of the rules on time: what they say, and where they keep quiet."""

from __future__ import annotations

from archgen.pipeline import check_text

_RULES = {
    "period-conflict",
    "lost-samples",
    "short-queue",
    "overloaded-host",
    "slow-component",
    "saturated-link",
    "slow-service",
}
_PAIR = """
groups:
  g:
    components:
      a: {{outputs: {{out: std_msgs/msg/Empty}}}}
      b: {{inputs: {{one: a.out}}, performance: {{speed: {{execution_time: 20 ms}}}}}}
nodes:
  a: {{implements: a, timing: {{{a}}}}}
  b: {{implements: b, timing: {{{b}}}{more}}}
"""


def told(text: str) -> list[str]:
    found = (d for d in check_text(text) if d.rule in _RULES)
    return [f"{d.span.line} {d.severity} {d.rule}: {d.message}" for d in found]


def of_pair(a: str, b: str, more: str = "") -> list[str]:
    return told(_PAIR.format(a=a, b=b, more=more))


def test_a_stated_rate_that_the_inputs_do_not_give() -> None:
    assert of_pair("rate: 30 Hz", "behaviour: event, rate: 10 Hz") == [
        "9 warning period-conflict: `b` states 10 Hz, but what fires it gives 30 Hz"
    ]
    assert of_pair("rate: 30 Hz", "behaviour: event, rate: 30 Hz") == []
    assert of_pair("wcet: 1 ms", "behaviour: event, rate: 30 Hz") == []


def test_sampling_on_purpose_is_no_finding() -> None:
    assert of_pair("rate: 500 Hz, wcet: 1 ms", "rate: 10 Hz, wcet: 1 ms") == []
    one = ", subscribes: {one: {qos: {depth: 1}}}"
    assert of_pair("rate: 500 Hz, wcet: 1 ms", "rate: 10 Hz, wcet: 1 ms", one) == []


def test_a_queue_that_was_asked_for_must_hold_what_comes() -> None:
    queue = ", subscribes: {one: {qos: {depth: 20}}}"
    assert of_pair("rate: 500 Hz, wcet: 1 ms, bcet: 1 ms", "rate: 10 Hz, wcet: 1 ms", queue) == [
        "9 warning short-queue: `b` keeps 20 messages of `/g/a/out`, but 51 can come before it has read them"
    ]


def test_an_element_that_cannot_keep_up() -> None:
    assert of_pair("rate: 10 Hz", "wcet: 120 ms") == [
        "6 warning slow-component: `g.b` is asked to need at most 20 ms, but `b` takes up to 120 ms",
        "9 warning overloaded-host: `b` takes 120 % of a core: it is fired again before it is done",
    ]
