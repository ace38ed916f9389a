"""What rests on a partner, in each format; whose words name no component says so."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from archgen.products.compared_versions import ProjectVersion
from archgen.products.partner_documents import ComponentsError, write_impact, write_tasks
from tests.late_robot import check


def test_formats_tell_the_same(tmp_path: Path) -> None:
    checked = check(tmp_path)
    north = checked.architecture.partners["north"]
    text, words = (write_impact(checked, north, (), form) for form in ("text", "markdown"))
    data = json.loads(write_impact(checked, north, (), "json"))
    assert text.startswith("If North is late (2 components)\n")
    assert words.startswith("# If North is late\n")
    for part in ("It answers", "at once, of 4 steps", "none: its message is not agreed"):
        assert part in text
        assert part in words
    assert [each["stand_in"] for each in data["interfaces"]] == ["recording", "none"]


def test_some_components_of_a_partner_or_of_nobody(tmp_path: Path) -> None:
    checked = check(tmp_path)
    north = checked.architecture.partners["north"]
    assert write_impact(checked, north, ("mouth",), "text").startswith("If Mouth is late (1 component)\n")
    assert write_impact(checked, None, ("g.bed",), "text").startswith("If Bed is late (1 component)\n")
    with pytest.raises(ComponentsError, match=r"`north` owns g\.brain not"):
        write_impact(checked, north, ("brain",), "text")
    with pytest.raises(ComponentsError, match="nothing is called `moth`; did you mean `mouth`"):
        write_impact(checked, None, ("moth",), "text")
    with pytest.raises(ComponentsError, match="name who or what is late"):
        write_impact(checked, None, (), "text")


def test_what_is_to_do_in_each_format(tmp_path: Path) -> None:
    checked = check(tmp_path)
    north = checked.architecture.partners["north"]
    text, words = (write_tasks(checked, north, None, form) for form in ("text", "markdown"))
    data = json.loads(write_tasks(checked, north, ProjectVersion("before", checked), "json"))
    assert text.startswith("North: what is to do (2 components)\n")
    assert "State size and QoS offered of `g.eye.picture`" in words
    assert data["tasks"][0]["text"] == "State size and QoS offered of `g.eye.picture`"
    assert (data["tasks"][0]["chains"], data["tasks"][0]["line"]) == (["talk"], 19)
    assert data["changes"] == []
