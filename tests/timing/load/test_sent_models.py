"""What is sent along an arc: samples, calls, and the answers to one client, each up to so much later than it might."""

from __future__ import annotations

import pytest

from archgen.timing.figures.timing_values import UnknownCause
from archgen.timing.load.event_models import sent_model
from archgen.timing.load.link_queueing import settle_links
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.timing_system import calls_per_activation
from tests.timing.printed import MS, show_ms
from tests.timing.sketches import analyse_sketch, read_sketch


def _sent(role: str, client: str, server: str, latency: str) -> list[str]:
    """Return what is sent in a role as `events each period, up to jitter late`, in ms; or what is missing."""
    nodes = {"a @p": f"period: 100 ms, {client}", "s @q": server}
    rest = f"hosts: {{p: {{cores: 1}}, q: {{cores: 1}}}}\nlinks: {{lan: {{connects: [p, q]{latency}}}}}"
    system, _, state = settle_links(build_system(read_sketch(nodes, "a?s", rest))[0])
    arc = next(arc for arc in system.arcs if arc.role == role)
    model = sent_model(state, arc)
    if isinstance(model, UnknownCause):
        return [*model.missing, *model.notes]
    unit = system.tick / MS
    return [
        f"{stream.events_per_period * stream.batch_size} each {stream.period * unit}, up to {stream.jitter * unit} late"
        for stream in model
    ]


PERIODIC = "period: 100 ms"
BOTH, LATENCY = "wcet: 1 ms, bcet: 1 ms", ", latency: {best: 1 ms, worst: 4 ms}"


@pytest.mark.parametrize(
    ("server", "latency", "answers"),
    [
        # A call comes up to 1 ms after its client has started (R), over the link 4 - 1 later, and takes 5 - 2 more.
        ("wcet: 5 ms, bcet: 2 ms", LATENCY, ["1 each 100, up to 7 late"]),
        # What nobody wrote as the best case may be 0.
        ("wcet: 5 ms", LATENCY, ["1 each 100, up to 9 late"]),
        ("wcet: 5 ms, bcet: 2 ms", ", latency: {worst: 4 ms}", ["1 each 100, up to 8 late"]),
        ("response: 6 ms, bcet: 2 ms", LATENCY, ["1 each 100, up to 8 late"]),
        # A server with a clock looks for calls when it runs: 20 + 3 later at worst.
        ("period: 20 ms, jitter: 3 ms, wcet: 5 ms, bcet: 2 ms", LATENCY, ["1 each 100, up to 30 late"]),
        ("behaviour: periodic, response: 5 ms", LATENCY, ["s"]),
        ("bcet: 2 ms", LATENCY, ["s"]),
        ("wcet: 5 ms", "", ["lan"]),
        ("period: 2 ms, wcet: 5 ms", LATENCY, ["overload"]),
    ],
)
def test_answers_come_up_to_so_much_later_than_calls(server: str, latency: str, answers: list[str]) -> None:
    assert _sent("answer", BOTH, server, latency) == answers


@pytest.mark.parametrize(
    ("client", "calls"),
    [
        (BOTH, ["1 each 100, up to 1 late"]),
        # A call may leave as soon as its client starts, however long that takes at least.
        ("wcet: 3 ms, bcet: 3 ms", ["1 each 100, up to 3 late"]),
        (f"{BOTH}, calls: {{s: 2}}", ["2 each 100, up to 1 late"]),
        ("bcet: 1 ms", ["a"]),
    ],
)
def test_calls_leave_while_their_client_runs(client: str, calls: list[str]) -> None:
    assert _sent("request", client, "wcet: 5 ms", LATENCY) == calls


def test_one_call_an_activation_unless_more_are_written() -> None:
    nodes = {"a": "period: 100 ms, calls: {s: 0.5}", "b": "period: 100 ms", "s": ""}
    system, _ = build_system(read_sketch(nodes, "a?s b?s"))
    requests = [arc for arc in system.arcs if arc.role == "request"]
    counts = {arc.source: calls_per_activation(system.activities[arc.source], arc) for arc in requests}
    assert counts == {"a": 0.5, "b": 1}


def test_what_leaves_a_core_comes_as_much_later_as_the_run_to_it_may_take() -> None:
    """The 10 ms of `c` hold up `a` or `b`, but not both: 15 ms at most and 5 at least, and not 12 - 2 and 13 - 3 more."""
    nodes = {
        "a @pc": f"{PERIODIC}, wcet: 2 ms, bcet: 2 ms, priority: 2",
        "b @pc": "behaviour: event, wcet: 3 ms, bcet: 3 ms, priority: 1",
        "c @pc": f"{PERIODIC}, wcet: 10 ms, priority: 3",
        "d @q": "behaviour: event, wcet: 1 ms",
    }
    rest = "hosts: {pc: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [pc, q], latency: 0 ms}}"
    assert show_ms(analyse_sketch(nodes, "a>b b>d", rest).paces["d"].jitter) == "10"
