"""Tests of the rules on time: what they say, and where they keep quiet."""

from __future__ import annotations

from tests.judged_projects import check_text

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


def test_a_queue_of_what_is_fired_must_hold_what_comes_meanwhile() -> None:
    """Eleven come at once, and 11 x 1.8 ms are 19.8; in any 19.8 ms there come (19.8 + 20) / 2, which is 20."""
    queue = ", subscribes: {one: {qos: {depth: %s}}}"
    a = "rate: 500 Hz, jitter: 20 ms, wcet: 0 ms, bcet: 0 ms"
    assert of_pair(a, "wcet: 1.8 ms", queue % 19) == [
        "9 warning short-queue: `b` keeps 19 messages of `/g/a/out`, but 20 can come before it has read them"
    ]
    assert of_pair(a, "wcet: 1.8 ms", queue % 20) == []
    assert of_pair(a, "wcet: 1.8 ms") == []


def test_what_else_works_on_a_host_makes_a_component_slow() -> None:
    host = "host: pc, timing: {period: 100 ms, wcet: %s ms"
    text = (
        _PAIR.replace("timing: {{{a}}}", "{a}").replace("timing: {{{b}}}{more}", "{b}")
        + "hosts: {{pc: {{cores: 1}}}}\n"
    )
    both = text.format(a=host % 9 + "}", b=host % 12 + "}")
    (said,) = told(both)
    asked = "6 warning slow-component: `g.b` is asked to need at most 20 ms, but `b` takes up to 21 ms"
    assert said == f"{asked} with all that works on `pc`"
    assert told(text.format(a=host % 9 + "}", b=host % 12 + ", priority: 1}")) == []
    assert told(text.format(a=host % 8 + "}", b=host % 12 + "}")) == []


def test_an_element_that_cannot_keep_up() -> None:
    assert of_pair("rate: 10 Hz", "wcet: 120 ms") == [
        "6 warning slow-component: `g.b` is asked to need at most 20 ms, but `b` takes up to 120 ms",
        "9 warning overloaded-host: `b` takes 120 % of a core: it is fired again before it is done",
    ]
