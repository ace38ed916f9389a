"""What came and went, and what that means at the other end."""

from __future__ import annotations

from tests.compare.conftest import Compared, Told

BOTH = """\
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: Colour image}}
  display:
    owner: sssa
    components:
      screen: {inputs: {image: camera.image}}
partners: {certh: CERTH, sssa: SSSA}
"""
CAMERA = BOTH.replace("      screen: {inputs: {image: camera.image}}\n", "      lamp: {title: Lamp}\n")
SCREEN = BOTH.replace("      camera: {outputs: {image: Colour image}}\n", "      lamp: {title: Lamp}\n")
UNFED = SCREEN.replace("image: camera.image", "image: ")


def test_a_reader_that_went_leaves_an_output_unread(told: Told) -> None:
    assert told(BOTH, CAMERA) == [
        "added component display.lamp: component `display.lamp` is added",
        (
            "removed component display.screen: component `display.screen` is removed with 1 input; "
            "`sensing.camera.image` is no longer read by anybody"
        ),
        "  removed input display.screen.image: input `display.screen.image` is removed",
        (
            "  removed connection display.screen.image: `sensing.camera.image` is no longer read by anybody: "
            "its only reader `display.screen.image` was removed"
        ),
    ]


def test_a_source_that_went_leaves_an_input_unfed(told: Told) -> None:
    assert told(BOTH, UNFED)[:3] == [
        (
            "removed component sensing.camera: component `sensing.camera` is removed with 1 output; "
            "`display.screen.image` has no source any more"
        ),
        "  removed output sensing.camera.image: output `sensing.camera.image` is removed",
        (
            "  removed connection display.screen.image: `display.screen.image` no longer reads `sensing.camera.image`, "
            "which was removed; it has no source any more"
        ),
    ]


def test_what_came_says_whom_it_feeds(told: Told) -> None:
    assert told(UNFED, BOTH)[0] == (
        "added component sensing.camera: component `sensing.camera` is added with 1 output; "
        "`display.screen.image` gets its first source"
    )
    assert told(CAMERA, BOTH)[1] == (
        "added component display.screen: component `display.screen` is added with 1 input; "
        "`sensing.camera.image` is read for the first time"
    )


MANY = """\
groups:
  g:
    components:
      a: {outputs: {x: T, y: T}}
      b: {inputs: {x: a.x}}
      c: {inputs: {x: a.x}}
"""


def test_connections_between_what_stays(compared: Compared) -> None:
    found = compared(MANY, MANY.replace("c: {inputs: {x: a.x}}", "c: {inputs: {x: a.y}}"))
    (change,) = found.changes
    assert (change.kind, change.element_kind, change.element_id) == ("changed", "connection", "g.c.x")
    assert (change.before, change.after) == (["g.a.x"], ["g.a.y"])
    assert change.text == "`g.c.x` now reads `g.a.y` instead of `g.a.x`; nobody read `g.a.y` before"


def test_one_reader_fewer(told: Told) -> None:
    assert told(MANY, MANY.replace("c: {inputs: {x: a.x}}", "c: {inputs: {x: }}")) == [
        "removed connection g.c.x: `g.c.x` no longer reads `g.a.x`; it has no source any more"
    ]
    assert told(MANY.replace("c: {inputs: {x: a.x}}", "c: {inputs: {x: }}"), MANY) == [
        "added connection g.c.x: `g.c.x` now reads `g.a.x`, its first source"
    ]


def test_an_output_that_went(told: Told) -> None:
    lines = told(MANY, MANY.replace("{x: T, y: T}", "{y: T}").replace("x: a.x", "x: "))
    assert lines == [
        "removed output g.a.x: output `g.a.x` is removed; `g.b.x` has no source any more; `g.c.x` has no source any more",
        "  removed connection g.b.x: `g.b.x` no longer reads `g.a.x`, which was removed; it has no source any more",
        "  removed connection g.c.x: `g.c.x` no longer reads `g.a.x`, which was removed; it has no source any more",
    ]


def test_a_reference_to_a_group_gains_what_the_group_gains(told: Told) -> None:
    before = "groups:\n  g: {components: {a: {outputs: {x: T}}}}\n  h: {components: {b: {inputs: {data: g}}}}\n"
    assert told(before, before.replace("{x: T}", "{x: T, y: T}")) == [
        "added output g.a.y: output `g.a.y` is added; `h.b.data` gets another source",
        "  changed connection h.b.data: `h.b.data` now also reads `g.a.y`",
    ]


def test_a_whole_group_is_one_change(told: Told) -> None:
    more = BOTH.replace("partners:", "  new:\n    components:\n      a: {inputs: {i: camera.image}}\npartners:")
    lines = told(BOTH, more)
    assert [line.split(":")[0] for line in lines] == [
        "added group new",
        "  added component new.a",
        "    added input new.a.i",
        "    added connection new.a.i",
    ]
    assert (
        lines[0]
        == "added group new: group `new` is added with 1 component and 1 input; it reads `sensing.camera.image`"
    )


def test_a_requirement_that_lost_its_last_component(told: Told) -> None:
    head = "requirements: {R-1: {title: One}}\ngroups:\n  g:\n    components:\n"
    before = f"{head}      a: {{title: A, requirements: [R-1]}}\n      b: {{title: B}}\n"
    assert told(before, before.replace(", requirements: [R-1]", "")) == [
        "changed component g.a: `g.a` no longer serves `R-1`; no component serves `R-1` any more"
    ]
    assert told(before, f"{head}      b: {{title: B}}\n") == [
        "removed component g.a: component `g.a` is removed; no component serves `R-1` any more"
    ]


def test_whose_interfaces_are_touched(compared: Compared) -> None:
    assert compared(BOTH, BOTH.replace("Colour image", "Depth image")).concerned_owners == ("certh", "sssa")
    assert compared(BOTH, CAMERA).concerned_owners == ("certh", "sssa")
    assert compared(BOTH, BOTH.replace("camera: {outputs", "camera: {title: C, outputs")).concerned_owners == ("certh",)
