"""Links: traffic, burst and queueing in numbers, and the latency of those that state only their bandwidth."""

from __future__ import annotations

from collections.abc import Callable

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.task_sets import MS

Derived = Callable[[str], Architecture]

CAMERAS = """
groups:
  g:
    components:
      left: {outputs: {image: Picture}}
      right: {outputs: {image: Picture}}
      viewer: {inputs: {left: left.image}}
      logger: {inputs: {right: right.image}}
types: {Picture: {message: sensor_msgs/msg/Image, SIZE}}
nodes:
  left: {implements: left, host: head, timing: {rate: 10 Hz, wcet: 1 ms, bcet: 1 ms}}
  right: {implements: right, host: head2, timing: {rate: 10 Hz, wcet: 1 ms, bcet: 1 ms}}
  viewer: {implements: viewer, host: base, timing: {wcet: 3 ms}}
  logger: {implements: logger, host: base2, timing: {wcet: 3 ms}}
hosts: {head: {cores: 1}, head2: {cores: 1}, base: {cores: 1}, base2: {cores: 1}}
links: {lan: {connects: [head, head2, base, base2], bandwidth: 1 Gbit/s, LATENCY}}
chains: {see: {through: [left, viewer], deadline: 125 ms}}
"""


def cameras(derived: Derived, latency: str = "", size: str = "size: 1 MB") -> tuple[Architecture, Analysis]:
    architecture = derived(CAMERAS.replace("LATENCY", latency).replace("SIZE", size))
    return architecture, analyse_architecture(architecture)


def test_two_pictures_wait_for_one_another(derived: Derived) -> None:
    """1 MB takes 8 ms at 125 MB/s; two at once 16 ms; 20 MB/s are 16 % of the bandwidth."""
    _, found = cameras(derived)
    load = found.links["lan"]
    assert [load.traffic.value, load.burst.value] == [20_000_000, 2_000_000]
    assert load.share.value is not None
    assert float(load.share.value) == 0.16
    assert load.queueing.value == 16 * MS


def test_a_bandwidth_alone_bounds_the_latency(derived: Derived) -> None:
    architecture, found = cameras(derived)
    see = bound_all_chains(found, architecture)["see"]
    assert see.bound.value == (100 + 1 + 16 + 3) * MS
    assert see.bound.assumptions == ("link lan takes no longer than its bandwidth lets it",)
    assert see.verdict == "met"


def test_what_is_on_its_way_anyhow_comes_on_top(derived: Derived) -> None:
    architecture, found = cameras(derived, "latency: {best: 6 ms}")
    see = bound_all_chains(found, architecture)["see"]
    assert see.bound.value == (100 + 1 + 6 + 16 + 3) * MS
    assert see.best.value == 7 * MS
    assert see.verdict == "not proven"


def test_a_worst_latency_that_is_written_holds_with_the_queueing_in_it(derived: Derived) -> None:
    architecture, found = cameras(derived, "latency: {best: 9 ms, worst: 20 ms}")
    see = bound_all_chains(found, architecture)["see"]
    assert see.bound.value == (100 + 1 + 20 + 3) * MS
    assert see.bound.assumptions == ("queueing on link lan (up to 16 ms) is within its latency",)


def test_a_worst_latency_below_the_queueing_is_taken_and_said(derived: Derived) -> None:
    architecture, found = cameras(derived, "latency: 1 ms")
    see = bound_all_chains(found, architecture)["see"]
    assert see.bound.value == (100 + 1 + 1 + 3) * MS
    assert see.bound.assumptions == ("link lan keeps its written latency, though 16 ms of traffic can wait for it",)


def test_without_sizes_nothing_is_said(derived: Derived) -> None:
    architecture, found = cameras(derived, size="comment: large")
    see = bound_all_chains(found, architecture)["see"]
    assert (see.bound.complete, see.bound.missing, see.verdict) == (False, ("lan",), "open")
    assert found.links["lan"].queueing.missing == ("/g/left/image", "/g/right/image")


def test_a_saturated_link_has_no_latency(derived: Derived) -> None:
    """20 pictures of 6.25 MB a second are just the bandwidth."""
    _, found = cameras(derived, size="size: 6.25 MB")
    load = found.links["lan"]
    assert load.share.value == 1
    assert (load.queueing.value, load.queueing.assumptions) == (None, ("unbounded",))
    assert (load.burst.value, load.burst.assumptions) == (None, ("unbounded",))
    assert found.responses["viewer"].worst.missing == ("lan",)


CAN = """
groups:
  g:
    components:
      a: {outputs: {frame: Frame}}
      b: {outputs: {frame: Frame}}
      c: {outputs: {frame: Frame}}
      sink: {inputs: {a: a.frame, b: b.frame, c: c.frame}}
types: {Frame: {message: std_msgs/msg/String, size: 125 B}}
nodes:
  a: {implements: a, host: one, timing: {period: 2.5 ms, wcet: 0 ms}}
  b: {implements: b, host: one, timing: {period: 3.5 ms, wcet: 0 ms}}
  c: {implements: c, host: one, timing: {period: 3.5 ms, wcet: 0 ms}}
  sink: {implements: sink, host: two, timing: {period: 1 ms, wcet: 0 ms}}
hosts: {one: {}, two: {}}
links: {can: {connects: [one, two], bandwidth: 1 Mbit/s}}
"""


def test_a_bus_with_priorities_stays_within_the_busy_period(derived: Derived) -> None:
    """The three messages of Davis et al. 2007, 1 ms each: at most 3.5 ms with priorities, 3 first come, first served;
    whoever chooses the order, the bus falls idle after 7 ms.
    """
    load = analyse_architecture(derived(CAN)).links["can"]
    assert load.queueing.value == 7 * MS
    assert load.burst.value == 375


CALL = """
groups:
  g:
    components:
      boss: {inputs: {plan: planner.plan}}
      planner: {outputs: {plan: Plan on request}}
types: {Plan on request: {message: nav_msgs/srv/GetPlan, size: 25 kB}}
nodes:
  boss: {implements: boss, host: one, timing: {period: 100 ms, wcet: 1 ms, bcet: 1 ms, calls: {plan: 2}}}
  planner: {implements: planner, host: two, timing: {wcet: 5 ms, bcet: 5 ms}}
hosts: {one: {cores: 1}, two: {cores: 1}}
links: {lan: {connects: [one, two], bandwidth: 10 MB/s}}
"""


def test_calls_and_their_answers_are_traffic(derived: Derived) -> None:
    """Two calls each 100 ms, 25 kB there and back: 1 MB/s; all four may meet and take 10 ms."""
    found = analyse_architecture(derived(CALL))
    load = found.links["lan"]
    assert (load.traffic.value, load.burst.value, load.queueing.value) == (1_000_000, 100_000, 10 * MS)
    assert found.responses["planner"].worst.value == 10 * MS


THERE_AND_BACK = """
groups:
  g:
    components:
      a: {outputs: {out: Data}}
      b: {inputs: {go: a.out}, outputs: {out: Data}}
      c: {inputs: {go: b.out}}
types: {Data: {message: std_msgs/msg/String, size: 10 kB}}
nodes:
  a: {implements: a, host: one, timing: {period: 20 ms, wcet: 1 ms, bcet: 1 ms}}
  b: {implements: b, host: two, timing: {wcet: 1 ms, bcet: 1 ms}}
  c: {implements: c, host: one, timing: {wcet: 1 ms, bcet: 1 ms, priority: 1}}
hosts: {one: {cores: 1}, two: {cores: 1}}
links: {lan: {connects: [one, two], bandwidth: 10 MB/s}}
chains: {round: {through: [a, b, c]}}
"""


def test_a_link_and_what_it_delays_find_one_fixed_point(derived: Derived) -> None:
    """Each message takes 1 ms, both may meet: 2 ms. b comes up to 2 ms late, and c up to 4, which changes nothing: the
    busy period of two messages ends before a third can come. a waits for no c: the one before it came back long ago.
    """
    architecture = derived(THERE_AND_BACK)
    found = analyse_architecture(architecture)
    assert found.links["lan"].queueing.value == 2 * MS
    assert found.paces["c"].jitter.value == (2 + 2) * MS
    assert bound_all_chains(found, architecture)["round"].bound.value == (20 + 1 + 2 + 1 + 2 + 1) * MS


SERVICE = """
groups:
  g:
    components:
      server: {outputs: {answer: {type: Ask}}}
      client: {inputs: {ask: {from: server.answer, type: Ask}}}
types: {Ask: {message: std_srvs/srv/Trigger, size: 1 kB}}
nodes:
  server: {implements: server, host: head, timing: {behaviour: on_demand, wcet: 1 ms, bcet: 1 ms}}
  client: {implements: client, host: base, timing: {rate: 10 Hz, wcet: 1 ms, bcet: 1 ms}}
hosts: {head: {cores: 1}, base: {cores: 1}}
links: {lan: {connects: [head, base], bandwidth: 1 MB/s, latency: {LATENCY}}}
"""


def test_a_service_over_a_link_without_a_best_latency_is_as_over_one_with_zero(derived: Derived) -> None:
    unwritten, zero, less = (
        analyse_architecture(derived(SERVICE.replace("LATENCY", latency))).links["lan"].queueing
        for latency in ("worst: 30 ms", "best: 0 ms, worst: 30 ms", "best: 29 ms, worst: 30 ms")
    )
    assert unwritten.value is not None
    assert unwritten == zero
    assert less.value is not None
    # The bound must not be better than that of a link of which more is known.
    assert unwritten.value >= less.value
