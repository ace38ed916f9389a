"""Agreements: the frames that one partner writes and the other uses, and what became of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.model.partner_interfaces import find_all_interfaces, find_shared_frames
from archgen.views.agreement.output_promises import hash_interface
from archgen.views.agreement.partner_agreement import PartnerAgreement, make_agreement
from archgen.views.shapes import Table
from tests.agreeing import DUO, checked, lines, section, view

FRAMES = """\
frames:
  world: {}
  base: {parent: world, by: planner, rate: 50 Hz}
  tool: {parent: base, by: arm_node}
  eye: {parent: base, static: true, by: camera}
  table: {parent: world, by: calibration}
  free: {parent: base}
"""
FRAMED = (
    DUO.replace("{image: Colour image, info", "{image: {type: Colour image, frame: eye}, info").replace(
        "Found objects: {message", "Found objects: {frame: base, message"
    )
    + FRAMES
)


def agree(folder: Path, after: str = FRAMED, before: str = "") -> PartnerAgreement:
    earlier = ("v1", view(checked(folder / "before", before))) if before else None
    return make_agreement(view(checked(folder / "after", after)), "north", "south", earlier_revision=earlier)


def list_rows(agreement: PartnerAgreement) -> list[tuple[str, ...]]:
    (table,) = (block for block in section(agreement.outline, "Frames").blocks if isinstance(block, Table))
    return [tuple("".join(run.text for run in cell) for cell in row) for row in table.rows]


def test_what_one_writes_and_the_other_uses(tmp_path: Path) -> None:
    """The finder's objects are in the base, and the eye stands there; what belongs to both is theirs together."""
    shared = find_shared_frames(checked(tmp_path, FRAMED).architecture, "north", "south")
    assert [(each.frame.id, each.giver, each.ports, each.frames) for each in shared] == [
        ("base", "north", ("seeing.finder.objects",), ("eye",)),
    ]
    assert list_rows(agree(tmp_path)) == [
        ("base", "North Robotics", "Planner", "world", "50 Hz", "Finder · objects, eye")
    ]


def test_the_partner_of_a_node_writes_its_frames(tmp_path: Path) -> None:
    used = FRAMED.replace("tool: {parent: base", "grip: {parent: tool, by: planner}\n  tool: {parent: base")
    shared = find_shared_frames(checked(tmp_path, used).architecture, "north", "west")
    assert [(each.frame.id, each.giver, each.taker, each.frames) for each in shared] == [
        ("base", "north", "west", ("tool",)),
        ("tool", "west", "north", ("grip",)),
    ]


def test_without_such_a_frame_there_is_no_section_and_an_interface_names_its_own(tmp_path: Path) -> None:
    titles = {each.title for each in agree(tmp_path, DUO).outline.sections}
    assert "Frames" not in titles
    assert "Frame: eye" in lines(section(agree(tmp_path).outline, "Camera · image").blocks)


@pytest.mark.parametrize(
    ("old", "new", "mark", "notice"),
    [
        ("rate: 50 Hz", "rate: 40 Hz", "~ changed", "Frames that are not what they were at v1: base."),
        (
            "base: {parent: world",
            "base: {parent: table",
            "~ changed",
            "Frames that are not what they were at v1: base.",
        ),
        ("  free: {parent: base}\n", "", "", "Nothing between the two has changed since v1."),
    ],
)
def test_what_became_of_them(tmp_path: Path, old: str, new: str, mark: str, notice: str) -> None:
    assert old in FRAMED
    agreement = agree(tmp_path, FRAMED.replace(old, new), FRAMED)
    assert notice in lines(agreement.outline.notices)
    (row,) = list_rows(agreement)
    assert (row[-1] if mark else "") == mark


def test_a_frame_that_is_gone_is_named(tmp_path: Path) -> None:
    gone = FRAMED.replace("frame: base, message", "frame: world, message").replace(
        "eye: {parent: base", "eye: {parent: world"
    )
    notices = lines(agree(tmp_path, gone, FRAMED).outline.notices)
    assert "Frames that are not what they were at v1: base." in notices


def test_versions_that_were_signed_stay_where_nobody_names_a_frame(tmp_path: Path) -> None:
    def list_versions(text: str) -> dict[str, str]:
        lookup = view(checked(tmp_path, text))
        return {each.key: hash_interface(lookup, each) for each in find_all_interfaces(lookup.architecture)}

    plain, framed = list_versions(DUO), list_versions(FRAMED)
    assert {name for name in plain if plain[name] != framed[name]} == {"seeing.camera.image", "seeing.finder.objects"}
