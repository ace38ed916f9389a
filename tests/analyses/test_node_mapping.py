"""Tests of the mapping between components and nodes."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.node_mapping import unjustified_node, unmapped_component, unpublished_output, unsubscribed_input

Found = Callable[..., list[str]]

_SHARED = """
    type Check std_srvs/srv/Trigger
    out a.camera.image
    out a.camera.info
    out a.camera.check type=Check
    out a.camera.light physical
    in a.screen.image from=a.camera.image
    in a.screen.info from=a.camera.info
    in a.screen.light from=a.camera.light
    in a.screen.voice external
    in a.screen.open from=?
    in a.screen.check from=a.camera.check
"""


def test_a_component_without_a_written_node_is_unmapped(found: Found) -> None:
    text = """
        out a.camera.image
        component a.screen
        out a.lamp.light physical
        node camera implements=a.camera
        node screen implements=a.screen planned
    """
    assert found(unmapped_component, text) == ["2: no node implements `a.screen`"]


def test_a_node_without_component_is_unjustified(found: Found) -> None:
    text = """
        component a.camera
        node camera implements=a.camera
        node relay
        node typo implements=
    """
    assert found(unjustified_node, text) == ["3: the node `relay` implements no component"]


def test_nodes_that_share_a_component_must_carry_all_of_it(found: Found) -> None:
    text = f"""{_SHARED}
        node driver implements=a.camera
        node calibration implements=a.camera
        node view implements=a.screen
        node overlay implements=a.screen
        use driver publishes image port=a.camera.image
        use view subscribes image port=a.screen.image
    """
    assert found(unpublished_output, text) == [
        "3: none of the nodes of `a.camera` publishes `info`",
        "4: none of the nodes of `a.camera` publishes `check`",
    ]
    assert found(unsubscribed_input, text) == [
        "7: none of the nodes of `a.screen` reads `info`",
        "11: none of the nodes of `a.screen` reads `check`",
    ]


def test_one_node_has_all_ports_of_its_component(found: Found) -> None:
    text = f"{_SHARED}\nnode driver implements=a.camera\nnode view implements=a.screen"
    assert found(unpublished_output, text) == []
    assert found(unsubscribed_input, text) == []


def test_what_an_unresolved_reference_meant_is_not_reported_again(found: Found) -> None:
    assert found(unmapped_component, "suspect a.camera\nout a.camera.image") == []
    text = f"""{_SHARED}
        suspect a.camera.info
        node driver implements=a.camera
        node calibration implements=a.camera
        use driver publishes image port=a.camera.image
        use driver serves check port=a.camera.check
    """
    assert found(unpublished_output, text) == []


def test_an_endpoint_carries_its_port_whether_its_node_lists_it_or_not(found: Found) -> None:
    text = """
        out a.camera.image
        out a.camera.depth
        node left implements=a.camera
        node right implements=a.camera
        end left publishes /image port=a.camera.image
    """
    assert found(unpublished_output, text) == ["2: none of the nodes of `a.camera` publishes `depth`"]
