"""Tests of chains: each element must lead to the next."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.broken_chains import broken_chain

Found = Callable[..., list[str]]

_ROBOT = """
    type Check std_srvs/srv/Trigger
    out a.camera.image
    out a.camera.depth
    in a.detector.image from=a.camera.image
    out a.detector.objects
    in a.planner.objects from=a.detector
    in a.planner.check from=a.server.check
    out a.server.check type=Check
    node detector implements=a.detector
    node relay
"""


def test_a_way_through_others_is_enough(found: Found) -> None:
    text = (
        f"{_ROBOT}\nchain c a.camera.image detector a.detector.objects a.planner a.server\nchain d a.camera a.planner"
    )
    assert found(broken_chain, text) == []


def test_a_service_leads_both_ways(found: Found) -> None:
    assert found(broken_chain, f"{_ROBOT}\nchain c a.server a.planner\nchain d a.planner a.server.check") == []


def test_the_wrong_order_and_a_missing_connection_break_a_chain(found: Found) -> None:
    text = f"{_ROBOT}\nchain c a.planner a.camera\nchain d a.camera.depth a.planner"
    assert found(broken_chain, text) == [
        "12: in the chain `c`, nothing leads from `a.planner` to `a.camera`",
        "13: in the chain `d`, nothing leads from `a.camera.depth` to `a.planner`",
    ]


def test_a_node_without_component_and_an_open_reference_break_nothing(found: Found) -> None:
    assert found(broken_chain, f"{_ROBOT}\nchain c a.camera relay a.planner") == []
    assert found(broken_chain, f"{_ROBOT}\nin a.arm.goal from=?\nchain c a.camera a.arm") == []


def test_a_reference_to_a_stub_leads_on(found: Found) -> None:
    assert found(broken_chain, "component a.one\nin a.two.data from=a.one\nchain c a.one a.two") == []
