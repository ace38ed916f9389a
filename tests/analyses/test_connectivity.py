"""Tests of the rules on connections."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.connectivity import disconnected_component, empty_reference, unfed_input, unread_output

Found = Callable[..., list[str]]


def test_a_component_that_others_neither_feed_nor_read_is_disconnected(found: Found) -> None:
    text = """
        out a.camera.image
        in a.screen.image from=a.camera.image
        component a.recorder inputs outputs
        out a.lamp.state
    """
    assert found(disconnected_component, text) == [
        "3: `a.recorder` is connected to no other component",
        "4: `a.lamp` is connected to no other component",
    ]


def test_a_stub_beside_connected_components_is_only_a_note(found: Found) -> None:
    text = """
        out a.camera.image
        in a.screen.image from=a.camera
        component a.recorder
    """
    assert found(disconnected_component, text) == ["3: `a.recorder` is connected to no other component (note)"]


def test_a_project_of_stubs_has_no_disconnected_component(found: Found) -> None:
    assert found(disconnected_component, "component a.one\ncomponent a.two\ncomponent b.three") == []


def test_a_single_component_is_not_asked_for_others(found: Found) -> None:
    assert found(disconnected_component, "component a.one inputs outputs") == []


def test_a_component_that_serves_the_world_outside_is_connected(found: Found) -> None:
    text = """
        in a.stop_button.press external physical
        out a.stop_button.power physical external
        component a.other
    """
    assert found(disconnected_component, text) == []


def test_a_reference_to_a_stub_connects_it(found: Found) -> None:
    text = """
        in a.screen.image from=a.camera
        in a.printer.all from=b
        component a.camera
        component b.one
        component b.two outputs inputs
    """
    assert found(disconnected_component, text) == ["5: `b.two` is connected to no other component"]


def test_a_component_with_an_unresolved_reference_may_be_connected(found: Found) -> None:
    text = """
        in a.screen.image from=?
        out a.camera.image external
        component a.other inputs outputs
    """
    assert found(disconnected_component, text) == ["3: `a.other` is connected to no other component"]


def test_a_loop_on_itself_connects_nobody(found: Found) -> None:
    text = """
        in a.filter.old from=a.filter.new
        out a.filter.new
        component a.other
    """
    assert found(disconnected_component, text)[0] == "1: `a.filter` is connected to no other component"


def test_an_input_without_source_is_unfed_unless_it_says_why(found: Found) -> None:
    text = """
        in a.screen.image
        in a.screen.hint optional
        in a.screen.voice external
        in a.screen.light physical
        in a.screen.typo from=?
        in a.screen.stub from=a.camera
        component a.camera
    """
    assert found(unfed_input, text) == [
        "1: nothing feeds the input `image` of `a.screen`",
        "4: nothing feeds the input `light` of `a.screen`",
    ]


def test_a_reference_to_a_whole_component_may_bring_nothing(found: Found) -> None:
    text = """
        type Check std_srvs/srv/Trigger
        out a.server.check type=Check
        out a.lamp.light physical
        component b.stub
        component c.mute outputs
        in d.one.a from=a.server
        in d.one.b from=a
        in d.one.c from=b.stub
        in d.one.d from=b
        in d.one.e from=c
        in d.one.f from=a.server.check
    """
    assert found(empty_reference, text) == [
        "6: `a.server` brings nothing: no output in it carries messages",
        "7: `a` brings nothing: no output in it carries messages",
        "10: `c` brings nothing: no output in it carries messages",
    ]


def test_an_output_without_reader_is_unread_unless_it_is_for_the_world(found: Found) -> None:
    text = """
        type Check std_srvs/srv/Trigger
        out a.camera.image
        out a.camera.depth
        out a.camera.check type=Check
        out a.camera.light physical
        out a.camera.beep physical external
        out a.camera.stream external
        in a.screen.image from=a.camera.image
    """
    assert found(unread_output, text) == [
        "3: nobody reads `depth` of `a.camera`",
        "4: nobody calls `check` of `a.camera`",
        "5: nobody reads `light` of `a.camera`",
    ]


def test_what_stands_on_a_shared_topic_is_for_everybody(found: Found) -> None:
    text = """
        out a.base.frames
        node base implements=a.base
        end base publishes /tf port=a.base.frames shared
    """
    assert found(unread_output, text) == []


def test_the_help_says_why_a_whole_reference_does_not_take_a_service(sketch: Callable[..., object]) -> None:
    text = """
        type Check std_srvs/srv/Trigger
        out a.camera.check type=Check
        out a.camera.image
        in a.screen.image from=a.camera
    """
    (diagnostic,) = unread_output(sketch(text))  # type: ignore[arg-type]
    assert diagnostic.help == (
        "a reference to the whole component does not take it, being a service: name `a.camera.check`"
    )


def test_what_an_unresolved_reference_meant_is_not_reported_again(found: Found) -> None:
    text = """
        suspect a.camera.image
        out a.camera.image
        out a.camera.depth
        in a.screen.image from=?
    """
    assert found(unread_output, text) == ["3: nobody reads `depth` of `a.camera`"]
    assert found(disconnected_component, text) == []
