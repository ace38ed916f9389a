"""Which hosts share their cores fairly, and what is assumed of them."""

from __future__ import annotations

import pytest

from archgen.timing.system.core_placement import find_fair_share, find_resources
from archgen.timing.system.system_builder import build_system
from tests.timing.random_systems import architecture
from tests.timing.sketches import sketch

MS = 10**6


@pytest.mark.parametrize(
    ("host", "lead", "assumes"),
    [
        ("{cores: 1}", 20, True),
        ("{cores: 1, scheduling: fair}", 20, True),
        ("{cores: 1, scheduling: {fair: {slice: 1 ms, tick: 0 ms}}}", 5, True),
        ("{cores: 1, scheduling: {fair: {slice: 1 ms, tick: 0 ms, lead: 3}}}", 3, False),
        ("{cores: 1, scheduling: round_robin}", None, False),
        ("{cores: 1, scheduling: {0: fifo}}", None, False),
        ("{cores: 1, scheduling: {fair: {lead: 3}, 0: fifo}}", None, False),
        ("{}", None, False),
    ],
)
def test_a_host_without_another_order_shares_its_cores(host: str, lead: int | None, *, assumes: bool) -> None:
    nodes = dict.fromkeys(("a @h", "b @h"), "behaviour: periodic, period: 100 ms, wcet: 2 ms")
    system, _ = build_system(architecture(sketch(nodes, "", f"hosts: {{h: {host}}}"), is_fair=True))
    share = find_fair_share(system, find_resources(system)[0])
    assert (None if share is None else share.lead * system.tick) == (None if lead is None else lead * MS)
    assert bool(share and share.assumption) == assumes
